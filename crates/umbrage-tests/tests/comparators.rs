//! Every comparison has to say no where it should, and yes just before.

use std::fs;

use image::{GrayAlphaImage, GrayImage, LumaA, Rgb, RgbImage};
use umbrage_tests::compare::{
    Golden, Incomparable, MASK_DECISIONS, MASK_VISIBILITY, PICTURE_MEAN, PICTURE_OUTLIER, PICTURE_OUTLIERS, compare,
    difference, linear,
};
use umbrage_tests::golden::{Failure, Goldens, LARGEST, Mode};
use umbrage_tests::judge::{Ceiling, pooled};
use umbrage_truth::scores::MisShadowed;

const WIDTH: u32 = 160;
const HEIGHT: u32 = 120;

/// Discs of shadow on lit ground under a sky.
fn mask() -> GrayAlphaImage {
    mask_of([WIDTH, HEIGHT])
}

fn mask_of([width, height]: [u32; 2]) -> GrayAlphaImage {
    GrayAlphaImage::from_fn(width, height, |x, y| {
        let (u, v) = (x % 40, y % 40);
        let inside = u.abs_diff(20).pow(2) + v.abs_diff(20).pow(2) < 150;
        LumaA(if y < 30 { [0, 0] } else { [if inside { 0 } else { 255 }, 255] })
    })
}

/// The mask's scene, shaded.
fn picture() -> RgbImage {
    let mask = mask();
    RgbImage::from_fn(96, 72, |x, y| match mask.get_pixel(x, y + 30).0 {
        [0, _] => Rgb([60, 58, 70]),
        _ => Rgb([150 + (x / 8) as u8, 140, 120]),
    })
}

fn is_same(expected: &Golden, actual: &Golden) -> bool {
    compare(expected, actual).expect("two images of one kind and size").is_same()
}

fn with_mask(change: impl FnOnce(&mut GrayAlphaImage)) -> Golden {
    let mut changed = mask();
    change(&mut changed);
    Golden::Mask(changed)
}

fn with_picture(change: impl FnOnce(&mut RgbImage)) -> Golden {
    let mut changed = picture();
    change(&mut changed);
    Golden::Picture(changed)
}

/// The first pixels that show ground, `count` of them.
fn first_on_ground(mask: &mut GrayAlphaImage, count: usize) -> impl Iterator<Item = &mut LumaA<u8>> {
    mask.pixels_mut().filter(|pixel| pixel.0[1] > 0).take(count)
}

#[test]
fn an_image_is_itself() {
    for golden in [Golden::Mask(mask()), Golden::Picture(picture())] {
        let verdict = compare(&golden, &golden).expect("comparable");
        assert!(verdict.is_same(), "{verdict}");
        assert!(verdict.measured.iter().all(|measured| measured.value == 0.0), "{verdict}");
        let pixels = golden.size()[0] * golden.size()[1];
        assert_eq!(verdict.pixels, pixels as usize, "every pixel is compared");
    }
}

#[test]
fn a_mask_moved_by_one_pixel_is_another() {
    let mask = mask();
    let moved = GrayAlphaImage::from_fn(WIDTH, HEIGHT, |x, y| *mask.get_pixel(x.saturating_sub(1), y));
    assert!(!is_same(&Golden::Mask(mask), &Golden::Mask(moved)));
}

#[test]
fn an_inverted_mask_is_another() {
    let inverted = with_mask(|mask| mask.pixels_mut().for_each(|pixel| pixel.0[0] = 255 - pixel.0[0]));
    assert!(!is_same(&Golden::Mask(mask()), &inverted));
}

#[test]
fn a_mask_of_nothing_is_no_mask_of_something() {
    let nothing = Golden::Mask(GrayAlphaImage::new(WIDTH, HEIGHT));
    assert!(!is_same(&Golden::Mask(mask()), &nothing), "no surface");
    assert!(!is_same(&nothing, &Golden::Mask(mask())), "nor the other way round");
    let all_lit = with_mask(|mask| mask.pixels_mut().for_each(|pixel| pixel.0[0] = 255));
    assert!(!is_same(&Golden::Mask(mask()), &all_lit), "no shadow");
    let empty = Golden::Mask(GrayAlphaImage::new(0, 0));
    assert!(!is_same(&empty, &empty), "nothing was compared");
}

#[test]
fn one_more_wrong_pixel_than_tolerated_is_too_many() {
    let pixels = f64::from(WIDTH * HEIGHT);
    let tolerated = (MASK_DECISIONS * pixels).floor() as usize;
    assert_eq!(tolerated, 38, "the worked example");
    // From just lit to just dark: visibility hardly changes, so that the decision alone is judged.
    let reference = with_mask(|mask| first_on_ground(mask, 100).for_each(|pixel| pixel.0[0] = 128));
    let flipped = |count| {
        with_mask(|mask| {
            first_on_ground(mask, 100).for_each(|pixel| pixel.0[0] = 128);
            first_on_ground(mask, count).for_each(|pixel| pixel.0[0] = 127);
        })
    };
    assert!(is_same(&reference, &flipped(tolerated)), "as many as tolerated");
    assert!(!is_same(&reference, &flipped(tolerated + 1)), "one pixel more");
}

#[test]
fn surfaces_that_come_and_go_are_decisions() {
    let holes = |count| with_mask(|mask| first_on_ground(mask, count).for_each(|pixel| *pixel = LumaA([0, 0])));
    assert!(!is_same(&Golden::Mask(mask()), &holes(39)));
    assert!(!is_same(&holes(39), &Golden::Mask(mask())));
}

#[test]
fn softer_shadows_are_others_though_they_decide_the_same() {
    // Every lit pixel a step darker: a mean of 1/255 over the lit ground.
    let darker = |steps: u8| {
        with_mask(|mask| {
            mask.pixels_mut().filter(|pixel| pixel.0[0] == 255).for_each(|pixel| pixel.0[0] -= steps);
        })
    };
    let verdict = compare(&Golden::Mask(mask()), &darker(1)).expect("comparable");
    assert_eq!(verdict.measured[0].value, 0.0, "no decision changes");
    assert!(verdict.measured[1].value > MASK_VISIBILITY && !verdict.is_same(), "{verdict}");
}

#[test]
fn pictures_differ_in_the_mean() {
    let reference = with_picture(|picture| picture.pixels_mut().for_each(|pixel| *pixel = Rgb([128; 3])));
    let brighter = |share: f64| {
        with_picture(|picture| {
            let count = (share * 96.0 * 72.0) as usize;
            picture.pixels_mut().for_each(|pixel| *pixel = Rgb([128; 3]));
            picture.pixels_mut().take(count).for_each(|pixel| *pixel = Rgb([129; 3]));
        })
    };
    let step = linear(129) - linear(128);
    assert!((step - 0.0036).abs() < 1e-4, "the worked example: {step}");
    assert!(is_same(&reference, &brighter(0.98 * PICTURE_MEAN / step)), "more than half of it, one step");
    assert!(!is_same(&reference, &brighter(1.02 * PICTURE_MEAN / step)), "a bit more");
    assert!(!is_same(&reference, &brighter(1.0)), "all of it");
}

#[test]
fn pictures_differ_in_their_outliers() {
    let tolerated = (PICTURE_OUTLIERS * 96.0 * 72.0).floor() as usize;
    assert_eq!(tolerated, 69, "the worked example");
    let sparkling = |count| {
        with_picture(|picture| {
            for pixel in picture.pixels_mut().filter(|pixel| pixel.0[1] == 140).take(count) {
                pixel.0[1] = 152;
            }
        })
    };
    assert!(linear(152) - linear(140) > PICTURE_OUTLIER, "this is an outlier");
    assert!(is_same(&Golden::Picture(picture()), &sparkling(tolerated)));
    assert!(!is_same(&Golden::Picture(picture()), &sparkling(tolerated + 1)));
}

#[test]
fn a_picture_moved_by_one_pixel_or_without_shadows_is_another() {
    let picture = picture();
    let moved = RgbImage::from_fn(96, 72, |x, y| *picture.get_pixel(x.saturating_sub(1), y));
    assert!(!is_same(&Golden::Picture(picture.clone()), &Golden::Picture(moved)));
    let lit = with_picture(|picture| {
        picture.pixels_mut().filter(|pixel| pixel.0[0] == 60).for_each(|pixel| *pixel = Rgb([150, 140, 120]));
    });
    assert!(!is_same(&Golden::Picture(picture), &lit));
}

#[test]
fn images_of_other_size_or_kind_are_never_compared() {
    let larger = Golden::Mask(mask_of([WIDTH + 1, HEIGHT]));
    let size = Incomparable::Size { expected: [WIDTH, HEIGHT], actual: [WIDTH + 1, HEIGHT] };
    assert_eq!(compare(&Golden::Mask(mask()), &larger), Err(size));
    assert!(difference(&Golden::Mask(mask()), &larger).is_none());
    let transposed = Golden::Mask(mask_of([HEIGHT, WIDTH]));
    assert!(compare(&Golden::Mask(mask()), &transposed).is_err(), "as many pixels, another shape");
    let kind = Incomparable::Kind { expected: "mask", actual: "picture" };
    let black = Golden::Picture(RgbImage::new(WIDTH, HEIGHT));
    assert_eq!(compare(&Golden::Mask(mask()), &black), Err(kind));
}

#[test]
fn differences_show_where_and_which_way() {
    let mut changed = mask();
    changed.put_pixel(20, 60, LumaA([255, 255]));
    changed.put_pixel(0, 60, LumaA([0, 255]));
    changed.put_pixel(5, 0, LumaA([255, 255]));
    let shown = difference(&Golden::Mask(mask()), &Golden::Mask(changed)).expect("comparable");
    assert_eq!(shown.get_pixel(20, 60).0, [255, 0, 0], "brighter than it should be: red");
    assert_eq!(shown.get_pixel(0, 60).0, [0, 0, 255], "darker: blue");
    assert_eq!(shown.get_pixel(5, 0).0, [255, 220, 0], "a surface where none was: yellow");
    let [r, g, b] = shown.get_pixel(1, 60).0;
    assert!(r == g && g == b, "grey where nothing differs");
}

/// A folder of references that goes away again.
fn folder(mode: Mode) -> (tempfile::TempDir, Goldens) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let goldens = Goldens { references: folder.path().join("goldens"), failures: folder.path().join("failures"), mode };
    (folder, goldens)
}

fn checking(goldens: &Goldens) -> Goldens {
    Goldens { mode: Mode::Check, ..goldens.clone() }
}

#[test]
fn a_missing_reference_fails_and_shows_what_there_is() {
    let (_folder, goldens) = folder(Mode::Check);
    let failure = goldens.check("world", &Golden::Mask(mask())).expect_err("there is no reference");
    assert!(matches!(failure, Failure::Missing { .. }), "{failure}");
    assert!(failure.to_string().contains("world.actual.png") && failure.to_string().contains("cargo xtask bless"));
    assert!(goldens.failures.join("world.actual.png").is_file());
    assert!(!goldens.references.join("world.png").exists(), "checking accepts nothing");
}

#[test]
fn a_blessed_reference_is_kept_until_the_image_differs() {
    let (_folder, blessing) = folder(Mode::Bless);
    for (name, golden) in [("mask", Golden::Mask(mask())), ("picture", Golden::Picture(picture()))] {
        blessing.check(name, &golden).expect("blessed");
        checking(&blessing).check(name, &golden).expect("the same");
        assert_eq!(blessing.read(name).expect("a reference"), golden, "nothing is lost in the file");
    }
    let inverted = with_mask(|mask| mask.pixels_mut().for_each(|pixel| pixel.0[0] = 255 - pixel.0[0]));
    let failure = checking(&blessing).check("mask", &inverted).expect_err("it differs");
    assert!(matches!(failure, Failure::Differs { .. }), "{failure}");
    assert!(failure.to_string().contains("failures"), "it says where to look: {failure}");
    for part in ["expected", "actual", "difference"] {
        assert!(blessing.failures.join(format!("mask.{part}.png")).is_file(), "{part}");
    }
    assert_eq!(blessing.read("mask").expect("a reference"), Golden::Mask(mask()), "checking replaces nothing");
    checking(&blessing).check("mask", &Golden::Mask(mask())).expect("as before");
    assert!(!blessing.failures.join("mask.actual.png").exists(), "what passes leaves nothing to look at");
    blessing.check("mask", &inverted).expect("blessed");
    checking(&blessing).check("mask", &inverted).expect("the new reference");
}

#[test]
fn references_of_other_size_kind_or_content_fail() {
    let (_folder, blessing) = folder(Mode::Bless);
    blessing.check("mask", &Golden::Mask(mask())).expect("blessed");
    let goldens = checking(&blessing);
    let small = goldens.check("mask", &Golden::Mask(mask_of([80, 60]))).expect_err("another size");
    assert!(small.to_string().contains("[160, 120]") && small.to_string().contains("[80, 60]"), "{small}");
    assert!(goldens.failures.join("mask.expected.png").is_file() && goldens.failures.join("mask.actual.png").is_file());
    assert!(goldens.check("mask", &Golden::Picture(picture())).is_err(), "another kind");

    let file = goldens.references.join("mask.png");
    GrayImage::new(WIDTH, HEIGHT).save(&file).expect("saved");
    assert!(matches!(goldens.check("mask", &Golden::Mask(mask())), Err(Failure::Format { .. })), "no alpha");
    fs::write(&file, b"no image").expect("written");
    assert!(matches!(goldens.check("mask", &Golden::Mask(mask())), Err(Failure::Image { .. })), "no image");
    blessing.check("mask", &Golden::Mask(mask())).expect("a broken reference is replaced on demand");
    goldens.check("mask", &Golden::Mask(mask())).expect("and is whole again");
}

#[test]
fn references_have_a_budget() {
    let (_folder, blessing) = folder(Mode::Bless);
    let mut state = 1_u32;
    let noise = RgbImage::from_fn(96, 72, |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        Rgb([(state >> 8) as u8, (state >> 16) as u8, (state >> 24) as u8])
    });
    let failure = blessing.check("noise", &Golden::Picture(noise.clone())).expect_err("noise does not pack");
    assert!(matches!(failure, Failure::TooLarge { bytes, .. } if bytes > LARGEST), "{failure}");
    assert!(!blessing.references.join("noise.png").exists(), "nothing too large is kept");

    blessing.check("mask", &Golden::Mask(mask())).expect("blessed");
    assert_eq!(blessing.audit(&["mask"]).expect("readable"), [""; 0]);
    assert!(blessing.audit(&[]).expect("readable")[0].contains("no image is compared with it"));
    noise.save(blessing.references.join("noise.png")).expect("saved");
    let complaints = blessing.audit(&["mask", "noise"]).expect("readable");
    assert!(complaints.len() == 1 && complaints[0].contains("noise.png"), "{complaints:?}");
    for i in 0..8 {
        noise.save(blessing.references.join(format!("noise{i}.png"))).expect("saved");
    }
    let complaints = blessing.audit(&["mask", "noise"]).expect("readable");
    assert!(complaints.iter().any(|complaint| complaint.contains("all references")), "{complaints:?}");
}

#[test]
fn ceilings_refuse_what_is_worse_and_what_is_nothing() {
    let ceiling = Ceiling::above(0.01);
    let score = |wrong: usize| MisShadowed {
        pixels: 100_000,
        false_shadow: wrong / 2,
        false_light: wrong - wrong / 2,
        missing: 0,
    };
    assert!(ceiling.check(&score(1_000)).is_ok(), "what was measured");
    assert!(ceiling.check(&score(1_149)).is_ok(), "just under");
    let exceeded = ceiling.check(&score(1_151)).expect_err("just above").to_string();
    assert!(exceeded.contains("0.01151") && exceeded.contains("0.01150") && exceeded.contains("0.01000"), "{exceeded}");
    assert!(ceiling.check(&MisShadowed::default()).is_err(), "nothing was scored");
    let both = pooled([score(1_000), score(3_000)]);
    assert_eq!((both.pixels, both.rate()), (200_000, 0.02));
    assert!(ceiling.check(&both).is_err(), "one bad view spoils the pool");
}
