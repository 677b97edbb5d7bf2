//! `--split-views`: the scene as each split's slice of the camera sees it, and as the light sees it
//! through each split's map.
//!
//! An OpenGL implementation of the GPU Gems chapter (\[PSSM-GL\]) shows the same pictures for each
//! of its splits.

use glam::{DMat4, DVec2};
use umbrage::{Frustum, Projection, Split, View};
use umbrage_render::{Frame, Outputs, Renderer};

use crate::{
    failure::{Failure, Result},
    picture::png,
};

/// Distance in metres of the light's eye in front of a map's near plane. A camera's near plane lies
/// in front of its eye.
const STEP_BACK_M: f64 = 1.0;

/// Draws the pictures of one frame by name. Use a `renderer` that draws nothing else, because each
/// slice is planned as a view of its own.
///
/// # Errors
/// [`Failure::Input`] for a local light, whose maps lie in its perspective; errors of the renderer.
pub fn pictures(renderer: &mut Renderer, frame: &Frame<'_>, splits: &[Split]) -> Result<Vec<(String, Vec<u8>)>> {
    let wanted = Outputs { picture: true, ..Outputs::default() };
    let mut files = Vec::new();
    for (i, split) in splits.iter().enumerate() {
        if split.light_position.is_some() {
            return Err(Failure::input(
                "--split-views shows the maps of a directional light; choose one with --light or --sun",
            ));
        }
        let lens = *frame.view.frustum();
        let views = [
            ("camera", slice(frame.view, split)?, frame.shadows_on),
            ("light", from_light(split, (lens.right - lens.left) / (lens.top - lens.bottom))?, false),
        ];
        for (name, view, shadows_on) in views {
            let frame = Frame { view: &view, shadows_on, ..*frame };
            let picture = renderer.render(&frame, wanted)?.picture;
            let picture = picture.ok_or_else(|| Failure::other("the renderer gave no picture"))?;
            files.push((format!("split{i}.{name}.png"), png(&picture)?));
        }
    }
    Ok(files)
}

/// Returns the camera between a split's planes.
fn slice(view: &View, split: &Split) -> Result<View> {
    let lens = *view.frustum();
    let (near, far) = (split.near.max(lens.near), split.far.min(lens.far));
    Ok(view.with_frustum(Frustum { near, far: if far > near { far } else { near * 1.001 }, ..lens })?)
}

/// Returns the light's view of an unwarped map (for a warped one: of the map without the warp),
/// widened or heightened to this aspect.
fn from_light(split: &Split, aspect: f64) -> Result<View> {
    let size = DVec2::splat(f64::from(split.size)) * split.texel_m;
    let middle = (split.min_texel + 0.5 * f64::from(split.size)) * split.texel_m;
    let eye = split.u_axis * middle.x + split.v_axis * middle.y + split.depth_axis * (split.depth_near - STEP_BACK_M);
    let height = size.y.max(size.x / aspect);
    let half = 0.5 * DVec2::new(height * aspect, height);
    let frustum = Frustum {
        projection: Projection::Orthographic,
        left: -half.x,
        right: half.x,
        bottom: -half.y,
        top: half.y,
        near: STEP_BACK_M,
        far: STEP_BACK_M + split.depth_far - split.depth_near,
    };
    let world_from_light = DMat4::from_cols(
        split.u_axis.extend(0.0),
        (-split.v_axis).extend(0.0),
        (-split.depth_axis).extend(0.0),
        eye.extend(1.0),
    );
    Ok(View::from_world_from_view(world_from_light, frustum)?)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use umbrage::config::{Preset, Stability};
    use umbrage::{Aabb, DirectionalLight, Planner, ShadowConfig};

    use super::*;

    #[test]
    fn the_light_sees_what_its_map_holds() {
        let lens = Frustum::perspective(1.0, 1.5, 0.5, 100.0).expect("valid");
        let view = View::look_at_upright(DVec3::new(3.0, 4.0, 5.0), DVec3::ZERO, lens).expect("valid");
        let light = DirectionalLight::new(DVec3::new(0.4, -1.0, 0.3)).expect("valid");
        let world = [Aabb::new(DVec3::splat(-3.0), DVec3::splat(2.0)), Aabb::new(DVec3::splat(4.0), DVec3::splat(5.0))];
        for stability in [Stability::tight(), Stability::Exact] {
            let settings = ShadowConfig { map_sizes: vec![256; 2], stability, ..Preset::Papers.config() };
            let mut planner = Planner::new(&settings).expect("valid");
            let plan = planner.plan(&view, &light, &world, &world).expect("valid").clone();
            for split in &plan.splits {
                let seen = from_light(split, 4.0 / 3.0).expect("valid");
                // A corner of the map lies on the picture's edge, and the light looks along its
                // travel.
                let texel = DVec2::ZERO + split.min_texel;
                let corner = split.u_axis * (texel.x * split.texel_m.x) + split.v_axis * (texel.y * split.texel_m.y);
                let at = seen.view_from_world_point(corner + split.depth_axis * split.depth_near);
                let frustum = seen.frustum();
                let (x, y) = ((at.x / frustum.right).abs(), (at.y / frustum.top).abs());
                assert!((x.max(y) - 1.0).abs() < 1e-9 && at.x < 0.0 && at.y > 0.0, "{at}");
                assert!((seen.forward() - light.direction()).length() < 1e-9);
                let slice = slice(&view, split).expect("valid");
                assert!(slice.frustum().near >= split.near && slice.frustum().far <= split.far.max(lens.far));
            }
        }
    }
}
