//! A knight in plate armour, with sword and shield.

use glam::{DVec3, dvec3};

use super::{SMOOTH, dome, limb, rounded, skirt};
use crate::Mesh;
use crate::procedural::maths::{Random, mix, sin_cos, smoothstep, turn};
use crate::procedural::sculpt::Sculpture;
use crate::procedural::shapes::{Solid, beam};

/// Materials of a knight's parts, as indices.
#[derive(Clone, Copy, Debug)]
pub(in crate::procedural) struct KnightsColours {
    pub(in crate::procedural) steel: usize,
    pub(in crate::procedural) brass: usize,
    pub(in crate::procedural) cloth: usize,
    pub(in crate::procedural) leather: usize,
}

/// Makes a knight.
pub(in crate::procedural) fn knight(name: &str, colours: KnightsColours) -> Mesh {
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

/// Returns hip, knee and ankle of the leg that is ahead (1) or behind (−1).
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

/// Direction in which the sword points.
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

/// Returns the transform of the shield: its middle, with the outside towards +Z.
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
