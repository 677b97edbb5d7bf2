//! War robots: four makes, about 1,480 triangles each. They face +Z, stand on y = 0 and are 10 m
//! tall at scale 1.

use glam::{DVec3, dvec3};

use super::maths::sin_cos;
use super::sculpt::Sculpture;
use super::shapes::{Solid, beam};
use crate::Mesh;

/// Materials of a robot's parts, as indices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Livery {
    pub(super) armour: usize,
    pub(super) metal: usize,
    pub(super) glass: usize,
}

/// The makes of robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Make {
    /// Two arms that end in three barrels each.
    Gunner,
    /// One claw, one gun, a rack of rockets on the shoulder.
    Wrecker,
    /// A cabin on two bird's legs, guns at its sides.
    Walker,
    /// A shield, a blade, and a cannon over the shoulder.
    Guard,
}

impl Make {
    pub(super) const ALL: [Self; 4] = [Self::Gunner, Self::Wrecker, Self::Walker, Self::Guard];
}

const FLAT: f64 = 30.0;
const ROUND: f64 = 50.0;

/// Makes a robot. No part of it is further than [`REACH`] from its axis.
pub(super) fn robot(make: Make, livery: Livery) -> Mesh {
    let mut parts = Parts::default();
    match make {
        Make::Gunner => {
            legs(&mut parts, 1.0);
            torso(&mut parts);
            head(&mut parts, 8.2);
            shoulders(&mut parts, 1.0);
            gun_arm(&mut parts, 1.0);
            gun_arm(&mut parts, -1.0);
            antenna(&mut parts, dvec3(-0.9, 8.2, -0.9), 2.4);
        }
        Make::Wrecker => {
            legs(&mut parts, 1.1);
            torso(&mut parts);
            head(&mut parts, 8.2);
            shoulders(&mut parts, 0.9);
            gun_arm(&mut parts, -1.0);
            claw_arm(&mut parts);
            rocket_rack(&mut parts);
            antenna(&mut parts, dvec3(0.8, 8.2, -0.9), 1.8);
        }
        Make::Walker => {
            bird_legs(&mut parts);
            cabin(&mut parts);
            antenna(&mut parts, dvec3(0.9, 8.6, -1.2), 2.2);
            antenna(&mut parts, dvec3(0.5, 8.6, -1.3), 1.4);
        }
        Make::Guard => {
            legs(&mut parts, 1.05);
            torso(&mut parts);
            head(&mut parts, 8.2);
            shoulders(&mut parts, 1.15);
            blade_arm(&mut parts);
            shield_arm(&mut parts);
            shoulder_cannon(&mut parts);
            antenna(&mut parts, dvec3(-0.6, 8.2, -1.0), 2.0);
        }
    }
    let mut sculpture = Sculpture::default();
    sculpture.add(livery.armour, FLAT, &parts.armour);
    sculpture.add(livery.metal, ROUND, &parts.metal);
    sculpture.add(livery.glass, ROUND, &parts.glass);
    sculpture.finish(&format!("{make:?}").to_lowercase())
}

/// Distance in metres from a robot's axis to its farthest part, at scale 1.
pub(super) const REACH: f64 = 5.6;

#[derive(Default)]
struct Parts {
    armour: Solid,
    metal: Solid,
    glass: Solid,
}

impl Parts {
    fn armour(&mut self, solid: Solid) {
        self.armour = std::mem::take(&mut self.armour).and(solid);
    }

    fn metal(&mut self, solid: Solid) {
        self.metal = std::mem::take(&mut self.metal).and(solid);
    }

    fn glass(&mut self, solid: Solid) {
        self.glass = std::mem::take(&mut self.glass).and(solid);
    }
}

/// A wheel or drum with its axis along X.
fn drum(radius: f64, width: f64, segments: usize) -> Solid {
    Solid::cone(radius, radius, width, segments).at(0.0, -0.5 * width, 0.0).turned(DVec3::Z, -90.0)
}

fn foot(parts: &mut Parts, x: f64, z: f64) {
    let toe = |dx: f64, turn: f64| {
        Solid::block([0.62, 1.5], [0.4, 1.0], 0.5, 0.0).at(0.0, 0.0, 1.0).turned(DVec3::Y, turn).at(x + dx, 0.0, z)
    };
    parts.armour(Solid::all([toe(0.28, 9.0), toe(-0.28, -9.0)]).and_mirrored());
    parts.metal(Solid::block([1.0, 0.9], [0.7, 0.6], 0.75, 0.12).at(x, 0.0, z).and_mirrored());
    parts.armour(Solid::block([0.7, 0.8], [0.45, 0.4], 0.55, 0.0).at(x, 0.0, z - 0.75).and_mirrored());
}

fn legs(parts: &mut Parts, stance: f64) {
    let hip = dvec3(0.95, 4.35, 0.0);
    let knee = dvec3(1.35 * stance, 2.75, 0.45);
    let ankle = dvec3(1.45 * stance, 0.75, -0.05);
    foot(parts, ankle.x, ankle.z);
    let shin = Solid::sweep(&[(ankle, 0.45), (knee, 0.62)], &beam(1.0, 0.9, 0.3));
    let thigh = Solid::sweep(&[(knee, 0.45), (hip, 0.58)], &beam(0.9, 1.0, 0.3));
    parts.armour(Solid::all([shin, thigh]).and_mirrored());
    let guard =
        Solid::block([0.75, 0.4], [0.5, 0.2], 1.1, 0.0).turned(DVec3::X, -8.0).at(knee.x, knee.y - 0.35, knee.z + 0.55);
    parts.armour(guard.and_mirrored());
    let piston = Solid::rod(
        ankle.lerp(knee, 0.1) + dvec3(0.0, 0.0, -0.62),
        knee.lerp(hip, 0.4) + dvec3(0.0, 0.0, -0.75),
        0.11,
        4,
    );
    parts.metal(
        Solid::all([
            drum(0.52, 1.25, 8).at(knee.x, knee.y, knee.z),
            drum(0.6, 0.9, 8).at(hip.x, hip.y, hip.z),
            drum(0.36, 0.8, 6).at(ankle.x, ankle.y, ankle.z),
            piston,
        ])
        .and_mirrored(),
    );
    parts.metal(Solid::block([1.5, 1.1], [1.9, 1.4], 0.9, 0.2).at(0.0, 4.05, 0.0));
    parts.armour(Solid::block([0.5, 0.3], [0.9, 0.4], 1.2, 0.0).at(0.0, 3.7, 0.72));
}

fn torso(parts: &mut Parts) {
    parts.metal(Solid::cone(0.75, 0.75, 0.9, 8).at(0.0, 4.8, 0.0));
    let trunk = [(5.25, [1.7, 1.4]), (6.1, [2.7, 2.0]), (7.5, [3.5, 2.5]), (8.15, [2.7, 1.8])];
    parts.armour(Solid::stack(&trunk, 0.35));
    parts.armour(
        Solid::block([0.9, 0.4], [1.2, 0.5], 1.2, 0.12).turned(DVec3::X, 7.0).at(0.72, 6.4, 1.0).and_mirrored(),
    );
    for slat in 0..3 {
        parts.metal(Solid::cuboid([1.3, 0.14, 0.3]).at(0.0, 5.65 + 0.27 * f64::from(slat), 0.9));
    }
    parts.armour(Solid::block([1.8, 0.7], [2.2, 1.0], 1.9, 0.2).at(0.0, 5.95, -1.4));
    let exhaust = Solid::tube(&[(dvec3(0.65, 6.4, -1.9), 0.24), (dvec3(0.72, 8.5, -2.15), 0.3)], 6);
    parts.metal(exhaust.and_mirrored());
}

fn head(parts: &mut Parts, y: f64) {
    parts.metal(Solid::cone(0.42, 0.36, 0.5, 6).at(0.0, y - 0.15, 0.0));
    parts.armour(
        Solid::stack(&[(0.0, [0.8, 0.9]), (0.35, [1.15, 1.25]), (0.85, [1.1, 1.15]), (1.15, [0.6, 0.7])], 0.18).at(
            0.0,
            y + 0.2,
            0.05,
        ),
    );
    parts.glass(Solid::cuboid([0.85, 0.22, 0.3]).at(0.0, y + 0.85, 0.58));
    parts.metal(Solid::cuboid([0.5, 0.3, 0.3]).at(0.0, y + 0.4, 0.62));
    parts.metal(drum(0.24, 0.2, 6).at(0.62, y + 0.75, 0.05).and_mirrored());
    // A crest, so that a head's shadow has a front and a back.
    parts.armour(Solid::block([0.14, 1.0], [0.08, 0.4], 0.5, 0.0).at(0.0, y + 1.25, -0.05));
}

fn antenna(parts: &mut Parts, foot: DVec3, length: f64) {
    parts.metal(Solid::cone(0.16, 0.12, 0.4, 5).at(foot.x, foot.y - 0.3, foot.z));
    parts.metal(Solid::rod(foot, foot + DVec3::Y * length, 0.06, 4));
    parts.metal(Solid::sphere(0.13, 5, 3).at(foot.x, foot.y + length, foot.z));
}

fn shoulders(parts: &mut Parts, size: f64) {
    parts.metal(drum(0.5, 1.2, 6).at(2.0, 7.45, 0.0).and_mirrored());
    let plate: Vec<[f64; 2]> = (0..=3)
        .map(|i| {
            let (sin, cos) = sin_cos(30.0 * f64::from(i));
            if i == 3 { [0.0, 1.0] } else { [cos, sin] }
        })
        .collect();
    let pauldron = Solid::lathe(&plate, 8).scaled(0.95, 0.85, 1.1).scaled(size, size, size);
    parts.armour(pauldron.turned(DVec3::Z, -18.0).at(2.55, 7.35, 0.0).and_mirrored());
}

/// Upper arm and elbow on the side of `side`; returns the elbow's place on the +X side.
fn upper_arm(parts: &mut Parts, side: f64) -> DVec3 {
    let (shoulder, elbow) = (dvec3(2.6, 7.4, 0.0), dvec3(2.85, 5.75, -0.35));
    let arm = Solid::sweep(&[(shoulder, 0.48), (elbow, 0.4)], &beam(1.0, 1.0, 0.3));
    parts.armour(arm.scaled(side, 1.0, 1.0));
    parts.metal(drum(0.44, 1.0, 8).at(elbow.x, elbow.y, elbow.z).scaled(side, 1.0, 1.0));
    elbow
}

fn gun_arm(parts: &mut Parts, side: f64) {
    let elbow = upper_arm(parts, side);
    let forearm = Solid::sweep(
        &[
            (elbow + dvec3(0.0, 0.0, -0.3), 0.4),
            (elbow + dvec3(0.0, -0.1, 0.7), 0.6),
            (elbow + dvec3(0.0, -0.2, 1.9), 0.5),
        ],
        &beam(0.95, 1.0, 0.3),
    );
    parts.armour(forearm.scaled(side, 1.0, 1.0));
    let muzzle = elbow + dvec3(0.0, -0.25, 1.8);
    for barrel in 0..3 {
        let (sin, cos) = sin_cos(120.0 * f64::from(barrel) + 90.0);
        let from = muzzle + 0.27 * dvec3(cos, sin, 0.0);
        let gun = Solid::tube(&[(from, 0.15), (from + dvec3(0.0, -0.12, 1.9), 0.13)], 6);
        parts.metal(gun.scaled(side, 1.0, 1.0));
    }
    let shroud = Solid::rod(muzzle + dvec3(0.0, -0.08, 1.15), muzzle + dvec3(0.0, -0.1, 1.4), 0.46, 8);
    parts.metal(shroud.scaled(side, 1.0, 1.0));
    let magazine = Solid::cuboid([0.35, 0.9, 0.8]).at(elbow.x, elbow.y - 0.75, elbow.z + 1.0);
    parts.metal(magazine.scaled(side, 1.0, 1.0));
}

fn claw_arm(parts: &mut Parts) {
    let elbow = upper_arm(parts, 1.0);
    let wrist = elbow + dvec3(0.1, -1.2, 1.2);
    parts.armour(Solid::sweep(&[(elbow, 0.4), (elbow.lerp(wrist, 0.6), 0.6), (wrist, 0.5)], &beam(1.0, 1.0, 0.3)));
    parts.metal(Solid::sphere(0.5, 6, 3).at(wrist.x, wrist.y, wrist.z));
    for finger in 0..3 {
        let (sin, cos) = sin_cos(120.0 * f64::from(finger) + 30.0);
        let out = dvec3(cos, 0.7 * sin, -0.7 * sin);
        let along = dvec3(0.0, -0.7, 0.7);
        let path = [
            (wrist + 0.2 * out, 0.2),
            (wrist + 0.85 * out + 0.5 * along, 0.2),
            (wrist + 0.75 * out + 1.2 * along, 0.15),
            (wrist + 0.2 * out + 1.7 * along, 0.0),
        ];
        parts.metal(Solid::tube(&path, 4));
    }
}

fn rocket_rack(parts: &mut Parts) {
    let at = dvec3(-2.1, 9.0, -0.2);
    parts.metal(Solid::rod(dvec3(-2.0, 7.6, -0.3), at, 0.25, 5));
    parts.armour(Solid::block([1.5, 1.9], [1.4, 1.7], 1.1, 0.15).turned(DVec3::X, -14.0).at(at.x, at.y - 0.55, at.z));
    for row in 0..2 {
        for column in 0..3 {
            let nose = dvec3(at.x - 0.45 + 0.45 * f64::from(column), at.y - 0.02 + 0.42 * f64::from(row), at.z + 0.86);
            let (sin, cos) = sin_cos(14.0);
            let tip = nose + 0.65 * dvec3(0.0, sin, cos);
            parts.metal(Solid::tube(&[(nose, 0.15), (nose.lerp(tip, 0.45), 0.15), (tip, 0.0)], 4));
        }
    }
}

fn blade_arm(parts: &mut Parts) {
    let elbow = upper_arm(parts, 1.0);
    let fist = elbow + dvec3(0.15, -0.4, 1.7);
    parts.armour(Solid::sweep(&[(elbow, 0.4), (elbow.lerp(fist, 0.5), 0.55), (fist, 0.42)], &beam(1.0, 1.0, 0.3)));
    parts.metal(Solid::bevelled([0.75, 0.75, 0.8], 0.15).at(fist.x, fist.y, fist.z + 0.2));
    let hilt = fist + dvec3(0.0, 0.0, 0.25);
    let up = dvec3(0.12, 0.94, 0.32);
    parts.metal(Solid::rod(hilt - 0.7 * up, hilt + 0.8 * up, 0.14, 5));
    parts.metal(Solid::cuboid([0.3, 0.22, 1.2]).turned(DVec3::X, 18.0).at(hilt.x + 0.1, hilt.y + 0.75, hilt.z + 0.26));
    let blade = [(hilt + 0.7 * up, 0.3), (hilt + 3.9 * up, 0.34), (hilt + 4.7 * up, 0.0)];
    parts.armour(Solid::sweep(&blade, &beam(0.25, 1.0, 0.2)));
}

fn shield_arm(parts: &mut Parts) {
    let elbow = upper_arm(parts, -1.0) * dvec3(-1.0, 1.0, 1.0);
    let fist = elbow + dvec3(-0.2, -0.3, 1.3);
    parts.armour(Solid::sweep(&[(elbow, 0.4), (elbow.lerp(fist, 0.5), 0.5), (fist, 0.4)], &beam(1.0, 1.0, 0.3)));
    let plate = Solid::stack(&[(-2.6, [0.25, 0.6]), (-1.4, [0.42, 1.9]), (1.2, [0.42, 2.3]), (1.7, [0.3, 1.7])], 0.08);
    parts.armour(plate.turned(DVec3::Y, 62.0).at(fist.x - 0.35, fist.y - 0.1, fist.z + 0.55));
    parts.glass(Solid::cuboid([0.2, 0.25, 1.1]).turned(DVec3::Y, 62.0).at(fist.x - 0.5, fist.y + 0.75, fist.z + 0.83));
}

fn shoulder_cannon(parts: &mut Parts) {
    let mount = dvec3(1.5, 8.1, -0.9);
    parts.metal(Solid::block([0.8, 0.9], [0.5, 0.6], 0.9, 0.1).at(mount.x, mount.y - 0.2, mount.z));
    let tilt = dvec3(0.0, 0.12, 1.0);
    let breech = mount + dvec3(0.0, 0.9, 0.0);
    parts.armour(Solid::sweep(&[(breech - 1.2 * tilt, 0.4), (breech + 0.7 * tilt, 0.46)], &beam(1.0, 1.0, 0.35)));
    let barrel = [
        (breech + 0.6 * tilt, 0.27),
        (breech + 3.0 * tilt, 0.22),
        (breech + 3.02 * tilt, 0.33),
        (breech + 3.6 * tilt, 0.33),
    ];
    parts.metal(Solid::tube(&barrel, 7));
}

fn bird_legs(parts: &mut Parts) {
    let hip = dvec3(1.75, 6.0, 0.1);
    let knee = dvec3(1.95, 4.0, 1.35);
    let heel = dvec3(2.0, 2.2, -0.95);
    let ankle = dvec3(2.0, 0.75, 0.0);
    foot(parts, ankle.x, ankle.z);
    let part = |from: DVec3, to: DVec3, radius: f64| {
        Solid::sweep(&[(from, 0.75 * radius), (from.lerp(to, 0.4), radius), (to, 0.7 * radius)], &beam(0.85, 1.0, 0.3))
    };
    parts.armour(Solid::all([part(hip, knee, 0.62), part(knee, heel, 0.5), part(heel, ankle, 0.42)]).and_mirrored());
    let piston = Solid::rod(hip + dvec3(0.0, -0.6, -0.4), heel + dvec3(0.0, 0.5, 0.5), 0.1, 6);
    parts.metal(
        Solid::all([
            drum(0.62, 1.0, 8).at(hip.x, hip.y, hip.z),
            drum(0.5, 1.1, 8).at(knee.x, knee.y, knee.z),
            drum(0.42, 0.95, 8).at(heel.x, heel.y, heel.z),
            drum(0.34, 0.8, 8).at(ankle.x, ankle.y, ankle.z),
            piston,
        ])
        .and_mirrored(),
    );
    parts.metal(Solid::bevelled([2.9, 0.7, 1.0], 0.15).at(0.0, 6.0, 0.1));
}

fn cabin(parts: &mut Parts) {
    parts.metal(Solid::cone(0.7, 0.85, 0.7, 8).at(0.0, 6.1, 0.0));
    // Lying on its back: the stack's height becomes the cabin's length.
    let hull = [(-2.0, [1.5, 1.3]), (-1.3, [2.5, 2.0]), (0.6, [2.7, 2.2]), (1.6, [2.0, 1.6]), (2.1, [1.3, 1.0])];
    parts.armour(Solid::stack(&hull, 0.32).turned(DVec3::X, 90.0).at(0.0, 7.6, 0.1));
    parts.glass(Solid::bevelled([1.5, 0.4, 0.9], 0.1).turned(DVec3::X, 30.0).at(0.0, 8.25, 1.75));
    parts.metal(Solid::bevelled([1.0, 0.45, 0.7], 0.1).at(0.0, 6.75, 1.5));
    let chin_gun = |x: f64| Solid::rod(dvec3(x, 6.72, 1.7), dvec3(x, 6.65, 3.1), 0.11, 5);
    parts.metal(Solid::all([chin_gun(0.25), chin_gun(-0.25)]));
    parts.armour(Solid::bevelled([0.55, 1.0, 2.2], 0.15).at(1.95, 7.7, 0.3).and_mirrored());
    let barrel = [
        (dvec3(1.95, 7.85, 1.3), 0.19),
        (dvec3(1.95, 7.85, 3.2), 0.16),
        (dvec3(1.95, 7.85, 3.22), 0.24),
        (dvec3(1.95, 7.85, 3.7), 0.24),
    ];
    let low = Solid::tube(&barrel.map(|(at, radius)| (at - DVec3::Y * 0.45, 0.8 * radius)), 6);
    parts.metal(Solid::tube(&barrel, 6).and(low).and_mirrored());
    let exhaust =
        Solid::tube(&[(dvec3(0.7, 7.6, -1.7), 0.24), (dvec3(0.7, 8.0, -2.3), 0.24), (dvec3(0.7, 8.9, -2.5), 0.3)], 6);
    parts.metal(exhaust.and_mirrored());
    parts.armour(Solid::block([0.9, 1.1], [0.6, 0.7], 0.5, 0.12).at(-0.3, 8.65, -0.4));
    parts.metal(drum(0.5, 0.16, 10).turned(DVec3::Y, 90.0).at(-0.3, 9.75, -0.3));
    parts.metal(Solid::rod(dvec3(-0.3, 9.1, -0.4), dvec3(-0.3, 9.75, -0.35), 0.09, 6));
}
