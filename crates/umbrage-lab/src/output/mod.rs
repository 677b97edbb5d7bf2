//! Files appear whole or not at all.
//!
//! Every output is first written in full into a hidden folder of the run, in its target's own
//! folder; only when all of them are there are they renamed into place. An error before that (a
//! full disk, a lost device, a bad frame) leaves nothing. An interrupted run leaves its finished
//! frames ([`clean_up_on_signals`]). The remains of a killed run are removed by the next.

use std::{
    collections::{HashMap, HashSet},
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

use crate::failure::{Failure, Result};

mod run_folder;
mod signals;

use run_folder::RunFolder;
pub use signals::clean_up_on_signals;

/// Most links that are followed, one to the next. Operating systems have the same limit.
const MOST_LINKS: usize = 40;

/// Returns `NAME.0007.png` for `NAME.png` and frame 7. A name without extension gets the number at
/// its end. Without a frame the name stays.
#[must_use]
pub fn numbered_file(path: &Path, frame: Option<u32>) -> PathBuf {
    match (frame, path.file_stem(), path.extension()) {
        (Some(frame), Some(stem), extension) => {
            let mut name = stem.to_os_string();
            name.push(format!(".{frame:04}"));
            if let Some(extension) = extension {
                name.push(".");
                name.push(extension);
            }
            path.with_file_name(name)
        }
        _ => path.to_path_buf(),
    }
}

/// Returns `DIR.0007` for `DIR` and frame 7.
#[must_use]
pub fn numbered_folder(path: &Path, frame: Option<u32>) -> PathBuf {
    match (frame, path.file_name()) {
        (Some(frame), Some(name)) => {
            let mut name = name.to_os_string();
            name.push(format!(".{frame:04}"));
            path.with_file_name(name)
        }
        _ => path.to_path_buf(),
    }
}

/// Refuses, before any work is done, outputs that cannot be written: two in one file, one that
/// would replace an input, a folder that does not exist or may not be written to.
///
/// # Errors
/// [`Failure::Input`] with the path.
pub fn check(files: &[&Path], folders: &[&Path], inputs: &[&Path]) -> Result<()> {
    if let Some(path) = files.iter().find(|path| path.is_dir()) {
        return Err(is_a_folder(path));
    }
    if let Some(path) = folders.iter().find(|path| path.exists() && !path.is_dir()) {
        return Err(is_no_folder(path));
    }
    let inputs: Vec<PathBuf> = inputs.iter().filter_map(|path| path.canonicalize().ok()).collect();
    let mut seen = HashSet::new();
    for path in files.iter().chain(folders) {
        if is_special(path) {
            continue;
        }
        let target = resolve(path)?;
        if inputs.contains(&target) {
            return Err(Failure::input(format!("{} is an input; write the output elsewhere", path.display())));
        }
        let folder = folder_of(&target);
        // The only sure way to learn whether a folder can be written to. The probe has no name
        // where systems allow it.
        tempfile::tempfile_in(folder).map_err(|error| Failure::file("write", path, &error))?;
        if !seen.insert(target) {
            return Err(Failure::input(format!("{} is named for two outputs; give each its own", path.display())));
        }
    }
    Ok(())
}

/// Outputs that are written but not yet in place. If dropped without [`Staged::commit`], they
/// vanish.
#[derive(Debug)]
pub struct Staged(Arc<Mutex<Pending>>);

/// State that is shared with the signal handler.
#[derive(Debug, Default)]
struct Pending {
    entries: Vec<Entry>,
    /// Number of entries, from the first on, that belong to finished frames.
    finished: usize,
    targets: HashSet<PathBuf>,
    /// Hidden folder of this run in each place of an output.
    folders: HashMap<PathBuf, RunFolder>,
}

#[derive(Debug)]
enum Entry {
    /// A file, written and closed, or a folder of such files.
    Written { path: PathBuf, target: PathBuf },
    /// A pipe, a terminal, or a device, which cannot be renamed. It is written when all other
    /// outputs are ready.
    Special { bytes: Vec<u8>, target: PathBuf },
}

impl Default for Staged {
    fn default() -> Self {
        let staged = Self(Arc::default());
        signals::watch(&staged.0);
        staged
    }
}

impl Staged {
    /// Writes a file that is to appear at `target`, in place of an existing file.
    ///
    /// # Errors
    /// [`Failure::Input`] with the target: it is a folder, its folder is missing, the disk is full,
    /// …
    pub fn file(&mut self, target: &Path, bytes: Vec<u8>) -> Result<()> {
        self.pending().file(target, bytes)
    }

    /// Writes a folder of files that is to appear at `target`. If that folder exists already, the
    /// files appear in it.
    ///
    /// # Errors
    /// As [`Staged::file`].
    pub fn folder(&mut self, target: &Path, files: Vec<(String, Vec<u8>)>) -> Result<()> {
        self.pending().folder(target, files)
    }

    /// Marks all files so far as whole frames, which are kept if the run is interrupted.
    pub fn finish_frame(&mut self) {
        let mut pending = self.pending();
        pending.finished = pending.entries.len();
    }

    /// Puts everything in place. A reader of a pipe that has closed it is no error.
    ///
    /// # Errors
    /// [`Failure::Input`] with the target that failed. Earlier targets are removed again, except
    /// that a replaced file stays replaced.
    pub fn commit(self) -> Result<()> {
        // Locked to the end: a signal waits until everything is in place.
        self.pending().commit()
    }

    fn pending(&self) -> MutexGuard<'_, Pending> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Pending {
    fn file(&mut self, target: &Path, bytes: Vec<u8>) -> Result<()> {
        if is_special(target) {
            self.entries.push(Entry::Special { bytes, target: target.to_path_buf() });
            return Ok(());
        }
        if target.is_dir() {
            return Err(is_a_folder(target));
        }
        let resolved = self.claim(target)?;
        let path = self
            .run_folder(&resolved)
            .and_then(|folder| folder.write(&bytes))
            .map_err(|error| Failure::file("write", target, &error))?;
        self.entries.push(Entry::Written { path, target: resolved });
        Ok(())
    }

    fn folder(&mut self, target: &Path, files: Vec<(String, Vec<u8>)>) -> Result<()> {
        if target.is_dir() {
            return files.into_iter().try_for_each(|(name, bytes)| self.file(&target.join(name), bytes));
        }
        if target.exists() {
            return Err(is_no_folder(target));
        }
        let resolved = self.claim(target)?;
        let path = self
            .run_folder(&resolved)
            .and_then(|folder| folder.write_folder(&files))
            .map_err(|error| Failure::file("write", target, &error))?;
        self.entries.push(Entry::Written { path, target: resolved });
        Ok(())
    }

    fn commit(&mut self) -> Result<()> {
        let (special, renamed): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.entries).into_iter().partition(|entry| matches!(entry, Entry::Special { .. }));
        let mut created = Vec::new();
        let placed = special.into_iter().chain(renamed).try_for_each(|entry| place(entry, &mut created));
        self.folders.clear();
        placed.inspect_err(|_| {
            for path in &created {
                // Best effort: the error that is already on its way says what went wrong.
                drop(if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) });
            }
        })
    }

    /// Puts finished frames in place, forgets everything else, and returns the number of files or
    /// folders.
    #[cfg(unix)]
    fn keep_finished(&mut self) -> usize {
        let entries = std::mem::take(&mut self.entries);
        // A pipe may have no reader who would end the wait for one.
        let written = entries.into_iter().take(self.finished).filter(|entry| matches!(entry, Entry::Written { .. }));
        // What cannot be put in place goes with the rest: there is nobody left to tell.
        let kept = written.filter_map(|entry| place(entry, &mut Vec::new()).ok()).count();
        self.folders.clear();
        kept
    }

    /// Returns this run's hidden folder beside a target.
    fn run_folder(&mut self, target: &Path) -> io::Result<&mut RunFolder> {
        let place = folder_of(target);
        if !self.folders.contains_key(place) {
            self.folders.insert(place.to_path_buf(), RunFolder::new(place)?);
        }
        self.folders.get_mut(place).ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    /// Resolves `target` and makes sure that nothing else is staged for it.
    fn claim(&mut self, target: &Path) -> Result<PathBuf> {
        let resolved = resolve(target)?;
        if self.targets.insert(resolved.clone()) {
            Ok(resolved)
        } else {
            Err(Failure::input(format!("{} is named for two outputs; give each its own", target.display())))
        }
    }
}

fn is_a_folder(path: &Path) -> Failure {
    Failure::input(format!("{} is a folder; give the name of a file", path.display()))
}

fn is_no_folder(path: &Path) -> Failure {
    Failure::input(format!("{} is not a folder; give the name of one", path.display()))
}

/// Puts one entry in place, and adds it to `created` if nothing was there before.
fn place(entry: Entry, created: &mut Vec<PathBuf>) -> Result<()> {
    match entry {
        Entry::Special { bytes, target } => {
            let written = fs::OpenOptions::new().write(true).open(&target).and_then(|mut file| {
                file.write_all(&bytes)?;
                file.flush()
            });
            match written {
                Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::file("write", &target, &error)),
                _ => Ok(()),
            }
        }
        Entry::Written { path, target } => {
            let is_new = !target.exists();
            fs::rename(&path, &target).map_err(|error| Failure::file("write", &target, &error))?;
            if is_new {
                created.push(target);
            }
            Ok(())
        }
    }
}

/// Returns whether the path leads to something that is neither a file nor a folder.
fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|meta| !meta.is_file() && !meta.is_dir())
}

/// Resolves links, `.` and `..` in a path. Its last part need not exist, nor the target of a link
/// at its end.
fn resolve(path: &Path) -> Result<PathBuf> {
    let failed = |error: io::Error| Failure::file("write", path, &error);
    let mut target = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        match target.canonicalize() {
            Ok(existing) => return Ok(existing),
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(failed(error)),
            Err(_) => {}
        }
        match target.read_link() {
            Ok(link) => target = folder_of(&target).join(link),
            Err(_) => break,
        }
    }
    let name = target.file_name().ok_or_else(|| {
        Failure::input(format!("{:?} is not the name of a file to write", path.display().to_string()))
    })?;
    let folder = folder_of(&target).canonicalize().map_err(failed)?;
    Ok(folder.join(name))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .expect("the folder can be read")
            .map(|entry| entry.expect("the entry can be read").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn numbers_stand_before_the_extension() {
        assert_eq!(numbered_file(Path::new("a/b.png"), Some(3)), Path::new("a/b.0003.png"));
        assert_eq!(numbered_file(Path::new("b.c.png"), Some(12345)), Path::new("b.c.12345.png"));
        assert_eq!(numbered_file(Path::new("answers"), Some(0)), Path::new("answers.0000"));
        assert_eq!(numbered_file(Path::new("b.png"), None), Path::new("b.png"));
        assert_eq!(numbered_folder(Path::new("maps.v1/"), Some(1)), Path::new("maps.v1.0001"));
        assert_eq!(numbered_folder(Path::new("maps"), None), Path::new("maps"));
    }

    #[test]
    fn nothing_appears_before_the_commit_and_everything_after_it() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("old.txt"), "old").expect("the old file");
        let mut staged = Staged::default();
        staged.file(&at("new.txt"), b"new".to_vec()).expect("staged");
        staged.file(&at("old.txt"), b"newer".to_vec()).expect("staged");
        staged.folder(&at("maps"), vec![("0.png".into(), vec![1]), ("1.png".into(), vec![2])]).expect("staged");
        assert_eq!(names(folder.path()).len(), 2, "the old file and one hidden folder");
        assert!(!at("new.txt").exists() && !at("maps").exists(), "nothing is in place yet");
        assert_eq!(fs::read(at("old.txt")).expect("readable"), b"old");
        staged.commit().expect("committed");
        assert_eq!(names(folder.path()), ["maps", "new.txt", "old.txt"]);
        assert_eq!(names(&at("maps")), ["0.png", "1.png"]);
        assert_eq!(fs::read(at("old.txt")).expect("readable"), b"newer");

        let mut again = Staged::default();
        again.folder(&at("maps"), vec![("0.png".into(), vec![7])]).expect("into a folder that is there");
        again.commit().expect("committed");
        assert_eq!(fs::read(at("maps/0.png")).expect("readable"), [7]);
        assert_eq!(names(&at("maps")), ["0.png", "1.png"]);
    }

    #[test]
    fn a_failure_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| folder.path().join(name);
        let mut staged = Staged::default();
        staged.file(&at("a.txt"), b"a".to_vec()).expect("staged");
        staged.folder(&at("maps"), vec![("0.png".into(), vec![1])]).expect("staged");
        let error = staged.file(&at("missing/b.txt"), b"b".to_vec()).expect_err("the folder is missing");
        assert!(error.to_string().contains("missing/b.txt"), "{error}");
        assert!(matches!(error, Failure::Input(_)), "{error:?}");
        drop(staged);
        assert_eq!(names(folder.path()), [""; 0]);

        // A target that turns into a folder after it was staged: what came before it is taken back.
        let mut staged = Staged::default();
        staged.file(&at("a.txt"), b"a".to_vec()).expect("staged");
        staged.file(&at("b.txt"), b"b".to_vec()).expect("staged");
        fs::create_dir_all(at("b.txt/c")).expect("a folder in the way");
        staged.commit().expect_err("a folder is in the way");
        assert_eq!(names(folder.path()), ["b.txt"]);
    }

    #[test]
    fn one_place_for_one_output() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("scene.glb"), "input").expect("the input");
        let (a, other_a) = (at("a.png"), folder.path().join(".").join("a.png"));
        assert!(check(&[&a, &at("b.png")], &[&at("maps")], &[&at("scene.glb")]).is_ok());
        assert!(check(&[&a, &other_a], &[], &[]).is_err(), "the same file by two names");
        assert!(check(&[&a], &[&a], &[]).is_err(), "a file and a folder by one name");
        assert!(check(&[&at("scene.glb")], &[], &[&at("scene.glb")]).is_err(), "an input would be replaced");
        assert!(check(&[&at("no/a.png")], &[], &[]).is_err(), "a folder that is not there");
        assert!(check(&[Path::new("")], &[], &[]).is_err(), "no name at all");
        assert!(check(&[folder.path()], &[], &[]).is_err(), "a folder where a file should be");
        assert!(check(&[], &[&at("scene.glb")], &[]).is_err(), "a file where a folder should be");
        assert_eq!(names(folder.path()), ["scene.glb"]);
        let mut staged = Staged::default();
        staged.file(&a, vec![1]).expect("staged");
        assert!(staged.file(&other_a, vec![2]).is_err(), "staged twice");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_though_it_leads_to_nothing_yet() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("other")).expect("a folder");
        symlink("other/new.txt", at("relative")).expect("a link");
        symlink(at("relative"), at("twice")).expect("a link to a link");
        symlink("round", at("round")).expect("a link to itself");
        symlink("missing/new.txt", at("lost")).expect("a link into a folder that is not there");
        assert!(check(&[&at("twice")], &[], &[]).is_ok());
        assert!(check(&[&at("twice"), &at("relative")], &[], &[]).is_err(), "one place by two names");
        assert!(check(&[&at("round")], &[], &[]).is_err() && check(&[&at("lost")], &[], &[]).is_err());
        let mut staged = Staged::default();
        staged.file(&at("twice"), b"new".to_vec()).expect("staged");
        staged.commit().expect("committed");
        assert_eq!(fs::read(at("other/new.txt")).expect("where the links lead"), b"new");
        assert!(at("twice").is_symlink() && at("relative").is_symlink(), "links stay links");
        assert_eq!(names(&at("other")), ["new.txt"]);
    }

    #[cfg(unix)]
    #[test]
    fn an_interrupted_run_keeps_its_finished_frames() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| folder.path().join(name);
        let mut staged = Staged::default();
        staged.file(&at("a.0.png"), vec![1]).expect("staged");
        staged.folder(&at("maps.0"), vec![("0.png".into(), vec![1])]).expect("staged");
        staged.finish_frame();
        staged.file(&at("a.1.png"), vec![2]).expect("staged");
        assert_eq!(staged.pending().keep_finished(), 2);
        assert_eq!(names(folder.path()), ["a.0.png", "maps.0"]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_is_written_to_and_not_replaced() {
        let mut staged = Staged::default();
        staged.file(Path::new("/dev/null"), vec![1]).expect("staged");
        staged.commit().expect("written");
        assert!(is_special(Path::new("/dev/null")), "still a device");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut staged = Staged::default();
        staged.file(&folder.path().join("a"), vec![1]).expect("staged");
        staged.file(Path::new("/dev/full"), vec![1]).expect("staged");
        let error = staged.commit().expect_err("the device is full");
        assert!(error.to_string().contains("/dev/full"), "{error}");
        assert_eq!(names(folder.path()), [""; 0]);
    }
}
