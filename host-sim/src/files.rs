//! Files that appear whole or not at all.
//!
//! What is written goes to a temporary file in the same folder, which takes the place of
//! the old one when it is complete. On a full disk, or when the program is interrupted,
//! the old file stays as it was, or there is none.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// Temporary files that are being written: what an interrupted program has to remove.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file on its way: nobody sees it before [`finish`](Self::finish). Dropped, it leaves
/// nothing.
#[derive(Debug)]
pub struct Draft {
    target: PathBuf,
    file: Option<NamedTempFile>,
    temporary: PathBuf,
}

impl Draft {
    /// Begins the file `target`. A link is followed: what it leads to is replaced.
    ///
    /// # Errors
    /// A folder that cannot be written to; a target that is there and is no file, or is
    /// read-only.
    pub fn new(target: impl Into<PathBuf>) -> io::Result<Self> {
        let mut target = target.into();
        let old = match fs::canonicalize(&target) {
            Ok(path) => {
                target = path;
                Some(fs::metadata(&target)?)
            }
            Err(_) => None,
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".host-sim-");
        match &old {
            Some(old) if !old.is_file() => {
                return Err(io::Error::new(
                    io::ErrorKind::InvalidInput,
                    "it is there already, and is no file",
                ));
            }
            Some(old) if old.permissions().readonly() => {
                return Err(io::Error::new(
                    io::ErrorKind::PermissionDenied,
                    "the file is there already, and is read-only",
                ));
            }
            Some(old) => {
                builder.permissions(old.permissions());
            }
            #[cfg(unix)]
            None => {
                use std::os::unix::fs::PermissionsExt;
                // As any other new file; the default is for its owner alone.
                builder.permissions(fs::Permissions::from_mode(0o666));
            }
            #[cfg(not(unix))]
            None => {}
        }
        let folder = match target.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        // Held until the file is in the list: an interrupt finds all that there is.
        let mut list = unfinished();
        let file = builder.tempfile_in(folder)?;
        let temporary = fs::canonicalize(file.path()).unwrap_or_else(|_| file.path().into());
        list.insert(temporary.clone());
        Ok(Self {
            target,
            file: Some(file),
            temporary,
        })
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// Those of the file system; then everything is as before.
    pub fn finish(mut self) -> io::Result<()> {
        let file = self.file.take().ok_or(io::ErrorKind::NotFound)?;
        file.persist(&self.target)?;
        Ok(())
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let file = self.file.as_mut().ok_or(io::ErrorKind::NotFound)?;
        // Past the wrapper, whose errors name the temporary file.
        file.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        let file = self.file.as_mut().ok_or(io::ErrorKind::NotFound)?;
        file.as_file_mut().flush()
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        self.file = None;
        unfinished().remove(&self.temporary);
    }
}

/// Writes a file as a whole, unless there is one already; says whether there was none.
///
/// # Errors
/// As of [`Draft`]; then there is none.
pub fn write_new(target: impl Into<PathBuf>, bytes: &[u8]) -> io::Result<bool> {
    let mut draft = Draft::new(target)?;
    draft.write_all(bytes)?;
    let file = draft.file.take().ok_or(io::ErrorKind::NotFound)?;
    match file.persist_noclobber(&draft.target) {
        Ok(_) => Ok(true),
        Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
        Err(failed) => Err(failed.error),
    }
}

/// Writes a file as a whole; one that was there is replaced.
///
/// # Errors
/// As of [`Draft`]; then the old file is as it was, or there is none.
pub fn write(target: impl Into<PathBuf>, bytes: &[u8]) -> io::Result<()> {
    let mut draft = Draft::new(target)?;
    draft.write_all(bytes)?;
    draft.finish()
}

/// Ends the program by `end`, with every unfinished file removed and none begun meanwhile.
/// For a program that is interrupted.
pub fn abandon(end: impl FnOnce()) {
    let list = unfinished();
    for temporary in list.iter() {
        // What cannot be removed stays: there is nobody left to tell.
        let _ = fs::remove_file(temporary);
    }
    end();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_appears_when_it_is_finished_and_not_before() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("a.txt");
        write(&target, b"old").unwrap();
        let mut draft = Draft::new(&target).unwrap();
        draft.write_all(b"new, and longer").unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"old");
        draft.finish().unwrap();
        assert_eq!(fs::read(&target).unwrap(), b"new, and longer");
        let mut draft = Draft::new(&target).unwrap();
        draft.write_all(b"half").unwrap();
        drop(draft);
        assert_eq!(fs::read(&target).unwrap(), b"new, and longer");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn what_is_no_file_or_read_only_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let error = write(folder.path(), b"").unwrap_err().to_string();
        assert!(error.contains("no file"), "{error}");
        let target = folder.path().join("a.txt");
        fs::write(&target, "old").unwrap();
        let mut permissions = fs::metadata(&target).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&target, permissions).unwrap();
        let error = write(&target, b"new").unwrap_err().to_string();
        assert!(error.contains("read-only"), "{error}");
        assert_eq!(fs::read(&target).unwrap(), b"old");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_permissions_too() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("file", &link).unwrap();
        write(&link, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(
            fs::metadata(&file).unwrap().permissions().mode() & 0o777,
            0o640
        );
        assert_eq!(names(folder.path()), ["file", "link"]);
    }
}
