//! Progress bars on a terminal; none in a pipe.

use indicatif::{ProgressBar, ProgressStyle};

/// Number of steps of [`fraction`]'s bar, fine enough that it never seems to stand still.
const FRACTION_STEPS: u64 = 1000;

/// Makes a bar on standard error that counts to `total`. It is hidden if standard error is no
/// terminal or there is only one step.
#[must_use]
pub fn steps(total: u64, what: &'static str) -> ProgressBar {
    if total <= 1 {
        return ProgressBar::hidden();
    }
    styled(ProgressBar::new(total), "{msg} {wide_bar} {pos}/{len} {eta}").with_message(what)
}

/// Makes a bar on standard error for a share of work in 0..=1; see [`set_fraction`]. It is hidden
/// if standard error is no terminal.
#[must_use]
pub fn fraction(what: &'static str) -> ProgressBar {
    styled(ProgressBar::new(FRACTION_STEPS), "{msg} {wide_bar} {percent:>3} % {eta}").with_message(what)
}

/// Moves the bar of [`fraction`].
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0..=FRACTION_STEPS")]
pub fn set_fraction(bar: &ProgressBar, done: f32) {
    bar.set_position((done.clamp(0.0, 1.0) * FRACTION_STEPS as f32) as u64);
}

fn styled(bar: ProgressBar, template: &str) -> ProgressBar {
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
