//! The scene that all other crates use: meshes, materials, nodes, cameras and lights, without any
//! file format or GPU.

use std::collections::BTreeMap;

use glam::{DAffine3, DQuat, DVec3, Mat4};
use umbrage::Aabb;

/// A scene: geometry that is stored once, and nodes that place it. Right-handed, +Y up, metres.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Name of the file or world, for messages.
    pub name: String,
    /// Stored geometry, which nodes place.
    pub meshes: Vec<Mesh>,
    /// Coarser levels of detail of each mesh that has some, the finest of them first.
    pub levels: BTreeMap<usize, Vec<DetailLevel>>,
    /// Materials. If there is a primitive, a loaded scene has at least one: primitives without a
    /// material refer to a default one.
    pub materials: Vec<Material>,
    /// Pictures that materials refer to.
    pub textures: Vec<Texture>,
    /// Nodes of the hierarchy. A parent comes before its children.
    pub nodes: Vec<Node>,
    /// Cameras, placed by their nodes.
    pub cameras: Vec<SceneCamera>,
    /// Lights, placed by their nodes; each shines along its node's −Z.
    pub lights: Vec<SceneLight>,
    /// Skeletons.
    pub skins: Vec<Skin>,
    /// Animation clips. A pose plays clip 0, and every later clip whose nodes no earlier clip
    /// moves, each in a loop.
    pub animations: Vec<Animation>,
    /// Remarks on parts that were left out or invented while loading, for the report.
    pub notes: Vec<String>,
}

/// Geometry that nodes place.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Name, for messages.
    pub name: String,
    /// Primitives, drawn with one draw call each.
    pub primitives: Vec<Primitive>,
    /// Default weight of each morph target of the primitives; 0 for targets beyond the list.
    pub weights: Vec<f32>,
}

impl Mesh {
    /// Returns whether some primitive has morph targets, so that its vertices are posed.
    #[must_use]
    pub fn is_morphed(&self) -> bool {
        self.primitives.iter().any(|primitive| !primitive.targets.is_empty())
    }
}

/// A coarser level of detail of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetailLevel {
    /// Index into [`Scene::meshes`]; neither skinned nor morphed.
    pub mesh: usize,
    /// Size of the smallest detail that the level shows, in metres of the mesh's own space.
    pub detail_m: f64,
}

impl Scene {
    /// Returns the coarsest mesh that still shows details of `detail_m` metres in the mesh's own
    /// space.
    #[must_use]
    pub fn shape_of(&self, mesh: usize, detail_m: f64) -> usize {
        let coarser = self.levels.get(&mesh).map_or(&[][..], Vec::as_slice);
        coarser.iter().rev().find(|level| level.detail_m <= detail_m).map_or(mesh, |level| level.mesh)
    }
}

/// An indexed triangle list with one material. Counter-clockwise triangles face the viewer.
#[derive(Clone, Debug, Default)]
pub struct Primitive {
    /// Local positions in metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one per position. Where the file has none, a loader computes flat ones and
    /// splits vertices.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates of the base colour (with KHR_texture_transform applied); empty if there
    /// are none.
    pub uvs: Vec<[f32; 2]>,
    /// Linear RGB(A) vertex colours, multiplied into the base colour; empty if there are none.
    pub colors: Vec<[f32; 4]>,
    /// Indices into the vertices, three per triangle.
    pub indices: Vec<u32>,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Four joints per vertex as indices into the skin; empty if not skinned.
    pub joints: Vec<[u16; 4]>,
    /// Weights of the joints; their sum is 1.
    pub weights: Vec<[f32; 4]>,
    /// Morph targets: shapes that are blended into the base shape by a weight each. The primitives
    /// of a mesh share the weights.
    pub targets: Vec<MorphTarget>,
    /// True if a posed shape takes its normals from its triangles, because the file has none. If
    /// there are morph targets, no two triangles then share a vertex.
    pub flat: bool,
}

/// Differences from the base shape: vertex + weight · difference (glTF 2.0 specification, section
/// 3.7.2.2).
#[derive(Clone, Debug, Default)]
pub struct MorphTarget {
    /// Differences of positions in metres, one per vertex; empty if no vertex moves.
    pub positions: Vec<[f32; 3]>,
    /// Differences of normals, one per vertex; empty if no normal turns.
    pub normals: Vec<[f32; 3]>,
}

/// Use of alpha.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    Opaque,
    /// Alpha test, for the eye and for shadows: there is a surface where alpha ≥ cutoff, and
    /// nothing elsewhere.
    Mask {
        /// Least alpha of the surface.
        cutoff: f32,
    },
    /// Translucent: drawn over the other surfaces. It casts no shadow and hides nothing.
    Blend,
}

/// Properties of a surface.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name, for messages.
    pub name: String,
    /// Linear RGBA, multiplied by the texture.
    pub base_color: [f32; 4],
    /// Index into [`Scene::textures`].
    pub base_color_texture: Option<usize>,
    /// Use of alpha.
    pub alpha: AlphaMode,
    /// True if the surface is visible from behind too. Both sides always cast shadows.
    pub double_sided: bool,
    /// Linear RGB that the surface emits.
    pub emissive: [f32; 3],
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            emissive: [0.0; 3],
        }
    }
}

/// Texture addressing outside `\[0,1\]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture repeats.
    #[default]
    Repeat,
    /// The border texel continues.
    Clamp,
    /// The texture repeats, mirrored every other time.
    Mirror,
}

/// Filter between texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TextureFilter {
    /// Bilinear mix of the four nearest texels.
    #[default]
    Linear,
    /// The nearest texel.
    Nearest,
}

/// A picture with 8-bit sRGB colour and linear alpha, row 0 on top.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Pixels, four bytes each.
    pub rgba: Vec<u8>,
    /// Addressing along u and v.
    pub wrap: [Wrap; 2],
    /// Filter of magnified texels, for colour and for alpha masks.
    pub filter: TextureFilter,
}

/// A node of the hierarchy.
#[derive(Clone, Debug)]
pub struct Node {
    /// Name, for messages, and to choose cameras and lights by.
    pub name: String,
    /// Index of the parent, a node before this one.
    pub parent: Option<usize>,
    /// Transform relative to the parent, when no animation moves the node.
    pub local: Trs,
    /// Index of the mesh that the node shows, in [`Scene::meshes`].
    pub mesh: Option<usize>,
    /// Index into [`Scene::skins`]; the mesh is then placed by the joints alone.
    pub skin: Option<usize>,
    /// Instances (EXT_mesh_gpu_instancing): the mesh is shown once per entry, relative to the node.
    /// If empty, it is shown once, at the node.
    pub instances: Vec<Trs>,
    /// Weight of each morph target of the mesh, instead of [`Mesh::weights`]; empty to use the
    /// mesh's weights.
    pub weights: Vec<f32>,
    /// True if the mesh casts shadows (`extras.castShadow`, which is true by default).
    pub cast_shadow: bool,
}

impl Default for Node {
    fn default() -> Self {
        Self {
            name: String::new(),
            parent: None,
            local: Trs::IDENTITY,
            mesh: None,
            skin: None,
            instances: Vec::new(),
            weights: Vec::new(),
            cast_shadow: true,
        }
    }
}

/// Translation T, rotation R and scale S: parent_from_local = T R S.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the fields are what the name says")]
pub struct Trs {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl Trs {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE };

    /// Returns the affine transform.
    #[must_use]
    pub fn to_affine(self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// A camera of the scene. It looks along its node's −Z.
#[derive(Clone, Debug)]
pub struct SceneCamera {
    /// Name of the camera, or of its node.
    pub name: String,
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// Projection of the camera.
    pub lens: Lens,
}

/// Projection of a camera, as in glTF; lengths in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "glTF's own names")]
pub enum Lens {
    Perspective {
        yfov: f64,
        aspect: Option<f64>,
        znear: f64,
        zfar: Option<f64>,
    },
    /// Orthographic projection; `xmag` and `ymag` are half widths.
    Orthographic {
        xmag: f64,
        ymag: f64,
        znear: f64,
        zfar: f64,
    },
}

/// A light of the scene (KHR_lights_punctual). It shines along its node's −Z.
#[derive(Clone, Debug)]
pub struct SceneLight {
    /// Name of the light, or of its node.
    pub name: String,
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// Kind of the light.
    pub kind: LightKind,
    /// Colour in linear RGB.
    pub color: [f32; 3],
    /// Intensity in lux or candela, as in glTF.
    pub intensity: f32,
    /// Range in metres; `None` is unlimited.
    pub range: Option<f64>,
}

/// Kind of a light, as in KHR_lights_punctual; angles in radians from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "glTF's own names")]
pub enum LightKind {
    Directional,
    Point,
    Spot { inner: f64, outer: f64 },
}

/// A skeleton for skinning.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Indices of the joints in [`Scene::nodes`].
    pub joints: Vec<usize>,
    /// Inverse bind matrix of each joint: bind space from mesh space.
    pub inverse_bind: Vec<Mat4>,
}

/// An animation clip.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// Name, for messages.
    pub name: String,
    /// Animated properties of nodes.
    pub channels: Vec<Channel>,
    /// Seconds until the clip starts again: the time of the last key of all channels.
    pub duration: f64,
}

/// One animated property of one node.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// Key times in seconds, rising.
    pub times: Vec<f32>,
    /// Key values.
    pub values: Keys,
    /// Interpolation between keys.
    pub interpolation: Interpolation,
}

/// Values of the keys of a channel. Cubic splines hold in-tangent, value and out-tangent per key.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the properties of a node")]
pub enum Keys {
    Translation(Vec<[f32; 3]>),
    Rotation(Vec<[f32; 4]>),
    Scale(Vec<[f32; 3]>),
    /// Weights of morph targets, `per_key` for each key or tangent.
    Weights {
        per_key: usize,
        values: Vec<f32>,
    },
}

impl Keys {
    /// Returns the number of values: one per key, three for cubic splines.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Translation(keys) | Self::Scale(keys) => keys.len(),
            Self::Rotation(keys) => keys.len(),
            Self::Weights { per_key, values } => values.len().checked_div(*per_key).unwrap_or(0),
        }
    }
}

/// Interpolation between keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(missing_docs, reason = "glTF's own names")]
pub enum Interpolation {
    #[default]
    Linear,
    Step,
    CubicSpline,
}

/// The scene at one moment, for renderers and rays.
#[derive(Clone, Debug, Default)]
pub struct Pose {
    /// Objects: one per mesh node, or per instance of one, in node order and then instance order.
    /// Nodes without triangles are left out.
    pub objects: Vec<Object>,
    /// World transform of every node.
    pub world_from_node: Vec<DAffine3>,
    /// Vertices of skinned and morphed objects; see [`Object::skinned`].
    pub skinned: Vec<SkinnedMesh>,
    /// Bounding box of all objects; `None` if there are none.
    pub bounds: Option<Aabb>,
}

/// A placed mesh, which is the unit of casting, receiving and culling.
#[derive(Clone, Debug)]
pub struct Object {
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// Index into [`Node::instances`] if the node has some.
    pub instance: Option<u32>,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// World transform of the vertices: those of the mesh, or those of [`Object::skinned`].
    pub world_from_local: DAffine3,
    /// Index into [`Pose::skinned`], whose vertices replace the mesh's. Instances share an entry.
    pub skinned: Option<usize>,
    /// Exact bounding box of the vertices in the world.
    pub bounds: Aabb,
    /// True if the object casts shadows: the node does, and some primitive is not
    /// [`AlphaMode::Blend`].
    pub casts: bool,
}

/// Vertices of a skinned or morphed mesh at one moment, with one entry per primitive of the mesh.
#[derive(Clone, Debug, Default)]
pub struct SkinnedMesh {
    /// World point that skinned positions are relative to; zero for a mesh that is only morphed,
    /// which its node places.
    pub origin: DVec3,
    /// Positions in metres, per primitive, in the space that [`Object::world_from_local`] places.
    pub positions: Vec<Vec<[f32; 3]>>,
    /// Unit normals, per primitive.
    pub normals: Vec<Vec<[f32; 3]>>,
}
