//! F: the share of decisions that flip when only the camera moves.

use glam::DVec3;
use umbrage::View;

use super::answers::{check_visibilities, is_lit};
use super::domain::check_size;
use super::{Answers, Domain};
use crate::{Error, Result, Truth, TruthMask};

/// Share of the next frame that is cut off at each border.
pub const BORDER_CUT: f64 = 0.03;

/// Flips along a camera path, summed over pairs of frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flicker {
    rates: Vec<f64>,
    scored: usize,
    edges: usize,
}

/// Answers of two neighbouring frames at the same world points P_k.
#[derive(Clone, Copy, Debug)]
pub struct FramePair<'a> {
    /// Scored pixels of frame k.
    pub domain: &'a Domain,
    /// Answers of frame k at P_k, V̂_k.
    pub now: &'a [f32],
    /// Answers of frame k + 1 at P_k, V̂_{k+1}.
    pub next: &'a [f32],
}

/// One frame of a path.
#[derive(Clone, Copy, Debug)]
pub struct FlickerFrame<'a> {
    /// Camera of the frame.
    pub view: &'a View,
    /// Ground truth of the frame.
    pub mask: &'a TruthMask,
    /// Scored pixels of the frame, Ω_f.
    pub domain: &'a Domain,
    /// Geometry of the frame, if objects move. Only points whose truth is the same in both frames
    /// are then kept.
    pub truth: Option<&'a Truth>,
}

impl Flicker {
    /// Counts one more pair of frames. A pair that shares no point is left out.
    ///
    /// # Errors
    /// [`Error::SizeMismatch`] if the two lists differ in length, [`Error::NotAVisibility`] for an
    /// answer outside `[0, 1]`.
    pub fn add(&mut self, pair: FramePair) -> Result<()> {
        check_size("the next frame's list of answers", [pair.next.len(), 1], [pair.now.len(), 1])?;
        check_visibilities("answer of this frame", pair.now.iter().copied().enumerate())?;
        check_visibilities("answer of the next frame", pair.next.iter().copied().enumerate())?;
        if !pair.now.is_empty() {
            let flips = pair.now.iter().zip(pair.next).filter(|&(&a, &b)| is_lit(a) != is_lit(b)).count();
            self.rates.push(flips as f64 / pair.now.len() as f64);
            self.scored += pair.domain.pixels().len();
            self.edges += pair.domain.edges().len();
        }
        Ok(())
    }

    /// Returns the number of pairs of frames counted.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.rates.len()
    }

    /// Returns F in `[0, 1]`; `None` without pairs.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        (!self.rates.is_empty()).then(|| self.rates.iter().sum::<f64>() / self.rates.len() as f64)
    }

    /// Returns F_edge, which may exceed 1; `None` if the path has no edge.
    #[must_use]
    pub fn per_edge(&self) -> Option<f64> {
        (self.edges > 0).then(|| self.rate().map(|rate| rate * self.scored as f64 / self.edges as f64))?
    }
}

/// Returns P_k as indices into the image: the pixels of Ω_f of a frame whose points lie in the next
/// frame's frustum, cut by 3 % at each border, and inside its shadowed range.
#[must_use]
pub fn shared_points(mask: &TruthMask, domain: &Domain, next: &View, next_range: (f64, f64)) -> Vec<usize> {
    let frustum = next.frustum();
    let (near, far) = (frustum.near.max(next_range.0), frustum.far.min(next_range.1));
    let inside = |value: f64, low: f64, high: f64| {
        let cut = BORDER_CUT * (high - low);
        (low + cut..=high - cut).contains(&value)
    };
    let stays = |&pixel: &usize| {
        mask.hits()[pixel].is_some_and(|hit| {
            let at = next.view_from_world_point(hit.position);
            let depth = -at.z;
            let scale = frustum.scale_at(depth);
            (near..=far).contains(&depth)
                && inside(at.x / scale, frustum.left, frustum.right)
                && inside(at.y / scale, frustum.bottom, frustum.top)
        })
    };
    domain.pixels().iter().copied().filter(stays).collect()
}

/// Computes F along a whole path. `probe` is the technique: for frame k (counted from 0) and world
/// points with normals, it returns V̂_k there. It is called twice for the points of frame k, once
/// in frame k and once in frame k + 1.
///
/// # Errors
/// Errors of `probe`, of [`Flicker::add`] and of [`Truth::visibility_at`];
/// [`Error::NothingToScore`] for fewer than two frames.
pub fn flicker_along<E: From<Error>>(
    frames: &[FlickerFrame],
    mut probe: impl FnMut(usize, &[(DVec3, DVec3)]) -> Result<Vec<f32>, E>,
) -> Result<Flicker, E> {
    if frames.len() < 2 {
        return Err(Error::NothingToScore("flicker needs two frames or more").into());
    }
    let mut flicker = Flicker::default();
    for (k, pair) in frames.windows(2).enumerate() {
        let (now, next) = (&pair[0], &pair[1]);
        check_size("the mask", now.mask.size(), now.domain.size())?;
        let mut points: Vec<_> = shared_points(now.mask, now.domain, next.view, next.domain.range())
            .into_iter()
            .filter_map(|pixel| now.mask.hits()[pixel].map(|hit| (hit.position, hit.normal)))
            .collect();
        if let (Some(truth_now), Some(truth_next)) = (now.truth, next.truth) {
            let before = truth_now.visibility_under(&points, now.mask.light())?;
            let after = truth_next.visibility_under(&points, next.mask.light())?;
            let mut same = before.iter().zip(&after).map(|(a, b)| a == b);
            points.retain(|_| same.next().unwrap_or(false));
        }
        let (first, second) = (probe(k, &points)?, probe(k + 1, &points)?);
        check_size("the probe's list of answers", [first.len(), 1], [points.len(), 1])?;
        flicker.add(FramePair { domain: now.domain, now: &first, next: &second })?;
    }
    Ok(flicker)
}

impl FramePair<'_> {
    /// Counts flips between whole images at the same pixels, which is [`Flicker`] for a camera that
    /// stands still.
    ///
    /// # Errors
    /// [`Error::SizeMismatch`] unless all three have one size.
    pub fn of_still_camera(domain: &Domain, now: &Answers, next: &Answers) -> Result<Flicker> {
        now.check(domain)?;
        next.check(domain)?;
        let values = |answers: &Answers| -> Vec<f32> {
            let decided = |&pixel: &usize| f32::from(u8::from(answers.decision(domain, pixel)));
            domain.pixels().iter().map(decided).collect()
        };
        let mut flicker = Flicker::default();
        flicker.add(FramePair { domain, now: &values(now), next: &values(next) })?;
        Ok(flicker)
    }
}
