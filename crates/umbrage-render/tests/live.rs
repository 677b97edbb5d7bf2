//! A renderer whose config, size or planned view changes draws what a new one draws.

mod common;

use common::{SIZE, Stage, config, configured, cuboid, gpu, ground, look, scene, settings, sphere, sun};
use glam::DVec3;
use image::RgbaImage;
use umbrage::config::{
    Coordinates, DepthFormat, Edges, Fallbacks, Filter, Layout, Look, MomentKind, Moments, Rebuilds, ShadowConfig,
    Translucent,
};
use umbrage::{DirectionalLight, View};
use umbrage_render::{Error, Gpu, Outputs, RenderSettings, Renderer};
use umbrage_scene::Scene;

const PICTURE: Outputs = Outputs { picture: true, mask: false, maps: false, edges: false };

fn town() -> Scene {
    scene(vec![
        ground(0.0, 60.0),
        cuboid(DVec3::new(-1.0, 0.0, -12.0), DVec3::new(2.0, 3.0, -9.0)),
        sphere(DVec3::new(-4.0, 2.0, -20.0), 1.5),
    ])
}

fn from_the_street() -> (View, DirectionalLight) {
    (look(DVec3::new(0.0, 2.5, 4.0), DVec3::new(0.0, 1.0, -8.0)), sun(DVec3::new(1.0, -0.9, 0.2)))
}

fn picture(stage: &mut Stage) -> RgbaImage {
    let (view, sun) = from_the_street();
    stage.renderer.restart();
    stage.render(&view, sun, PICTURE).picture.expect("a picture")
}

fn fresh(gpu: &Gpu, settings: &RenderSettings) -> RgbaImage {
    picture(&mut Stage::new(gpu, &town(), settings))
}

/// Configs that differ by what a change rebuilds.
fn configs() -> Vec<ShadowConfig> {
    vec![
        config(),
        ShadowConfig { far_fade: 0.5, ..config() },
        ShadowConfig { map_sizes: vec![256, 128], ..config() },
        ShadowConfig { map_sizes: vec![256; 3], filter: Filter::Pcf5 { width_m: None }, ..config() },
        ShadowConfig { filter: Filter::Moments(Moments::new(MomentKind::Evsm2)), ..config() },
        ShadowConfig { layout: Layout::Reused, depth_format: DepthFormat::R32Float, ..config() },
        ShadowConfig { coordinates: Coordinates::Vertex, ..config() },
        ShadowConfig { edges: Edges::exact(), filter: Filter::Pcf3 { width_m: None }, ..config() },
        ShadowConfig {
            look: Look { contact: true, translucent: Translucent::Dithered, ..Look::default() },
            fallbacks: Fallbacks::Allow,
            ..config()
        },
    ]
}

#[test]
fn a_changed_config_draws_what_a_new_renderer_draws() {
    let Some(gpu) = gpu() else { return };
    let mut stage = Stage::new(&gpu, &town(), &settings());
    let first = picture(&mut stage);
    let mut different = 0;
    for config in configs() {
        stage.renderer.set_config(&town(), &config).expect("a change");
        assert_eq!(stage.renderer.config(), &config);
        let changed = picture(&mut stage);
        different += usize::from(changed != first);
        assert!(changed == fresh(&gpu, &configured(config.clone())), "{config:?}");
    }
    // The comparison can say no: wider filters are seen. The other configs draw the same shadows in
    // other ways.
    assert!(different >= 2, "{different} pictures differ");
    let last = configs().pop().expect("a config");
    assert_eq!(stage.renderer.set_config(&town(), &last).expect("no change"), Rebuilds::Nothing);
}

#[test]
fn a_refused_config_changes_nothing() {
    let Some(gpu) = gpu() else { return };
    let mut stage = Stage::new(&gpu, &town(), &settings());
    let before = picture(&mut stage);
    let error = stage.renderer.set_config(&town(), &ShadowConfig { map_sizes: vec![1; 2], ..config() });
    assert!(matches!(error, Err(Error::Plan(_))), "{error:?}");
    assert_eq!(stage.renderer.config(), &config());
    assert!(picture(&mut stage) == before);
}

#[test]
fn another_size_draws_what_a_new_renderer_draws() {
    let Some(gpu) = gpu() else { return };
    let look = Look { contact: true, ..Look::default() };
    let settings = configured(ShadowConfig { look, ..config() });
    let mut stage = Stage::new(&gpu, &town(), &settings);
    picture(&mut stage);
    for size in [[64, 48], [200, 150], SIZE] {
        stage.renderer.resize(size).expect("a size");
        assert!(picture(&mut stage) == fresh(&gpu, &RenderSettings { size, ..settings.clone() }), "{size:?}");
    }
    assert!(matches!(stage.renderer.resize([0, 48]), Err(Error::ImageSize { .. })));
    assert_eq!(picture(&mut stage).dimensions(), (SIZE[0], SIZE[1]));
}

#[test]
fn maps_stay_while_another_eye_looks_at_them() {
    let Some(gpu) = gpu() else { return };
    let mut stage = Stage::new(&gpu, &town(), &settings());
    let (street, sun) = from_the_street();
    let above = look(DVec3::new(20.0, 25.0, 10.0), DVec3::new(0.0, 0.0, -10.0));
    let plan = |stage: &mut Stage, view: &View| stage.render(view, sun, PICTURE).stats.plan.splits.clone();
    let of_the_street = plan(&mut stage, &street);
    assert_ne!(plan(&mut stage, &above), of_the_street, "the comparison can say no");
    stage.renderer.plan_for(Some(street)).expect("layers");
    assert_eq!(plan(&mut stage, &above), of_the_street);
    stage.renderer.plan_for(None).expect("always");
    assert_ne!(plan(&mut stage, &above), of_the_street);

    let reused = configured(ShadowConfig { layout: Layout::Reused, ..config() });
    let mut renderer = Renderer::new(&gpu, &town(), &reused).expect("a renderer");
    assert!(matches!(renderer.plan_for(Some(street)), Err(Error::SlicesOfAnotherView)));
    renderer.plan_for(None).expect("always");
}
