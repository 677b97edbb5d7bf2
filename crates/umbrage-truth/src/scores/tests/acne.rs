//! Acne and leak.

use glam::{DVec2, DVec3};
use umbrage::{Frustum, View};

use super::frames::{answers, domain, edge_at, inverted, nothing};
use crate::TruthMask;
use crate::scores::{AcneAndLeak, Answers, TexelGradient, acne_and_leak};

/// View from straight above: a pixel shows a metre, and m is the texel in metres.
fn view([width, height]: [usize; 2]) -> View {
    let lens = Frustum::orthographic(width as f64, height as f64, 0.1, 100.0).expect("a lens");
    View::look_at(DVec3::Y * 10.0, DVec3::ZERO, DVec3::NEG_Z, lens).expect("a view")
}

fn score(truth: &TruthMask, answers: &Answers, texel: Option<f64>) -> AcneAndLeak {
    let map = |_, _| texel.map(|texel| TexelGradient::orthographic(DVec3::X, DVec3::Z, DVec2::splat(texel)));
    acne_and_leak(&view(truth.size()), truth, &domain(truth), answers, map).expect("a score")
}

/// The truth with single pixels of row 20 decided otherwise.
fn with_wrong(truth: &TruthMask, columns: impl IntoIterator<Item = u32>) -> Answers {
    let mut image = truth.to_image();
    for x in columns {
        let pixel = image.get_pixel_mut(x, 20);
        pixel.0[0] = 255 - pixel.0[0];
    }
    Answers::from_mask(&image)
}

#[test]
fn the_truth_has_neither() {
    let truth = edge_at([60, 40], 25);
    let right = score(&truth, &answers(&truth), Some(1.0));
    assert_eq!((right.acne, right.leak, right.wrong.len()), (0, 0, 0));
    // Edge pixels are in column 24; 2 + 1.5 pixels on both sides of it are the edge's.
    assert_eq!((right.pixels, right.beyond), (2400, 40 * (60 - 7)));
}

#[test]
fn a_wrong_pixel_counts_from_just_beyond_the_edge() {
    let truth = edge_at([100, 40], 50);
    for (texel, reach) in [(None, 2), (Some(1.0), 3), (Some(4.1), 8), (Some(10.1), 17)] {
        let at = |x: u32| {
            let score = score(&truth, &with_wrong(&truth, [x]), texel);
            (score.acne, score.leak)
        };
        assert_eq!(at(49 + reach), (0, 0), "{texel:?}");
        assert_eq!(at(49 + reach + 1), (1, 0), "{texel:?}");
        assert_eq!(at(49 - reach), (0, 0), "{texel:?}");
        assert_eq!(at(49 - reach - 1), (0, 1), "{texel:?}");
    }
}

#[test]
fn stripes_on_lit_ground_are_acne_and_holes_in_shadow_leak() {
    let truth = edge_at([60, 40], 25);
    let stripes = score(&truth, &with_wrong(&truth, (40..60).step_by(2)), Some(1.0));
    assert_eq!((stripes.acne, stripes.leak), (10, 0));
    assert_eq!(stripes.acne_rate(), 10.0 / 2400.0);
    assert_eq!(stripes.acne_rate_beyond(), 10.0 / stripes.beyond as f64);
    let holes = score(&truth, &with_wrong(&truth, 0..8), Some(1.0));
    assert_eq!((holes.acne, holes.leak, holes.leak_rate()), (0, 8, 8.0 / 2400.0));
    assert_eq!((holes.acne_rate_beyond(), holes.leak_rate_beyond()), (0.0, 8.0 / holes.beyond as f64));
    assert_eq!(holes.wrong, (0..8).map(|x| 20 * 60 + x).collect::<Vec<_>>());
    let all = score(&truth, &inverted(&truth), Some(1.0));
    assert_eq!(all.acne + all.leak, all.beyond);
    let blank = score(&truth, &nothing([60, 40]), Some(1.0));
    assert_eq!(blank.acne + blank.leak, blank.beyond, "no answer is a wrong one");
}

#[test]
fn coarse_texels_hide_nothing_silently() {
    // A map that explains every error leaves nothing to judge, and says so.
    let truth = edge_at([60, 40], 25);
    let coarse = score(&truth, &inverted(&truth), Some(100.0));
    assert_eq!((coarse.acne, coarse.leak, coarse.beyond_rate()), (0, 0, 0.0));
    assert_eq!((coarse.acne_rate_beyond(), coarse.leak_rate_beyond()), (0.0, 0.0));
}

#[test]
fn other_sizes_are_refused() {
    let (truth, other) = (edge_at([60, 40], 25), edge_at([40, 60], 25));
    let of =
        |mask: &TruthMask, given: &Answers| acne_and_leak(&view([60, 40]), mask, &domain(&truth), given, |_, _| None);
    assert!(of(&truth, &answers(&other)).is_err());
    assert!(of(&other, &answers(&truth)).is_err());
}
