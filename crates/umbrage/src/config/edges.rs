//! Choices of the method that decides where a shadow's edge lies.

use super::names::named;

named! {
    /// Method that decides where a shadow's edge lies.
    pub enum Edges as "way to decide edges" {
        /// The filter: an edge is known to the texel
        #[default]
        Sampled = "sampled",
        /// The triangles that texels name: an edge is exact where casters can be asked
        Exact = "exact",
    }
}
