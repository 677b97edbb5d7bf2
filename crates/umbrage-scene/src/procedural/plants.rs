//! Palms and cactuses for the desert, pines for the mine. All stand on y = 0, their feet a little
//! below it.

use glam::{DVec3, dvec3};

use super::figures::rounded;
use super::maths::{Random, mix, scramble, sin_cos, smoothstep, turn, unit};
use super::sculpt::Sculpture;
use super::shapes::{Solid, ribbed};
use crate::{Mesh, Texture, TextureFilter, Wrap};

const SMOOTH: f64 = 60.0;

/// Indices of a palm's materials; `leaf` is double-sided.
#[derive(Clone, Copy, Debug)]
pub(super) struct PalmsColours {
    pub(super) bark: usize,
    pub(super) leaf: usize,
    pub(super) dry_leaf: usize,
    pub(super) fruit: usize,
}

/// Makes a date palm, about 12 m tall. Every seed gives another one.
pub(super) fn palm(name: &str, seed: u64, colours: PalmsColours) -> Mesh {
    let mut random = Random::new(seed);
    let mut sculpture = Sculpture::default();
    let lean = dvec3(random.between(-1.6, 1.6), 0.0, random.between(-1.6, 1.6));
    let height = random.between(8.6, 10.0);
    let trunk_at = |t: f64| lean * t * t + DVec3::Y * (height * t);
    // Every ring is the scar of a leaf: wide above, narrow below.
    let rings = 56;
    let trunk: Vec<_> = (0..=rings)
        .map(|i| {
            let t = f64::from(i) / f64::from(rings);
            let scar = if i % 2 == 0 { 0.055 } else { 0.0 };
            let swell = 0.3 * smoothstep(0.12, 0.0, t) + 0.16 * smoothstep(0.8, 1.0, t);
            (trunk_at(t) - DVec3::Y * 0.4 * (1.0 - t), 0.42 - 0.1 * t + scar + swell)
        })
        .collect();
    sculpture.add(colours.bark, 30.0, &Solid::tube(&trunk, 16));
    let heart = trunk_at(1.0);
    sculpture.add(
        colours.bark,
        SMOOTH,
        &Solid::sphere(0.62, 14, 8).scaled(1.0, 1.3, 1.0).at(heart.x, heart.y, heart.z),
    );

    for i in 0..24 {
        // The golden angle spreads fronds evenly; the later, the steeper.
        let bearing = 137.507_764 * f64::from(i) + random.between(-8.0, 8.0);
        let rise = mix(-12.0, 68.0, f64::from(i) / 23.0) + random.between(-4.0, 4.0);
        let length = random.between(4.3, 5.2);
        frond(&mut sculpture, [colours.bark, colours.leaf], heart, [bearing, rise, length], 1.0);
    }
    for i in 0..6 {
        let bearing = 60.0 * f64::from(i) + random.between(-15.0, 15.0);
        frond(&mut sculpture, [colours.bark, colours.dry_leaf], heart - DVec3::Y * 0.4, [bearing, -42.0, 3.3], 0.7);
    }
    let dates = (0..3).flat_map(|bunch| {
        let (sin, cos) = sin_cos(120.0 * f64::from(bunch) + 25.0);
        let stalk = heart + dvec3(1.05 * cos, -0.75, 1.05 * sin);
        (0..14).map(move |i| {
            let (s, c) = sin_cos(137.5 * f64::from(i));
            let t = f64::from(i) / 13.0;
            let out = 0.28 * sin_cos(180.0 * t).0;
            Solid::sphere(0.14, 6, 4).at(stalk.x + out * c, stalk.y - 0.75 * t, stalk.z + out * s)
        })
    });
    sculpture.add(colours.fruit, SMOOTH, &Solid::all(dates));
    sculpture.finish(name)
}

/// One leaf of a palm: a rib that bends under its weight and leaflets on both sides. `[bearing,
/// rise, length]`.
fn frond(
    sculpture: &mut Sculpture,
    [rib, leaf]: [usize; 2],
    root: DVec3,
    [bearing, rise, length]: [f64; 3],
    fullness: f64,
) {
    const LEAFLETS: i32 = 26;
    let heading = turn(DVec3::Y, bearing) * DVec3::X;
    let side = turn(DVec3::Y, bearing) * DVec3::Z;
    let (sin, cos) = sin_cos(rise);
    let along = |t: f64| {
        let droop = 0.55 * length * t * t * (0.45 + 0.55 * cos.max(0.0));
        root + heading * (length * t * cos) + DVec3::Y * (length * t * sin - droop)
    };
    let path: Vec<_> = (0..=9)
        .map(|i| {
            let t = f64::from(i) / 9.0;
            (along(t), if i == 9 { 0.0 } else { mix(0.11, 0.03, t) })
        })
        .collect();
    sculpture.add(rib, SMOOTH, &Solid::tube(&path, 4));
    for i in 0..LEAFLETS {
        let t = mix(0.16, 0.99, f64::from(i) / f64::from(LEAFLETS - 1));
        let at = along(t);
        let forward = (along((t + 0.01).min(1.0)) - along(t - 0.01)).normalize();
        let up = side.cross(forward).normalize();
        let up = if up.y < 0.0 { -up } else { up };
        let reach = fullness * 1.15 * (0.35 + 0.65 * sin_cos(180.0 * libm::pow(t, 0.8)).0);
        for hand in [-1.0, 1.0] {
            let out = (side * hand + 0.75 * forward + 0.28 * up).normalize();
            let across = forward * (0.085 * fullness);
            let bend = |s: f64| at + out * (reach * s) - DVec3::Y * (0.3 * reach * s * s);
            let rows: Vec<Vec<DVec3>> = [(0.0, 0.55), (0.45, 1.0), (1.0, 0.06)]
                .iter()
                .map(|&(s, width)| vec![bend(s) - across * width, bend(s) + across * width])
                .collect();
            let normal = (up - 0.3 * out).normalize();
            sculpture.sheet(leaf, &rows, normal);
        }
    }
}

/// Indices of a cactus' materials.
#[derive(Clone, Copy, Debug)]
pub(super) struct CactusColours {
    pub(super) flesh: usize,
    pub(super) spine: usize,
    pub(super) flower: usize,
}

/// Makes a saguaro, about 10 m tall. Every seed gives another one.
pub(super) fn cactus(name: &str, seed: u64, colours: CactusColours) -> Mesh {
    let mut random = Random::new(seed);
    let mut columns = Vec::new();
    let height = random.between(8.6, 10.2);
    let trunk = [
        (dvec3(0.0, -0.4, 0.0), 0.78),
        (dvec3(0.0, 1.5, 0.0), 0.92),
        (dvec3(0.05, 0.5 * height, 0.0), 1.05),
        (dvec3(0.1, 0.85 * height, 0.05), 0.98),
        (dvec3(0.1, height, 0.05), 0.8),
    ];
    columns.push((rounded(&trunk, 5), 15));
    let arms = 2 + random.index(3);
    for i in 0..arms {
        let bearing = 360.0 * i as f64 / arms as f64 + random.between(-30.0, 30.0);
        let heading = turn(DVec3::Y, bearing) * DVec3::X;
        let (start, rise) = (random.between(0.3, 0.52) * height, random.between(2.0, 3.9));
        let at = |out: f64, up: f64| heading * out + DVec3::Y * (start + up);
        let arm = [
            (at(0.4, 0.0), 0.5),
            (at(1.35, 0.05), 0.56),
            (at(2.05, 0.42), 0.6),
            (at(2.3, 1.2), 0.62),
            (at(2.3, 0.6 + 0.6 * rise), 0.64),
            (at(2.25, 0.6 + rise), 0.5),
        ];
        columns.push((rounded(&arm, 3), 10));
    }
    let mut sculpture = Sculpture::default();
    for (mut path, ribs) in columns {
        // A round top: the last radius shrinks along a quarter circle.
        let (end, radius) = path[path.len() - 1];
        let up = (end - path[path.len() - 2].0).normalize();
        path.extend((1..=5).map(|i| {
            let (sin, cos) = sin_cos(18.0 * f64::from(i));
            (end + up * (0.9 * radius * sin), if i == 5 { 0.0 } else { radius * cos })
        }));
        sculpture.add(colours.flesh, 50.0, &Solid::sweep(&path, &ribbed(ribs, 4, 0.17)));
        let tip = end + up * 0.88 * radius;
        for i in 0..5 {
            let (sin, cos) = sin_cos(72.0 * f64::from(i));
            let petal = Solid::sphere(0.17, 7, 4).scaled(1.0, 1.3, 1.0);
            sculpture.add(colours.flower, SMOOTH, &petal.at(tip.x + 0.3 * cos, tip.y + 0.05, tip.z + 0.3 * sin));
        }
        for i in 0..60 {
            let (center, radius) = path[1 + random.index(path.len() - 8)];
            let out = turn(DVec3::Y, 360.0 / ribs as f64 * f64::from(i)) * DVec3::X;
            let from = center + out * (0.9 * radius) + DVec3::Y * random.between(-0.2, 0.2);
            let to = center + out * (radius + 0.32) + DVec3::Y * random.between(0.0, 0.25);
            sculpture.add(colours.spine, SMOOTH, &Solid::tube(&[(from, 0.022), (to, 0.0)], 3));
        }
    }
    sculpture.finish(name)
}

/// Indices of a pine's materials; `needles` shows [`bough_texture`] and is masked and double-sided.
#[derive(Clone, Copy, Debug)]
pub(super) struct PinesColours {
    pub(super) bark: usize,
    pub(super) needles: usize,
}

/// Makes a pine, about 20 m tall. Every seed gives another one.
pub(super) fn pine(name: &str, seed: u64, colours: PinesColours) -> Mesh {
    let mut random = Random::new(seed);
    let mut sculpture = Sculpture::default();
    let height = random.between(18.5, 21.5);
    let sway = dvec3(random.between(-0.5, 0.5), 0.0, random.between(-0.5, 0.5));
    let trunk_at = |t: f64| DVec3::Y * (height * t) + sway * sin_cos(200.0 * t).0;
    let trunk: Vec<_> = (0..=44)
        .map(|i| {
            let t = f64::from(i) / 44.0;
            let radius = 0.55 * (1.0 - t) + 0.35 * smoothstep(0.08, 0.0, t) + 0.02 * f64::from(i % 2);
            (trunk_at(t) - DVec3::Y * 0.6 * (1.0 - t), if i == 44 { 0.0 } else { radius.max(0.03) })
        })
        .collect();
    sculpture.add(colours.bark, 50.0, &Solid::sweep(&trunk, &ribbed(7, 3, 0.12)));
    const BOUGHS: i32 = 190;
    for i in 0..BOUGHS {
        let t = f64::from(i) / f64::from(BOUGHS - 1);
        let up = mix(0.17, 0.985, libm::pow(t, 0.9));
        let root = trunk_at(up);
        let heading = turn(DVec3::Y, 137.507_764 * f64::from(i) + random.between(-12.0, 12.0)) * DVec3::X;
        let side = heading.cross(DVec3::Y);
        let length = (5.2 * libm::pow(1.0 - up, 0.85) + 0.5 - 0.15 * up) * random.between(0.82, 1.1);
        let rise = mix(-0.12, 0.75, up) + random.between(-0.08, 0.08);
        let along =
            |s: f64| root + heading * (length * s) + DVec3::Y * (length * (rise * s - 0.32 * s * s + 0.12 * s * s * s));
        let wood: Vec<_> =
            (0..=4).map(|k| f64::from(k) / 4.0).map(|s| (along(0.92 * s), 0.022 * length * (1.0 - s))).collect();
        sculpture.add(colours.bark, SMOOTH, &Solid::tube(&wood, 4));
        let normal = (heading + DVec3::Y * 0.9).normalize();
        for roll in [-38.0, 38.0] {
            let across =
                turn(heading, roll + random.between(-12.0, 12.0)) * side * (0.3 * length + 0.22 * (1.0 - 0.6 * up));
            let rows: Vec<Vec<DVec3>> = (0..=4)
                .map(|k| {
                    let s = mix(0.04, 1.06, f64::from(k) / 4.0);
                    let sag = DVec3::Y * (0.08 * length);
                    vec![along(s) - across - sag, along(s), along(s) + across - sag]
                })
                .collect();
            sculpture.card(colours.needles, &rows, normal);
        }
    }
    sculpture.finish(name)
}

/// A bough of needles for a card: transparent around twigs and needles, the branch's root at the
/// bottom.
pub(super) fn bough_texture() -> Texture {
    const WIDTH: u32 = 128;
    const HEIGHT: u32 = 256;
    // In pixels, as (from, to, half width, brightness).
    let mut strokes: Vec<([f64; 2], [f64; 2], f64, f64)> = vec![([64.0, 255.0], [64.0, 14.0], 1.6, 0.34)];
    let mut needles = |from: [f64; 2], to: [f64; 2], count: i32, reach: f64, seed: u64| {
        for i in 0..count {
            let share = f64::from(i) / f64::from(count);
            let jitter = unit(scramble(seed + i as u64)) - 0.5;
            let at = [mix(from[0], to[0], share), mix(from[1], to[1], share)];
            let along = libm::atan2(to[1] - from[1], to[0] - from[0]).to_degrees();
            for hand in [-1.0, 1.0] {
                let (sin, cos) = sin_cos(along + hand * (42.0 + 22.0 * jitter));
                let length = reach * (1.0 - 0.35 * share) * (0.8 + 0.4 * jitter.abs());
                let tip = [at[0] + length * cos, at[1] + length * sin];
                strokes.push((at, tip, 1.15, 0.62 + 0.38 * unit(scramble(seed ^ (0xABCD + i as u64)))));
            }
        }
    };
    needles([64.0, 235.0], [64.0, 18.0], 46, 17.0, 1);
    for twig in 0..9_u32 {
        let y = mix(222.0, 48.0, f64::from(twig) / 8.0);
        for hand in [-1.0, 1.0] {
            let reach = mix(56.0, 24.0, f64::from(twig) / 8.0);
            let from = [64.0, y + 5.0 * hand];
            let to = [64.0 + hand * reach, y - 0.62 * reach + 5.0 * hand];
            needles(from, to, 20, 13.0, 100 + 10 * u64::from(twig) + u64::from(hand > 0.0));
        }
    }
    for twig in 0..9_u32 {
        let y = mix(222.0, 48.0, f64::from(twig) / 8.0);
        let reach = mix(54.0, 22.0, f64::from(twig) / 8.0);
        for hand in [-1.0, 1.0] {
            strokes.push(([64.0, y + 5.0 * hand], [64.0 + hand * reach, y - 0.62 * reach + 5.0 * hand], 0.9, 0.4));
        }
    }
    let mut coverage = vec![0.0_f64; (WIDTH * HEIGHT) as usize];
    let mut brightness = vec![0.75_f64; (WIDTH * HEIGHT) as usize];
    for (from, to, half_width, bright) in strokes {
        let low = |axis: usize| (from[axis].min(to[axis]) - 3.0).max(0.0) as u32;
        let high = |axis: usize, size: u32| ((from[axis].max(to[axis]) + 4.0).max(0.0) as u32).min(size);
        for y in low(1)..high(1, HEIGHT) {
            for x in low(0)..high(0, WIDTH) {
                let (px, py) = (f64::from(x) + 0.5 - from[0], f64::from(y) + 0.5 - from[1]);
                let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
                let share = ((px * dx + py * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
                let distance = libm::hypot(px - share * dx, py - share * dy);
                let cover = (half_width * (1.0 - 0.6 * share) + 0.5 - distance).clamp(0.0, 1.0);
                let pixel = (y * WIDTH + x) as usize;
                if cover > 0.0 {
                    brightness[pixel] = mix(brightness[pixel], bright, cover);
                    coverage[pixel] = coverage[pixel].max(cover);
                }
            }
        }
    }
    let byte = |value: f64| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    // Colour goes on where alpha is 0, so that filtering draws no dark seam around the needles.
    let rgba = coverage
        .iter()
        .zip(&brightness)
        .flat_map(|(&cover, &bright)| [byte(0.36 * bright), byte(0.52 * bright), byte(0.27 * bright), byte(cover)])
        .collect();
    Texture { width: WIDTH, height: HEIGHT, rgba, wrap: [Wrap::Clamp; 2], filter: TextureFilter::Linear }
}
