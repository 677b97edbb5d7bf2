//! Options that the viewer starts with.

use std::path::PathBuf;
use std::str::FromStr;

use umbrage::ShadowConfig;
use umbrage_lab::scene_request::SceneRequest;

use crate::judge::Overlay;
use crate::link::Linked;
use crate::session::{Show, Tab};

/// Options that the viewer starts with.
#[derive(Clone, Debug)]
pub struct Options {
    /// Scene, camera, light and time. The size is the window's, in pixels.
    pub request: SceneRequest,
    /// Technique of the shadows.
    pub config: ShadowConfig,
    /// Settings that were changed to make room for others.
    pub notes: Vec<String>,
    /// Display options.
    pub show: Show,
    /// True if maps are held for the first view.
    pub held: bool,
    /// Technique to compare with.
    pub other: Option<ShadowConfig>,
    /// True if the panels are hidden.
    pub bare: bool,
    /// True if time runs at once.
    pub runs: bool,
    /// Scale of text and controls; 1 is the screen's own.
    pub scale: f32,
    /// File (PNG) of a screenshot, after which the viewer ends.
    pub screenshot: Option<PathBuf>,
    /// Number of pictures of the scene before the screenshot.
    pub frames: u64,
}

impl Options {
    /// Makes the options of a link. `wrong` is the error of its unreadable part.
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

/// A display option, by its word on the command line.
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
    /// Errors of the shadows.
    Errors,
    /// Triangle tests of exact edges.
    Tests,
    /// A tab below the picture.
    Tab(Tab),
}

impl ShowAtStart {
    /// All display options, by their words.
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

    /// Applies the choice to options.
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
