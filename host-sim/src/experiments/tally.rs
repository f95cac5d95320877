//! Worlds added up as they end, for comparisons too large to keep their rows.

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::journal::{JournalError, PARTS, parts};
use super::order::Order;
use super::row::Row;
use super::settings::Settings;
use super::shard::Shard;
use super::totals::Totals;
use crate::files;

/// Between two times that a tally is written.
const PAUSE: Duration = Duration::from_secs(1);

/// What the worlds of a shard have come to, in `parts/I-of-N.json` of an output folder. The
/// file is written anew now and then: an interruption costs the worlds of the last second
/// and those that had begun.
#[derive(Debug)]
pub struct Tally {
    path: PathBuf,
    settings: Settings,
    order: Order,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    counted: Counted,
    /// The rows of worlds some of whose runs have not ended.
    pending: HashMap<usize, Vec<Row>>,
    written: Instant,
}

/// Worlds, and what their runs come to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counted {
    /// Numbers of the worlds in the plan.
    #[serde(with = "ranges")]
    pub worlds: BTreeSet<usize>,
    /// Their runs, added up.
    pub totals: Totals,
}

impl Tally {
    /// Goes on with the tally of a shard, or begins it.
    ///
    /// # Errors
    /// A file that cannot be read, or holds something else.
    pub fn open(out: &Path, shard: Shard, settings: &Settings) -> Result<Self, JournalError> {
        let path = out.join(PARTS).join(format!("{shard}.json"));
        let counted = match path.exists() {
            true => Counted::read(&path)?,
            false => Counted::default(),
        };
        let tally = Self {
            path,
            settings: settings.clone(),
            order: settings.order(),
            state: Mutex::new(State {
                counted,
                pending: HashMap::new(),
                written: Instant::now(),
            }),
        };
        tally.write()?;
        Ok(tally)
    }

    /// Adds a row.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn add(&self, row: Row) -> Result<(), JournalError> {
        let Some(world) = self.order.world(&row.world) else {
            return Ok(());
        };
        {
            let mut state = self.state.lock().expect("nobody panics while adding");
            let rows = state.pending.entry(world).or_default();
            rows.push(row);
            if rows.len() < self.order.runs_a_world() {
                return Ok(());
            }
            let rows = state.pending.remove(&world).unwrap_or_default();
            let Settings {
                reference, metric, ..
            } = self.settings;
            state.counted.worlds.insert(world);
            state.counted.totals.add_world(&rows, reference, metric);
            if state.written.elapsed() < PAUSE {
                return Ok(());
            }
        }
        self.write()
    }

    /// What has been counted so far.
    pub fn counted(&self) -> Counted {
        let state = self.state.lock().expect("nobody panics while adding");
        state.counted.clone()
    }

    /// Writes the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self) -> Result<(), JournalError> {
        let mut state = self.state.lock().expect("nobody panics while adding");
        state.written = Instant::now();
        let text = serde_json::to_string(&state.counted).expect("a tally is plain");
        let folder = self.path.parent().unwrap_or(Path::new(""));
        fs::create_dir_all(folder)
            .and_then(|()| files::write(&self.path, text.as_bytes()))
            .map_err(|problem| JournalError::Io {
                path: self.path.clone(),
                problem,
            })
    }
}

impl Counted {
    fn read(path: &Path) -> Result<Self, JournalError> {
        let io = |problem| JournalError::Io {
            path: path.into(),
            problem,
        };
        let text = fs::read_to_string(path).map_err(io)?;
        serde_json::from_str(&text).map_err(|problem| io(io::Error::other(problem)))
    }

    /// Adds the tallies of all shards in an output folder.
    ///
    /// # Errors
    /// Files that cannot be read; one with a world that was there before, which nobody can
    /// take out of a sum again.
    pub fn read_all(&mut self, out: &Path) -> Result<(), JournalError> {
        for path in parts(out, "json")? {
            let part = Self::read(&path)?;
            if let Some(&world) = part.worlds.intersection(&self.worlds).next() {
                return Err(JournalError::Twice { path, world });
            }
            self.worlds.extend(part.worlds);
            self.totals.add(&part.totals);
        }
        Ok(())
    }
}

/// A set of numbers as the first and the last of each run of neighbours.
mod ranges {
    use std::collections::BTreeSet;

    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        set: &BTreeSet<usize>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        let mut ranges: Vec<(usize, usize)> = Vec::new();
        for &number in set {
            match ranges.last_mut() {
                Some((_, last)) if *last + 1 == number => *last = number,
                _ => ranges.push((number, number)),
            }
        }
        ranges.serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<BTreeSet<usize>, D::Error> {
        let ranges = Vec::<(usize, usize)>::deserialize(from)?;
        Ok(ranges
            .into_iter()
            .flat_map(|(first, last)| first..=last)
            .collect())
    }
}
