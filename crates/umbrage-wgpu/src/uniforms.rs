//! Conversion of a plan in `f64` world metres to uniforms in `f32` relative to the frame's origin.

use std::borrow::Borrow;
use std::f32::consts::TAU;

use glam::{DMat4, DVec2, DVec3, DVec4};
use umbrage::ShadowPlan;
use umbrage::config::{Filter, LightKind, Selection, ShadowConfig, SplitMetric};
use umbrage_shaders::layout;

use crate::maps::place::Place;
use crate::maps::slot::Slot;
use crate::options::{bias_kind, depth_step, filter_kind, reach_within, selection_kind, transition_kind};
use crate::{Error, FrameOptions, LightMaps, Result, local};

/// The uniform that receivers read: the frames of each light's slot. Their splits are the uniforms
/// of casters. `places` are those of all maps.
pub(crate) fn frames(
    plans: &[impl Borrow<ShadowPlan>],
    config: &ShadowConfig,
    slots: &[Slot],
    places: &[Place],
    options: &FrameOptions,
) -> Result<Vec<layout::Frame>> {
    options.validate()?;
    if plans.len() != slots.len() {
        return Err(Error::LightCount { plans: plans.len(), lights: slots.len() });
    }
    let mut frames = Vec::new();
    for (light, (plan, slot)) in plans.iter().map(Borrow::borrow).zip(slots).enumerate() {
        let given = plan.light.map_or(LightKind::Directional, LightKind::from);
        LightMaps::from(slot.kind).check(light, given)?;
        for face in 0..slot.kind.faces() {
            let first = slot.first_map + face * slot.sizes.len();
            frames.push(match face < plan.faces() {
                true => frame(plan, face, config, slot, &places[first..first + slot.sizes.len()], options)?,
                // A sun in a point light's slot leaves five faces over, which nobody asks.
                false => layout::Frame::default(),
            });
        }
        check_choices(plan, config)?;
    }
    local::number(&mut frames, slots, plans);
    Ok(frames)
}

/// Checks that a sun's plan is made by the choices for which the receivers' text was made, because
/// the text does not check.
fn check_choices(plan: &ShadowPlan, config: &ShadowConfig) -> Result<()> {
    if plan.light.is_some_and(|light| light.position().is_some()) {
        return Ok(());
    }
    let mismatch = |setting, made_for: &str, given: &str| {
        Err(Error::PlanOfOtherConfig { setting, made_for: made_for.to_owned(), given: given.to_owned() })
    };
    let by_map = config.selection == Selection::Map;
    if by_map != (plan.selection == Selection::Map) {
        let word = |by_map| if by_map { "map" } else { "depth" };
        return mismatch("selection", word(by_map), word(!by_map));
    }
    let [made_for, given] = [config.selection.metric(), plan.metric()];
    if made_for != given {
        return mismatch("bands", &made_for.to_string(), &given.to_string());
    }
    let has_warp = plan.splits.iter().any(|split| split.light_position.is_none() && split.warp.is_some());
    if has_warp && config.first_warp().is_none() {
        return mismatch("warp", "none", "a warped map");
    }
    Ok(())
}

/// The uniform of one face of one light. `places` are those of its splits.
fn frame(
    plan: &ShadowPlan,
    face: usize,
    config: &ShadowConfig,
    slot: &Slot,
    places: &[Place],
    options: &FrameOptions,
) -> Result<layout::Frame> {
    check_plan(plan, slot)?;
    let (filter, look) = (&config.filter, &config.look);
    if let Some(width_m) = filter.width_m() {
        let map_m = plan.splits.iter().map(|s| s.texel_m.max_element() * f64::from(s.size)).fold(0.0, f64::max);
        if 0.5 * width_m > map_m {
            return Err(Error::FilterTooWide { width_m, map_m });
        }
    }
    let (sun_degrees, rotated) = match *filter {
        Filter::Pcss { sun_degrees, rotated } => (sun_degrees, rotated),
        Filter::Disc { rotated, .. } => (0.0, rotated),
        _ => (0.0, false),
    };
    let plane = plan.view_depth_plane;
    let mut frame = layout::Frame {
        view_depth_plane: row(plane.truncate(), plane.truncate().dot(options.origin) + plane.w),
        to_light: (-plan.light_direction).as_vec3().to_array(),
        strength: look.strength as f32,
        fade_begin: plan.fade_begin as f32,
        split_count: slot.sizes.len() as u32,
        filter_kind: filter_kind(filter) as u32,
        enabled: options.enabled.into(),
        tint: options.tint.into(),
        filter_width_m: filter.width_m().unwrap_or(0.0) as f32,
        sun_tangent: (0.5 * sun_degrees).to_radians().tan() as f32,
        turn_per_pixel: if rotated { TAU } else { 0.0 },
        transition: transition_kind(config.transition) as u32,
        slice: layout::EVERY_SLICE,
        selection: selection_kind(plan.selection) as u32,
        map_blend: plan.blend as f32,
        bias_kind: bias_kind(look.bias) as u32,
        shadow_colour: look.colour.map(|part| part as f32),
        eye: (plan.eye - options.origin).as_vec3().to_array(),
        is_radial: (plan.metric() == SplitMetric::Distance).into(),
        ..layout::Frame::default()
    };
    local::place_light(&mut frame, plan, options.origin);
    let first = face * slot.sizes.len();
    let splits = plan.splits.iter().enumerate().skip(first);
    for ((uniform, (index, split)), place) in frame.splits.iter_mut().zip(splits).zip(places) {
        *uniform = self::split(index, split, depth_step(config.depth_format), *place, options.origin)?;
        uniform.filter_radius_texels = reach_within(filter, split.filter_radius_texels) as f32;
        uniform.is_linear = (config.depth_format.is_colour() && split.light_position.is_some()).into();
    }
    Ok(frame)
}

/// Checks the values of a plan that belong to no split.
fn check_plan(plan: &ShadowPlan, slot: &Slot) -> Result<()> {
    let all_faces = (0..plan.faces()).flat_map(|_| &slot.sizes);
    if !plan.splits.iter().map(|split| &split.size).eq(all_faces) {
        return Err(Error::PlanMismatch {
            plan: plan.splits.iter().map(|split| split.size).collect(),
            maps: slot.sizes.clone(),
        });
    }
    let bad = |field, value, expected| Err(Error::InvalidPlan { field, value, expected });
    if !plan.view_depth_plane.is_finite() {
        return bad("view_depth_plane", f64::NAN, "four finite numbers");
    }
    if let Some(plane) = plan.planes.iter().find(|plane| !plane.is_finite()) {
        return bad("planes", *plane, "finite view depths");
    }
    if !plan.eye.is_finite() {
        return bad("eye", f64::NAN, "three finite numbers");
    }
    if !is_unit(plan.light_direction) {
        return bad("light_direction", plan.light_direction.length(), "a vector of length 1");
    }
    if !plan.fade_begin.is_finite() {
        return bad("fade_begin", plan.fade_begin, "a finite view depth");
    }
    if !(0.0..=1.0).contains(&plan.blend) {
        return bad("blend", plan.blend, "in 0..=1");
    }
    Ok(())
}

/// The uniform of one split. `depth_step` is the format's step as a share of the depth range.
pub(crate) fn split(
    index: usize,
    split: &umbrage::Split,
    depth_step: f64,
    place: Place,
    origin: DVec3,
) -> Result<layout::Split> {
    check(index, split)?;
    if let Some(at) = split.warp.zip(split.light_position) {
        return local::split(index, split, at, depth_step, place, origin);
    }
    if let Some(shadow_from_world) = split.warp {
        return warped(index, split, shadow_from_world, depth_step, place, origin);
    }
    // The light's plane in texels. What the origin adds (less the fraction of a map that is not
    // stabilised) is split into a fraction, which stays with the row, and whole texels, which join
    // the map's offset: a place before the offset then depends on the point and the origin alone,
    // and offsets are whole numbers (see `from_caster` in shaders/lib/map.wesl).
    let corner = split.min_texel.floor();
    let constant =
        DVec2::new(split.u_axis.dot(origin), split.v_axis.dot(origin)) / split.texel_m - (split.min_texel - corner);
    let whole = constant.floor();
    let fraction = constant - whole;
    let range = split.depth_far - split.depth_near;
    let uniform = layout::Split {
        u_row: row(split.u_axis / split.texel_m.x, fraction.x),
        v_row: row(split.v_axis / split.texel_m.y, fraction.y),
        depth_row: row(split.depth_axis / range, (split.depth_axis.dot(origin) - split.depth_near) / range),
        texel_offset: (whole - corner).as_vec2().to_array(),
        texel_m: split.texel_m.as_vec2().to_array(),
        size: split.size as f32,
        far: split.far as f32,
        blend_begin: split.blend_begin as f32,
        depth_range_m: range as f32,
        depth_step_m: (range * depth_step) as f32,
        is_empty: split.casters.is_empty().into(),
        ..place.into_split()
    };
    Ok(uniform)
}

/// The uniform of one split whose map is warped.
fn warped(
    index: usize,
    split: &umbrage::Split,
    shadow_from_world: DMat4,
    depth_step: f64,
    place: Place,
    origin: DVec3,
) -> Result<layout::Split> {
    let bad = |value, expected| Err(Error::InvalidSplit { split: index, field: "warp", value, expected });
    let matrix = shadow_from_world * DMat4::from_translation(origin);
    let [x, y, z, w] = [0, 1, 2, 3].map(|i| matrix.row(i));
    let largest = w.abs().max_element();
    if !(matrix.is_finite() && largest > 0.0) {
        return bad(f64::NAN, "finite numbers with a fourth row");
    }
    // What a metre along the light adds to depth, where w is 1.
    let depth_per_metre = z.truncate().dot(split.depth_axis) / largest;
    if !(depth_per_metre > 0.0 && depth_per_metre.is_finite()) {
        return bad(depth_per_metre, "a matrix whose depth grows along the light");
    }
    // Any multiple of the matrix is the same map; this one has numbers near 1 to divide by.
    let half = 0.5 * f64::from(split.size) / largest;
    let range = 1.0 / depth_per_metre;
    let row = |row: DVec4| row.as_vec4().to_array();
    Ok(layout::Split {
        u_row: row((w + x) * half),
        v_row: row((w - y) * half),
        depth_row: row(z / largest),
        w_row: row(w / largest),
        texel_m: split.texel_m.as_vec2().to_array(),
        size: split.size as f32,
        far: split.far as f32,
        blend_begin: split.blend_begin as f32,
        depth_range_m: range as f32,
        depth_step_m: (range * depth_step) as f32,
        is_empty: split.casters.is_empty().into(),
        ..place.into_split()
    })
}

/// Checks that every number of the computations above is finite and nothing is divided by zero.
fn check(index: usize, split: &umbrage::Split) -> Result<()> {
    let bad = |field, value, expected| Err(Error::InvalidSplit { split: index, field, value, expected });
    for (field, axis) in [("u_axis", split.u_axis), ("v_axis", split.v_axis), ("depth_axis", split.depth_axis)] {
        if !is_unit(axis) {
            return bad(field, axis.length(), "a vector of length 1");
        }
    }
    if !split.texel_m.is_finite() || split.texel_m.min_element() <= 0.0 {
        return bad("texel_m", split.texel_m.min_element(), "finite metres greater than 0");
    }
    if !split.min_texel.is_finite() {
        return bad("min_texel", f64::NAN, "two finite numbers");
    }
    let range = split.depth_far - split.depth_near;
    if !(range > 0.0 && range.is_finite() && split.depth_near.is_finite()) {
        return bad("depth_far", split.depth_far, "finite and greater than depth_near");
    }
    if !split.near.is_finite() {
        return bad("near", split.near, "a finite view depth");
    }
    if !split.far.is_finite() {
        return bad("far", split.far, "a finite view depth");
    }
    if !(split.filter_radius_texels >= 0.0 && split.filter_radius_texels.is_finite()) {
        return bad("filter_radius_texels", split.filter_radius_texels, "finite texels, 0 or more");
    }
    if !split.blend_begin.is_finite() || split.blend_begin > split.far {
        return bad("blend_begin", split.blend_begin, "a finite view depth no greater than far");
    }
    Ok(())
}

/// Returns whether a vector has length 1; false for NaN.
fn is_unit(axis: DVec3) -> bool {
    (axis.length() - 1.0).abs() < 1e-6
}

fn row(xyz: DVec3, w: f64) -> [f32; 4] {
    xyz.extend(w).as_vec4().to_array()
}

#[cfg(test)]
mod bias_tests;

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};
    use proptest::prelude::*;
    use umbrage::{DirectionalLight, Frustum, View, Warp, WarpTarget};
    use umbrage_shaders::twin;

    use super::{Place, split};
    use crate::maps::place::Viewport;
    use crate::maps::storage::Tile;

    fn alone(size: u32) -> Place {
        let tile = Tile { layer: 0, corner: [0; 2], layer_texels: [size; 2] };
        Place { tile, viewport: Viewport::around(size, 8192) }
    }

    /// A stabilised split of a light, whose map lies near a point.
    pub(super) fn split_near(direction: DVec3, center: DVec3, texel: f64, size: u32) -> umbrage::Split {
        let light = DirectionalLight::new(direction).expect("not zero");
        let (u_axis, v_axis) = light.map_axes();
        let depth_axis = light.direction();
        let at = DVec2::new(u_axis.dot(center), v_axis.dot(center)) / texel;
        let mut split = umbrage::Split::default();
        (split.near, split.far, split.blend_begin, split.coverage) = (1.0, 10.0, 9.0, (1.0, 10.0));
        (split.size, split.texel_m) = (size, DVec2::splat(texel));
        (split.u_axis, split.v_axis, split.depth_axis) = (u_axis, v_axis, depth_axis);
        split.min_texel = (at - 0.5 * f64::from(size)).round();
        (split.depth_near, split.depth_far) = (depth_axis.dot(center) - 50.0, depth_axis.dot(center) + 50.0);
        split.receiver_depths = (split.depth_near, split.depth_far);
        split.filter_radius_texels = 1.5;
        split.casters = 0..1;
        split
    }

    fn unit() -> impl Strategy<Value = DVec3> {
        let random = (-1.0f64..1.0, -1.0f64..1.0, -1.0f64..1.0).prop_map(|(x, y, z)| DVec3::new(x, y, z));
        prop_oneof![4 => random.prop_filter("has a direction", |v| v.length() > 0.1), 1 => Just(DVec3::NEG_Y), 1 => Just(DVec3::X)]
    }

    /// Points up to 100 km from the world's origin.
    fn far_away() -> impl Strategy<Value = DVec3> {
        (prop_oneof![Just(0.0), Just(1e4), Just(1e5)], unit()).prop_map(|(distance, v)| distance * v.normalize())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn uniforms_say_what_the_plan_says(
            direction in unit(),
            center in far_away(),
            offset in unit(),
            texel in prop_oneof![Just(0.005), Just(0.1), Just(3.0)],
            place in unit(),
            stabilised in any::<bool>(),
        ) {
            // The frame's origin lies up to a kilometre from what the map shows.
            let origin = center + 500.0 * offset;
            let mut planned = split_near(direction, center, texel, 1024);
            if !stabilised {
                planned.min_texel += DVec2::new(0.37, -0.81);
            }
            let uniform = split(0, &planned, 0.0, alone(1024), origin).expect("a valid split");
            prop_assert_eq!(uniform.texel_offset.map(f32::fract), [0.0; 2], "whole texels stay whole");
            prop_assert!((0.0..=1.0).contains(&uniform.u_row[3]) && (0.0..=1.0).contains(&uniform.v_row[3]));
            let point = center + 300.0 * texel * place;
            let relative = (point - origin).as_vec3();
            let at = twin::map_from_world(&uniform, relative.to_array());
            let exact = planned.map_from_world(point);
            // A position 1000 m from the origin is known to 6e-5 m, three times over; then 1e5
            // texels to 2^-7 at most.
            let texels = 3.0 * (6e-5 / texel) + 3.0 * (1000.0 / texel) * 2f64.powi(-24) + 1e-3;
            prop_assert!((f64::from(at[0]) - exact.x).abs() < texels, "{at:?} instead of {exact}");
            prop_assert!((f64::from(at[1]) - exact.y).abs() < texels, "{at:?} instead of {exact}");
            prop_assert!((f64::from(at[2]) - exact.z).abs() < 1e-5, "{at:?} instead of {exact}");
        }

        #[test]
        fn warped_uniforms_say_what_the_plan_says(
            center in far_away(),
            offset in unit(),
            warp in prop_oneof![Just(Warp::Psm), Just(Warp::Lispsm), Just(Warp::Tsm { focus: 0.2 })],
            at in (0.0..1.0f64, 0.0..1.0f64, 0.01..1.0f64),
        ) {
            let frustum = Frustum::perspective(1.0, 1.3, 1.0, 200.0).expect("valid");
            let view = View::look_at(center, center + DVec3::new(1.0, -0.2, 0.5), DVec3::Y, frustum).expect("valid");
            let receivers = view.slice_corners(1.0, 200.0);
            let direction = DVec3::new(0.3, -0.8, 0.4).normalize();
            let mut planned = split_near(direction, center, 0.1, 1024);
            planned.warp = warp.shadow_from_world(&WarpTarget {
                view: &view,
                slice: (1.0, 200.0),
                light: direction,
                receivers: &receivers,
                casters: &[],
                margin: 0.01,
            });
            prop_assert!(planned.warp.is_some());
            let origin = center + 500.0 * offset;
            let uniform = split(0, &planned, 0.0, alone(1024), origin).expect("a valid split");
            let depth = 1.0 + 199.0 * at.2;
            let corners = view.slice_corners(depth, depth + 1.0);
            let point = corners[0] + (corners[1] - corners[0]) * at.0 + (corners[2] - corners[0]) * at.1;
            let relative = (point - origin).as_vec3();
            let found = twin::map_from_world(&uniform, relative.to_array());
            let exact = planned.map_from_world(origin + relative.as_dvec3());
            // Sums of terms near 1000 m lose some 1e-4 m, divided by a w of 3 m or more, times 1024
            // texels.
            let [x, y, z] = found.map(f64::from);
            prop_assert!((x - exact.x).abs() < 0.1 && (y - exact.y).abs() < 0.1, "{found:?} instead of {exact}");
            prop_assert!((z - exact.z).abs() < 2e-4, "{found:?} instead of {exact}");
        }

        #[test]
        fn moving_the_map_by_texels_moves_the_offset_alone(
            direction in unit(),
            center in far_away(),
            x in -500i32..500,
            y in -500i32..500,
        ) {
            let planned = split_near(direction, center, 0.1, 512);
            let mut moved = planned.clone();
            moved.min_texel += DVec2::new(x.into(), y.into());
            let uniform = |it| split(0, it, 0.0, alone(512), center.round()).expect("a valid split");
            let (before, mut after) = (uniform(&planned), uniform(&moved));
            prop_assert_eq!(after.texel_offset, [before.texel_offset[0] - x as f32, before.texel_offset[1] - y as f32]);
            after.texel_offset = before.texel_offset;
            prop_assert_eq!(after, before);
        }
    }

    /// \[PCSM\], Listings 4.1.4 and 4.1.5: map coordinates that a vertex shader passes on, and
    /// those that a fragment shader computes from an interpolated position. The source calls the
    /// second wrong; perspective-correct interpolation is exact for both, as both are affine in the
    /// position, and in `f32` they differ by rounding alone.
    #[test]
    fn coordinates_of_vertices_and_of_fragments_agree_to_rounding() {
        let planned = split_near(DVec3::new(0.3, -1.0, 0.4), DVec3::new(20.0, 0.0, -30.0), 0.1, 1024);
        let uniform = split(0, &planned, 0.0, alone(1024), DVec3::ZERO).expect("a valid split");
        // One large triangle of ground under a camera at (0, 5, 20) that looks down -Z: w is the
        // distance along -Z.
        let corners = [DVec3::new(-60.0, 0.0, 15.0), DVec3::new(70.0, 0.0, 15.0), DVec3::new(10.0, 2.0, -400.0)];
        let w = corners.map(|corner| (20.0 - corner.z) as f32);
        let (mut between, mut of_fragments) = (0.0_f64, 0.0_f64);
        for i in 0..200_u32 {
            for j in 0..200 - i {
                let screen = [f64::from(i) / 200.0, f64::from(j) / 200.0].map(|share| share as f32);
                let screen = [screen[0], screen[1], 1.0 - screen[0] - screen[1]];
                let perspective = |values: [f32; 3]| {
                    let over = |k: usize| screen[k] / w[k];
                    (0..3).map(|k| over(k) * values[k]).sum::<f32>() / (0..3).map(over).sum::<f32>()
                };
                let position =
                    [0, 1, 2].map(|axis| perspective([0, 1, 2].map(|k: usize| corners[k].as_vec3().to_array()[axis])));
                let by_fragment = twin::map_from_world(&uniform, position);
                let at_vertices = corners.map(|corner| twin::map_from_world(&uniform, corner.as_vec3().to_array()));
                let by_vertex = [0, 1, 2].map(|axis| perspective([0, 1, 2].map(|k: usize| at_vertices[k][axis])));
                let exact = planned.map_from_world(glam::Vec3::from_array(position).as_dvec3());
                // What counts is where the maps are: those of far vertices are thousands of texels
                // away.
                if exact.truncate().abs().max_element() > 2048.0 {
                    continue;
                }
                for axis in 0..2 {
                    between = between.max(f64::from((by_fragment[axis] - by_vertex[axis]).abs()));
                    of_fragments = of_fragments.max((f64::from(by_fragment[axis]) - exact[axis]).abs());
                }
            }
        }
        eprintln!("fragment against vertex: {between:.6} texels; fragment against f64: {of_fragments:.6} texels");
        assert!(between < 0.01, "the two methods differ by {between} texels");
        assert!(of_fragments < 0.001, "an interpolated position is {of_fragments} texels off");
        // Interpolation that is not perspective-correct would be off by whole shadows: the
        // comparison can say no.
        let flat = |values: [f32; 3]| values.iter().sum::<f32>() / 3.0;
        let shares: Vec<f32> = w.iter().map(|w| 1.0 / w).collect();
        let middle = |k: usize| twin::map_from_world(&uniform, corners[k].as_vec3().to_array())[1];
        let straight = flat([middle(0), middle(1), middle(2)]);
        let right = (0..3).map(|k| shares[k] * middle(k)).sum::<f32>() / shares.iter().sum::<f32>();
        assert!((straight - right).abs() > 100.0, "{straight} and {right}");
    }
}
