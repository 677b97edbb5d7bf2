//! Passes, the splits that each of them draws, and the instances with which they are drawn.

use std::ops::Range;

use umbrage::config::Generation;
use umbrage::{MAX_SPLITS, ShadowPlan};

use super::choose::Abilities;

/// One pass that draws casters into the maps of one split or of several; see
/// [`crate::ShadowMaps::passes`].
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MapPass {
    splits: Range<usize>,
    /// Number of layers drawn at once: split `splits.start + t · views + v` is tile `t` of layer
    /// `v`.
    views: usize,
    /// True for one split alone, whose casters need no code.
    alone: bool,
    /// True if every draw begins with an instance that draws nothing.
    leads: bool,
}

impl MapPass {
    /// The passes of a generation, first to last.
    pub(super) fn all(generation: Generation, splits: usize, abilities: Abilities) -> Vec<Self> {
        let several = |splits, views| Self { splits, views, alone: false, leads: views > 1 && abilities.leads };
        match generation {
            Generation::PerSplit | Generation::Multipass => (0..splits)
                .map(|split| Self { splits: split..split + 1, views: 1, alone: true, leads: false })
                .collect(),
            Generation::Layered => {
                // As many views in each pass, so that one pipeline serves all of them.
                let passes = splits.div_ceil(abilities.views as usize);
                let views = splits.div_ceil(passes);
                (0..passes).map(|pass| several(pass * views..splits.min((pass + 1) * views), views)).collect()
            }
            Generation::Instanced => vec![several(0..splits, 1)],
            // Two tiles a layer, more only where there are not enough views.
            Generation::Mixed => vec![several(0..splits, splits.div_ceil(2).min(abilities.views as usize))],
        }
    }

    /// Range of the splits whose maps the pass draws; with several lights, of the maps: see
    /// [`crate::ShadowMaps::first_map`].
    #[must_use]
    pub fn splits(&self) -> Range<usize> {
        self.splits.clone()
    }

    /// Number of layers that the pass draws at once; 1 without multiview.
    #[must_use]
    pub fn views(&self) -> usize {
        self.views
    }

    /// Returns whether every draw has to begin with an instance whose code draws nothing: the code
    /// before the first one of [`MapPass::instances`], whose range then includes it. An application
    /// that draws many instances in one call needs one such instance in each call.
    ///
    /// Works around a bug of Mesa's software driver (seen with 22.3). It remembers which layer it
    /// draws into when it draws a batch that needs no clipping, and draws batches that need
    /// clipping into the remembered layer. Each instance is a batch, so an empty one makes it
    /// remember the right layer.
    #[must_use]
    pub fn leads(&self) -> bool {
        self.leads
    }

    /// Returns whether the pass draws one split with the plain text for casters.
    pub(crate) fn is_alone(&self) -> bool {
        self.alone
    }

    /// Range of instances with which to draw a caster of the splits in `mask` (bit `i`: split `i`);
    /// empty if the pass draws none of them. A caster that is an instance in the application needs
    /// one instance for each number of the range, with that number as its code.
    #[must_use]
    pub fn instances(&self, mask: u8) -> Range<u32> {
        if self.alone {
            // With several lights there are more maps than bits, and the app knows which plan and
            // which split are drawn.
            let here = self.splits.start >= 8 || mask & (1 << self.splits.start) != 0;
            return 0..u32::from(here);
        }
        let mask = self.splits().filter(|split| mask & (1 << split) != 0).fold(0u32, |mask, split| mask | 1 << split);
        if mask == 0 {
            return 0..0;
        }
        let (first, last) = (mask.trailing_zeros() as usize, mask.ilog2() as usize);
        let tile = |split: usize| ((split - self.splits.start) / self.views) as u32;
        let code = mask << 3;
        // The code before the first is no instance's: its tile holds none of these splits.
        code + tile(first) - u32::from(self.leads)..code + tile(last) + 1
    }

    /// Casters to draw if there is one sun or spot light, each with its instances: the plan's
    /// casters, as indices into the list given to the planner or keys of its set.
    pub fn casters(&self, plan: &ShadowPlan) -> impl Iterator<Item = (u32, Range<u32>)> + use<> {
        let mut list = Vec::new();
        self.list(plan, &mut list);
        list.into_iter()
    }

    /// Appends [`MapPass::casters`] to a list.
    pub(crate) fn list(&self, plan: &ShadowPlan, list: &mut Vec<(u32, Range<u32>)>) {
        if self.alone {
            let casters = plan.casters(self.splits.start);
            list.extend(casters.iter().map(|&caster| (caster, 0..1)));
            return;
        }
        // Lists rise: the least of their first casters is the next one, in all splits whose list it
        // heads.
        let mut left: [&[u32]; MAX_SPLITS] = [&[]; MAX_SPLITS];
        for split in self.splits() {
            left[split] = plan.casters(split);
        }
        while let Some(&caster) = left.iter().filter_map(|casters| casters.first()).min() {
            let mut mask = 0;
            for (split, casters) in left.iter_mut().enumerate() {
                if let [first, rest @ ..] = casters
                    && *first == caster
                {
                    (mask, *casters) = (mask | 1 << split, rest);
                }
            }
            list.push((caster, self.instances(mask)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Split that `umbrage_cast` derives from a code and a view.
    fn decoded(pass: &MapPass, code: u32, view: usize) -> Option<usize> {
        let index = pass.splits.start + (code & 7) as usize * pass.views + view;
        (index < pass.splits.end && (code >> (3 + index)) & 1 == 1).then_some(index)
    }

    #[test]
    fn every_split_is_drawn_once_and_by_its_own_casters() {
        for generation in [Generation::PerSplit, Generation::Layered, Generation::Instanced, Generation::Mixed] {
            for splits in 1..=8 {
                for (views, leads) in (2..=8).flat_map(|views| [(views, false), (views, true)]) {
                    let passes = MapPass::all(
                        generation,
                        splits,
                        Abilities { views, clip_distances: true, leads, depth_loads: true },
                    );
                    assert!(passes.iter().all(|pass| pass.views <= views as usize && pass.views == passes[0].views));
                    for mask in 0..1u32 << splits {
                        let mut drawn = Vec::new();
                        for pass in &passes {
                            for code in pass.instances(mask as u8) {
                                if pass.alone {
                                    drawn.push(pass.splits.start);
                                } else {
                                    drawn.extend((0..pass.views).filter_map(|view| decoded(pass, code, view)));
                                }
                            }
                        }
                        drawn.sort_unstable();
                        let wanted: Vec<usize> = (0..splits).filter(|split| mask & (1 << split) != 0).collect();
                        assert_eq!(drawn, wanted, "{generation:?}, {splits} splits, {views} views, {mask:b}");
                    }
                }
            }
        }
    }

    #[test]
    fn submissions_are_as_few_as_views_allow() {
        let count = |generation, splits, views| {
            MapPass::all(generation, splits, Abilities { views, clip_distances: true, leads: false, depth_loads: true })
                .len()
        };
        assert_eq!(count(Generation::PerSplit, 4, 6), 4);
        assert_eq!(
            (1..=8).map(|splits| count(Generation::Layered, splits, 6)).collect::<Vec<_>>(),
            [1, 1, 1, 1, 1, 1, 2, 2]
        );
        assert_eq!(count(Generation::Layered, 8, 2), 4);
        assert_eq!((count(Generation::Instanced, 8, 2), count(Generation::Mixed, 8, 2)), (1, 1));
    }
}
