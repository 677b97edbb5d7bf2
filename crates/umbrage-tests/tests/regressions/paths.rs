//! Every pair of generation and storage draws every world alike, and whatever a device lacks,
//! everything renders.

use image::GrayAlphaImage;
use umbrage::config::{DepthFormat, Filter, Generation, Layout};
use umbrage_render::{Gpu, GpuOptions, Outputs, ProbePoint, Renderer};
use umbrage_scene::procedural::World;
use umbrage_tests::stage::{Stage, Technique, gpu};

/// The first is what the others are compared with.
const LAYOUTS: [Layout; 9] = Layout::ALL;

const SIZE: [u32; 2] = [160, 120];

/// The share of pixels that may differ where maps are tiles: their edges are clipped and their
/// texels have other coordinates.
const TILES: f64 = 0.0005;

/// The mask of a world's camera `middle`, or `None`, said loudly, where the device cannot take this
/// path.
fn mask(gpu: &Gpu, world: World, technique: &Technique, layout: Layout) -> Option<GrayAlphaImage> {
    let mut technique = technique.clone();
    technique.settings.config.layout = layout;
    let stage = Stage::of(world);
    let view = stage.view("middle", SIZE);
    let mut drawer = stage.drawer(gpu, &technique, SIZE);
    let taken = drawer.renderer.layout();
    if taken != layout {
        eprintln!("SKIPPED: {layout:?} became {taken:?}");
        return None;
    }
    Some(drawer.mask(&view))
}

/// Share of pixels that are not the same.
fn difference(a: &GrayAlphaImage, b: &GrayAlphaImage) -> f64 {
    let count = a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count();
    count as f64 / f64::from(a.width() * a.height())
}

fn check(world: World, technique: &Technique, layouts: &[Layout]) {
    let Some(gpu) = gpu() else { return };
    let expected = mask(gpu, world, technique, LAYOUTS[0]).expect("the plainest path is there");
    let shadowed = expected.pixels().filter(|pixel| pixel.0 == [0, 255]).count();
    assert!(shadowed > 500, "{}: only {shadowed} pixels are in shadow", world.name());
    for &layout in layouts {
        let Some(found) = mask(gpu, world, technique, layout) else { continue };
        let tiles = matches!(layout, Layout::Atlas | Layout::InstancedAtlas | Layout::MixedArray);
        let (found, most) = (difference(&found, &expected), if tiles { TILES } else { 0.0 });
        assert!(found <= most, "{} by {layout:?}: {:.4} % of the pixels differ", world.name(), 100.0 * found);
    }
}

#[test]
fn every_pair_draws_every_world_alike() {
    for world in World::PAPER {
        check(world, &Technique::pssm(4, 256), &LAYOUTS[1..]);
    }
}

#[test]
fn every_way_to_read_maps_filters_alike() {
    check(World::Chessboard, &Technique::pssm(3, 256).filter(Filter::Pcf3 { width_m: None }), &LAYOUTS[1..5]);
}

/// The comparison must be able to say no: a technique that is a little coarser.
#[test]
fn another_resolution_is_no_path() {
    let Some(gpu) = gpu() else { return };
    let of = |size| mask(gpu, World::Chessboard, &Technique::pssm(4, size), LAYOUTS[0]).expect("a mask");
    assert!(difference(&of(256), &of(248)) > TILES);
}

/// Maps of different sizes, colours instead of depth.
#[test]
fn sizes_and_floats_change_nothing() {
    let mut technique = Technique::pssm(4, 256);
    technique.settings.config.map_sizes = vec![256, 192, 128, 128];
    // Where sizes matter: packed, apart, with one viewport for several layers, and packed in
    // layers.
    check(World::Knights, &technique, &[LAYOUTS[1], LAYOUTS[2], LAYOUTS[5], LAYOUTS[8]]);
    let Some(gpu) = gpu() else { return };
    let depth = mask(gpu, World::Knights, &technique, LAYOUTS[0]).expect("a mask");
    technique.settings.config.depth_format = DepthFormat::R32Float;
    for layout in [LAYOUTS[0], LAYOUTS[5]] {
        let Some(floats) = mask(gpu, World::Knights, &technique, layout) else { continue };
        assert_eq!(difference(&depth, &floats), 0.0, "{layout:?}");
    }
}

/// Probes ask whatever path there is, and one map at a time as well as all of them.
#[test]
fn probes_answer_alike() {
    let Some(gpu) = gpu() else { return };
    let stage = Stage::of(World::RobotWar);
    let view = stage.view("middle", SIZE);
    let points: Vec<ProbePoint> = (0..400)
        .map(|i| {
            let (a, b) = (f64::from(i % 20) - 10.0, f64::from(i / 20) - 10.0);
            let position = view.eye() + view.forward() * 120.0 + glam::DVec3::new(20.0 * a, 0.0, 20.0 * b);
            ProbePoint { position: glam::DVec3::new(position.x, 0.05, position.z), normal: glam::DVec3::Y }
        })
        .collect();
    let answers = |layout: Layout| {
        let mut technique = Technique::pssm(4, 256);
        technique.settings.config.layout = layout;
        let mut drawer = stage.drawer(gpu, &technique, SIZE);
        drawer.renderer.probe(&stage.frame(&view, false), &points).expect("answers")
    };
    let expected = answers(LAYOUTS[0]);
    let split_of = |split| expected.iter().filter(|answer| answer.split == split).count();
    assert!(expected.iter().any(|answer| answer.visibility == 0.0), "no point is in shadow");
    assert!((0..4).filter(|&split| split_of(split) > 10).count() > 1, "all points are of one split");
    assert_eq!(answers(Layout::Reused), expected);
    assert_eq!(answers(Layout::Separate), expected);
}

/// With each optional feature withheld in turn, and with all of them, every path that is asked for
/// renders, and the report names what was taken.
#[test]
fn whatever_a_device_lacks_everything_renders() {
    if gpu().is_none() {
        return;
    }
    let stage = Stage::of(World::RobotWar);
    let view = stage.view("near", SIZE);
    use Layout::{InstancedAtlas as Instanced, LayeredArray as Layered, MixedArray as Mixed, Reused as Multipass};
    // Each with those whom it concerns.
    let features: [(wgpu::Features, &[Layout]); 7] = [
        (wgpu::Features::MULTIVIEW, &[Layered, Mixed]),
        (wgpu::Features::CLIP_DISTANCES, &[Instanced, Mixed]),
        (wgpu::Features::DEPTH_CLIP_CONTROL, &[Multipass]),
        (wgpu::Features::TIMESTAMP_QUERY, &[Multipass]),
        (wgpu::Features::PIPELINE_STATISTICS_QUERY, &[Layered]),
        (wgpu::Features::FLOAT32_FILTERABLE, &[Layout::Array]),
        (wgpu::Features::all(), &[Multipass, Layered, Instanced, Mixed]),
    ];
    let mut expected: Option<GrayAlphaImage> = None;
    for (withhold, layouts) in features {
        let gpu = Gpu::new(&GpuOptions { withhold }).expect("a device with less");
        for &layout in layouts {
            let generation: Generation = layout.generation();
            let mut technique = Technique::pssm(2, 256);
            technique.settings.config.layout = layout;
            technique.settings.size = SIZE;
            technique.settings.config.range = stage.range();
            let mut renderer = Renderer::new(&gpu, &stage.scene, &technique.settings).expect("a renderer");
            let outputs = Outputs { mask: true, picture: true, maps: true, edges: false };
            let rendered = renderer.render(&stage.frame(&view, false), outputs).expect("a frame");
            let stats = rendered.stats;
            assert_eq!(stats.splits.len(), rendered.maps.len());
            let taken = stats.generation == generation.word();
            let noted = stats.notes.iter().any(|note| note.contains(generation.word()) && note.contains("per-split"));
            assert!(
                taken != noted,
                "{generation:?} without {withhold:?} became {}: {:?}",
                stats.generation,
                stats.notes
            );
            assert!(taken || stats.generation == "per-split");
            let mask = rendered.mask.expect("a mask");
            let expected = expected.get_or_insert_with(|| mask.clone());
            let found = difference(&mask, expected);
            // Cut at the slices' borders, where depth cannot be left unclipped, triangles round
            // otherwise.
            assert!(found <= TILES, "{generation:?} without {withhold:?}: {:.4} % differ", 100.0 * found);
        }
    }
}
