//! E_soft and E_pen.

use super::frames::{answers, domain, edge_at, mask, nothing};
use crate::SoftTruth;
use crate::scores::{Answers, false_colour_soft, soft_error};

/// A ramp from dark to lit over ten pixels.
fn ramp() -> (crate::TruthMask, SoftTruth) {
    let values = [0.0, 0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.99, 1.0, 1.0];
    let hard = mask([10, 1], |x, _| Some((10.0, values[x] >= 0.5)));
    (hard, SoftTruth::from_values([10, 1], values.iter().map(|&v| Some(v)).collect()))
}

#[test]
fn differences_are_averaged_over_all_and_over_the_penumbra() {
    let (hard, soft) = ramp();
    let domain = domain(&hard);
    let same = Answers::from_pixels([10, 1], soft.visibility().to_vec()).unwrap();
    let score = soft_error(&domain, &soft, &same).unwrap();
    assert_eq!((score.whole, score.penumbra, score.pixels, score.penumbra_pixels), (0.0, Some(0.0), 10, 4));
    // The hard answer is off by 0.01 + 0.1 + 0.3 + 0.5 + 0.3 + 0.01, most of it in the penumbra.
    let score = soft_error(&domain, &soft, &answers(&hard)).unwrap();
    assert!((score.whole - 0.122).abs() < 1e-6, "{}", score.whole);
    assert!((score.penumbra.unwrap() - 0.3).abs() < 1e-6, "{:?}", score.penumbra);
    assert_eq!(soft_error(&domain, &soft, &nothing([10, 1])).unwrap().whole, 1.0);
}

#[test]
fn a_hard_scene_has_no_penumbra_and_wrong_sizes_are_refused() {
    let hard = edge_at([10, 1], 4);
    let soft = SoftTruth::from_values([10, 1], (0..10).map(|x| Some(if x >= 4 { 1.0 } else { 0.0 })).collect());
    let score = soft_error(&domain(&hard), &soft, &answers(&hard)).unwrap();
    assert_eq!((score.whole, score.penumbra), (0.0, None));
    let small = SoftTruth::from_values([9, 1], vec![Some(1.0); 9]);
    assert!(soft_error(&domain(&hard), &small, &answers(&hard)).is_err());
    assert!(soft_error(&domain(&hard), &soft, &answers(&edge_at([9, 1], 4))).is_err());
    assert!(false_colour_soft(&small, &domain(&hard), &answers(&hard)).is_err());
}

#[test]
fn soft_colours_are_as_strong_as_the_difference() {
    let (hard, soft) = ramp();
    let picture = false_colour_soft(&soft, &domain(&hard), &answers(&hard)).unwrap();
    let at = |x: u32| picture.get_pixel(x, 0).0.map(i32::from);
    assert!(at(0)[0] == at(0)[2], "right and grey");
    assert!(at(4)[2] > at(4)[0], "too dark is blue: {:?}", at(4));
    assert!(at(5)[0] > at(5)[2], "too light is red: {:?}", at(5));
    assert!(at(5)[0] - at(5)[2] > at(6)[0] - at(6)[2], "and redder where it is off by more");
}
