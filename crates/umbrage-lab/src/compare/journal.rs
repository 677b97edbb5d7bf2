//! What a comparison has finished, kept in a file while it runs: one that is cut off goes on from
//! there.
//!
//! The first line says what is compared, each further one holds a finished series: its views'
//! scores, its flicker and its columns of the sheets. A line counts once its end is written.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Seek as _, Write as _},
    path::{Path, PathBuf},
};

use base64::{Engine, engine::general_purpose::STANDARD};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use umbrage_truth::scores::{MisShadowed, Seams};

use super::{
    report::{ViewReport, WalkReport},
    sheet::{Cell, Column},
};
use crate::{
    failure::{Failure, Result},
    picture::png,
};

/// A series that is finished.
#[derive(Clone, Debug)]
pub struct Finished {
    /// Scene and series.
    pub series: [usize; 2],
    /// Its views.
    pub views: Vec<ViewReport>,
    /// Its flicker, of two frames or more.
    pub walk: Option<WalkReport>,
    /// Its columns on the sheet of pictures and on that of errors.
    pub columns: [Vec<Column>; 2],
}

/// The file, open for what is still to come.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// What was finished before.
    pub finished: Vec<Finished>,
    /// Bytes of a last line that was cut off, which are dropped.
    pub dropped: usize,
}

impl Journal {
    /// Opens the journal at `path` or begins one. `of` says what is compared; a journal of anything
    /// else is refused.
    ///
    /// # Errors
    /// [`Failure::Input`] naming the file: it cannot be read or written, is no journal, or is one
    /// of another comparison.
    pub fn open(path: &Path, of: &impl Serialize) -> Result<Self> {
        let failed = |error: io::Error| Failure::file("write", path, &error);
        let wrong = |what: String| Failure::input(format!("--resume {}: {what}", path.display()));
        let of = serde_json::to_value(of).map_err(|error| Failure::other(format!("no JSON of the job: {error}")))?;
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(error) => return Err(Failure::file("read", path, &error)),
        };
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        let text = std::str::from_utf8(&bytes[..whole]).map_err(|_| wrong(NO_JOURNAL.to_owned()))?;
        let mut lines = text.lines();
        let mut finished = Vec::new();
        let header = lines.next();
        let mut first_line = serde_json::to_vec(&of).map_err(|error| Failure::other(error.to_string()))?;
        first_line.push(b'\n');
        if let Some(header) = header {
            let header: Value = serde_json::from_str(header).map_err(|_| wrong(NO_JOURNAL.to_owned()))?;
            if let Some(what) = difference(&header, &of) {
                return Err(wrong(format!(
                    "it holds another comparison ({what}); repeat that one's options, or give another file"
                )));
            }
            for (number, line) in (2..).zip(lines) {
                finished.push(
                    read(line).map_err(|error| wrong(format!("line {number} is damaged: {error}; delete the file")))?,
                );
            }
        } else if !first_line.starts_with(&bytes) {
            return Err(wrong(NO_JOURNAL.to_owned()));
        }
        let mut file = OpenOptions::new().write(true).create(true).truncate(false).open(path).map_err(failed)?;
        file.set_len(whole as u64).and_then(|()| file.seek(io::SeekFrom::End(0))).map_err(failed)?;
        let mut journal = Self { path: path.to_owned(), file, finished, dropped: bytes.len() - whole };
        if header.is_none() {
            journal.append(&of)?;
        }
        Ok(journal)
    }

    /// What an earlier run left, in words.
    #[must_use]
    pub fn note(&self) -> String {
        let cut = if self.dropped > 0 { "; another was cut off and is drawn again" } else { "" };
        format!(
            "--resume {}: {} cameras under suns were finished before{cut}",
            self.path.display(),
            self.finished.len()
        )
    }

    /// A series, if it was finished before.
    pub fn take(&mut self, series: [usize; 2]) -> Option<Finished> {
        let at = self.finished.iter().position(|finished| finished.series == series)?;
        Some(self.finished.swap_remove(at))
    }

    /// Keeps a series.
    ///
    /// # Errors
    /// [`Failure::Input`] if the file cannot be written.
    pub fn keep(&mut self, finished: &Finished) -> Result<()> {
        self.append(&Line::new(finished)?)
    }

    /// Removes the file: everything that it held is in the outputs.
    ///
    /// # Errors
    /// [`Failure::Input`] if it cannot be removed.
    pub fn remove(self) -> Result<()> {
        fs::remove_file(&self.path).map_err(|error| Failure::file("remove", &self.path, &error))
    }

    fn append(&mut self, line: &impl Serialize) -> Result<()> {
        let mut bytes =
            serde_json::to_vec(line).map_err(|error| Failure::other(format!("no JSON of a finished view: {error}")))?;
        bytes.push(b'\n');
        let written = self.file.write_all(&bytes).and_then(|()| self.file.sync_data());
        written.map_err(|error| Failure::file("write", &self.path, &error))
    }
}

const NO_JOURNAL: &str = "it is no journal of a comparison; give another file";

/// What two descriptions of a job do not have in common, by its name.
fn difference(old: &Value, new: &Value) -> Option<String> {
    let (Some(old), Some(new)) = (old.as_object(), new.as_object()) else { return Some("no description".into()) };
    let names = old.keys().chain(new.keys());
    names.into_iter().find(|name| old.get(*name) != new.get(*name)).cloned()
}

/// A finished series as it stands in the file.
#[derive(Serialize, Deserialize)]
struct Line {
    series: [usize; 2],
    views: Vec<ViewReport>,
    /// Of each view and technique: pixels, falsely dark and falsely lit ones and missing answers of
    /// the seam and its two sides. The report has their rates alone.
    seams: Vec<Vec<[[usize; 4]; 3]>>,
    walk: Option<WalkReport>,
    columns: [Vec<ColumnLine>; 2],
}

#[derive(Serialize, Deserialize)]
struct ColumnLine {
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
        let column = |column: &Column| {
            Ok(ColumnLine {
                title: column.title.clone(),
                lines: column.lines.clone(),
                warning: column.warning.clone(),
                cells: column.cells.iter().map(cell).collect::<Result<_>>()?,
            })
        };
        let sheet = |columns: &Vec<Column>| columns.iter().map(column).collect::<Result<Vec<_>>>();
        Ok(Self {
            series: finished.series,
            views: finished.views.clone(),
            seams: finished.views.iter().map(of_view).collect(),
            walk: finished.walk.clone(),
            columns: [sheet(&finished.columns[0])?, sheet(&finished.columns[1])?],
        })
    }
}

/// A line of the file; what is wrong with it in words.
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
    let column = |column: &ColumnLine| -> std::result::Result<_, String> {
        let cells = column.cells.iter().map(|(text, caption, is_best)| {
            Ok(Cell { picture: picture(text)?, caption: caption.clone(), is_best: *is_best })
        });
        Ok(Column {
            title: column.title.clone(),
            lines: column.lines.clone(),
            warning: column.warning.clone(),
            cells: cells.collect::<std::result::Result<_, String>>()?,
        })
    };
    let sheet = |columns: &[ColumnLine]| columns.iter().map(column).collect::<std::result::Result<Vec<_>, String>>();
    let columns = [sheet(&line.columns[0])?, sheet(&line.columns[1])?];
    Ok(Finished { series: line.series, views, walk: line.walk, columns })
}

#[cfg(test)]
mod tests {
    use image::RgbImage;

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
        let column = Column { title: "t".into(), lines: vec!["l".into()], warning: None, cells: vec![cell] };
        Finished { series, views: vec![view], walk: None, columns: [vec![column.clone()], vec![column]] }
    }

    fn of(what: &str) -> Value {
        serde_json::json!({ "techniques": what, "size": [8, 6] })
    }

    #[test]
    fn what_was_finished_comes_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("journal");
        let mut journal = Journal::open(&path, &of("a")).expect("a new one");
        assert!(journal.finished.is_empty());
        journal.keep(&finished([0, 0])).expect("kept");
        journal.keep(&finished([0, 1])).expect("kept");
        drop(journal);
        let mut journal = Journal::open(&path, &of("a")).expect("the same comparison");
        let back = journal.take([0, 1]).expect("the second");
        let (old, new) = (&finished([0, 1]).views[0], &back.views[0]);
        assert_eq!(old.scores, new.scores);
        assert_eq!(serde_json::to_string(old).ok(), serde_json::to_string(new).ok());
        assert_eq!(back.columns[1][0].cells[0].picture, finished([0, 1]).columns[1][0].cells[0].picture);
        assert!(journal.take([0, 1]).is_none() && journal.take([0, 0]).is_some() && journal.take([1, 0]).is_none());
        journal.remove().expect("removed");
        assert!(!path.exists());
    }

    #[test]
    fn a_line_that_was_cut_off_is_dropped_and_what_comes_next_is_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("journal");
        let mut journal = Journal::open(&path, &of("a")).expect("a new one");
        journal.keep(&finished([0, 0])).expect("kept");
        journal.keep(&finished([0, 1])).expect("kept");
        let bytes = fs::read(&path).expect("readable");
        for cut in [1, 2, 50] {
            fs::write(&path, &bytes[..bytes.len() - cut]).expect("writable");
            let mut journal = Journal::open(&path, &of("a")).expect("all but its end");
            assert!(journal.finished.len() == 1 && journal.dropped > 0, "{cut}");
            journal.keep(&finished([0, 1])).expect("kept");
            assert_eq!(fs::read(&path).expect("readable"), bytes, "{cut}");
        }
    }

    #[test]
    fn what_is_no_journal_of_this_comparison_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("journal");
        drop(Journal::open(&path, &of("a")).expect("a new one"));
        let message = |of: &Value| Journal::open(&path, of).expect_err("refused").to_string();
        let other = message(&of("b"));
        assert!(other.contains("another comparison (techniques)") && other.contains("journal"), "{other}");
        for (bytes, word) in [
            (&b"no journal"[..], "no journal"),
            (b"no journal\n", "no journal"),
            (b"\xff\xfe\n", "no journal"),
            (b"{\"techniques\":\"a\",\"size\":[8,6]}\n{}\n", "line 2"),
        ] {
            fs::write(&path, bytes).expect("writable");
            assert!(message(&of("a")).contains(word), "{}", message(&of("a")));
            assert_eq!(fs::read(&path).expect("readable"), bytes, "what is not ours stays as it is");
        }
        assert!(Journal::open(&folder.path().join("no/such"), &of("a")).is_err());
    }
}
