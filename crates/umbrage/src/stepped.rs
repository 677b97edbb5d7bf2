//! A sun that moves in steps.

use crate::{DirectionalLight, Error, Result, maths};

/// Follows a moving sun in steps, between which shadows stand still, and gives the fade from one
/// step to the next.
///
/// If the sun moves a little in every frame, every shadow edge falls on other texels in every
/// frame, and all edges crawl. This sun stays in place until it is `step` behind the true one, and
/// is then cross-faded to the true direction. Nothing changes in between; a fade costs a second set
/// of maps. Not from a paper: \[PCSM\] has a static light.
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

/// The one or two suns whose shadows are shown, and the weight of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunFade {
    /// The sun that is faded out; equal to `to` between two fades.
    pub from: DirectionalLight,
    /// The sun that is faded in.
    pub to: DirectionalLight,
    /// Weight of `to`, 0 to 1: 1 between two fades.
    pub weight: f64,
}

impl SunFade {
    /// Returns whether two sets of maps are needed.
    #[must_use]
    pub fn is_fading(&self) -> bool {
        self.weight < 1.0
    }

    /// Mixes the visibilities from the two suns' maps.
    #[must_use]
    pub fn mix(&self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.weight
    }
}

impl SteppedSun {
    /// A sun with steps of `step` radians: the angle by which shadows may fall behind the true sun.
    /// `fade` is the duration of a step's fade, in the unit of the time given to
    /// [`SteppedSun::follow`] (seconds, frames); 0 is a sudden step.
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

    /// The suns to draw with, for the true direction `sun` and the time `elapsed` since the last
    /// call. The first call returns the sun in its true direction.
    ///
    /// If the sun moves more than a step during a fade, the next step begins from its direction
    /// after that fade, so shadows fall behind by at most a step and the sun's movement in a fade.
    /// A sun that trembles by less than a step changes nothing.
    ///
    /// # Errors
    /// [`Error::InvalidLight`] if `elapsed` is negative or not finite.
    pub fn follow(&mut self, sun: &DirectionalLight, elapsed: f64) -> Result<SunFade> {
        let passed = self.passed(elapsed)?;
        Ok(self.advance(sun, passed, passed))
    }

    /// [`SteppedSun::follow`] for maps that are filled over several frames: kept maps with a budget
    /// of texels ([`crate::KeptFrame::budget`]). `is_filled` tells whether the last frame's maps
    /// for [`SunFade::to`] were filled ([`crate::ShadowPlan::is_filled`]).
    ///
    /// A fade begins with a weight of 0, and its time passes only while maps are filled. Until then
    /// the maps of the sun before are shown alone, which cost nothing while they stand, and the new
    /// ones are to be drawn without being shown.
    ///
    /// # Errors
    /// Those of [`SteppedSun::follow`].
    pub fn follow_filled(&mut self, sun: &DirectionalLight, elapsed: f64, is_filled: bool) -> Result<SunFade> {
        let passed = self.passed(elapsed)?;
        Ok(self.advance(sun, if is_filled { passed } else { 0.0 }, 0.0))
    }

    /// The share of a fade that passes in a time.
    fn passed(&self, elapsed: f64) -> Result<f64> {
        check_duration("elapsed", elapsed)?;
        Ok(if elapsed < self.duration { elapsed / self.duration } else { 1.0 })
    }

    /// Advances a fade by a share of it; begins one at weight `begin` if the sun is a step ahead.
    fn advance(&mut self, sun: &DirectionalLight, passed: f64, begin: f64) -> SunFade {
        let mut fade = self.fade.unwrap_or(SunFade { from: *sun, to: *sun, weight: 1.0 });
        if fade.is_fading() {
            fade.weight = (fade.weight + passed).min(1.0);
        } else if maths::angle_between(fade.to.direction(), sun.direction()) >= self.step {
            fade = SunFade { from: fade.to, to: *sun, weight: begin };
        }
        if !fade.is_fading() {
            fade.from = fade.to;
        }
        self.fade = Some(fade);
        fade
    }
}

fn check_duration(field: &'static str, value: f64) -> Result<()> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::InvalidLight { field, reason: format!("{value}; give a finite time of 0 or more") })
}
