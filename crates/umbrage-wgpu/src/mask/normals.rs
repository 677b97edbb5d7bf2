//! Source of a mask's normals. An error carries it, so this file needs none.

/// Source of the normals that the mask's pass uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MaskNormals {
    /// The depth of neighbouring pixels. Exact on planes; wrong for a surface that is a pixel or
    /// two wide, which may then shade itself or count as turned away from the light.
    #[default]
    FromDepth,
    /// A texture as large as the depth, `texture_2d<f32>` with a signed format: unit vectors in the
    /// world, the geometric normals of surfaces and not those of shading. They are turned towards
    /// the camera.
    Texture,
    /// [`MaskNormals::Texture`], used as it is: a normal that is turned away from the camera stays
    /// so. For normals that are bent towards the light, as of leaves that are shaded like a crown.
    TextureAsIs,
}

impl MaskNormals {
    /// Returns whether normals are read from a texture.
    pub(super) fn has_texture(self) -> bool {
        self != Self::FromDepth
    }
}
