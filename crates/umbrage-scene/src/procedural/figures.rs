//! Walkers of the desert: a knight in plate armour (10 m tall at scale 1) and a dwarf (7.4 m). They
//! face +Z and stand on y = 0 in mid-stride.

use glam::{DVec3, dvec3};

use super::maths::{Random, mix, sin_cos, smoothstep, turn};
use super::sculpt::Sculpture;
use super::shapes::{Solid, beam};
use crate::Mesh;

const SMOOTH: f64 = 48.0;

/// What a knight wears: indices of materials.
#[derive(Clone, Copy, Debug)]
pub(super) struct KnightsColours {
    pub(super) steel: usize,
    pub(super) brass: usize,
    pub(super) cloth: usize,
    pub(super) leather: usize,
}

/// What a dwarf wears: indices of materials.
#[derive(Clone, Copy, Debug)]
pub(super) struct DwarfsColours {
    pub(super) skin: usize,
    pub(super) beard: usize,
    pub(super) tunic: usize,
    pub(super) leather: usize,
    pub(super) iron: usize,
}

/// How far the feet reach from a figure's axis at scale 1, sideways and along its way.
pub(super) const STRIDE: [f64; 2] = [1.5, 1.9];

/// A dome on the ground, flat below: boots, knee guards, pauldrons.
fn dome(size: [f64; 3], segments: usize, rings: usize) -> Solid {
    let profile: Vec<[f64; 2]> = (0..=rings)
        .map(|i| {
            let (sin, cos) = sin_cos(90.0 * i as f64 / rings as f64);
            [if i == rings { 0.0 } else { cos }, sin]
        })
        .collect();
    Solid::lathe(&profile, segments).scaled(size[0], size[1], size[2])
}

/// A tube through knots of (place, radius), rounded between them (Catmull-Rom).
fn limb(knots: &[(DVec3, f64)], steps: usize, segments: usize) -> Solid {
    Solid::tube(&rounded(knots, steps), segments)
}

pub(super) fn rounded(knots: &[(DVec3, f64)], steps: usize) -> Vec<(DVec3, f64)> {
    let knot = |i: isize| knots[i.clamp(0, knots.len() as isize - 1) as usize];
    let mut path = Vec::new();
    for i in 0..knots.len() as isize - 1 {
        let [a, b, c, d] = [knot(i - 1), knot(i), knot(i + 1), knot(i + 2)];
        for step in 0..steps {
            let t = step as f64 / steps as f64;
            let weights = [
                -0.5 * t + t * t - 0.5 * t * t * t,
                1.0 - 2.5 * t * t + 1.5 * t * t * t,
                0.5 * t + 2.0 * t * t - 1.5 * t * t * t,
                -0.5 * t * t + 0.5 * t * t * t,
            ];
            let place = weights[0] * a.0 + weights[1] * b.0 + weights[2] * c.0 + weights[3] * d.0;
            path.push((place, mix(b.1, c.1, smoothstep(0.0, 1.0, t))));
        }
    }
    path.push(knots[knots.len() - 1]);
    path
}

/// A bell that hangs from the waist: open below, with pleats that grow towards the hem. `[radius,
/// height]` of waist and hem.
fn skirt(waist: [f64; 2], hem: [f64; 2], pleats: f64, depth: f64) -> Solid {
    let rows = 8;
    let outside = (0..=rows).map(|i| {
        let t = f64::from(i) / f64::from(rows);
        [mix(hem[0], waist[0], libm::pow(t, 0.8)), mix(hem[1], waist[1], t)]
    });
    let mut profile = vec![[0.0, waist[1] - 0.12]];
    profile.extend(outside.clone().rev().map(|[radius, y]| [radius - 0.09, y - 0.1]).skip(1));
    profile.extend(outside);
    profile.push([0.0, waist[1] + 0.05]);
    Solid::lathe(&profile, 60).bent(|p| {
        let fall = smoothstep(waist[1], hem[1], p.y);
        let around = libm::atan2(p.z, p.x).to_degrees();
        let pleat = 1.0 + depth * fall * sin_cos(around * pleats).1;
        dvec3(p.x * pleat, p.y, p.z * pleat)
    })
}

/// A knight.
pub(super) fn knight(name: &str, colours: KnightsColours) -> Mesh {
    let mut sculpture = Sculpture::default();
    let steel = Solid::all([knights_legs(), knights_trunk(), knights_arms(), great_helm()]);
    sculpture.add(colours.steel, 40.0, &steel);
    sculpture.add(colours.steel, 25.0, &sword_blade());
    sculpture.add(colours.brass, SMOOTH, &knights_trim());
    sculpture.add(colours.cloth, SMOOTH, &Solid::all([skirt([1.02, 5.3], [1.75, 3.3], 16.0, 0.05), cape(), plume()]));
    sculpture.add(colours.cloth, 40.0, &heater_shield(0.0));
    sculpture.add(colours.leather, SMOOTH, &knights_leather());
    sculpture.finish(name)
}

/// Hip, knee, ankle of the leg that is ahead (1) or behind (−1).
fn leg_joints(ahead: f64) -> [DVec3; 3] {
    let x = 0.72 * ahead;
    if ahead > 0.0 {
        [dvec3(x, 4.7, 0.0), dvec3(x * 1.15, 2.75, 1.05), dvec3(x * 1.25, 0.75, 0.95)]
    } else {
        [dvec3(x, 4.7, 0.0), dvec3(x * 1.15, 2.65, 0.05), dvec3(x * 1.25, 0.75, -0.85)]
    }
}

fn knights_legs() -> Solid {
    let leg = |ahead: f64| {
        let [hip, knee, ankle] = leg_joints(ahead);
        let cuisse = limb(&[(hip, 0.72), (hip.lerp(knee, 0.45), 0.66), (knee, 0.46)], 4, 16);
        let greave = limb(
            &[
                (knee, 0.42),
                (knee.lerp(ankle, 0.3) - DVec3::Z * 0.08, 0.53),
                (knee.lerp(ankle, 0.75), 0.4),
                (ankle, 0.38),
            ],
            3,
            16,
        );
        let cop = Solid::sphere(0.52, 14, 9).scaled(1.0, 1.0, 0.95).at(knee.x, knee.y, knee.z + 0.12);
        let wing = Solid::sphere(0.4, 12, 6).scaled(0.22, 1.0, 1.0).at(knee.x + 0.5 * ahead, knee.y, knee.z);
        // The sabaton: lames that overlap like a lobster's tail.
        let lame = |i: i32| {
            let t = f64::from(i) / 4.0;
            dome([mix(0.5, 0.3, t), mix(0.75, 0.34, t), 0.5], 14, 5).at(ankle.x, 0.0, ankle.z + mix(-0.15, 0.95, t))
        };
        Solid::all((0..=4).map(lame).chain([cuisse, greave, cop, wing]))
    };
    leg(1.0).and(leg(-1.0))
}

fn knights_trunk() -> Solid {
    let knots = [
        (0.95, 4.9),
        (0.98, 5.2),
        (1.04, 5.5),
        (1.22, 6.0),
        (1.38, 6.6),
        (1.42, 7.1),
        (1.28, 7.6),
        (0.85, 7.95),
        (0.5, 8.1),
    ];
    let mut profile = vec![[0.0, 4.8]];
    profile.extend(rounded(&knots.map(|(r, y)| (dvec3(r, y, 0.0), 0.0)), 3).iter().map(|(p, _)| [p.x, p.y]));
    profile.push([0.0, 8.15]);
    let plate = Solid::lathe(&profile, 30).scaled(1.0, 1.0, 0.78).bent(|p| {
        // The breast's keel.
        let keel = smoothstep(0.5, 0.0, p.x.abs()) * smoothstep(0.0, 0.8, p.z) * smoothstep(5.0, 6.6, p.y);
        dvec3(p.x, p.y, p.z + 0.22 * keel * smoothstep(8.0, 7.0, p.y))
    });
    let lame = |i: i32| {
        let y = 4.62 + 0.2 * f64::from(i);
        let radius = 1.16 - 0.05 * f64::from(i);
        Solid::hoop(&[[radius - 0.1, y], [radius + 0.06, y], [radius - 0.02, y + 0.24], [radius - 0.12, y + 0.24]], 28)
    };
    let faulds = Solid::all((0..4).map(lame)).scaled(1.0, 1.0, 0.84);
    plate.and(faulds)
}

const SWORD_HAND: DVec3 = DVec3::new(-2.05, 5.0, 1.55);
const SHIELD_HAND: DVec3 = DVec3::new(1.95, 5.35, 1.25);

fn knights_arms() -> Solid {
    let arm = |side: f64, hand: DVec3| {
        let shoulder = dvec3(1.5 * side, 7.35, 0.0);
        let elbow = dvec3(2.0 * side, 5.75, -0.25);
        let upper = limb(&[(shoulder, 0.45), (shoulder.lerp(elbow, 0.5), 0.43), (elbow, 0.35)], 3, 14);
        let fore = limb(&[(elbow, 0.34), (elbow.lerp(hand, 0.35), 0.42), (hand, 0.29)], 3, 14);
        let couter = Solid::sphere(0.43, 13, 8).at(elbow.x, elbow.y, elbow.z);
        let cuff =
            limb(&[(elbow.lerp(hand, 0.55), 0.34), (elbow.lerp(hand, 0.78), 0.5), (elbow.lerp(hand, 0.8), 0.3)], 2, 14);
        let fist = Solid::sphere(0.38, 12, 8).scaled(0.9, 1.0, 1.0).at(hand.x, hand.y, hand.z);
        let finger = |i: i32| {
            let y = hand.y + 0.14 * (f64::from(i) - 1.5);
            let out = dvec3(-0.1 * side, 0.0, 0.42);
            limb(
                &[
                    (hand.with_y(y) + dvec3(0.34 * side, 0.0, 0.1), 0.1),
                    (hand.with_y(y) + out, 0.11),
                    (hand.with_y(y) - dvec3(0.3 * side, 0.0, -0.12), 0.09),
                ],
                3,
                6,
            )
        };
        let lame = |i: i32| {
            let t = f64::from(i) / 3.0;
            let size = mix(0.92, 0.62, t);
            dome([size, 0.75 * size, size * 0.95], 20, 5).turned(DVec3::Z, mix(-8.0, -50.0, t) * side).at(
                shoulder.x + mix(0.0, 0.35, t) * side,
                shoulder.y + mix(0.1, -0.55, t),
                0.0,
            )
        };
        Solid::all((0..4).map(lame).chain((0..4).map(finger)).chain([upper, fore, couter, cuff, fist]))
    };
    arm(-1.0, SWORD_HAND).and(arm(1.0, SHIELD_HAND))
}

fn great_helm() -> Solid {
    let mut profile = vec![[0.0, 7.75], [0.62, 7.8], [0.7, 7.82]];
    profile.extend((0..=7).map(|i| {
        let t = f64::from(i) / 7.0;
        [0.7 + 0.1 * sin_cos(180.0 * t).0 - 0.02 * t, mix(7.95, 9.25, t)]
    }));
    profile.extend((1..=5).map(|i| {
        let (sin, cos) = sin_cos(18.0 * f64::from(i));
        [if i == 5 { 0.0 } else { 0.66 * cos }, 9.28 + 0.42 * sin]
    }));
    let bowl = Solid::lathe(&profile, 26).bent(|p| {
        let face = smoothstep(0.2, 0.8, p.z) * smoothstep(0.4, 0.0, p.x.abs());
        dvec3(p.x, p.y, 1.12 * p.z + 0.14 * face * smoothstep(9.4, 8.6, p.y))
    });
    let gorget = Solid::cone(0.95, 0.62, 0.5, 32).scaled(1.0, 1.0, 0.9).at(0.0, 7.6, 0.0);
    bowl.and(gorget)
}

fn knights_trim() -> Solid {
    let band = |from: f64, to: f64, low: f64, high: f64| {
        Solid::sector([0.6, 0.86], [low, high], [from, to], 12).scaled(1.0, 1.0, 1.14)
    };
    let rivet = |i: i32| {
        let (sin, cos) = sin_cos(20.0 * f64::from(i));
        Solid::sphere(0.06, 5, 3).at(0.8 * cos, 8.05, 0.9 * sin)
    };
    let guard = SWORD_HAND + SWORD * 0.55;
    let cross = limb(
        &[(guard - DVec3::X * 1.1 + SWORD * 0.15, 0.16), (guard, 0.13), (guard + DVec3::X * 1.1 + SWORD * 0.15, 0.16)],
        3,
        10,
    );
    let pommel = SWORD_HAND - SWORD * 0.95;
    let boss = Solid::sphere(0.3, 14, 7).scaled(1.0, 1.0, 0.5);
    let buckle = Solid::bevelled([0.5, 0.45, 0.16], 0.06).at(0.0, 5.3, 0.92);
    let clasp = Solid::sphere(0.22, 10, 6).at(1.0, 7.72, 0.62).and_mirrored();
    // Brow, nose and the edge of the visor: the cross of a great helm.
    let brow = band(-170.0, -10.0, 8.86, 9.02);
    let chin = band(-165.0, -15.0, 8.5, 8.62);
    let nose = Solid::slab(3, 6, |u, v| {
        let (x, y) = (mix(-0.12, 0.12, u), mix(8.02, 9.3, v));
        (dvec3(x, y, 1.08 - 0.1 * v), dvec3(x, y, 0.6))
    });
    Solid::all((0..18).map(rivet).chain([
        cross,
        Solid::sphere(0.26, 12, 7).at(pommel.x, pommel.y, pommel.z),
        boss.transformed(&shield_place(0.24)),
        buckle,
        clasp,
        brow,
        chin,
        nose,
    ]))
}

/// The way the sword points.
const SWORD: DVec3 = DVec3::new(-0.12, 0.9, 0.42);

fn sword_blade() -> Solid {
    let (hilt, length) = (SWORD_HAND + SWORD * 0.5, 5.4);
    let path: Vec<_> = (0..=14)
        .map(|i| {
            let t = f64::from(i) / 14.0;
            (hilt + SWORD * length * t, if i == 14 { 0.0 } else { 0.36 * (1.0 - 0.35 * t) * smoothstep(1.08, 0.86, t) })
        })
        .collect();
    Solid::sweep(&path, &beam(1.0, 0.22, 0.18))
}

fn knights_leather() -> Solid {
    let grip = Solid::rod(SWORD_HAND - SWORD * 0.9, SWORD_HAND + SWORD * 0.6, 0.13, 14);
    let belt = Solid::hoop(&[[0.92, 5.15], [1.1, 5.15], [1.1, 5.45], [0.95, 5.45]], 32).scaled(1.0, 1.0, 0.84);
    let scabbard = Solid::sweep(
        &[
            (dvec3(1.15, 5.2, 0.1), 0.22),
            (dvec3(1.45, 4.0, -0.7), 0.24),
            (dvec3(1.75, 2.3, -1.8), 0.16),
            (dvec3(1.8, 2.0, -1.95), 0.0),
        ],
        &beam(0.5, 1.0, 0.3),
    );
    let glove = Solid::sphere(0.3, 10, 6).at(SHIELD_HAND.x, SHIELD_HAND.y, SHIELD_HAND.z + 0.1);
    Solid::all([grip, belt, scabbard, glove])
}

/// A cloak from the shoulders to the calves, blown back a little.
fn cape() -> Solid {
    Solid::slab(28, 15, |u, v| {
        let fall = 1.0 - v;
        let width = mix(1.25, 2.1, fall);
        let across = 2.0 * u - 1.0;
        let fold = 0.2 * fall * sin_cos(across * 760.0 + 70.0 * fall).1;
        let z = -0.95 - 0.5 * fall - 1.15 * fall * fall + 0.45 * across * across * (1.0 - 0.5 * fall) + fold;
        let front = dvec3(-width * across, mix(7.85, 1.1, fall) + 0.1 * sin_cos(across * 400.0).0 * fall, z);
        // Its outside looks back: u runs from the left hand to the right seen from behind.
        (front, front + DVec3::Z * 0.08)
    })
}

fn plume() -> Solid {
    let mut random = Random::new(21);
    let feather = |i: i32, random: &mut Random| {
        let side = (f64::from(i) - 6.0) / 6.0;
        let lean = random.between(-0.12, 0.12);
        let knots = [
            (dvec3(0.05 * side, 9.55, 0.15), 0.1),
            (dvec3(0.22 * side + lean, 10.35, 0.05 + lean), 0.2),
            (dvec3(0.45 * side + lean, 10.6, -0.75), 0.22),
            (dvec3(0.62 * side, 9.9 + lean, -1.5), 0.17),
            (dvec3(0.7 * side, 8.9 + 2.0 * lean, -1.75), 0.05),
        ];
        limb(&knots, 3, 6)
    };
    Solid::all((0..13).map(|i| feather(i, &mut random)))
}

/// Where the shield hangs; its middle, with the outside towards +Z.
fn shield_place(ahead: f64) -> glam::DAffine3 {
    let rotation = turn(DVec3::Y, 32.0);
    glam::DAffine3::from_rotation_translation(
        rotation,
        SHIELD_HAND + dvec3(0.25, -0.3, 0.5) + rotation * DVec3::Z * ahead,
    )
}

/// A shield with a flat top and a point below, bent around the arm.
fn heater_shield(ahead: f64) -> Solid {
    Solid::slab(14, 20, |u, v| {
        let across = 2.0 * u - 1.0;
        let width =
            1.25 * libm::sqrt((1.0 - libm::pow(1.0 - smoothstep(0.0, 1.25, v + 0.02) * 1.02, 2.4)).max(0.0)).max(0.03);
        let y = mix(-2.1, 1.5, v);
        let z = -0.42 * (across * width / 1.25) * (across * width / 1.25) + 0.12;
        (dvec3(width * across, y, z), dvec3(0.97 * width * across, y, z - 0.14))
    })
    .transformed(&shield_place(ahead))
}

/// A dwarf.
pub(super) fn dwarf(name: &str, colours: DwarfsColours) -> Mesh {
    let mut sculpture = Sculpture::default();
    sculpture.add(colours.skin, SMOOTH, &dwarfs_skin());
    sculpture.add(colours.beard, SMOOTH, &dwarfs_beard());
    sculpture.add(colours.tunic, SMOOTH, &dwarfs_tunic());
    sculpture.add(colours.leather, SMOOTH, &dwarfs_leather());
    sculpture.add(colours.iron, 35.0, &dwarfs_iron());
    sculpture.finish(name)
}

const AXE_HAND: DVec3 = DVec3::new(-2.1, 2.9, 1.5);
const FREE_HAND: DVec3 = DVec3::new(2.2, 2.3, 0.75);

fn dwarfs_skin() -> Solid {
    let head = Solid::sphere(1.0, 22, 14).scaled(0.95, 1.0, 0.95).at(0.0, 5.5, 0.1);
    let nose = Solid::sphere(0.27, 14, 9).scaled(1.0, 0.9, 1.15).at(0.0, 5.42, 1.12);
    let cheek = Solid::sphere(0.3, 12, 7).scaled(1.0, 0.8, 0.7).at(0.45, 5.35, 0.85).and_mirrored();
    let ear = Solid::sphere(0.28, 10, 7).scaled(0.5, 1.0, 0.8).at(0.96, 5.4, 0.05).and_mirrored();
    let hand = |at: DVec3, side: f64| {
        let palm = Solid::sphere(0.4, 12, 8).at(at.x, at.y, at.z);
        let finger = |i: i32| {
            let place = at + dvec3(0.0, 0.17 * (f64::from(i) - 1.5), 0.0);
            limb(
                &[
                    (place + dvec3(0.3 * side, 0.0, 0.1), 0.13),
                    (place + dvec3(0.05 * side, 0.0, 0.43), 0.13),
                    (place - dvec3(0.28 * side, 0.0, -0.15), 0.1),
                ],
                3,
                6,
            )
        };
        Solid::all((0..4).map(finger).chain([palm]))
    };
    Solid::all([head, nose, cheek, ear, hand(AXE_HAND, -1.0), hand(FREE_HAND, 1.0)])
}

fn dwarfs_beard() -> Solid {
    let mut random = Random::new(7);
    let mut strands = Vec::new();
    for row in 0..3 {
        let count = 13 - 2 * row;
        for i in 0..count {
            let across = 2.0 * f64::from(i) / f64::from(count - 1) - 1.0;
            let length = (2.6 - 0.35 * f64::from(row)) * (1.0 - 0.45 * across * across) + random.between(-0.15, 0.15);
            let (sin, cos) = sin_cos(mix(14.0, 166.0, 0.5 + 0.5 * across));
            let root = dvec3(-0.86 * cos, 5.2 - 0.12 * f64::from(row) + 0.25 * across * across, 0.1 + 0.86 * sin);
            let out = 0.36 + 0.09 * f64::from(row);
            let knots = [
                (root, 0.16),
                (root + dvec3(-0.12 * cos, -0.3 * length, out), 0.22),
                (root + dvec3(0.1 * cos + random.between(-0.08, 0.08), -0.65 * length, out + 0.15), 0.17),
                (root + dvec3(0.42 * cos, -length, out - 0.05), 0.03),
            ];
            strands.push(limb(&knots, 3, 6));
        }
    }
    let moustache = limb(
        &[
            (dvec3(0.05, 5.2, 1.12), 0.15),
            (dvec3(0.45, 5.1, 1.2), 0.2),
            (dvec3(0.9, 4.8, 1.05), 0.14),
            (dvec3(1.2, 4.4, 0.95), 0.03),
        ],
        4,
        8,
    );
    let brow =
        limb(&[(dvec3(0.12, 5.72, 1.0), 0.09), (dvec3(0.42, 5.82, 0.95), 0.13), (dvec3(0.72, 5.7, 0.75), 0.05)], 3, 6);
    let braid = |side: f64| {
        // A string of beads along a curve reads as plaited hair.
        Solid::all((0..7).map(|i| {
            let t = f64::from(i) / 6.0;
            let size = mix(0.27, 0.17, t);
            Solid::sphere(size, 9, 6).scaled(1.0, 1.2, 1.0).at(
                side * (0.85 + 0.12 * sin_cos(t * 260.0).0),
                mix(4.9, 2.9, t),
                -0.65 - 0.35 * t,
            )
        }))
    };
    Solid::all(strands.into_iter().chain([moustache.and_mirrored(), brow.and_mirrored(), braid(1.0), braid(-1.0)]))
}

fn dwarfs_tunic() -> Solid {
    let knots = [(1.25, 1.9), (1.5, 2.4), (1.66, 3.0), (1.68, 3.5), (1.55, 4.1), (1.25, 4.6), (0.8, 4.85)];
    let mut profile = vec![[0.0, 1.85]];
    profile.extend(rounded(&knots.map(|(r, y)| (dvec3(r, y, 0.0), 0.0)), 3).iter().map(|(p, _)| [p.x, p.y]));
    profile.push([0.0, 4.95]);
    let belly = Solid::lathe(&profile, 32).bent(|p| dvec3(p.x * 1.04, p.y, p.z * if p.z > 0.0 { 0.96 } else { 0.82 }));
    let sleeve = |hand: DVec3, side: f64| {
        let (shoulder, elbow) = (dvec3(1.35 * side, 4.35, 0.0), dvec3(2.15 * side, 3.2, -0.15));
        limb(
            &[
                (shoulder, 0.62),
                (shoulder.lerp(elbow, 0.5), 0.56),
                (elbow, 0.47),
                (elbow.lerp(hand, 0.6), 0.46),
                (elbow.lerp(hand, 0.85), 0.5),
            ],
            3,
            16,
        )
    };
    let trousers = |ahead: f64| {
        let z = 0.5 * ahead;
        limb(
            &[
                (dvec3(0.7 * ahead, 2.2, 0.0), 0.72),
                (dvec3(0.78 * ahead, 1.5, z), 0.68),
                (dvec3(0.82 * ahead, 0.95, 1.2 * z), 0.58),
            ],
            4,
            16,
        )
    };
    Solid::all([
        belly,
        skirt([1.6, 2.7], [1.95, 1.35], 12.0, 0.045),
        sleeve(AXE_HAND, -1.0),
        sleeve(FREE_HAND, 1.0),
        trousers(1.0),
        trousers(-1.0),
    ])
}

fn dwarfs_leather() -> Solid {
    let boot = |ahead: f64| {
        let (x, z) = (0.84 * ahead, 0.65 * ahead);
        let shaft = limb(&[(dvec3(x, 0.15, z), 0.5), (dvec3(x, 0.7, z), 0.52), (dvec3(x, 1.3, z * 0.95), 0.66)], 3, 16);
        let fold = Solid::hoop(&[[0.5, 1.1], [0.74, 1.08], [0.78, 1.3], [0.56, 1.42]], 20).at(x, 0.0, z * 0.97);
        let toe = dome([0.58, 0.62, 1.05], 18, 7).at(x, 0.0, z + 0.4);
        Solid::all([shaft, fold, toe])
    };
    let belt = Solid::hoop(&[[1.5, 2.55], [1.78, 2.55], [1.78, 2.95], [1.5, 2.95]], 32).scaled(1.03, 1.0, 0.98);
    let strap = |side: f64| {
        limb(
            &[
                (dvec3(1.0 * side, 2.8, 1.42), 0.14),
                (dvec3(1.08 * side, 3.8, 1.32), 0.14),
                (dvec3(0.95 * side, 4.72, 0.5), 0.14),
                (dvec3(0.95 * side, 4.2, -1.0), 0.14),
            ],
            4,
            7,
        )
    };
    let pack = Solid::sphere(1.0, 18, 10).bent(|p| {
        let square = |v: f64| v * (1.3 - 0.3 * v.abs());
        dvec3(1.15 * square(p.x), 1.2 * square(p.y), 0.75 * square(p.z))
    });
    let bedroll = Solid::rod(dvec3(-1.35, 4.95, -1.75), dvec3(1.35, 4.95, -1.75), 0.42, 18);
    let pouch = Solid::sphere(0.45, 12, 7).scaled(0.7, 1.0, 1.0).at(1.75, 2.3, 0.5);
    Solid::all([boot(1.0), boot(-1.0), belt, strap(1.0), strap(-1.0), pack.at(0.0, 3.6, -1.7), bedroll, pouch])
}

fn dwarfs_iron() -> Solid {
    let mut profile = vec![[0.0, 5.78], [0.9, 5.8], [1.12, 5.82], [1.14, 6.02], [1.04, 6.08]];
    profile.extend((1..=7).map(|i| {
        let (sin, cos) = sin_cos(90.0 / 7.0 * f64::from(i));
        [if i == 7 { 0.0 } else { 1.02 * cos }, 6.08 + 1.1 * sin]
    }));
    let cap = Solid::lathe(&profile, 28).at(0.0, 0.0, 0.05);
    let comb = Solid::slab(12, 2, |u, v| {
        let (sin, cos) = sin_cos(mix(20.0, 160.0, u));
        let radius = mix(0.96, 1.22, v);
        let at = dvec3(0.0, 6.1 + 1.06 * radius * sin, 0.05 + radius * cos);
        (at + DVec3::X * 0.1, at - DVec3::X * 0.1)
    });
    let horn = limb(
        &[
            (dvec3(0.85, 6.25, 0.0), 0.33),
            (dvec3(1.5, 6.4, 0.05), 0.28),
            (dvec3(1.95, 6.85, 0.1), 0.19),
            (dvec3(1.95, 7.5, 0.15), 0.02),
        ],
        4,
        12,
    );
    let nasal = Solid::bevelled([0.22, 0.8, 0.14], 0.05).at(0.0, 5.78, 1.12);
    let buckle = Solid::bevelled([0.75, 0.62, 0.2], 0.08).at(0.0, 2.75, 1.72);
    // The axe: a haft from the ground up and a blade on either side.
    let (foot, top) = (dvec3(-2.1, 0.6, 1.95), dvec3(-2.1, 6.5, 1.2));
    let haft = Solid::tube(&[(foot, 0.14), (foot.lerp(top, 0.9), 0.14), (top, 0.17)], 14);
    let spike = Solid::cone(0.16, 0.0, 0.7, 12).at(top.x, top.y - 0.05, top.z);
    let blade = Solid::slab(5, 12, |u, v| {
        let (sin, cos) = sin_cos(mix(-62.0, 62.0, v));
        let reach = mix(0.1, 1.35 * (0.75 + 0.25 * cos), u);
        let at = dvec3(reach, mix(0.4 * sin, 1.15 * sin, u), 0.0);
        let thickness = mix(0.16, 0.015, u);
        (at + DVec3::Z * thickness, at - DVec3::Z * thickness)
    });
    let blades =
        blade.clone().and(blade.turned(DVec3::Y, 180.0)).turned(DVec3::Y, 60.0).at(top.x, top.y - 0.75, top.z + 0.1);
    let knob = Solid::sphere(0.22, 10, 6).at(foot.x, foot.y, foot.z);
    let rivet = |i: i32| {
        let (sin, cos) = sin_cos(30.0 * f64::from(i));
        Solid::sphere(0.09, 7, 4).at(1.12 * cos, 5.93, 0.05 + 1.12 * sin)
    };
    Solid::all((0..12).map(rivet).chain([cap, comb, horn.and_mirrored(), nasal, buckle, haft, spike, blades, knob]))
}
