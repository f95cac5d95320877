//! Many runs, and what they say.
//!
//! ```text
//! Settings ─► Plan ─execute─► Row by Row into a Journal ─► Totals ─► Comparison ─► tables
//!                                    or into a Tally of Totals ─┘
//! ```
//! A [`Plan`] lists runs; [`execute`] does those of a [`Shard`] in parallel and hands over
//! one [`Row`] as each one ends; a [`Journal`] keeps the rows of interrupted and of shared
//! work, a [`Tally`] only what they come to; [`Totals`] pair planners with a reference. The
//! [`Settings`] lie beside all that as a file.

mod execute;
pub mod figures;
pub mod ghosts;
mod journal;
mod order;
#[cfg(feature = "parquet")]
mod parquet;
mod plan;
mod row;
mod settings;
mod shard;
mod statistics;
mod table;
mod tally;
mod totals;

pub use execute::{ExecuteError, execute};
pub use journal::{Journal, JournalError, to_csv};
pub use order::Order;
#[cfg(feature = "parquet")]
pub use parquet::write_parquet;
pub use plan::{Place, Plan, Setup, Site};
pub use row::{Key, Metric, Row};
pub use settings::{GivenMap, PlanError, Settings, this_program};
pub use shard::Shard;
pub use statistics::{Axes, Comparison, Conditions, Interval, compare, geometric_mean, mean};
pub use table::{comparisons_csv, markdown};
pub use tally::{Counted, Tally};
pub use totals::Totals;

#[cfg(test)]
mod tests;
