//! Scores of shadow techniques. They count wrong decisions at world points, not differences of
//! shaded pixels.
//!
//! A [`Domain`] is the ground truth of one frame, an [`Answers`] the technique's visibilities. All
//! scores take both.
//!
//! # Definitions
//! Frame k, light direction l (towards the light), W × H pixels, one ray through each pixel centre;
//! `p` is the first hit, `n_g` its geometric normal turned towards the eye, `z` its view depth.
//! **Ω_f** ([`Domain`]) are the pixels with a hit, `n_g·l > 0.02` and `z` inside the shadowed range
//! `[n, f]`. **V\*** is the truth, **V̂** in `[0, 1]` the technique's answer; the hard decision is
//! `V̂ ≥ ½`. A pixel of Ω_f that the technique's image leaves transparent counts as a wrong
//! decision everywhere.
//!
//! | name | formula | here |
//! |---|---|---|
//! | E | `(1/│Ω_f│) Σ │[V̂ ≥ ½] − V*│`, split into `E_fs` (false shadow: acne) and `E_fl` (false light: leaks) | [`mis_shadowed`] |
//! | acne, leak | E_fs and E_fl without the pixels that lie up to `2 + 1.5 m` pixels from B*: shadow where no edge is, and light where none is | [`acne_and_leak`] |
//! | E_log | mean over 8 equal bins of ln z in `[n, f]`, those with at least 200 pixels of Ω_f, of E in the bin | [`by_depth`] |
//! | B(V) | pixels with a right or lower neighbour, both in Ω_f, `│Δz│` < 5 % of the nearer z, V different | [`Domain::edges`] |
//! | D | `(Σ_{B*} min(d(x, B̂), 64) + Σ_{B̂} min(d(x, B*), 64)) / (│B*│ + │B̂│)` pixels, d exact; 95th percentile | [`edge_distance`] |
//! | m | `1/σ_min(J)`, `J = ∂(texel)/∂(pixel)` at p through the receiver's plane | [`texel_footprint`] |
//! | m_p | `t_w H / (2 z tan(fov_y/2))`, t_w the texel's larger edge in metres | [`texel_footprint`] |
//! | F | `mean_k │{p in P_k: V̂_k(p) ≠ V̂_{k+1}(p)}│ / │P_k│`, P_k: the points of Ω_f of frame k that lie in frame k + 1's frustum cut by 3 % at each border | [`Flicker`] |
//! | F_edge | `F · │Ω_f│/│B*│`; both counts are summed over the path | [`Flicker::per_edge`] |
//! | seam | E within 2 px of a split's border over the larger E of both sides at 3 to 12 px; at most 1.1, pooled over 2,000 pixels or more | [`seams`] |
//! | E_soft, E_pen | `mean │V̂ − V*_A│` over Ω_f, and over its part with `0.02 < V*_A < 0.98` | [`soft_error`] |
//!
//! A view counts only if `│B*│ ≥ 2000` ([`Domain::counts_as_view`]); techniques are compared per
//! view ([`paired`]), and one number for a technique is the memory at which E falls to 0.5 %
//! ([`memory_at`]). Image metrics ([`similarity`]) are for information and never gate.
//!
//! The measures and their limits are this project's own. m follows Lloyd et al., "Warping and
//! Partitioning for Low Error Shadow Maps" (2006).

mod acne;
mod answers;
mod compare;
mod depth;
mod domain;
mod edges;
mod flicker;
mod footprint;
mod picture;
mod rate;
mod seams;
mod similarity;
mod soft;
mod stats;

pub use acne::{AcneAndLeak, EDGE_PIXELS, EDGE_TEXELS, acne_and_leak};
pub use answers::Answers;
pub use compare::{MemoryAt, Paired, memory_at, paired};
pub use depth::{ByDepth, DepthBin, LEAST_PIXELS_IN_BIN, by_depth};
pub use domain::{Domain, LEAST_EDGES, LEAST_FACING};
pub use edges::{EDGE_DISTANCE_CAP, EdgeDistance, edge_distance};
pub use flicker::{BORDER_CUT, Flicker, FlickerFrame, FramePair, flicker_along, shared_points};
pub use footprint::{Footprint, TexelGradient, texel_footprint};
pub use picture::{false_colour, false_colour_soft};
pub use rate::{MisShadowed, mis_shadowed};
pub use seams::{BESIDE_PX, LEAST_SEAM_PIXELS, MOST_RATIO, SEAM_PX, Seams, seams};
pub use similarity::{Similarity, similarity};
pub use soft::{SoftError, soft_error};

#[cfg(test)]
mod tests;
