//! Exact visibility of scenes of many objects. Rays need only objects that the views may see, and
//! objects between those and the light.

use glam::{DQuat, DVec3};
use umbrage::{Aabb, Light, View};
use umbrage_scene::{Pose, Scene};
use umbrage_truth::Truth;

use crate::failure::Result;

/// Number of objects up to which all are kept.
const MANY: usize = 4096;

/// Metres by which the visible box is enlarged: more than any rounding of boxes.
const ROOM_M: f64 = 1.0;

/// Builds the ground truth ([`Truth::build`]) for views of one scene, each under its light.
///
/// # Errors
/// Those of [`Truth::build`].
pub fn truth_for(scene: &Scene, pose: &Pose, views: &[(&View, Light)]) -> Result<Truth> {
    let near = views.first().map_or(DVec3::ZERO, |(view, _)| view.eye());
    if pose.objects.len() <= MANY {
        return Ok(Truth::build(scene, pose, near)?);
    }
    let reaches: Vec<Reach> = views.iter().map(|(view, light)| Reach::new(view, light, pose.bounds)).collect();
    let mut kept = pose.clone_without_objects();
    let may_matter = |bounds: &Aabb| reaches.iter().any(|reach| reach.holds(bounds));
    kept.objects.extend(pose.objects.iter().filter(|object| may_matter(&object.bounds)).cloned());
    Ok(Truth::build(scene, &kept, near)?)
}

/// Region of the objects that may be visible in a view, or may shade visible ones: a box along the
/// light's own axes, endless towards the light. A local light has no such box: every object may
/// matter.
struct Reach {
    /// Rotation of the light's direction to −Z, and the box around the visible part of the world.
    of_sun: Option<(DQuat, Aabb)>,
}

impl Reach {
    fn new(view: &View, light: &Light, world: Option<Aabb>) -> Self {
        let (Light::Directional(sun), Some(world)) = (light, world) else { return Self { of_sun: None } };
        let light_from_world = DQuat::from_rotation_arc(sun.direction(), DVec3::NEG_Z);
        let corners = seen_corners(view, world).into_iter().map(|corner| light_from_world * corner);
        let seen = Aabb::from_points(corners);
        let room = DVec3::splat(ROOM_M);
        Self { of_sun: Some((light_from_world, Aabb::new(seen.min - room, seen.max + room))) }
    }

    fn holds(&self, bounds: &Aabb) -> bool {
        let Some((light_from_world, seen)) = &self.of_sun else { return true };
        let own = Aabb::from_points(bounds.corners().map(|corner| *light_from_world * corner));
        let beside =
            own.max.x < seen.min.x || own.min.x > seen.max.x || own.max.y < seen.min.y || own.min.y > seen.max.y;
        // What lies behind all that is seen, as the light goes, is neither seen nor in its way.
        !beside && own.max.z >= seen.min.z
    }
}

/// Returns the corners of the view's frustum, cut at the end of the world's box.
fn seen_corners(view: &View, world: Aabb) -> Vec<DVec3> {
    let frustum = view.frustum();
    let deepest = world.corners().map(|corner| view.view_depth(corner)).into_iter().fold(0.0, f64::max);
    let far = frustum.far.min(deepest).max(frustum.near);
    let mut corners = Vec::with_capacity(8);
    for depth in [frustum.near, far] {
        let scale = frustum.scale_at(depth);
        for x in [frustum.left, frustum.right] {
            for y in [frustum.bottom, frustum.top] {
                corners.push(view.world_from_view_point(DVec3::new(x * scale, y * scale, -depth)));
            }
        }
    }
    corners
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use umbrage::{DirectionalLight, Frustum};
    use umbrage_scene::procedural::{World, WorldOptions};

    use super::*;

    #[test]
    fn rays_say_the_same_without_what_cannot_matter() {
        let options = WorldOptions { trees: Some(6000), ..WorldOptions::default() };
        let scene = World::Forest.build_with(&options, &|_| ()).expect("a small forest");
        let pose = scene.pose(0.0).expect("a pose");
        assert!(pose.objects.len() > MANY);
        let frustum = Frustum::perspective(0.9, 1.0, 0.5, 120.0).expect("a lens");
        let eye = DVec3::new(-20.0, 40.0, 30.0);
        let view = View::look_at_upright(eye, DVec3::new(60.0, 0.0, -60.0), frustum).expect("a view");
        let sun = Light::from(DirectionalLight::new(DVec3::new(-0.5, -0.6, 0.3)).expect("a sun"));
        let few = truth_for(&scene, &pose, &[(&view, sun)]).expect("a truth");
        let all = Truth::build(&scene, &pose, eye).expect("a truth");
        assert!(
            2 * few.triangle_count() < all.triangle_count(),
            "{} of {}",
            few.triangle_count(),
            all.triangle_count()
        );
        let mask = |truth: &Truth| truth.mask_under(&view, &sun, [64, 64], &|_| {}).expect("a mask").to_image();
        assert_eq!(mask(&few), mask(&all));
    }
}
