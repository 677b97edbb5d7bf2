//! From a plan in `f64` world metres to the uniforms in `f32` relative to the frame's origin.

use glam::{DVec2, DVec3};
use umbrage::ShadowPlan;
use umbrage_shaders::layout;

use crate::{Error, FrameOptions, Result, ShadowMapsOptions};

/// The square of texels that clip space covers when a split is drawn: the map and a guard band around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Viewport {
    /// Edge in texels.
    pub edge: u32,
    /// Texels from its left and upper edge to the map's.
    pub guard: u32,
}

impl Viewport {
    /// The widest guard band worth having, as a multiple of the map. Ours: a triangle that reaches from the map past one and a
    /// half maps more is clipped, and its edges may then move by 1/512 texel between frames. A power of two, so that the step
    /// from texels to clip space stays exact.
    const WIDEST: u32 = 4;

    /// For a map of `size` texels. `largest` is the device's limit for viewports: its `max_texture_dimension_2d`, or 0 where they
    /// may not be larger than what is drawn to.
    pub fn around(size: u32, largest: u32) -> Self {
        let mut edge = size;
        while edge < Self::WIDEST * size && 2 * u64::from(edge) <= u64::from(largest) {
            edge *= 2;
        }
        Self { edge, guard: (edge - size) / 2 }
    }
}

/// The uniform that receivers read; its splits are what casters read. `map_edge` is the edge of a layer in texels, `viewports`
/// are those of the splits.
pub(crate) fn frame(
    plan: &ShadowPlan,
    maps: &ShadowMapsOptions,
    map_edge: u32,
    viewports: &[Viewport],
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
    for (index, ((uniform, split), viewport)) in frame.splits.iter_mut().zip(&plan.splits).zip(viewports).enumerate() {
        *uniform = self::split(index, split, maps.depth_format.step(), *viewport, options.origin)?;
    }
    Ok(frame)
}

/// One split. `depth_step` is the format's step as a share of the depth range.
fn split(
    index: usize,
    split: &umbrage::Split,
    depth_step: f64,
    viewport: Viewport,
    origin: DVec3,
) -> Result<layout::Split> {
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
        viewport_texels: viewport.edge as f32,
        guard_texels: viewport.guard as f32,
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
