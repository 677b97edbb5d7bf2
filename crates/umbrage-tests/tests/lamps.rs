//! Lights that stand somewhere, several at once, and several views: masks against the truth by
//! rays, and against those drawn alone.

use image::GrayAlphaImage;
use umbrage::config::{DepthFormat, Edges, Filter, ShadowConfig, Stability};
use umbrage::{Light, View};
use umbrage_render::{Frame, Lamp, Outputs, RenderSettings, Renderer};
use umbrage_scene::{Pose, Scene, camera_view, scene_light};
use umbrage_tests::judge::Ceiling;
use umbrage_tests::room::room;
use umbrage_tests::stage::{Technique, gpu};
use umbrage_truth::Truth;
use umbrage_truth::scores::{Answers, Domain, MisShadowed, mis_shadowed};

const SIZE: [u32; 2] = [240, 180];
const MASK: Outputs = Outputs { picture: false, mask: true, maps: false, edges: false };

struct Room {
    scene: Scene,
    pose: Pose,
}

impl Room {
    fn new() -> Self {
        let scene = room();
        Self { pose: scene.pose(0.0).expect("a pose"), scene }
    }

    fn view(&self, camera: &str) -> View {
        let index = self.scene.cameras.iter().position(|other| other.name == camera).expect("a camera of the room");
        camera_view(&self.scene, &self.pose, index, 4.0 / 3.0, None, None).expect("usable")
    }

    fn light(&self, name: &str) -> Light {
        let index = self.scene.lights.iter().position(|other| other.name == name).expect("a light of the room");
        scene_light(&self.scene, &self.pose, index).expect("usable")
    }

    fn frame<'a>(&'a self, view: &'a View, light: Light, more_lights: &'a [Lamp]) -> Frame<'a> {
        Frame { pose: &self.pose, moved: None, view, light: light.into(), more_lights, shadows_on: true, tint: false }
    }
}

/// Two maps of 512² for each light (and face).
fn settings(lights: &[Light], stability: Stability) -> RenderSettings {
    let any = Technique::pssm(2, 512);
    RenderSettings {
        size: SIZE,
        config: ShadowConfig { stability, ..any.settings.config },
        lights: lights.iter().map(|&light| light.into()).collect(),
        ..any.settings
    }
}

fn mask(renderer: &mut Renderer, frame: &Frame<'_>) -> GrayAlphaImage {
    renderer.render(frame, MASK).expect("a frame").mask.expect("a mask")
}

#[test]
fn masks_of_lamps_are_nearly_true() {
    let Some(gpu) = gpu() else { return };
    let room = Room::new();
    // A point light in a room; a spot light through a slatted screen, with the shelf behind it; one
    // that grazes a wall. In each pair the first camera sees the light's own place, the second has
    // it behind or above.
    let cases = [
        ("pendant", ["door", "table"], [Ceiling::above(0.00146), Ceiling::above(0.00174)]),
        ("reading", ["door", "wall"], [Ceiling::above(0.00543), Ceiling::above(0.00512)]),
        ("washer", ["wall", "door"], [Ceiling::above(0.01404), Ceiling::above(0.00777)]),
    ];
    let truth = Truth::build(&room.scene, &room.pose, room.view("door").eye()).expect("rays can meet a room");
    for (name, cameras, ceilings) in cases {
        let light = room.light(name);
        for (stability, ceiling) in [Stability::tight(), Stability::Exact].into_iter().zip(ceilings) {
            let mut renderer =
                Renderer::new(gpu, &room.scene, &settings(&[light], stability.clone())).expect("a renderer");
            let mut all = MisShadowed::default();
            for camera in cameras {
                let view = room.view(camera);
                let exact = truth.mask_under(&view, &light, SIZE, &|_| {}).expect("a mask");
                let domain = Domain::new(&exact, (0.1, 40.0)).expect("a range");
                assert!(
                    domain.edges().len() > 20 || name == "washer",
                    "{name} {camera}: {} edges",
                    domain.edges().len()
                );
                let drawn = mask(&mut renderer, &room.frame(&view, light, &[]));
                let score = mis_shadowed(&domain, &Answers::from_mask(&drawn)).expect("the same size");
                all.pixels += score.pixels;
                all.false_shadow += score.false_shadow;
                all.false_light += score.false_light;
                all.missing += score.missing;
            }
            eprintln!("{name} {stability:?}: E {:.5} ({all:?})", all.rate());
            ceiling.check(&all).unwrap_or_else(|error| panic!("{name} {stability:?}: {error}"));
        }
    }
}

/// Triangles that texels name decide the edges of a lamp's shadows, too.
#[test]
fn exact_edges_of_lamps_are_truer() {
    let Some(gpu) = gpu() else { return };
    let room = Room::new();
    let truth = Truth::build(&room.scene, &room.pose, room.view("door").eye()).expect("rays can meet a room");
    for (name, cameras) in [("pendant", ["door", "table"]), ("reading", ["door", "wall"]), ("washer", ["wall", "door"])]
    {
        let light = room.light(name);
        let error = |edges: Edges| {
            let mut settings = settings(&[light], Stability::Exact);
            let filter = Filter::Pcf3 { width_m: None };
            settings.config = ShadowConfig { edges, filter, map_sizes: vec![256; 2], ..settings.config };
            let mut renderer = Renderer::new(gpu, &room.scene, &settings).expect("a renderer");
            let mut all = MisShadowed::default();
            for camera in cameras {
                let view = room.view(camera);
                let exact = truth.mask_under(&view, &light, SIZE, &|_| {}).expect("a mask");
                let domain = Domain::new(&exact, (0.1, 40.0)).expect("a range");
                let drawn = mask(&mut renderer, &room.frame(&view, light, &[]));
                let score = mis_shadowed(&domain, &Answers::from_mask(&drawn)).expect("the same size");
                all.pixels += score.pixels;
                all.false_shadow += score.false_shadow;
                all.false_light += score.false_light;
            }
            all
        };
        let (sampled, exact) = (error(Edges::Sampled), error(Edges::exact()));
        eprintln!("{name}: sampled {:.5} ({sampled:?}), exact {:.5} ({exact:?})", sampled.rate(), exact.rate());
        assert!(exact.rate() < 0.5 * sampled.rate(), "{name}");
    }
}

#[test]
fn linear_depth_decides_as_perspective_depth_does() {
    let Some(gpu) = gpu() else { return };
    let room = Room::new();
    for name in ["pendant", "reading", "washer"] {
        let light = room.light(name);
        let view = room.view("door");
        let [perspective, linear] = [DepthFormat::D32Float, DepthFormat::R32Float].map(|depth_format| {
            let mut settings = settings(&[light], Stability::tight());
            settings.config.depth_format = depth_format;
            let mut renderer = Renderer::new(gpu, &room.scene, &settings).expect("a renderer");
            mask(&mut renderer, &room.frame(&view, light, &[]))
        });
        let different = perspective.pixels().zip(linear.pixels()).filter(|(a, b)| a != b).count();
        // One nearest texel, one comparison: what differs is rounding, at edges that a texel's
        // centre grazes.
        assert!(different <= 20, "{name}: {different} pixels of {}", SIZE[0] * SIZE[1]);
    }
}

#[test]
fn a_light_among_others_is_as_it_is_alone() {
    let Some(gpu) = gpu() else { return };
    let room = Room::new();
    let [pendant, reading, washer] = ["pendant", "reading", "washer"].map(|name| room.light(name));
    let view = room.view("door");
    let all = [reading, pendant, washer];
    let others = [Lamp::from(pendant), Lamp::from(washer)];
    let mut together = Renderer::new(gpu, &room.scene, &settings(&all, Stability::Exact)).expect("a renderer");
    let mut alone = Renderer::new(gpu, &room.scene, &settings(&[reading], Stability::Exact)).expect("a renderer");
    let rendered =
        together.render(&room.frame(&view, reading, &others), Outputs { picture: true, ..MASK }).expect("a frame");
    assert_eq!(rendered.mask, Some(mask(&mut alone, &room.frame(&view, reading, &[]))));
    assert_eq!(rendered.stats.more_lights.iter().map(|light| light.splits.len()).collect::<Vec<_>>(), [12, 2]);
    // The picture has the light of all: no pixel is darker than with one, and some are brighter.
    let one = alone
        .render(&room.frame(&view, reading, &[]), Outputs { picture: true, mask: false, maps: false, edges: false });
    let (one, all) = (one.expect("a frame").picture.expect("a picture"), rendered.picture.expect("a picture"));
    let brighter = one.pixels().zip(all.pixels()).filter(|(one, all)| all.0[0] > one.0[0].saturating_add(20)).count();
    assert!(one.pixels().zip(all.pixels()).all(|(one, all)| all.0[0] >= one.0[0].saturating_sub(1)));
    assert!(brighter > 10_000, "{brighter}");

    let error = together.render(&room.frame(&view, reading, &[]), MASK).expect_err("two lights are missing");
    assert!(error.to_string().contains("1 lights") && error.to_string().contains("3"), "{error}");
}

#[test]
fn views_beside_each_other_are_as_they_are_alone() {
    let Some(gpu) = gpu() else { return };
    let room = Room::new();
    let light = room.light("pendant");
    let settings = settings(&[light], Stability::Exact);
    let mut both = Renderer::new(gpu, &room.scene, &settings).expect("a renderer");
    let mut alone = ["door", "table"].map(|_| Renderer::new(gpu, &room.scene, &settings).expect("a renderer"));
    // Three frames, so that what stabilisation holds of one view could reach the other.
    for step in 0..3 {
        let views = ["door", "table"].map(|camera| {
            let view = room.view(camera);
            let eye = view.eye() + view.forward() * 0.4 * f64::from(step);
            View::look_at_upright(eye, eye + view.forward(), *view.frustum()).expect("usable")
        });
        let frames = views.each_ref().map(|view| room.frame(view, light, &[]));
        let beside = both.render_views(&frames, None, MASK).expect("two views");
        assert_ne!(beside[0].mask, beside[1].mask, "two cameras see two pictures");
        for ((rendered, frame), alone) in beside.into_iter().zip(&frames).zip(&mut alone) {
            assert_eq!(rendered.mask, Some(mask(alone, frame)), "frame {step}");
        }
    }
}
