//! Settings of all candidates of a search.

/// Settings of all candidates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// View depths in metres that are scored; `None` uses the camera's near and far.
    pub shadow_range: Option<(f64, f64)>,
    /// Angular diameter of the sun in degrees, for the filter pcss.
    pub sun_angle: Option<f64>,
    /// Fewest edge pixels of the true shadow in a view that counts.
    pub least_edges: usize,
}
