//! Choice of the layout: the requested one, or the one that the device supports instead.

use umbrage::config::{Edges, Fallbacks, Generation, Layout, ShadowConfig};

use crate::{Error, Result};

/// Properties of the device on which the choice depends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Abilities {
    /// Number of layers that one pass can draw into; 0 or 1 without multiview.
    pub views: u32,
    /// True if instances can be clipped at the edges of a tile.
    pub clip_distances: bool,
    /// True if multiview forgets which layer it draws into, see [`super::MapPass::leads`].
    pub leads: bool,
    /// True if shaders can load from depth textures.
    pub depth_loads: bool,
}

impl Abilities {
    pub fn of(device: &wgpu::Device) -> Self {
        let has = |feature| device.features().contains(feature);
        Self {
            views: if has(wgpu::Features::MULTIVIEW) { device.limits().max_multiview_view_count } else { 0 },
            clip_distances: has(wgpu::Features::CLIP_DISTANCES),
            leads: device.adapter_info().driver == "llvmpipe",
            depth_loads: device.adapter_info().backend != wgpu::Backend::Gl,
        }
    }

    /// The feature that a generation lacks.
    fn lacking(self, generation: Generation) -> Option<&'static str> {
        let multiview = (self.views < 2).then_some("MULTIVIEW with max_multiview_view_count of 2 or more");
        let clip_distances = (!self.clip_distances).then_some("CLIP_DISTANCES");
        match generation {
            Generation::Layered => multiview,
            Generation::Instanced => clip_distances,
            Generation::Mixed => multiview.or(clip_distances),
            Generation::PerSplit | Generation::Multipass => None,
        }
    }
}

/// The chosen layout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Chosen {
    pub layout: Layout,
    pub edges: Edges,
    /// Requests that could not be met.
    pub notes: Vec<String>,
}

/// Finds the layout, or names the feature that it lacks.
pub(crate) fn choose(config: &ShadowConfig, abilities: Abilities) -> Result<Chosen> {
    let (layout, generation) = (config.layout, config.layout.generation());
    let mut notes = Vec::new();
    let mut edges = config.edges;
    if edges.is_exact() && !abilities.depth_loads {
        if config.fallbacks == Fallbacks::Forbid {
            return Err(Error::NoExactEdges);
        }
        notes.push("no loads from depth textures on GL: edges are sampled".to_owned());
        edges = Edges::Sampled;
    }
    let Some(feature) = abilities.lacking(generation) else {
        return Ok(Chosen { layout, edges, notes });
    };
    if config.fallbacks == Fallbacks::Forbid {
        return Err(Error::MissingFeature { generation: generation.word(), feature });
    }
    notes.push(format!("generation {generation} needs {feature}, which this device does not give: per-split"));
    let layout = Layout::of(Generation::PerSplit, layout.storage()).unwrap_or_default();
    Ok(Chosen { layout, edges, notes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_edges_need_loads_from_depth() {
        let asked = ShadowConfig { edges: Edges::exact(), ..ShadowConfig::default() };
        let with_loads = Abilities { depth_loads: true, ..Abilities::default() };
        let chosen = choose(&asked, with_loads).expect("there is always a way");
        assert_eq!((chosen.edges, chosen.notes.len()), (Edges::exact(), 0));
        let chosen = choose(&asked, Abilities::default()).expect("there is always a way");
        assert!(chosen.edges == Edges::Sampled && chosen.notes[0].contains("edges are sampled"), "{chosen:?}");
        let strict = ShadowConfig { fallbacks: Fallbacks::Forbid, ..asked };
        assert_eq!(choose(&strict, Abilities::default()), Err(Error::NoExactEdges));
    }

    #[test]
    fn what_a_device_lacks_is_replaced_or_refused() {
        for layout in Layout::ALL {
            for abilities in [
                Abilities::default(),
                Abilities { views: 6, clip_distances: false, leads: false, depth_loads: true },
                Abilities { views: 1, clip_distances: true, leads: false, depth_loads: true },
                Abilities { views: 8, clip_distances: true, leads: false, depth_loads: true },
            ] {
                let asked = ShadowConfig { layout, ..ShadowConfig::default() };
                let chosen = choose(&asked, abilities).expect("there is always a way");
                assert_eq!(abilities.lacking(chosen.layout.generation()), None);
                assert_eq!(chosen.layout.storage(), layout.storage());
                let strict = choose(&ShadowConfig { fallbacks: Fallbacks::Forbid, ..asked }, abilities);
                let generation = layout.generation().word();
                match abilities.lacking(layout.generation()) {
                    Some(feature) => {
                        assert!(chosen.notes[0].contains(generation) && chosen.notes[0].contains("per-split"));
                        assert_eq!(strict, Err(Error::MissingFeature { generation, feature }));
                    }
                    None => assert_eq!((strict, chosen.layout), (Ok(chosen.clone()), layout)),
                }
            }
        }
    }
}
