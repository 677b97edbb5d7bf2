//! Where a mask takes its normals from; an error carries it.

/// Where the mask's pass takes its normals from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MaskNormals {
    /// From the depth of neighbouring pixels. Exact on planes; wrong where a surface is a pixel or
    /// two wide, which then may shade itself or lie turned away from the light.
    #[default]
    FromDepth,
    /// From a texture as large as the depth, `texture_2d<f32>` with a format that has a sign: unit
    /// vectors of the world, of the surfaces themselves and not of their shading.
    Texture,
}
