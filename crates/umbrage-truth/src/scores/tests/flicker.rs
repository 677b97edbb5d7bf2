//! F and F_edge.

use glam::{DAffine3, DVec3};
use umbrage::{Frustum, View};

use super::frames::{answers, domain, edge_at, inverted};
use crate::scores::{Domain, Flicker, FlickerFrame, FramePair, flicker_along, shared_points};
use crate::tests::scenes::{Shape, Stage};
use crate::{Error, Truth, TruthMask};

const SUN: DVec3 = DVec3::new(0.5, -1.0, 0.3);

struct Frame {
    view: View,
    mask: TruthMask,
    domain: Domain,
    truth: Truth,
}

impl Frame {
    /// A camera that looks straight down on a floor from height 10 at x, 20 x 10 m in 200 x 100
    /// pixels, with a roof of 2 x 2 m at height 2 over `roof`.
    fn new(x: f64, roof: f64) -> Self {
        let mut stage = Stage::default();
        stage.add(Shape::floor(500.0, 0.0), DAffine3::IDENTITY);
        stage.add(Shape::floor(1.0, 2.0), DAffine3::from_translation(DVec3::new(roof, 0.0, 0.0)));
        let frustum = Frustum::orthographic(20.0, 10.0, 1.0, 50.0).unwrap();
        let view = View::look_at_upright(DVec3::new(x, 10.0, 0.0), DVec3::new(x, 0.0, 0.0), frustum).unwrap();
        let truth = stage.truth(view.eye());
        let mask = truth.mask(&view, SUN, [200, 100], &|_| {}).unwrap();
        let domain = Domain::new(&mask, (1.0, 50.0)).unwrap();
        Self { view, mask, domain, truth }
    }

    fn still(&self) -> FlickerFrame<'_> {
        FlickerFrame { view: &self.view, mask: &self.mask, domain: &self.domain, truth: None }
    }

    fn moving(&self) -> FlickerFrame<'_> {
        FlickerFrame { truth: Some(&self.truth), ..self.still() }
    }
}

type Points<'a> = &'a [(DVec3, DVec3)];

#[test]
fn shared_points_are_those_that_stay_inside_the_cut_frame() {
    let (a, b) = (Frame::new(0.0, 0.0), Frame::new(3.0, 0.0));
    let kept = shared_points(&a.mask, &a.domain, &b.view, b.domain.range());
    // Frame b sees x from −7 to 13; the cut leaves −6.4 to 12.4 and z from −4.7 to 4.7. Frame a
    // ends at x = 10.
    let expected: Vec<usize> = (a.domain.pixels().iter().copied())
        .filter(|pixel| {
            let x = (pixel % 200) as f64 * 0.1 + 0.05 - 10.0;
            let z = (pixel / 200) as f64 * 0.1 + 0.05 - 5.0;
            (-6.4..=12.4).contains(&x) && z.abs() <= 4.7
        })
        .collect();
    assert_eq!(kept, expected);
    assert_eq!(kept.len(), 164 * 94);
    // What leaves the shadowed range is not shared either: the floor lies 10 m deep, the roof 8 m.
    let roof = shared_points(&a.mask, &a.domain, &b.view, (1.0, 9.0));
    assert!(!roof.is_empty() && roof.iter().all(|&pixel| (a.domain.depth(pixel) - 8.0).abs() < 1e-9));
}

#[test]
fn an_answer_fixed_to_the_world_does_not_flicker() {
    let frames = [0.0, 0.37, 1.1].map(|x| Frame::new(x, 0.0));
    let path: Vec<_> = frames.iter().map(Frame::still).collect();
    let checks = |_: usize, points: Points| -> Result<Vec<f32>, Error> {
        Ok(points.iter().map(|(p, _)| f32::from(u8::from((p.x * 3.0).sin() > 0.0))).collect())
    };
    let flicker = flicker_along(&path, checks).unwrap();
    assert_eq!((flicker.pairs(), flicker.rate(), flicker.per_edge()), (2, Some(0.0), Some(0.0)));
}

#[test]
fn an_answer_fixed_to_the_frame_flips() {
    let frames = [0.0, 0.5, 1.0].map(|x| Frame::new(x, 0.0));
    let path: Vec<_> = frames.iter().map(Frame::still).collect();
    let blinks =
        |frame: usize, points: Points| -> Result<Vec<f32>, Error> { Ok(vec![(frame % 2) as f32; points.len()]) };
    let flicker = flicker_along(&path, blinks).unwrap();
    assert_eq!(flicker.rate(), Some(1.0));
    let scored: usize = frames[..2].iter().map(|f| f.domain.pixels().len()).sum();
    let edges: usize = frames[..2].iter().map(|f| f.domain.edges().len()).sum();
    assert!(edges > 50);
    assert_eq!(flicker.per_edge(), Some(scored as f64 / edges as f64));
    // Soft changes that do not cross one half are no flips.
    let breathes = |frame: usize, points: Points| -> Result<Vec<f32>, Error> {
        Ok(vec![0.5 + 0.4 * frame as f32 / 2.0; points.len()])
    };
    assert_eq!(flicker_along(&path, breathes).unwrap().rate(), Some(0.0));
}

#[test]
fn where_the_truth_changed_nothing_is_asked() {
    let frames = [Frame::new(0.0, 0.0), Frame::new(0.0, 5.0)];
    let exact = |frame: usize, points: Points| frames[frame].truth.visibility_at(points, SUN);
    let moving: Vec<_> = frames.iter().map(Frame::moving).collect();
    assert_eq!(flicker_along(&moving, exact).unwrap().rate(), Some(0.0));
    // Taken for a still world the moving shadow looks like flicker.
    let still: Vec<_> = frames.iter().map(Frame::still).collect();
    assert!(flicker_along(&still, exact).unwrap().rate().unwrap() > 0.02);
}

#[test]
fn broken_probes_are_refused() {
    let frames = [Frame::new(0.0, 0.0), Frame::new(0.5, 0.0)];
    let path: Vec<_> = frames.iter().map(Frame::still).collect();
    let short = |_: usize, points: Points| -> Result<Vec<f32>, Error> { Ok(vec![1.0; points.len() - 1]) };
    assert!(matches!(flicker_along(&path, short), Err(Error::SizeMismatch { .. })));
    let nan = |_: usize, points: Points| -> Result<Vec<f32>, Error> { Ok(vec![f32::NAN; points.len()]) };
    assert!(matches!(flicker_along(&path, nan), Err(Error::NotAVisibility { .. })));
    let one = |_: usize, points: Points| -> Result<Vec<f32>, Error> { Ok(vec![1.0; points.len()]) };
    assert!(matches!(flicker_along(&path[..1], one), Err(Error::NothingToScore(_))));
}

#[test]
fn pairs_are_averaged_and_empty_ones_left_out() {
    let truth = edge_at([10, 10], 5);
    let domain = domain(&truth);
    let mut flicker = Flicker::default();
    assert_eq!((flicker.rate(), flicker.per_edge()), (None, None));
    flicker.add(FramePair { domain: &domain, now: &[0.0, 1.0], next: &[1.0, 1.0] }).unwrap();
    flicker.add(FramePair { domain: &domain, now: &[0.0; 4], next: &[0.0; 4] }).unwrap();
    flicker.add(FramePair { domain: &domain, now: &[], next: &[] }).unwrap();
    assert_eq!((flicker.pairs(), flicker.rate()), (2, Some(0.25)));
    assert_eq!(flicker.per_edge(), Some(0.25 * 100.0 / 10.0));
    assert!(flicker.add(FramePair { domain: &domain, now: &[0.0], next: &[0.0, 0.0] }).is_err());

    let still = FramePair::of_still_camera(&domain, &answers(&truth), &answers(&truth)).unwrap();
    assert_eq!(still.rate(), Some(0.0));
    assert_eq!(FramePair::of_still_camera(&domain, &answers(&truth), &inverted(&truth)).unwrap().rate(), Some(1.0));
}
