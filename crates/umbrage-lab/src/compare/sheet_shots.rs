//! Choice of the shots on the sheets, and their pictures.

use image::{DynamicImage, GrayAlphaImage, Rgb, RgbImage, RgbaImage};
use umbrage_truth::scores::{Answers, Domain, LEAST_FACING, false_colour};

use super::{
    inset,
    judge::{Scores, ViewTruth, wrong_pixels},
    sheet::{self, Cell, SheetShot},
    shots::SceneShots,
};
use crate::failure::Result;

/// Indices of a view: scene, series, frame.
pub type Place = [usize; 3];

/// Chooses the views of the sheets: the middle one of each series, or the frames of the only
/// series; of too many, evenly spaced ones.
#[must_use]
pub fn chosen(sets: &[SceneShots], most: usize) -> Vec<Place> {
    let series = |set: usize| sets[set].series.len();
    let frames = |set: usize, of: usize| sets[set].series[of].views.len();
    let all: Vec<[usize; 2]> = (0..sets.len()).flat_map(|set| (0..series(set)).map(move |of| [set, of])).collect();
    let candidates: Vec<Place> = match all[..] {
        [[set, of]] => (0..frames(set, of)).map(|frame| [set, of, frame]).collect(),
        _ => all.iter().map(|&[set, of]| [set, of, (frames(set, of) - 1) / 2]).collect(),
    };
    evenly(candidates.len(), most).map(|index| candidates[index]).collect()
}

/// Returns at most `most` of the numbers below `count`, with the first and the last among them.
fn evenly(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let shown = count.min(most);
    (0..shown).map(move |i| if shown > 1 { (2 * i * (count - 1) + shown - 1) / (2 * (shown - 1)) } else { 0 })
}

/// Result of one technique in a view.
pub struct Answer {
    /// Mask of the view.
    pub mask: GrayAlphaImage,
    /// Picture of the view.
    pub picture: RgbaImage,
    /// Scores of the view.
    pub scores: Scores,
    /// Pixels of the points whose decision differs from that of one frame ago.
    pub flipped: Vec<[u32; 2]>,
}

/// Colour of pixels whose decision differs from that of one frame ago.
const FLIPPED: Rgb<u8> = Rgb([255, 216, 0]);

/// Pictures that the truth's picture is made of, beside the techniques' pictures: all surfaces that
/// face the sun lit, and none lit.
pub struct Plain {
    /// Picture without shadows.
    pub lit: RgbaImage,
    /// Picture without sun, which is about right where a surface faces the sun.
    pub dark: RgbaImage,
}

/// Makes the shot of a view for the sheet of pictures and for that of errors, without headings.
pub fn sheet_shots(judged: &ViewTruth, answers: &[Answer], plain: &Plain, cell: [u32; 2]) -> Result<[SheetShot; 2]> {
    let decided: Vec<Answers> = answers.iter().map(|answer| Answers::from_mask(&answer.mask)).collect();
    let wrong: Vec<Vec<bool>> = decided.iter().map(|answers| wrong_pixels(judged, answers)).collect();
    let inset = inset::find(judged, &wrong);
    let least = answers.iter().filter_map(|answer| answer.scores.e).fold(f64::INFINITY, f64::min);
    let captioned = |picture: &RgbImage, scores: &Scores| Cell {
        picture: sheet::framed(picture, cell, inset),
        caption: caption(scores),
        is_best: answers.len() > 1 && scores.e == Some(least),
    };
    let true_answers = Answers::from_mask(&judged.truth.to_image());
    let [mut pictures, mut errors] = [Vec::new(), Vec::new()];
    for (answer, decided) in answers.iter().zip(&decided) {
        pictures.push(captioned(&opaque(&answer.picture), &answer.scores));
        let mut wrong = false_colour(&judged.truth, &judged.domain, decided)?;
        for [x, y] in &answer.flipped {
            wrong.put_pixel(*x, *y, FLIPPED);
        }
        errors.push(captioned(&wrong, &answer.scores));
    }
    let edges = judged.domain.edges().len();
    let truth = |picture: &RgbImage| Cell {
        picture: sheet::framed(picture, cell, inset),
        caption: format!("{edges} edge pixels, {} scored", judged.domain.pixels().len()),
        is_best: false,
    };
    pictures.push(truth(&true_picture(judged, answers, plain)));
    errors.push(truth(&false_colour(&judged.truth, &judged.domain, &true_answers)?));
    Ok([pictures, errors].map(|cells| SheetShot { title: String::new(), lines: Vec::new(), warning: None, cells }))
}

/// Makes the picture with true shadows. Where the sun shines it is the picture without shadows.
/// Elsewhere it is that of a technique that rightly finds shadow there, and if none does, the
/// picture without sun. Surfaces that hardly face the sun or turn away are those of the best
/// technique, because their shading does not depend on shadows.
fn true_picture(judged: &ViewTruth, answers: &[Answer], plain: &Plain) -> RgbImage {
    let light = judged.truth.light();
    let errors = answers.iter().map(|answer| answer.scores.e.unwrap_or(1.0));
    let best = errors.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(number, _)| &answers[number].picture);
    let width = plain.lit.width();
    RgbImage::from_fn(width, plain.lit.height(), |x, y| {
        let hit = judged.truth.hits()[(y * width + x) as usize];
        let source = match hit {
            Some(hit) if hit.normal.dot(light.to_light(hit.position)) <= LEAST_FACING => best.unwrap_or(&plain.lit),
            Some(hit) if !hit.lit => {
                let visibility = |answer: &&Answer| answer.mask.get_pixel(x, y).0[0];
                let darkest = answers.iter().min_by_key(visibility).filter(|answer| visibility(answer) < 128);
                darkest.map_or(&plain.dark, |answer| &answer.picture)
            }
            _ => &plain.lit,
        };
        let [r, g, b, _] = source.get_pixel(x, y).0;
        Rgb([r, g, b])
    })
}

fn opaque(picture: &RgbaImage) -> RgbImage {
    DynamicImage::from(picture.clone()).into_rgb8()
}

fn caption(scores: &Scores) -> String {
    match (scores.e, scores.edge_distance_px) {
        (Some(e), Some(distance)) => format!("E {:.2} % · D {distance:.2} px", 100.0 * e),
        (Some(e), None) => format!("E {:.2} % · no edges", 100.0 * e),
        (None, _) => "nothing to score".into(),
    }
}

/// Returns the reason why a view does not count, if it does not.
#[must_use]
pub fn warning(domain: &Domain, least_edges: usize) -> Option<String> {
    let edges = domain.edges().len();
    (edges < least_edges).then(|| format!("does not count: {edges} edges"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evenly_chosen_shots_hold_the_ends() {
        let chosen = |count, most| evenly(count, most).collect::<Vec<_>>();
        assert_eq!(chosen(3, 8), [0, 1, 2]);
        assert_eq!(chosen(9, 3), [0, 4, 8]);
        assert_eq!(chosen(10, 1), [0]);
        assert_eq!(chosen(0, 4), [0; 0]);
        for (count, most) in [(60, 8), (8, 7), (5, 4), (100, 2)] {
            let chosen = chosen(count, most);
            assert!(chosen.len() == most && chosen.windows(2).all(|pair| pair[0] < pair[1]), "{chosen:?}");
            assert!(chosen[0] == 0 && chosen[most - 1] == count - 1, "{chosen:?}");
        }
    }
}
