//! All chips of a run.

use std::cell::{OnceCell, RefCell};
use std::path::PathBuf;
use std::rc::Rc;

use planner_core::Planner;

use super::emulator::{Chip, Machine};
use super::error::ChipError;
use super::proxy::Proxy;
use crate::measured::Measured;
use crate::planners::{PlannerKind, Setup};
use crate::run::Host;

/// Hosts the planners of a run in emulated chips.
#[derive(Clone)]
pub struct Swarm {
    machine: Machine,
    image: PathBuf,
    book: Rc<Book>,
}

/// What all chips of a run write down.
pub(super) struct Book {
    /// The first failure. The run is worth nothing after it, and ends.
    pub(super) failure: OnceCell<ChipError>,
    pub(super) measured: RefCell<Measured>,
}

impl Swarm {
    /// Chips of this kind, which run the image at that path.
    pub fn new(machine: Machine, image: PathBuf) -> Self {
        let measured = Measured {
            machine: machine.to_string(),
            ..Measured::default()
        };
        Self {
            machine,
            image,
            book: Rc::new(Book {
                failure: OnceCell::new(),
                measured: measured.into(),
            }),
        }
    }

    /// What the chips took, when the run is over.
    ///
    /// # Errors
    /// Why the run failed.
    pub fn finish(self) -> Result<Measured, ChipError> {
        let book = Rc::try_unwrap(self.book);
        let Ok(book) = book else {
            unreachable!("the robots are gone with the run");
        };
        match book.failure.into_inner() {
            Some(failure) => Err(failure),
            None => Ok(book.measured.into_inner()),
        }
    }
}

impl Host for Swarm {
    fn planner<const TW: usize, const TH: usize>(
        &self,
        kind: PlannerKind,
        setup: Setup,
    ) -> Box<dyn Planner<TW, TH>> {
        let chip = Chip::start(setup.id, self.machine, &self.image);
        Box::new(Proxy::new(chip, self.book.clone(), kind, setup))
    }

    fn has_failed(&self) -> bool {
        self.book.failure.get().is_some()
    }
}
