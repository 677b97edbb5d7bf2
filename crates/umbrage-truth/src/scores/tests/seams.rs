//! Tests of the seam score, and of cases in which it fails.

use super::frames::{domain, mask};
use crate::scores::{Answers, Domain, LEAST_SEAM_PIXELS, Seams, seams};

const SIZE: [usize; 2] = [700, 60];
const BORDER: f64 = 20.0;
/// Depth grows by 0.2 m a row: the border lies between rows 29 and 30. Shadow and light alternate
/// along it.
fn ground() -> Domain {
    domain(&mask(SIZE, |x, y| Some((14.1 + 0.2 * y as f64, x % 4 < 2))))
}

/// Returns the true answers, wrong wherever `wrong` is true.
fn answers(domain: &Domain, wrong: impl Fn(usize, usize) -> bool) -> Answers {
    let visibility = |pixel: usize| {
        let lit = domain.lit(pixel) != wrong(pixel % SIZE[0], pixel / SIZE[0]);
        Some(f32::from(u8::from(lit)))
    };
    Answers::from_pixels(SIZE, (0..SIZE[0] * SIZE[1]).map(visibility).collect()).unwrap()
}

fn score(wrong: impl Fn(usize, usize) -> bool) -> Seams {
    let domain = ground();
    seams(&domain, &answers(&domain, wrong), &[BORDER], |pixel| domain.depth(pixel)).unwrap()
}

#[test]
fn rows_are_counted_where_they_belong() {
    let found = score(|_, y| y == 29);
    // The middles of rows 28 to 31 lie within two pixels of the border between 29 and 30.
    assert_eq!((found.seam.pixels, found.seam.false_shadow + found.seam.false_light), (4 * 700, 700));
    // Rows 18 to 26 and 33 to 41.
    assert_eq!((found.nearer.pixels, found.farther.pixels), (9 * 700, 9 * 700));
    assert_eq!((found.nearer.rate(), found.farther.rate()), (0.0, 0.0));
    let near_side = score(|_, y| y == 26);
    assert_eq!((near_side.nearer.rate(), near_side.farther.rate(), near_side.seam.rate()), (1.0 / 9.0, 0.0, 0.0));
}

#[test]
fn even_errors_are_no_seam() {
    for wrong in
        [|x: usize, y: usize| (x + 3 * y).is_multiple_of(10), |x: usize, y: usize| y >= 29 && x.is_multiple_of(7)]
    {
        let found = score(wrong);
        assert_eq!(found.are_hidden(), Some(true), "{found:?}");
    }
    assert_eq!(score(|_, _| false).ratio(), None);
    assert_eq!(score(|_, _| false).are_hidden(), Some(true));
}

#[test]
fn a_line_of_wrong_pixels_is_a_seam() {
    // One row in a hundred pixels, on ground that is 1 % wrong everywhere.
    let found = score(|x, y| (x + 3 * y).is_multiple_of(100) || (y == 29 && x.is_multiple_of(50)));
    assert_eq!(found.are_hidden(), Some(false), "{found:?}");
    let alone = score(|x, y| y == 30 && x < 7);
    assert_eq!((alone.ratio(), alone.are_hidden()), (Some(f64::INFINITY), Some(false)));
}

#[test]
fn few_pixels_say_nothing_and_frames_add_up() {
    let domain = ground();
    let everywhere = answers(&domain, |_, y| y == 29);
    let elsewhere = seams(&domain, &everywhere, &[5.0, 100.0], |pixel| domain.depth(pixel)).unwrap();
    assert_eq!((elsewhere.seam.pixels, elsewhere.are_hidden()), (0, None));
    let mut sum = Seams::default();
    let one = score(|_, y| y == 29);
    sum += one;
    sum += one;
    assert_eq!((sum.seam.pixels, sum.ratio()), (2 * one.seam.pixels, one.ratio()));
    assert!(one.seam.pixels >= LEAST_SEAM_PIXELS);
}

#[test]
fn radial_bands_and_bad_borders() {
    let domain = ground();
    let columns = answers(&domain, |x, _| x == 350);
    let radial = seams(&domain, &columns, &[350.0], |pixel| (pixel % SIZE[0]) as f64).unwrap();
    assert_eq!(radial.seam.pixels, 4 * SIZE[1]);
    assert_eq!(radial.ratio(), Some(f64::INFINITY));
    for borders in [&[3.0, 3.0][..], &[f64::NAN], &[f64::INFINITY]] {
        assert!(seams(&domain, &columns, borders, |pixel| domain.depth(pixel)).is_err());
    }
    let other = Answers::from_pixels([1, 1], vec![Some(1.0)]).unwrap();
    assert!(seams(&domain, &other, &[BORDER], |pixel| domain.depth(pixel)).is_err());
}

/// Two surfaces that meet at a silhouette have no border between them.
#[test]
fn silhouettes_are_no_borders() {
    let domain = domain(&mask(SIZE, |x, y| Some((if x < 350 { 10.0 } else { 30.0 }, (x + y) % 4 < 2))));
    let everywhere = answers(&domain, |_, _| true);
    assert_eq!(seams(&domain, &everywhere, &[BORDER], |pixel| domain.depth(pixel)).unwrap(), Seams::default());
}
