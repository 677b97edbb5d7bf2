//! The scene at one moment, with a tree of triangles for rays.

use glam::DVec3;
use rayon::prelude::*;
use umbrage::{DirectionalLight, Light};
use umbrage_scene::{Pose, Scene};

use crate::bvh::Tree;
use crate::contact::{Contact, F64_ERROR};
use crate::trace::{Crossing, Ray};
use crate::triangles::{Surface, Triangle, Triangles};
use crate::{Error, Result};

/// Distance by which a shadow ray's start is lifted off its surface, towards the eye, as a share of
/// the numbers that the point is made of. The start then lies in the eye's own part of space,
/// whatever edge or crease the point is on. 2^-40 is some thousand times the rounding of a point in
/// `f64`, and a ten-thousandth of the rounding of a vertex in `f32`.
const LIFT: f64 = 1.0 / (1_u64 << 40) as f64;

/// Ground truth: the exact geometry of a posed scene. It borrows nothing; build it once per pose
/// and query it as often as needed.
///
/// Around 110 bytes per triangle.
pub struct Truth {
    triangles: Triangles,
    /// Triangles in the order of the tree's leaves.
    leaves: Vec<Triangle>,
    tree: Tree,
    contact: Contact,
}

/// Least cosine between the normals of surfaces that can lie on each other: 0.6°, more than
/// rounding turns all but the smallest triangles.
const PARALLEL: f64 = 0.999_95;

/// Distance in lifts behind its start at which a shadow ray begins. Rounding moves crossings by as
/// much where light meets a plane at an angle of a millionth.
const BEHIND: f64 = 1e6;

/// A point on a surface from which shadow rays start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Position relative to [`Triangles::origin`], in metres.
    point: DVec3,
    /// Geometric unit normal, turned towards the eye.
    normal: DVec3,
    /// Unit vector from the point to the eye.
    to_eye: DVec3,
    /// Bound in metres on the numbers that the point is made of. Its rounding follows from it.
    reach: f64,
    /// Number of the triangle that the point lies on, if known.
    own: Option<u32>,
}

/// First hit of a primary ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// World position of the hit, in metres.
    pub position: DVec3,
    /// The triangle's geometric unit normal in the world, turned towards the eye.
    pub normal: DVec3,
    /// View depth in metres.
    pub depth: f64,
    /// Index into the pose's objects.
    pub object: u32,
    /// Number of the triangle, counted through all objects and primitives without the translucent
    /// ones.
    pub triangle: u32,
    /// True if V* is 1: the surface faces the light and nothing stands between.
    pub lit: bool,
}

impl Truth {
    /// Transforms the pose's triangles and builds the tree over them. `near_point` is a world point
    /// near the cameras that will be used: boxes are most exact around it. Hits are in `f64`
    /// wherever it lies.
    ///
    /// # Errors
    /// [`Error::InvalidGeometry`] and [`Error::TooManyTriangles`] for a scene that no ray can meet,
    /// and [`Error::InvalidSetting`] for a near point that is not finite.
    pub fn build(scene: &Scene, pose: &Pose, near_point: DVec3) -> Result<Self> {
        if !near_point.is_finite() {
            return Err(Error::setting("near_point", format!("{near_point} is not a point; give finite metres")));
        }
        let triangles = Triangles::gather(scene, pose, near_point)?;
        let (tree, order) = Tree::build(&triangles.boxes(scene, pose)?);
        let leaves = triangles.in_order(scene, pose, &order);
        let contact = Contact::new(scene, pose);
        Ok(Self { triangles, leaves, tree, contact })
    }

    /// Returns the number of triangles that rays can meet.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.leaves.len()
    }

    /// Returns the bytes of triangles and tree.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.leaves.as_slice()) + self.tree.bytes()
    }

    /// Returns the hard visibility of world points with their normals: 1 if nothing stands between
    /// the point and the light, else 0; 0 where the normal is turned away from the light.
    /// `light_travel` is the direction in which the light travels. No triangle is known as the
    /// point's own and no eye is given: the point is taken as seen along its normal, and surfaces
    /// that it lies on within τ (see [the crate's page](crate)) are its own.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] if the light has no direction or a point is not finite.
    pub fn visibility_at(&self, points: &[(DVec3, DVec3)], light_travel: DVec3) -> Result<Vec<f32>> {
        self.visibility_under(points, &sun(light_travel)?)
    }

    /// Returns the hard visibility of world points with their normals under any light, as
    /// [`Truth::visibility_at`] does for a sun. Occluders of a local light count up to the light
    /// itself. Points outside its range and cone are not shadowed.
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
                f32::from(u8::from(self.is_lit(&self.probed(point, normal), point, light, stack)))
            })
            .collect())
    }

    /// Returns the first triangle that a primary ray meets with `t` in `[t_min, t_max]`; `origin`
    /// is in the world. Of two at the same distance the one with the lower number is returned.
    pub(crate) fn first_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        (t_min, t_max): (f64, f64),
        stack: &mut Vec<u32>,
    ) -> Option<Hit> {
        let ray = Ray::new(origin - self.triangles.origin, direction, t_min, t_max);
        let (crossing, triangle) =
            self.first_of(&ray, stack, |triangle, crossing| self.is_seen(triangle, crossing, direction))?;
        Some(self.hit(origin, direction, &crossing, triangle))
    }

    /// Returns the first surface that stops light on its way from a world point: either side of any
    /// caster's triangle, where its alpha counts. `direction` need not be normalised. Surfaces
    /// farther than `most` metres are ignored. [`Hit::depth`] is metres from the point;
    /// [`Hit::lit`] has no meaning.
    ///
    /// A map's texel stores the depth of the first caster that a ray from its centre along the
    /// light meets.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] if the point is not finite or the direction has none.
    pub fn first_caster(&self, origin: DVec3, direction: DVec3, most: f64) -> Result<Option<Hit>> {
        if !origin.is_finite() {
            return Err(Error::setting("origin", format!("{origin} is not a point; give finite metres")));
        }
        let Some(direction) = direction.try_normalize() else {
            return Err(Error::setting(
                "direction",
                format!("{direction} is not a direction; give finite numbers, not all zero"),
            ));
        };
        let ray = Ray::new(origin - self.triangles.origin, direction, 0.0, most.max(0.0));
        let first = self.first_of(&ray, &mut Vec::new(), |triangle, crossing| self.blocks(triangle, crossing));
        Ok(first.map(|(crossing, triangle)| self.hit(origin, direction, &crossing, triangle)))
    }

    /// Returns the nearest crossing that counts; of two at one distance, that of the lower number.
    fn first_of(
        &self,
        ray: &Ray,
        stack: &mut Vec<u32>,
        counts: impl Fn(&Triangle, &Crossing) -> bool,
    ) -> Option<(Crossing, &Triangle)> {
        let mut best: Option<(Crossing, &Triangle)> = None;
        self.tree.walk(&ray.boxes, ray.t_max, stack, |range, limit| {
            for triangle in &self.leaves[range] {
                let Some(crossing) = ray.meets(&triangle.corners, *limit) else { continue };
                let later = best.is_some_and(|(b, of)| b.t == crossing.t && of.number < triangle.number);
                if !later && counts(triangle, &crossing) {
                    *limit = crossing.t;
                    best = Some((crossing, triangle));
                }
            }
            true
        });
        best
    }

    /// Makes the origin of shadow rays from a world point and its normal, without an eye.
    pub(crate) fn probed(&self, point: DVec3, normal: DVec3) -> Seen {
        let relative = point - self.triangles.origin;
        // The point was rounded in the world, its caller's arithmetic included.
        let reach = relative.length() + point.length() * F64_ERROR / LIFT;
        Seen { point: relative, normal, to_eye: normal.normalize_or_zero(), reach, own: None }
    }

    /// Makes the origin of shadow rays from the hit of a primary ray; `origin` is in the world.
    pub(crate) fn seen(&self, origin: DVec3, direction: DVec3, hit: &Hit) -> Seen {
        // As exact as the ray itself, where the hit's own position is rounded in the world.
        let eye = origin - self.triangles.origin;
        let way = direction * hit.depth;
        let reach = eye.length() + way.length();
        Seen { point: eye + way, normal: hit.normal, to_eye: -direction.normalize(), reach, own: Some(hit.triangle) }
    }

    /// Returns whether a surface faces the light and nothing stands between; `point` is the seen
    /// point in the world.
    pub(crate) fn is_lit(&self, seen: &Seen, point: DVec3, light: &Light, stack: &mut Vec<u32>) -> bool {
        let to_light = light.to_light(point);
        let distance = light.position().map_or(f64::INFINITY, |position| position.distance(point));
        seen.normal.dot(to_light) > 0.0
            && (!light.illuminates(point) || self.sees_light(seen, to_light, distance, stack))
    }

    /// Returns whether nothing stands between a point and a light `distance` metres away.
    /// `to_light` is a unit vector.
    pub(crate) fn sees_light(&self, seen: &Seen, to_light: DVec3, distance: f64, stack: &mut Vec<u32>) -> bool {
        let ray = seen.shadow_ray(to_light, distance);
        let mut free = true;
        self.tree.walk(&ray.boxes, ray.t_max, stack, |range, _| {
            free = !self.leaves[range].iter().any(|triangle| self.is_between(triangle, &ray, seen, to_light));
            free
        });
        free
    }

    /// Returns whether a triangle stops the light on its way to a point.
    fn is_between(&self, triangle: &Triangle, ray: &Ray, seen: &Seen, to_light: DVec3) -> bool {
        if Some(triangle.number) == seen.own {
            return false;
        }
        let Some(crossing) = ray.meets(&triangle.corners, ray.t_max) else { return false };
        self.blocks(triangle, &crossing) && !self.is_own_surface(triangle, &crossing, seen, to_light)
    }

    /// Returns whether a triangle that the shadow ray meets belongs to the surface that the ray
    /// starts from.
    ///
    /// A parallel triangle does if the point lies in its plane, within the precision of the scene's
    /// data: a decal, the other face of a leaf, the neighbour across a seam. Any other does not:
    /// the wall beside a crease stops light however near the crease the point is. Only where
    /// rounding hides on which side of the wall the point lies, light counts as stopped if the wall
    /// lies between light and eye.
    fn is_own_surface(&self, triangle: &Triangle, crossing: &Crossing, seen: &Seen, to_light: DVec3) -> bool {
        let Some(normal) = area_normal(triangle).try_normalize() else { return true };
        let from_plane = (crossing.t * normal.dot(to_light)).abs();
        let rounding = (F64_ERROR + LIFT) * seen.reach;
        if crossing.t < 0.0 && from_plane > rounding {
            // Behind the point.
            return true;
        }
        if normal.dot(seen.normal).abs() < PARALLEL {
            return from_plane <= rounding && normal.dot(seen.to_eye) * normal.dot(to_light) > 0.0;
        }
        let own = seen.own.map(|number| &self.triangles.surfaces[self.triangles.surface_of(number)]);
        let there = self.surface(triangle);
        if from_plane > rounding + self.contact.most(there) + self.contact.most(own.unwrap_or(there)) {
            return false;
        }
        let (there, here) = ((there, &triangle.corners), (own, seen.point));
        from_plane <= rounding + self.contact.tolerance(there, here, normal, self.triangles.origin)
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

    /// Returns whether the eye sees this point of a triangle: not the back of a single-sided one,
    /// and not where alpha is too low.
    fn is_seen(&self, triangle: &Triangle, crossing: &Crossing, direction: DVec3) -> bool {
        let surface = self.surface(triangle);
        let normal = area_normal(triangle);
        if normal.try_normalize().is_none() {
            return false;
        }
        let from_behind = (normal.dot(direction) > 0.0) != surface.mirrored;
        !(surface.single_sided && from_behind) && self.is_there(surface, triangle, crossing)
    }

    /// Returns whether this point of a triangle stops light.
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

    /// Returns the first hit of a ray by testing every triangle: the reference for tests of the
    /// tree.
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

    /// Returns whether a seen point sees the light by testing every triangle: the reference for
    /// tests of the tree.
    #[cfg(test)]
    pub(crate) fn sees_light_by_brute_force(&self, seen: &Seen, to_light: DVec3, distance: f64) -> bool {
        let ray = seen.shadow_ray(to_light, distance);
        !self.leaves.iter().any(|triangle| self.is_between(triangle, &ray, seen, to_light))
    }
}

impl Seen {
    fn shadow_ray(&self, to_light: DVec3, distance: f64) -> Ray {
        // It begins a little behind its start: on a crease whose wall the eye looks along, the
        // start is in the wall itself, and where light runs along that wall too, rounding moves
        // the crossing far.
        let lift = LIFT * self.reach;
        Ray::new(self.point + lift * self.to_eye, to_light, -BEHIND * lift, distance)
    }
}

impl std::fmt::Debug for Truth {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Truth").field("triangles", &self.leaves.len()).field("bytes", &self.bytes()).finish()
    }
}

/// Returns twice the triangle's area along its normal, by the right-hand rule.
fn area_normal(triangle: &Triangle) -> DVec3 {
    let [a, b, c] = triangle.corners;
    (b - a).cross(c - a)
}

/// Makes a sun whose light travels along `light_travel`.
pub(crate) fn sun(light_travel: DVec3) -> Result<Light> {
    DirectionalLight::new(light_travel).map(Light::from).map_err(|_| {
        Error::setting(
            "sun",
            format!("{light_travel} is not a direction; give the way the light travels, not all zero"),
        )
    })
}
