//! WGSL texts that applications put before the shaders of receivers.

use umbrage::config::{Coordinates, Filter, LightKind, Storage};
#[cfg(doc)]
use umbrage::config::{DepthFormat, Edges};
use umbrage_shaders::{Bound, ExactEdges, Lights, Maps, Projection, ReceiverText};

use super::ShadowMaps;
use crate::moments::Moments;
use crate::options::{filter_kind, metric_kind, selection_kind, transition_kind};

impl ShadowMaps {
    /// WGSL that a shader needs to compute visibility; `group` is the index at which the
    /// application binds [`ShadowMaps::receiver_bind_group`]. With [`Coordinates::Vertex`] vertex
    /// shaders may compute the coordinates of every split's map (`umbrage_shadow_coordinates` and
    /// `umbrage_shadow_from_coordinates`, see `umbrage_shaders::Maps::coordinates`). On GL and
    /// WebGL2, where depth textures cannot be loaded from, [`Filter::Pcss`] is [`Filter::Disc`],
    /// unless the format is [`DepthFormat::R32Float`].
    #[must_use]
    pub fn receiver_wgsl(&self, group: u32) -> String {
        umbrage_shaders::receiver(group, self.receiver_text())
    }

    /// [`ShadowMaps::receiver_wgsl`] with every filter that compares depth, one of which each frame
    /// chooses: it fits all configs that differ in nothing but such a filter. It takes longer to
    /// compile and to run. `None` if the config's filter is of moments, or if edges are exact.
    #[must_use]
    pub fn any_filter_receiver_wgsl(&self, group: u32) -> Option<String> {
        let has_one = self.config.filter.is_prefiltered() || self.edges.is_exact();
        let text = ReceiverText { filter: None, ..self.receiver_text() };
        (!has_one).then(|| umbrage_shaders::receiver(group, text))
    }

    /// [`ShadowMaps::receiver_wgsl`] that counts the work of exact edges, for a debug view. With
    /// [`Edges::Exact`] it has `umbrage_edge_counts() -> vec4u` for all queries of an invocation:
    /// the farthest cause (0 no query, 1 no texel is dark, 2 all texels that count are dark, 3
    /// triangles were tested and none is hit, 4 one is hit, 5 the filter decided), and the numbers
    /// of maps queried, of runs whose boxes were tested, and of triangles tested.
    #[must_use]
    pub fn counting_receiver_wgsl(&self, group: u32) -> String {
        let text = self.receiver_text();
        let exact = text.exact.map(|exact| ExactEdges { counted: true, ..exact });
        umbrage_shaders::receiver(group, ReceiverText { exact, ..text })
    }

    /// [`ShadowMaps::receiver_wgsl`] that knows only the answers that bounds over the filter's kernel
    /// give (`umbrage_is_undecided`); `None` if the config's filter has no bounds.
    pub(crate) fn bounds_receiver_wgsl(&self, group: u32) -> Option<String> {
        let has_bounds = match self.config.filter {
            Filter::Pcf2 | Filter::Pcf3 { .. } | Filter::Pcf5 { .. } | Filter::Pcf7 { .. } | Filter::Castano5 => true,
            Filter::Hard | Filter::Disc { .. } | Filter::Pcss { .. } | Filter::Moments(_) => false,
        };
        let text = ReceiverText { bounds: true, ..self.receiver_text() };
        has_bounds.then(|| umbrage_shaders::receiver(group, text))
    }

    /// Choices for which the receivers' text is made: those that the config fixes, and no others.
    fn receiver_text(&self) -> ReceiverText {
        let config = &self.config;
        let kinds = || self.slots.iter().map(|slot| slot.kind);
        let lights = match () {
            () if kinds().all(|kind| kind == LightKind::Directional) => Lights::Suns,
            () if kinds().all(|kind| kind.faces() == 1) => Lights::Single,
            () => Lights::Any,
        };
        // Splits of local lights are chosen by view depth, whatever a sun's are chosen by.
        let of_suns = lights == Lights::Suns;
        ReceiverText {
            filter: Some(filter_kind(&config.filter)),
            selection: of_suns.then(|| selection_kind(config.selection)),
            metric: of_suns.then(|| metric_kind(config.selection.metric())),
            transition: Some(transition_kind(config.transition)),
            // Part of the look, which changes from frame to frame.
            bias: None,
            // A split whose warp has nothing to gain has a plain map.
            projection: if config.first_warp().is_some() { Projection::Any } else { Projection::Plain },
            lights,
            sliced: self.layout.storage() == Storage::Reused,
            exact: self.edges.samples().map(|positions| ExactEdges { positions, counted: false }),
            ..self.receiver_maps().into()
        }
    }

    /// The maps as receivers bind them.
    fn receiver_maps(&self) -> Maps {
        let bound = match self.layout.storage() {
            Storage::Separate => Bound::Separate(self.splits()),
            Storage::Cube => Bound::Cube,
            Storage::Array | Storage::Atlas | Storage::Reused => Bound::Array,
        };
        Maps {
            bound,
            r32f: self.config.depth_format.is_colour(),
            without_loads: !self.depth_loads,
            frames: self.slots.iter().map(|slot| slot.kind.faces() as u32).sum(),
            // Not how many there are: another number of splits leaves pipelines valid.
            splits: umbrage_shaders::layout::MAX_SPLITS as u32,
            moments: self.moments.as_ref().map(Moments::maps),
            coordinates: self.config.coordinates == Coordinates::Vertex,
        }
    }
}
