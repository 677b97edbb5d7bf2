//! Results of a comparison, as they are written to JSON.

use serde::{Deserialize, Serialize};
use umbrage_truth::scores::{MemoryAt, Seams, memory_at, paired};

use super::judge::{Cost, Scores, TexelPixels};
use crate::{failure::Result, report::CameraReport};

/// Error rate E at which techniques are compared by their memory.
pub const LIMIT: f64 = 0.005;

/// Results of a comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Command as it was typed.
    pub command: Vec<String>,
    /// Instructions to draw one mask again.
    pub reproduce: &'static str,
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Least |B*| of a view that counts.
    pub least_edges: usize,
    /// Results of each technique.
    pub techniques: Vec<TechniqueReport>,
    /// Results of every view, whether it counts or not.
    pub views: Vec<ViewReport>,
    /// Flicker along walks of two frames or more.
    pub walks: Vec<WalkReport>,
    /// Comparison of every technique with every later one, by E over the views that count.
    pub pairs: Vec<PairReport>,
    /// Memory at which a technique comes down to E = 0.5 %, for techniques measured at two sizes or
    /// more.
    pub memory_at_half_percent: Vec<FamilyReport>,
    /// Notes on parts that were left out, invented, or do not count.
    pub notes: Vec<String>,
}

/// Mean results of a technique.
#[derive(Clone, Debug, Serialize)]
pub struct TechniqueReport {
    /// Label of the technique in tables.
    pub label: String,
    /// Short form of the technique, with all settings.
    pub spec: String,
    /// Part of the short form that is the same for the technique at other sizes.
    pub family: String,
    /// Technique as options of `umbrage render`.
    pub options: Vec<String>,
    /// Number of texels of all maps.
    pub texels: u64,
    /// Bytes of all maps.
    pub bytes: u64,
    /// Means over the views that count.
    pub mean: Means,
}

/// Means over the views that count.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Means {
    /// Number of views that count.
    pub views: usize,
    /// Share of wrong decisions, E.
    pub e: Option<f64>,
    /// Share of pixels that are dark where light should be, E_fs.
    pub e_false_shadow: Option<f64>,
    /// Share of pixels that are lit where shadow should be, E_fl.
    pub e_false_light: Option<f64>,
    /// Share of all scored pixels that are falsely dark and farther than 2 + 1.5 m pixels from true
    /// edges.
    pub acne: Option<f64>,
    /// Share of all scored pixels that are falsely lit and farther than 2 + 1.5 m pixels from true
    /// edges.
    pub leak: Option<f64>,
    /// Share of the scored pixels farther than 2 + 1.5 m pixels from true edges.
    pub beyond_edges: Option<f64>,
    /// Mean of E over bins of depth, E_log.
    pub e_log: Option<f64>,
    /// Mean difference from the visible share of the sun, E_soft, with `--sun-angle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub e_soft: Option<f64>,
    /// Mean difference from the visible share of the sun over penumbrae, E_pen.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub e_pen: Option<f64>,
    /// Mean distance between true edges and those of the technique in pixels, D.
    pub edge_distance_px: Option<f64>,
    /// 95th percentile of the edge distance, in pixels.
    pub edge_distance_p95_px: Option<f64>,
    /// Number of pixels that a texel covers on the screen.
    pub texel_px: Option<TexelPixels>,
    /// Seam score: E on the borders of splits over the larger E of their sides, pooled over all
    /// views; `None` below 2,000 pixels.
    pub seam_ratio: Option<f64>,
    /// Share of decisions that flip, F, over the walks that count.
    pub flicker: Option<f64>,
    /// Flips relative to the edges, F_edge, over the walks that count.
    pub flicker_per_edge: Option<f64>,
    /// F_edge over points that keep their split.
    pub kept_flicker_per_edge: Option<f64>,
    /// F_edge over points that keep their split while its map takes no step.
    pub standing_flicker_per_edge: Option<f64>,
    /// FLIP against the mask of the truth.
    pub flip: Option<f64>,
    /// SSIM against the mask of the truth.
    pub ssim: Option<f64>,
    /// Share of the points that depth alone does not decide, with exact edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undecided: Option<f64>,
    /// Number of triangles tested per undecided point, with exact edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub triangles_per_undecided: Option<f64>,
    /// Number of casters, summed over splits.
    pub caster_split_pairs: Option<f64>,
    /// Number of draw calls into maps.
    pub draws: Option<f64>,
    /// Number of triangles drawn into maps.
    pub triangles: Option<f64>,
    /// Means by bins of depth.
    pub by_depth: Vec<DepthMeans>,
}

/// Means of a bin of depth, over the views that count.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DepthMeans {
    /// Geometric mean of the bin's middles, in metres.
    pub depth_m: f64,
    /// E in the bin.
    pub e: Option<f64>,
    /// Texels per pixel as the plan predicts them.
    pub predicted_texels_per_px: Option<f64>,
    /// Texels per pixel as measured on the surfaces in view.
    pub measured_texels_per_px: Option<f64>,
}

/// Results of a view.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ViewReport {
    /// Scene as it was named.
    pub scene: String,
    /// Camera of the view.
    pub camera: CameraReport,
    /// Number of the frame in its walk.
    pub frame: Option<u32>,
    /// Sun in words.
    pub sun_name: String,
    /// Direction in which the sun's light travels; `None` for other lights.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sun: Option<[f64; 3]>,
    /// Options of `umbrage render` that show the view. Along a path they show all its frames.
    pub options: Vec<String>,
    /// View depths that are scored, in metres.
    pub range_m: [f64; 2],
    /// Number of scored pixels, |Ω_f|.
    pub scored_pixels: usize,
    /// Number of pixels on true edges, |B*|.
    pub true_edges: usize,
    /// True if the view has enough edges to count in means and comparisons.
    pub counts: bool,
    /// Scores of each technique, in order.
    pub scores: Vec<Scores>,
}

/// Results of a walk: one camera's frames under one sun.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct WalkReport {
    /// Scene as it was named.
    pub scene: String,
    /// Name of the camera.
    pub camera: String,
    /// Sun in words.
    pub sun_name: String,
    /// Number of frames.
    pub frames: usize,
    /// True if each view of the walk counts.
    pub counts: bool,
    /// Flicker of each technique, in order.
    pub flicker: Vec<FlickerReport>,
}

/// Flicker of one technique along one walk.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub struct FlickerReport {
    /// Share of decisions that flip, F.
    pub rate: Option<f64>,
    /// Flips relative to the edges, F_edge, which may exceed 1.
    pub per_edge: Option<f64>,
    /// F_edge over points that the same split decides in both frames, without a blend and without a
    /// fade.
    pub kept_per_edge: Option<f64>,
    /// Number of these points whose map took no step, over all pairs of frames.
    pub standing_points: usize,
    /// F_edge over the points whose map took no step.
    pub standing_per_edge: Option<f64>,
    /// Number of steps of maps: changes of a map's texel size, axes or depth range, other than
    /// moves by whole texels. A map that is not stabilised takes a step whenever it moves.
    pub steps: usize,
}

/// Comparison of two techniques over the same views.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairReport {
    /// Label of the first technique.
    pub first: String,
    /// Label of the second technique.
    pub second: String,
    /// Number of views.
    pub views: usize,
    /// Mean of E of the first less E of the second technique; below 0 the first is better.
    pub mean_difference: f64,
    /// Standard error of the mean difference; `None` for a single view.
    pub standard_error: Option<f64>,
    /// Number of views in which the first is better.
    pub first_better: usize,
    /// Number of views in which the second is better.
    pub second_better: usize,
    /// Number of views in which they are equal.
    pub ties: usize,
}

/// Memory at an error rate, for one technique at several sizes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FamilyReport {
    /// Technique without its sizes.
    pub family: String,
    /// Kind of the bound: `at most`, `about` or `more than`.
    pub bound: &'static str,
    /// Number of texels.
    pub texels: f64,
}

/// Computes the means of one technique. `number` is its index in the scores of each view.
#[must_use]
pub fn means(number: usize, views: &[ViewReport], walks: &[WalkReport]) -> Means {
    let scores: Vec<&Scores> = views.iter().filter(|view| view.counts).map(|view| &view.scores[number]).collect();
    let over = |of: &dyn Fn(&Scores) -> Option<f64>| mean(scores.iter().filter_map(|scores| of(scores)));
    let cost = |of: fn(&Cost) -> u64| over(&|scores| Some(of(&scores.cost) as f64));
    let texel = |of: fn(&TexelPixels) -> f64| over(&|scores| scores.texel_px.as_ref().map(of));
    let flicker = |of: fn(&FlickerReport) -> Option<f64>| {
        mean(walks.iter().filter(|walk| walk.counts).filter_map(|walk| of(&walk.flicker[number])))
    };
    let bins = scores.iter().map(|scores| scores.by_depth.len()).max().unwrap_or(0);
    let by_depth = (0..bins).filter_map(|bin| {
        let of: Vec<_> = scores.iter().filter_map(|scores| scores.by_depth.get(bin)).collect();
        Some(DepthMeans {
            depth_m: mean(of.iter().map(|bin| 0.5 * (bin.near_m.ln() + bin.far_m.ln())))?.exp(),
            e: mean(of.iter().filter_map(|bin| bin.e)),
            predicted_texels_per_px: mean(of.iter().filter_map(|bin| bin.predicted_texels_per_px)),
            measured_texels_per_px: mean(of.iter().filter_map(|bin| bin.measured_texels_per_px)),
        })
    });
    Means {
        views: scores.len(),
        e: over(&|scores| scores.e),
        e_false_shadow: over(&|scores| scores.e_false_shadow),
        e_false_light: over(&|scores| scores.e_false_light),
        acne: over(&|scores| scores.acne),
        leak: over(&|scores| scores.leak),
        beyond_edges: over(&|scores| scores.beyond_edges),
        e_log: over(&|scores| scores.e_log),
        e_soft: over(&|scores| scores.e_soft),
        e_pen: over(&|scores| scores.e_pen),
        edge_distance_px: over(&|scores| scores.edge_distance_px),
        edge_distance_p95_px: over(&|scores| scores.edge_distance_p95_px),
        texel_px: (|| {
            Some(TexelPixels {
                m_p50: texel(|t| t.m_p50)?,
                m_p99: texel(|t| t.m_p99)?,
                perspective_p50: texel(|t| t.perspective_p50)?,
                perspective_p99: texel(|t| t.perspective_p99)?,
            })
        })(),
        seam_ratio: seam_ratio(number, views),
        flicker: flicker(|f| f.rate),
        flicker_per_edge: flicker(|f| f.per_edge),
        kept_flicker_per_edge: flicker(|f| f.kept_per_edge),
        standing_flicker_per_edge: flicker(|f| f.standing_per_edge),
        flip: over(&|scores| scores.flip),
        ssim: over(&|scores| scores.ssim),
        undecided: over(&|scores| scores.edges.map(|edges| edges.did.undecided)),
        triangles_per_undecided: over(&|scores| scores.edges.and_then(|edges| edges.did.triangles_per_undecided)),
        caster_split_pairs: cost(|cost| cost.caster_split_pairs),
        draws: cost(|cost| cost.draws),
        triangles: cost(|cost| cost.triangles),
        by_depth: by_depth.collect(),
    }
}

/// Computes the seam score from all views. A seam needs pixels, not edges, so views that do not
/// count are included.
fn seam_ratio(number: usize, views: &[ViewReport]) -> Option<f64> {
    let mut sum = Seams::default();
    views.iter().for_each(|view| sum += view.scores[number].seams.counts);
    sum.ratio().filter(|ratio| sum.counts() && ratio.is_finite())
}

/// Compares every technique with every later one, over the views that count.
pub fn pairs(labels: &[String], views: &[ViewReport]) -> Result<Vec<PairReport>> {
    let counting: Vec<&ViewReport> = views.iter().filter(|view| view.counts).collect();
    let mut pairs = Vec::new();
    for first in 0..labels.len() {
        for second in first + 1..labels.len() {
            let both = counting.iter().filter_map(|view| view.scores[first].e.zip(view.scores[second].e));
            let (a, b): (Vec<f64>, Vec<f64>) = both.unzip();
            if a.is_empty() {
                continue;
            }
            let result = paired(&a, &b)?;
            pairs.push(PairReport {
                first: labels[first].clone(),
                second: labels[second].clone(),
                views: result.views(),
                mean_difference: result.mean_difference,
                standard_error: result.standard_error,
                first_better: result.first_better,
                second_better: result.second_better,
                ties: result.ties,
            });
        }
    }
    Ok(pairs)
}

/// Computes the memory at [`LIMIT`] of every technique that was measured at two sizes or more.
pub fn families(techniques: &[TechniqueReport]) -> Result<Vec<FamilyReport>> {
    let mut families = Vec::new();
    for (number, technique) in techniques.iter().enumerate() {
        if techniques[..number].iter().any(|earlier| earlier.family == technique.family) {
            continue;
        }
        let of_family = techniques[number..].iter().filter(|other| other.family == technique.family);
        let measured: Vec<(f64, f64)> =
            of_family.filter_map(|other| other.mean.e.map(|e| (other.texels as f64, e))).collect();
        if measured.len() < 2 {
            continue;
        }
        let (bound, texels) = match memory_at(&measured, LIMIT)? {
            MemoryAt::AtMost(texels) => ("at most", texels),
            MemoryAt::About(texels) => ("about", texels),
            MemoryAt::MoreThan(texels) => ("more than", texels),
        };
        families.push(FamilyReport { family: technique.family.clone(), bound, texels });
    }
    Ok(families)
}

/// Returns the mean; `None` without values.
pub fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.fold((0_u32, 0.0), |(count, sum), value| (count + 1, sum + value));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(counts: bool, errors: &[f64]) -> ViewReport {
        ViewReport {
            scene: "s".into(),
            camera: CameraReport {
                name: "c".into(),
                eye: [0.0; 3],
                forward: [0.0; 3],
                up: [0.0; 3],
                fov: None,
                near: 1.0,
                far: None,
            },
            frame: None,
            sun_name: "own".into(),
            sun: None,
            options: Vec::new(),
            range_m: [1.0, 2.0],
            scored_pixels: 1,
            true_edges: 1,
            counts,
            scores: errors.iter().map(|&e| Scores { e: Some(e), ..Scores::default() }).collect(),
        }
    }

    #[test]
    fn views_that_do_not_count_are_in_no_mean_and_no_comparison() {
        let views = [view(true, &[0.1, 0.2]), view(false, &[0.9, 0.0]), view(true, &[0.3, 0.2])];
        let first = means(0, &views, &[]);
        assert_eq!((first.views, first.e.map(|e| (e * 1e9).round())), (2, Some(2e8)));
        assert_eq!((first.flicker, first.texel_px), (None, None));
        let pairs = pairs(&["a".into(), "b".into()], &views).expect("pairs");
        assert_eq!(pairs.len(), 1);
        assert_eq!((pairs[0].views, pairs[0].first_better, pairs[0].second_better), (2, 1, 1));
        assert!(pairs[0].mean_difference.abs() < 1e-12);
    }

    #[test]
    fn a_technique_does_not_differ_from_itself() {
        let views = [view(true, &[0.1, 0.1]), view(true, &[0.3, 0.3])];
        let pairs = pairs(&["a".into(), "a #2".into()], &views).expect("pairs");
        assert_eq!((pairs[0].mean_difference, pairs[0].ties), (0.0, 2));
    }

    #[test]
    fn without_a_view_that_counts_there_is_no_mean() {
        let views = [view(false, &[0.1, 0.2])];
        assert_eq!(means(0, &views, &[]), Means::default());
        assert!(pairs(&["a".into(), "b".into()], &views).expect("pairs").is_empty());
    }

    #[test]
    fn families_need_two_sizes() {
        let technique = |family: &str, texels, e| TechniqueReport {
            label: String::new(),
            spec: String::new(),
            family: family.into(),
            options: Vec::new(),
            texels,
            bytes: 4 * texels,
            mean: Means { e: Some(e), ..Means::default() },
        };
        let techniques = [technique("a", 1000, 0.01), technique("b", 1000, 0.5), technique("a", 4000, 0.0025)];
        let families = families(&techniques).expect("families");
        assert_eq!(families.len(), 1);
        assert_eq!((families[0].family.as_str(), families[0].bound), ("a", "about"));
        assert!((families[0].texels - 2000.0).abs() < 1.0, "{}", families[0].texels);
    }
}
