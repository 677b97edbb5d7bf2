//! The scene as all other crates see it: meshes, materials, nodes, cameras, lights; no file format,
//! no GPU.

use std::collections::BTreeMap;

use glam::{DAffine3, DQuat, DVec3, Mat4};
use umbrage::Aabb;

/// A scene: geometry that is stored once and nodes that place it. Right-handed, +Y up, metres.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// For messages: the file's or world's name.
    pub name: String,
    /// Stored geometry.
    pub meshes: Vec<Mesh>,
    /// By mesh, coarser shapes of what it shows, the finest of them first.
    pub levels: BTreeMap<usize, Vec<DetailLevel>>,
    /// Never empty once loaded if there is a primitive: primitives without a material point at a
    /// default one.
    pub materials: Vec<Material>,
    /// Pictures that materials refer to.
    pub textures: Vec<Texture>,
    /// The hierarchy; a parent comes before its children.
    pub nodes: Vec<Node>,
    /// Cameras, placed by their nodes.
    pub cameras: Vec<SceneCamera>,
    /// Lights, placed by their nodes; each shines along its node's −Z.
    pub lights: Vec<SceneLight>,
    /// Skeletons.
    pub skins: Vec<Skin>,
    /// Clips. A pose plays clip 0 and every later clip whose nodes no earlier clip moves, each in a
    /// loop.
    pub animations: Vec<Animation>,
    /// What was left out or invented while loading, for the report.
    pub notes: Vec<String>,
}

/// Geometry that nodes place.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// For messages.
    pub name: String,
    /// One draw each.
    pub primitives: Vec<Primitive>,
    /// How far each morph target of the primitives is applied where no node says otherwise; 0 where
    /// it is shorter.
    pub weights: Vec<f32>,
}

impl Mesh {
    /// Whether some primitive has morph targets, so that its vertices are posed.
    #[must_use]
    pub fn is_morphed(&self) -> bool {
        self.primitives.iter().any(|primitive| !primitive.targets.is_empty())
    }
}

/// A coarser shape of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DetailLevel {
    /// Index into [`Scene::meshes`]; neither skinned nor morphed.
    pub mesh: usize,
    /// Metres, in the mesh's own space, of the smallest detail that it shows.
    pub detail_m: f64,
}

impl Scene {
    /// The coarsest shape of a mesh that shows details of so many metres of the mesh's own space.
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
    /// Unit normals, one per position; a loader computes flat ones (splitting vertices) where the
    /// file has none.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates of the base colour (KHR_texture_transform already applied); empty if
    /// there are none.
    pub uvs: Vec<[f32; 2]>,
    /// Linear RGB(A) vertex colours, multiplied into the base colour; empty if there are none.
    pub colors: Vec<[f32; 4]>,
    /// Three per triangle.
    pub indices: Vec<u32>,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Four joints per vertex as indices into the skin; empty if not skinned.
    pub joints: Vec<[u16; 4]>,
    /// Their weights; sum 1.
    pub weights: Vec<[f32; 4]>,
    /// Shapes that a weight each blends into the base shape; the primitives of a mesh share the
    /// weights.
    pub targets: Vec<MorphTarget>,
    /// Whether a posed shape takes its normals from its triangles, because the file has none. No
    /// two triangles then share a vertex if there are morph targets.
    pub flat: bool,
}

/// Differences to the base shape: vertex + weight · difference (glTF 2.0 specification, section
/// 3.7.2.2).
#[derive(Clone, Debug, Default)]
pub struct MorphTarget {
    /// Metres, one per vertex; empty if no vertex moves.
    pub positions: Vec<[f32; 3]>,
    /// Differences of normals, one per vertex; empty if no normal turns.
    pub normals: Vec<[f32; 3]>,
}

/// How alpha is used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    Opaque,
    /// A surface where alpha ≥ cutoff, nothing elsewhere, for the eye and for shadows.
    Mask {
        /// Least alpha that counts.
        cutoff: f32,
    },
    /// Translucent: drawn over the rest, casts no shadow, hides nothing.
    Blend,
}

/// A surface.
#[derive(Clone, Debug)]
pub struct Material {
    /// For messages.
    pub name: String,
    /// Linear RGBA, multiplied with the texture.
    pub base_color: [f32; 4],
    /// Index into [`Scene::textures`].
    pub base_color_texture: Option<usize>,
    /// How alpha is used.
    pub alpha: AlphaMode,
    /// Seen from behind too. Shadows are cast by both sides always.
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

/// What happens outside `\[0,1\]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// Starts again.
    #[default]
    Repeat,
    /// Stays at the border.
    Clamp,
    /// Runs back.
    Mirror,
}

/// What lies between texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum TextureFilter {
    /// A bilinear mix of the four nearest.
    #[default]
    Linear,
    /// The nearest texel.
    Nearest,
}

/// A picture, 8-bit sRGB colour and linear alpha, row 0 on top.
#[derive(Clone, Debug)]
pub struct Texture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Four bytes per pixel.
    pub rgba: Vec<u8>,
    /// Addressing of u and v.
    pub wrap: [Wrap; 2],
    /// What magnified texels look like, for colour and for alpha masks.
    pub filter: TextureFilter,
}

/// A place in the hierarchy.
#[derive(Clone, Debug)]
pub struct Node {
    /// For messages, and to choose cameras and lights by.
    pub name: String,
    /// Index of a node before this one.
    pub parent: Option<usize>,
    /// Where it stands relative to its parent, when nothing moves it.
    pub local: Trs,
    /// What it shows.
    pub mesh: Option<usize>,
    /// Index into [`Scene::skins`]; the mesh is then placed by the joints alone.
    pub skin: Option<usize>,
    /// EXT_mesh_gpu_instancing: the mesh once per entry, relative to the node. Empty: once, at the
    /// node.
    pub instances: Vec<Trs>,
    /// How far each morph target of the mesh is applied, instead of [`Mesh::weights`]; empty: as
    /// the mesh says.
    pub weights: Vec<f32>,
    /// Whether the mesh casts shadows (`extras.castShadow`, true unless it says false).
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

/// Translation, rotation, scale: parent_from_local = T R S.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the fields are what the name says")]
pub struct Trs {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl Trs {
    /// Stays where it is.
    pub const IDENTITY: Self = Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE };

    /// As a transform.
    #[must_use]
    pub fn to_affine(self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// A camera of the scene. It looks along its node's −Z.
#[derive(Clone, Debug)]
pub struct SceneCamera {
    /// The camera's name, or its node's.
    pub name: String,
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// What it sees.
    pub lens: Lens,
}

/// glTF's two projections; lengths in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "glTF's own names")]
pub enum Lens {
    Perspective {
        yfov: f64,
        aspect: Option<f64>,
        znear: f64,
        zfar: Option<f64>,
    },
    /// `xmag` and `ymag` are half widths.
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
    /// The light's name, or its node's.
    pub name: String,
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// What sort.
    pub kind: LightKind,
    /// Linear RGB.
    pub color: [f32; 3],
    /// Lux or candela, as glTF has it.
    pub intensity: f32,
    /// Metres; `None` is unlimited.
    pub range: Option<f64>,
}

/// The three kinds of KHR_lights_punctual; angles in radians from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "glTF's own names")]
pub enum LightKind {
    Directional,
    Point,
    Spot { inner: f64, outer: f64 },
}

/// A skeleton.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Indices into [`Scene::nodes`].
    pub joints: Vec<usize>,
    /// bind space from mesh space, one per joint.
    pub inverse_bind: Vec<Mat4>,
}

/// A clip.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// For messages.
    pub name: String,
    /// What it moves.
    pub channels: Vec<Channel>,
    /// Seconds until it starts again: the last key of all channels.
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
    /// Between keys.
    pub interpolation: Interpolation,
}

/// The keys of a channel; cubic splines hold in-tangent, value, out-tangent per key.
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
    /// How many values there are: one per key, three for cubic splines.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Translation(keys) | Self::Scale(keys) => keys.len(),
            Self::Rotation(keys) => keys.len(),
            Self::Weights { per_key, values } => values.len().checked_div(*per_key).unwrap_or(0),
        }
    }
}

/// Between keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(missing_docs, reason = "glTF's own names")]
pub enum Interpolation {
    #[default]
    Linear,
    Step,
    CubicSpline,
}

/// The scene at one moment: what a renderer draws and a ray meets.
#[derive(Clone, Debug, Default)]
pub struct Pose {
    /// One per mesh node, or per instance of one, in node order then instance order; nodes without
    /// triangles are left out.
    pub objects: Vec<Object>,
    /// World transform of every node.
    pub world_from_node: Vec<DAffine3>,
    /// Vertices of skinned and morphed objects, see [`Object::skinned`].
    pub skinned: Vec<SkinnedMesh>,
    /// Around all objects; `None` if there are none.
    pub bounds: Option<Aabb>,
}

/// A placed mesh: the unit of casting, receiving and culling.
#[derive(Clone, Debug)]
pub struct Object {
    /// Index into [`Scene::nodes`].
    pub node: usize,
    /// Index into [`Node::instances`] if the node has some.
    pub instance: Option<u32>,
    /// Index into [`Scene::meshes`].
    pub mesh: usize,
    /// Places the vertices: those of the mesh, or those of [`Object::skinned`].
    pub world_from_local: DAffine3,
    /// Index into [`Pose::skinned`], whose vertices take the place of the mesh's; instances share
    /// an entry.
    pub skinned: Option<usize>,
    /// Exact world bounds of the vertices.
    pub bounds: Aabb,
    /// Whether it casts shadows: the node says so and some primitive is not [`AlphaMode::Blend`].
    pub casts: bool,
}

/// Vertices of a skinned or morphed mesh at one moment, one entry per primitive of the mesh.
#[derive(Clone, Debug, Default)]
pub struct SkinnedMesh {
    /// The world point that skinned positions are relative to; zero where a node places what is
    /// only morphed.
    pub origin: DVec3,
    /// Positions in metres, per primitive, in the space that [`Object::world_from_local`] places.
    pub positions: Vec<Vec<[f32; 3]>>,
    /// Unit normals, per primitive.
    pub normals: Vec<Vec<[f32; 3]>>,
}
