//! The planner's bias, for engines with other shaders, against the bias of the WGSL.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use umbrage::config::{Preset, Stability};
use umbrage::{
    Aabb, Bias, DirectionalLight, Frustum, Light, Planner, STEEPEST, ShadowConfig, ShadowPlan, Split, SpotLight, View,
    Warp,
};
use umbrage_shaders::twin::bias::{Receiver, SNAP_TEXELS, TEXEL_BIAS, receiver};

use crate::maps::place::{Place, Viewport};
use crate::maps::storage::Tile;

/// A receiver, and a tap beside it.
#[derive(Clone, Debug)]
struct Lookup {
    plan: ShadowPlan,
    view: View,
    /// Index of the split, and shares of its slice of the view.
    split: usize,
    at: [f64; 3],
    normal: DVec3,
    /// Texels from the receiver to the tap.
    offset: DVec2,
    /// Texels that the filter reads along u and v.
    reach: DVec2,
    /// Distance of the tap behind the edge of shade, in texels.
    gap: f64,
}

/// Both forms of the bias for a lookup.
struct Asked {
    bias: Bias,
    receiver: Receiver,
    /// Tangent of the angle between light and normal, at most [`STEEPEST`].
    tangent: f64,
}

fn view() -> View {
    let frustum = Frustum::perspective(1.0, 1.3, 1.0, 80.0).expect("valid");
    View::look_at_upright(DVec3::new(2.0, 6.0, 20.0), DVec3::ZERO, frustum).expect("valid")
}

fn plan(view: &View, light: Light, stability: Stability) -> ShadowPlan {
    let config = ShadowConfig { map_sizes: vec![1024; 3], stability, ..Preset::Papers.config() };
    let ground = [Aabb::new(DVec3::new(-40.0, -1.0, -40.0), DVec3::new(40.0, 12.0, 40.0))];
    let mut planner = Planner::new(&config).expect("valid");
    planner.plan(view, &light, &ground, &ground).expect("a plan").clone()
}

fn lookups() -> impl Strategy<Value = Lookup> {
    let direction = (-1.0..1.0f64, -1.0..-0.1f64, -1.0..1.0f64).prop_map(DVec3::from);
    let normal = (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64).prop_map(DVec3::from);
    let kind = prop_oneof![
        2 => Just(Some(Stability::Exact)),
        2 => Just(Some(Stability::tight())),
        1 => Just(Some(Stability::Tight { warps: vec![Warp::Tsm { focus: 0.3 }] })),
        1 => Just(Some(Stability::Tight { warps: vec![Warp::Lispsm] })),
        2 => Just(None),
    ];
    let texels = |most: f64| (-most..most, -most..most).prop_map(DVec2::from);
    let gap = (0.02..0.5f64, any::<bool>()).prop_map(|(gap, behind)| if behind { gap } else { -gap });
    let at = [0.05..0.95f64, 0.05..0.95, 0.05..0.95];
    (direction, normal, kind, 0..3_usize, at, texels(4.0), texels(3.0), gap).prop_filter_map(
        "the light shines on the point",
        |(direction, normal, kind, split, at, offset, reach, gap)| {
            let view = view();
            let (light, stability) = match kind {
                Some(stability) => (DirectionalLight::new(direction).expect("valid").into(), stability),
                None => {
                    let spot = SpotLight::new(-20.0 * direction.normalize(), direction, 1.0, 60.0).expect("valid");
                    (spot.into(), Stability::tight())
                }
            };
            let plan = plan(&view, light, stability);
            let normal = normal.try_normalize()?;
            let lookup = Lookup { plan, view, split, at, normal, offset, reach: reach.abs(), gap };
            let travel = lookup.split().light_direction_at(lookup.point());
            let in_map = lookup.split().map_from_world(lookup.point());
            let is_inside = (in_map.truncate() - 512.0).abs().max_element() < 512.0 && (0.0..1.0).contains(&in_map.z);
            (is_inside && normal.dot(travel) < -1e-3).then_some(lookup)
        },
    )
}

impl Lookup {
    fn split(&self) -> &Split {
        &self.plan.splits[self.split]
    }

    fn point(&self) -> DVec3 {
        let corners = self.view.slice_corners(self.split().near, self.split().far);
        let [right, up, away] = self.at;
        let across = |first: usize| {
            let [a, b, c] = [corners[first], corners[first + 1], corners[first + 2]];
            a + (b - a) * right + (c - a) * up
        };
        across(0).lerp(across(4), away)
    }

    fn ask(&self) -> Asked {
        let (split, point) = (self.split(), self.point());
        let tile = Tile { layer: 0, corner: [0; 2], layer_texels: [split.size; 2] };
        let place = Place { tile, viewport: Viewport::around(split.size, 8192) };
        let origin = self.view.eye().round();
        let uniform = super::split(self.split, split, 0.0, place, origin).expect("a valid split");
        let travel = split.light_direction_at(point);
        let [point_f32, normal, to_light] = [point - origin, self.normal, -travel].map(|it| it.as_vec3().to_array());
        let facing = -self.normal.dot(travel);
        let sine = (1.0 - facing * facing).sqrt();
        let tangent = sine / facing.max(sine / STEEPEST);
        Asked {
            bias: split.bias_at(point, self.normal),
            receiver: receiver(&uniform, point_f32, normal, to_light),
            tangent,
        }
    }
}

/// True if both forms of the bias decide alike about a tap that lies `gap` metres behind the edge
/// of shade by the planner's rule. The WGSL's constant is larger by `more` metres. The tap's
/// surface faces the light.
fn agree(bias: &Bias, receiver: &Receiver, depth: f32, more: f64, offset: DVec2, gap: f64) -> bool {
    let rise = bias.depth_per_texel.dot(offset) - (bias.corner_per_texel * offset).length();
    let edge_m = rise.min(0.0) - bias.constant_m - more;
    let offset = offset.as_vec2().to_array();
    let level = depth + receiver.tilt[0] * offset[0] + receiver.tilt[1] * offset[1];
    let stored = (f64::from(level) + (edge_m + gap) / f64::from(receiver.range_m)) as f32;
    // No map stores such a depth.
    if !(0.0..=1.0).contains(&stored) {
        return true;
    }
    let beyond = [0, 1].map(|axis| stored + receiver.tilt[axis] * offset[axis].signum());
    receiver.is_shaded(offset, stored, beyond) == (gap < 0.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn the_planners_bias_decides_as_the_shaders(lookup in lookups()) {
        let Asked { bias, receiver, tangent } = lookup.ask();
        let longer = f64::from(receiver.texel_m[0].max(receiver.texel_m[1]));
        let range = f64::from(receiver.range_m);
        // The WGSL adds to the constant for the grid that casters are snapped to, and for rounding
        // in f32.
        let more = f64::from(receiver.tolerance.constant) * range - f64::from(TEXEL_BIAS) * longer;
        let own = f64::from(SNAP_TEXELS) * tangent * longer + f64::from(receiver.tolerance.rounding) * range;
        prop_assert!((more - own).abs() < 1e-3 * longer, "{more} m instead of {own} m");
        prop_assert!((longer - lookup.split().texel_size_m(lookup.point()).max_element()).abs() < 1e-4 * longer);
        let depth = receiver.depth + receiver.tolerance.constant;
        // Steep surfaces have a bias of metres, of which f32 knows a thousandth.
        let gap = |bias: &Bias| lookup.gap.signum() * (lookup.gap.abs() * longer).max(0.01 * bias.constant_m);
        prop_assert!(agree(&bias, &receiver, depth, more, lookup.offset, gap(&bias)), "{bias:?} {receiver:?}");
        let (flat, flat_twin) =
            (bias.without_plane(lookup.reach), receiver.without_plane(lookup.reach.as_vec2().to_array()));
        prop_assert!(agree(&flat, &flat_twin, depth, more, lookup.offset, gap(&flat)), "{flat:?} {flat_twin:?}");
    }
}

/// A bias that differs by a tenth decides otherwise about some tap.
#[test]
fn another_bias_is_told_from_the_shaders() {
    let view = view();
    let light = DirectionalLight::new(DVec3::new(0.4, -1.0, 0.2)).expect("valid").into();
    let plan = plan(&view, light, Stability::Exact);
    let lookup = Lookup {
        plan,
        view,
        split: 1,
        at: [0.5; 3],
        normal: DVec3::new(0.5, 1.0, 0.3).normalize(),
        offset: DVec2::ZERO,
        reach: DVec2::ZERO,
        gap: 0.0,
    };
    let Asked { bias, receiver, .. } = lookup.ask();
    let longer = f64::from(receiver.texel_m[0].max(receiver.texel_m[1]));
    let more = f64::from(receiver.tolerance.constant * receiver.range_m) - f64::from(TEXEL_BIAS) * longer;
    let agrees_everywhere = |bias: &Bias| {
        let taps = (-4..=4).flat_map(|u| (-4..=4).map(move |v| DVec2::new(f64::from(u), f64::from(v))));
        let depth = receiver.depth + receiver.tolerance.constant;
        taps.flat_map(|tap| [-0.02, 0.02].map(|gap| (tap, gap * longer)))
            .all(|(tap, gap)| agree(bias, &receiver, depth, more, tap, gap))
    };
    assert!(agrees_everywhere(&bias), "{bias:?}");
    let changed = |change: fn(&mut Bias)| {
        let mut other = bias;
        change(&mut other);
        other
    };
    for other in [
        changed(|bias| bias.constant_m *= 1.1),
        changed(|bias| bias.constant_m *= 0.9),
        changed(|bias| bias.corner_per_texel *= 1.1),
        changed(|bias| bias.depth_per_texel *= 1.1),
        changed(|bias| bias.depth_per_texel *= -1.0),
        bias.without_plane(DVec2::ONE),
    ] {
        assert!(!agrees_everywhere(&other), "{other:?} is taken for {bias:?}");
    }
}

/// The planner's bias, for engines with other shaders, has the constants of the WGSL.
#[test]
fn the_planners_bias_has_the_shaders_constants() {
    let text = umbrage_shaders::receiver(0, umbrage_shaders::Maps::default());
    let constant = |name: &str| -> f64 {
        let begin = format!("const UMBRAGE_BIAS_{name}: f32 = ");
        let value = text.lines().find_map(|line| line.strip_prefix(&begin)?.strip_suffix(';'));
        value.and_then(|value| value.parse().ok()).unwrap_or_else(|| panic!("{name} is not in the text"))
    };
    let texel = DVec2::new(0.3, 0.1);
    let mut planned = super::tests::split_near(DVec3::NEG_Y, DVec3::ZERO, 0.1, 1024);
    planned.texel_m = texel;
    let of = |tangent: f64| planned.bias((planned.u_axis * tangent - planned.depth_axis).normalize());
    assert!((of(0.0).constant_m - constant("TEXEL_BIAS") * texel.max_element()).abs() < 1e-12);
    let corner = |tangent: f64| of(tangent).corner_per_texel / texel.min_element();
    for (tangent, expected) in
        [(1.0, constant("CORNER_SLOPE")), (10.0, constant("FOLD") * 101.0), (40.0, constant("MOST_CORNER_SLOPE"))]
    {
        assert!((corner(tangent) - expected).abs().max_element() < 1e-9, "{} for {expected}", corner(tangent));
    }
    assert_eq!(STEEPEST, constant("MAX_SLOPE"));
}
