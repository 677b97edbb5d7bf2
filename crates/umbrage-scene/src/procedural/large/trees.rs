//! Trees that are drawn by the million, each with four levels of detail, down to eight triangles.

use glam::{DVec3, dvec3};

use super::super::maths::{Random, mix, scramble, sin_cos, smoothstep, unit};
use super::super::noise;
use super::super::sculpt::Sculpture;
use super::super::shapes::{End, Solid};
use super::super::stage::Stage;
use super::Levels;
use crate::Mesh;

/// Size in metres of the smallest detail of each level, finest first: boughs, clumps, tiers, the
/// crown.
const DETAILS_M: [f64; 4] = [0.0, 0.25, 0.8, 2.0];

/// Materials that all trees share.
#[derive(Clone, Copy)]
pub(in super::super) struct Paints {
    bark: usize,
    birch: usize,
    leaves: usize,
}

impl Paints {
    /// Adds the materials to the stage. Leaves take their colour from vertices.
    pub(in super::super) fn new(stage: &mut Stage) -> Self {
        Self {
            bark: stage.paint("bark", 0x5B_4A_3C),
            birch: stage.paint("birch bark", 0xCF_C9_BC),
            leaves: stage.paint("leaves", 0xFF_FF_FF),
        }
    }
}

/// Kinds of trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Tree {
    /// Dark, in tiers.
    Spruce,
    /// A bare trunk under an umbrella.
    Pine,
    /// Broad and round.
    Oak,
    /// Slender and light.
    Birch,
}

/// Linear colours of a crown, inside and outside.
type Greens = [[f64; 3]; 2];

impl Tree {
    /// Kinds of trees of the forest, with their seeds.
    pub(in super::super) const FOREST: [(Self, u64); 6] =
        [(Self::Spruce, 1), (Self::Spruce, 2), (Self::Pine, 3), (Self::Oak, 4), (Self::Oak, 5), (Self::Birch, 6)];

    fn greens(self, seed: u64) -> Greens {
        let light = mix(0.85, 1.15, unit(scramble(seed)));
        let [dark, bright] = match self {
            Self::Spruce => [[0.012, 0.026, 0.014], [0.055, 0.105, 0.045]],
            Self::Pine => [[0.020, 0.036, 0.014], [0.090, 0.140, 0.050]],
            Self::Oak => [[0.022, 0.040, 0.008], [0.120, 0.190, 0.034]],
            Self::Birch => [[0.050, 0.070, 0.010], [0.230, 0.260, 0.045]],
        };
        [dark, bright.map(|channel| light * channel)]
    }

    /// Makes the tree at all levels of detail. Every seed gives another tree.
    pub(in super::super) fn levels(self, seed: u64, paints: Paints) -> Levels {
        let shape = |(level, detail_m): (usize, f64)| {
            let mut mesh = match self {
                Self::Spruce => spruce(seed, level, paints),
                Self::Pine => crowned(&PINE, seed, level, (paints.bark, paints.leaves)),
                Self::Oak => crowned(&OAK, seed, level, (paints.bark, paints.leaves)),
                Self::Birch => crowned(&BIRCH, seed, level, (paints.birch, paints.leaves)),
            };
            mesh.name = format!("{self:?} {seed}, shape {level}").to_lowercase();
            colour(&mut mesh, paints.leaves, self.greens(seed), seed);
            (mesh, detail_m)
        };
        Levels(DETAILS_M.into_iter().enumerate().map(shape).collect())
    }
}

/// Colours leaves: darker near the trunk and below, lighter outside and above, with a little noise.
fn colour(mesh: &mut Mesh, leaves: usize, [dark, bright]: Greens, seed: u64) {
    for primitive in &mut mesh.primitives {
        if primitive.material != leaves {
            continue;
        }
        let points = || primitive.positions.iter().map(|p| DVec3::from(p.map(f64::from)));
        let high = points().fold(0.0, |high: f64, p| high.max(p.y));
        let wide = points().fold(0.1, |wide: f64, p| wide.max(p.x.hypot(p.z)));
        let share = |p: DVec3| {
            let out = smoothstep(0.1, 1.0, p.x.hypot(p.z) / wide + 0.5 * p.y / high);
            (0.15 + 0.75 * out + 0.35 * noise::space(seed, 0.8 * p)).clamp(0.0, 1.0)
        };
        let mixed = |p: DVec3| {
            let [r, g, b] = std::array::from_fn(|i| mix(dark[i], bright[i], share(p)) as f32);
            [r, g, b, 1.0]
        };
        primitive.colors = points().map(mixed).collect();
    }
}

/// Shape of each level of a spruce: tiers of boughs, each a star whose points droop; points of a
/// star; sides of the trunk.
const SPRUCE: [(i32, usize, usize); 4] = [(13, 8, 6), (7, 5, 4), (3, 0, 0), (1, 0, 0)];

/// A spruce, 20 m tall.
fn spruce(seed: u64, level: usize, paints: Paints) -> Mesh {
    const HEIGHT: f64 = 20.0;
    const LOWEST: f64 = 0.09;
    let (tiers, points, sides) = SPRUCE[level];
    let mut random = Random::new(seed);
    let mut tree = Sculpture::default();
    if sides > 0 {
        let trunk = [(DVec3::NEG_Y * 0.8, 0.42), (DVec3::Y * 0.8, 0.3), (DVec3::Y * (0.9 * HEIGHT), 0.05)];
        tree.add(paints.bark, 60.0, &Solid::tube(&trunk, sides));
    }
    for tier in 0..tiers {
        let share = |tier: f64| mix(LOWEST, 0.97, libm::pow(tier / f64::from(tiers), 0.92));
        let (low, next) = (share(f64::from(tier)), share(f64::from(tier + 1)));
        let radius = (4.1 * libm::pow(1.0 - low, 0.8) + 0.15) * random.between(0.93, 1.05);
        let top = if tier + 1 == tiers { HEIGHT } else { HEIGHT * mix(low, next, 1.75).min(0.995) };
        let turned = random.between(0.0, 360.0);
        let around = if points == 0 { if tiers == 1 { 4 } else { 6 } } else { 2 * points };
        let ring: Vec<DVec3> = (0..around)
            .map(|i| {
                let is_point = points == 0 || i % 2 == 0;
                let (sin, cos) = sin_cos(turned + 360.0 * i as f64 / around as f64);
                let out = radius * if is_point { random.between(0.9, 1.08) } else { 0.56 };
                let droop = if is_point { 0.16 * radius } else { 0.02 * radius };
                dvec3(out * cos, HEIGHT * low - droop, -out * sin)
            })
            .collect();
        let inside = DVec3::Y * (HEIGHT * low + if points == 0 { 0.0 } else { 0.22 * radius });
        tree.add(paints.leaves, 35.0, &Solid::loft(End::Point(inside), &[ring], End::Point(DVec3::Y * top)));
    }
    tree.finish("")
}

/// A trunk under clumps of leaves.
struct Crowned {
    /// Height of the crown's centre in metres.
    height: f64,
    /// Half the crown's extent across and upwards, in metres.
    crown: [f64; 2],
    /// Radius of the trunk above its roots, in metres.
    trunk: f64,
    /// Number of clumps at the finest level.
    clumps: usize,
    /// Radius of a clump as a share of the crown's.
    clump: f64,
}

const OAK: Crowned = Crowned { height: 7.6, crown: [4.3, 3.6], trunk: 0.42, clumps: 17, clump: 0.44 };
const BIRCH: Crowned = Crowned { height: 9.6, crown: [2.3, 5.0], trunk: 0.17, clumps: 15, clump: 0.5 };
const PINE: Crowned = Crowned { height: 15.0, crown: [3.6, 2.3], trunk: 0.34, clumps: 12, clump: 0.45 };

/// Shape of each level: clumps as a share of the finest level's, and sides of the trunk.
const CROWNED: [(f64, usize); 4] = [(1.0, 7), (0.5, 4), (0.2, 3), (0.0, 3)];

/// A tree with a round crown.
fn crowned(of: &Crowned, seed: u64, level: usize, (bark, leaves): (usize, usize)) -> Mesh {
    let mut random = Random::new(seed);
    let mut tree = Sculpture::default();
    let (share, sides) = CROWNED[level];
    let middle = DVec3::Y * of.height;
    let lean = dvec3(random.between(-0.5, 0.5), 0.0, random.between(-0.5, 0.5));
    if level > 1 {
        let trunk = [(DVec3::NEG_Y * 0.8, 1.3 * of.trunk), (middle + lean, 0.8 * of.trunk)];
        tree.add(bark, 60.0, &Solid::tube(&trunk, sides));
    } else {
        let trunk = [
            (DVec3::NEG_Y * 0.8, 1.7 * of.trunk),
            (DVec3::Y * 0.5, of.trunk),
            (middle + 0.4 * lean - DVec3::Y * (0.5 * of.crown[1]), 0.7 * of.trunk),
            (middle + lean, 0.3 * of.trunk),
        ];
        tree.add(bark, 60.0, &Solid::tube(&trunk, sides));
    }
    // The golden angle spreads clumps evenly over the crown, from below to above.
    let all: Vec<(DVec3, f64)> = (0..of.clumps)
        .map(|i| {
            let height = mix(-0.75, 0.85, (i as f64 + 0.5) / of.clumps as f64);
            let (sin, cos) = sin_cos(137.507_764 * i as f64 + random.between(-15.0, 15.0));
            let out = 0.74 * (1.0 - height * height).max(0.0).sqrt();
            let at = dvec3(out * cos * of.crown[0], 0.78 * height * of.crown[1], -out * sin * of.crown[0]);
            (middle + lean + at, of.clump * of.crown[0] * random.between(0.85, 1.15))
        })
        .collect();
    if share == 0.0 {
        let whole = Solid::sphere(1.0, 4, 2).scaled(of.crown[0], of.crown[1], of.crown[0]);
        tree.add(leaves, 180.0, &whole.at(lean.x, of.height, lean.z));
        return tree.finish("");
    }
    let kept = ((share * of.clumps as f64) as usize).max(3);
    let grown = libm::pow(1.0 / share, 0.36);
    for i in 0..kept {
        let (at, radius) = all[i * of.clumps / kept + of.clumps / kept / 2];
        let ball = match level {
            0 => Solid::cube_sphere(2),
            1 => Solid::sphere(1.0, 6, 4),
            _ => Solid::sphere(1.0, 5, 3),
        };
        let rough = |p: DVec3| p * (1.0 + 0.35 * noise::space(seed + i as u64, 1.7 * p));
        let ball = ball.bent(rough).scaled(radius * grown, 0.8 * radius * grown, radius * grown);
        tree.add(leaves, if level == 0 { 40.0 } else { 80.0 }, &ball.at(at.x, at.y, at.z));
    }
    tree.finish("")
}
