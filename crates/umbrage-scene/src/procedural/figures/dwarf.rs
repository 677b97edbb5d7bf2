//! A dwarf with an axe.

use glam::{DVec3, dvec3};

use super::{SMOOTH, dome, limb, rounded, skirt};
use crate::Mesh;
use crate::procedural::maths::{Random, mix, sin_cos};
use crate::procedural::sculpt::Sculpture;
use crate::procedural::shapes::Solid;

/// Materials of a dwarf's parts, as indices.
#[derive(Clone, Copy, Debug)]
pub(in crate::procedural) struct DwarfsColours {
    pub(in crate::procedural) skin: usize,
    pub(in crate::procedural) beard: usize,
    pub(in crate::procedural) tunic: usize,
    pub(in crate::procedural) leather: usize,
    pub(in crate::procedural) iron: usize,
}

/// Makes a dwarf.
pub(in crate::procedural) fn dwarf(name: &str, colours: DwarfsColours) -> Mesh {
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
