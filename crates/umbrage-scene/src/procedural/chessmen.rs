//! Staunton chessmen, turned and carved: they face +Z, stand on y = 0 and are 36 to 85 m tall, for
//! squares of 87.5 m.

use glam::{DVec3, dvec3};

use super::maths::{mix, sin_cos, smoothstep};
use super::sculpt::Sculpture;
use super::shapes::Solid;
use crate::Mesh;

/// The six sorts of chessmen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Piece {
    Pawn,
    Rook,
    Knight,
    Bishop,
    Queen,
    King,
}

/// Angle in degrees below which edges are smooth; beads and rims stay sharp.
const TURNED: f64 = 38.0;
/// Number of segments around a turned piece.
const AROUND: usize = 28;

impl Piece {
    /// The back rank from a to h.
    pub(super) const BACK_RANK: [Self; 8] =
        [Self::Rook, Self::Knight, Self::Bishop, Self::Queen, Self::King, Self::Bishop, Self::Knight, Self::Rook];

    /// Returns the piece in metres, of one material.
    pub(super) fn mesh(self, name: &str, material: usize) -> Mesh {
        let solids = match self {
            Self::Pawn => pawn(),
            Self::Rook => rook(),
            Self::Knight => knight(),
            Self::Bishop => bishop(),
            Self::Queen => queen(),
            Self::King => king(),
        };
        let mut sculpture = Sculpture::default();
        for solid in &solids {
            sculpture.add(material, TURNED, solid);
        }
        sculpture.finish(name)
    }
}

/// The foot that all pieces have: plinth, bead and the sweep up to the stem. It ends at the stem's
/// radius, open upwards.
fn foot(radius: f64, height: f64, stem: f64) -> Vec<[f64; 2]> {
    let mut profile = vec![[0.0, 0.0], [radius * 0.97, 0.0], [radius, 0.06 * height], [radius, 0.2 * height]];
    for i in 1..=3 {
        let (sin, cos) = sin_cos(mix(0.0, 90.0, f64::from(i) / 3.0));
        profile.push([radius * (0.9 + 0.1 * cos), height * (0.2 + 0.22 * sin)]);
    }
    profile.push([radius * 0.78, 0.5 * height]);
    // A quarter of a hollow, from level to upright.
    for i in 1..=5 {
        let (sin, cos) = sin_cos(mix(8.0, 82.0, f64::from(i) / 5.0));
        profile.push([mix(radius * 0.76, stem, sin), height * (0.5 + 0.5 * (1.0 - cos))]);
    }
    profile
}

/// A stem that narrows in an even curve from the last radius to `top` at `height`.
fn stem(profile: &mut Vec<[f64; 2]>, top: f64, height: f64, steps: usize) {
    let [radius, from] = profile[profile.len() - 1];
    for i in 1..=steps {
        let t = i as f64 / steps as f64;
        profile.push([mix(radius, top, 1.0 - (1.0 - t) * (1.0 - t)), mix(from, height, t)]);
    }
}

/// A disc with a round rim.
fn collar(profile: &mut Vec<[f64; 2]>, radius: f64, thickness: f64) {
    let y = profile[profile.len() - 1][1];
    for angle in [-60.0, 0.0, 60.0] {
        let (sin, cos) = sin_cos(angle);
        profile.push([
            radius - 0.5 * thickness * (1.0 - cos),
            y + 0.5 * thickness * (1.0 + sin / 0.866_025_403_784_438_6),
        ]);
    }
}

/// A ball, from the neck of the given radius up to its pole.
fn ball(profile: &mut Vec<[f64; 2]>, neck: f64, radius: f64, steps: usize) {
    let y = profile[profile.len() - 1][1];
    let start = libm::acos(neck / radius).to_degrees();
    let middle = y + radius * sin_cos(start).0;
    for i in 0..=steps {
        let (sin, cos) = sin_cos(mix(-start, 90.0, i as f64 / steps as f64));
        profile.push([if i == steps { 0.0 } else { radius * cos }, middle + radius * sin]);
    }
}

fn pawn() -> Vec<Solid> {
    let mut profile = foot(13.5, 11.0, 7.6);
    stem(&mut profile, 5.0, 25.0, 3);
    collar(&mut profile, 9.0, 2.2);
    profile.push([5.6, 27.6]);
    ball(&mut profile, 5.4, 8.2, 7);
    vec![Solid::lathe(&profile, 20)]
}

fn rook() -> Vec<Solid> {
    let mut profile = foot(16.0, 12.5, 11.0);
    stem(&mut profile, 8.8, 32.0, 4);
    collar(&mut profile, 11.8, 2.2);
    profile.extend([[10.4, 34.6], [10.8, 36.5], [13.4, 38.6], [13.4, 43.0], [10.2, 43.0], [10.2, 38.0], [0.0, 37.4]]);
    let merlon = |i: i32| {
        let middle = 60.0 * f64::from(i);
        Solid::sector([10.25, 13.35], [42.6, 48.0], [middle - 17.0, middle + 17.0], 3)
    };
    let mut solids = vec![Solid::lathe(&profile, AROUND)];
    solids.extend((0..6).map(merlon));
    solids
}

fn bishop() -> Vec<Solid> {
    let mut profile = foot(14.5, 12.5, 7.6);
    stem(&mut profile, 5.0, 36.0, 5);
    collar(&mut profile, 10.0, 2.0);
    profile.push([6.6, 38.6]);
    collar(&mut profile, 8.0, 1.6);
    profile.push([5.4, 40.6]);
    let body = Solid::lathe(&profile, 22);

    // The mitre: an egg whose rings crowd together at the notch and lean there; the ring inside is
    // drawn in.
    let (base, top, widest, notch) = (40.4, 57.5, 7.6, 0.6);
    let lips = [notch - 0.05, notch - 0.035, notch, notch + 0.035, notch + 0.05];
    let heights = [0.0, 0.06, 0.14, 0.24, 0.35, 0.46].into_iter().chain(lips).chain([0.74, 0.84, 0.92, 0.965]);
    let radius = |t: f64| {
        let swell = libm::sin(std::f64::consts::PI * libm::pow(mix(0.17, 1.0, t.clamp(0.0, 1.0)), 1.2));
        widest * libm::pow(swell.max(0.0), 0.75)
    };
    let mut mitre = vec![[0.0, base]];
    mitre.extend(heights.map(|t| [radius(t), mix(base, top, t)]));
    mitre.push([0.0, top]);
    let head = Solid::lathe(&mitre, 24).bent(|p| {
        let t = (p.y - base) / (top - base);
        let around = DVec3::new(p.x, 0.0, p.z);
        let Some(direction) = around.try_normalize() else { return p };
        let lean = 0.75 * smoothstep(0.05, notch - 0.05, t) * (1.0 - smoothstep(notch + 0.05, 1.0, t));
        // Where the leaning plane of the ring meets the egg in this direction.
        let slid = (0..20).fold(t, |slid, _| 0.5 * (slid + t + lean * radius(slid) * direction.x / (top - base)));
        let depth = if (t - notch).abs() < 0.01 { smoothstep(0.05, 0.6, direction.x) } else { 0.0 };
        let drawn_in = 1.0 - 0.7 * depth;
        let height = mix(base, top, slid) - lean * radius(slid) * direction.x * (1.0 - drawn_in);
        (direction * radius(slid) * drawn_in).with_y(height)
    });
    let finial = Solid::sphere(2.1, 12, 8).at(0.0, top + 1.3, 0.0);
    vec![body, head.turned(DVec3::Y, -55.0), finial]
}

fn queen() -> Vec<Solid> {
    let mut profile = foot(16.5, 14.0, 8.6);
    stem(&mut profile, 5.8, 47.0, 5);
    collar(&mut profile, 11.4, 2.2);
    profile.push([7.0, 49.8]);
    collar(&mut profile, 9.0, 1.7);
    profile.push([6.2, 52.0]);
    for i in 1..=5 {
        let t = f64::from(i) / 5.0;
        profile.push([mix(6.2, 11.4, t * t), mix(52.0, 62.5, t)]);
    }
    profile.extend([[10.2, 62.9], [7.4, 59.6]]);
    for i in 0..=4 {
        let (sin, cos) = sin_cos(22.5 * f64::from(i));
        profile.push([if i == 4 { 0.0 } else { 6.8 * cos }, 59.6 + 5.6 * sin]);
    }
    let mut solids = vec![Solid::lathe(&profile, 32)];
    for point in 0..9 {
        let ray = Solid::tube(
            &[(dvec3(10.3, 61.6, 0.0), 1.75), (dvec3(11.1, 64.2, 0.0), 1.3), (dvec3(11.7, 66.8, 0.0), 0.0)],
            6,
        );
        solids.push(ray.turned(DVec3::Y, 40.0 * f64::from(point)));
    }
    solids.push(Solid::sphere(2.6, 12, 7).at(0.0, 66.8, 0.0));
    solids
}

fn king() -> Vec<Solid> {
    let mut profile = foot(17.0, 15.0, 9.4);
    stem(&mut profile, 6.4, 51.0, 5);
    collar(&mut profile, 12.0, 2.4);
    profile.push([7.6, 54.0]);
    collar(&mut profile, 9.6, 1.8);
    profile.push([6.8, 56.2]);
    for i in 1..=5 {
        let t = f64::from(i) / 5.0;
        profile.push([mix(6.8, 10.8, libm::pow(t, 1.6)), mix(56.2, 66.6, t)]);
    }
    profile.extend([[11.3, 67.2], [11.3, 68.4]]);
    for i in 1..=4 {
        let (sin, cos) = sin_cos(22.5 * f64::from(i));
        profile.push([if i == 4 { 0.0 } else { 10.6 * cos }, 68.4 + 4.0 * sin]);
    }
    let upright = Solid::stack(&[(71.2, [3.2, 3.2]), (77.6, [2.2, 2.4]), (85.0, [4.6, 3.2])], 0.4);
    let half_bar = Solid::stack(&[(0.0, [2.0, 2.3]), (5.2, [4.2, 3.1])], 0.4);
    let bar = half_bar.clone().turned(DVec3::Z, 90.0).and(half_bar.turned(DVec3::Z, -90.0)).at(0.0, 79.0, 0.0);
    vec![Solid::lathe(&profile, 36), Solid::sphere(2.4, 14, 8).at(0.0, 72.4, 0.0), upright, bar]
}

fn knight() -> Vec<Solid> {
    let mut profile = foot(16.0, 12.5, 11.2);
    profile.extend([[11.4, 13.4], [11.4, 14.6], [0.0, 15.4]]);
    let body = Solid::lathe(&profile, 26);

    // Drawn from its left side, looking along +X: (back or crest), (chest, throat or chin), half
    // thickness.
    let sections = [
        ([-10.2, 14.2], [10.0, 14.2], 9.2),
        ([-10.6, 18.0], [9.6, 18.0], 8.8),
        ([-10.9, 23.0], [8.3, 22.0], 8.0),
        ([-10.6, 28.5], [6.2, 26.0], 7.2),
        ([-9.6, 34.0], [3.9, 29.6], 6.5),
        ([-7.9, 39.2], [2.0, 32.6], 6.0),
        ([-5.6, 44.0], [1.1, 35.0], 5.7),
        ([-2.6, 48.0], [1.9, 36.0], 5.7),
        ([1.0, 49.8], [4.0, 35.6], 5.8),
        ([4.6, 48.6], [6.4, 34.4], 5.6),
        ([8.2, 45.4], [8.6, 33.6], 4.9),
        ([11.4, 41.6], [10.6, 32.6], 4.1),
        ([14.0, 38.0], [12.2, 31.0], 3.8),
        ([16.2, 34.8], [13.6, 29.4], 3.9),
        ([17.2, 32.2], [14.6, 28.6], 3.4),
        ([17.3, 30.4], [15.6, 28.5], 2.3),
    ];
    let head = Solid::profile(&sections, 18, 0.25);
    let ear = Solid::tube(
        &[
            (dvec3(0.6, 46.5, 3.0), 2.0),
            (dvec3(0.2, 50.5, 3.6), 2.1),
            (dvec3(-0.4, 53.4, 3.9), 1.3),
            (dvec3(-1.2, 56.4, 3.8), 0.0),
        ],
        8,
    );
    // Locks of the mane: overlapping scales along the crest.
    let lock = |i: usize| {
        let t = i as f64 / 6.0;
        let crest = sections_crest(&sections, t);
        let (out, down) = (crest.1, dvec3(crest.1.y, -crest.1.x, 0.0));
        let at = crest.0 - 1.2 * out;
        Solid::tube(
            &[
                (at - 3.4 * down, 0.0),
                (at - 1.4 * down + 0.8 * out, 1.9),
                (at + 1.6 * down + 1.7 * out, 2.3),
                (at + 4.2 * down + 2.4 * out, 1.4),
                (at + 5.6 * down + 3.3 * out, 0.0),
            ],
            7,
        )
    };
    let mane = Solid::all((0..7).map(lock));
    let forelock = Solid::tube(
        &[
            (dvec3(-1.5, 49.0, 0.0), 1.6),
            (dvec3(2.5, 50.6, 0.0), 1.7),
            (dvec3(6.6, 47.4, 0.0), 1.2),
            (dvec3(9.0, 44.0, 0.0), 0.0),
        ],
        7,
    );
    let eye = Solid::sphere(1.25, 8, 5).at(7.0, 44.0, 4.7);
    let brow =
        Solid::tube(&[(dvec3(3.9, 45.2, 4.2), 0.0), (dvec3(6.2, 46.2, 4.7), 1.0), (dvec3(9.4, 44.6, 4.0), 0.0)], 7);
    let jaw = Solid::sphere(1.0, 12, 7).scaled(4.6, 5.4, 2.6).at(4.6, 38.9, 3.9);
    let nostril = Solid::sphere(1.0, 8, 5).scaled(1.7, 1.2, 1.0).at(15.3, 33.0, 3.1);
    let both = Solid::all([ear, eye, brow, jaw, nostril]);
    let pair = both.clone().and(both.scaled(1.0, 1.0, -1.0));
    let carved = Solid::all([head, mane, forelock, pair]);
    // From "looks along +X" to "looks along +Z".
    vec![body, carved.turned(DVec3::Y, -90.0)]
}

/// Returns a place on the horse's crest (0 at the withers, 1 between the ears) and the outward
/// direction of the neck there.
fn sections_crest(sections: &[([f64; 2], [f64; 2], f64)], t: f64) -> (DVec3, DVec3) {
    let at = mix(1.2, 7.3, t);
    let (index, share) = (at.floor() as usize, at.fract());
    let point = |i: usize| dvec3(sections[i].0[0], sections[i].0[1], 0.0);
    let along = (point(index + 1) - point(index)).normalize();
    (point(index).lerp(point(index + 1), share), dvec3(-along.y, along.x, 0.0))
}
