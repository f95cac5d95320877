//! The figures of the papers, drawn anew.

mod list;
mod measure;
mod page;

pub use list::{Effort, Figure, Layout, figures};
pub use measure::{Measured, measure};
pub use page::page;
