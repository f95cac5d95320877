//! One player for all worlds: what is run once, remembered, and gone back to.

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// There are ticks to come.
    Running,
    /// Everything that can be reached was seen, and all robots have stopped.
    Complete,
    /// The run is over, and something was left.
    Incomplete,
}

/// What a run can be exported as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Export {
    /// A picture of the shown tick, as PNG.
    Picture,
    /// The run up to its last tick as an animation, as GIF.
    Animation,
    /// The trace as host-sim writes it.
    Trace,
    /// The map: cells as text, surveyed space as an octree of OctoMap.
    Map,
}

impl Export {
    /// All of them, with their buttons.
    pub const ALL: [(Self, &'static str); 4] = [
        (Self::Picture, "PNG"),
        (Self::Animation, "GIF"),
        (Self::Trace, "Trace"),
        (Self::Map, "Map"),
    ];
}

/// What is plotted of a run, tick by tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Series {
    /// Share of what can be seen that has been seen, in per cent.
    Seen,
    /// Largest work of a robot in the tick.
    Work,
    /// Bytes that all robots have sent since the start.
    Bytes,
}

impl Series {
    /// All of them, with their names.
    pub const ALL: [(Self, &'static str); 3] = [
        (Self::Seen, "Cells seen, %"),
        (Self::Work, "Largest work of a robot in a tick"),
        (Self::Bytes, "Bytes sent by all robots"),
    ];
}

/// A run on the screen, on a grid, over heights or among voxels. A tick is run once, and
/// then remembered.
pub trait Playback {
    /// The name of the place.
    fn name(&self) -> &str;

    /// What tells it from another run in the same place.
    fn title(&self) -> String;

    /// Shows the next tick, and runs it if it was not run yet; false if there is none.
    fn tick(&mut self) -> bool;

    /// The tick that is shown: so many are done.
    fn shown(&self) -> u32;

    /// Number of ticks done, or in the trace.
    fn ticks(&self) -> u32;

    /// Shows the state after `tick` ticks, or after the last.
    fn show(&mut self, tick: u32);

    /// Share of what can be seen that was seen by the shown tick, in per cent.
    fn seen_percent(&self) -> f64;

    /// Numbers of ticks done, and the value then.
    fn curve(&self, of: Series) -> Vec<[f64; 2]>;

    /// How the run stands at its last tick.
    fn verdict(&self) -> Verdict;

    /// Whether the ticks are those of a trace that was opened.
    fn is_replay(&self) -> bool;

    /// The digest of the trace, when the run is over.
    fn digest(&self) -> Option<String>;

    /// A file for the user: the ending of its name, and its bytes.
    ///
    /// # Errors
    /// Those of the encoder.
    fn export(&self, what: Export) -> Result<(&'static str, Vec<u8>), String>;
}
