//! What the calls of planners on chips, and their image, take.

use std::collections::BTreeMap;
use std::fmt;

#[cfg(unix)]
use bridge::Memory;
use serde::Serialize;

/// A call of a planner that is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "they are the verbs of Planner")]
pub enum Call {
    Observe,
    Tick,
    Report,
    Transmit,
    Receive,
    Hear,
    Join,
    TakeChanged,
    Adopt,
}

/// The name of the verb.
impl fmt::Display for Call {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Observe => "observe",
            Self::Tick => "tick",
            Self::Report => "report",
            Self::Transmit => "transmit",
            Self::Receive => "receive",
            Self::Hear => "hear",
            Self::Join => "join",
            Self::TakeChanged => "take_changed",
            Self::Adopt => "adopt",
        })
    }
}

/// Instructions and stack of all calls of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Number of calls.
    pub calls: u64,
    /// Instructions of one call on average.
    pub mean: u64,
    /// Instructions of the most expensive call.
    pub largest: u64,
    /// The most stack that a call took.
    pub stack_bytes: u32,
    /// Instructions of all calls.
    #[serde(skip)]
    total: u64,
}

/// What the planners of a run took on their chips.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Measured {
    /// The board that was emulated.
    pub machine: String,
    /// Instructions and stack, call by call, over all robots.
    pub calls: BTreeMap<Call, Tally>,
    /// The planner, everything included, in bytes.
    pub planner_bytes: u32,
    /// All statics of the image: every planner that it can host, and the dialogue.
    pub static_bytes: u32,
    /// The image in flash.
    pub flash_bytes: u32,
    /// The most stack that any robot ever used, the dialogue included.
    pub peak_stack_bytes: u32,
    /// The stack.
    pub stack_bytes: u32,
}

#[cfg(unix)]
impl Measured {
    pub(crate) fn count(&mut self, call: Call, instructions: u64, stack: u32) {
        let tally = self.calls.entry(call).or_default();
        tally.calls += 1;
        tally.total += instructions;
        tally.mean = tally.total / tally.calls;
        tally.largest = tally.largest.max(instructions);
        tally.stack_bytes = tally.stack_bytes.max(stack);
    }

    pub(crate) fn weigh(&mut self, memory: &Memory) {
        self.planner_bytes = memory.planner;
        self.static_bytes = memory.statics;
        self.flash_bytes = memory.flash;
        self.peak_stack_bytes = self.peak_stack_bytes.max(memory.stack_peak);
        self.stack_bytes = memory.stack;
    }
}
