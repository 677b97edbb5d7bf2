//! Config for a budget.

use super::{Budget, EDGE_STEP};
use crate::config::{Filter, Preset, ShadowConfig};
use crate::margin::FilterReach;
use crate::{Error, Result};

/// Number of splits and filter from a number of texels on.
struct Rung {
    texels: u64,
    splits: usize,
    filter: Filter,
}

/// The best number of splits hardly depends on the budget (docs/notes/budget.md): four, and fewer
/// where maps of four would be narrower than 64 texels. Each rung begins where its maps take every
/// texel of the budget, so that no larger budget has fewer texels.
const RUNGS: [Rung; 3] = [
    Rung { texels: 0, splits: 1, filter: Filter::Pcf3 { width_m: None } },
    Rung { texels: 2 * 64 * 64, splits: 2, filter: Filter::Pcf3 { width_m: None } },
    Rung { texels: 4 * 64 * 64, splits: 4, filter: Filter::Pcf3 { width_m: None } },
];

impl Budget {
    /// Edge in texels of the smallest map that [`Budget::edge`] gives and in which a filter works.
    #[must_use]
    pub fn least_edge(filter: &Filter, is_stabilised: bool) -> u32 {
        let margins = FilterReach::from(filter).least_map_size(is_stabilised);
        filter.least_map_size().max(margins).next_multiple_of(EDGE_STEP)
    }
}

impl ShadowConfig {
    /// [`Preset::Balanced`] within a budget, which decides the number of splits, the sizes of maps
    /// and the filter. Maps never take more than the budget; a larger budget never has fewer
    /// texels.
    ///
    /// ```
    /// use umbrage::config::{Budget, ShadowConfig};
    ///
    /// let config = ShadowConfig::for_budget("8MiB".parse()?)?;
    /// assert!(4 * config.texels() <= 8 << 20);
    /// # Ok::<(), umbrage::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::BudgetTooSmall`] if the budget does not pay for the map of a single split. The
    /// error contains the least budget that does.
    pub fn for_budget(budget: Budget) -> Result<Self> {
        let balanced = Preset::Balanced.config();
        let texel_bytes = balanced.depth_format.texel_bytes();
        let rung = RUNGS.iter().rev().find(|rung| budget.texels(texel_bytes) >= rung.texels).unwrap_or(&RUNGS[0]);
        let least = Budget::least_edge(&rung.filter, balanced.is_stabilised());
        let edge = budget.edge(rung.splits, texel_bytes);
        if edge < least {
            let least = budget.of_texels(u64::from(least) * u64::from(least), texel_bytes);
            return Err(Error::BudgetTooSmall { budget, least });
        }
        Ok(Self { map_sizes: vec![edge; rung.splits], filter: rung.filter, ..balanced })
    }
}
