//! `umbrage theory`: the papers' theory as data and plots, computed by the crate `umbrage`; no
//! number is typed in.
//!
//! * `aliasing`: the three split schemes over depth and dp/ds (\[PSSM06\] Figure 4, \[GG3-10\]
//!   Figure 10-4);
//! * `area`: Σ Area(B_i)/Area(B) over the light's direction (\[PSSM06\] Figure 5);
//! * `fits`: independent against dependent fit (\[GG3-10\] Figures 10-5 and 10-6);
//! * `wireframe`: slices and light frusta in space;
//! * `levels`: the mip level across a border of splits (\[PCSM\] Figures 4.1.10 to 4.1.14);
//! * `stillness`: why shadows flicker, and what keeps them still (\[PCSM\] Figures 4.1.3, 4.1.4 and
//!   4.1.6).
//!
//! Papers by key: `docs/papers.md`.

mod aliasing;
mod area;
mod example;
mod fits;
mod levels;
mod setting;
mod stillness;
mod wireframe;

pub use setting::Setting;

use crate::{
    failure::Failure,
    page::html::{Page, Section},
    page::plot,
};

/// [`std::result::Result`] with this module's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Reason why the theory could not be drawn. None occurs with the default [`Setting`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The planner refused its input.
    #[error(transparent)]
    Plan(#[from] umbrage::Error),
    /// A world could not be posed.
    #[error(transparent)]
    Scene(#[from] umbrage_scene::Error),
    /// A chart could not be drawn.
    #[error(transparent)]
    Plot(#[from] plot::Error),
    /// A picture could not be written as PNG.
    #[error("{reason}")]
    Picture {
        /// Message of the encoder.
        reason: String,
    },
    /// A world lacks the camera that the plots look through.
    #[error("the world {world} has no camera {camera}, through which the fits are compared")]
    NoCamera {
        /// Name of the world.
        world: &'static str,
        /// Name of the camera.
        camera: &'static str,
    },
}

/// Makes all sections, for a page of the caller's own.
///
/// # Errors
/// [`Error`] if the setting's lens or range is out of range.
pub fn sections(setting: &Setting) -> Result<Vec<Section>> {
    Ok(vec![
        aliasing::section(setting)?,
        area::section(setting)?,
        fits::section(setting)?,
        wireframe::section()?,
        stillness::section(setting)?,
        levels::section(setting)?,
    ])
}

/// Makes the whole page with the default setting.
///
/// # Errors
/// As [`sections`].
pub fn page() -> Result<Page> {
    let setting = Setting::default();
    Ok(Page {
        title: "The theory of parallel-split shadow maps".into(),
        lead: vec![
            "What the papers derive, computed: every curve and drawing comes from the planner that also makes the shadows."
                .into(),
            format!("Unless said otherwise: {}, maps of {}².", setting.describe(), setting.map_size),
        ],
        sections: sections(&setting)?,
        footer: "Written by `umbrage theory`. [PSSM06]: Zhang, Sun, Xu, Lun, Parallel-Split Shadow Maps for Large-scale Virtual \
                 Environments, VRCIA 2006. [GG3-10]: Zhang, Sun, Nyman, Parallel-Split Shadow Maps on Programmable GPUs, GPU \
                 Gems 3, chapter 10, 2007. [PCSM]: Zhang, Zaprjagaev, Bentham, Practical Cascaded Shadow Maps, ShaderX7, 2009."
            .into(),
    })
}

/// The setting is ours, so every error is too.
impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::other(format!("cannot draw the theory: {error}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_whole() {
        let html = page().expect("a page").html();
        assert_eq!(html.matches("<section").count(), 6);
        assert_eq!(html.matches("<svg ").count(), html.matches("</svg>").count());
        assert_eq!(html.matches("<svg xmlns").count(), 22);
        assert!(!html.contains("NaN") && !html.contains("inf"), "a number that is none");
        assert!(html.len() < 2 << 20, "{} bytes", html.len());
    }
}
