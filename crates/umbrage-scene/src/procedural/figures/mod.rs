//! Walkers of the desert: a knight in plate armour (10 m tall at scale 1) and a dwarf (7.4 m). They
//! face +Z and stand on y = 0 in mid-stride.

mod dwarf;
mod knight;

use glam::{DVec3, dvec3};

use super::maths::{mix, sin_cos, smoothstep};
use super::shapes::Solid;

pub(super) use dwarf::{DwarfsColours, dwarf};
pub(super) use knight::{KnightsColours, knight};

const SMOOTH: f64 = 48.0;

/// Largest distance in metres of the feet from a figure's axis at scale 1, sideways and along its
/// way.
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
