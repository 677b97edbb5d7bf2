//! A split of a plan as a cascade of Bevy's.

use bevy_light::cascade::Cascade;
use bevy_math::Mat4;
use umbrage::Split;
use umbrage::glam::{DMat4, DVec2, DVec3, DVec4};

/// How many times as long as wide a texel may be. Bevy moves receivers along their normal by so
/// many of the longer edges, and that must not lead out of the map along the shorter one. Higher:
/// wider margins in every map. Lower: more maps that are widened.
pub(crate) const MOST_STRETCH: f64 = 4.0;

/// By what Bevy scales a light's normal bias for a texel's diagonal.
const DIAGONAL: f64 = std::f64::consts::SQRT_2;

/// Share of a map's depth that is left free at both ends, for rounding to `f32`.
const DEPTH_ROOM: f64 = 1e-4;

/// How Bevy moves a receiver before it looks up a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ReceiverOffset {
    /// Along the surface's normal, in texels of the longer edge.
    pub normal_texels: f64,
    /// Towards the light, metres.
    pub depth_m: f64,
}

impl ReceiverOffset {
    pub fn of(light: &bevy_light::DirectionalLight) -> Self {
        let normal_texels = DIAGONAL * f64::from(light.shadow_normal_bias.abs());
        Self { normal_texels, depth_m: f64::from(light.shadow_depth_bias.abs()) }
    }
}

/// The cascade that draws and samples the map of a split, reversed depth: 1 nearest to the light.
pub(crate) fn cascade(split: &Split, offset: ReceiverOffset) -> Cascade {
    let (texel, min_texel) = widened(split);
    let half = 0.5 * f64::from(split.size);
    let room =
        offset.normal_texels * texel.max_element() + offset.depth_m + DEPTH_ROOM * (split.depth_far - split.depth_near);
    let (near, far) = (split.depth_near - room, split.depth_far + room);
    let (right, up, back) = (split.u_axis, -split.v_axis, -split.depth_axis);
    // The middle of the map, in metres along right, up and back, on the near plane.
    let middle = (min_texel + half) * texel;
    let middle = DVec3::new(middle.x, -middle.y, -near);
    let rows = [right.extend(-middle.x), up.extend(-middle.y), back.extend(-middle.z), DVec4::W];
    let cascade_from_world = DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose();
    let origin = right * middle.x + up * middle.y + back * middle.z;
    let world_from_cascade = DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), origin.extend(1.0));
    let scale = 1.0 / (half * texel);
    let clip_from_cascade = DMat4::from_cols(
        scale.x * DVec4::X,
        scale.y * DVec4::Y,
        DVec4::Z / (far - near),
        DVec4::new(0.0, 0.0, 1.0, 1.0),
    );
    Cascade {
        world_from_cascade: narrowed(&world_from_cascade),
        clip_from_cascade: narrowed(&clip_from_cascade),
        clip_from_world: narrowed(&(clip_from_cascade * cascade_from_world)),
        texel_size: texel.max_element() as f32,
    }
}

/// Texels in metres and the map's corner in texels, with the shorter edge of a texel at least
/// 1 / [`MOST_STRETCH`] of the longer. A widened map stands on whole texels of its own.
fn widened(split: &Split) -> (DVec2, DVec2) {
    let least = split.texel_m.max_element() / MOST_STRETCH;
    let half = 0.5 * f64::from(split.size);
    let texel = split.texel_m.max(DVec2::splat(least));
    let middle = (split.min_texel + half) * split.texel_m;
    let corner = (middle / texel - half).floor();
    let is_wide = split.texel_m.cmpge(DVec2::splat(least));
    (texel, DVec2::select(is_wide, split.min_texel, corner))
}

fn narrowed(matrix: &DMat4) -> Mat4 {
    Mat4::from_cols_array(&matrix.to_cols_array().map(|entry| entry as f32))
}

#[cfg(test)]
mod tests {
    use bevy_math::Vec3;

    use super::*;

    fn split(texel_m: DVec2) -> Split {
        let depth_axis = DVec3::new(0.4, -0.8, 0.3).normalize();
        let u_axis = depth_axis.cross(DVec3::Y).normalize();
        let mut split = Split::default();
        (split.near, split.far, split.blend_begin, split.coverage) = (1.0, 30.0, 27.0, (0.9, 30.0));
        (split.size, split.texel_m) = (1024, texel_m);
        (split.u_axis, split.v_axis, split.depth_axis) = (u_axis, depth_axis.cross(u_axis), depth_axis);
        split.min_texel = DVec2::new(-700.0, 213.0);
        (split.depth_near, split.depth_far, split.receiver_depths) = (-12.0, 40.0, (-10.0, 38.0));
        split.filter_radius_texels = 3.0;
        split
    }

    const OFFSET: ReceiverOffset = ReceiverOffset { normal_texels: 2.5, depth_m: 0.02 };

    /// The world point at a place of the map.
    fn point(split: &Split, texel: DVec2, depth: f64) -> DVec3 {
        let at = (split.min_texel + texel) * split.texel_m;
        let depth = split.depth_near + depth * (split.depth_far - split.depth_near);
        at.x * split.u_axis + at.y * split.v_axis + depth * split.depth_axis
    }

    fn narrow(point: DVec3) -> Vec3 {
        Vec3::from_array(point.to_array().map(|metres| metres as f32))
    }

    #[test]
    fn texels_lie_where_the_plan_says() {
        let split = split(DVec2::new(0.03, 0.05));
        let made = cascade(&split, OFFSET);
        for (u, v) in [(0.0, 0.0), (1024.0, 0.0), (37.0, 900.0), (512.0, 512.0)] {
            for depth in [0.0, 0.3, 1.0] {
                let at = made.clip_from_world.project_point3(narrow(point(&split, DVec2::new(u, v), depth)));
                let texel = (at.truncate() * bevy_math::Vec2::new(0.5, -0.5) + 0.5) * 1024.0;
                assert!(texel.distance(bevy_math::Vec2::new(u as f32, v as f32)) < 0.01, "{texel} {u} {v}");
                assert!((0.0..1.0).contains(&at.z), "{}", at.z);
                let expected = (split.depth_far - split.depth_near) as f32;
                assert!((at.z - (1.0 - depth as f32)).abs() < 0.5 / expected);
            }
        }
        assert_eq!(made.texel_size, 0.05);
    }

    #[test]
    fn both_ways_into_the_map_are_one() {
        let map = split(DVec2::new(0.03, 0.05));
        let made = cascade(&map, OFFSET);
        let product = made.clip_from_cascade * made.world_from_cascade.inverse();
        assert!((made.world_from_cascade.determinant() - 1.0).abs() < 1e-5, "it mirrors");
        let other = cascade(&split(DVec2::new(0.03, 0.051)), OFFSET);
        for texel in [DVec2::ZERO, DVec2::new(1024.0, 300.0)] {
            let at = narrow(point(&map, texel, 0.2));
            let [one, two, wrong] =
                [product, made.clip_from_world, other.clip_from_world].map(|m| m.project_point3(at));
            assert!(one.distance(two) < 1e-4, "{one} {two}");
            assert!(one.distance(wrong) > 1e-3, "the comparison sees 2 %");
        }
    }

    #[test]
    fn receivers_stay_inside_though_they_are_moved() {
        let split = split(DVec2::new(0.03, 0.05));
        let made = cascade(&split, OFFSET);
        let moved = 2.5 * 0.05 + 0.02;
        for depth in [0.0, 1.0] {
            for side in [-1.0, 1.0] {
                let at = point(&split, DVec2::splat(500.0), depth) + side * moved * split.depth_axis;
                let z = made.clip_from_world.project_point3(narrow(at)).z;
                assert!((0.0..=1.0).contains(&z), "{z}");
            }
        }
    }

    #[test]
    fn long_texels_are_widened_around_the_middle_on_a_grid_of_their_own() {
        let split = split(DVec2::new(0.01, 0.1));
        let made = cascade(&split, OFFSET);
        for (u, v) in [(1.0, 1.0), (1023.0, 1023.0), (512.0, 4.0)] {
            let at = made.clip_from_world.project_point3(narrow(point(&split, DVec2::new(u, v), 0.5)));
            assert!(at.x.abs() < 0.41 && at.y.abs() < 1.0, "{at}");
        }
        let corner = widened(&split).1;
        assert_eq!(corner.fract(), DVec2::ZERO);
        // Moving the map by whole texels of the plan moves it by whole texels of its own.
        let mut moved = split.clone();
        moved.min_texel.x += 5.0;
        assert_eq!(widened(&moved).1.fract(), DVec2::ZERO);
        assert_eq!(widened(&moved).0, widened(&split).0);
    }
}
