//! Scenes for umbrage: what a renderer draws and a ray meets, wherever it comes from.
//!
//! Right-handed, +Y up, metres; conventions and names of spaces are those of the crate `umbrage`.
//!
//! * [`open`] takes whatever a user names: a world, a glTF file, a height map.
//! * [`Scene`] is geometry stored once and nodes that place it; [`Scene::pose`] is a scene at one
//!   moment.
//! * [`camera_view`], [`light_direction`] and their invented counterparts say from where and by
//!   which sun it is seen.
//! * [`CameraPath`] walks through it, [`export_glb`] writes it down.
//!
//! ```
//! use umbrage_scene::{OpenOptions, camera_view, export_glb, light_direction, open};
//!
//! let scene = open("chessboard", &OpenOptions::default())?;
//! let pose = scene.pose(2.5)?;
//! let view = camera_view(&scene, &pose, 0, 800.0 / 600.0, None, None)?;
//! let sun = light_direction(&scene, &pose, 0)?;
//! assert!(sun.y < 0.0, "the sun is up");
//! assert!(pose.objects.iter().any(|object| object.casts && view.view_depth(object.bounds.center()) > 0.0));
//! let glb = export_glb(&scene)?;
//! # assert!(glb.starts_with(b"glTF"));
//! # Ok::<(), umbrage_scene::Error>(())
//! ```

mod camera_path;
mod error;
mod export;
mod extensions;
mod frame;
mod gltf;
mod height_map;
mod model;
mod morph;
mod moved;
mod open;
mod outline;
mod picture;
mod pose;
pub mod procedural;
mod sample;
mod validate;

pub use camera_path::CameraPath;
pub use error::{Error, Result};
pub use export::export_glb;
pub use extensions::{EXTENSIONS, Extensions};
pub use frame::{camera_view, invented_sun, invented_view, light_direction, scene_light};
pub use gltf::{GltfOptions, load_gltf, load_gltf_slice};
pub use height_map::{HeightEncoding, HeightMapOptions, load_height_map, load_height_map_slice};
pub use model::*;
pub use open::{OpenOptions, open, open_slice, open_watched};
pub use pose::{Detail, Poser};
