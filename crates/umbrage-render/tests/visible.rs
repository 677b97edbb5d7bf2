//! What is shaded: what is seen and nothing else, by shaders that may never have heard of shadows.

mod common;

use common::{SIZE, Stage, cuboid, gpu, ground, look, quad, scene, settings, sphere, sun};
use glam::DVec3;
use image::RgbaImage;
use umbrage_render::{Frame, Outputs, Renderer};
use umbrage_scene::{AlphaMode, Material, Primitive, Scene, Texture, TextureFilter, Wrap};

const PICTURE: Outputs = Outputs { picture: true, mask: false, maps: false, edges: false };

/// A box, a ball and a card with holes on a ground.
fn garden() -> Scene {
    let mut card = Primitive { material: 1, ..Primitive::default() };
    quad(&mut card, DVec3::new(-4.0, 2.5, 1.0), DVec3::X * 3.0, DVec3::Y * 2.5, DVec3::Z);
    let mut scene = scene(vec![
        ground(0.0, 60.0),
        cuboid(DVec3::new(1.0, 0.0, -2.0), DVec3::new(4.0, 3.0, 1.0)),
        sphere(DVec3::new(6.0, 2.0, 0.0), 2.0),
        card,
    ]);
    let alpha = AlphaMode::Mask { cutoff: 0.5 };
    scene.materials.push(Material { alpha, base_color_texture: Some(0), double_sided: true, ..Material::default() });
    let texel = |x: u32, y: u32| [60, 160, 60, if (x / 4 + y / 4).is_multiple_of(2) { 255 } else { 0 }];
    let rgba = (0..32).flat_map(|y| (0..32).flat_map(move |x| texel(x, y))).collect();
    scene.textures.push(Texture { width: 32, height: 32, rgba, wrap: [Wrap::Clamp; 2], filter: TextureFilter::Linear });
    scene
}

fn picture(stage: &mut Stage) -> RgbaImage {
    let view = look(DVec3::new(0.0, 5.0, 14.0), DVec3::new(0.0, 1.5, 0.0));
    stage.render(&view, sun(DVec3::new(0.4, -1.0, -0.3)), PICTURE).picture.expect("a picture")
}

/// Triangles at the same place to the bit: what the list names first is seen, as if there were no
/// depth pass.
#[test]
fn the_first_of_two_surfaces_at_one_place_is_seen() {
    let Some(gpu) = gpu() else { return };
    let square = |material: usize| {
        let mut primitive = Primitive { material, ..Primitive::default() };
        quad(&mut primitive, DVec3::new(0.0, 2.0, 0.0), DVec3::X * 6.0, DVec3::Y * 2.0, DVec3::Z);
        primitive
    };
    for (order, expected) in [([0, 1], 0), ([1, 0], 2)] {
        let mut scene = scene(vec![square(order[0])]);
        scene.meshes[0].primitives.push(square(order[1]));
        scene.materials[0].base_color = [0.8, 0.05, 0.05, 1.0];
        scene.materials.push(Material { base_color: [0.05, 0.05, 0.8, 1.0], ..Material::default() });
        let picture = picture(&mut Stage::new(&gpu, &scene, &settings()));
        let pixel = picture.get_pixel(SIZE[0] / 2, SIZE[1] / 2).0;
        let strongest = (0..3).max_by_key(|&channel| pixel[channel]);
        assert_eq!(strongest, Some(expected), "{order:?}: {pixel:?}");
    }
}

#[test]
fn shaders_without_shadows_draw_what_switched_off_shadows_draw() {
    let Some(gpu) = gpu() else { return };
    let (scene, settings) = (garden(), settings());
    let pose = scene.pose(0.0).expect("a pose");
    let view = look(DVec3::new(0.0, 5.0, 14.0), DVec3::new(0.0, 1.5, 0.0));
    let sun = sun(DVec3::new(0.4, -1.0, -0.3));
    let drawn = |mut renderer: Renderer, shadows_on| {
        let frame = Frame { shadows_on, ..Stage::frame(&pose, &view, sun) };
        let rendered = renderer.render(&frame, PICTURE).expect("a frame");
        (rendered.picture.expect("a picture"), rendered.stats)
    };
    let make = || Renderer::new(&gpu, &scene, &settings).expect("a renderer");
    let bare = || Renderer::without_shadows(&gpu, &scene, &settings).expect("a renderer");
    let (on, _) = drawn(make(), true);
    let (off, _) = drawn(make(), false);
    for shadows_on in [false, true] {
        let (without, stats) = drawn(bare(), shadows_on);
        let most = without.iter().zip(off.iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(most <= Some(1), "{most:?}");
        assert_eq!((stats.shadow_draws, stats.shadow_ms), (0, 0.0), "a map was drawn");
    }
    assert!(on.iter().zip(off.iter()).any(|(a, b)| a.abs_diff(*b) > 40), "there are shadows to leave out");
}
