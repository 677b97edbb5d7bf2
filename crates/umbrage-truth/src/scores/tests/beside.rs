//! Comparing techniques, and the image metrics beside.

use image::{Rgb, RgbImage};

use crate::Error;
use crate::scores::{MemoryAt, memory_at, paired, similarity};

#[test]
fn paired_differences_by_hand() {
    let result = paired(&[1.0, 2.0, 3.0, 4.0], &[2.0, 2.0, 5.0, 3.0]).unwrap();
    assert_eq!((result.first_better, result.second_better, result.ties, result.views()), (2, 1, 1, 4));
    assert!((result.mean_difference + 0.5).abs() < 1e-15);
    // Differences −1, 0, −2, 1: sample variance 5/3, over four views.
    assert!((result.standard_error.unwrap() - (5.0_f64 / 12.0).sqrt()).abs() < 1e-15);
    assert_eq!(paired(&[1.0], &[0.5]).unwrap().standard_error, None);
}

#[test]
fn paired_lists_must_match() {
    assert!(matches!(paired(&[1.0], &[1.0, 2.0]), Err(Error::SizeMismatch { .. })));
    assert!(matches!(paired(&[], &[]), Err(Error::NothingToScore(_))));
    assert!(matches!(paired(&[f64::NAN], &[1.0]), Err(Error::InvalidSetting { .. })));
}

#[test]
fn memory_is_found_between_measurements() {
    // Error falls with the root of memory: 2 % at 1 Mtexel, 1 % at 4, 0.5 % at 16, 0.25 % at 64.
    let law = |memory: f64| (memory, 0.02 / memory.sqrt());
    let about = |measured: &[(f64, f64)]| match memory_at(measured, 0.005).unwrap() {
        MemoryAt::About(memory) => memory,
        other => panic!("{other:?}"),
    };
    assert!((about(&[law(64.0), law(1.0), law(4.0)]) - 16.0).abs() < 1e-9);
    assert!((about(&[law(10.0), law(20.0)]) - 16.0).abs() < 1e-9);
    assert_eq!(memory_at(&[law(1.0), law(4.0)], 0.005).unwrap(), MemoryAt::MoreThan(4.0));
    assert_eq!(memory_at(&[law(64.0), law(100.0)], 0.005).unwrap(), MemoryAt::AtMost(64.0));
    // The first time that the limit is met counts, and an error of 0 is no obstacle.
    assert!((1.0..4.0).contains(&about(&[(1.0, 0.02), (4.0, 0.0), (16.0, 0.01)])));
    assert!(memory_at(&[], 0.005).is_err());
    assert!(memory_at(&[(0.0, 0.1)], 0.005).is_err());
    assert!(memory_at(&[(1.0, f64::NAN)], 0.005).is_err());
    assert!(memory_at(&[law(1.0)], 0.0).is_err());
}

fn stripes(shift: u32, invert: bool) -> RgbImage {
    RgbImage::from_fn(64, 48, |x, _| {
        let light = ((x + shift) / 16).is_multiple_of(2);
        Rgb([if light == invert { 20 } else { 220 }; 3])
    })
}

#[test]
fn image_metrics_know_same_from_different() {
    let reference = stripes(0, false);
    let same = similarity(&reference, &reference).unwrap();
    assert_eq!(same.ssim, 1.0);
    let shifted = similarity(&reference, &stripes(2, false)).unwrap();
    let inverted = similarity(&reference, &stripes(0, true)).unwrap();
    assert!(shifted.ssim < 0.95 && inverted.ssim < shifted.ssim, "{shifted:?} {inverted:?}");
    if cfg!(feature = "flip") {
        assert_eq!(same.flip, Some(0.0));
        assert!(shifted.flip > Some(0.02) && inverted.flip > shifted.flip, "{shifted:?} {inverted:?}");
    }
    let mut one_wrong = reference.clone();
    one_wrong.put_pixel(30, 30, Rgb([255, 0, 0]));
    let wrong = similarity(&reference, &one_wrong).unwrap();
    assert!(wrong.ssim < 1.0 && wrong.flip != same.flip.filter(|_| cfg!(feature = "flip")) || wrong.flip.is_none());
    assert!(matches!(similarity(&reference, &RgbImage::new(64, 47)), Err(Error::SizeMismatch { .. })));
    assert!(matches!(similarity(&RgbImage::new(0, 0), &RgbImage::new(0, 0)), Err(Error::NothingToScore(_))));
}
