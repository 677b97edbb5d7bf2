//! Pictures of alpha-tested surfaces: opaque, and of the leaves' own colour up to their edges.

mod common;

use common::{Stage, gpu, ground, look, quad, scene, settings, sun};
use glam::DVec3;
use image::RgbaImage;
use umbrage_render::{Outputs, RenderSettings, Samples};
use umbrage_scene::{AlphaMode, Material, Primitive, Scene, Texture, TextureFilter, Wrap};

/// Dark green leaves on a ground that is as dark and as green, round dots of texture among texels
/// that are white where nobody sees them.
fn leaves() -> Scene {
    let mut card = Primitive { material: 1, ..Primitive::default() };
    quad(&mut card, DVec3::Y * 3.0, DVec3::X * 12.0, DVec3::NEG_Z * 12.0, DVec3::Y);
    card.uvs.iter_mut().flatten().for_each(|coordinate| *coordinate *= 24.0);
    let mut scene = scene(vec![ground(0.0, 300.0), card]);
    scene.materials[0].base_color = [0.02, 0.08, 0.02, 1.0];
    let alpha = AlphaMode::Mask { cutoff: 0.5 };
    scene.materials.push(Material { alpha, base_color_texture: Some(0), double_sided: true, ..Material::default() });
    let texel = |x: i32, y: i32| {
        let is_leaf = (2 * x - 15).pow(2) + (2 * y - 15).pow(2) < 100;
        if is_leaf { [38, 80, 38, 255] } else { [255, 255, 255, 0] }
    };
    let rgba = (0..16).flat_map(|y| (0..16).flat_map(move |x| texel(x, y))).collect();
    scene.textures.push(Texture {
        width: 16,
        height: 16,
        rgba,
        wrap: [Wrap::Repeat; 2],
        filter: TextureFilter::Linear,
    });
    scene
}

fn picture(settings: &RenderSettings) -> Option<RgbaImage> {
    let gpu = gpu()?;
    let mut stage = Stage::new(&gpu, &leaves(), settings);
    let outputs = Outputs { picture: true, ..Outputs::default() };
    let view = look(DVec3::new(0.0, 9.0, 16.0), DVec3::ZERO);
    stage.render(&view, sun(DVec3::new(0.3, -1.0, 0.2)), outputs).picture
}

#[test]
fn a_picture_is_opaque() {
    for samples in [Samples::One, Samples::Four] {
        let Some(picture) = picture(&RenderSettings { samples, ..settings() }) else { return };
        let seen_through = picture.pixels().filter(|pixel| pixel.0[3] != 255).count();
        assert_eq!(seen_through, 0, "{samples:?}");
    }
}

#[test]
fn leaves_have_no_fringes_of_what_nobody_sees() {
    let Some(picture) = picture(&settings()) else { return };
    let [width, height] = [picture.width(), picture.height()];
    // The lower half shows leaves and ground and nothing else. White mixed in would make red as
    // bright as green.
    let pale = (height / 2..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| picture.get_pixel(x, y).0)
        .filter(|[red, green, _, _]| f64::from(*red) > 0.8 * f64::from(*green))
        .count();
    assert_eq!(pale, 0, "of {}", width * (height - height / 2));
}
