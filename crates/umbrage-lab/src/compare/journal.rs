//! The finished series of a comparison, as lines of a [`crate::journal`]: scores of views, flicker,
//! and shots of the sheets.

use std::path::Path;

use base64::{Engine, engine::general_purpose::STANDARD};
use serde::{Deserialize, Serialize};
use umbrage_truth::scores::{MisShadowed, Seams};

use super::{
    report::{ViewReport, WalkReport},
    sheet::{Cell, SheetShot},
};
use crate::{
    failure::Result,
    journal::{Journal, Kind},
    picture::png,
};

const KIND: Kind = Kind { option: "--resume", run: "comparison" };

/// A finished series.
#[derive(Clone, Debug)]
pub struct Finished {
    /// Index of the scene, and of the series in it.
    pub series: [usize; 2],
    /// Scores of the series' views.
    pub views: Vec<ViewReport>,
    /// Flicker of the series, if it has two frames or more.
    pub walk: Option<WalkReport>,
    /// Shots of the series on the sheet of pictures and on that of errors.
    pub sheets: [Vec<SheetShot>; 2],
}

/// Opens the journal at `path` or begins one. `of` describes the comparison; a journal of any other
/// is refused.
///
/// # Errors
/// As [`Journal::open`].
pub fn open(path: &Path, of: &impl Serialize) -> Result<Journal<Finished>> {
    Journal::open(path, KIND, of, read)
}

impl Journal<Finished> {
    /// Describes the content left by an earlier run.
    #[must_use]
    pub fn note(&self) -> String {
        let cut = if self.dropped > 0 { "; another was cut off and is drawn again" } else { "" };
        format!(
            "--resume {}: {} cameras under suns were finished before{cut}",
            self.path().display(),
            self.finished.len()
        )
    }

    /// Takes a series out, if it was finished before.
    pub fn take(&mut self, series: [usize; 2]) -> Option<Finished> {
        let at = self.finished.iter().position(|finished| finished.series == series)?;
        Some(self.finished.swap_remove(at))
    }

    /// Writes a finished series.
    ///
    /// # Errors
    /// As [`Journal::append`].
    pub fn keep(&mut self, finished: &Finished) -> Result<()> {
        self.append(&Line::new(finished)?)
    }
}

/// Line of the file for a finished series.
#[derive(Serialize, Deserialize)]
struct Line {
    series: [usize; 2],
    views: Vec<ViewReport>,
    /// Counts of each view and technique: pixels, falsely dark and falsely lit ones and missing
    /// answers of the seam and its two sides. The report has only their rates.
    seams: Vec<Vec<[[usize; 4]; 3]>>,
    walk: Option<WalkReport>,
    sheets: [Vec<ShotLine>; 2],
}

#[derive(Serialize, Deserialize)]
struct ShotLine {
    title: String,
    lines: Vec<String>,
    warning: Option<String>,
    /// Picture (PNG, base64), caption, and whether no other is better.
    cells: Vec<(String, String, bool)>,
}

impl Line {
    fn new(finished: &Finished) -> Result<Self> {
        let counts = |seams: &Seams| {
            [seams.seam, seams.nearer, seams.farther].map(|c| [c.pixels, c.false_shadow, c.false_light, c.missing])
        };
        let of_view = |view: &ViewReport| view.scores.iter().map(|scores| counts(&scores.seams.counts)).collect();
        let cell = |cell: &Cell| Ok((STANDARD.encode(png(&cell.picture)?), cell.caption.clone(), cell.is_best));
        let shot = |shot: &SheetShot| {
            Ok(ShotLine {
                title: shot.title.clone(),
                lines: shot.lines.clone(),
                warning: shot.warning.clone(),
                cells: shot.cells.iter().map(cell).collect::<Result<_>>()?,
            })
        };
        let sheet = |shots: &Vec<SheetShot>| shots.iter().map(shot).collect::<Result<Vec<_>>>();
        Ok(Self {
            series: finished.series,
            views: finished.views.clone(),
            seams: finished.views.iter().map(of_view).collect(),
            walk: finished.walk.clone(),
            sheets: [sheet(&finished.sheets[0])?, sheet(&finished.sheets[1])?],
        })
    }
}

/// Reads a line of the file. The error says what is wrong with it.
fn read(line: &str) -> std::result::Result<Finished, String> {
    let line: Line = serde_json::from_str(line).map_err(|error| error.to_string())?;
    let mut views = line.views;
    for (view, seams) in views.iter_mut().zip(&line.seams) {
        for (scores, counts) in view.scores.iter_mut().zip(seams) {
            let [seam, nearer, farther] = counts.map(|[pixels, false_shadow, false_light, missing]| MisShadowed {
                pixels,
                false_shadow,
                false_light,
                missing,
            });
            scores.seams.counts = Seams { seam, nearer, farther };
        }
    }
    let picture = |text: &str| -> std::result::Result<_, String> {
        let bytes = STANDARD.decode(text).map_err(|error| error.to_string())?;
        Ok(image::load_from_memory(&bytes).map_err(|error| error.to_string())?.into_rgb8())
    };
    let shot = |shot: &ShotLine| -> std::result::Result<_, String> {
        let cells = shot.cells.iter().map(|(text, caption, is_best)| {
            Ok(Cell { picture: picture(text)?, caption: caption.clone(), is_best: *is_best })
        });
        Ok(SheetShot {
            title: shot.title.clone(),
            lines: shot.lines.clone(),
            warning: shot.warning.clone(),
            cells: cells.collect::<std::result::Result<_, String>>()?,
        })
    };
    let sheet = |shots: &[ShotLine]| shots.iter().map(shot).collect::<std::result::Result<Vec<_>, String>>();
    let sheets = [sheet(&line.sheets[0])?, sheet(&line.sheets[1])?];
    Ok(Finished { series: line.series, views, walk: line.walk, sheets })
}

#[cfg(test)]
mod tests {
    use image::RgbImage;
    use serde_json::Value;

    use super::super::judge::Scores;
    use super::*;
    use crate::report::CameraReport;

    fn finished(series: [usize; 2]) -> Finished {
        let count = |pixels| MisShadowed { pixels, false_shadow: 1, false_light: 2, missing: 0 };
        let seams = Seams { seam: count(30), nearer: count(40), farther: count(50) };
        let scores = Scores { e: Some(0.1 + 0.2), seams: seams.into(), planes_m: vec![1.0 / 3.0], ..Scores::default() };
        let camera = CameraReport {
            name: "near".into(),
            eye: [0.1; 3],
            forward: [0.0, 0.0, -1.0],
            up: [0.0, 1.0, 0.0],
            fov: Some(60.0),
            near: 1.0,
            far: None,
        };
        let view = ViewReport {
            scene: "s".into(),
            camera,
            frame: Some(3),
            sun_name: "own".into(),
            sun: None,
            options: vec!["s".into(), "--near=1".into()],
            range_m: [1.0, 2.0],
            scored_pixels: 7,
            true_edges: 5,
            counts: true,
            scores: vec![scores],
        };
        let cell = Cell {
            picture: RgbImage::from_fn(3, 2, |x, y| image::Rgb([x as u8, y as u8, 7])),
            caption: "c".into(),
            is_best: true,
        };
        let shot = SheetShot { title: "t".into(), lines: vec!["l".into()], warning: None, cells: vec![cell] };
        Finished { series, views: vec![view], walk: None, sheets: [vec![shot.clone()], vec![shot]] }
    }

    fn of(what: &str) -> Value {
        serde_json::json!({ "techniques": what, "size": [8, 6] })
    }

    #[test]
    fn what_was_finished_comes_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("journal");
        let mut journal = open(&path, &of("a")).expect("a new one");
        assert!(journal.finished.is_empty());
        journal.keep(&finished([0, 0])).expect("kept");
        journal.keep(&finished([0, 1])).expect("kept");
        drop(journal);
        let mut journal = open(&path, &of("a")).expect("the same comparison");
        let back = journal.take([0, 1]).expect("the second");
        let (old, new) = (&finished([0, 1]).views[0], &back.views[0]);
        assert_eq!(old.scores, new.scores);
        assert_eq!(serde_json::to_string(old).ok(), serde_json::to_string(new).ok());
        assert_eq!(back.sheets[1][0].cells[0].picture, finished([0, 1]).sheets[1][0].cells[0].picture);
        assert!(journal.take([0, 1]).is_none() && journal.take([0, 0]).is_some() && journal.take([1, 0]).is_none());
        journal.remove().expect("removed");
        assert!(!path.exists());
    }
}
