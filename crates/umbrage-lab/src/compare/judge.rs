//! Scores of one technique in one view.

use glam::{DMat2, DVec2, DVec3};
use image::{GrayAlphaImage, Rgb, RgbImage};
use serde::{Deserialize, Serialize};
use umbrage::{ShadowPlan, Split, View};
use umbrage_render::{EdgeCause, EdgeCounts, FrameStats};
use umbrage_scene::Pose;
use umbrage_truth::{
    Hit, SoftTruth, Truth, TruthMask,
    scores::{
        Answers, ByDepth, Domain, Footprint, Seams, TexelGradient, acne_and_leak, by_depth, edge_distance,
        mis_shadowed, seams, similarity, soft_error, texel_footprint,
    },
};

use crate::edges::{ByCause, EdgesReport};
use crate::{failure::Result, sun_disc::sun_disc};

/// Relative difference of depths from which neighbouring pixels count as different surfaces. So do
/// pixels whose normals' cosine is below [`SAME_NORMAL`].
const SAME_DEPTH: f64 = 0.05;
/// Cosine of normals below which neighbouring pixels lie on different surfaces; see [`SAME_DEPTH`].
const SAME_NORMAL: f64 = 0.95;
/// Most pixels at which predicted and measured densities are compared. More would not change the
/// result.
const SAMPLES: usize = 20_000;

/// Ground truth of a view.
#[derive(Debug)]
pub struct ViewTruth {
    /// Camera of the view.
    pub view: View,
    /// Ground truth of hard shadows.
    pub truth: TruthMask,
    /// Pixels that are scored.
    pub domain: Domain,
    /// Ground truth under a sun with an angular size.
    pub soft: Option<SoftTruth>,
}

impl ViewTruth {
    /// Traces a view. `range` is the shadowed range; `None` uses the camera's, with the far plane
    /// capped by the scene.
    ///
    /// # Errors
    /// [`crate::failure::Failure::Input`] for a range that cannot be scored.
    pub fn new(
        truth: &Truth,
        pose: &Pose,
        view: &View,
        light: &umbrage::Light,
        size: [u32; 2],
        range: Option<(f64, f64)>,
    ) -> Result<Self> {
        let mask = truth.mask_under(view, light, size, &|_| {})?;
        let domain = Domain::new(&mask, range.unwrap_or_else(|| range_of(view, pose)))?;
        Ok(Self { view: *view, truth: mask, domain, soft: None })
    }

    /// Adds the truth under a sun with this angular diameter in degrees; `None` and 0 add nothing.
    ///
    /// # Errors
    /// [`crate::failure::Failure::Input`] for an angle out of range.
    pub fn soften(&mut self, truth: &Truth, sun_angle: Option<f64>) -> Result<()> {
        self.soft = match sun_angle.and_then(sun_disc) {
            Some(disc) => Some(truth.soft(&self.truth, &disc, &|_| {})?),
            None => None,
        };
        Ok(())
    }

    fn hit(&self, pixel: usize) -> Option<&Hit> {
        self.truth.hits().get(pixel)?.as_ref()
    }
}

/// Returns the camera's near and far distance, far capped by the scene's box.
fn range_of(view: &View, pose: &Pose) -> (f64, f64) {
    let frustum = view.frustum();
    let deepest = pose.bounds.map_or(f64::NEG_INFINITY, |bounds| {
        bounds.corners().into_iter().map(|corner| view.view_depth(corner)).fold(f64::NEG_INFINITY, f64::max)
    });
    let deepest = if deepest > frustum.near { deepest } else { 2.0 * frustum.near.abs() + 1.0 };
    (frustum.near, frustum.far.min(deepest))
}

/// Scores of a technique in a view. Rates are shares in 0..=1; a score is `None` where nothing
/// could be counted.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Scores {
    /// Share of wrong decisions, E.
    pub e: Option<f64>,
    /// Share of pixels that are dark where light should be (acne), E_fs.
    pub e_false_shadow: Option<f64>,
    /// Share of pixels that are lit where shadow should be (leaks), E_fl.
    pub e_false_light: Option<f64>,
    /// Share of all scored pixels that are falsely dark and farther than 2 + 1.5 m pixels from true
    /// edges.
    pub acne: Option<f64>,
    /// Share of all scored pixels that are falsely lit and farther than 2 + 1.5 m pixels from true
    /// edges.
    pub leak: Option<f64>,
    /// Share of the scored pixels farther than 2 + 1.5 m pixels from true edges.
    pub beyond_edges: Option<f64>,
    /// Number of pixels without an answer, all of which count as wrong.
    pub missing_pixels: usize,
    /// Mean of E over bins of depth, E_log.
    pub e_log: Option<f64>,
    /// Mean distance between true and answered edges in pixels, D.
    pub edge_distance_px: Option<f64>,
    /// 95th percentile of the edge distance, in pixels.
    pub edge_distance_p95_px: Option<f64>,
    /// Number of pixels that a texel covers on the screen.
    pub texel_px: Option<TexelPixels>,
    /// E and texel densities by depth.
    pub by_depth: Vec<DepthScores>,
    /// FLIP against the truth's mask, for information only.
    pub flip: Option<f64>,
    /// SSIM against the truth's mask, for information only.
    pub ssim: Option<f64>,
    /// Mean difference from the visible share of the sun, E_soft, with `--sun-angle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub e_soft: Option<f64>,
    /// Mean difference from the visible share of the sun over penumbrae, E_pen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub e_pen: Option<f64>,
    /// Counts of exact edges with their wrong decisions; `None` with sampled edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edges: Option<EdgeScores>,
    /// Decisions on and beside the borders of splits.
    pub seams: SeamScores,
    /// Cost of the frame.
    pub cost: Cost,
    /// View depths of the split planes in metres; distances with radial bands.
    pub planes_m: Vec<f64>,
}

/// Counts of exact edges in a view, with their wrong decisions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct EdgeScores {
    /// Counts of exact edges.
    #[serde(flatten)]
    pub did: EdgesReport,
    /// Falsely dark pixels as shares of the scored ones, by the cause of the decision.
    pub false_shadow: ByCause,
    /// Falsely lit pixels as shares of the scored ones, by the cause of the decision.
    pub false_light: ByCause,
}

/// Counts of [`Seams`], to be pooled over views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct SeamScores {
    /// Number of pixels within 2 px of a border.
    pub pixels: usize,
    /// E within 2 px of a border.
    pub e: f64,
    /// E at 3 to 12 px on the near side.
    pub e_nearer: f64,
    /// E at 3 to 12 px on the far side.
    pub e_farther: f64,
    /// Counts behind the rates.
    #[serde(skip)]
    pub counts: Seams,
}

impl From<Seams> for SeamScores {
    fn from(counts: Seams) -> Self {
        Self {
            pixels: counts.seam.pixels,
            e: counts.seam.rate(),
            e_nearer: counts.nearer.rate(),
            e_farther: counts.farther.rate(),
            counts,
        }
    }
}

/// Pixels per texel over a view.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct TexelPixels {
    /// Median of m, the whole footprint, in pixels per texel.
    pub m_p50: f64,
    /// 99th percentile of m, in pixels per texel.
    pub m_p99: f64,
    /// Median of m_p, the perspective part of m, in pixels per texel.
    pub perspective_p50: f64,
    /// 99th percentile of m_p, in pixels per texel.
    pub perspective_p99: f64,
}

/// Scores of one of eight equal bins of ln z.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct DepthScores {
    /// View depth at which the bin begins, in metres.
    pub near_m: f64,
    /// View depth at which the bin ends, in metres.
    pub far_m: f64,
    /// Number of scored pixels in the bin.
    pub pixels: usize,
    /// E in the bin.
    pub e: Option<f64>,
    /// Median of texels per pixel (along the worse axis) as the planner predicts it at the visible
    /// points.
    pub predicted_texels_per_px: Option<f64>,
    /// Median of texels per pixel as measured from the map positions of neighbouring pixels'
    /// points.
    pub measured_texels_per_px: Option<f64>,
}

/// Cost of a frame, in counts that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct Cost {
    /// Bytes of all maps.
    pub bytes: u64,
    /// Number of casters, summed over splits.
    pub caster_split_pairs: u64,
    /// Number of draw calls into maps.
    pub draws: u64,
    /// Number of triangles drawn into maps.
    pub triangles: u64,
    /// Number of triangles drawn for the view, before any clipping.
    pub view_triangles: u64,
    /// Number of vertices shaded for maps; `None` where the device does not count.
    pub vertices: Option<u64>,
    /// Number of pixels of maps touched; `None` where the device does not count.
    pub fragments: Option<u64>,
}

/// Scores a mask against the truth. Image metrics cost more than all other scores together and are
/// computed only on demand.
///
/// # Errors
/// [`crate::failure::Failure`] if the mask has another size.
pub fn score(judged: &ViewTruth, mask: &GrayAlphaImage, stats: &FrameStats, image_metrics: bool) -> Result<Scores> {
    let answers = Answers::from_mask(mask);
    let mut scores = decisions(judged, &answers)?;
    if !judged.domain.pixels().is_empty() {
        let gradient = |point, _| texel_gradient(&stats.plan, point);
        let far = acne_and_leak(&judged.view, &judged.truth, &judged.domain, &answers, gradient)?;
        scores.acne = Some(far.acne_rate());
        scores.leak = Some(far.leak_rate());
        scores.beyond_edges = Some(far.beyond_rate());
    }
    scores.seams = seam_scores(judged, &answers, &stats.plan)?;
    scores.texel_px = footprint(judged, &stats.plan)?;
    for (bin, (predicted, measured)) in scores.by_depth.iter_mut().zip(densities(judged, &stats.plan)) {
        (bin.predicted_texels_per_px, bin.measured_texels_per_px) = (predicted, measured);
    }
    if image_metrics {
        let likeness = similarity(&grey(&judged.truth.to_image()), &grey(mask))?;
        (scores.flip, scores.ssim) = (likeness.flip, Some(likeness.ssim));
    }
    scores.cost = Cost {
        bytes: stats.bytes,
        caster_split_pairs: stats.splits.iter().map(|split| split.casters as u64).sum(),
        draws: stats.splits.iter().map(|split| u64::from(split.draws)).sum(),
        triangles: stats.splits.iter().map(|split| split.triangles).sum(),
        view_triangles: stats.view_triangles,
        vertices: stats.shadow_counts.map(|counts| counts.vertices),
        fragments: stats.shadow_counts.map(|counts| counts.fragments),
    };
    scores.planes_m.clone_from(&stats.plan.planes);
    Ok(scores)
}

/// Counts the decisions of exact edges in a view, and those of them that are wrong.
#[must_use]
pub fn edge_scores(judged: &ViewTruth, mask: &GrayAlphaImage, edges: &EdgeCounts) -> EdgeScores {
    let (answers, domain) = (Answers::from_mask(mask), &judged.domain);
    let wrong = |lit: bool| {
        let of = |cause: EdgeCause| {
            let is_wrong = |&&pixel: &&usize| {
                let answer = answers.visibility()[pixel].is_some_and(|answer| (answer >= 0.5) != lit);
                domain.lit(pixel) == lit && answer && edges.pixels()[pixel].is_some_and(|count| count.cause == cause)
            };
            domain.pixels().iter().filter(is_wrong).count() as f64 / domain.pixels().len().max(1) as f64
        };
        ByCause::of(of)
    };
    EdgeScores { did: edges.sums().into(), false_shadow: wrong(true), false_light: wrong(false) }
}

/// Computes the seam score of one view; `None` where no pixel is scored or there is no border.
fn seam_scores(judged: &ViewTruth, answers: &Answers, plan: &ShadowPlan) -> Result<SeamScores> {
    let domain = &judged.domain;
    let inner = plan.planes.get(1..plan.planes.len().saturating_sub(1)).unwrap_or_default();
    if domain.pixels().is_empty() || inner.is_empty() {
        return Ok(SeamScores::default());
    }
    let depth = |pixel| judged.hit(pixel).map_or(f64::INFINITY, |hit| plan.depth_at(hit.position));
    Ok(seams(domain, answers, inner, depth)?.into())
}

/// Computes the scores that depend on decisions alone.
pub fn decisions(judged: &ViewTruth, answers: &Answers) -> Result<Scores> {
    let domain = &judged.domain;
    if domain.pixels().is_empty() {
        return Ok(Scores::default());
    }
    let rates = mis_shadowed(domain, answers)?;
    let depths = by_depth(domain, answers)?;
    let distance = edge_distance(domain, answers)?;
    let soft = judged.soft.as_ref().map(|soft| soft_error(domain, soft, answers)).transpose()?;
    Ok(Scores {
        e_soft: soft.map(|soft| soft.whole),
        e_pen: soft.and_then(|soft| soft.penumbra),
        e: Some(rates.rate()),
        e_false_shadow: Some(rates.false_shadow_rate()),
        e_false_light: Some(rates.false_light_rate()),
        missing_pixels: rates.missing,
        e_log: depths.mean(),
        edge_distance_px: distance.map(|distance| distance.mean),
        edge_distance_p95_px: distance.map(|distance| distance.p95),
        by_depth: depth_scores(&depths),
        ..Scores::default()
    })
}

/// Returns, for each pixel, whether a mask decides it wrongly.
#[must_use]
pub fn wrong_pixels(judged: &ViewTruth, answers: &Answers) -> Vec<bool> {
    let mut wrong = vec![false; answers.visibility().len()];
    for &pixel in judged.domain.pixels() {
        let lit = judged.domain.lit(pixel);
        wrong[pixel] = answers.visibility()[pixel].is_none_or(|answer| (answer >= 0.5) != lit);
    }
    wrong
}

fn depth_scores(depths: &ByDepth) -> Vec<DepthScores> {
    let of = |bin: &umbrage_truth::scores::DepthBin| DepthScores {
        near_m: bin.near,
        far_m: bin.far,
        pixels: bin.score.pixels,
        e: (bin.score.pixels > 0).then(|| bin.score.rate()),
        predicted_texels_per_px: None,
        measured_texels_per_px: None,
    };
    depths.bins.iter().map(of).collect()
}

/// Returns the split whose map covers a point.
fn split_at(plan: &ShadowPlan, point: DVec3) -> Option<&Split> {
    let depth = plan.depth_at(point);
    let split = plan.splits.iter().find(|split| depth <= split.far)?;
    (!split.casters.is_empty()).then_some(split)
}

/// Returns the texel gradient at a point of the map that covers it.
fn texel_gradient(plan: &ShadowPlan, point: DVec3) -> Option<TexelGradient> {
    let split = split_at(plan, point)?;
    let [u, v] = split.texel_jacobian(point);
    Some(TexelGradient { u, v, width: split.texel_size_m(point).max_element() })
}

fn footprint(judged: &ViewTruth, plan: &ShadowPlan) -> Result<Option<TexelPixels>> {
    let gradient = |point, _| texel_gradient(plan, point);
    let footprint = texel_footprint(&judged.view, &judged.truth, &judged.domain, gradient)?;
    Ok(footprint.map(|Footprint { median, p99, perspective_median, perspective_p99, .. }| TexelPixels {
        m_p50: median,
        m_p99: p99,
        perspective_p50: perspective_median,
        perspective_p99,
    }))
}

/// Returns, for each bin of depth, the medians of texels per pixel, predicted and measured, over
/// the same pixels.
fn densities(judged: &ViewTruth, plan: &ShadowPlan) -> Vec<(Option<f64>, Option<f64>)> {
    const BINS: usize = 8;
    let domain = &judged.domain;
    let (near, far) = domain.range();
    let mut bins = vec![(Vec::new(), Vec::new()); BINS];
    for &pixel in domain.pixels().iter().step_by((domain.pixels().len() / SAMPLES).max(1)) {
        let depth = domain.depth(pixel);
        let Some(pair) = density_at(judged, plan, pixel, depth) else { continue };
        let bin = ((depth / near).ln() / (far / near).ln() * BINS as f64) as usize;
        let (predicted, measured) = &mut bins[bin.min(BINS - 1)];
        predicted.push(pair.0);
        measured.push(pair.1);
    }
    bins.into_iter().map(|(predicted, measured)| (median(predicted), median(measured))).collect()
}

/// Returns texels per pixel along the worse axis: predicted, and measured between this pixel's
/// point and those to its right and below.
fn density_at(judged: &ViewTruth, plan: &ShadowPlan, pixel: usize, depth: f64) -> Option<(f64, f64)> {
    let [width, height] = judged.domain.size();
    let here = judged.hit(pixel)?;
    let right = (pixel % width + 1 < width).then(|| judged.hit(pixel + 1)).flatten()?;
    let below = judged.hit(pixel + width)?;
    let on_one_surface = |other: &Hit| {
        other.object == here.object
            && (other.depth - depth).abs() < SAME_DEPTH * depth.min(other.depth)
            && other.normal.dot(here.normal) > SAME_NORMAL
    };
    if !(on_one_surface(right) && on_one_surface(below)) {
        return None;
    }
    let split = split_at(plan, here.position)?;
    let texel = |hit: &Hit| split.map_from_world(hit.position).truncate();
    let measured = least_singular_value(texel(right) - texel(here), texel(below) - texel(here));
    let size = [width as u32, height as u32];
    let predicted = 1.0 / split.pixels_per_texel_at(&judged.view, size, here.position, here.normal);
    (predicted.is_finite() && measured.is_finite()).then_some((predicted, measured))
}

/// Returns σ_min of the matrix with these columns: |det| / σ_max.
fn least_singular_value(a: DVec2, b: DVec2) -> f64 {
    let (square, det) = (a.length_squared() + b.length_squared(), DMat2::from_cols(a, b).determinant());
    let largest = (0.5 * (square + (square * square - 4.0 * det * det).max(0.0).sqrt())).sqrt();
    if largest > 0.0 { det.abs() / largest } else { 0.0 }
}

/// Returns the middle value, or the lower of the two in the middle.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied()
}

/// Converts a mask for image metrics: black where no surface is.
fn grey(mask: &GrayAlphaImage) -> RgbImage {
    RgbImage::from_fn(mask.width(), mask.height(), |x, y| {
        let [value, alpha] = mask.get_pixel(x, y).0;
        Rgb([if alpha > 0 { value } else { 0 }; 3])
    })
}

#[cfg(test)]
mod tests {
    use image::LumaA;
    use umbrage::config::Preset;

    use super::*;
    use crate::compare::tests::chessboard_shot;

    fn shifted(mask: &GrayAlphaImage, by: u32) -> GrayAlphaImage {
        GrayAlphaImage::from_fn(mask.width(), mask.height(), |x, y| *mask.get_pixel(x.saturating_sub(by), y))
    }

    #[test]
    fn the_truth_is_right_and_everything_else_is_worse() {
        let judged = chessboard_shot([160, 120]);
        let truth = judged.truth.to_image();
        let of = |mask: &GrayAlphaImage| decisions(&judged, &Answers::from_mask(mask)).expect("scores");
        let right = of(&truth);
        assert_eq!((right.e, right.e_log, right.edge_distance_px), (Some(0.0), Some(0.0), Some(0.0)));
        let (one, three) = (of(&shifted(&truth, 1)), of(&shifted(&truth, 3)));
        assert!(one.e > Some(0.0) && three.e > one.e, "{:?} {:?}", one.e, three.e);
        assert!(three.edge_distance_px > one.edge_distance_px && three.e_log > Some(0.0));
        let mut inverted = truth.clone();
        inverted.pixels_mut().for_each(|pixel| pixel.0[0] = 255 - pixel.0[0]);
        assert_eq!(of(&inverted).e, Some(1.0));
        let mut single = truth.clone();
        let pixel = judged.domain.pixels()[7];
        let size = judged.domain.size()[0];
        let (x, y) = ((pixel % size) as u32, (pixel / size) as u32);
        single.put_pixel(x, y, LumaA([255 - truth.get_pixel(x, y).0[0], 255]));
        assert_eq!(of(&single).e, Some(1.0 / judged.domain.pixels().len() as f64), "one wrong pixel");
        assert_eq!(wrong_pixels(&judged, &Answers::from_mask(&single)).iter().filter(|wrong| **wrong).count(), 1);
        assert!(decisions(&judged, &Answers::from_mask(&GrayAlphaImage::new(3, 3))).is_err(), "another size");
    }

    #[test]
    fn predicted_and_measured_densities_agree_on_flat_ground() {
        let judged = chessboard_shot([160, 120]);
        let mut planner = umbrage::Planner::new(&Preset::Papers.config()).expect("a planner");
        let everything = [umbrage::Aabb::new(glam::DVec3::splat(-400.0), glam::DVec3::splat(400.0))];
        let plan = planner.plan(&judged.view, judged.truth.light(), &everything, &everything).expect("a plan");
        let pairs: Vec<(f64, f64)> =
            densities(&judged, plan).into_iter().filter_map(|(predicted, measured)| predicted.zip(measured)).collect();
        assert!(pairs.len() >= 2, "{pairs:?}");
        for (predicted, measured) in pairs {
            assert!((predicted / measured - 1.0).abs() < 0.1, "{predicted} {measured}");
        }
    }

    #[test]
    fn small_statistics() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.0));
        assert_eq!(median(Vec::new()), None);
        assert!((least_singular_value(DVec2::new(3.0, 0.0), DVec2::new(0.0, -0.5)) - 0.5).abs() < 1e-12);
        assert_eq!(least_singular_value(DVec2::ZERO, DVec2::ZERO), 0.0);
    }
}
