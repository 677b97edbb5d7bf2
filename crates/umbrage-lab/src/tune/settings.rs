//! What holds for all candidates of a search.

/// What holds for all candidates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels across and down.
    pub size: [u32; 2],
    /// View depths in metres that are scored; none: the camera's near and far.
    pub shadow_range: Option<(f64, f64)>,
    /// Degrees across the sun, for pcss.
    pub sun_angle: Option<f64>,
    /// Edge pixels of the true shadow that a view needs to count.
    pub least_edges: usize,
}
