//! The scene at one moment, ready to be asked by rays.

use glam::DVec3;
use rayon::prelude::*;
use umbrage::{DirectionalLight, Light};
use umbrage_scene::{Pose, Scene};

use crate::bvh::Tree;
use crate::trace::{Crossing, Ray};
use crate::triangles::{Surface, Triangle, Triangles};
use crate::{Error, Result};

/// Least distance in metres at which a triangle throws a shadow on a point: surfaces lie on each other in real scenes.
const LEAST_OCCLUDER_DISTANCE: f64 = 0.002;

/// The exact geometry of a posed scene. It borrows nothing; build it once per pose and ask as often as needed.
///
/// Around 110 bytes per triangle.
pub struct Truth {
    triangles: Triangles,
    /// In the order of the tree's leaves.
    leaves: Vec<Triangle>,
    tree: Tree,
}

/// The first thing that a primary ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where, in the world.
    pub position: DVec3,
    /// The triangle's geometric unit normal in the world, turned towards the eye.
    pub normal: DVec3,
    /// View depth in metres.
    pub depth: f64,
    /// Index into the pose's objects.
    pub object: u32,
    /// The triangle's number, counted through all objects and primitives without the translucent ones.
    pub triangle: u32,
    /// V*: the surface faces the light and nothing stands between.
    pub lit: bool,
}

impl Truth {
    /// Spreads out the pose's triangles and builds the tree over them. `near_point` is a world point near the cameras that
    /// will be asked for: boxes are most exact around it. Hits are `f64` wherever it lies.
    ///
    /// # Errors
    /// [`Error::InvalidGeometry`] and [`Error::TooManyTriangles`] for a scene that no ray can meet, and
    /// [`Error::InvalidSetting`] for a near point that is not finite.
    pub fn build(scene: &Scene, pose: &Pose, near_point: DVec3) -> Result<Self> {
        if !near_point.is_finite() {
            return Err(Error::setting("near_point", format!("{near_point} is not a point; give finite metres")));
        }
        let triangles = Triangles::gather(scene, pose, near_point)?;
        let (tree, order) = Tree::build(&triangles.boxes(scene, pose)?);
        let leaves = triangles.in_order(scene, pose, &order);
        Ok(Self { triangles, leaves, tree })
    }

    /// How many triangles rays can meet.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.leaves.len()
    }

    /// Bytes held by triangles and tree.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.leaves.as_slice()) + self.tree.bytes()
    }

    /// Hard visibility of world points: 1 if nothing stands between the point and the light, else 0; 0 where the normal is
    /// turned away from the light. `light_travel` is the way the light travels. No triangle is known to be the point's own,
    /// so only distance tells: occluders count beyond τ (see [the crate's page](crate)).
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] if the light has no direction or a point is not finite.
    pub fn visibility_at(&self, points: &[(DVec3, DVec3)], light_travel: DVec3) -> Result<Vec<f32>> {
        self.visibility_under(points, &sun(light_travel)?)
    }

    /// The same under any light. Occluders of a local light count up to the light itself; what its range and cone do not reach is
    /// not shadowed.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] if a point is not finite.
    pub fn visibility_under(&self, points: &[(DVec3, DVec3)], light: &Light) -> Result<Vec<f32>> {
        if let Some(bad) = points.iter().position(|(point, normal)| !(point.is_finite() && normal.is_finite())) {
            return Err(Error::setting("points", format!("point {bad} is not finite; give numbers in metres")));
        }
        Ok(points
            .par_iter()
            .with_min_len(64)
            .map_init(Vec::new, |stack, &(point, normal)| {
                f32::from(u8::from(self.is_lit((point, normal), light, None, stack)))
            })
            .collect())
    }

    /// The first triangle that a primary ray meets with `t` in `[t_min, t_max]`, `origin` in the world. Of two at the same
    /// distance the one with the lower number.
    pub(crate) fn first_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        (t_min, t_max): (f64, f64),
        stack: &mut Vec<u32>,
    ) -> Option<Hit> {
        let ray = Ray::new(origin - self.triangles.origin, direction, t_min, t_max);
        let mut best: Option<(Crossing, &Triangle)> = None;
        self.tree.walk(&ray.boxes, ray.t_max, stack, |range, limit| {
            for triangle in &self.leaves[range] {
                let Some(crossing) = ray.meets(&triangle.corners, *limit) else { continue };
                let later = best.is_some_and(|(b, of)| b.t == crossing.t && of.number < triangle.number);
                if !later && self.is_seen(triangle, &crossing, direction) {
                    *limit = crossing.t;
                    best = Some((crossing, triangle));
                }
            }
            true
        });
        best.map(|(crossing, triangle)| self.hit(origin, direction, &crossing, triangle))
    }

    /// Whether a surface faces the light and nothing stands between.
    pub(crate) fn is_lit(
        &self,
        (point, normal): (DVec3, DVec3),
        light: &Light,
        own: Option<u32>,
        stack: &mut Vec<u32>,
    ) -> bool {
        let to_light = light.to_light(point);
        let distance = light.position().map_or(f64::INFINITY, |position| position.distance(point));
        normal.dot(to_light) > 0.0 && (!light.reaches(point) || self.sees_light(point, to_light, distance, own, stack))
    }

    /// Whether nothing but triangle `own` stands between a world point and a light `distance` metres away, beyond τ.
    pub(crate) fn sees_light(
        &self,
        point: DVec3,
        to_light: DVec3,
        distance: f64,
        own: Option<u32>,
        stack: &mut Vec<u32>,
    ) -> bool {
        let ray = shadow_ray(point, self.triangles.origin, to_light, distance);
        let mut free = true;
        self.tree.walk(&ray.boxes, ray.t_max, stack, |range, _| {
            free = !self.leaves[range].iter().any(|triangle| {
                Some(triangle.number) != own
                    && ray.meets(&triangle.corners, ray.t_max).is_some_and(|at| self.blocks(triangle, &at))
            });
            free
        });
        free
    }

    fn hit(&self, origin: DVec3, direction: DVec3, crossing: &Crossing, triangle: &Triangle) -> Hit {
        let normal = area_normal(triangle).normalize();
        Hit {
            position: origin + direction * crossing.t,
            normal: if normal.dot(direction) > 0.0 { -normal } else { normal },
            depth: crossing.t,
            object: self.surface(triangle).object,
            triangle: triangle.number,
            lit: false,
        }
    }

    fn surface(&self, triangle: &Triangle) -> &Surface {
        &self.triangles.surfaces[triangle.surface as usize]
    }

    /// Whether the eye sees this point of a triangle: not the back of a single-sided one, not where alpha is too low.
    fn is_seen(&self, triangle: &Triangle, crossing: &Crossing, direction: DVec3) -> bool {
        let surface = self.surface(triangle);
        let normal = area_normal(triangle);
        if normal.try_normalize().is_none() {
            return false;
        }
        let from_behind = (normal.dot(direction) > 0.0) != surface.mirrored;
        !(surface.single_sided && from_behind) && self.is_there(surface, triangle, crossing)
    }

    /// Whether this point of a triangle stops light.
    fn blocks(&self, triangle: &Triangle, crossing: &Crossing) -> bool {
        let surface = self.surface(triangle);
        surface.casts && self.is_there(surface, triangle, crossing)
    }

    fn is_there(&self, surface: &Surface, triangle: &Triangle, crossing: &Crossing) -> bool {
        surface.alpha.is_none_or(|test| {
            let triangle = (triangle.number - surface.first) as usize;
            self.triangles.alpha_tests[test as usize].passes(&self.triangles.pictures, triangle, crossing.weights)
        })
    }

    /// The same first hit without the tree: what the tree is tested against.
    #[cfg(test)]
    pub(crate) fn first_hit_by_brute_force(
        &self,
        origin: DVec3,
        direction: DVec3,
        (t_min, t_max): (f64, f64),
    ) -> Option<Hit> {
        let ray = Ray::new(origin - self.triangles.origin, direction, t_min, t_max);
        self.leaves
            .iter()
            .filter_map(|triangle| ray.meets(&triangle.corners, t_max).map(|crossing| (crossing, triangle)))
            .filter(|(crossing, triangle)| self.is_seen(triangle, crossing, direction))
            .min_by(|a, b| a.0.t.partial_cmp(&b.0.t).expect("distances are numbers").then(a.1.number.cmp(&b.1.number)))
            .map(|(crossing, triangle)| self.hit(origin, direction, &crossing, triangle))
    }

    /// The same visibility without the tree.
    #[cfg(test)]
    pub(crate) fn sees_light_by_brute_force(
        &self,
        point: DVec3,
        to_light: DVec3,
        distance: f64,
        own: Option<u32>,
    ) -> bool {
        let ray = shadow_ray(point, self.triangles.origin, to_light, distance);
        !self.leaves.iter().any(|triangle| {
            Some(triangle.number) != own
                && ray.meets(&triangle.corners, ray.t_max).is_some_and(|at| self.blocks(triangle, &at))
        })
    }
}

impl std::fmt::Debug for Truth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Truth").field("triangles", &self.leaves.len()).field("bytes", &self.bytes()).finish()
    }
}

fn shadow_ray(point: DVec3, origin: DVec3, to_light: DVec3, distance: f64) -> Ray {
    Ray::new(point - origin, to_light, least_occluder_distance(point).next_up(), distance)
}

/// Twice the triangle's area along its normal, by the right-hand rule.
fn area_normal(triangle: &Triangle) -> DVec3 {
    let [a, b, c] = triangle.corners;
    (b - a).cross(c - a)
}

/// τ: occluders count beyond max(2 mm, 4 ulp(|p|)), with the ulp of `f32`, in which scenes are stored and drawn.
pub(crate) fn least_occluder_distance(point: DVec3) -> f64 {
    let length = point.length() as f32;
    LEAST_OCCLUDER_DISTANCE.max(4.0 * f64::from(length.next_up() - length))
}

/// A sun whose light travels along `light_travel`.
pub(crate) fn sun(light_travel: DVec3) -> Result<Light> {
    DirectionalLight::new(light_travel).map(Light::from).map_err(|_| {
        Error::setting("sun", format!("{light_travel} is no direction; give the way the light travels, not all zero"))
    })
}
