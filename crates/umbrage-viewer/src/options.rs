//! What the viewer starts with.

use std::path::PathBuf;
use std::str::FromStr;

use umbrage::ShadowConfig;
use umbrage_lab::scene_request::SceneRequest;

use crate::judge::Overlay;
use crate::link::Linked;
use crate::session::{Show, Tab};

/// What the viewer starts with.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scene, camera, light and time; the size is the window's, in pixels.
    pub request: SceneRequest,
    /// Shadows.
    pub config: ShadowConfig,
    /// What gave way to what was asked for.
    pub notes: Vec<String>,
    /// What is shown at once.
    pub show: Show,
    /// Whether maps are held for the first view.
    pub held: bool,
    /// Shadows to compare with.
    pub other: Option<ShadowConfig>,
    /// Whether the panels are hidden.
    pub bare: bool,
    /// Whether time runs at once.
    pub runs: bool,
    /// Size of text and controls: 1 is the screen's own.
    pub scale: f32,
    /// Writes a picture of the window here (PNG) and ends.
    pub screenshot: Option<PathBuf>,
    /// Pictures of the scene before the screenshot.
    pub frames: u64,
}

impl Options {
    /// Shows what a link shows; `wrong` is what could not be read of it.
    #[must_use]
    pub fn of_link(linked: Linked, wrong: Option<String>) -> Self {
        Self {
            request: linked.request,
            config: linked.config,
            notes: linked.notes.into_iter().chain(wrong).collect(),
            show: Show { tint: linked.tint, ..Show::default() },
            held: false,
            other: None,
            bare: linked.bare,
            runs: linked.runs,
            scale: 1.0,
            screenshot: None,
            frames: 1,
        }
    }
}

/// Something to show at once, by its word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShowAtStart {
    /// Splits in colours.
    Tint,
    /// Frusta as lines.
    Frusta,
    /// Maps held for the first view, seen from behind it.
    Held,
    /// Texels per pixel.
    Density,
    /// Where shadows are wrong.
    Errors,
    /// Where exact edges test triangles.
    Tests,
    /// A tab.
    Tab(Tab),
}

impl ShowAtStart {
    /// All of them, by their words.
    pub const ALL: [(&'static str, Self); 10] = [
        ("tint", Self::Tint),
        ("frusta", Self::Frusta),
        ("held", Self::Held),
        ("density", Self::Density),
        ("errors", Self::Errors),
        ("tests", Self::Tests),
        ("maps", Self::Tab(Tab::Maps)),
        ("planes", Self::Tab(Tab::Planes)),
        ("times", Self::Tab(Tab::Times)),
        ("casters", Self::Tab(Tab::Casters)),
    ];

    /// Shows it.
    pub fn apply(self, options: &mut Options) {
        let show = &mut options.show;
        match self {
            Self::Tint => show.tint = true,
            Self::Frusta => show.frusta = true,
            Self::Held => options.held = true,
            Self::Density => show.overlay = Some(Overlay::Density),
            Self::Errors => show.overlay = Some(Overlay::Errors),
            Self::Tests => show.overlay = Some(Overlay::Tests),
            Self::Tab(tab) => show.tab = Some(tab),
        }
    }
}

impl FromStr for ShowAtStart {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let known = Self::ALL.iter().find(|(word, _)| *word == text).map(|(_, show)| *show);
        known.ok_or_else(|| {
            let words: Vec<&str> = Self::ALL.iter().map(|(word, _)| *word).collect();
            format!("{text:?} is nothing to show; give one of {}", words.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_told_apart() {
        for (word, show) in ShowAtStart::ALL {
            assert_eq!(word.parse(), Ok(show));
        }
        assert!("fog".parse::<ShowAtStart>().expect_err("nothing").contains("held"));
    }
}
