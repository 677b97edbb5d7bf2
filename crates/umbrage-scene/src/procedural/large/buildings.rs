//! Buildings that are drawn by the hundred thousand: walls with pictures of their windows, roofs
//! with objects on them, and coarser levels of detail without.

use glam::{DVec3, dvec3};

use super::super::maths::{Random, mix, scramble, unit};
use super::super::sculpt::Sculpture;
use super::super::shapes::Solid;
use super::super::stage::Stage;
use super::Levels;
use crate::{Material, Mesh, Primitive, Texture, TextureFilter, Wrap};

/// Height of a storey, and width of a window's share of a wall, in metres: one picture of a facade.
pub(super) const STOREY_M: f64 = 3.3;

/// Size in metres of the smallest detail of each level, finest first: parapets and tanks, setbacks,
/// a box.
const DETAILS_M: [f64; 3] = [0.0, 1.2, 4.0];

/// Style of a building.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    /// Three or four storeys under a gable.
    House,
    /// About six storeys, flat, with a water tank.
    Apartments,
    /// A slab of offices.
    Office,
    /// A tower that steps back.
    Tower,
    /// A tower of glass.
    Glass,
}

/// A kind of building. All buildings of a kind share meshes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    pub(super) style: Style,
    /// Metres along the street and across the lot.
    pub(super) size: [f64; 2],
    storeys: u32,
    facade: Facade,
    roof: u32,
}

/// A picture of a wall: its colours, and the share of it that is window.
#[derive(Clone, Copy, Debug)]
struct Facade {
    wall: u32,
    window: u32,
    /// Shares of a storey's width and height that the window takes.
    opening: [f64; 2],
}

const fn kind(style: Style, size: [f64; 2], storeys: u32, (wall, window): (u32, u32), roof: u32) -> Kind {
    let opening = match style {
        Style::House => [0.34, 0.5],
        Style::Apartments => [0.42, 0.52],
        Style::Office => [0.9, 0.46],
        Style::Tower => [0.5, 0.66],
        Style::Glass => [0.94, 0.86],
    };
    Kind { style, size, storeys, facade: Facade { wall, window, opening }, roof }
}

/// Kinds of buildings.
pub(super) const KINDS: [Kind; 16] = [
    kind(Style::House, [9.9, 13.2], 3, (0x9A_5B_46, 0x3A_42_4A), 0x5A_46_40),
    kind(Style::House, [9.9, 13.2], 3, (0xC9_B9_9A, 0x46_4A_4C), 0x7C_4A_3A),
    kind(Style::House, [13.2, 13.2], 4, (0xB8_8A_66, 0x3C_42_48), 0x50_4C_4A),
    kind(Style::House, [9.9, 16.5], 3, (0xD8_D2_C4, 0x4A_50_54), 0x8A_55_40),
    kind(Style::Apartments, [16.5, 19.8], 6, (0x8E_55_42, 0x34_3C_46), 0x6E_6A_66),
    kind(Style::Apartments, [19.8, 23.1], 7, (0xBF_A4_82, 0x38_40_48), 0x86_80_78),
    kind(Style::Apartments, [16.5, 23.1], 5, (0xD2_C8_B6, 0x44_4C_54), 0x75_70_6A),
    kind(Style::Apartments, [26.4, 19.8], 8, (0xA8_7A_60, 0x36_3E_48), 0x68_64_60),
    kind(Style::Office, [29.7, 26.4], 11, (0xC4_C0_B8, 0x2E_3A_48), 0x80_7C_78),
    kind(Style::Office, [33.0, 23.1], 14, (0x9C_8E_80, 0x30_3A_46), 0x74_70_6C),
    kind(Style::Office, [26.4, 26.4], 17, (0xDA_D6_CE, 0x3A_48_58), 0x8A_86_80),
    kind(Style::Tower, [29.7, 29.7], 24, (0xC8_B4_96, 0x34_3C_46), 0x7A_72_68),
    kind(Style::Tower, [33.0, 29.7], 32, (0xB4_A8_9C, 0x30_38_42), 0x70_6C_68),
    kind(Style::Tower, [29.7, 26.4], 40, (0xD4_CA_BA, 0x3A_42_4C), 0x82_7C_74),
    kind(Style::Glass, [33.0, 33.0], 44, (0x6E_7C_86, 0x4A_66_7C), 0x60_64_68),
    kind(Style::Glass, [29.7, 29.7], 34, (0x86_8E_92, 0x54_6C_70), 0x66_68_6A),
];

/// Iterates over the kinds of a style.
pub(super) fn of_style(style: Style) -> impl Iterator<Item = usize> {
    (0..KINDS.len()).filter(move |&kind| KINDS[kind].style == style)
}

/// Materials of one kind.
#[derive(Clone, Copy)]
struct Paints {
    walls: usize,
    roof: usize,
    trim: usize,
}

/// Stores a kind's meshes and returns the index of the finest.
pub(super) fn store(stage: &mut Stage, index: usize) -> usize {
    let kind = KINDS[index];
    stage.scene.textures.push(facade_picture(kind.facade, index as u64));
    let texture = stage.scene.textures.len() - 1;
    let walls = stage.material(Material {
        name: format!("facade {index}"),
        base_color_texture: Some(texture),
        ..Material::default()
    });
    let roof = stage.paint(&format!("roof {index}"), kind.roof);
    let trim = stage.paint(&format!("trim {index}"), kind.facade.wall);
    let paints = Paints { walls, roof, trim };
    let shape = |(level, detail_m): (usize, f64)| (building(index, level, paints), detail_m);
    Levels(DETAILS_M.into_iter().enumerate().map(shape).collect()).store(stage)
}

/// Walls and roofs under construction.
struct Builder {
    walls: Primitive,
    rest: Sculpture,
    paints: Paints,
}

/// A part of a building: its middle, half its size, and its lower and upper height.
#[derive(Clone, Copy)]
struct Block {
    middle: [f64; 2],
    half: [f64; 2],
    from: f64,
    to: f64,
}

impl Builder {
    fn new(paints: Paints) -> Self {
        Self { walls: Primitive { material: paints.walls, ..Primitive::default() }, rest: Sculpture::default(), paints }
    }

    /// Adds four walls, whose pictures repeat for each storey.
    fn walls(&mut self, block: Block) {
        let [x, z] = block.middle;
        let [half_x, half_z] = block.half;
        let corners = [[-half_x, half_z], [half_x, half_z], [half_x, -half_z], [-half_x, -half_z]];
        for side in 0..4 {
            let ([ax, az], [bx, bz]) = (corners[side], corners[(side + 1) % 4]);
            let along = dvec3(bx - ax, 0.0, bz - az);
            let across = (along.length() / STOREY_M).round().max(1.0) as f32;
            let normal = along.cross(DVec3::NEG_Y).normalize().as_vec3().to_array();
            let first = self.walls.positions.len() as u32;
            for (dx, dz, u) in [(ax, az, 0.0), (bx, bz, across)] {
                for y in [block.from, block.to] {
                    self.walls.positions.push(dvec3(x + dx, y, z + dz).as_vec3().to_array());
                    self.walls.normals.push(normal);
                    self.walls.uvs.push([u, -(y / STOREY_M) as f32]);
                }
            }
            self.walls.indices.extend([0, 2, 3, 0, 3, 1].map(|i| first + i));
        }
    }

    /// Adds a closed box that is no wall.
    fn solid(&mut self, material: usize, block: Block) {
        let [x, z] = block.middle;
        let size = [2.0 * block.half[0], block.to - block.from, 2.0 * block.half[1]];
        let solid = Solid::cuboid(size).at(x, 0.5 * (block.from + block.to), z);
        self.rest.add(material, 30.0, &solid);
    }

    /// Adds walls and a flat roof, with a parapet where `lip` is not 0.
    fn block(&mut self, block: Block, lip: f64) {
        self.walls(block);
        let roof = Block { from: block.to - 0.4, half: block.half.map(|half| half - 0.02), ..block };
        self.solid(self.paints.roof, roof);
        if lip <= 0.0 {
            return;
        }
        let [x, z] = block.middle;
        let [half_x, half_z] = block.half;
        let thick = 0.18;
        for side in [-1.0, 1.0] {
            let (from, to) = (block.to - 0.5, block.to + lip);
            let trim = self.paints.trim;
            let along =
                Block { middle: [x, z + side * (half_z - thick)], half: [half_x + 0.12, thick + 0.1], from, to };
            let across =
                Block { middle: [x + side * (half_x - thick), z], half: [thick + 0.1, half_z - 2.0 * thick], from, to };
            self.solid(trim, along);
            self.solid(trim, across);
        }
    }

    /// Adds a gable along x.
    fn gable(&mut self, block: Block, rise: f64) {
        let [x, z] = block.middle;
        let [half_x, half_z] = block.half;
        let eaves = block.to - 0.1;
        let section = |at: f64| {
            vec![dvec3(at, eaves, z + half_z + 0.4), dvec3(at, eaves, z - half_z - 0.4), dvec3(at, eaves + rise, z)]
        };
        let ends = [section(x - half_x - 0.15), section(x + half_x + 0.15)];
        let roof = Solid::loft(super::super::shapes::End::Flat, &ends, super::super::shapes::End::Flat);
        self.rest.add(self.paints.roof, 30.0, &roof);
    }

    fn finish(self, name: &str) -> Mesh {
        let mut mesh = self.rest.finish(name);
        mesh.primitives.insert(0, self.walls);
        mesh
    }
}

/// Makes one level of detail of a kind, standing on y = 0 with its front towards +Z.
fn building(index: usize, level: usize, paints: Paints) -> Mesh {
    let kind = KINDS[index];
    let mut random = Random::new(900 + index as u64);
    let mut builder = Builder::new(paints);
    let high = STOREY_M * f64::from(kind.storeys);
    let half = kind.size.map(|size| 0.5 * size - 0.15);
    let whole = Block { middle: [0.0; 2], half, from: -0.5, to: high };
    let lip = if level == 0 { 0.9 } else { 0.0 };
    match kind.style {
        Style::House => {
            builder.walls(whole);
            builder.gable(whole, if level == 2 { 2.2 } else { 3.4 });
            if level == 0 {
                chimneys(&mut builder, whole);
            }
        }
        Style::Apartments | Style::Office => builder.block(whole, lip),
        Style::Tower if level < 2 => {
            let steps = [(0.0, 0.55, 1.0), (0.55, 0.84, 0.78), (0.84, 1.0, 0.52)];
            for (from, to, share) in steps {
                let from = if from == 0.0 { -0.5 } else { storey(high * from) };
                let block = Block { half: half.map(|half| share * half), from, to: storey(high * to), ..whole };
                builder.block(block, lip);
            }
            if level == 0 {
                let mast = Solid::cone(0.5, 0.06, 0.22 * high, 6).at(0.0, high, 0.0);
                builder.rest.add(paints.trim, 60.0, &mast);
            }
        }
        Style::Glass if level < 2 => {
            builder.block(Block { to: storey(0.93 * high), ..whole }, lip);
            let crown = Block { half: half.map(|half| 0.8 * half), from: storey(0.93 * high), to: high + 2.0, ..whole };
            builder.block(crown, 0.0);
            let podium = Block { half: half.map(|half| half + 0.1), to: 2.0 * STOREY_M, ..whole };
            builder.walls(podium);
            builder.solid(paints.trim, Block { from: podium.to - 0.3, to: podium.to, ..podium });
        }
        Style::Tower | Style::Glass => builder.block(Block { half: half.map(|half| 0.94 * half), ..whole }, 0.0),
    }
    if level == 0 && matches!(kind.style, Style::Apartments | Style::Office) {
        roof_things(&mut builder, &mut random, whole);
    }
    builder.finish(&format!("building {index}, shape {level}"))
}

/// Rounds a height to a whole number of storeys.
fn storey(height: f64) -> f64 {
    (height / STOREY_M).round() * STOREY_M
}

fn chimneys(builder: &mut Builder, whole: Block) {
    for side in [-1.0, 1.0] {
        let middle = [side * (whole.half[0] - 0.8), 0.35 * whole.half[1]];
        let trim = builder.paints.trim;
        builder.solid(trim, Block { middle, half: [0.45, 0.6], from: whole.to, to: whole.to + 4.2 });
    }
}

/// Adds a stair's head, machines, and on some a water tank on legs.
fn roof_things(builder: &mut Builder, random: &mut Random, whole: Block) {
    let roof = whole.to;
    let place =
        |random: &mut Random| [whole.half[0] * random.between(-0.6, 0.6), whole.half[1] * random.between(-0.6, 0.6)];
    let Paints { roof: grey, trim, .. } = builder.paints;
    builder.solid(trim, Block { middle: place(random), half: [2.0, 1.5], from: roof, to: roof + 2.8 });
    for _ in 0..3 {
        builder.solid(grey, Block { middle: place(random), half: [1.1, 0.8], from: roof, to: roof + 1.2 });
    }
    let [x, z] = place(random);
    for leg in 0..4 {
        let at = [x + if leg % 2 == 0 { -1.0 } else { 1.0 }, z + if leg < 2 { -1.0 } else { 1.0 }];
        builder.solid(grey, Block { middle: at, half: [0.12, 0.12], from: roof, to: roof + 3.0 });
    }
    let tank = Solid::lathe(&[[1.7, roof + 3.0], [1.7, roof + 6.2], [0.0, roof + 7.5]], 10).at(x, 0.0, z);
    builder.rest.add(trim, 40.0, &tank);
}

/// One window in its share of wall, 48 × 48 pixels, with a sill and a frame.
fn facade_picture(facade: Facade, seed: u64) -> Texture {
    const EDGE: u32 = 48;
    let parts = |colour: u32| [16, 8, 0].map(|shift| f64::from((colour >> shift) & 0xFF));
    let (wall, window) = (parts(facade.wall), parts(facade.window));
    let mut rgba = Vec::with_capacity((EDGE * EDGE * 4) as usize);
    for y in 0..EDGE {
        for x in 0..EDGE {
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(EDGE) - 0.5;
            let (u, v) = (at(x).abs() / (0.5 * facade.opening[0]), (at(y) + 0.03).abs() / (0.5 * facade.opening[1]));
            let grain = 0.95 + 0.1 * unit(scramble(seed << 20 | u64::from(y * EDGE + x)));
            let is_sill = u < 1.12 && at(y) > 0.5 * facade.opening[1] - 0.03 && at(y) < 0.5 * facade.opening[1] + 0.05;
            let colour = if u < 1.0 && v < 1.0 {
                let is_bar = at(x).abs() < 0.012 || u > 0.9 || v > 0.92;
                // The sky in the upper half.
                let sky = mix(0.85, 1.25, 0.5 - at(y));
                window.map(|channel| if is_bar { 0.5 * channel + 60.0 } else { sky * channel })
            } else if is_sill {
                wall.map(|channel| 1.12 * channel)
            } else {
                // A course of stone at each floor.
                let course = if at(y) > 0.46 { 0.9 } else { 1.0 };
                wall.map(|channel| course * grain * channel)
            };
            rgba.extend(colour.map(|channel| channel.clamp(0.0, 255.0) as u8));
            rgba.push(255);
        }
    }
    Texture { width: EDGE, height: EDGE, rgba, wrap: [Wrap::Repeat; 2], filter: TextureFilter::Linear }
}
