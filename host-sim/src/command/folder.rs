//! The output folder: all files appear in it together, or none does.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use host_sim::draw::{Coverage, DrawError};
use host_sim::files::Draft;
use thiserror::Error;

/// A folder that cannot be written to.
#[derive(Debug, Error)]
#[error("{}: {problem}; choose another folder with --out", path.display())]
pub(super) struct FolderError {
    path: PathBuf,
    problem: DrawError,
}

/// Files on their way into a folder.
pub(super) struct Folder {
    path: PathBuf,
    files: Vec<Draft>,
}

impl Folder {
    /// Makes the folder if need be, and makes sure that it can be written to.
    pub(super) fn open(path: PathBuf) -> Result<Self, FolderError> {
        match fs::create_dir_all(&path).and_then(|()| Draft::new(path.join("trace.csv"))) {
            Ok(_) => Ok(Self {
                path,
                files: Vec::new(),
            }),
            Err(problem) => Err(FolderError {
                path,
                problem: problem.into(),
            }),
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Prepares a file.
    pub(super) fn write(
        &mut self,
        name: impl AsRef<Path>,
        fill: impl FnOnce(&mut dyn Write) -> Result<(), DrawError>,
    ) -> Result<(), FolderError> {
        let filled = || {
            let mut writer = BufWriter::new(Draft::new(self.path.join(name))?);
            fill(&mut writer)?;
            Ok(writer
                .into_inner()
                .map_err(io::IntoInnerError::into_error)?)
        };
        let file = filled().map_err(|problem| self.error(problem))?;
        self.files.push(file);
        Ok(())
    }

    /// Prepares a file that holds `text`.
    pub(super) fn put(&mut self, name: impl AsRef<Path>, text: &str) -> Result<(), FolderError> {
        self.write(name, |file| Ok(file.write_all(text.as_bytes())?))
    }

    /// Prepares what had been seen over time, as a table and as a curve.
    pub(super) fn write_coverage(&mut self, coverage: &Coverage) -> Result<(), FolderError> {
        self.write("coverage.csv", |file| Ok(coverage.write_csv(file)?))?;
        self.write("coverage.png", |file| coverage.write_png(file))
    }

    /// Puts all prepared files in place.
    pub(super) fn close(mut self) -> Result<(), FolderError> {
        for file in std::mem::take(&mut self.files) {
            file.finish().map_err(|failed| self.error(failed.into()))?;
        }
        Ok(())
    }

    fn error(&self, problem: DrawError) -> FolderError {
        FolderError {
            path: self.path.clone(),
            problem,
        }
    }
}
