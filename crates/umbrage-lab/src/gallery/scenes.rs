//! Scenes and shots of the gallery.

use glam::DVec3;

use crate::{
    failure::Result,
    scene_request::{CameraChoice, LightChoice, SceneRequest},
};

/// A scene and its shots.
#[derive(Debug)]
pub struct Scene {
    /// Id for file names and the command line.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Sentence about the scene.
    pub about: &'static str,
    /// Name of a world, or a file from the repository's root.
    pub scene: &'static str,
    /// Direction in which the sun's light travels, for scenes without a sun of their own.
    pub sun: Option<DVec3>,
    /// Shots of the scene.
    pub shots: &'static [Shot],
}

/// A view of a scene.
#[derive(Debug)]
pub struct Shot {
    /// Name for file names.
    pub name: &'static str,
    /// Caption that says what to look for.
    pub caption: &'static str,
    /// Camera of the shot.
    pub camera: Camera,
}

/// A camera of the scene, or an eye and its target in metres.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the two ways")]
pub enum Camera {
    Named(&'static str),
    LookAt(DVec3, DVec3),
}

impl Scene {
    /// Returns the request of a shot.
    ///
    /// # Errors
    /// Never for the shots of [`SCENES`]: their lenses are sound.
    pub fn request(&self, shot: &Shot, size: [u32; 2]) -> Result<SceneRequest> {
        let light = self.sun.map_or(LightChoice::Default, LightChoice::Given);
        let request = SceneRequest { light, ..SceneRequest::new(self.scene, size) };
        request.with_camera(match shot.camera {
            Camera::Named(name) => CameraChoice::Named(name.to_owned()),
            Camera::LookAt(eye, target) => CameraChoice::LookAt { eye, target },
        })
    }

    /// Returns the command that draws a shot.
    #[must_use]
    pub fn command(&self, shot: &Shot, size: [u32; 2]) -> String {
        let vector = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
        let sun = self.sun.map_or(String::new(), |sun| format!(" --sun {}", vector(sun)));
        let camera = match shot.camera {
            Camera::Named(name) => format!("--camera {name}"),
            Camera::LookAt(eye, target) => format!("--eye {} --target {}", vector(eye), vector(target)),
        };
        let [width, height] = size;
        format!("umbrage render {}{sun} {camera} --size {width}x{height} -o picture.png", self.scene)
    }
}

/// Shots of the four cameras that every world has.
const WORLD_SHOTS: &[Shot] = &[
    Shot { name: "near", caption: "Shadows at arm's length: the first splits.", camera: Camera::Named("near") },
    Shot {
        name: "middle",
        caption: "Shadows at a hundred metres: the splits' borders lie here.",
        camera: Camera::Named("middle"),
    },
    Shot { name: "far", caption: "Shadows out to the end of the range.", camera: Camera::Named("far") },
    Shot {
        name: "dueling",
        caption: "Nearly into the light: the case that warped shadow maps cannot do.",
        camera: Camera::Named("dueling"),
    },
];

const CITY_SHOTS: &[Shot] = &[
    Shot {
        name: "near",
        caption: "A lamp, a tree and the truss, from the pavement.",
        camera: Camera::LookAt(DVec3::new(-60.0, -5.0, -20.0), DVec3::new(-110.0, -9.0, 5.0)),
    },
    Shot {
        name: "middle",
        caption: "The truss's shadow across the square and up the houses.",
        camera: Camera::LookAt(DVec3::new(-245.0, -7.9, 11.0), DVec3::new(-225.0, -9.5, -4.0)),
    },
    Shot {
        name: "far",
        caption: "Over the roofs to the hills.",
        camera: Camera::LookAt(DVec3::new(-255.0, 70.0, -200.0), DVec3::new(-120.0, -10.0, 0.0)),
    },
    Shot {
        name: "dueling",
        caption: "Along the author's driveline, nearly into the light: the case that warped shadow maps cannot do.",
        camera: Camera::LookAt(DVec3::new(-114.77, -7.95, 8.25), DVec3::new(-134.77, -7.95, 8.25)),
    },
];

const fn world(id: &'static str, title: &'static str, about: &'static str) -> Scene {
    Scene { id, title, about, scene: id, sun: None, shots: WORLD_SHOTS }
}

/// All scenes: the worlds of the PSSM paper, then the city.
pub const SCENES: &[Scene] = &[
    world("robot-war", "Robot War", "160 robots, 240,000 triangles, on a plain of 1.44 km²."),
    world("chessboard", "Huge Chessboard", "32 chessmen, 51,000 triangles, on 0.49 km²."),
    world(
        "knights",
        "Knights",
        "15 dwarfs and 15 knights on the move, 15 trees and 15 cactuses, a million triangles, in 1.6 km² of desert.",
    ),
    world(
        "mining-terrain",
        "Mining Terrain",
        "10 clawbots and 15 windmills at work, 20 rocks, 10 trees, 1.3 million triangles, on 2.56 km² of terrain.",
    ),
    Scene {
        id: "city",
        title: "City by the sea",
        about: "The track candela_city of SuperTuxKart, © 2014-2017 Jean-Manuel Clémençon, CC-BY-SA-4.0 (these pictures of it \
                too; see `assets/README.md`): 416 nodes, 294,631 triangles, under the sun its author chose.",
        scene: "assets/city_candela.glb",
        sun: Some(DVec3::new(0.97478, -0.2229, 0.01083)),
        shots: CITY_SHOTS,
    },
];

#[cfg(test)]
mod tests {
    use umbrage_scene::procedural::World;

    use super::*;

    #[test]
    fn every_world_is_shown_and_every_shot_can_be_asked_for() {
        for world in World::PAPER {
            assert!(SCENES.iter().any(|scene| scene.scene == world.name()), "{}", world.name());
        }
        for scene in SCENES {
            for shot in scene.shots {
                scene.request(shot, [80, 60]).expect(shot.name);
                assert!(scene.command(shot, [80, 60]).contains("--size 80x60"));
            }
        }
        let city = SCENES.iter().find(|scene| scene.id == "city").expect("the city");
        assert_eq!(
            city.command(&city.shots[0], [800, 600]),
            "umbrage render assets/city_candela.glb --sun 0.97478,-0.2229,0.01083 --eye -60,-5,-20 --target -110,-9,5 \
             --size 800x600 -o picture.png"
        );
    }
}
