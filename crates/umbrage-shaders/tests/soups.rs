//! Random triangle soups under exact edges, against all triangles: an id never darkens a point that
//! is lit. Some hundred soups in a plain test run; `cargo xtask fuzz` or `UMBRAGE_FUZZ_SOUPS` asks
//! for more, from the seed `UMBRAGE_FUZZ_SEED`.

use umbrage_shaders::layout::{RUN_TRIANGLES, Split};
use umbrage_shaders::twin::bias::{self, Receiver};
use umbrage_shaders::twin::edges::{Around, Decision, LEAST_M, LOST, PARALLEL, ROUND, Ray, Run, decided};

type Triangle = [[f64; 3]; 3];

/// Soups of a plain test run.
const SOUPS: u64 = 600;
/// Points of each.
const POINTS: usize = 6;
/// Metres between depth 0 and depth 1.
const RANGE: f64 = 100.0;
/// Metres along the light that arithmetic may move a hit by, beside [`LEAST_M`].
const UNSURE_M: f64 = 1e-3;

fn from_environment(variable: &str, otherwise: u64) -> u64 {
    std::env::var(variable).ok().map_or(otherwise, |text| text.parse().expect("a whole number"))
}

/// Numbers from a linear congruential generator (Knuth's constants).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, size: f64) -> f64 {
        size * (2.0 * self.next() - 1.0)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    fn place(&mut self, size: f64) -> [f64; 3] {
        std::array::from_fn(|_| self.within(size))
    }
}

/// Triangles with a space of their own, seen from straight above.
struct Soup {
    split: Split,
    /// Relative to the frame's origin, exactly as the rows and the stored corners have them.
    triangles: Vec<Triangle>,
    runs: Vec<Run>,
}

impl Soup {
    fn new(numbers: &mut Numbers) -> Self {
        // As far from the frame's origin as receivers are that texels of this size serve.
        let texel = 10f64.powf(2.2 * numbers.next() - 1.7);
        let far = [1.0, 30.0, 300.0][numbers.below(3)] * texel.max(0.1);
        let centre = numbers.place(far);
        let local = triangles_of(numbers, texel);
        let rows = rows_of(numbers, centre);
        let corner = |at: [f64; 3]| {
            let at: [f64; 3] = std::array::from_fn(|axis| at[axis] + centre[axis]);
            own(&rows, at).map(|x| x as f32)
        };
        let stored: Vec<[[f32; 3]; 3]> = local.iter().map(|triangle| triangle.map(corner)).collect();
        let runs: Vec<Run> = stored
            .chunks(RUN_TRIANGLES as usize)
            .map(|chunk| Run { rows: rows.map(|row| row.map(|x| x as f32)), ..Run::in_frame(chunk) })
            .collect();
        let triangles = stored.iter().map(|triangle| triangle.map(|at| frame(&rows, at.map(f64::from)))).collect();
        let split = Split {
            u_row: [(1.0 / texel) as f32, 0.0, 0.0, 0.0],
            v_row: [0.0, 0.0, (1.0 / texel) as f32, 0.0],
            depth_row: [0.0, (-1.0 / RANGE) as f32, 0.0, (0.5 + centre[1] / RANGE) as f32],
            texel_m: [texel as f32; 2],
            depth_range_m: RANGE as f32,
            size: 1024.0,
            ..Split::default()
        };
        Self { split, triangles, runs }
    }

    fn around(&self, at: &Receiver) -> Around {
        let middle = at.texel.map(f32::floor);
        let texel = f64::from(self.split.texel_m[0]);
        let [_, slope, _, offset] = self.split.depth_row.map(f64::from);
        let held = ROUND.map(|step| {
            let [x, z] = [0, 1].map(|axis| (f64::from(middle[axis] + step[axis]) + 0.5) * texel);
            let hits = self.triangles.iter().enumerate();
            let hits = hits.filter_map(|(i, triangle)| Some((height_at(triangle, x, z)?, i)));
            let nearest = hits.max_by(|a, b| a.0.total_cmp(&b.0));
            nearest.map_or((1.0, 0), |(y, i)| ((slope * y + offset) as f32, 1 + i as u32 / RUN_TRIANGLES))
        });
        Around { middle, depths: held.map(|(depth, _)| depth), ids: held.map(|(_, id)| id) }
    }
}

/// Triangles about the origin, alone or as parts of one surface, of all sizes beside a texel.
fn triangles_of(numbers: &mut Numbers, texel: f64) -> Vec<Triangle> {
    let count = 1 + numbers.below(40);
    let size = texel * 10f64.powf(1.6 * numbers.next() - 0.8);
    let spread = 3.0 * texel;
    match numbers.below(3) {
        0 => (0..count).map(|_| std::array::from_fn(|_| numbers.place(spread))).collect(),
        1 => (0..count)
            .map(|_| {
                let middle = numbers.place(spread);
                std::array::from_fn(|_| {
                    let by = numbers.place(size);
                    std::array::from_fn(|axis| middle[axis] + by[axis])
                })
            })
            .collect(),
        // Hills, whose triangles meet.
        _ => {
            let across = 2 + numbers.below(4);
            let rough = [0.02, 0.3, 2.0][numbers.below(3)];
            let heights: Vec<f64> = (0..(across + 1) * (across + 1)).map(|_| numbers.within(rough * size)).collect();
            let at = |i: usize, j: usize| {
                let side = |k: usize| size * (k as f64 - 0.5 * across as f64);
                [side(i), heights[i * (across + 1) + j], side(j)]
            };
            let quads = (0..across).flat_map(|i| (0..across).map(move |j| (i, j)));
            let halves = quads.flat_map(|(i, j)| {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                [[a, b, c], [a, c, d]]
            });
            halves.collect()
        }
    }
}

/// Rows of a turn and a scale about a place; numbers that `f32` has.
fn rows_of(numbers: &mut Numbers, centre: [f64; 3]) -> [[f64; 4]; 3] {
    let q: [f64; 4] = std::array::from_fn(|_| numbers.within(1.0));
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-3);
    let [w, x, y, z] = q.map(|part| part / length);
    let scale = 2f64.powf(numbers.within(1.0));
    let turn = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    turn.map(|row| {
        let row = row.map(|part| scale * part);
        let [x, y, z] = row;
        [x, y, z, -(row[0] * centre[0] + row[1] * centre[1] + row[2] * centre[2])].map(|part| f64::from(part as f32))
    })
}

/// From the frame to the soup's own space.
fn own(rows: &[[f64; 4]; 3], at: [f64; 3]) -> [f64; 3] {
    rows.map(|[x, y, z, w]| x * at[0] + y * at[1] + z * at[2] + w)
}

/// And back, by Cramer's rule.
fn frame(rows: &[[f64; 4]; 3], at: [f64; 3]) -> [f64; 3] {
    let column = |axis: usize| [rows[0][axis], rows[1][axis], rows[2][axis]];
    let [x, y, z] = [0, 1, 2].map(column);
    let right: [f64; 3] = std::array::from_fn(|i| at[i] - rows[i][3]);
    let volume = dot(x, cross(y, z));
    [dot(right, cross(y, z)), dot(x, cross(right, z)), dot(x, cross(y, right))].map(|part| part / volume)
}

/// The height of a triangle over a place, edges inside.
fn height_at([a, b, c]: &Triangle, x: f64, z: f64) -> Option<f64> {
    let side = |p: &[f64; 3], q: &[f64; 3]| (q[0] - p[0]) * (z - p[2]) - (q[2] - p[2]) * (x - p[0]);
    let weights = [side(b, c), side(c, a), side(a, b)];
    let area: f64 = weights.iter().sum();
    let inside = weights.iter().all(|w| *w >= 0.0) || weights.iter().all(|w| *w <= 0.0);
    (inside && area != 0.0).then(|| (weights[0] * a[1] + weights[1] * b[1] + weights[2] * c[1]) / area)
}

/// Whether something stands over a point, by all triangles: for sure, or for what rounding of the
/// numbers involved may make of an edge.
fn is_dark(triangles: &[Triangle], point: [f64; 3], normal: [f64; 3]) -> [bool; 2] {
    let [x, y, z] = point;
    let beyond = |triangle: &Triangle| y + least(triangle, point, normal) - UNSURE_M;
    let hit = |triangle: &Triangle| height_at(triangle, x, z).is_some_and(|height| height > beyond(triangle));
    let grazed = |triangle: &Triangle| {
        let size = triangle.iter().flatten().chain(&[x, y, z]).fold(0.0f64, |most, part| most.max(part.abs()));
        let graze = 4.0 * f64::from(LOST) * (size + 1.0);
        let above = triangle.iter().any(|corner| corner[1] > beyond(triangle));
        let ends = [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|i| [triangle[i][0], triangle[i][2]]));
        above && ends.iter().any(|[from, to]| to_segment([x, z], *from, *to) <= graze)
    };
    let sure = triangles.iter().any(hit);
    [sure, sure || triangles.iter().any(grazed)]
}

/// Metres over a point from which on a triangle shades it: those that rise from its surface do so
/// however near they are, and so may those whose angle to it rounding decides.
fn least(triangle: &Triangle, point: [f64; 3], normal: [f64; 3]) -> f64 {
    let [a, b, c] = triangle.map(|corner| std::array::from_fn(|axis| corner[axis] - point[axis]));
    let minus = |p: [f64; 3], q: [f64; 3]| std::array::from_fn(|axis| p[axis] - q[axis]);
    let across = cross(minus(b, a), minus(c, a));
    let rises = [a, b, c].into_iter().any(|corner| dot(normal, corner) > 0.0);
    let is_parallel = dot(across, normal).abs() > (f64::from(PARALLEL) + 1e-3) * dot(across, across).sqrt();
    if rises && !is_parallel { 0.0 } else { f64::from(LEAST_M) }
}

/// How far a place is from a segment.
fn to_segment(at: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let way = [to[0] - from[0], to[1] - from[1]];
    let own = [at[0] - from[0], at[1] - from[1]];
    let squared = way[0] * way[0] + way[1] * way[1];
    let share = if squared > 0.0 { ((own[0] * way[0] + own[1] * way[1]) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (own[0] - share * way[0]).hypot(own[1] - share * way[1])
}

/// A point of a triangle, often at its rim, and the unit normal turned upwards.
fn point_of(triangle: &Triangle, numbers: &mut Numbers) -> Option<([f64; 3], [f64; 3])> {
    let (s, t) = (numbers.next(), numbers.next());
    let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
    let (s, t) = if numbers.below(4) == 0 { (s, t * 1e-4) } else { (s, t) };
    let [a, b, c] = *triangle;
    let [u, v] = [b, c].map(|corner| [corner[0] - a[0], corner[1] - a[1], corner[2] - a[2]]);
    let normal = cross(u, v);
    let length = dot(normal, normal).sqrt();
    let up = normal[1].signum();
    let point = std::array::from_fn(|axis| a[axis] + s * u[axis] + t * v[axis]);
    let normal = normal.map(|part| up * part / length);
    (length > 1e-9 && normal[1] > 0.02).then_some((point, normal))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// What became of many points.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    lit: u64,
    covered: u64,
    shaded: u64,
    /// Shaded by an id where nothing stands in the way.
    false_shadow: u64,
    /// Those of which rounding does not decide.
    beyond_rounding: u64,
    /// Lit where something stands in the way: by triangles that no texel names.
    false_light: u64,
}

/// Asks points of a soup; the truth is that of the soup moved aside by so many metres.
fn ask(numbers: &mut Numbers, moved: f64, counts: &mut Counts) {
    let soup = Soup::new(numbers);
    let aside = |triangle: &Triangle| triangle.map(|[x, y, z]| [x + moved, y, z]);
    let truth: Vec<Triangle> = soup.triangles.iter().map(aside).collect();
    for _ in 0..POINTS {
        let triangle = &soup.triangles[numbers.below(soup.triangles.len())];
        let Some((point, normal)) = point_of(triangle, numbers) else { continue };
        let (point, normal) = (point.map(|x| x as f32), normal.map(|x| x as f32));
        let at = bias::receiver(&soup.split, point, normal, [0.0, 1.0, 0.0]);
        let ray = Ray::to_sun(point, normal, [0.0, 1.0, 0.0]);
        let found = decided(&at, &soup.around(&at), ray, |id| &soup.runs[id as usize - 1]);
        let [sure, unsure] = is_dark(&truth, point.map(f64::from), normal.map(f64::from));
        match found {
            Decision::Lit | Decision::Undecided => {
                counts.lit += 1;
                counts.false_light += u64::from(sure);
            }
            Decision::Covered => counts.covered += 1,
            Decision::Shaded => {
                counts.shaded += 1;
                counts.false_shadow += u64::from(!sure);
                counts.beyond_rounding += u64::from(!unsure);
            }
        }
    }
}

#[test]
fn an_id_never_darkens_a_lit_point_of_a_soup() {
    let seed = from_environment("UMBRAGE_FUZZ_SEED", 1);
    let soups = from_environment("UMBRAGE_FUZZ_SOUPS", SOUPS);
    let threads = std::thread::available_parallelism().map_or(1, |count| count.get() as u64);
    let part = |thread: u64| {
        let mut counts = Counts::default();
        for soup in (thread..soups).step_by(threads as usize) {
            let before = counts.beyond_rounding;
            ask(&mut Numbers(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ soup << 20), 0.0, &mut counts);
            assert_eq!(counts.beyond_rounding, before, "seed {seed}, soup {soup}: a lit point is dark");
        }
        counts
    };
    let counts = std::thread::scope(|scope| {
        let parts: Vec<_> = (0..threads).map(|thread| scope.spawn(move || part(thread))).collect();
        parts.into_iter().map(|part| part.join().expect("no false shadow")).fold(Counts::default(), |a, b| Counts {
            lit: a.lit + b.lit,
            covered: a.covered + b.covered,
            shaded: a.shaded + b.shaded,
            false_shadow: a.false_shadow + b.false_shadow,
            beyond_rounding: a.beyond_rounding + b.beyond_rounding,
            false_light: a.false_light + b.false_light,
        })
    });
    eprintln!("{soups} soups: {counts:?}");
    let asked = counts.lit + counts.covered + counts.shaded;
    assert!(10 * counts.shaded > asked && 40 * counts.covered > asked && 10 * counts.lit > asked, "{counts:?}");
}

/// The comparison can say no: to shadows of a soup that stands aside.
#[test]
fn shadows_of_another_soup_are_seen() {
    let mut counts = Counts::default();
    for soup in 0..SOUPS {
        ask(&mut Numbers(soup << 20), 0.4, &mut counts);
    }
    assert!(10 * counts.beyond_rounding > counts.shaded && counts.shaded > 100, "{counts:?}");
}
