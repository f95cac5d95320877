//! Many runs, and what they say.
//!
//! ```text
//! Plan ──execute──► Row by Row into a Journal ──► Comparison ──► tables
//! ```
//! A [`Plan`] lists runs; [`execute`] does them in parallel and hands over one
//! [`Row`] as each one ends; a [`Journal`] keeps the rows of interrupted and of
//! shared work; [`compare`] pairs planners with a reference.

mod execute;
pub mod figures;
pub mod ghosts;
mod journal;
#[cfg(feature = "parquet")]
mod parquet;
mod plan;
mod row;
mod statistics;
mod table;

pub use execute::{ExecuteError, Shard, execute};
pub use journal::{Journal, JournalError, to_csv};
#[cfg(feature = "parquet")]
pub use parquet::write_parquet;
pub use plan::{Place, Plan, Setup, Site};
pub use row::{Key, Metric, Row};
pub use statistics::{Comparison, Conditions, Interval, compare, geometric_mean, mean};
pub use table::{comparisons_csv, markdown};

#[cfg(test)]
mod tests;
