//! The bounding volume hierarchy: built by `obvhs`, walked here so that no rounding can lose a hit.
//!
//! `obvhs` builds the binary tree (PLOC, Meister and Bittner 2018, with parallel reinsertion,
//! 2017). Its own traversal compares `f32` boxes without an error margin, which is right for
//! pictures; a judge needs every box test to err on the side of looking inside. The walk below
//! therefore rounds the ray's origin to both sides and widens the interval of each box by the
//! rounding error of its three operations (Ize, "Robust BVH Ray Traversal", JCGT 2013).

use std::ops::Range;
use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;

use crate::triangles::{EDGE_ERROR, round_down, round_up};

/// Bound on the relative error of a slab's distance: rounding of direction, inverse, difference and
/// product, half an ulp each, doubled for safety.
const SLAB_ERROR: f32 = 4.0 * f32::EPSILON;

/// Smallest magnitude of a direction component. Smaller ones are replaced by it, so that the
/// inverse stays finite.
const LEAST_DIRECTION: f64 = 1e-25;

/// Metres by which a ray's origin is blurred to either side, beyond its rounding and one ulp more.
/// The blur is never 0, neither near the origin nor far from it: a flat box that holds an
/// axis-parallel ray is then met, and the error of [`LEAST_DIRECTION`] is covered up to 1e16 m.
const ORIGIN_BLUR: f64 = 1e-9;

/// A binary tree of boxes. Leaves are ranges of the order that [`Tree::build`] returns.
pub(crate) struct Tree {
    nodes: Vec<Bvh2Node>,
}

/// A ray as the box tests see it.
pub(crate) struct BoxRay {
    origin_high: Vec3A,
    origin_low: Vec3A,
    inverse: Vec3A,
    t_min: f32,
}

impl BoxRay {
    pub(crate) fn new(origin: DVec3, direction: DVec3, t_min: f64) -> Self {
        // A ray meets what it passes within the rounding of its own coordinates and of the
        // corners', for which boxes have room.
        let blur = ORIGIN_BLUR + 2.0 * EDGE_ERROR * origin.abs().max_element();
        let each = |f: &dyn Fn(f64) -> f32, v: DVec3| Vec3A::new(f(v.x), f(v.y), f(v.z));
        let inverse = |d: f64| {
            let away_from_zero = if d.abs() < LEAST_DIRECTION { LEAST_DIRECTION.copysign(d) } else { d };
            (1.0 / away_from_zero) as f32
        };
        Self {
            origin_high: each(&|x| round_up(x + blur).next_up(), origin),
            origin_low: each(&|x| round_down(x - blur).next_down(), origin),
            inverse: each(&inverse, direction),
            t_min: round_down(t_min),
        }
    }

    /// Returns the `t` at which the ray enters a box, or infinity if it certainly misses the box
    /// before `t_max`.
    #[inline(always)]
    fn enters(&self, bounds: &Aabb, t_max: f32) -> f32 {
        let a = (bounds.min - self.origin_high) * self.inverse;
        let b = (bounds.max - self.origin_low) * self.inverse;
        let enter = a.min(b).max_element();
        let leave = a.max(b).min_element();
        let enter = enter - SLAB_ERROR * enter.abs();
        let leave = leave + SLAB_ERROR * leave.abs();
        if enter <= leave && leave >= self.t_min && enter <= t_max { enter } else { f32::INFINITY }
    }
}

impl Tree {
    /// Builds the tree and returns it with the order of the boxes in its leaves.
    pub(crate) fn build(boxes: &[Aabb]) -> (Self, Vec<u32>) {
        if boxes.is_empty() {
            return (Self { nodes: Vec::new() }, Vec::new());
        }
        let tree = build_bvh2(boxes, BvhBuildParams::fast_build(), &mut Duration::default());
        let mut nodes = tree.nodes;
        nodes.shrink_to_fit();
        (Self { nodes }, tree.primitive_indices)
    }

    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice())
    }

    /// Visits every leaf that the ray may meet between its own `t_min` and `t_max`, roughly from
    /// near to far. `visit` may lower `t_max`, and ends the walk by returning `false`.
    #[inline(always)]
    pub(crate) fn walk(
        &self,
        ray: &BoxRay,
        t_max: f64,
        stack: &mut Vec<u32>,
        mut visit: impl FnMut(Range<usize>, &mut f64) -> bool,
    ) {
        let Some(root) = self.nodes.first() else { return };
        let mut t_max = t_max;
        let mut t_max_above = round_up(t_max);
        if ray.enters(root.aabb(), t_max_above) == f32::INFINITY {
            return;
        }
        let leaf = |node: &Bvh2Node| node.first_index as usize..(node.first_index + node.prim_count) as usize;
        if root.is_leaf() {
            visit(leaf(root), &mut t_max);
            return;
        }
        stack.clear();
        let mut current = root.first_index;
        loop {
            let [a, b] = &self.nodes[current as usize..current as usize + 2] else { return };
            let (mut near, mut far) = (a, b);
            let mut t_near = ray.enters(a.aabb(), t_max_above);
            let mut t_far = ray.enters(b.aabb(), t_max_above);
            if t_far < t_near {
                std::mem::swap(&mut near, &mut far);
                std::mem::swap(&mut t_near, &mut t_far);
            }
            let mut next = None;
            if t_near < f32::INFINITY {
                if near.is_leaf() {
                    if !visit(leaf(near), &mut t_max) {
                        return;
                    }
                    t_max_above = round_up(t_max);
                } else {
                    next = Some(near.first_index);
                }
            }
            if t_far < f32::INFINITY && t_far <= t_max_above {
                if far.is_leaf() {
                    if !visit(leaf(far), &mut t_max) {
                        return;
                    }
                    t_max_above = round_up(t_max);
                } else if next.is_some() {
                    stack.push(far.first_index);
                } else {
                    next = Some(far.first_index);
                }
            }
            match next.or_else(|| stack.pop()) {
                Some(index) => current = index,
                None => return,
            }
        }
    }
}
