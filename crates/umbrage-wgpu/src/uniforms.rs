//! From a plan in `f64` world metres to the uniforms in `f32` relative to the frame's origin.

use glam::{DVec2, DVec3};
use umbrage::ShadowPlan;
use umbrage_shaders::layout;

use crate::{Error, FrameOptions, Result, ShadowMapsOptions};

/// The uniform that receivers read; its splits are what casters read. `map_edge` is the edge of a layer in texels.
pub(crate) fn frame(
    plan: &ShadowPlan,
    maps: &ShadowMapsOptions,
    map_edge: u32,
    options: &FrameOptions,
) -> Result<layout::Frame> {
    options.validate()?;
    if !plan.splits.iter().map(|split| &split.size).eq(&maps.map_sizes) {
        return Err(Error::PlanMismatch {
            plan: plan.splits.iter().map(|split| split.size).collect(),
            maps: maps.map_sizes.clone(),
        });
    }
    let bad = |field, value, expected| Err(Error::InvalidPlan { field, value, expected });
    let plane = plan.view_depth_plane;
    if !plane.is_finite() {
        return bad("view_depth_plane", f64::NAN, "four finite numbers");
    }
    let length = plan.light_direction.length();
    if !((length - 1.0).abs() < 1e-6) {
        return bad("light_direction", length, "a vector of length 1");
    }
    if !plan.fade_begin.is_finite() {
        return bad("fade_begin", plan.fade_begin, "a finite view depth");
    }

    let mut frame = layout::Frame {
        view_depth_plane: row(plane.truncate(), plane.truncate().dot(options.origin) + plane.w),
        to_light: (-plan.light_direction).as_vec3().to_array(),
        strength: options.strength,
        fade_begin: plan.fade_begin as f32,
        map_edge: map_edge as f32,
        split_count: plan.splits.len() as u32,
        filter_kind: maps.filter.kind() as u32,
        enabled: options.enabled.into(),
        tint: options.tint.into(),
        ..layout::Frame::default()
    };
    for (index, (uniform, split)) in frame.splits.iter_mut().zip(&plan.splits).enumerate() {
        *uniform = self::split(index, split, maps.depth_format.step(), options.origin)?;
    }
    Ok(frame)
}

/// One split. `depth_step` is the format's step as a share of the depth range.
fn split(index: usize, split: &umbrage::Split, depth_step: f64, origin: DVec3) -> Result<layout::Split> {
    check(index, split)?;
    // The light's plane in texels. What the origin adds is split into a fraction, which stays with the row, and whole texels,
    // which join the map's own offset: a caster's place before the offset then depends on the point and the origin alone, and
    // the offset of a stabilised map is a whole number (see `from_caster` in shaders/lib/map.wesl).
    let of_origin = DVec2::new(split.u_axis.dot(origin), split.v_axis.dot(origin)) / split.texel_m;
    let whole = of_origin.floor();
    let fraction = of_origin - whole;
    let range = split.depth_far - split.depth_near;
    let uniform = layout::Split {
        u_row: row(split.u_axis / split.texel_m.x, fraction.x),
        v_row: row(split.v_axis / split.texel_m.y, fraction.y),
        depth_row: row(split.depth_axis / range, (split.depth_axis.dot(origin) - split.depth_near) / range),
        texel_offset: (whole - split.min_texel).as_vec2().to_array(),
        texel_m: split.texel_m.as_vec2().to_array(),
        size: split.size as f32,
        far: split.far as f32,
        blend_begin: split.blend_begin as f32,
        depth_range_m: range as f32,
        depth_step_m: (range * depth_step) as f32,
        is_empty: split.casters.is_empty().into(),
        ..layout::Split::default()
    };
    Ok(uniform)
}

/// What the arithmetic above needs: every number finite and nothing divided by zero.
fn check(index: usize, split: &umbrage::Split) -> Result<()> {
    let bad = |field, value, expected| Err(Error::InvalidSplit { split: index, field, value, expected });
    for (field, axis) in [("u_axis", split.u_axis), ("v_axis", split.v_axis), ("depth_axis", split.depth_axis)] {
        if !((axis.length() - 1.0).abs() < 1e-6) {
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
    if !split.far.is_finite() {
        return bad("far", split.far, "a finite view depth");
    }
    if !(split.blend_begin <= split.far) || !split.blend_begin.is_finite() {
        return bad("blend_begin", split.blend_begin, "a finite view depth no greater than far");
    }
    Ok(())
}

fn row(xyz: DVec3, w: f64) -> [f32; 4] {
    xyz.extend(w).as_vec4().to_array()
}
