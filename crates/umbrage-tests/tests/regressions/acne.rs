//! No acne and no leak to speak of at the defaults: wrong decisions farther from true edges than
//! the maps' resolution explains.

use glam::DVec3;
use image::GrayAlphaImage;
use umbrage::{DirectionalLight, Frustum, ShadowPlan, View};
use umbrage_render::{Frame, Outputs, RenderSettings, Renderer};
use umbrage_scene::procedural::World;
use umbrage_scene::{GltfOptions, load_gltf};
use umbrage_tests::stage::{Stage, Technique, gpu};
use umbrage_truth::Truth;
use umbrage_truth::scores::{AcneAndLeak, Answers, Domain, TexelGradient, acne_and_leak};

const SIZE: [u32; 2] = [200, 150];
const CAMERAS: [&str; 2] = ["near", "dueling"];
/// Degrees above the horizon, at the bearing of the world's own sun.
const ELEVATIONS: [f64; 3] = [80.0, 20.0, 5.0];
/// The most of either, of those pixels of a world's views that lie so far from edges (and so of all
/// scored ones too). Single views of this size have too few of them to tell a share of a
/// thousandth.
const MOST: f64 = 0.001;

/// Acne and leak, pooled over a world's views, of masks and of the same masks moved aside.
fn measure(world: World) -> Option<[AcneAndLeak; 2]> {
    let gpu = gpu()?;
    let stage = Stage::of(world);
    let truth = Truth::build(&stage.scene, &stage.pose, stage.view("near", SIZE).eye()).expect("rays can meet a world");
    let settings = Technique::default().settings;
    let settings = RenderSettings {
        size: SIZE,
        config: umbrage::ShadowConfig { far_fade: 0.1, ..settings.config.clone() },
        ..settings
    };
    let mut renderer = Renderer::new(gpu, &stage.scene, &settings).expect("a renderer");
    let own = -stage.sun.direction();
    let bearing = DVec3::new(own.x, 0.0, own.z).normalize();
    let mut sums = [AcneAndLeak::default(), AcneAndLeak::default()];
    for camera in CAMERAS {
        let view = stage.view(camera, SIZE);
        for elevation in ELEVATIONS {
            let (sine, cosine) = elevation.to_radians().sin_cos();
            let sun = DirectionalLight::new(-(bearing * cosine + DVec3::Y * sine)).expect("a sun");
            let frame = Frame { light: sun.into(), ..stage.frame(&view, false) };
            let scores = scores(&mut renderer, &truth, &frame, (sun, SIZE), stage.world.near_far());
            eprintln!(
                "{} {camera} {elevation}°: acne {:.5}, leak {:.5} of {}",
                world.name(),
                scores[0].acne_rate_beyond(),
                scores[0].leak_rate_beyond(),
                scores[0].beyond
            );
            for (sum, score) in sums.iter_mut().zip(scores) {
                sum.pixels += score.pixels;
                sum.beyond += score.beyond;
                sum.acne += score.acne;
                sum.leak += score.leak;
            }
        }
    }
    Some(sums)
}

/// Acne and leak of a frame's mask under a sun, and of that mask moved aside.
fn scores(
    renderer: &mut Renderer,
    truth: &Truth,
    frame: &Frame<'_>,
    (sun, size): (DirectionalLight, [u32; 2]),
    range: (f64, f64),
) -> [AcneAndLeak; 2] {
    let rendered = renderer.render(frame, Outputs { mask: true, ..Outputs::default() }).expect("a frame");
    let mask = rendered.mask.expect("a mask");
    let judged = truth.mask(frame.view, sun.direction(), size, &|_| {}).expect("a truth");
    let domain = Domain::new(&judged, range).expect("a range");
    let gradient = |point, depth| texel_gradient(&rendered.stats.plan, point, depth);
    [mask.clone(), moved_aside(&mask)]
        .map(|mask| acne_and_leak(frame.view, &judged, &domain, &Answers::from_mask(&mask), gradient).expect("a score"))
}

fn texel_gradient(plan: &ShadowPlan, point: DVec3, depth: f64) -> Option<TexelGradient> {
    let split = plan.splits.iter().find(|split| depth <= split.far).filter(|split| !split.casters.is_empty())?;
    let [u, v] = split.texel_jacobian(point);
    Some(TexelGradient { u, v, width: split.texel_size_m(point).max_element() })
}

fn moved_aside(mask: &GrayAlphaImage) -> GrayAlphaImage {
    GrayAlphaImage::from_fn(mask.width(), mask.height(), |x, y| *mask.get_pixel(x.saturating_sub(12), y))
}

fn check(world: World) {
    let Some([ours, moved]) = measure(world) else { return };
    assert!(ours.beyond_rate() > 0.3, "{}: most pixels lie near edges, and nothing is judged", world.name());
    let [acne, leak] = [ours.acne_rate_beyond(), ours.leak_rate_beyond()];
    assert!(acne <= MOST, "{}: acne {acne}", world.name());
    assert!(leak <= MOST, "{}: leak {leak}", world.name());
    let worse = moved.acne_rate_beyond().max(moved.leak_rate_beyond());
    assert!(worse > MOST, "{}: shadows that lie twelve pixels aside pass, {worse}", world.name());
}

#[test]
fn robot_war_has_neither_acne_nor_leaks() {
    check(World::RobotWar);
}

#[test]
fn chessboard_has_neither_acne_nor_leaks() {
    check(World::Chessboard);
}

#[test]
fn knights_have_neither_acne_nor_leaks() {
    check(World::Knights);
}

#[test]
fn mining_terrain_has_neither_acne_nor_leaks() {
    check(World::MiningTerrain);
}

/// Two views of a city's road whose round posts, kerbs and grazed walls are what a bias or a rule
/// for creases darkens first: in each of them, and not in their mean, as nothing else shows it.
#[test]
fn a_city_has_neither_acne_nor_leaks() {
    let Some(gpu) = gpu() else { return };
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/city_candela.glb");
    let scene = load_gltf(file.as_ref(), &GltfOptions::default()).expect("the city is in the repository");
    let pose = scene.pose(0.0).expect("a pose");
    let size = [400, 300];
    let settings = RenderSettings { size, ..Technique::default().settings };
    let mut renderer = Renderer::new(gpu, &scene, &settings).expect("a renderer");
    for (eye, ahead, elevation) in [
        (DVec3::new(-13.211, -7.951, -33.167), DVec3::new(0.0147, 0.0, 0.9999), 80.0_f64),
        (DVec3::new(-346.956, -7.941, 14.138), DVec3::new(-0.0848, 0.0001, -0.9964), 5.0),
    ] {
        let lens = Frustum::perspective(60.0_f64.to_radians(), 4.0 / 3.0, 1.0, 800.0).expect("a lens");
        let view = View::look_at(eye, eye + ahead, DVec3::Y, lens).expect("a view");
        let truth = Truth::build(&scene, &pose, eye).expect("rays can meet a city");
        let (sine, cosine) = elevation.to_radians().sin_cos();
        // At the bearing of the city's own sun.
        let bearing = DVec3::new(-0.97478, 0.0, -0.01083).normalize();
        let sun = DirectionalLight::new(-(bearing * cosine + DVec3::Y * sine)).expect("a sun");
        let light = sun.into();
        let frame =
            Frame { pose: &pose, moved: None, view: &view, light, more_lights: &[], shadows_on: true, tint: false };
        let [ours, moved] = scores(&mut renderer, &truth, &frame, (sun, size), (1.0, 800.0));
        let [acne, leak] = [ours.acne_rate_beyond(), ours.leak_rate_beyond()];
        eprintln!("city {elevation}°: acne {acne:.5}, leak {leak:.5} of {}", ours.beyond);
        assert!(ours.beyond_rate() > 0.3, "most pixels lie near edges, and nothing is judged");
        assert!(acne <= MOST && leak <= MOST, "{elevation}°: acne {acne}, leak {leak}");
        assert!(moved.acne_rate_beyond().max(moved.leak_rate_beyond()) > MOST, "{elevation}°: moved aside passes");
        renderer.restart();
    }
}
