//! A sun that moves in steps.

use crate::{DirectionalLight, Error, Result, maths};

/// Follows a moving sun in steps, so that shadows stand still between two of them, and returns how
/// to fade from one to the next.
///
/// If the sun moves a little every frame, every shadow edge falls into other texels every frame,
/// and all edges crawl. This sun stays where it is until it is `step` behind, and is then
/// cross-faded to its true direction. Nothing changes in between; a fade costs a second set of
/// maps. Ours: \[PCSM\] has a static light.
///
/// ```
/// # use umbrage::{DirectionalLight, SteppedSun};
/// # use glam::DVec3;
/// let mut stepped = SteppedSun::new(0.5f64.to_radians(), 2.0)?;
/// // Every frame, with the seconds since the last one:
/// let sun = DirectionalLight::new(DVec3::new(0.3, -1.0, 0.2))?;
/// let fade = stepped.follow(&sun, 1.0 / 60.0)?;
/// // Plan and draw maps for `fade.to`, and for `fade.from` too if it fades; then mix their visibilities.
/// assert!(!fade.is_fading());
/// # Ok::<(), umbrage::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteppedSun {
    step: f64,
    duration: f64,
    fade: Option<SunFade>,
}

/// The one or two suns whose shadows are shown, and their shares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunFade {
    /// The sun that is left; the same as `to` between two fades.
    pub from: DirectionalLight,
    /// The sun that is faded to.
    pub to: DirectionalLight,
    /// The share of `to`, 0 to 1: 1 between two fades.
    pub weight: f64,
}

impl SunFade {
    /// Whether two sets of maps are needed.
    #[must_use]
    pub fn is_fading(&self) -> bool {
        self.weight < 1.0
    }

    /// What is shown, of what the two suns' maps answer.
    #[must_use]
    pub fn mix(&self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.weight
    }
}

impl SteppedSun {
    /// `step` in radians: how far behind the true sun shadows may fall. `fade` is how long a step
    /// is faded, in the unit of the time given to [`SteppedSun::follow`] (seconds, frames); 0 is a
    /// sudden step.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] for a step outside (0, π], or a fade that is negative or not finite.
    pub fn new(step: f64, fade: f64) -> Result<Self> {
        if !(step > 0.0 && step <= std::f64::consts::PI) {
            return Err(Error::InvalidLight {
                field: "step",
                reason: format!("{step} rad; give an angle greater than 0 and at most π"),
            });
        }
        check_duration("fade", fade)?;
        Ok(Self { step, duration: fade, fade: None })
    }

    /// The suns to draw with, now that the true one stands at `sun` and `elapsed` has passed since
    /// the last call. The first call shows the sun where it is.
    ///
    /// A sun that moves more than a step while one is being faded is taken up where it is after
    /// that fade, so shadows fall at most a step and what the sun moves in a fade behind. A sun
    /// that trembles by less than a step changes nothing.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] if `elapsed` is negative or not finite.
    pub fn follow(&mut self, sun: &DirectionalLight, elapsed: f64) -> Result<SunFade> {
        check_duration("elapsed", elapsed)?;
        let mut fade = self.fade.unwrap_or(SunFade { from: *sun, to: *sun, weight: 1.0 });
        let passed = if elapsed < self.duration { elapsed / self.duration } else { 1.0 };
        if fade.is_fading() {
            fade.weight = (fade.weight + passed).min(1.0);
        } else if maths::angle_between(fade.to.direction(), sun.direction()) >= self.step {
            fade = SunFade { from: fade.to, to: *sun, weight: passed };
        }
        if !fade.is_fading() {
            fade.from = fade.to;
        }
        self.fade = Some(fade);
        Ok(fade)
    }
}

fn check_duration(field: &'static str, value: f64) -> Result<()> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::InvalidLight { field, reason: format!("{value}; give a finite time of 0 or more") })
}
