//! Local lights: the uniforms of their maps, and the list of frames that several lights share.

use std::borrow::Borrow;

use glam::{DMat4, DVec3, DVec4};
use umbrage::{Light, ShadowPlan};
use umbrage_shaders::layout;

use crate::maps::place::Place;
use crate::maps::slot::Slot;
use crate::{Error, Result};

/// Cosine of a light without a cone.
const NO_CONE: f32 = -2.0;

/// Uniform of one split of a local light. Its matrix is taken apart: w is metres along the axis,
/// and depth `A − B/w` keeps its two numbers apart, because `(A w − B)/w` in `f32` would lose
/// precision with every metre from the origin, and A alone does not.
pub(crate) fn split(
    index: usize,
    split: &umbrage::Split,
    (shadow_from_world, light_position): (DMat4, DVec3),
    depth_step: f64,
    place: Place,
    origin: DVec3,
) -> Result<layout::Split> {
    let bad = |field, value, expected| Err(Error::InvalidSplit { split: index, field, value, expected });
    let matrix = shadow_from_world * DMat4::from_translation(origin);
    let [x, y, w] = [0, 1, 3].map(|i| matrix.row(i));
    let length = w.truncate().length();
    if !(matrix.is_finite() && length > 0.0) {
        return bad("warp", f64::NAN, "finite numbers with a fourth row");
    }
    let at_light = split.depth_axis.dot(light_position);
    let (near, far) = (split.depth_near - at_light, split.depth_far - at_light);
    if near.is_nan() || near <= 0.0 {
        return bad("depth_near", near, "greater than 0 from the light on");
    }
    let half = 0.5 * f64::from(split.size) / length;
    let row = |row: DVec4| row.as_vec4().to_array();
    Ok(layout::Split {
        u_row: row((w + x) * half),
        v_row: row((w - y) * half),
        depth_row: [0.0, 0.0, 0.0, (-near * far / (far - near)) as f32],
        w_row: row(w / length),
        depth_offset: (far / (far - near)) as f32,
        texel_m: split.texel_m.as_vec2().to_array(),
        size: split.size as f32,
        far: split.far as f32,
        blend_begin: split.blend_begin as f32,
        depth_range_m: 1.0,
        depth_step_m: depth_step as f32,
        is_empty: split.casters.is_empty().into(),
        ..place.into_split()
    })
}

/// Writes the position, range and cone of a frame's light.
pub(crate) fn place_light(frame: &mut layout::Frame, plan: &ShadowPlan, origin: DVec3) {
    frame.cone_cosine = NO_CONE;
    let Some((light, position)) = plan.light.and_then(|light| Some((light, light.position()?))) else { return };
    frame.light_position = (position - origin).as_vec3().to_array();
    frame.light_range_m = light.range() as f32;
    if let Light::Spot(spot) = light {
        frame.cone_cosine = spot.outer_angle().cos() as f32;
    }
}

/// Numbers the frames of several lights, so that a shader finds the frames of each light.
pub(crate) fn number(frames: &mut [layout::Frame], slots: &[Slot], plans: &[impl Borrow<ShadowPlan>]) {
    for (light, (slot, plan)) in slots.iter().zip(plans).enumerate() {
        let first = slot.first_frame;
        frames[light].first_frame = first as u32;
        let own = frames[first..first + slot.kind.faces()].iter_mut();
        own.for_each(|frame| frame.face_count = plan.borrow().faces() as u32);
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;
    use umbrage::config::{Preset, Stability};
    use umbrage::{Aabb, Frustum, Light, Planner, PointLight, ShadowConfig, SpotLight, View};
    use umbrage_shaders::twin;

    use crate::maps::place::{Place, Viewport};
    use crate::maps::storage::Tile;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn uniforms_say_what_the_plan_says(
            far_away in prop_oneof![Just(0.0), Just(1e5)],
            offset in (-400.0..400.0f64, -50.0..50.0f64, -400.0..400.0f64),
            at in (0.2..1.0f64, -0.9..0.9f64, -0.9..0.9f64),
            is_point in any::<bool>(),
            stability in prop_oneof![Just(Stability::tight()), Just(Stability::Exact)],
        ) {
            let center = DVec3::new(far_away, 3.0, -0.3 * far_away);
            let ground = [Aabb::new(center + DVec3::new(-20.0, -5.0, -20.0), center + DVec3::new(20.0, -4.0, 20.0))];
            let posts: Vec<Aabb> = (0..9).map(|i| {
                let at = center + DVec3::new(f64::from(i % 3) * 5.0 - 5.0, -4.0, f64::from(i / 3) * 5.0 - 5.0);
                Aabb::new(at, at + DVec3::new(0.3, 2.0, 0.3))
            }).collect();
            let light: Light = if is_point {
                PointLight::new(center, 15.0).expect("valid").into()
            } else {
                SpotLight::new(center, DVec3::new(0.2, -1.0, 0.1), 1.0, 15.0).expect("valid").into()
            };
            let lens = Frustum::perspective(1.0, 1.3, 0.5, 100.0).expect("valid");
            let view = View::look_at_upright(center + DVec3::new(0.0, 2.0, 15.0), center - DVec3::Y * 3.0, lens).expect("valid");
            let settings = ShadowConfig { map_sizes: vec![1024; 2], stability, ..Preset::Papers.config() };
            let mut planner = Planner::new(&settings).expect("valid");
            let plan = planner.plan(&view, &light, &posts, &ground).expect("valid");
            // The frame's origin lies up to half a kilometre from the light.
            let origin = center + DVec3::from(offset);
            let tile = Tile { layer: 0, corner: [0; 2], layer_texels: [1024; 2] };
            let place = Place { tile, viewport: Viewport::around(1024, 8192) };
            for planned in &plan.splits {
                let matrix = planned.warp.expect("a local light's map");
                let uniform = super::split(0, planned, (matrix, center), 0.0, place, origin).expect("a valid split");
                let axis = planned.depth_axis;
                let depth = 15.0 * at.0;
                let point = center + depth * (axis + at.1 * planned.u_axis + at.2 * planned.v_axis);
                let relative = (point - origin).as_vec3();
                let found = twin::map_from_world(&uniform, relative.to_array()).map(f64::from);
                let exact = planned.map_from_world(origin + relative.as_dvec3());
                // Sums of terms near 400 m lose some 1e-4 m, over a texel of so many metres here;
                // twice for w.
                let texel = planned.texel_size_m(point).min_element();
                let texels = 3e-4 * (1.0 + exact.truncate().length() / 1024.0) / texel + 1e-3;
                prop_assert!((found[0] - exact.x).abs() < texels && (found[1] - exact.y).abs() < texels, "{found:?} instead of {exact}");
                let near = planned.depth_near - axis.dot(center);
                prop_assert!((found[2] - exact.z).abs() < 1e-6 + 3e-4 * near / (depth * depth), "{found:?} instead of {exact}");
            }
        }
    }
}
