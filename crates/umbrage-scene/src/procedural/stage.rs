//! Tools that all worlds share: materials by colour, nodes, cameras, the moving sun, clips, and
//! scattered places.

use glam::{DVec2, DVec3};

use super::maths::{Random, looking_along, sin_cos};
use crate::{
    Animation, Channel, Interpolation, Keys, Lens, LightKind, Material, Mesh, Node, Scene, SceneCamera, SceneLight, Trs,
};

/// A scene under construction.
pub(super) struct Stage {
    pub(super) scene: Scene,
    near_far: (f64, f64),
}

impl Stage {
    pub(super) fn new(name: &str, near_far: (f64, f64)) -> Self {
        Self { scene: Scene { name: name.to_owned(), ..Scene::default() }, near_far }
    }

    /// Adds a matte material of an sRGB colour, `0xRRGGBB`.
    pub(super) fn paint(&mut self, name: &str, srgb: u32) -> usize {
        let linear = |shift: u32| {
            let value = f64::from((srgb >> shift) & 0xFF) / 255.0;
            let linear = if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) };
            linear as f32
        };
        let base_color = [linear(16), linear(8), linear(0), 1.0];
        self.material(Material { name: name.to_owned(), base_color, ..Material::default() })
    }

    pub(super) fn material(&mut self, material: Material) -> usize {
        self.scene.materials.push(material);
        self.scene.materials.len() - 1
    }

    pub(super) fn mesh(&mut self, mesh: Mesh) -> usize {
        self.scene.meshes.push(mesh);
        self.scene.meshes.len() - 1
    }

    /// Adds a node that shows a mesh.
    pub(super) fn place(&mut self, name: String, mesh: usize, local: Trs) -> usize {
        self.node(Node { name, mesh: Some(mesh), local, ..Node::default() })
    }

    pub(super) fn node(&mut self, node: Node) -> usize {
        self.scene.nodes.push(node);
        self.scene.nodes.len() - 1
    }

    /// Adds a camera with the paper's lens, 60° from bottom to top.
    pub(super) fn camera(&mut self, name: &str, eye: DVec3, target: DVec3) {
        let local = Trs { translation: eye, rotation: looking_along(target - eye), ..Trs::IDENTITY };
        let node = self.node(Node { name: name.to_owned(), local, ..Node::default() });
        let (znear, zfar) = self.near_far;
        let lens = Lens::Perspective { yfov: 60_f64.to_radians(), aspect: None, znear, zfar: Some(zfar) };
        self.scene.cameras.push(SceneCamera { name: name.to_owned(), node, lens });
    }

    /// Adds the sun. At time 0 it stands at `start`; in two minutes it goes to `noon` and back,
    /// over a great circle at an even pace but for a rest at either end.
    pub(super) fn sun(&mut self, start: SkyPoint, noon: SkyPoint) {
        const KEYS: usize = 97;
        const PERIOD_S: f64 = 120.0;
        let rotation_at = |share: f64| {
            let swing = 0.5 - 0.5 * sin_cos(360.0 * share).1;
            let at = |from: f64, to: f64| from + (to - from) * swing;
            let place =
                SkyPoint { bearing: at(start.bearing, noon.bearing), elevation: at(start.elevation, noon.elevation) };
            looking_along(-place.direction())
        };
        let local = Trs { rotation: rotation_at(0.0), translation: DVec3::Y * 400.0, ..Trs::IDENTITY };
        let node = self.node(Node { name: "sun".to_owned(), local, ..Node::default() });
        self.scene.lights.push(SceneLight {
            name: "sun".to_owned(),
            node,
            kind: LightKind::Directional,
            color: [1.0, 0.96, 0.9],
            intensity: 3.0,
            range: None,
        });
        let share = |key: usize| key as f64 / (KEYS - 1) as f64;
        let rotations = (0..KEYS).map(|key| rotation_at(share(key)).as_quat().to_array()).collect();
        let times = (0..KEYS).map(|key| (PERIOD_S * share(key)) as f32).collect();
        self.clip(
            "sun",
            vec![Channel { node, times, values: Keys::Rotation(rotations), interpolation: Interpolation::Linear }],
        );
    }

    /// Adds a clip that plays in a loop beside all others.
    pub(super) fn clip(&mut self, name: &str, channels: Vec<Channel>) {
        let last = |channel: &Channel| channel.times.last().copied().unwrap_or(0.0);
        let duration = f64::from(channels.iter().map(last).fold(0.0, f32::max));
        self.scene.animations.push(Animation { name: name.to_owned(), channels, duration });
    }
}

/// A place on the sky: degrees, the bearing counter-clockwise from +X seen from above (−Z is 90°).
#[derive(Clone, Copy, Debug)]
pub(super) struct SkyPoint {
    pub(super) bearing: f64,
    pub(super) elevation: f64,
}

impl SkyPoint {
    /// Returns the unit vector from the ground towards the point.
    pub(super) fn direction(self) -> DVec3 {
        let ((sin_b, cos_b), (sin_e, cos_e)) = (sin_cos(self.bearing), sin_cos(self.elevation));
        DVec3::new(cos_e * cos_b, sin_e, -cos_e * sin_b)
    }
}

/// Chooses places on a square of the ground (x, z) around the origin, such that circles of the
/// given radii around them stay apart and inside. Larger circles should come first. Places that
/// `fits` refuses stay free.
pub(super) fn scatter(random: &mut Random, edge: f64, radii: &[f64], fits: impl Fn(DVec2) -> bool) -> Vec<DVec2> {
    const TRIES: usize = 100_000;
    let mut places: Vec<DVec2> = Vec::new();
    for &radius in radii {
        let reach = 0.5 * edge - radius;
        let free = (0..TRIES).map(|_| DVec2::new(random.between(-reach, reach), random.between(-reach, reach))).find(
            |&place| {
                let apart = |(other, other_radius): (&DVec2, &f64)| place.distance(*other) > radius + other_radius;
                fits(place) && places.iter().zip(radii).all(apart)
            },
        );
        places.push(free.expect("a world has room for what is scattered over it"));
    }
    places
}
