//! Objects of the mine: robots with claws on tracks, tower windmills, rocks.

use glam::{DVec3, dvec3};

use super::maths::{mix, sin_cos, smoothstep, turn};
use super::noise;
use super::sculpt::Sculpture;
use super::shapes::{Solid, beam};
use crate::Mesh;

const SMOOTH: f64 = 45.0;

/// Materials of a clawbot's parts, as indices.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClawbotsColours {
    pub(super) paint: usize,
    pub(super) steel: usize,
    pub(super) rubber: usize,
    pub(super) glass: usize,
}

/// The meshes of a clawbot, 9 m tall, facing +Z.
pub(super) struct Clawbot {
    /// Tracks, which stand on the ground.
    pub(super) tracks: Mesh,
    /// Trunk, which turns about Y on the tracks, around [`TURRET`].
    pub(super) trunk: Mesh,
    /// Moving jaws. The left claw's (+X) is relative to its hinge [`HINGE`] and opens by turning
    /// about +Y. The right claw's is its mirror image.
    pub(super) jaws: [Mesh; 2],
}

/// Point on the tracks about which the trunk turns.
pub(super) const TURRET: DVec3 = DVec3::new(0.0, 2.6, 0.0);
/// Hinge of the left jaw, relative to [`TURRET`].
pub(super) const HINGE: DVec3 = DVec3::new(3.75, 1.3, 4.1);

/// Makes a clawbot.
pub(super) fn clawbot(colours: ClawbotsColours) -> Clawbot {
    let mut tracks = Sculpture::default();
    tracks.add(colours.rubber, 30.0, &track().at(2.3, 0.0, 0.0).and_mirrored());
    tracks.add(colours.steel, SMOOTH, &wheels().at(2.3, 0.0, 0.0).and_mirrored());
    let deck = Solid::all([
        Solid::bevelled([3.4, 0.9, 5.2], 0.2).at(0.0, 1.5, 0.0),
        Solid::bevelled([1.7, 0.35, 6.6], 0.1).at(2.3, 2.25, 0.0).and_mirrored(),
        Solid::block([3.0, 0.5], [2.2, 0.3], 0.9, 0.1).turned(DVec3::X, 60.0).at(0.0, 1.2, 2.5),
    ]);
    tracks.add(colours.paint, 30.0, &deck);
    tracks.add(colours.steel, SMOOTH, &Solid::cone(1.75, 1.6, 0.75, 64).at(0.0, 1.9, 0.0));

    let mut trunk = Sculpture::default();
    trunk.add(colours.paint, 30.0, &trunk_shell());
    trunk.add(colours.steel, SMOOTH, &trunk_steel());
    trunk.add(colours.glass, SMOOTH, &eyes());
    trunk.add(colours.steel, 30.0, &fixed_jaw().and_mirrored());

    let jaw = |name: &str, side: f64| {
        let mut sculpture = Sculpture::default();
        sculpture.add(colours.steel, 30.0, &moving_jaw().scaled(side, 1.0, 1.0));
        sculpture.finish(name)
    };
    Clawbot {
        tracks: tracks.finish("clawbot tracks"),
        trunk: trunk.finish("clawbot trunk"),
        jaws: [jaw("clawbot left jaw", 1.0), jaw("clawbot right jaw", -1.0)],
    }
}

/// Links around a stadium of 6.4 m × 2 m, in the plane x = 0.
fn track() -> Solid {
    const LINKS: usize = 42;
    let (half, radius) = (2.2, 0.88);
    let straight = 2.0 * half;
    let bend = std::f64::consts::PI * radius;
    let link = |i: usize| {
        let way = (straight + bend) * 2.0 * i as f64 / LINKS as f64;
        // Along the top to the front, around, back along the ground, around.
        let (z, y, angle) = if way < straight {
            (way - half, radius, 0.0)
        } else if way < straight + bend {
            let angle = 180.0 * (way - straight) / bend;
            let (sin, cos) = sin_cos(angle);
            (half + radius * sin, radius * cos, angle)
        } else if way < 2.0 * straight + bend {
            (half - (way - straight - bend), -radius, 180.0)
        } else {
            let angle = 180.0 + 180.0 * (way - 2.0 * straight - bend) / bend;
            let (sin, cos) = sin_cos(angle);
            (-half + radius * sin, radius * cos, angle)
        };
        let shoe = Solid::bevelled([1.5, 0.14, 0.25], 0.04);
        let grouser = Solid::block([1.45, 0.1], [1.4, 0.05], 0.11, 0.0).at(0.0, 0.06, 0.0);
        let pin = Solid::rod(dvec3(-0.8, -0.02, 0.12), dvec3(0.8, -0.02, 0.12), 0.06, 6);
        Solid::all([shoe, grouser, pin]).turned(DVec3::X, angle).at(0.0, y + 1.05, z)
    };
    Solid::all((0..LINKS).map(link))
}

fn wheel(radius: f64, width: f64) -> Solid {
    let half = 0.5 * width;
    let profile = [
        [0.0, -half * 1.25],
        [0.22 * radius, -half * 1.25],
        [0.24 * radius, -half * 0.7],
        [0.6 * radius, -half * 0.55],
        [0.72 * radius, -half],
        [0.97 * radius, -half],
        [radius, -half * 0.9],
        [radius, half * 0.9],
        [0.97 * radius, half],
        [0.72 * radius, half],
        [0.6 * radius, half * 0.55],
        [0.24 * radius, half * 0.7],
        [0.22 * radius, half * 1.25],
        [0.0, half * 1.25],
    ];
    let bolt = |i: i32| {
        let (sin, cos) = sin_cos(60.0 * f64::from(i));
        Solid::cone(0.05, 0.05, width * 1.2, 5).at(0.42 * radius * cos, -half * 1.2, 0.42 * radius * sin)
    };
    Solid::all((0..6).map(bolt).chain([Solid::lathe(&profile, 20)])).turned(DVec3::Z, -90.0)
}

fn wheels() -> Solid {
    let ends = [-2.2, 2.2].map(|z| wheel(0.74, 0.9).at(0.0, 1.05, z));
    let rollers = [-1.25, -0.4, 0.4, 1.25].map(|z| wheel(0.42, 0.8).at(0.0, 0.72, z));
    Solid::all(ends.into_iter().chain(rollers))
}

fn trunk_shell() -> Solid {
    let body = Solid::stack(
        &[(-0.2, [2.6, 2.2]), (0.4, [3.3, 2.9]), (2.2, [3.9, 3.2]), (3.3, [3.3, 2.7]), (3.7, [2.2, 1.8])],
        0.5,
    );
    let head = Solid::stack(&[(4.3, [1.5, 1.4]), (4.7, [1.9, 1.8]), (5.5, [1.8, 1.7]), (5.9, [1.1, 1.1])], 0.35);
    let engine = Solid::bevelled([2.6, 2.1, 1.4], 0.25).at(0.0, 1.5, -2.0);
    let shoulder = Solid::sphere(0.95, 20, 12).at(2.5, 2.75, 0.1);
    let upper = Solid::sweep(
        &[(dvec3(2.6, 2.7, 0.1), 0.5), (dvec3(3.45, 1.6, 0.7), 0.62), (dvec3(3.6, 1.0, 1.0), 0.5)],
        &beam(1.0, 1.0, 0.3),
    );
    let fore = Solid::sweep(
        &[(dvec3(3.6, 1.0, 0.9), 0.5), (dvec3(3.65, 1.1, 2.2), 0.66), (dvec3(3.65, 1.2, 3.3), 0.55)],
        &beam(1.0, 1.0, 0.3),
    );
    let fender = Solid::hoop(&[[0.98, -0.55], [1.12, -0.55], [1.12, 0.2], [1.02, 0.2]], 32)
        .turned(DVec3::Z, -35.0)
        .at(2.5, 2.75, 0.1);
    Solid::all([body, head, engine, Solid::all([shoulder, upper, fore, fender]).and_mirrored()])
}

fn trunk_steel() -> Solid {
    let neck = Solid::lathe(
        &[
            [0.0, 3.5],
            [0.7, 3.55],
            [0.62, 3.7],
            [0.7, 3.82],
            [0.62, 3.95],
            [0.7, 4.07],
            [0.62, 4.2],
            [0.6, 4.4],
            [0.0, 4.4],
        ],
        28,
    );
    let elbow = Solid::cone(0.62, 0.62, 1.3, 24).at(0.0, -0.65, 0.0).turned(DVec3::Z, -90.0).at(3.6, 1.0, 0.95);
    let wrist = Solid::lathe(
        &[
            [0.0, 0.0],
            [0.5, 0.0],
            [0.58, 0.12],
            [0.58, 0.3],
            [0.45, 0.36],
            [0.58, 0.42],
            [0.58, 0.6],
            [0.5, 0.72],
            [0.0, 0.72],
        ],
        24,
    )
    .turned(DVec3::X, 90.0)
    .at(3.65, 1.2, 3.25);
    let piston = |from: DVec3, to: DVec3| {
        let middle = from.lerp(to, 0.55);
        Solid::rod(from, middle, 0.14, 12).and(Solid::rod(middle - (to - from) * 0.05, to, 0.085, 12))
    };
    let lift = piston(dvec3(1.75, 1.0, 1.0), dvec3(3.2, 1.6, 0.85));
    let reach = piston(dvec3(3.2, 2.05, 0.9), dvec3(3.6, 1.65, 2.7));
    let exhaust = Solid::tube(
        &[
            (dvec3(0.85, 2.2, -2.2), 0.2),
            (dvec3(0.85, 4.2, -2.3), 0.2),
            (dvec3(0.85, 4.75, -2.6), 0.2),
            (dvec3(0.85, 4.9, -2.9), 0.24),
        ],
        16,
    );
    let slats =
        Solid::all((0..7).map(|i| Solid::bevelled([2.0, 0.12, 0.2], 0.03).at(0.0, 0.75 + 0.24 * f64::from(i), -2.72)));
    let rivets = Solid::all((0..24).map(|i| {
        let (sin, cos) = sin_cos(15.0 * f64::from(i));
        Solid::sphere(0.07, 6, 4).at(1.5 * cos, 0.05, 1.25 * sin)
    }));
    let antenna = Solid::rod(dvec3(-0.7, 5.6, -0.4), dvec3(-0.75, 7.6, -0.5), 0.05, 10)
        .and(Solid::sphere(0.13, 14, 10).at(-0.75, 7.6, -0.5));
    let lamp = Solid::lathe(&[[0.0, -0.3], [0.2, -0.3], [0.3, 0.1], [0.34, 0.12], [0.34, 0.2], [0.0, 0.2]], 24)
        .turned(DVec3::X, 90.0)
        .at(1.35, 3.75, 1.0);
    Solid::all([neck, slats, rivets, antenna, Solid::all([elbow, wrist, lift, reach, exhaust, lamp]).and_mirrored()])
}

fn eyes() -> Solid {
    let eye = Solid::sphere(0.3, 18, 10).scaled(1.0, 1.0, 0.7).at(0.42, 5.1, 0.82).and_mirrored();
    let lens = Solid::sphere(0.27, 14, 8).scaled(1.0, 1.0, 0.5).at(1.35, 3.75, 1.2).and_mirrored();
    eye.and(lens)
}

/// One half of a lobster's claw in the XZ plane, growing along +Z from the origin and bent towards
/// −X, with teeth.
fn half_claw(length: f64) -> Solid {
    let arc = |t: f64| dvec3(0.62 * sin_cos(180.0 * libm::pow(t, 0.85)).0 - 0.42 * t, 0.0, length * t);
    let path: Vec<_> = (0..=16)
        .map(|i| {
            let t = f64::from(i) / 16.0;
            (arc(t), if i == 16 { 0.0 } else { mix(0.42, 0.1, t) * smoothstep(1.25, 0.75, t) })
        })
        .collect();
    let horn = Solid::tube(&path, 18).scaled(1.0, 1.25, 1.0);
    let tooth = |i: i32| {
        let t = mix(0.25, 0.85, f64::from(i) / 6.0);
        let at = arc(t) - DVec3::X * mix(0.28, 0.08, t);
        Solid::cone(0.13, 0.0, 0.3, 8).turned(DVec3::Z, 90.0).at(at.x, at.y, at.z)
    };
    Solid::all((0..7).map(tooth).chain([horn]))
}

fn fixed_jaw() -> Solid {
    // The palm, and the inner half of the claw that points outwards from it.
    let palm = Solid::sphere(0.72, 22, 14).scaled(1.0, 0.75, 1.0).at(3.65, 1.2, 4.1);
    let jaw = half_claw(2.6).scaled(-1.0, 1.0, 1.0).at(3.3, 1.25, 4.35);
    palm.and(jaw)
}

fn moving_jaw() -> Solid {
    let knuckle = Solid::cone(0.36, 0.36, 1.15, 28).at(0.0, -0.575, 0.0);
    half_claw(2.75).at(0.3, 0.0, 0.15).and(knuckle).at(0.0, -0.05, 0.0)
}

/// Materials of a windmill's parts, as indices.
#[derive(Clone, Copy, Debug)]
pub(super) struct WindmillsColours {
    pub(super) stone: usize,
    pub(super) wood: usize,
    pub(super) thatch: usize,
    pub(super) cloth: usize,
}

/// Point about which a windmill's rotor turns, around +Z.
pub(super) const HUB: DVec3 = DVec3::new(0.0, 21.5, 5.2);

/// Makes a tower mill, 25 m tall with its sails facing +Z, and its rotor around [`HUB`].
pub(super) fn windmill(colours: WindmillsColours) -> [Mesh; 2] {
    let mut tower = Sculpture::default();
    tower.add(colours.stone, 32.0, &stone_tower());
    tower.add(colours.wood, 35.0, &gallery().and(tower_joinery()));
    tower.add(colours.thatch, SMOOTH, &cap());
    let mut rotor = Sculpture::default();
    rotor.add(colours.wood, 35.0, &sails());
    rotor.add(colours.cloth, SMOOTH, &canvas());
    [tower.finish("windmill"), rotor.finish("windmill sails")]
}

fn tower_radius(y: f64) -> f64 {
    mix(5.2, 3.3, y / 19.0) + 0.35 * smoothstep(2.5, 0.0, y)
}

/// Courses of stone: rings that step in and out, and stones of different sizes around.
fn stone_tower() -> Solid {
    const COURSES: i32 = 24;
    let mut profile = vec![[0.0, -1.6], [tower_radius(0.0) + 0.1, -1.6]];
    for course in 0..COURSES {
        let y = mix(-0.4, 19.0, f64::from(course) / f64::from(COURSES));
        let next = mix(-0.4, 19.0, f64::from(course + 1) / f64::from(COURSES));
        let bulge = tower_radius(0.5 * (y + next)) + 0.07;
        profile.extend([[tower_radius(y), y], [bulge, y + 0.08], [bulge - 0.02, next - 0.08]]);
    }
    profile.extend([[tower_radius(19.0), 19.0], [3.6, 19.1], [3.6, 19.5], [0.0, 19.5]]);
    Solid::lathe(&profile, 36)
}

fn gallery() -> Solid {
    const POSTS: i32 = 28;
    let (y, inner, outer) = (6.6, 4.3, 6.5);
    let floor = Solid::hoop(&[[inner, y], [outer, y], [outer, y + 0.2], [inner, y + 0.2]], 56);
    let rail = |height: f64, size: f64| {
        let (low, high) = (y + height, y + height + size);
        Solid::hoop(
            &[[outer - 0.2, low], [outer - 0.2 + size, low], [outer - 0.2 + size, high], [outer - 0.2, high]],
            56,
        )
    };
    let post = |i: i32| {
        let out = turn(DVec3::Y, 360.0 * f64::from(i) / f64::from(POSTS)) * DVec3::X;
        let post =
            Solid::rod(out * (outer - 0.13) + DVec3::Y * y, out * (outer - 0.13) + DVec3::Y * (y + 1.3), 0.08, 8);
        if i % 4 != 0 {
            return post;
        }
        // A strut from the tower's wall carries the floor.
        let strut = Solid::rod(out * 4.5 + DVec3::Y * (y - 2.6), out * (outer - 0.5) + DVec3::Y * (y + 0.05), 0.16, 8);
        let joist = Solid::rod(out * 4.2 + DVec3::Y * (y - 0.12), out * outer + DVec3::Y * (y - 0.12), 0.14, 8);
        Solid::all([post, strut, joist])
    };
    Solid::all((0..POSTS).map(post).chain([floor, rail(0.6, 0.1), rail(1.2, 0.14)]))
}

fn tower_joinery() -> Solid {
    let on_wall = |solid: Solid, bearing: f64, y: f64| {
        let out = tower_radius(y);
        solid.at(0.0, 0.0, out).turned(DVec3::Y, bearing).at(0.0, y, 0.0)
    };
    let door = |bearing: f64| {
        let frame = [
            Solid::bevelled([0.28, 3.1, 0.6], 0.05).at(0.95, 1.5, 0.0).and_mirrored(),
            Solid::bevelled([2.5, 0.32, 0.7], 0.06).at(0.0, 3.15, 0.0),
            Solid::bevelled([1.7, 3.0, 0.35], 0.04).at(0.0, 1.5, 0.0),
            Solid::bevelled([2.6, 0.4, 1.2], 0.06).at(0.0, -0.05, 0.3),
        ];
        let planks = Solid::all(
            (0..6).map(|i| Solid::bevelled([0.23, 2.7, 0.5], 0.03).at(-0.68 + 0.27 * f64::from(i), 1.5, 0.0)),
        );
        on_wall(Solid::all(frame).and(planks), bearing, 0.1)
    };
    let window = |bearing: f64, y: f64| {
        let frame = Solid::all([
            Solid::bevelled([0.2, 1.7, 0.5], 0.04).at(0.6, 0.0, 0.0).and_mirrored(),
            Solid::bevelled([1.6, 0.2, 0.6], 0.04).at(0.0, -0.85, 0.0),
            Solid::bevelled([1.6, 0.2, 0.6], 0.04).at(0.0, 0.85, 0.0),
            Solid::cuboid([1.1, 1.6, 0.3]),
            Solid::cuboid([0.09, 1.6, 0.42]),
            Solid::cuboid([1.1, 0.09, 0.44]),
        ]);
        on_wall(frame, bearing, y)
    };
    let openings = [(40.0, 10.2), (160.0, 10.2), (280.0, 10.2), (100.0, 14.6), (220.0, 14.6), (340.0, 14.6)];
    Solid::all(openings.into_iter().map(|(bearing, y)| window(bearing, y)).chain([door(0.0), door(180.0)]))
}

/// The turning roof: an onion of shingles, the wind shaft's housing, and the tail pole.
fn cap() -> Solid {
    const ROWS: i32 = 12;
    let mut profile = vec![[0.0, 19.2], [3.9, 19.25], [4.15, 19.4]];
    for row in 0..ROWS {
        let t = f64::from(row) / f64::from(ROWS);
        let radius = |t: f64| 4.1 * libm::pow((1.0 - t * t).max(0.0), 0.62);
        let next = t + 1.0 / f64::from(ROWS);
        profile
            .extend([[radius(t) + 0.09, 19.45 + 5.2 * t], [radius(next).max(0.1) + 0.02, 19.45 + 5.2 * next - 0.03]]);
    }
    profile.push([0.0, 24.85]);
    let roof = Solid::lathe(&profile, 40);
    let dormer = Solid::stack(&[(0.0, [2.4, 2.4]), (2.2, [2.2, 2.2]), (2.6, [1.4, 1.4])], 0.4)
        .turned(DVec3::X, 90.0)
        .at(0.0, 21.5, 2.0);
    let finial = Solid::lathe(&[[0.0, 24.6], [0.3, 24.7], [0.16, 25.0], [0.34, 25.35], [0.12, 25.7], [0.0, 26.5]], 24);
    let pole = |x: f64| Solid::tube(&[(dvec3(x, 22.0, -3.2), 0.2), (dvec3(0.3 * x, 7.4, -8.6), 0.16)], 12);
    let brace = Solid::rod(dvec3(-1.3, 17.0, -5.1), dvec3(1.3, 17.0, -5.1), 0.13, 10);
    Solid::all([roof, dormer, finial, pole(2.6), pole(-2.6), brace])
}

const SAIL_M: f64 = 13.2;

fn sails() -> Solid {
    let hub =
        Solid::lathe(&[[0.0, -3.2], [0.42, -3.2], [0.5, -1.0], [0.75, -0.9], [0.8, 0.6], [0.55, 0.9], [0.0, 1.0]], 32)
            .turned(DVec3::X, 90.0);
    let one = {
        let stock =
            Solid::sweep(&[(dvec3(0.0, 0.0, 0.1), 0.32), (dvec3(0.0, SAIL_M, 0.1), 0.14)], &beam(1.0, 1.0, 0.25));
        let hem = |x: f64| Solid::rod(dvec3(x, 2.4, 0.22), dvec3(x, SAIL_M - 0.1, 0.14), 0.07, 8);
        let bar = |i: i32| {
            let y = mix(2.4, SAIL_M - 0.1, f64::from(i) / 17.0);
            Solid::rod(dvec3(-0.55, y, 0.2), dvec3(2.15, y, 0.2), 0.05, 6)
        };
        Solid::all((0..18).map(bar).chain([stock, hem(-0.5), hem(0.8), hem(2.1)]))
    };
    let four = (0..4).map(|i| one.clone().turned(DVec3::Z, 90.0 * f64::from(i)));
    Solid::all(four.chain([hub]))
}

/// Cloth, set on two thirds of each sail.
fn canvas() -> Solid {
    let one = Solid::slab(6, 24, |u, v| {
        let (x, y) = (mix(0.12, 2.05, u), mix(2.6, 10.4, v));
        let z = 0.36 + 0.1 * sin_cos(180.0 * u).0 * sin_cos(180.0 * 6.0 * v).0.abs();
        (dvec3(x, y, z), dvec3(x, y, z - 0.06))
    });
    Solid::all((0..4).map(|i| one.clone().turned(DVec3::Z, 90.0 * f64::from(i))))
}

/// Makes a boulder of radius about 1; every seed gives another one. Its lower third belongs into
/// the ground.
pub(super) fn rock(name: &str, seed: u64, material: usize) -> Mesh {
    let stone = Solid::cube_sphere(26).bent(|p| {
        // Planes that cut the ball make a broken stone; noise makes it rough.
        let cuts = (0..9_u32).map(|i| {
            let (sin, cos) = sin_cos(137.507_764 * f64::from(i) + seed as f64 * 31.0);
            let height = mix(-0.55, 0.95, f64::from(i) / 8.0);
            let out = dvec3(cos, height, sin).normalize();
            let facing = p.dot(out);
            if facing > 0.2 { (0.74 + 0.05 * f64::from(i % 3)) / facing } else { 10.0 }
        });
        let broken = cuts.fold(1.0, f64::min);
        let rough = noise::space_octaves(seed, p * 1.3, 4, 0.52);
        let scale = broken * (1.0 + 0.26 * rough);
        dvec3(p.x * scale * 1.15, p.y * scale * 0.85, p.z * scale)
    });
    let mut sculpture = Sculpture::default();
    sculpture.add(material, 38.0, &stone);
    sculpture.finish(name)
}
