//! Opening a scene, with a progress bar for slow ones.

use glam::DVec3;
use umbrage::{Projection, View};
use umbrage_scene::{Detail, OpenOptions, Pose, Scene};

use crate::failure::Result;
#[cfg(feature = "judge")]
use crate::progress;

/// Opens a scene and moves it.
///
/// # Errors
/// [`crate::failure::Failure::Input`] with the file or option at fault.
pub fn open(name: &str, files: &OpenOptions, move_scene: Option<DVec3>) -> Result<Scene> {
    let scene = watched(name, files)?;
    Ok(match move_scene {
        Some(by) => scene.moved(by),
        None => scene,
    })
}

#[cfg(feature = "judge")]
fn watched(name: &str, files: &OpenOptions) -> Result<Scene> {
    let bar = progress::fraction("building");
    let scene = umbrage_scene::open_watched(name, files, &|done| progress::set_fraction(&bar, done));
    bar.finish_and_clear();
    Ok(scene?)
}

/// Opens a scene without a bar, because there is no terminal.
#[cfg(not(feature = "judge"))]
fn watched(name: &str, files: &OpenOptions) -> Result<Scene> {
    Ok(umbrage_scene::open(name, files)?)
}

/// Poses a scene for views, with the coarsest levels of detail that pictures of that size cannot
/// tell from finer ones. `None` if no mesh has several levels.
///
/// # Errors
/// As [`Scene::pose`].
pub fn pose_seen<'v>(
    scene: &Scene,
    time_s: f64,
    views: impl Iterator<Item = &'v View>,
    size: [u32; 2],
) -> Result<Option<Pose>> {
    if scene.levels.is_empty() {
        return Ok(None);
    }
    let (mut eyes, mut angle) = (Vec::new(), f64::INFINITY);
    for view in views {
        let frustum = view.frustum();
        eyes.push(view.eye());
        angle = angle.min(match frustum.projection {
            Projection::Perspective => (frustum.top - frustum.bottom) / f64::from(size[1]),
            // What is far away is as large as what is near.
            Projection::Orthographic => 0.0,
        });
    }
    Ok(Some(scene.pose_for(time_s, Detail { eyes, angle })?))
}
