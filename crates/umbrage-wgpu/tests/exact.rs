//! Exact edges on a GPU: against the twin, against closed forms in every layout, and what has no
//! name.

mod common;

use bytemuck::{Pod, Zeroable};
use common::{Answer, Ask, Gpu, NAMED, PCF3, SUN, World, ask, config, cuboid, ground, plan, quad};
use glam::{DVec3, Mat3, Quat, Vec3};
use umbrage::ShadowPlan;
use umbrage::config::Edges;
use umbrage_shaders::ExactEdges;
use umbrage_shaders::twin::edges::{LEAST_M, Ray, Run, shades};
use umbrage_wgpu::{CasterPipeline, Error, FrameOptions, MaskNormals, ShadowMaps, ShadowMask, Shadows};

/// Numbers in [0, 1) from a linear congruential generator (Knuth's constants).
fn random() -> impl FnMut() -> f32 {
    let mut state = 5u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    }
}

/// An application's own two functions, and what asks: triangles stand behind the points in the one
/// buffer that it has. The first of them says by its fourth numbers how many corners follow and by
/// how much ids are too high.
const ASK: &str = "
struct Ask { position: vec4f, normal: vec4f }
struct Answer { visibility: f32, split: i32, in_split: vec2f, tint: vec3f, short: f32 }
@group(0) @binding(0) var<storage, read> asks: array<Ask>;
@group(0) @binding(1) var<storage, read_write> answers: array<Answer>;
fn umbrage_run(id: u32) -> UmbrageRun {
    let count = u32(asks[0].position.w);
    let first = 24u * (id - 1u + u32(asks[0].normal.w));
    let end = min(first + 24u, count);
    var least = vec3f(1e9);
    var most = vec3f(-1e9);
    for (var i = first; i < end; i++) {
        let corner = asks[arrayLength(&asks) - count + i].position.xyz;
        least = min(least, corner);
        most = max(most, corner);
    }
    let x = vec4f(1.0, 0.0, 0.0, 0.0);
    return UmbrageRun(x, x.yxzw, x.yzxw, least, (max(end, first) - first) / 3u, most, first);
}
fn umbrage_corner(run: UmbrageRun, corner: u32) -> vec3f {
    return asks[arrayLength(&asks) - u32(asks[0].position.w) + run.first + corner].position.xyz;
}
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&asks) { return; }
    let shadow = umbrage_shadow(umbrage_query(asks[id.x].position.xyz, asks[id.x].normal.xyz));
    answers[id.x] = Answer(shadow.visibility, shadow.split, vec2f(0.0), shadow.tint, 0.0);
}";

fn answers(world: &World, triangles: &[Vec3], shift: u8, asks: &[Ask]) -> Vec<Answer> {
    if !world.maps.edges().is_exact() {
        return world.ask(asks);
    }
    let source = world.maps.receiver_wgsl(1) + ASK;
    let corners = triangles.iter().take(3 * NAMED).map(|corner| ask(*corner, Vec3::Y));
    let mut all: Vec<Ask> = asks.iter().copied().chain(corners).collect();
    let [count, shift] = [(all.len() - asks.len()) as f32, f32::from(shift)];
    all[0] = all[0].with(count, shift);
    let mut found: Vec<Answer> = world.gpu.compute(&source, &all, Some(&world.maps));
    found.truncate(asks.len());
    found
}

/// A plate 3 m above the ground from x = `edge` on, the ground, and something far away: eight
/// triangles each.
fn stage(edge: f32) -> Vec<Vec3> {
    let ground = ground(30.0).repeat(4);
    let plate =
        quad([(edge, -8.0), (edge + 6.0, -8.0), (edge + 6.0, 8.0), (edge, 8.0)].map(|(x, z)| Vec3::new(x, 3.0, z)));
    [plate.repeat(4), ground, vec![Vec3::new(500.0, 0.0, 500.0); 24]].concat()
}

/// Straight down over two maps: the near one as far as x = 3.
fn stage_plan(sizes: &[u32]) -> ShadowPlan {
    plan(DVec3::NEG_Y, DVec3::ZERO, sizes, &[-40.0, 3.0, 40.0], &[40.0, 64.0])
}

/// Points of the ground to both sides of the plate's edge, from a hundredth of a millimetre to a
/// texel away, and whether they are dark.
fn around_edge(edge: f32) -> Vec<(Ask, bool)> {
    let mut next = random();
    let mut points = Vec::new();
    for step in 0..400 {
        let aside = [1e-5, 1e-3, 0.1, 0.4][step % 4] * (1.0 + next());
        let aside = if step % 8 < 4 { aside } else { -aside };
        let z = 12.0 * next() - 6.0;
        points.push((ask(Vec3::new(edge + aside, 0.0, z), Vec3::Y), aside > 0.0));
    }
    points
}

fn wrong(answers: &[Answer], points: &[(Ask, bool)]) -> usize {
    answers
        .iter()
        .zip(points)
        .filter(|(answer, (_, is_dark))| answer.visibility != f32::from(u8::from(!is_dark)))
        .count()
}

#[test]
fn edges_are_exact_in_every_layout() {
    for layout in [
        "storage=array",
        "storage=atlas",
        "storage=separate",
        "storage=cube",
        "storage=cube generation=layered",
        "storage=reused transition=hard",
        "generation=layered",
        "generation=instanced",
        "generation=mixed",
        "depth-format=d16",
        "coordinates=split",
        "storage=array generation=per-split bias=slope",
    ] {
        let Some(gpu) = Gpu::new() else { return };
        // The faces of a cube have one size.
        let sizes = if layout.starts_with("storage=cube") { [64, 64] } else { [96, 64] };
        let mut world = World::new(gpu, &config(&sizes, PCF3, &format!("blend=0 edges=exact {layout}")));
        let (mut asked, mut shifted) = (0, 0);
        for edge in [0.13f32, 0.333] {
            let triangles = stage(edge);
            let one_map = layout.starts_with("storage=reused");
            let mut plan = stage_plan(&sizes);
            if one_map {
                // The map that was drawn last answers for its own slice.
                (plan.splits[0].far, plan.splits[0].blend_begin) = (-30.0, -30.0);
                plan.planes[1] = -30.0;
            }
            world.draw(&plan, &FrameOptions::default(), &triangles);
            let points = around_edge(edge);
            let asks: Vec<Ask> = points.iter().map(|(ask, _)| *ask).collect();
            let found = answers(&world, &triangles, 0, &asks);
            assert_eq!(wrong(&found, &points), 0, "{layout}, edge at {edge}");
            if edge < 0.2 {
                shifted = wrong(&answers(&world, &triangles, 1, &asks), &points);
            }
            asked += points.len();
        }
        assert_eq!(asked, 800);
        // The comparison can say no: to ids that are one too high.
        assert!(shifted > 60, "{layout}: {shifted}");
    }
}

/// A pixel of 0.2 m by 0.2 m of the ground, its middle a hundredth of that to either side of the
/// plate's edge and farther: lit by as many of its positions as lie outside.
#[test]
fn smooth_edges_have_the_share_of_a_pixel_that_is_lit() {
    const PIXEL: f32 = 0.2;
    for samples in [4, 8] {
        let Some(gpu) = Gpu::new() else { return };
        let settings = format!("blend=0 edges=exact edge-samples={samples}");
        let mut world = World::new(gpu, &config(&[96, 64], PCF3, &settings));
        let edge = 0.133;
        let triangles = stage(edge);
        world.draw(&stage_plan(&[96, 64]), &FrameOptions::default(), &triangles);
        let asks: Vec<Ask> = (0..201u8)
            .map(|i| ask(Vec3::new(edge + PIXEL * (f32::from(i) - 100.3) / 100.0, 0.0, 0.4), Vec3::Y))
            .collect();
        let smooth = ASK.replace(
            "let shadow = umbrage_shadow(umbrage_query(asks[id.x].position.xyz, asks[id.x].normal.xyz));",
            &format!(
                "var query = umbrage_query(asks[id.x].position.xyz, asks[id.x].normal.xyz);
                 query.dx = vec3f({PIXEL}, 0.0, 0.0);
                 query.dy = vec3f(0.0, 0.0, {PIXEL});
                 let shadow = umbrage_shadow(query);"
            ),
        );
        assert_ne!(smooth, ASK);
        let source = world.maps.receiver_wgsl(1) + &smooth;
        let corners = triangles.iter().take(3 * NAMED).map(|corner| ask(*corner, Vec3::Y));
        let mut all: Vec<Ask> = asks.iter().copied().chain(corners).collect();
        all[0] = all[0].with((all.len() - asks.len()) as f32, 0.0);
        let found: Vec<Answer> = world.gpu.compute(&source, &all, Some(&world.maps));
        let places = ExactEdges { positions: samples, counted: false }.places();
        assert_eq!(places.len(), samples as usize);
        let mut shares = std::collections::BTreeSet::new();
        for (ask, answer) in asks.iter().zip(&found) {
            let lit = places.iter().filter(|place| ask.position().x + PIXEL * place[0] < edge).count();
            assert_eq!(answer.visibility, lit as f32 / samples as f32, "{samples} samples, {ask:?}");
            shares.insert(lit);
        }
        assert_eq!(shares.len(), samples as usize + 1, "each share is there");
    }
}

#[test]
fn sampled_edges_are_seen_to_be_inexact() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new(gpu, &config(&[96, 64], PCF3, "blend=0"));
    let (triangles, points) = (stage(0.13), around_edge(0.13));
    world.draw(&stage_plan(&[96, 64]), &FrameOptions::default(), &triangles);
    let asks: Vec<Ask> = points.iter().map(|(ask, _)| *ask).collect();
    assert!(wrong(&answers(&world, &triangles, 0, &asks), &points) > 200);
}

/// A plate without a name stands before one that has one: no texel names what lies behind, and what
/// is dark by it stays dark.
#[test]
fn no_id_of_something_farther_stays_in_the_map() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new(gpu, &config(&[96, 64], PCF3, "blend=0 edges=exact"));
    let nameless = quad([(-6.0, -8.0), (4.0, -8.0), (4.0, 8.0), (-6.0, 8.0)].map(|(x, z)| Vec3::new(x, 5.0, z)));
    // As many triangles as have a name, then the one above all.
    let padding = 3 * NAMED - stage(0.13).len();
    let far_away = vec![Vec3::new(500.0, 0.0, 500.0); padding];
    let triangles = [stage(0.13), far_away, nameless].concat();
    world.draw(&stage_plan(&[96, 64]), &FrameOptions::default(), &triangles);
    let at = |x: f32| ask(Vec3::new(x, 0.0, 0.4), Vec3::Y);
    // Far inside, far outside, and a texel (0.42 m) to both sides of the nameless edge.
    let asks = [at(-3.0), at(1.0), at(5.0), at(-9.0), at(-6.5), at(-5.5)];
    let found: Vec<f32> = answers(&world, &triangles, 0, &asks).iter().map(|answer| answer.visibility).collect();
    assert_eq!(found, [0.0, 0.0, 0.0, 1.0, 1.0, 0.0]);
    // Right at its edge the filter's contour answers: hard, within half a texel of the truth.
    let asks: Vec<Ask> = (0..200u8).map(|i| at(-6.4 + 0.004 * f32::from(i))).collect();
    let found = answers(&world, &triangles, 0, &asks);
    assert!(found.iter().all(|answer| answer.visibility == 0.0 || answer.visibility == 1.0));
    let turns = found.windows(2).filter(|pair| pair[0].visibility != pair[1].visibility).count();
    assert_eq!(turns, 1, "one edge");
}

/// A point and a run in a space of its own, as the shader below takes them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct RunAsk {
    rows: [[f32; 4]; 3],
    min: [f32; 4],
    max: [f32; 4],
    corners: [[f32; 4]; 24],
    origin: [f32; 4],
    to_light: [f32; 4],
}

const ASK_RUN: &str = "
struct RunAsk {
    rows: array<vec4f, 3>, min: vec4f, max: vec4f, corners: array<vec4f, 24>, origin: vec4f, to_light: vec4f,
}
@group(0) @binding(0) var<storage, read> asks: array<RunAsk>;
@group(0) @binding(1) var<storage, read_write> found: array<u32>;
fn umbrage_run(id: u32) -> UmbrageRun {
    let it = asks[id];
    return UmbrageRun(it.rows[0], it.rows[1], it.rows[2], it.min.xyz, 8u, it.max.xyz, id);
}
fn umbrage_corner(run: UmbrageRun, corner: u32) -> vec3f { return asks[run.first].corners[corner].xyz; }
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= arrayLength(&asks) { return; }
    let to_light = asks[id.x].to_light.xyz;
    let origin = asks[id.x].origin.xyz;
    let ray = UmbrageRay(origin, to_light.zxy, to_light.yzx, to_light, 3.0e38, vec3f(0.0), vec3f(0.0));
    found[id.x] = u32(umbrage_edges_lit_past(id.x, ray, 1u) == 0u);
}";

#[test]
fn triangles_are_tested_as_by_the_twin() {
    let Some(gpu) = Gpu::new() else { return };
    let maps = ShadowMaps::new(&gpu.device, &config(&[64], PCF3, "edges=exact"), &SUN).expect("maps");
    let mut next = random();
    let mut vec = |size: f32| Vec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * 2.0 * size;
    let asks: Vec<RunAsk> = (0..20_000)
        .map(|i| {
            let to_light = vec(1.0).normalize_or(Vec3::Y);
            let turn = Mat3::from_quat(Quat::from_scaled_axis(vec(2.0)));
            let own_from_frame = Mat3::from_diagonal(vec(1.0).abs() + 0.5) * turn;
            let centre = vec(300.0);
            let corners: [Vec3; 24] = std::array::from_fn(|_| vec(3.0));
            // Where the ray passes close by, or a triangle's own point.
            let own = match i % 3 {
                0 => vec(4.0),
                1 => (corners[0] + corners[1] + corners[2]) / 3.0,
                _ => 0.3 * vec(4.0),
            };
            let origin = centre + own_from_frame.inverse() * own;
            let offset = -(own_from_frame * centre);
            let rows = [0, 1, 2].map(|i| own_from_frame.row(i).extend(offset[i]).to_array());
            RunAsk {
                rows,
                min: corners.into_iter().fold(Vec3::INFINITY, Vec3::min).extend(0.0).to_array(),
                max: corners.into_iter().fold(Vec3::NEG_INFINITY, Vec3::max).extend(0.0).to_array(),
                corners: corners.map(|corner| corner.extend(0.0).to_array()),
                origin: origin.extend(0.0).to_array(),
                to_light: to_light.extend(0.0).to_array(),
            }
        })
        .collect();
    let source = maps.receiver_wgsl(1) + ASK_RUN;
    let found: Vec<u32> = gpu.compute(&source, &asks, Some(&maps));
    let xyz = |v: [f32; 4]| [v[0], v[1], v[2]];
    let twin = |ask: &RunAsk, origin: [f32; 3]| {
        let triangles: Vec<[[f32; 3]; 3]> = ask.corners.chunks(3).map(|t| [xyz(t[0]), xyz(t[1]), xyz(t[2])]).collect();
        let run = Run { rows: ask.rows, min: xyz(ask.min), max: xyz(ask.max), triangles };
        let [x, y, z, _] = ask.to_light;
        shades(&run, Ray { to_eye: [y, z, x], ..Ray::to_sun(origin, [z, x, y], [x, y, z]) })
    };
    let disagree = |twin: &dyn Fn(&RunAsk, [f32; 3]) -> bool| {
        let differs = |(ask, found): &(&RunAsk, &u32)| twin(ask, xyz(ask.origin)) != (**found == 1);
        asks.iter().zip(&found).filter(differs).count()
    };
    let shaded = found.iter().filter(|found| **found == 1).count();
    assert!((2000..18_000).contains(&shaded), "{shaded}");
    // Rays that graze an edge or a plane are told apart by a rounding or two.
    assert!(disagree(&twin) <= 20, "{} of 20,000", disagree(&twin));
    // The comparison can say no: to a point that is a little aside.
    let aside = |ask: &RunAsk, origin: [f32; 3]| twin(ask, origin.map(|x| x + 50.0 * LEAST_M));
    assert!(disagree(&aside) > 100, "{}", disagree(&aside));
}

/// Closed boxes that stand in each other, a sun from aside: nothing shines through where triangles
/// meet, and nothing is dark that is lit.
#[test]
fn boxes_are_exact_under_a_low_sun() {
    let Some(gpu) = Gpu::new() else { return };
    let mut world = World::new(gpu, &config(&[96, 64], PCF3, "blend=0 edges=exact"));
    let boxes = [
        cuboid(Vec3::new(-2.0, 0.0, -2.0), Vec3::new(-1.0, 2.5, 1.0)),
        cuboid(Vec3::new(0.5, 0.0, -1.5), Vec3::new(1.5, 1.2, 2.0)),
        cuboid(Vec3::new(-0.7, 1.0, -3.0), Vec3::new(0.2, 1.7, 3.0)),
    ];
    let triangles = [ground(30.0), boxes.concat()].concat();
    let light = DVec3::new(0.7, -1.0, 0.25);
    let plan = plan(light, DVec3::ZERO, &[96, 64], &[-40.0, 3.0, 40.0], &[40.0, 64.0]);
    world.draw(&plan, &FrameOptions::default(), &triangles);
    let mut next = random();
    let asks: Vec<Ask> =
        (0..20_000).map(|_| ask(Vec3::new(10.0 * next() - 4.0, 0.0, 8.0 * next() - 4.0), Vec3::Y)).collect();
    let found = answers(&world, &triangles, 0, &asks);
    let to_light = -light.normalize().as_vec3();
    let is_dark = |point: Vec3, grown: f32| {
        let slabs = |min: Vec3, max: Vec3| {
            let (one, other) = ((min - grown - point) / to_light, (max + grown - point) / to_light);
            one.min(other).max_element().max(0.0) <= one.max(other).min_element()
        };
        let ends =
            |it: &Vec<Vec3>| it.iter().fold((Vec3::INFINITY, -Vec3::INFINITY), |(a, b), c| (a.min(*c), b.max(*c)));
        boxes.iter().map(ends).any(|(min, max)| slabs(min, max))
    };
    let (mut dark, mut lit, mut sure, mut false_light) = (0, 0, 0, 0);
    for (ask, answer) in asks.iter().zip(&found) {
        let (less, more) = (is_dark(ask.position(), -1e-3), is_dark(ask.position(), 1e-3));
        if less != more {
            continue;
        }
        sure += 1;
        dark += u32::from(less);
        lit += u32::from(!less);
        assert!(less || answer.visibility == 1.0, "dark in the light: {ask:?}");
        // A caster may pass between nine texels' centres where it is thin: at a box's upper edge.
        false_light += u32::from(less && answer.visibility == 1.0);
    }
    assert!(sure > 19_000 && dark > 3000 && lit > 3000, "{sure} {dark} {lit}");
    assert!(false_light <= 10, "{false_light} of {dark} dark points are lit");
}

#[test]
fn what_does_not_go_with_ids_is_refused_by_name() {
    let Some(gpu) = Gpu::new() else { return };
    let asked = config(&[64], PCF3, "edges=exact");
    let shadows = Shadows::new(&gpu.device, &asked).expect("shadows");
    assert_eq!(shadows.maps().edges(), Edges::exact());
    let discarding = |wgsl, label| CasterPipeline { wgsl, discards: true, label: Some(label), ..Default::default() };
    let with_fragment = |fragment: &str| {
        format!(
            "@vertex fn vertex(@location(0) position: vec3f, instance: UmbrageInstance) -> UmbrageCast {{
                 return umbrage_cast(position, instance);
             }}
             @fragment fn fragment(@builtin(position) at: vec4f) {fragment}"
        )
    };
    let depth = with_fragment("-> @location(0) f32 { return umbrage_caster_depth(at); }");
    let nothing = with_fragment("{ if at.x < 0.0 { discard; } }");
    let named = with_fragment("-> @location(0) UmbrageTexel { return umbrage_caster_texel(at, 0u); }");
    for (text, label) in [(&depth, "of depth"), (&nothing, "of nothing")] {
        let error = shadows.caster_pipeline(&discarding(text, label)).expect_err("it writes no id");
        assert!(matches!(&error, Error::CasterWithoutId { label: told } if told == label), "{error}");
        assert!(error.to_string().contains("umbrage_caster_texel"), "{error}");
    }
    shadows.caster_pipeline(&discarding(&named, "of ids")).expect("it writes 0");
    shadows.caster_pipeline(&CasterPipeline::default()).expect("ids are written for it");
    let mask = ShadowMask::new(&gpu.device, shadows.maps(), wgpu::TextureFormat::R8Unorm, MaskNormals::FromDepth);
    assert!(matches!(mask.expect_err("a mask knows no triangles"), Error::MaskNeedsRuns));
    // Two maps of 64² texels of 4 bytes, and as many ids.
    let bytes =
        |settings: &str| ShadowMaps::new(&gpu.device, &config(&[64; 2], PCF3, settings), &SUN).expect("maps").bytes();
    assert_eq!((bytes("edges=sampled"), bytes("edges=exact")), (2 * 64 * 64 * 4, 2 * 64 * 64 * 8));
}
