//! The figures of the papers, drawn anew.

mod list;
mod measure;
mod page;
mod surveys;
mod tables;

pub use list::{Effort, Figure, Layout, figures};
pub use measure::{Measured, measure};
pub use page::{Drawn, page};
pub use surveys::{FIGURES as SURVEYS, figure as survey};
