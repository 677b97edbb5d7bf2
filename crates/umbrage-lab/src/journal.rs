//! Journals: the finished parts of a long run, kept in a file so that a run that is cut off can
//! continue.
//!
//! The first line describes the run; each further line holds a finished part. A line counts once
//! its end is written. [`crate::compare`] keeps the views of a comparison in one, [`crate::tune`]
//! candidates.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Seek as _, Write as _},
    path::{Path, PathBuf},
};

use serde::Serialize;
use serde_json::Value;

use crate::failure::{Failure, Result};

/// Kind of a journal, for messages.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// The option that names the file.
    pub option: &'static str,
    /// Name of the kind of run.
    pub run: &'static str,
}

impl Kind {
    /// Makes the error about a file: `what` is wrong with it.
    #[must_use]
    pub fn refuse(self, path: &Path, what: impl std::fmt::Display) -> Failure {
        Failure::input(format!("{} {}: {what}", self.option, path.display()))
    }

    fn no_journal(self, path: &Path) -> Failure {
        self.refuse(path, format_args!("it is not a journal of a {}; give another file", self.run))
    }
}

/// Content of a file.
#[derive(Clone, Debug)]
pub struct Kept<T> {
    /// Description of the run; `None` in a file that is empty or was cut off in its first line.
    pub of: Option<Value>,
    /// Finished parts.
    pub finished: Vec<T>,
    /// Number of bytes of a last line that was cut off.
    pub dropped: usize,
    /// Number of bytes of whole lines.
    whole: usize,
}

/// Reads a file of this kind. `line` reads a finished part from a line; its error says what is
/// wrong with the line. `expected` is the description of the expected run; a file of another run is
/// refused before its further lines are read.
///
/// # Errors
/// [`Failure::Input`] with the file: it cannot be read, is no journal, belongs to another run than
/// expected, or has a damaged line.
pub fn read<T>(
    path: &Path,
    kind: Kind,
    expected: Option<&Value>,
    line: impl Fn(&str) -> std::result::Result<T, String>,
) -> Result<Kept<T>> {
    let bytes = fs::read(path).map_err(|error| Failure::file("read", path, &error))?;
    let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    let text = std::str::from_utf8(&bytes[..whole]).map_err(|_| kind.no_journal(path))?;
    let mut lines = text.lines();
    let header = lines.next().map(serde_json::from_str::<Value>).transpose().map_err(|_| kind.no_journal(path))?;
    if let (Some(header), Some(expected)) = (&header, expected)
        && let Some(what) = difference(header, expected)
    {
        let run = kind.run;
        return Err(kind.refuse(
            path,
            format_args!("it holds another {run} ({what}); repeat that one's options, or give another file"),
        ));
    }
    let mut finished = Vec::new();
    for (number, text) in (2..).zip(lines) {
        let damaged =
            |error| kind.refuse(path, format_args!("line {number} is damaged: {error}; delete that line, or the file"));
        finished.push(line(text).map_err(damaged)?);
    }
    Ok(Kept { of: header, finished, dropped: bytes.len() - whole, whole })
}

/// A journal whose file is open for further parts.
#[derive(Debug)]
pub struct Journal<T> {
    path: PathBuf,
    file: File,
    /// Parts that were finished before.
    pub finished: Vec<T>,
    /// Number of bytes of a last line that was cut off, which are dropped.
    pub dropped: usize,
}

impl<T> Journal<T> {
    /// Opens the journal at `path` or begins one. `of` describes the run; a journal of any other
    /// run is refused.
    ///
    /// # Errors
    /// [`Failure::Input`] with the file: it cannot be read or written, is no journal, belongs to
    /// another run, or has a damaged line.
    pub fn open(
        path: &Path,
        kind: Kind,
        of: &impl Serialize,
        line: impl Fn(&str) -> std::result::Result<T, String>,
    ) -> Result<Self> {
        let failed = |error: io::Error| Failure::file("write", path, &error);
        let of = serde_json::to_value(of).map_err(|error| Failure::other(format!("no JSON of the run: {error}")))?;
        let nothing = Kept { of: None, finished: Vec::new(), dropped: 0, whole: 0 };
        let kept = if path.exists() { read(path, kind, Some(&of), line)? } else { nothing };
        if kept.of.is_none() && kept.dropped > 0 {
            // A first line that was cut off begins like ours; anything else belongs to somebody.
            let bytes = fs::read(path).map_err(|error| Failure::file("read", path, &error))?;
            if !text_of(&of)?.starts_with(&bytes) {
                return Err(kind.no_journal(path));
            }
        }
        let mut file = OpenOptions::new().write(true).create(true).truncate(false).open(path).map_err(failed)?;
        file.set_len(kept.whole as u64).and_then(|()| file.seek(io::SeekFrom::End(0))).map_err(failed)?;
        let mut journal = Self { path: path.to_owned(), file, finished: kept.finished, dropped: kept.dropped };
        if kept.of.is_none() {
            journal.append(&of)?;
        }
        Ok(journal)
    }

    /// Returns the path of the file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a line.
    ///
    /// # Errors
    /// [`Failure::Input`] if the file cannot be written.
    pub fn append(&mut self, line: &impl Serialize) -> Result<()> {
        let written = self.file.write_all(&text_of(line)?).and_then(|()| self.file.sync_data());
        written.map_err(|error| Failure::file("write", &self.path, &error))
    }

    /// Removes the file, whose content is in the outputs.
    ///
    /// # Errors
    /// [`Failure::Input`] if it cannot be removed.
    pub fn remove(self) -> Result<()> {
        fs::remove_file(&self.path).map_err(|error| Failure::file("remove", &self.path, &error))
    }
}

/// Returns a line with its end.
fn text_of(line: &impl Serialize) -> Result<Vec<u8>> {
    let mut bytes =
        serde_json::to_vec(line).map_err(|error| Failure::other(format!("no JSON of what is finished: {error}")))?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Returns the name of the first field in which two descriptions of a run differ.
#[must_use]
pub fn difference(old: &Value, new: &Value) -> Option<String> {
    let (Some(old), Some(new)) = (old.as_object(), new.as_object()) else { return Some("no description".into()) };
    let names = old.keys().chain(new.keys());
    names.into_iter().find(|name| old.get(*name) != new.get(*name)).cloned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: Kind = Kind { option: "--resume", run: "comparison" };

    fn of(what: &str) -> Value {
        serde_json::json!({ "techniques": what, "size": [8, 6] })
    }

    fn number(line: &str) -> std::result::Result<f64, String> {
        serde_json::from_str(line).map_err(|error| error.to_string())
    }

    #[test]
    fn a_line_that_was_cut_off_is_dropped_and_what_comes_next_is_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("journal");
        let mut journal = Journal::open(&path, KIND, &of("a"), number).expect("a new one");
        for value in [1.25, 1.0 / 3.0] {
            journal.append(&value).expect("kept");
        }
        let bytes = fs::read(&path).expect("readable");
        for cut in [1, 2, 5] {
            fs::write(&path, &bytes[..bytes.len() - cut]).expect("writable");
            let mut journal = Journal::open(&path, KIND, &of("a"), number).expect("all but its end");
            assert!(journal.finished == [1.25] && journal.dropped > 0, "{cut}");
            journal.append(&(1.0 / 3.0)).expect("kept");
            assert_eq!(fs::read(&path).expect("readable"), bytes, "{cut}");
        }
        for cut in [bytes.len() - 3, bytes.len()] {
            fs::write(&path, &bytes[..bytes.len() - cut]).expect("writable");
            assert!(Journal::open(&path, KIND, &of("a"), number).expect("begun anew").finished.is_empty());
        }
    }

    #[test]
    fn what_is_no_journal_of_this_run_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("journal");
        drop(Journal::open(&path, KIND, &of("a"), number).expect("a new one"));
        let message = |of: &Value| Journal::open(&path, KIND, of, number).expect_err("refused").to_string();
        let other = message(&of("b"));
        assert!(other.contains("another comparison (techniques)") && other.contains("journal"), "{other}");
        for (bytes, word) in [
            (&b"no journal"[..], "not a journal"),
            (b"no journal\n", "not a journal"),
            (b"\xff\xfe\n", "not a journal"),
            (b"{\"techniques\":\"a\",\"size\":[8,6]}\n{}\n", "line 2"),
        ] {
            fs::write(&path, bytes).expect("writable");
            assert!(message(&of("a")).contains(word), "{}", message(&of("a")));
            assert_eq!(fs::read(&path).expect("readable"), bytes, "what is not ours stays as it is");
        }
        assert!(Journal::open(&folder.path().join("no/such"), KIND, &of("a"), number).is_err());
        assert!(read(&folder.path().join("none"), KIND, None, number).is_err());
    }
}
