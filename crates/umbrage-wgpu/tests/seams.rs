//! No seam shows where splits meet, for any filter; with naive derivatives one does. The seam score
//! of `umbrage_truth::scores` against closed-form truth: a plain strewn with boxes, of which only
//! the shadows are seen.

mod common;

use common::{Gpu, MSM, VSM, World, config, cuboid};
use glam::{DVec3, Vec3};
use umbrage::config::{Derivatives, Filter, Preset, Range, SplitScheme};
use umbrage::{Aabb, DirectionalLight, FilterReach, Frustum, Planner, PlannerOptions, ShadowConfig, ShadowPlan, View};
use umbrage_truth::scores::{Answers, Domain, Seams, seams};
use umbrage_truth::{Hit, TruthMask};
use umbrage_wgpu::FrameOptions;

const SIZE: u32 = 512;
const SPLITS: usize = 4;
const MAP: u32 = 1024;
const EYE_HEIGHT: f64 = 6.0;
const RANGE: (f64, f64) = (4.0, 60.0);
const TRAVEL: DVec3 = DVec3::new(0.45, -0.6, 0.55);
/// Tangents of the picture's edges.
const HALF: f64 = 0.7;

/// Boxes on the plain; numbers from a linear congruential generator (Knuth's constants).
fn boxes(seed: u64) -> Vec<Aabb> {
    let mut state = seed;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / (1u64 << 24) as f64
    };
    (0..500)
        .map(|_| {
            let at = DVec3::new(150.0 * next(), 0.0, 200.0 * next() - 100.0);
            Aabb::new(at, at + DVec3::new(0.5 + 2.5 * next(), 3.0 + 5.0 * next(), 0.5 + 2.5 * next()))
        })
        .collect()
}

/// The place of the ground that a pixel shows, if it does.
fn ground_at(x: u32, y: u32) -> Option<DVec3> {
    let ndc = |i: u32| (2.0 * (f64::from(i) + 0.5) / f64::from(SIZE) - 1.0) * HALF;
    // The picture's lower edge looks steeply down, its upper edge a little below the horizon; it is
    // tilted, so that borders run askew.
    let down = 0.1 + 0.5 * (ndc(y) + HALF) + 0.1 * ndc(x);
    let depth = EYE_HEIGHT / down;
    (RANGE.0..RANGE.1).contains(&depth).then(|| DVec3::new(depth, 0.0, depth * ndc(x)))
}

/// Whether a box lies between a place and the sun.
fn is_lit(place: DVec3, boxes: &[Aabb]) -> bool {
    let towards = -TRAVEL;
    !boxes.iter().any(|it| {
        let (a, b) = ((it.min - place) / towards, (it.max - place) / towards);
        let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
        leave > 1e-6 && enter < leave
    })
}

fn truth(boxes: &[Aabb]) -> Domain {
    let hits = (0..SIZE * SIZE).map(|pixel| {
        let position = ground_at(pixel % SIZE, pixel / SIZE)?;
        let lit = is_lit(position, boxes);
        Some(Hit { position, normal: DVec3::Y, depth: position.x, object: 0, triangle: 0, lit })
    });
    let mask =
        TruthMask::from_hits([SIZE as usize; 2], -TRAVEL.normalize(), hits.collect()).expect("a hit for each pixel");
    Domain::new(&mask, RANGE).expect("a range")
}

fn plan(filter: &Filter, boxes: &[Aabb]) -> ShadowPlan {
    let settings = ShadowConfig {
        map_sizes: vec![MAP; SPLITS],
        scheme: SplitScheme::Logarithmic,
        range: Range::Metres { near: RANGE.0, far: RANGE.1 },
        far_fade: 0.0,
        ..Preset::Papers.config()
    };
    let eye = DVec3::new(0.0, EYE_HEIGHT, 0.0);
    let frustum = Frustum::perspective(2.0, 1.0, RANGE.0, RANGE.1).expect("a lens");
    let view = View::look_at(eye, eye + DVec3::X, DVec3::Y, frustum).expect("a view");
    let ground = Aabb::new(DVec3::new(0.0, -0.01, -150.0), DVec3::new(160.0, 0.0, 150.0));
    let reach = FilterReach { radius_texels: filter.radius_texels(), radius_m: None };
    let options = PlannerOptions { filter_reach: Some(reach), image_size: [SIZE; 2], ..PlannerOptions::default() };
    let mut planner = Planner::with_options(&settings, options).expect("valid settings");
    planner.plan(&view, &DirectionalLight::new(TRAVEL).expect("a direction"), boxes, &[ground]).expect("a plan").clone()
}

/// Derivatives of the place in each pixel's own map, as hardware would take them: metres that make
/// them.
const NAIVE: &str = "
fn umbrage_fragment_query(position: vec3f, normal: vec3f, dx: vec3f, dy: vec3f, pixel: vec2f) -> UmbrageQuery {
    let own = umbrage_select_split_at(0u, umbrage_frame_view_depth(0u, position));
    let split = umbrage_frames[0].splits[min(own, 7u)];
    let texel = umbrage_map_from_world(split, position).xy;
    let u = split.u_row.xyz / dot(split.u_row.xyz, split.u_row.xyz);
    let v = split.v_row.xyz / dot(split.v_row.xyz, split.v_row.xyz);
    let x = dpdx(texel);
    let y = dpdy(texel);
    var query = umbrage_query(position, normal);
    query.dx = x.x * u + x.y * v;
    query.dy = y.x * u + y.y * v;
    return query;
}";

struct Scene {
    boxes: Vec<Aabb>,
    domain: Domain,
}

impl Scene {
    fn all(seeds: &[u64]) -> Vec<Self> {
        let of = |&seed: &u64| {
            let boxes = boxes(seed);
            Self { domain: truth(&boxes), boxes }
        };
        seeds.iter().map(of).collect()
    }

    fn score(&self, world: &mut World, derivatives: Derivatives, naive: bool) -> Seams {
        let plan = plan(&world.maps.config().filter, &self.boxes);
        let triangles: Vec<Vec3> =
            self.boxes.iter().flat_map(|it| cuboid(it.min.as_vec3(), it.max.as_vec3())).collect();
        if world.maps.config().filter.is_prefiltered() {
            world.set(&format!("derivatives={derivatives}"));
        }
        world.draw(&plan, &FrameOptions::default(), &triangles);
        let mut source = world.maps.receiver_wgsl(2);
        if naive {
            source = source.replace("fn umbrage_fragment_query(", "fn umbrage_other_query(") + NAIVE;
        }
        source += &format!(
            "
@vertex fn vs(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {{
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}}
@fragment fn fs(@builtin(position) pixel: vec4f) -> @location(0) vec4f {{
    let ndc = (2.0 * pixel.xy / {SIZE}.0 - 1.0) * {HALF};
    let depth = {EYE_HEIGHT}.0 / max(0.1 + 0.5 * (ndc.y + {HALF}) + 0.1 * ndc.x, 0.01);
    let position = vec3f(depth, 0.0, depth * ndc.x);
    let up = vec3f(0.0, 1.0, 0.0);
    let query = umbrage_fragment_query(position, up, dpdx(position), dpdy(position), pixel.xy);
    return vec4f(umbrage_shadow(query).visibility);
}}"
        );
        let pixels = world.gpu.fragments(&source, SIZE, &world.maps);
        let answers = pixels.iter().map(|pixel| Some(pixel[0].clamp(0.0, 1.0))).collect();
        let answers = Answers::from_pixels([SIZE as usize; 2], answers).expect("as many as pixels");
        let borders = &plan.planes[1..plan.planes.len() - 1];
        seams(&self.domain, &answers, borders, |pixel| self.domain.depth(pixel)).expect("a score")
    }
}

/// Decisions of all scenes; `None` without an adapter.
fn pooled(scenes: &[Scene], filter: Filter, derivatives: Derivatives, naive: bool) -> Option<Seams> {
    let mut world = World::new(Gpu::new()?, &config(&[MAP; SPLITS], filter, ""));
    let mut sum = Seams::default();
    scenes.iter().for_each(|scene| sum += scene.score(&mut world, derivatives, naive));
    eprintln!(
        "{filter:?}, {derivatives:?}, naive {naive}: {:.3?} over {} pixels; E {:.4}, nearer {:.4}, farther {:.4}",
        sum.ratio(),
        sum.seam.pixels,
        sum.seam.rate(),
        sum.nearer.rate(),
        sum.farther.rate()
    );
    Some(sum)
}

#[test]
fn no_filter_shows_a_seam() {
    let scenes = Scene::all(&[5, 6, 7, 8, 9]);
    let quads = [(VSM, Derivatives::Quad), (MSM, Derivatives::Quad)];
    for (filter, derivatives) in Filter::ALL.map(|filter| (filter, Derivatives::Analytic)).into_iter().chain(quads) {
        let Some(score) = pooled(&scenes, filter, derivatives, false) else { return };
        assert_eq!(score.are_hidden(), Some(true), "{filter:?}, {derivatives:?}: {score:?}");
    }
}

/// The score says no to derivatives that are taken across borders.
#[test]
fn naive_derivatives_show_one() {
    let scenes = Scene::all(&[5]);
    for filter in Filter::ALL.into_iter().filter(|filter| filter.is_prefiltered()) {
        let Some(score) = pooled(&scenes, filter, Derivatives::Analytic, true) else { return };
        assert_eq!(score.are_hidden(), Some(false), "{filter:?}: {score:?}");
    }
}
