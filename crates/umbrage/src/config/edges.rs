//! What decides where a shadow ends.

use super::names::named;

named! {
    /// What decides where a shadow ends.
    pub enum Edges as "way to decide edges" {
        /// The filter: an edge is known to the texel
        #[default]
        Sampled = "sampled",
        /// The triangles that texels name: an edge is exact where casters can be asked
        Exact = "exact",
    }
}
