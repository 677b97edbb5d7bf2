//! E, E_log, D and the domain they are taken over.

use glam::DVec3;
use image::{GrayAlphaImage, LumaA};

use super::frames::{RANGE, answers, domain, edge_at, inverted, mask, nothing};
use crate::scores::{
    Answers, Domain, EDGE_DISTANCE_CAP, LEAST_EDGES, MisShadowed, by_depth, edge_distance, false_colour, mis_shadowed,
};
use crate::{Error, Hit, TruthMask};

#[test]
fn the_truth_is_right() {
    let truth = edge_at([60, 40], 25);
    let domain = domain(&truth);
    let score = mis_shadowed(&domain, &answers(&truth)).unwrap();
    assert_eq!(score, MisShadowed { pixels: 2400, ..MisShadowed::default() });
    assert_eq!(score.rate(), 0.0);
    let distance = edge_distance(&domain, &answers(&truth)).unwrap().expect("there is an edge");
    assert_eq!((distance.mean, distance.p95, distance.true_edges, distance.answered_edges), (0.0, 0.0, 40, 40));
    assert_eq!(by_depth(&domain, &answers(&truth)).unwrap().mean(), Some(0.0));
}

#[test]
fn an_inverted_mask_is_all_wrong() {
    let truth = edge_at([60, 40], 25);
    let score = mis_shadowed(&domain(&truth), &inverted(&truth)).unwrap();
    assert_eq!(score.rate(), 1.0);
    assert_eq!((score.false_shadow, score.false_light, score.missing), (35 * 40, 25 * 40, 0));
    assert_eq!(by_depth(&domain(&truth), &inverted(&truth)).unwrap().mean(), Some(1.0));
    // Its edges are where they should be: D alone would be fooled, which is why it stands beside E.
    assert_eq!(edge_distance(&domain(&truth), &inverted(&truth)).unwrap().unwrap().mean, 0.0);
}

#[test]
fn a_shifted_mask_is_wrong_by_its_shift() {
    let size = [100, 40];
    let truth = edge_at(size, 25);
    for shift in [1, 3, 10] {
        let later = answers(&edge_at(size, 25 + shift));
        let score = mis_shadowed(&domain(&truth), &later).unwrap();
        assert_eq!((score.false_shadow, score.false_light), (shift * 40, 0));
        assert!((score.rate() - shift as f64 / 100.0).abs() < 1e-15);
        assert_eq!(score.false_shadow_rate(), score.rate());
        let distance = edge_distance(&domain(&truth), &later).unwrap().unwrap();
        assert_eq!((distance.mean, distance.p95), (shift as f64, shift as f64));
        let earlier = mis_shadowed(&domain(&truth), &answers(&edge_at(size, 25 - shift))).unwrap();
        assert_eq!((earlier.false_shadow, earlier.false_light), (0, shift * 40));
        assert_eq!(earlier.false_light_rate(), earlier.rate());
    }
}

#[test]
fn one_wrong_pixel_is_one_wrong_pixel() {
    let truth = edge_at([60, 40], 25);
    for (x, false_shadow, false_light) in [(50, 1, 0), (5, 0, 1)] {
        let mut image = truth.to_image();
        let pixel = image.get_pixel_mut(x, 20);
        pixel.0[0] = 255 - pixel.0[0];
        let wrong = Answers::from_mask(&image);
        let score = mis_shadowed(&domain(&truth), &wrong).unwrap();
        assert_eq!((score.false_shadow, score.false_light, score.pixels), (false_shadow, false_light, 2400));
        let distance = edge_distance(&domain(&truth), &wrong).unwrap().unwrap();
        // The pixel itself, its left and its upper neighbour are new edges.
        assert_eq!(distance.answered_edges, 43);
        let from_edge = (i64::from(x) - 24).abs() as f64;
        let expected = (2.0 * from_edge + (from_edge - 1.0 + if x < 24 { 2.0 } else { 0.0 })) / 83.0;
        assert!((distance.mean - expected).abs() < 1e-12, "{} {expected}", distance.mean);
    }
}

#[test]
fn a_blank_image_is_all_wrong() {
    let truth = edge_at([60, 40], 25);
    let score = mis_shadowed(&domain(&truth), &nothing([60, 40])).unwrap();
    assert_eq!((score.rate(), score.missing), (1.0, 2400));
    // A picture that is dark where it has nothing to say is not right in the shadow.
    assert_eq!(score.false_light, 25 * 40);
}

#[test]
fn wrong_sizes_are_refused_by_every_score() {
    let truth = edge_at([60, 40], 25);
    let domain = domain(&truth);
    for size in [[59, 40], [60, 41], [40, 60]] {
        let other = answers(&edge_at(size, 25));
        let refused = |error: Error| assert!(matches!(error, Error::SizeMismatch { .. }), "{error}");
        refused(mis_shadowed(&domain, &other).unwrap_err());
        refused(by_depth(&domain, &other).unwrap_err());
        refused(edge_distance(&domain, &other).unwrap_err());
        refused(false_colour(&truth, &domain, &other).unwrap_err());
        refused(false_colour(&edge_at(size, 25), &domain, &answers(&truth)).unwrap_err());
    }
    assert!(matches!(Answers::from_points(&domain, &[1.0; 7]).unwrap_err(), Error::SizeMismatch { .. }));
    assert!(matches!(Answers::from_pixels([2, 2], vec![None; 3]).unwrap_err(), Error::SizeMismatch { .. }));
}

#[test]
fn answers_outside_0_to_1_are_refused() {
    let truth = edge_at([3, 1], 1);
    for bad in [f32::NAN, -0.1, 1.1, f32::INFINITY] {
        let error = Answers::from_points(&domain(&truth), &[0.0, bad, 1.0]).unwrap_err();
        assert!(matches!(error, Error::NotAVisibility { index: 1, .. }), "{error}");
        let error = Answers::from_pixels([3, 1], vec![None, None, Some(bad)]).unwrap_err();
        assert!(matches!(error, Error::NotAVisibility { index: 2, .. }), "{error}");
    }
}

#[test]
fn an_empty_domain_has_no_score() {
    let sky = mask([4, 4], |_, _| None);
    let error = mis_shadowed(&domain(&sky), &answers(&sky)).unwrap_err();
    assert!(matches!(error, Error::NothingToScore(_)), "{error}");
    for range in [(0.0, 1.0), (2.0, 1.0), (1.0, f64::INFINITY), (f64::NAN, 1.0), (1.0, f64::NAN)] {
        assert!(Domain::new(&sky, range).is_err(), "{range:?}");
    }
}

#[test]
fn the_hard_decision_is_at_one_half() {
    let truth = mask([4, 1], |_, _| Some((10.0, true)));
    let values = Answers::from_points(&domain(&truth), &[0.0, 0.499_999, 0.5, 1.0]).unwrap();
    assert_eq!(mis_shadowed(&domain(&truth), &values).unwrap().false_shadow, 2);
    // 8 bits: 127 is dark, 128 is light.
    let image = GrayAlphaImage::from_fn(4, 1, |x, _| LumaA([[0, 127, 128, 255][x as usize], 255]));
    assert_eq!(mis_shadowed(&domain(&truth), &Answers::from_mask(&image)).unwrap().false_shadow, 2);
}

#[test]
fn only_pixels_that_face_the_light_in_range_are_scored() {
    let light = DVec3::Y;
    let hit = |facing: f64, depth: f64| {
        let normal = DVec3::new((1.0 - facing * facing).sqrt(), facing, 0.0);
        Some(Hit { position: DVec3::ZERO, normal, depth, object: 0, triangle: 0, lit: true })
    };
    let hits = vec![
        hit(1.0, 10.0),
        hit(0.021, 10.0),
        hit(0.019, 10.0),
        hit(-1.0, 10.0),
        hit(1.0, 0.99),
        hit(1.0, 1.0),
        hit(1.0, 1000.0),
        hit(1.0, 1000.1),
        None,
    ];
    let domain = domain(&TruthMask::from_hits([9, 1], light, hits).unwrap());
    assert_eq!(domain.pixels(), [0, 1, 5, 6]);
    assert!((0..9).all(|pixel| domain.contains(pixel) == domain.pixels().contains(&pixel)));
}

#[test]
fn edges_stay_on_one_surface() {
    // Columns: lit, dark | dark at another depth | lit at that depth | dark, 4 % deeper | gap |
    // lit.
    let row =
        [Some((10.0, true)), Some((10.0, false)), Some((20.0, true)), Some((20.8, false)), None, Some((20.0, true))];
    let truth = mask([6, 1], |x, _| row[x]);
    assert_eq!(domain(&truth).edges(), [0, 2]);
    // Two rows that differ: the upper one carries the edge.
    let truth = mask([3, 2], |_, y| Some((10.0, y == 0)));
    assert_eq!(domain(&truth).edges(), [0, 1, 2]);
    // The last column has no right neighbour in the next row.
    let truth = mask([2, 2], |x, y| Some((10.0, x == 1 && y == 0)));
    assert_eq!(domain(&truth).edges(), [0, 1]);
}

#[test]
fn a_view_counts_from_two_thousand_edges() {
    for (edges, counts) in [(LEAST_EDGES, true), (LEAST_EDGES - 1, false)] {
        let truth = edge_at([4, edges], 2);
        assert_eq!(domain(&truth).edges().len(), edges);
        assert_eq!(domain(&truth).counts_as_view(), counts);
    }
}

#[test]
fn missed_edges_cost_the_cap() {
    let truth = edge_at([300, 10], 25);
    let domain = domain(&truth);
    let all_lit = Answers::from_points(&domain, &vec![1.0; 3000]).unwrap();
    let distance = edge_distance(&domain, &all_lit).unwrap().unwrap();
    assert_eq!((distance.mean, distance.answered_edges), (EDGE_DISTANCE_CAP, 0));
    let far = edge_distance(&domain, &answers(&edge_at([300, 10], 200))).unwrap().unwrap();
    assert_eq!(far.mean, EDGE_DISTANCE_CAP);
    let lit = mask([300, 10], |_, _| Some((10.0, true)));
    assert_eq!(edge_distance(&super::frames::domain(&lit), &all_lit).unwrap(), None);
}

#[test]
fn depth_bins_weigh_the_same() {
    // 8 bins over 3 decades; row y lies in the middle of bin y, and the far rows are narrower.
    let widths = [1000, 900, 800, 700, 600, 500, 200, 199];
    let depth = |y: usize| 1000_f64.powf((y as f64 + 0.5) / 8.0);
    let truth = mask([1000, 8], |x, y| (x < widths[y]).then(|| (depth(y), true)));
    let domain = domain(&truth);
    assert_eq!(domain.range(), RANGE);
    // Row 1 is a tenth wrong, row 6 half, row 7 wholly, but it is too small to have a say.
    let wrong = |x: usize, y: usize| (y == 1 && x < 90) || (y == 6 && x < 100) || y == 7;
    let values: Vec<f32> = domain.pixels().iter().map(|&p| f32::from(u8::from(!wrong(p % 1000, p / 1000)))).collect();
    let scores = by_depth(&domain, &Answers::from_points(&domain, &values).unwrap()).unwrap();
    for (bin, width) in scores.bins.iter().zip(widths) {
        assert_eq!(bin.score.pixels, width);
    }
    assert!((scores.bins[0].near - 1.0).abs() < 1e-12 && (scores.bins[7].far - 1000.0).abs() < 1e-9);
    assert!((scores.mean().unwrap() - (0.1 + 0.5) / 7.0).abs() < 1e-12);
    // Depths at the very ends of the range fall into the first and the last bin.
    let ends = mask([2, 1], |x, _| Some(([1.0, 1000.0][x], true)));
    let scores = by_depth(&super::frames::domain(&ends), &answers(&ends)).unwrap();
    assert_eq!((scores.bins[0].score.pixels, scores.bins[7].score.pixels), (1, 1));
    assert_eq!(scores.mean(), None);
}

#[test]
fn leaks_are_red_and_acne_is_blue() {
    let truth = mask([5, 1], |x, _| {
        [Some((10.0, true)), Some((10.0, false)), Some((10.0, true)), Some((10.0, false)), None][x]
    });
    let domain = domain(&truth);
    let picture =
        false_colour(&truth, &domain, &Answers::from_points(&domain, &[1.0, 0.0, 0.0, 1.0]).unwrap()).unwrap();
    let at = |x: u32| picture.get_pixel(x, 0).0;
    for x in 0..2 {
        assert!(at(x).iter().all(|&c| c == at(x)[0]), "what is right is grey");
    }
    assert!(at(0)[0] > at(1)[0], "light is lighter");
    assert!(at(2)[2] > 200 && at(2)[0] < 60, "acne {:?}", at(2));
    assert!(at(3)[0] > 200 && at(3)[2] < 60, "leak {:?}", at(3));
    assert_eq!(at(4), [0; 3]);
}
