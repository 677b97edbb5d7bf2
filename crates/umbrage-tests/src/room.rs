//! A room with lamps, for tests of local lights.
//!
//! Walls, floor and ceiling are boxes of 20 cm around 9 × 3 × 7 m. A pendant lamp hangs over a
//! table with stools; a spot light looks from under a shelf across a slatted screen, with boxes
//! behind it; a washer shines down a wall that it nearly touches.

use umbrage_scene::{Lens, LightKind, Material, Mesh, Node, Primitive, Scene, SceneCamera, SceneLight, Trs};

/// Corner of a box, in metres.
pub(crate) type Corner = [f32; 3];

/// Colours in linear RGB.
const PLASTER: [f32; 3] = [0.75, 0.72, 0.66];
const FLOOR: [f32; 3] = [0.36, 0.24, 0.15];
const WOOD: [f32; 3] = [0.48, 0.30, 0.16];
const BLUE: [f32; 3] = [0.16, 0.28, 0.48];
const RED: [f32; 3] = [0.55, 0.14, 0.10];

/// Makes the room. Cameras: `door`, `table`, `wall`. Lights: `pendant` (point), `reading` and
/// `washer` (spot).
#[must_use]
pub fn room() -> Scene {
    let mut scene = Scene { name: "room".to_owned(), ..Scene::default() };
    let materials = [PLASTER, FLOOR, WOOD, BLUE, RED].map(|color| material(&mut scene, color));
    let [plaster, floor, wood, blue, red] = materials;
    let mut add = |name: &str, material: usize, boxes: &[(Corner, Corner)]| {
        let mut primitive = Primitive { material, ..Primitive::default() };
        boxes.iter().for_each(|&(min, max)| cuboid(&mut primitive, min, max));
        place(&mut scene, name, primitive);
    };
    add("floor", floor, &[([-4.7, -0.2, -3.7], [4.7, 0.0, 3.7])]);
    add("ceiling", plaster, &[([-4.7, 3.0, -3.7], [4.7, 3.2, 3.7])]);
    add("wall west", plaster, &[([-4.7, 0.0, -3.7], [-4.5, 3.0, 3.7])]);
    add("wall east", plaster, &[([4.5, 0.0, -3.7], [4.7, 3.0, 3.7])]);
    add("wall north", plaster, &[([-4.5, 0.0, -3.7], [4.5, 3.0, -3.5])]);
    add("wall south", plaster, &[([-4.5, 0.0, 3.5], [4.5, 3.0, 3.7])]);
    add("table", wood, &table([0.0, 0.0], [1.8, 0.9], 0.76, 0.05));
    for (i, [x, z]) in [[-0.7, 0.85], [0.6, 0.8], [-0.1, -0.95], [1.4, -0.2]].into_iter().enumerate() {
        add(&format!("stool {i}"), red, &table([x, z], [0.4, 0.4], 0.46, 0.04));
    }
    add("bowl", blue, &[([-0.15, 0.76, -0.1], [0.15, 0.88, 0.2])]);
    let shelves = (0..5).map(|i| ([-4.5, 0.3 + 0.5 * i as f32, -3.0], [-4.1, 0.34 + 0.5 * i as f32, -0.6]));
    add(
        "shelf",
        wood,
        &shelves
            .chain([([-4.5, 0.0, -3.05], [-4.1, 2.5, -3.0]), ([-4.5, 0.0, -0.6], [-4.1, 2.5, -0.55])])
            .collect::<Vec<_>>(),
    );
    let books = (0..14).map(|i| {
        let z = -2.95 + 0.16 * i as f32;
        let (shelf, height) = ((i * 3) % 5, 0.2 + 0.02 * ((i * 7) % 9) as f32);
        let y = 0.34 + 0.5 * shelf as f32;
        ([-4.45, y, z], [-4.2, y + height.min(0.42), z + 0.06])
    });
    add("books", blue, &books.collect::<Vec<_>>());
    let slats = (0..16).map(|i| ([2.2, 0.05, -2.6 + 0.12 * i as f32], [2.24, 1.8, -2.55 + 0.12 * i as f32]));
    add("screen", wood, &slats.chain([([2.18, 1.8, -2.65], [2.26, 1.86, -0.7])]).collect::<Vec<_>>());
    add("pillar", plaster, &[([2.6, 0.0, 1.6], [3.0, 3.0, 2.0])]);
    add("pictures", blue, &[([-1.4, 1.2, 3.46], [-0.5, 1.9, 3.5]), ([0.4, 1.0, 3.46], [1.4, 1.7, 3.5])]);
    // Under the ceiling over the pendant, which shines on it from below.
    add("rose", wood, &[([-0.25, 2.92, -0.25], [0.25, 3.0, 0.25])]);

    light(&mut scene, "pendant", [0.0, 2.1, 0.0], None, LightKind::Point, 14.0);
    let reading = LightKind::Spot { inner: 0.35, outer: 0.6 };
    light(&mut scene, "reading", [-3.6, 2.2, -1.8], Some([1.0, -0.22, 0.08]), reading, 12.0);
    let washer = LightKind::Spot { inner: 0.5, outer: 0.9 };
    light(&mut scene, "washer", [0.0, 2.8, 3.38], Some([0.0, -1.0, 0.1]), washer, 6.0);
    camera(&mut scene, "door", [-4.1, 1.75, 3.1], [1.0, -0.25, -0.9]);
    camera(&mut scene, "table", [1.9, 1.6, 1.7], [-1.0, -0.55, -0.9]);
    camera(&mut scene, "wall", [-1.8, 1.5, 0.9], [0.6, -0.08, 1.0]);
    scene
}

pub(crate) fn material(scene: &mut Scene, [r, g, b]: [f32; 3]) -> usize {
    scene.materials.push(Material { base_color: [r, g, b, 1.0], ..Material::default() });
    scene.materials.len() - 1
}

pub(crate) fn place(scene: &mut Scene, name: &str, primitive: Primitive) {
    scene.nodes.push(Node { name: name.to_owned(), mesh: Some(scene.meshes.len()), ..Node::default() });
    scene.meshes.push(Mesh { name: name.to_owned(), primitives: vec![primitive], ..Mesh::default() });
}

/// A board on four legs.
fn table([x, z]: [f32; 2], [width, depth]: [f32; 2], height: f32, leg: f32) -> Vec<(Corner, Corner)> {
    let (w, d) = (0.5 * width, 0.5 * depth);
    let mut boxes = vec![([x - w, height - 0.04, z - d], [x + w, height, z + d])];
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
        let (cx, cz) = (x + sx * (w - leg), z + sz * (d - leg));
        boxes.push(([cx - 0.5 * leg, 0.0, cz - 0.5 * leg], [cx + 0.5 * leg, height - 0.04, cz + 0.5 * leg]));
    }
    boxes
}

/// Adds a box with faces of its own.
pub(crate) fn cuboid(primitive: &mut Primitive, min: Corner, max: Corner) {
    const FACES: [[usize; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    const NORMALS: [[f32; 3]; 6] =
        [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
    for (face, normal) in FACES.iter().zip(NORMALS) {
        let first = primitive.positions.len() as u32;
        for &corner in face {
            primitive.positions.push(std::array::from_fn(|k| if corner >> k & 1 == 0 { min[k] } else { max[k] }));
            primitive.normals.push(normal);
        }
        primitive.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
    }
}

/// Makes the transform of an object at `translation` whose −Z points along `along`.
fn looking(translation: Corner, along: Corner) -> Trs {
    let [x, y, z] = along.map(f64::from);
    // Turned about Y, then raised: the rotation of a tripod's head.
    let (yaw, pitch) = ((-x).atan2(-z), y.atan2(x.hypot(z)));
    let ((sy, cy), (sp, cp)) = ((0.5 * yaw).sin_cos(), (0.5 * pitch).sin_cos());
    let mut trs = Trs::IDENTITY;
    trs.translation = translation.map(f64::from).into();
    [trs.rotation.x, trs.rotation.y, trs.rotation.z, trs.rotation.w] = [cy * sp, sy * cp, -sy * sp, cy * cp];
    trs
}

fn light(scene: &mut Scene, name: &str, at: Corner, along: Option<Corner>, kind: LightKind, range: f64) {
    let local = looking(at, along.unwrap_or([0.0, 0.0, -1.0]));
    scene.nodes.push(Node { name: name.to_owned(), local, ..Node::default() });
    let node = scene.nodes.len() - 1;
    let color = [1.0, 0.92, 0.8];
    scene.lights.push(SceneLight { name: name.to_owned(), node, kind, color, intensity: 100.0, range: Some(range) });
}

fn camera(scene: &mut Scene, name: &str, at: Corner, along: Corner) {
    scene.nodes.push(Node { name: name.to_owned(), local: looking(at, along), ..Node::default() });
    let lens = Lens::Perspective { yfov: 1.15, aspect: None, znear: 0.1, zfar: Some(40.0) };
    scene.cameras.push(SceneCamera { name: name.to_owned(), node: scene.nodes.len() - 1, lens });
}
