//! A mask made from the picture's depth says what one made from the surfaces says, but for pixels
//! on edges.

mod common;

use common::{SIZE, Stage, config, configured, cuboid, gpu, ground, look, scene, sphere, sun};
use glam::DVec3;
use image::GrayAlphaImage;
use umbrage::config::{Coordinates, ShadowConfig};

/// Pixels that both masks hit and decide differently, and all that they hit.
fn differences(a: &GrayAlphaImage, b: &GrayAlphaImage) -> (usize, usize) {
    let hit = || a.pixels().zip(b.pixels()).filter(|(a, b)| a.0[1] > 0 && b.0[1] > 0);
    (hit().filter(|(a, b)| a.0 != b.0).count(), hit().count())
}

#[test]
fn depth_says_what_surfaces_say() {
    let Some(gpu) = gpu() else { return };
    let boxes =
        [cuboid(DVec3::new(-1.0, 0.0, -2.0), DVec3::new(1.5, 2.0, 1.0)), sphere(DVec3::new(3.0, 1.0, -6.0), 1.0)];
    let world = scene(std::iter::once(ground(0.0, 60.0)).chain(boxes).collect());
    let mut stages = [Coordinates::World, Coordinates::Deferred]
        .map(|coordinates| Stage::new(&gpu, &world, &configured(ShadowConfig { coordinates, ..config() })));
    let light = sun(DVec3::new(0.6, -0.7, -0.4));
    for (eye, target) in [
        (DVec3::new(-2.0, 4.0, 9.0), DVec3::new(1.0, 0.0, -6.0)),
        (DVec3::new(6.0, 1.0, 3.0), DVec3::new(0.0, 1.0, -2.0)),
    ] {
        let view = look(eye, target);
        let [forward, deferred] = stages.each_mut().map(|stage| stage.mask(&view, light));
        let (differ, hit) = differences(&forward, &deferred);
        assert!(hit > 5000, "{hit} pixels are hit");
        // Silhouettes, creases and the sphere's facets, whose normals neighbours cannot tell.
        assert!(100 * differ <= 2 * hit, "{differ} of {hit} pixels differ from {eye}");
        let surfaces = |mask: &GrayAlphaImage| mask.pixels().filter(|pixel| pixel.0[1] > 0).count();
        assert_eq!(surfaces(&forward), surfaces(&deferred), "the same pixels are hit");
        assert_eq!(forward.dimensions(), (SIZE[0], SIZE[1]));
    }
}
