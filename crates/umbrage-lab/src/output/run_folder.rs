//! The hidden folder in which a run keeps unfinished outputs, beside their final place.
//!
//! A run holds a lock on a file in its folder for as long as it lives. The system releases the lock
//! of a run that was killed, so the next run that writes to the same place recognises abandoned
//! folders.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

use tempfile::TempDir;

/// Prefix of the names of such folders.
const PREFIX: &str = ".umbrage-run-";
const LOCK: &str = "lock";

/// One run's folder in one place. If dropped, it vanishes with its content.
#[derive(Debug)]
pub(super) struct RunFolder {
    folder: TempDir,
    /// File that is locked while this run lives.
    _lock: fs::File,
    /// Number of names that were given.
    given: usize,
}

impl RunFolder {
    /// Makes a folder of this run in `place`, after removing folders of killed runs.
    pub fn new(place: &Path) -> io::Result<Self> {
        remove_abandoned(place);
        let folder = tempfile::Builder::new().prefix(PREFIX).tempdir_in(place)?;
        // Locked before it has its name, so that no other run finds the name without the lock.
        let unnamed = folder.path().join("unlocked");
        let lock = fs::File::create(&unnamed)?;
        // A file system without locks has no cleaning up either.
        drop(lock.lock());
        fs::rename(&unnamed, folder.path().join(LOCK))?;
        Ok(Self { folder, _lock: lock, given: 0 })
    }

    /// Writes a file in full and returns its path.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<PathBuf> {
        let path = self.next();
        write_whole(&path, bytes)?;
        Ok(path)
    }

    /// Writes a folder of files in full and returns its path.
    pub fn write_folder(&mut self, files: &[(String, Vec<u8>)]) -> io::Result<PathBuf> {
        let path = self.next();
        fs::create_dir(&path)?;
        files.iter().try_for_each(|(name, bytes)| write_whole(&path.join(name), bytes))?;
        Ok(path)
    }

    fn next(&mut self) -> PathBuf {
        self.given += 1;
        self.folder.path().join(format!("{:06}", self.given))
    }
}

fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = fs::File::create_new(path)?;
    file.write_all(bytes)?;
    // Some file systems find out that they are full only now.
    file.sync_all()
}

/// Removes folders whose runs have ended. A folder that cannot be removed is ignored.
fn remove_abandoned(place: &Path) {
    let Ok(entries) = fs::read_dir(place) else { return };
    for entry in entries.flatten() {
        if entry.file_name().to_string_lossy().starts_with(PREFIX)
            && fs::File::open(entry.path().join(LOCK)).is_ok_and(|lock| lock.try_lock().is_ok())
        {
            drop(fs::remove_dir_all(entry.path()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_killed_run_left_goes_and_what_another_run_holds_stays() {
        let place = tempfile::tempdir().expect("a temporary folder");
        let abandoned = place.path().join(format!("{PREFIX}abandoned"));
        fs::create_dir(&abandoned).expect("a folder");
        fs::write(abandoned.join(LOCK), "").expect("its lock, which nobody holds");
        fs::write(abandoned.join("000001"), "half").expect("what was not finished");
        let mut first = RunFolder::new(place.path()).expect("a folder");
        assert!(!abandoned.exists());
        let kept = first.write(b"whole").expect("a file");
        let second = RunFolder::new(place.path()).expect("another");
        assert_eq!(fs::read(&kept).expect("still there"), b"whole");
        drop((first, second));
        assert_eq!(fs::read_dir(place.path()).expect("readable").count(), 0);
    }
}
