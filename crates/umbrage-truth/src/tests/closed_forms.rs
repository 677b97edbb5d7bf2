//! Shadows whose outline is known.

use glam::{DAffine3, DVec2, DVec3};
use umbrage::{Light, PointLight, SpotLight};

use super::scenes::{Shape, Stage, view};
use crate::TruthMask;

/// Checks every hit on object `floor` against `lit`, which may abstain; answers how many of either
/// kind were checked.
fn check_floor(mask: &TruthMask, floor: usize, lit: impl Fn(DVec3) -> Option<bool>) -> [usize; 2] {
    let mut counted = [0; 2];
    for hit in mask.hits().iter().flatten().filter(|hit| hit.object as usize == floor) {
        let Some(expected) = lit(hit.position) else { continue };
        assert_eq!(hit.lit, expected, "at {}", hit.position);
        counted[usize::from(expected)] += 1;
    }
    counted
}

#[test]
fn a_sphere_throws_an_ellipse() {
    let mut stage = Stage::default();
    let centre = DVec3::new(0.5, 3.0, -0.25);
    stage.add(Shape::sphere(1.0, 128), DAffine3::from_translation(centre));
    let floor = stage.add(Shape::floor(30.0, 0.0), DAffine3::IDENTITY);
    for (sun, eye) in [
        (DVec3::new(0.0, -1.0, 0.0), DVec3::new(4.0, 8.0, 5.0)),
        (DVec3::new(1.0, -1.0, 0.5), DVec3::new(4.0, 8.0, 5.0)),
        (DVec3::new(-1.0, -0.3, 2.0), DVec3::new(-3.0, 12.0, -6.0)),
    ] {
        let to_light = -sun.normalize();
        let mask = stage.mask(&view(eye, DVec3::new(1.0, 0.0, 1.0)), sun, [160, 120]);
        // The mesh is inscribed: within 0.1 % of the outline it may differ from the sphere.
        let [dark, lit] = check_floor(&mask, floor, |p| {
            let off = centre - p;
            let distance = (off - off.dot(to_light) * to_light).length();
            ((distance - 1.0).abs() > 1e-3).then_some(distance > 1.0)
        });
        assert!(dark > 50 && lit > 5000, "{dark} {lit}");
    }
}

#[test]
fn the_ellipse_has_the_area_it_should() {
    let mut stage = Stage::default();
    stage.add(Shape::sphere(1.0, 64), DAffine3::from_translation(DVec3::new(0.0, 5.0, 0.0)));
    stage.add(Shape::floor(40.0, 0.0), DAffine3::IDENTITY);
    let sun = DVec3::new(1.0, -1.0, 0.0);
    // From below the floor, straight up, 12 x 12 m of it in 240 x 240 pixels: 400 pixels a square
    // metre.
    let frustum = umbrage::Frustum::orthographic(12.0, 12.0, 0.5, 100.0).unwrap();
    let eye = DVec3::new(5.0, 20.0, 0.0);
    let view = umbrage::View::look_at_upright(eye, DVec3::new(5.0, 0.0, 0.0), frustum).unwrap();
    let mask = stage.mask(&view, sun, [240, 240]);
    let dark = mask.hits().iter().flatten().filter(|hit| hit.position.y.abs() < 1e-6 && !hit.lit).count();
    let area = std::f64::consts::PI / 45_f64.to_radians().sin() * 400.0;
    assert!((dark as f64 / area - 1.0).abs() < 0.02, "{dark} pixels, {area} expected");
}

#[test]
fn a_fence_throws_its_slats() {
    let mut stage = Stage::default();
    let floor = stage.add(Shape::floor(50.0, 0.0), DAffine3::IDENTITY);
    let mut slats = Shape::default();
    for k in -10..10 {
        let x = k as f32;
        slats.append(Shape::quad([[x, 0.0, 0.0], [x + 0.5, 0.0, 0.0], [x + 0.5, 2.0, 0.0], [x, 2.0, 0.0]]));
    }
    stage.add(slats, DAffine3::IDENTITY);
    // One unit of light goes down 1, north 2 and east 0.25.
    let sun = DVec3::new(0.25, -1.0, -2.0);
    let mask = stage.mask(&view(DVec3::new(0.3, 6.0, -9.0), DVec3::new(0.0, 0.0, -2.0)), sun, [160, 120]);
    let [dark, lit] = check_floor(&mask, floor, |p| {
        let height = -p.z / 2.0;
        let x = p.x - 0.25 * height;
        let edge = [height, height - 2.0, (2.0 * x).fract()].iter().any(|e| e.abs() < 1e-3);
        let behind = height > 0.0 && height < 2.0 && (-10.0..10.0).contains(&x);
        (!edge && (x.abs() - 10.0).abs() > 1e-3).then_some(!(behind && x.rem_euclid(1.0) < 0.5))
    });
    assert!(dark > 1500 && lit > 1500, "{dark} {lit}");
}

/// A box of 2 m on the floor, under any sun: the ray to the light against the slabs of the box.
fn check_box(sun: DVec3, eye: DVec3) -> [usize; 2] {
    let mut stage = Stage::default();
    let floor = stage.add(Shape::floor(500.0, 0.0), DAffine3::IDENTITY);
    let cuboid = stage.add(Shape::cuboid([-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]), DAffine3::IDENTITY);
    let (low, high) = (DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 2.0, 1.0));
    let to_light = -sun.normalize();
    let mask = stage.mask(&view(eye, DVec3::new(0.0, 0.5, 0.0)), sun, [160, 120]);
    // A convex box does not shadow the faces that look at the light, and those that look away are
    // dark.
    for hit in mask.hits().iter().flatten().filter(|hit| hit.object as usize == cuboid) {
        assert_eq!(hit.lit, hit.normal.dot(to_light) > 0.0, "{hit:?}");
    }
    check_floor(&mask, floor, |p| {
        let (a, b) = ((low - p) / to_light, (high - p) / to_light);
        let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
        let margin = 1e-9 * (1.0 + p.length());
        ((leave - enter).abs() > margin && leave.abs() > 0.01).then_some(!(leave > enter && leave > 0.0))
    })
}

#[test]
fn a_box_under_several_suns() {
    let [dark, lit] = check_box(DVec3::new(1.0, -2.0, 0.7), DVec3::new(4.0, 5.0, 6.0));
    assert!(dark > 100 && lit > 8000, "{dark} {lit}");
    // Half a degree above the horizon, so the shadow is 230 m long.
    let [dark, lit] = check_box(DVec3::new(1.0, -0.0087, 0.2), DVec3::new(8.0, 5.0, 6.0));
    assert!(dark > 500 && lit > 2000, "{dark} {lit}");
}

#[test]
fn a_sun_straight_down_darkens_only_what_is_below() {
    let mut stage = Stage::default();
    let floor = stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
    stage.add(Shape::floor(1.0, 4.0), DAffine3::IDENTITY);
    let mask = stage.mask(&view(DVec3::new(0.0, 2.0, 9.0), DVec3::ZERO), DVec3::NEG_Y, [160, 120]);
    let [dark, lit] = check_floor(&mask, floor, |p| Some(DVec2::new(p.x, p.z).abs().max_element() > 1.0));
    assert!(dark > 100 && lit > 5000, "{dark} {lit}");
}

#[test]
fn a_sun_in_the_plane_of_the_floor_leaves_it_dark() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(20.0, 0.0), DAffine3::IDENTITY);
    let view = view(DVec3::new(0.0, 2.0, 9.0), DVec3::ZERO);
    for (sun, lit) in [(DVec3::X, false), (DVec3::new(1.0, -1e-9, 0.0), true), (DVec3::new(1.0, 1e-9, 0.0), false)] {
        let mask = stage.mask(&view, sun, [32, 24]);
        assert!(mask.hits().iter().flatten().count() > 100);
        assert!(mask.hits().iter().flatten().all(|hit| hit.lit == lit), "{sun}");
    }
}

#[test]
fn a_hundred_kilometres_away_everything_is_the_same() {
    let sun = DVec3::new(1.0, -1.0, 0.5);
    let at = |offset: DVec3| {
        let mut stage = Stage::default();
        stage.add(Shape::floor(30.0, 0.0), DAffine3::from_translation(offset));
        stage.add(Shape::sphere(1.0, 24), DAffine3::from_translation(offset + DVec3::new(0.5, 3.0, -0.25)));
        stage.add(Shape::cuboid([-4.0, 0.0, -2.0], [-3.0, 2.0, 3.0]), DAffine3::from_translation(offset));
        stage.mask(&view(offset + DVec3::new(4.0, 8.0, 5.0), offset), sun, [160, 120])
    };
    let here = at(DVec3::ZERO);
    for offset in [DVec3::new(1e5, 0.0, 0.0), DVec3::new(-131_072.0, 4096.0, 131_072.0)] {
        let there = at(offset);
        let mut differences = 0;
        for (a, b) in here.hits().iter().zip(there.hits()) {
            let (Some(a), Some(b)) = (a, b) else {
                assert_eq!(a.is_some(), b.is_some());
                continue;
            };
            assert!((a.position + offset).distance(b.position) < 1e-8);
            differences += usize::from(a.lit != b.lit);
        }
        // 4 ulp at 141 km are 6 cm: only the seam between box and floor may tell.
        assert!(differences <= 12, "{differences} pixels at {offset}");
    }
}

#[test]
fn the_image_says_lit_dark_and_nothing() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(3.0, 0.0), DAffine3::IDENTITY);
    stage.add(Shape::floor(1.0, 1.0), DAffine3::IDENTITY);
    let heard = std::sync::Mutex::new(Vec::new());
    let view = view(DVec3::new(0.0, 4.0, 6.0), DVec3::ZERO);
    let truth = stage.truth(view.eye());
    let mask = truth.mask(&view, DVec3::NEG_Y, [80, 60], &|share| heard.lock().unwrap().push(share)).unwrap();
    let image = mask.to_image();
    assert_eq!(image.dimensions(), (80, 60));
    let kinds: std::collections::BTreeSet<[u8; 2]> = image.pixels().map(|p| p.0).collect();
    assert_eq!(kinds.into_iter().collect::<Vec<_>>(), [[0, 0], [0, 255], [255, 255]]);
    for (pixel, hit) in image.pixels().zip(mask.hits()) {
        assert_eq!(pixel.0, hit.map_or([0, 0], |hit| [if hit.lit { 255 } else { 0 }, 255]));
    }
    let heard = heard.into_inner().unwrap();
    assert_eq!(heard.iter().copied().fold(0.0, f32::max), 1.0);
    assert!(heard.iter().all(|share| (0.0..=1.0).contains(share)));

    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("mask.png");
    image.save(&path).unwrap();
    assert_eq!(crate::read_mask(&path).unwrap(), image);
    let missing = crate::read_mask(&directory.path().join("missing.png")).unwrap_err();
    assert!(matches!(missing, crate::Error::Image { .. }) && missing.to_string().contains("missing.png"), "{missing}");
}

#[test]
fn points_are_answered_as_pixels_are() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(30.0, 0.0), DAffine3::IDENTITY);
    stage.add(Shape::sphere(1.0, 24), DAffine3::from_translation(DVec3::new(0.5, 3.0, -0.25)));
    let sun = DVec3::new(1.0, -1.0, 0.5);
    let view = view(DVec3::new(4.0, 8.0, 5.0), DVec3::ZERO);
    let truth = stage.truth(view.eye());
    let mask = truth.mask(&view, sun, [80, 60], &|_| {}).unwrap();
    let hits: Vec<_> = mask.hits().iter().flatten().collect();
    let points: Vec<_> = hits.iter().map(|hit| (hit.position, hit.normal)).collect();
    let answers = truth.visibility_at(&points, sun).unwrap();
    assert_eq!(answers.len(), hits.len());
    for (hit, answer) in hits.iter().zip(answers) {
        assert_eq!(answer, f32::from(u8::from(hit.lit)), "{hit:?}");
    }
    assert!(truth.visibility_at(&[(DVec3::NAN, DVec3::Y)], sun).is_err());
    assert!(truth.visibility_at(&[], DVec3::ZERO).is_err());
    assert!(truth.mask(&view, sun, [0, 60], &|_| {}).is_err());
    assert!(truth.mask(&view, DVec3::new(0.0, f64::NAN, 0.0), [8, 6], &|_| {}).is_err());
}

#[test]
fn a_lamp_throws_shadows_as_large_as_similar_triangles_say() {
    // A plate of 1 m half way between a lamp and the ground, one above the lamp, and one out of its
    // reach.
    let mut stage = Stage::default();
    stage.add(Shape::floor(30.0, 0.0), DAffine3::IDENTITY);
    stage.add(Shape::floor(0.5, 2.0), DAffine3::IDENTITY);
    stage.add(Shape::floor(0.5, 5.0), DAffine3::IDENTITY);
    let view = view(DVec3::new(6.0, 9.0, 7.0), DVec3::ZERO);
    let truth = stage.truth(view.eye());
    let at = DVec3::new(0.0, 4.0, 0.0);
    let lamp = Light::from(PointLight::new(at, 6.0).unwrap());
    let spot = Light::from(SpotLight::new(at, DVec3::NEG_Y, 0.6, 6.0).unwrap());
    for light in [lamp, spot] {
        let mask = truth.mask_under(&view, &light, [160, 120], &|_| {}).unwrap();
        let mut seen = [0; 3];
        for hit in mask.hits().iter().flatten().filter(|hit| hit.position.y.abs() < 1e-6) {
            let p = hit.position;
            let shaded = p.x.abs().max(p.z.abs()) < 1.0;
            let reached = light.illuminates(p);
            // Where it does not reach nothing is shadowed, the plate's shadow included.
            assert_eq!(hit.lit, !shaded || !reached, "{p}");
            seen[usize::from(shaded) + usize::from(!reached)] += 1;
        }
        assert!(seen[0] > 100 && seen[1] > 100, "lit, shaded or out of reach: {seen:?}");
        let domain = crate::scores::Domain::new(&mask, (0.1, 100.0)).unwrap();
        let scored = domain.points(&mask).unwrap();
        assert!(scored.iter().all(|(p, n)| light.illuminates(*p) && n.dot(light.to_light(*p)) > 0.02));
        // The plate over the lamp is lit from below only.
        let above = [(DVec3::new(0.2, 5.0, 0.1), DVec3::Y), (DVec3::new(0.2, 5.0, 0.1), DVec3::NEG_Y)];
        assert_eq!(truth.visibility_under(&above, &light).unwrap(), [0.0, 1.0]);
    }
    let mask = truth.mask_under(&view, &lamp, [16, 12], &|_| {}).unwrap();
    let soft = truth.soft(&mask, &crate::SunDisc::new(0.01, 16), &|_| {});
    assert!(soft.is_err_and(|error| error.to_string().contains("directional")), "a lamp is no disc in the sky");
}

#[test]
fn a_mask_is_the_same_however_many_rows_are_traced_at_once() {
    let mut stage = Stage::default();
    stage.add(Shape::floor(30.0, 0.0), DAffine3::IDENTITY);
    stage.add(Shape::floor(1.0, 2.0), DAffine3::IDENTITY);
    let view = view(DVec3::new(6.0, 9.0, 7.0), DVec3::ZERO);
    let truth = stage.truth(view.eye());
    let light = Light::from(PointLight::new(DVec3::new(0.0, 4.0, 0.0), 6.0).unwrap());
    // No multiple of eight rows: the last band is a narrower one.
    let size = [40, 29];
    let mut tracing = truth.begin_mask(&view, &light, size).unwrap();
    assert!((tracing.advance() - 8.0 / 29.0).abs() < 1e-6, "eight rows at a time");
    while tracing.advance() < 1.0 {}
    let mask = truth.mask_under(&view, &light, size, &|_| {}).unwrap();
    assert_eq!(tracing.finish().expect("all rows").hits(), mask.hits());
    assert!(mask.hits().iter().flatten().any(|hit| hit.lit) && mask.hits().iter().flatten().any(|hit| !hit.lit));
    assert!(truth.begin_mask(&view, &light, size).unwrap().finish().is_none(), "nothing is traced yet");
}

#[test]
fn the_first_caster_is_what_a_map_would_store() {
    let mut stage = Stage::default();
    let sphere = stage.add(Shape::sphere(1.0, 64), DAffine3::from_translation(DVec3::new(0.0, 5.0, 0.0)));
    let material = stage.material(umbrage_scene::Material::default());
    let screen = Shape::floor(3.0, 8.0).with_material(material);
    stage.add_primitive(screen, DAffine3::IDENTITY, false);
    let floor = stage.add(Shape::floor(30.0, 0.0), DAffine3::IDENTITY);
    let truth = stage.truth(DVec3::ZERO);
    let from =
        |x: f64, direction: DVec3, most| truth.first_caster(DVec3::new(x, 20.0, 0.0), direction, most).expect("a ray");
    // Through the screen, which casts nothing, onto the sphere's top; beside it, onto the floor.
    let top = from(0.0, DVec3::NEG_Y * 3.0, 1e6).expect("the sphere");
    assert_eq!(top.object as usize, sphere);
    assert!((top.depth - 14.0).abs() < 1e-3 && top.position.y > 5.9, "{top:?}");
    assert_eq!(from(2.0, DVec3::NEG_Y, 1e6).expect("the floor").object as usize, floor);
    assert_eq!(from(0.0, DVec3::NEG_Y, 13.0), None, "too far");
    assert_eq!(from(0.0, DVec3::Y, 1e6), None, "nothing is above");
    // Both sides count: from below, the floor's back.
    let below = truth.first_caster(DVec3::new(2.0, -5.0, 0.0), DVec3::Y, 1e6).expect("a ray").expect("the floor");
    assert_eq!(below.object as usize, floor);
    assert!(truth.first_caster(DVec3::NAN, DVec3::Y, 1.0).is_err());
    assert!(truth.first_caster(DVec3::ZERO, DVec3::ZERO, 1.0).is_err());
}
