//! What stands before the picture, or behind the eye, takes no texels from it: an empty foreground,
//! a gun in the hand, a cockpit, a mountain behind. At the defaults, against rays.

use glam::DVec3;
use umbrage::config::ShadowConfig;
use umbrage::{DirectionalLight, Frustum, View};
use umbrage_render::{Frame, Outputs, RenderSettings, Renderer};
use umbrage_scene::{Primitive, Scene};
use umbrage_tests::boxes::{add, cuboid, ground, scene};
use umbrage_tests::stage::gpu;
use umbrage_truth::Truth;
use umbrage_truth::scores::{Answers, Domain, MisShadowed, mis_shadowed};

const SIZE: [u32; 2] = [320, 240];
const FAR: f64 = 2000.0;

/// Posts and blocks on a plain, from `first` metres ahead of the origin to 400.
fn field(first: f64) -> Scene {
    let mut scene = scene();
    add(&mut scene, ground(0.0, 3000.0));
    for i in 0..240 {
        let [x, z, size] = [0.754_877_67, 0.569_840_29, 0.381_966_01].map(|step: f64| (step * f64::from(i)).fract());
        let ahead = first + (400.0 - first) * z * z;
        let mut block = Primitive::default();
        let size = DVec3::new(0.5 + 2.0 * size, 1.0 + 6.0 * x, 0.5 + size);
        cuboid(&mut block, DVec3::new((x - 0.5) * (20.0 + 1.2 * ahead), 0.0, -ahead), size);
        add(&mut scene, block);
    }
    scene
}

fn look(eye: DVec3, ahead: DVec3, near: f64) -> View {
    let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
    let frustum = Frustum::perspective(60f64.to_radians(), aspect, near, FAR).expect("a lens");
    View::look_at_upright(eye, eye + ahead, frustum).expect("a view")
}

/// A config with maps of 512².
fn small(config: ShadowConfig) -> ShadowConfig {
    ShadowConfig { map_sizes: vec![512; 4], ..config }
}

/// E of a config.
fn error(scene: &Scene, view: &View, sun: DVec3, config: &ShadowConfig) -> Option<MisShadowed> {
    let config = config.clone();
    let settings = RenderSettings { size: SIZE, config, ..RenderSettings::default() };
    let mut renderer = Renderer::new(gpu()?, scene, &settings).expect("a renderer");
    let (pose, light) = (scene.pose(0.0).expect("a pose"), DirectionalLight::new(sun).expect("a direction"));
    let frame =
        Frame { pose: &pose, moved: None, view, light: light.into(), more_lights: &[], shadows_on: true, tint: false };
    let rendered = renderer.render(&frame, Outputs { mask: true, ..Outputs::default() }).expect("a frame");
    let truth = Truth::build(scene, &pose, view.eye()).expect("rays can meet it");
    let truth = truth.mask(view, sun, SIZE, &|_| {}).expect("a truth");
    let domain = Domain::new(&truth, (view.frustum().near, FAR)).expect("a range");
    let mask = rendered.mask.expect("a mask");
    Some(mis_shadowed(&domain, &Answers::from_mask(&mask)).expect("surfaces that face the light"))
}

/// E is at most `most` per cent, and the bound is no gift: the papers' settings are beyond it.
fn check(name: &str, scene: &Scene, view: &View, sun: DVec3, most: f64) {
    let Some(score) = error(scene, view, sun, &small(ShadowConfig::default())) else { return };
    let e = 100.0 * score.rate();
    assert!(e <= most, "{name}: E {e:.3} %, asked {most}: {score:?}");
    let papers = small(umbrage::config::Preset::Papers.config());
    let papers = 100.0 * error(scene, view, sun, &papers).expect("a device").rate();
    assert!(papers > most, "{name}: the papers' settings have E {papers:.3} %, within {most}");
}

#[test]
fn an_empty_foreground_takes_no_texels() {
    let (eye, ahead) = (DVec3::new(0.0, 60.0, 0.0), DVec3::new(0.0, -0.25, -1.0));
    check("empty", &field(120.0), &look(eye, ahead, 0.05), DVec3::new(-0.5, -0.7, -0.3), 0.1);
}

#[test]
fn a_gun_in_the_hand_takes_no_texels() {
    let mut scene = field(4.0);
    let mut gun = Primitive::default();
    cuboid(&mut gun, DVec3::new(0.06, 1.5, -0.5), DVec3::new(0.05, 0.06, 0.35));
    cuboid(&mut gun, DVec3::new(0.07, 1.56, -0.42), DVec3::new(0.02, 0.02, 0.05));
    add(&mut scene, gun);
    let view = look(DVec3::new(0.0, 1.7, 0.0), DVec3::new(0.0, -0.08, -1.0), 0.01);
    check("gun", &scene, &view, DVec3::new(-0.5, -0.7, -0.3), 0.3);
}

#[test]
fn a_cockpit_takes_no_texels() {
    let mut scene = field(20.0);
    let mut cockpit = Primitive::default();
    // A dashboard, two posts and a roof, as seen from the seat.
    cuboid(&mut cockpit, DVec3::new(-0.9, 1.2, -0.8), DVec3::new(1.8, 0.15, 0.5));
    cuboid(&mut cockpit, DVec3::new(-0.9, 1.35, -0.8), DVec3::new(0.08, 0.7, 0.08));
    cuboid(&mut cockpit, DVec3::new(0.82, 1.35, -0.8), DVec3::new(0.08, 0.7, 0.08));
    cuboid(&mut cockpit, DVec3::new(-0.9, 2.05, -0.8), DVec3::new(1.8, 0.06, 1.6));
    add(&mut scene, cockpit);
    let view = look(DVec3::new(0.0, 1.7, 0.0), DVec3::new(0.0, -0.05, -1.0), 0.05);
    check("cockpit", &scene, &view, DVec3::new(-0.3, -0.6, 0.5), 0.15);
}

#[test]
fn a_mountain_behind_throws_its_shadow() {
    let mut scene = field(4.0);
    let mut mountain = Primitive::default();
    cuboid(&mut mountain, DVec3::new(-400.0, 0.0, 900.0), DVec3::new(345.0, 420.0, 300.0));
    add(&mut scene, mountain);
    // Low from behind: one side of the field lies in the mountain's shadow, as far as 200 m.
    let view = look(DVec3::new(0.0, 1.7, 0.0), DVec3::new(0.0, -0.05, -1.0), 0.1);
    check("mountain", &scene, &view, DVec3::new(0.05, -0.38, -1.0), 0.3);
}

#[test]
fn a_ground_of_any_size_shows_the_shadows_of_small_boxes() {
    for half in [10.0, 2000.0, 500_000.0] {
        let mut scene = scene();
        add(&mut scene, ground(0.0, half));
        for i in 0..9 {
            let mut block = Primitive::default();
            let (x, z) = (f64::from(i % 3), f64::from(i / 3));
            cuboid(&mut block, DVec3::new(2.6 * x - 3.0, 0.0, -8.0 + 2.2 * z), DVec3::ONE);
            add(&mut scene, block);
        }
        // glTF's infinite lens.
        let frustum = Frustum::perspective(60f64.to_radians(), 4.0 / 3.0, 0.1, f64::INFINITY).expect("a lens");
        let view = View::look_at_upright(DVec3::new(0.0, 4.0, 4.0), DVec3::new(0.0, 0.0, -5.0), frustum);
        let view = view.expect("a view");
        let sun = DVec3::new(-0.5, -0.7, -0.3);
        let Some(score) = error(&scene, &view, sun, &ShadowConfig::default()) else { return };
        assert!(100.0 * score.rate() <= 0.06, "{half} m: {score:?}");
    }
}

#[test]
fn one_large_mesh_is_fitted_to_what_its_depth_shows() {
    // A level that is one object, as files have it: its box says nothing of what a wall hides.
    let mut level = ground(0.0, 300.0);
    cuboid(&mut level, DVec3::new(-40.0, 0.0, -9.0), DVec3::new(80.0, 30.0, 0.4));
    for i in 0..12 {
        let x = 1.3 * f64::from(i) - 8.0;
        cuboid(&mut level, DVec3::new(x, 0.2 * f64::from(i % 5), -8.4), DVec3::new(0.15, 1.0 + 0.1 * x.abs(), 0.15));
        cuboid(&mut level, DVec3::new(20.0 * x, 0.0, -150.0), DVec3::new(9.0, 12.0, 9.0));
    }
    let mut scene = scene();
    add(&mut scene, level);
    let view = look(DVec3::new(0.0, 1.7, 0.0), DVec3::new(0.0, -0.1, -1.0), 0.1);
    let sun = DVec3::new(-0.5, -0.7, -0.5);
    let Some(by_boxes) = error(&scene, &view, sun, &small(ShadowConfig::default())) else { return };
    let fitted = ShadowConfig { fit_to: umbrage::config::FitTo::Depth, ..ShadowConfig::default() };
    let by_depth = error(&scene, &view, sun, &small(fitted)).expect("a device");
    let (boxes, depth) = (100.0 * by_boxes.rate(), 100.0 * by_depth.rate());
    assert!(depth < 0.5 * boxes, "E {depth:.3} % by depth, {boxes:.3} % by boxes");
}
