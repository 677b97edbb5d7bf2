//! Placement of planes by search: the set of candidates with the least predicted error.
//!
//! The papers place planes by a formula of near, far and m alone, which is optimal for a scene that
//! fills the view evenly. Real scenes do not: a plane in the gap between two rows of casters leaves
//! both maps small, a plane through a row makes both as wide as the row. Here the set of planes of
//! least expected error is found exactly, by dynamic programming over a few dozen candidates. This
//! search is not from a paper; *Sample Distribution Shadow Maps* (Lauritzen et al. 2010) place
//! planes by the depths that a frame shows, which needs the frame.

use glam::DVec2;

use super::cells::{Cells, Sight};
use super::scheme::{coverage, split_planes};
use super::visible::visible_range;
use crate::config::{Crop, ExtentSteps, SplitScheme, Stability};
use crate::geometry::region::{Fan, Region, Widths};
use crate::geometry::sphere::slice_sphere;
use crate::held::ends::Range;
use crate::{Error, Frustum, Projection, Result, ShadowConfig, View};

/// Number of candidates between the ends, besides those of the fixed schemes and held planes.
const CANDIDATES: usize = 32;

/// Ratio of the last to the first visible depth below which both count as a single depth.
const LEAST_RATIO: f64 = 1.01;

/// Share of the held planes' cost below which new planes replace them, if maps have to stand still.
const WORTH_MOVING: f64 = 2.0 / 3.0;

/// Values from which the edge of a map follows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Maps<'a> {
    pub config: &'a ShadowConfig,
    /// Size of the image in pixels.
    pub image_size: [u32; 2],
    /// Texels that each map keeps free around the points that it serves.
    pub margin: f64,
    /// Width of the whole shadowed range in metres, of which the steps of \[PCSM\] are fractions.
    pub whole_width: f64,
    /// Upper bound in metres of half the edges of any still map.
    pub most_half: DVec2,
}

impl Maps<'_> {
    /// Metres across a still map around a sphere, as the mean of its edges.
    fn still_edge(&self, radius: f64) -> f64 {
        radius.min(self.most_half.x) + radius.min(self.most_half.y)
    }

    /// Metres across a map that shows a region, as the mean of its edges.
    fn edge(&self, region: &Region) -> f64 {
        self.edge_across(&region.widths())
    }

    /// [`Maps::edge`] for a region of these widths.
    fn edge_across(&self, widths: &Widths) -> f64 {
        let widths = widths.least_rectangle();
        let extent = match self.config.stability {
            Stability::Approximate { steps: ExtentSteps::Levels(count) } => {
                let level = self.whole_width / f64::from(count);
                (widths / level).ceil().max(DVec2::ONE) * level
            }
            // Steps of equal ratio add the same share to all on average.
            _ => widths,
        };
        0.5 * (extent.x + extent.y)
    }

    /// Texels across map `i` that serve its slice.
    fn texels(&self, i: usize) -> f64 {
        let rounding = if self.config.is_stabilised() { 1.0 } else { 0.0 };
        (f64::from(self.config.map_sizes[i]) - 2.0 * self.margin - rounding).max(1.0)
    }
}

/// Costs of every slice between two candidates.
#[derive(Clone, Debug, Default)]
struct Costs {
    /// Number of candidates, ends included.
    len: usize,
    /// Metres across the map of slice (i, j), at `i * len + j`.
    edges: Vec<f64>,
    /// Begin of the map of the slice from j if the slice before begins at i, because blending and
    /// pixel quads reach back over the border. Given as the candidate at or before it, and the
    /// share of the way to the next candidate.
    begins: Vec<(usize, f64)>,
    /// Sums of the cells' weights before each candidate.
    weights_before: Vec<f64>,
    /// Texels across each map.
    texels: Vec<f64>,
    /// Metres across the last map, if that does not follow from its slice.
    last_edge: Option<f64>,
}

impl Costs {
    /// Empties the costs between `len` candidates.
    fn reset(&mut self, len: usize, texels: impl Iterator<Item = f64>, weights: &[f64]) {
        self.len = len;
        self.texels.clear();
        self.texels.extend(texels);
        self.weights_before.clear();
        self.weights_before.push(0.0);
        let mut sum = 0.0;
        self.weights_before.extend(weights.iter().map(|weight| {
            sum += weight;
            sum
        }));
        self.edges.clear();
        self.edges.resize(len * len, 0.0);
        self.begins.clear();
        self.begins.resize(len * len, (0, 0.0));
    }

    /// Expected error of map `split` over the slice from candidate `j` to `k`; `before` is the
    /// candidate at which the slice before it begins.
    fn slice(&self, split: usize, before: Option<usize>, j: usize, k: usize) -> f64 {
        let weight = self.weights_before[k] - self.weights_before[j];
        if weight <= 0.0 {
            return 0.0;
        }
        let edge = |i: usize| self.edges[i * self.len + k];
        if let Some(edge) = self.last_edge.filter(|_| split + 1 == self.texels.len()) {
            return weight * edge / self.texels[split];
        }
        let edge = match before.map(|i| self.begins[i * self.len + j]) {
            Some((begin, share)) if share > 0.0 => edge(begin) + share * (edge(begin + 1) - edge(begin)),
            Some((begin, _)) => edge(begin),
            None => edge(j),
        };
        weight * edge / self.texels[split]
    }

    /// A lower bound of [`Costs::slice`] for whichever slice before it that `begins` allows: the
    /// first candidate at which a map may begin.
    fn slice_bound(&self, split: usize, first: usize, j: usize, k: usize) -> f64 {
        let weight = self.weights_before[k] - self.weights_before[j];
        let least = match self.last_edge.filter(|_| split + 1 == self.texels.len()) {
            Some(edge) => edge,
            None => (first..=j).map(|i| self.edges[i * self.len + k]).fold(f64::INFINITY, f64::min),
        };
        // Rounding in between two edges may lead below both.
        (1.0 - 1e-9) * (weight.max(0.0) * least / self.texels[split])
    }

    /// The first candidate at which the map of a slice from candidate `j` may begin.
    fn first_begin(&self, j: usize) -> usize {
        (0..j).map(|i| self.begins[i * self.len + j].0).min().unwrap_or(j)
    }

    /// Expected error with planes at these candidates, ends included.
    fn total(&self, planes: &[usize]) -> f64 {
        (0..planes.len() - 1)
            .map(|split| self.slice(split, split.checked_sub(1).map(|i| planes[i]), planes[split], planes[split + 1]))
            .sum()
    }
}

/// The best rows of slices, by the two candidates between which their last slice lies.
#[derive(Clone, Debug, Default)]
struct Search {
    costs: Vec<f64>,
    costs_before: Vec<f64>,
    /// Begin of the slice before the last, for each split.
    parents: Vec<u8>,
}

impl Search {
    /// Writes the candidates of least cost into `planes`, ends included. Needs at least as many
    /// candidates as planes.
    ///
    /// A slice's map reaches back over its border by a share of the slice before, so that its cost
    /// depends on three planes: the states are pairs of candidates, and there are m K³ / 6 ways
    /// from pair to pair. Of equal ones the first is taken.
    fn cheapest(&mut self, costs: &Costs, planes: &mut Vec<usize>) {
        let (n, m) = (costs.len, costs.texels.len());
        let at = |i: usize, j: usize| j * n + i;
        self.costs.clear();
        self.costs.resize(n * n, f64::INFINITY);
        self.parents.clear();
        self.parents.resize(m * n * n, 0);
        for k in 1..n {
            self.costs[at(0, k)] = costs.slice(0, None, 0, k);
        }
        for split in 1..m {
            std::mem::swap(&mut self.costs, &mut self.costs_before);
            self.costs.clear();
            self.costs.resize(n * n, f64::INFINITY);
            for j in split..n {
                let before = &self.costs_before[at(0, j)..at(j, j)];
                let first = costs.first_begin(j);
                // The best way to the last end is a good way to the next one, and leaves few others
                // to look at.
                let mut parent = 0;
                for k in j + 1..n {
                    let bound = costs.slice_bound(split, first, j, k);
                    let cost = |i: usize| before[i] + costs.slice(split, Some(i), j, k);
                    let mut best = cost(parent);
                    for (i, &before) in before.iter().enumerate() {
                        if before + bound <= best && i != parent {
                            let cost = cost(i);
                            if cost < best || cost == best && i < parent {
                                (best, parent) = (cost, i);
                            }
                        }
                    }
                    self.costs[at(j, k)] = best;
                    self.parents[split * n * n + at(j, k)] = if best < f64::INFINITY { parent as u8 } else { 0 };
                }
            }
        }
        let last = n - 1;
        let mut j =
            (0..last).fold(0, |best, j| if self.costs[at(j, last)] < self.costs[at(best, last)] { j } else { best });
        let mut k = last;
        planes.clear();
        planes.push(k);
        for split in (0..m).rev() {
            planes.push(j);
            (j, k) = (usize::from(self.parents[split * n * n + at(j, k)]), j);
        }
        planes.reverse();
    }
}

/// Search for planes, with its buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placement {
    candidates: Vec<f64>,
    cells: Cells,
    weights: Vec<f64>,
    /// The view across each candidate, in the light's plane.
    faces: Vec<Region>,
    costs: Costs,
    search: Search,
    best: Vec<usize>,
    scheme: Vec<f64>,
}

impl Placement {
    /// Writes the `m + 1` planes of a range into `planes`, the last at its inner far end. Held
    /// inner planes are kept, unless others promise a much smaller error; otherwise the planes are
    /// those of least predicted error.
    ///
    /// # Errors
    /// [`Error::InvalidSetting`] naming `shadow-range` if the range is too short to be divided.
    pub fn place(
        &mut self,
        sight: &Sight,
        maps: &Maps,
        range: Range,
        held: Option<&[f64]>,
        planes: &mut Vec<f64>,
    ) -> Result<()> {
        let (near, far) = (range.near, range.inner_far);
        let m = maps.config.splits();
        split_planes(&SplitScheme::Logarithmic, near, far, m, planes)?;
        if m == 1 {
            return Ok(());
        }
        let inside = |inner: &&[f64]| inner.first() > Some(&near) && inner.last() < Some(&far);
        self.choose_candidates(sight, (near, far), m, held.unwrap_or_default())?;
        self.cells.gather(sight, &self.candidates);
        self.cells.weigh(sight.view.frustum().projection, &self.candidates, &mut self.weights);
        if self.weights.iter().sum::<f64>() <= 0.0 {
            // Nothing casts a shadow that is seen: planes that are held stay, others stand where
            // they do for an even scene.
            if let Some(inner) = held.filter(inside) {
                planes[1..m].copy_from_slice(inner);
            }
            return Ok(());
        }
        self.measure(sight, maps, range.far);
        self.search.cheapest(&self.costs, &mut self.best);
        match held.filter(inside) {
            Some(inner) if self.is_good_enough(inner) => planes[1..m].copy_from_slice(inner),
            // Where no slice has a cost planes stand as for an even scene.
            _ if self.best.windows(2).all(|pair| pair[0] < pair[1]) => {
                for (plane, &index) in planes[1..m].iter_mut().zip(&self.best[1..m]) {
                    *plane = self.candidates[index];
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn is_good_enough(&self, held: &[f64]) -> bool {
        let index = |depth: &f64| self.candidates.partition_point(|candidate| candidate < depth);
        let mut planes = [0; crate::MAX_SPLITS + 1];
        let m = held.len() + 1;
        for (plane, held) in planes[1..m].iter_mut().zip(held) {
            *plane = index(held);
        }
        planes[m] = self.costs.len - 1;
        self.costs.total(&self.best) >= WORTH_MOVING * self.costs.total(&planes[..=m])
    }

    /// Chooses rising depths from near to far: evenly spaced on the image over the depths that show
    /// receivers, together with the planes of the fixed schemes and held planes.
    fn choose_candidates(&mut self, sight: &Sight, (near, far): (f64, f64), m: usize, held: &[f64]) -> Result<()> {
        let scheme = match sight.view.frustum().projection {
            Projection::Perspective => SplitScheme::Logarithmic,
            Projection::Orthographic => SplitScheme::Uniform,
        };
        let (first, last) = visible_range(sight.view, near, far, sight.receivers)
            .map(|(first, last)| (first.max(near), last.min(far)))
            .filter(|(first, last)| *last > LEAST_RATIO * first)
            .unwrap_or((near, far));
        let Self { candidates, scheme: planes, .. } = self;
        candidates.clear();
        candidates.extend([near, far]);
        let fixed = [SplitScheme::Logarithmic, SplitScheme::practical()].map(|scheme| (scheme, near, far, m));
        for (scheme, from, to, splits) in [(scheme, first, last, CANDIDATES)].into_iter().chain(fixed) {
            // A range with room for the splits may be too short for all the candidates: those that
            // it has no room for are left out.
            if split_planes(&scheme, from, to, splits, planes).is_ok() {
                candidates.extend(planes.iter().filter(|&&plane| plane > near && plane < far));
            }
        }
        candidates.extend(held.iter().filter(|&&held| held > near && held < far));
        candidates.sort_unstable_by(f64::total_cmp);
        candidates.dedup();
        if candidates.len() <= m {
            return Err(Error::setting(
                "shadow-range",
                format!("{near} m to {far} m has no room for {m} splits; give a longer range or fewer splits"),
            ));
        }
        Ok(())
    }

    /// Fills the costs of all slices.
    fn measure(&mut self, sight: &Sight, maps: &Maps, far: f64) {
        let Self { candidates, cells, weights, faces, costs, .. } = self;
        let config = maps.config;
        let n = candidates.len();
        costs.reset(n, (0..config.splits()).map(|i| maps.texels(i)), weights);
        costs.last_edge = sight.last_map.as_ref().map(|region| maps.edge(region));
        for i in 0..n {
            for j in i + 1..n {
                costs.begins[i * n + j] = begin(sight.view, maps, candidates, i, j);
            }
        }
        // The last slice may be stretched beyond the depths that the planes are placed for.
        let end = |j: usize| if j == n - 1 { far } else { candidates[j] };
        let edges = |i: usize| (i + 1..n).map(move |j| (j, i * n + j));
        match (&config.stability, config.crop) {
            (Stability::Exact, _) => {
                let frustum = around(sight.view.frustum());
                for (i, &from) in candidates.iter().enumerate() {
                    for (j, at) in edges(i) {
                        costs.edges[at] = maps.still_edge(slice_sphere(&frustum, from, end(j)).radius);
                    }
                }
            }
            (_, Crop::SceneIndependent) => {
                faces.clear();
                faces.extend((0..n).map(|j| face(sight.view, sight.fan, end(j))));
                for i in 0..n {
                    for (j, at) in edges(i) {
                        let mut region = faces[i];
                        region.include_region(&faces[j]);
                        costs.edges[at] = maps.edge(&region);
                    }
                }
            }
            (_, Crop::SceneDependent) => {
                for i in 0..n {
                    let (mut receivers, mut casters, mut edge) = (Region::EMPTY, Region::EMPTY, 0.0);
                    for (j, at) in edges(i) {
                        let cell = &cells.cells[j - 1];
                        if !cell.receivers.is_empty() {
                            receivers.include_region(&cell.receivers);
                            casters.include_region(&cell.casters);
                            if !casters.is_empty() {
                                edge = maps.edge_across(&casters.widths_within(&receivers));
                            }
                        }
                        costs.edges[at] = edge;
                    }
                }
            }
        }
    }
}

/// A symmetric frustum around another, whose spheres have a closed form.
fn around(frustum: &Frustum) -> Frustum {
    let (right, top) = (frustum.left.abs().max(frustum.right.abs()), frustum.bottom.abs().max(frustum.top.abs()));
    Frustum { left: -right, right, bottom: -top, top, ..*frustum }
}

/// The view across a depth, in the light's plane.
fn face(view: &View, fan: &Fan, depth: f64) -> Region {
    let mut region = Region::EMPTY;
    for corner in view.frustum().corners_at(depth) {
        region.include_point(fan, view.world_from_view_point(corner));
    }
    region
}

/// Begin of the map of a slice from candidate `j`, if the slice before begins at `i`.
fn begin(view: &View, maps: &Maps, candidates: &[f64], i: usize, j: usize) -> (usize, f64) {
    // The far plane has no effect on where a slice begins.
    let planes = [candidates[i], candidates[j], f64::INFINITY];
    let (blend, metric) = (maps.config.blend(), maps.config.selection.metric());
    let (from, _) = coverage(view, &planes, 1, blend, maps.image_size, metric);
    let after = candidates.partition_point(|&candidate| candidate <= from);
    match after.checked_sub(1) {
        None => (0, 0.0),
        Some(before) if before >= j => (j, 0.0),
        Some(before) => (before, (from - candidates[before]) / (candidates[after] - candidates[before])),
    }
}

#[cfg(test)]
mod tests;
