//! The output folder: all files appear in it together, or none does, and those of another run
//! go.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use host_sim::draw::{Coverage, DrawError};
use host_sim::files::Draft;
use thiserror::Error;

/// The files that explorations and surveys leave, `#` being any number.
const OF_RUNS: [&str; 14] = [
    "trace.csv",
    "summary.json",
    "explored.png",
    "explored.gif",
    "oblique.png",
    "coverage.csv",
    "coverage.png",
    "map.bt",
    "map.ply",
    "map.pgm",
    "map.yaml",
    "mission-#.plan",
    "mission-#.waypoints",
    "trajectory-#.csv",
];

/// Whether a run leaves a file of this name.
fn is_of_a_run(name: &str) -> bool {
    OF_RUNS.iter().any(|of_run| match of_run.split_once('#') {
        None => name == *of_run,
        Some((before, after)) => {
            let number = name
                .strip_prefix(before)
                .and_then(|it| it.strip_suffix(after));
            number.is_some_and(|it| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit()))
        }
    })
}

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
    names: BTreeSet<PathBuf>,
}

impl Folder {
    /// Makes the folder if need be, and makes sure that it can be written to.
    pub(super) fn open(path: PathBuf) -> Result<Self, FolderError> {
        match fs::create_dir_all(&path).and_then(|()| Draft::new(path.join("trace.csv"))) {
            Ok(_) => Ok(Self {
                path,
                files: Vec::new(),
                names: BTreeSet::new(),
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
            let mut writer = BufWriter::new(Draft::new(self.path.join(&name))?);
            fill(&mut writer)?;
            Ok(writer
                .into_inner()
                .map_err(io::IntoInnerError::into_error)?)
        };
        let file = filled().map_err(|problem| self.error(problem))?;
        self.files.push(file);
        self.names.insert(name.as_ref().to_path_buf());
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

    /// The same, and removes what another run has left, so that a folder is of one run.
    pub(super) fn close_run(self) -> Result<(), FolderError> {
        let (path, names) = (self.path.clone(), self.names.clone());
        self.close()?;
        let of_others = || {
            for entry in fs::read_dir(&path)? {
                let entry = entry?;
                let name = PathBuf::from(entry.file_name());
                let is_left = name.to_str().is_some_and(is_of_a_run) && !names.contains(&name);
                if is_left && entry.file_type()?.is_file() {
                    fs::remove_file(entry.path())?;
                }
            }
            io::Result::Ok(())
        };
        of_others().map_err(|problem| FolderError {
            path: path.clone(),
            problem: problem.into(),
        })
    }

    fn error(&self, problem: DrawError) -> FolderError {
        FolderError {
            path: self.path.clone(),
            problem,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_run_left_goes_and_what_is_not_of_runs_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        let (own, left) = (["map.bt", "mission-0.plan"], ["mission-10.plan", "map.ply"]);
        let others = [
            "mission-.plan",
            "mission-a.plan",
            "notes.txt",
            "trace.csv.old",
        ];
        for name in [&own[..], &left, &others].concat() {
            fs::write(path.join(name), "old").unwrap();
        }
        fs::create_dir(path.join("map.pgm")).unwrap();
        let mut run = Folder::open(path.to_path_buf()).unwrap();
        for name in own {
            run.put(name, "new").unwrap();
        }
        run.close_run().unwrap();
        for name in own {
            assert_eq!(fs::read_to_string(path.join(name)).unwrap(), "new");
        }
        assert!(left.iter().all(|name| !path.join(name).exists()));
        assert!(others.iter().all(|name| path.join(name).exists()));
        assert!(path.join("map.pgm").is_dir());
    }
}
