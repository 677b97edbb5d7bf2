//! The receivers' text, made only of the parts that are used.

use crate::layout::{BiasKind, FilterKind, MetricKind, SelectionKind, TransitionKind};
use crate::{Bound, Maps, MomentMaps, layout, variant};

const SEPARATE: [&str; layout::MAX_SPLITS] = [
    text!("separate_1"),
    text!("separate_2"),
    text!("separate_3"),
    text!("separate_4"),
    text!("separate_5"),
    text!("separate_6"),
    text!("separate_7"),
    text!("separate_8"),
];
const SEPARATE_WITHOUT_LOADS: [&str; layout::MAX_SPLITS] = [
    text!("separate_1_without_loads"),
    text!("separate_2_without_loads"),
    text!("separate_3_without_loads"),
    text!("separate_4_without_loads"),
    text!("separate_5_without_loads"),
    text!("separate_6_without_loads"),
    text!("separate_7_without_loads"),
    text!("separate_8_without_loads"),
];
const SEPARATE_R32F: [&str; layout::MAX_SPLITS] = [
    text!("separate_1_r32f"),
    text!("separate_2_r32f"),
    text!("separate_3_r32f"),
    text!("separate_4_r32f"),
    text!("separate_5_r32f"),
    text!("separate_6_r32f"),
    text!("separate_7_r32f"),
    text!("separate_8_r32f"),
];

const SEPARATE_IDS: [&str; layout::MAX_SPLITS] = [
    text!("ids_1"),
    text!("ids_2"),
    text!("ids_3"),
    text!("ids_4"),
    text!("ids_5"),
    text!("ids_6"),
    text!("ids_7"),
    text!("ids_8"),
];

/// Kinds of lights that receivers may sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Lights {
    /// Only suns.
    Suns,
    /// Suns and spot lights: one frame for each light.
    Single,
    /// Suns, spot lights and point lights.
    #[default]
    Any,
}

/// Kinds of maps that a sun may have. A local light's maps are always perspective.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Projection {
    /// Plain maps, in which all texels have one size.
    Plain,
    /// Warped maps.
    Warped,
    /// Either kind, split by split.
    #[default]
    Any,
}

/// Options of exact edges, by which the triangles that texels name decide where a shadow ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ExactEdges {
    /// Number of positions of a pixel that are decided, each lit or dark: 1, which is the query's
    /// own, or 4 or 8, at the positions of a pixel's samples.
    pub positions: u32,
    /// True if the text counts its work, for a debug view: it then has `umbrage_edge_counts() ->
    /// vec4u`, for all queries of an invocation.
    pub counted: bool,
}

impl Default for ExactEdges {
    /// One position, without counting.
    fn default() -> Self {
        Self { positions: 1, counted: false }
    }
}

impl ExactEdges {
    /// Offsets from a pixel's centre in sixteenths, for one position and for the usual samples of 4
    /// and 8
    /// (<https://registry.khronos.org/vulkan/specs/latest/html/vkspec.html#primsrast-multisampling>).
    const ONE: &[[i32; 2]] = &[[0, 0]];
    const FOUR: &[[i32; 2]] = &[[-2, -6], [6, -2], [-6, 2], [2, 6]];
    const EIGHT: &[[i32; 2]] = &[[1, -3], [-1, 3], [5, 1], [-3, -5], [-5, 5], [-7, -1], [3, 7], [7, -7]];

    /// Offsets of the positions in pixels, to the right and down from the centre.
    #[must_use]
    pub fn places(self) -> Vec<[f32; 2]> {
        self.sixteenths().iter().map(|place| place.map(|by| by as f32 / 16.0)).collect()
    }

    const fn sixteenths(self) -> &'static [[i32; 2]] {
        match self.positions {
            0..=3 => Self::ONE,
            4..=7 => Self::FOUR,
            _ => Self::EIGHT,
        }
    }

    /// Declares the constants that `shaders/lib/edges.wesl` needs.
    fn constants(self, ids_binding: usize) -> String {
        let packed = |axis: usize| {
            let nibble = |(i, place): (usize, &[i32; 2])| ((place[axis] + 8) as u32) << (4 * i);
            self.sixteenths().iter().enumerate().map(nibble).sum::<u32>()
        };
        let (samples, right, below) = (self.sixteenths().len(), packed(0), packed(1));
        format!(
            "const UMBRAGE_IDS_BINDING = {ids_binding}u;\nconst UMBRAGE_EDGE_SAMPLES = {samples}u;\n\
             const UMBRAGE_EDGE_RIGHT = {right}u;\nconst UMBRAGE_EDGE_BELOW = {below}u;\n"
        )
    }
}

/// Choices for which a receiver's text is made; code for other choices is not in it. If a choice is
/// `None` the text has all alternatives, and the [`layout::Frame`] selects one. The frame has to
/// agree with the choices of the text: the text does not check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ReceiverText {
    /// Binding of the maps, and the way in which they are read.
    pub maps: Maps,
    /// [`layout::Frame::filter_kind`].
    pub filter: Option<FilterKind>,
    /// [`layout::Frame::selection`].
    pub selection: Option<SelectionKind>,
    /// [`layout::Frame::is_radial`].
    pub metric: Option<MetricKind>,
    /// [`layout::Frame::transition`].
    pub transition: Option<TransitionKind>,
    /// [`layout::Frame::bias_kind`].
    pub bias: Option<BiasKind>,
    /// Kinds of maps that a sun may have.
    pub projection: Projection,
    /// Kinds of lights.
    pub lights: Lights,
    /// True if one map may be used for one split after the other: [`layout::Frame::slice`] is then
    /// read.
    pub sliced: bool,
    /// Exact edges: texels store ids of the triangles that they show, and these decide where a
    /// shadow ends; see [`stored_runs`]. For depth that can be loaded from, and only with the
    /// filter [`FilterKind::Pcf3`].
    pub exact: Option<ExactEdges>,
    /// True if the text knows only the answers that bounds over a filter's kernel give, without the
    /// filter: it then has `umbrage_is_undecided() -> bool`. For a first draw of cheap pixels,
    /// which leaves the others to a second one.
    pub bounds: bool,
}

impl Default for ReceiverText {
    /// A text with all choices.
    fn default() -> Self {
        Self::from(Maps::default())
    }
}

impl From<Maps> for ReceiverText {
    fn from(maps: Maps) -> Self {
        Self {
            maps,
            filter: None,
            selection: None,
            metric: None,
            transition: None,
            bias: None,
            projection: Projection::Any,
            lights: Lights::Any,
            sliced: true,
            exact: None,
            bounds: false,
        }
    }
}

impl ReceiverText {
    /// Returns whether the text contains the code behind a condition of this name, for conditions
    /// that the joined texts keep.
    fn has(&self, name: &str) -> bool {
        /// Returns whether a choice is one of these, or open.
        fn may<T: Copy + PartialEq>(choice: Option<T>, these: &[T]) -> bool {
            choice.is_none_or(|choice| these.contains(&choice))
        }
        if FilterKind::ALL.iter().any(|kind| kind.parts().contains(&name)) {
            return self.filter.is_none_or(|kind| kind.parts().contains(&name));
        }
        let suns_alone = self.lights == Lights::Suns;
        match name {
            "any_filter" => self.filter.is_none(),
            "by_depth" => may(self.selection, &[SelectionKind::Depth]),
            "by_map" => may(self.selection, &[SelectionKind::Map]),
            "planar" => may(self.metric, &[MetricKind::ViewDepth]),
            "radial" => may(self.metric, &[MetricKind::Distance]),
            "any_transition" => self.transition.is_none(),
            "blended" => may(self.transition, &[TransitionKind::Blend]),
            "dithered" => may(self.transition, &[TransitionKind::Dither]),
            "plane_bias" => may(self.bias, &[BiasKind::Plane]),
            "slope_bias" => may(self.bias, &[BiasKind::Slope]),
            "plain" => self.projection != Projection::Warped,
            "warped" => !(self.maps.coordinates || suns_alone && self.projection == Projection::Plain),
            "local" => !suns_alone,
            "faces" => self.lights == Lights::Any,
            "sliced" => self.sliced,
            "exact" => self.exact.is_some(),
            "bounds" => self.bounds,
            "counted" => self.exact.is_some_and(|exact| exact.counted),
            "linear" => !suns_alone && self.maps.r32f,
            _ => unreachable!("the condition {name} stands for no choice"),
        }
    }
}

/// WGSL to put before a shader that computes visibility.
///
/// | WGSL | result |
/// |---|---|
/// | `umbrage_visibility(position: vec3f, normal: vec3f) -> f32` | share of the first light that reaches a surface, 0 to 1 |
/// | `umbrage_shadow(query: UmbrageQuery) -> UmbrageShadow` | the same for any light, with the split that was sampled |
/// | `umbrage_shadow_from_coordinates(query, coordinates) -> UmbrageShadow` | the same from coordinates that vertex shaders computed ([`Maps::coordinates`]) |
///
/// `umbrage_query(position, normal)` makes a query in any stage; `umbrage_fragment_query(position,
/// normal, dx, dy, pixel)` makes one that contains its pixel, in uniform control flow. Set a
/// query's `light`, `pixel` or `split` for another query.
///
/// # Panics
/// If there are fewer than 1 or more than [`layout::MAX_SPLITS`] separate maps.
#[must_use]
pub fn receiver(group: u32, text: impl Into<ReceiverText>) -> String {
    let text: ReceiverText = text.into();
    let ReceiverText { maps, filter, exact, .. } = text;
    let (frames, bound) = (maps.frames.max(1), maps.bound);
    let splits = maps.splits.clamp(1, layout::MAX_SPLITS as u32);
    let loads = maps.r32f || !maps.without_loads;
    let root = match (maps.moments, loads, maps.coordinates) {
        (Some(_), _, false) => text!("receiver_of_moments"),
        (Some(_), _, true) => text!("receiver_with_coordinates_of_moments"),
        (None, true, false) => text!("receiver"),
        (None, true, true) => text!("receiver_with_coordinates"),
        (None, false, false) => text!("receiver_without_loads"),
        (None, false, true) => text!("receiver_with_coordinates_without_loads"),
    };
    let maps = match (maps.moments, maps.bound, maps.r32f, loads) {
        (Some(MomentMaps::Sampled), ..) => text!("moments"),
        (Some(MomentMaps::Taps), ..) => text!("moments_by_taps"),
        (Some(MomentMaps::Manual), ..) => text!("moments_by_hand"),
        (None, Bound::Array, true, _) => text!("array_r32f"),
        (None, Bound::Array, false, true) => text!("array"),
        (None, Bound::Array, false, false) => text!("array_without_loads"),
        (None, Bound::Cube, true, _) => text!("cube_r32f"),
        (None, Bound::Cube, false, true) => text!("cube"),
        (None, Bound::Cube, false, false) => text!("cube_without_loads"),
        (None, Bound::Separate(count), true, _) => SEPARATE_R32F[count - 1],
        (None, Bound::Separate(count), false, true) => SEPARATE[count - 1],
        (None, Bound::Separate(count), false, false) => SEPARATE_WITHOUT_LOADS[count - 1],
    };
    let filter = filter.map_or_else(String::new, |kind| format!("const UMBRAGE_FILTER = {}u;\n", kind as u32));
    let root = variant::resolved(root, |name| text.has(name));
    let ids = match (exact, bound) {
        (None, _) => String::new(),
        (Some(edges), Bound::Array) => edges.constants(3) + text!("ids"),
        // Beside the faces as layers.
        (Some(edges), Bound::Cube) => edges.constants(4) + text!("ids"),
        (Some(edges), Bound::Separate(count)) => edges.constants(3 + count) + SEPARATE_IDS[count - 1],
    };
    format!(
        "const UMBRAGE_RECEIVER_GROUP = {group}u;\nconst UMBRAGE_FRAMES = {frames}u;\n\
         const UMBRAGE_SPLITS = {splits}u;\n{filter}{maps}\n{ids}\n{root}\n"
    )
}

/// WGSL to put beside a [`receiver`] of exact edges ([`ReceiverText::exact`]): the two functions
/// that it calls, for casters whose positions and indices lie in storage buffers.
///
/// | binding, from `binding` on | resource |
/// |---|---|
/// | 0 | [`layout::StoredSlot`] of each slot |
/// | 1 | [`layout::StoredRun`]s |
/// | 2 | indices, `u32` |
/// | 3 | positions, three `f32` each, in the runs' own space |
///
/// An application that keeps its meshes otherwise declares the functions itself:
///
/// | WGSL | result |
/// |---|---|
/// | `umbrage_run(id: u32) -> UmbrageRun` | the rows of the transform from metres relative to the frame's origin to the run's own space, a box around its triangles, their number |
/// | `umbrage_corner(run: UmbrageRun, corner: u32) -> vec3f` | corner `3 i + k` of triangle `i`, in that space |
///
/// `UmbrageRun` has the members `row_x`, `row_y`, `row_z` (`vec4f`), `min` (`vec3f`), `triangles`
/// (`u32`), `max` (`vec3f`) and `first` (`u32`), the last of which is the application's own.
#[must_use]
pub fn stored_runs(group: u32, binding: u32) -> String {
    let bits = layout::RUN_BITS;
    format!(
        "const UMBRAGE_RUNS_GROUP = {group}u;\nconst UMBRAGE_RUNS_BINDING = {binding}u;\n\
         const UMBRAGE_RUN_BITS = {bits}u;\n{}\n",
        text!("stored_runs")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines of code, to show that a text has fewer.
    fn lines(text: &ReceiverText) -> usize {
        receiver(0, *text).lines().count()
    }

    #[test]
    fn what_is_not_used_is_not_in_the_text() {
        let all = ReceiverText::default();
        let least = ReceiverText {
            filter: Some(FilterKind::Hard),
            selection: Some(SelectionKind::Depth),
            metric: Some(MetricKind::ViewDepth),
            transition: Some(TransitionKind::Hard),
            bias: Some(BiasKind::Plane),
            projection: Projection::Plain,
            lights: Lights::Suns,
            sliced: false,
            ..all
        };
        let (text, full) = (receiver(0, least), receiver(0, all));
        for gone in [
            "fn umbrage_disc_",
            "fn umbrage_square_",
            "fn umbrage_kernel_integral",
            "fn umbrage_texel_texel_seen",
            "fn umbrage_bias_warped_point",
            "fn umbrage_bias_meets_receiver",
            "fn umbrage_bias_without_plane",
            "fn umbrage_select_choose_by_map",
            "distance(",
            "frame_count",
            ".transition",
            ".selection",
            ".filter_kind",
            ".slice",
        ] {
            assert!(!text.contains(gone), "{gone} is in the text");
        }
        for there in [
            "fn umbrage_disc_shares",
            "fn umbrage_square_shares",
            "fn umbrage_select_choose_by_map",
            ".transition",
            ".slice",
        ] {
            assert!(full.contains(there), "{there} is not in the full text");
        }
        assert!(5 * lines(&least) < 4 * lines(&all), "{} of {}", lines(&least), lines(&all));
        assert!(!text.contains("@if") && !full.contains("@if"));
    }
}
