//! Casters to draw into each map.

use std::ops::Range;
use std::sync::Arc;

use umbrage::{Keeper, ShadowPlan};

use crate::ShadowMaps;

/// Casters to draw into the maps of a frame. Buffers are reused.
#[derive(Debug, Default)]
pub(super) struct Draws {
    /// Indices of the passes that have to be drawn.
    pub passes: Vec<usize>,
    /// Casters of each pass with their instances, pass after pass.
    list: Vec<(u32, Range<u32>)>,
    /// End of each pass's part of the list.
    ends: Vec<usize>,
}

impl Draws {
    /// Lists a frame's casters; none if shadows are disabled.
    pub fn list(&mut self, maps: &ShadowMaps, plans: &[Arc<ShadowPlan>], enabled: bool) {
        self.clear();
        if !enabled {
            return;
        }
        let alone = maps.is_of_one_light_and_face();
        for (index, pass) in maps.passes().iter().enumerate() {
            let begin = self.list.len();
            if alone {
                pass.list(&plans[0], &mut self.list);
            } else {
                let (light, split) = maps.light_of_map(index);
                // A sun in a point light's place leaves maps over.
                let casters = if split < plans[light].splits.len() { plans[light].casters(split) } else { &[] };
                self.list.extend(casters.iter().map(|&caster| (caster, 0..1)));
            }
            // A map without casters is not read: one of several lights need not even be cleared.
            // Those of one light are, as they share textures.
            if alone || self.list.len() > begin {
                self.passes.push(index);
            }
            self.ends.push(self.list.len());
        }
    }

    /// Lists the parts of one sun's kept maps that have to be drawn: regions, whose indices follow
    /// those of the passes, and the maps that are due, with their moving casters.
    pub fn list_kept(&mut self, keeper: &Keeper) {
        self.clear();
        let maps = keeper.maps();
        self.passes.extend(maps.len()..maps.len() + keeper.regions().len());
        self.passes.extend((0..maps.len()).filter(|&map| maps[map].is_due));
        let movers = maps.iter().map(|map| keeper.movers(map));
        for casters in movers.chain(keeper.regions().iter().map(|region| keeper.casters(region))) {
            self.list.extend(casters.iter().map(|&caster| (caster, 0..1)));
            self.ends.push(self.list.len());
        }
    }

    /// Clears the lists.
    pub fn clear(&mut self) {
        self.passes.clear();
        self.list.clear();
        self.ends.clear();
    }

    /// The casters of a pass with their instances.
    pub fn of_pass(&self, pass: usize) -> &[(u32, Range<u32>)] {
        let end = |pass: usize| self.ends.get(pass).copied().unwrap_or(0);
        let begin = pass.checked_sub(1).map_or(0, end);
        &self.list[begin..end(pass).max(begin)]
    }
}

/// Casters of a pass that draws one map, as ranges of neighbours.
pub(super) fn rows(list: &[(u32, Range<u32>)]) -> impl Iterator<Item = Range<u32>> + '_ {
    list.chunk_by(|a, b| b.0 == a.0 + 1).map(|run| run[0].0..run[run.len() - 1].0 + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_one_range() {
        let list = [3, 4, 5, 8].map(|caster| (caster, 0..1));
        assert_eq!(rows(&list).collect::<Vec<_>>(), [3..6, 8..9]);
        assert_eq!(rows(&[]).count(), 0);
    }
}
