//! Display options, times of pictures, and messages.

use crate::judge::Overlay;

/// Times of a drawn picture in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Time of planning, on the CPU.
    pub plan: f64,
    /// Time of drawing the maps.
    pub maps: f64,
    /// Time of drawing the view.
    pub view: f64,
    /// Time from the order to the picture, with all outputs that were wanted beside it.
    pub wall: f64,
}

/// A message for the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// True for an error, false for a note.
    pub is_error: bool,
    /// Text of the message.
    pub text: String,
}

/// Display options of the picture and its surroundings.
#[derive(Clone, Debug, PartialEq)]
pub struct Show {
    /// True if splits are coloured.
    pub tint: bool,
    /// True if frusta of splits and volumes of maps are drawn as lines.
    pub frusta: bool,
    /// True if there are shadows.
    pub shadows: bool,
    /// Overlay over the picture.
    pub overlay: Option<Overlay>,
    /// Tab below the picture.
    pub tab: Option<Tab>,
    /// Position of the line between two compared pictures, as a share of the width.
    pub wipe: f32,
    /// Caster whose box is drawn: an index into the pose's objects.
    pub outlined: Option<usize>,
}

impl Default for Show {
    fn default() -> Self {
        Self { tint: false, frusta: false, shadows: true, overlay: None, tab: None, wipe: 0.5, outlined: None }
    }
}

/// Tab below the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tab {
    /// Maps as pictures.
    Maps,
    /// Planes and predicted aliasing.
    Planes,
    /// Times and sizes.
    Times,
    /// Lists of casters.
    Casters,
}

impl Tab {
    /// All tabs, with their names.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Maps, "Maps"), (Self::Planes, "Planes"), (Self::Times, "Times"), (Self::Casters, "Casters")];
}
