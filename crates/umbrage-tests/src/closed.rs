//! Closed rooms: no sun may light anything inside.

use glam::DVec3;
use umbrage::{DirectionalLight, Frustum, ShadowConfig, View};
use umbrage_render::{Frame, Gpu, Outputs, RenderSettings, Renderer};
use umbrage_scene::{Material, Primitive, Scene};

use crate::room::{cuboid, place};

/// Least corner of the room's inside, in metres.
const MIN: [f32; 3] = [-4.0, 0.0, -3.0];
const MAX: [f32; 3] = [4.0, 3.0, 3.0];

/// Construction of the walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Walls {
    /// One box, seen from both sides.
    Thin,
    /// A box within a box, with this distance between them in metres.
    Shell(f32),
    /// A box for each wall, with this thickness in metres. Floor and ceiling reach over the other
    /// walls.
    Slabs(f32),
}

/// Makes a room of 8 × 3 × 6 m on a ground of 80 m.
#[must_use]
pub fn closed_room(walls: Walls) -> Scene {
    let mut scene = Scene { name: "closed room".to_owned(), ..Scene::default() };
    scene.materials.push(Material { double_sided: true, ..Material::default() });
    let mut add = |name: &str, boxes: &[([f32; 3], [f32; 3])]| {
        let mut primitive = Primitive::default();
        boxes.iter().for_each(|&(min, max)| cuboid(&mut primitive, min, max));
        place(&mut scene, name, primitive);
    };
    let grown = |by: f32| (MIN.map(|x| x - by), MAX.map(|x| x + by));
    let thickness = match walls {
        Walls::Thin => 0.0,
        Walls::Shell(thickness) | Walls::Slabs(thickness) => thickness,
    };
    add("ground", &[([-40.0, -1.0, -40.0], [40.0, -thickness - 0.001, 40.0])]);
    match walls {
        Walls::Thin => add("room", &[(MIN, MAX)]),
        Walls::Shell(by) => add("room", &[(MIN, MAX), grown(by)]),
        Walls::Slabs(by) => {
            let (low, high) = grown(by);
            add("floor", &[(low, [high[0], MIN[1], high[2]])]);
            add("ceiling", &[([low[0], MAX[1], low[2]], high)]);
            let (bottom, top) = (MIN[1], MAX[1]);
            add("west", &[([low[0], bottom, low[2]], [MIN[0], top, high[2]])]);
            add("east", &[([MAX[0], bottom, low[2]], [high[0], top, high[2]])]);
            add("north", &[([MIN[0], bottom, low[2]], [MAX[0], top, MIN[2]])]);
            add("south", &[([MIN[0], bottom, MAX[2]], [MAX[0], top, high[2]])]);
        }
    }
    scene
}

/// Pairs of eye and target inside the room: across it, along its creases, and close to four of
/// them.
pub const VIEWS: [([f64; 3], [f64; 3]); 8] = [
    ([3.4, 1.6, 2.4], [-1.0, 1.2, -1.0]),
    ([-3.7, 2.8, -2.7], [2.0, 0.0, 2.0]),
    ([-3.4, 1.6, 2.4], [1.0, 1.4, -1.0]),
    ([3.6, 0.3, -2.6], [-4.0, 0.8, 3.0]),
    ([-3.6, 0.3, -0.2], [-4.0, 0.0, 0.0]),
    ([0.3, 0.25, 2.7], [0.2, 0.0, 3.0]),
    ([0.6, 2.7, -2.6], [0.2, 3.0, -3.0]),
    ([3.5, 2.6, 2.5], [4.0, 3.0, 3.0]),
];

/// Makes a sun at a height in degrees and a bearing in degrees from east.
#[must_use]
pub fn sun(height: f64, bearing: f64) -> DVec3 {
    let ((sine, cosine), (z, x)) = (height.to_radians().sin_cos(), bearing.to_radians().sin_cos());
    -DVec3::new(cosine * x, sine, cosine * z)
}

/// Numbers of lit pixels in a mask of a room.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Light {
    /// Number of all pixels.
    pub pixels: usize,
    /// Number of pixels that are more than 2 % lit.
    pub more_than_2_percent: usize,
    /// Number of pixels that are more than half lit.
    pub more_than_half: usize,
    /// Value of the brightest pixel, 0 to 255.
    pub brightest: u8,
}

/// Draws rooms and counts lit pixels.
pub struct Rooms<'a> {
    scene: &'a Scene,
    renderer: Renderer,
    size: [u32; 2],
}

impl<'a> Rooms<'a> {
    /// # Panics
    /// If the device cannot hold the maps.
    #[must_use]
    pub fn new(gpu: &Gpu, scene: &'a Scene, config: &ShadowConfig, size: [u32; 2]) -> Self {
        let settings = RenderSettings { size, config: config.clone(), ..RenderSettings::default() };
        Self { scene, renderer: Renderer::new(gpu, scene, &settings).expect("a renderer"), size }
    }

    /// Counts the lit pixels of one view, and returns them with the mask.
    ///
    /// # Panics
    /// If it cannot be drawn.
    pub fn light(&mut self, (eye, target): ([f64; 3], [f64; 3]), sun: DVec3) -> (Light, image::GrayAlphaImage) {
        let pose = self.scene.pose(0.0).expect("a pose");
        let aspect = f64::from(self.size[0]) / f64::from(self.size[1]);
        let lens = Frustum::perspective(1.4, aspect, 0.05, 100.0).expect("a lens");
        let view = View::look_at_upright(eye.into(), target.into(), lens).expect("a view");
        let light = DirectionalLight::new(sun).expect("a direction").into();
        let frame =
            Frame { pose: &pose, moved: None, view: &view, light, more_lights: &[], shadows_on: true, tint: false };
        self.renderer.restart();
        let outputs = Outputs { mask: true, ..Outputs::default() };
        let mask = self.renderer.render(&frame, outputs).expect("a frame").mask.expect("a mask was asked for");
        (light_of(&mask), mask)
    }
}

/// Counts the lit pixels of a mask. Pixels without an answer count as lit.
#[must_use]
pub fn light_of(mask: &image::GrayAlphaImage) -> Light {
    let shares = mask.pixels().map(|pixel| if pixel.0[1] == 0 { 255 } else { pixel.0[0] });
    shares.fold(Light::default(), |light, share| Light {
        pixels: light.pixels + 1,
        more_than_2_percent: light.more_than_2_percent + usize::from(share > 5),
        more_than_half: light.more_than_half + usize::from(share > 127),
        brightest: light.brightest.max(share),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_are_scenes() {
        for walls in [Walls::Thin, Walls::Shell(0.05), Walls::Slabs(0.05)] {
            closed_room(walls).validate().expect("valid");
        }
    }

    #[test]
    fn light_is_counted() {
        let shares = [0, 5, 6, 127, 128, 255];
        let mask = image::GrayAlphaImage::from_fn(6, 1, |x, _| image::LumaA([shares[x as usize], 255]));
        let expected = Light { pixels: 6, more_than_2_percent: 4, more_than_half: 2, brightest: 255 };
        assert_eq!(light_of(&mask), expected);
        assert_eq!(light_of(&image::GrayAlphaImage::new(1, 1)).more_than_half, 1);
    }
}
