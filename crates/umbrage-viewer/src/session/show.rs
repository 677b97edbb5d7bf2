//! What is shown beside the picture and over it, and lines to read.

use crate::judge::Overlay;

/// A drawn picture's times, milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Planning, on the CPU.
    pub plan: f64,
    /// The maps.
    pub maps: f64,
    /// The view.
    pub view: f64,
    /// From the order to the picture, with everything that was wanted beside it.
    pub wall: f64,
}

/// A line for whoever looks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Whether something failed; else it is a note.
    pub is_error: bool,
    /// What to read.
    pub text: String,
}

/// What is shown beside the picture, and over it.
#[derive(Clone, Debug, PartialEq)]
pub struct Show {
    /// Splits in colours.
    pub tint: bool,
    /// Frusta of splits and of their maps as lines.
    pub frusta: bool,
    /// Shadows at all.
    pub shadows: bool,
    /// What is laid over the picture.
    pub overlay: Option<Overlay>,
    /// The tab below the picture.
    pub tab: Option<Tab>,
    /// Where the first of two compared pictures ends, as a share of the width.
    pub wipe: f32,
    /// A caster whose box is drawn: an index into the pose's objects.
    pub outlined: Option<usize>,
}

impl Default for Show {
    fn default() -> Self {
        Self { tint: false, frusta: false, shadows: true, overlay: None, tab: None, wipe: 0.5, outlined: None }
    }
}

/// What stands below the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tab {
    /// The maps as pictures.
    Maps,
    /// Planes and predicted aliasing.
    Planes,
    /// Times and sizes.
    Times,
    /// Lists of casters.
    Casters,
}

impl Tab {
    /// All of them, with their names.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Maps, "Maps"), (Self::Planes, "Planes"), (Self::Times, "Times"), (Self::Casters, "Casters")];
}
