//! What one robot does with the marks.

use planner_core::{Cell, Direction, RobotId, Sighting};

use super::board::Board;

/// A robot among the marks: its mode, and what it remembers of its way.
#[derive(Debug)]
pub(super) struct Robot {
    id: RobotId,
    position: Cell,
    mode: Mode,
    /// The way that it has come since it last began to look for a loop,
    /// without what it went back over.
    trail: Vec<Cell>,
    /// The cell that it stood on before this one.
    before: Option<Cell>,
    /// By cell: when it was last there, 0 for never.
    passes: Vec<u32>,
    /// What it sees, farthest first.
    view: Vec<Cell>,
    time: u32,
    /// Cells tried for closing in this tick.
    pub(super) work: u32,
}

/// What a robot is about [Gauville2019 §2.2].
#[derive(Debug)]
enum Mode {
    /// Explores, and looks for loops on its way.
    Detection,
    /// Walks a loop to mark it; stands on the cell `at` of it.
    Control { cells: Vec<Cell>, at: usize },
    /// The same, but a weaker robot has marked that cell: waits for it to clean
    /// up, until the time `until`.
    Standby {
        cells: Vec<Cell>,
        at: usize,
        until: u32,
    },
    /// Walks a loop that is all its own, and closes what lies behind it.
    Closing {
        cells: Vec<Cell>,
        at: usize,
        /// Whether it has closed a cell: the loop is none any more.
        is_open: bool,
    },
    /// Takes its marks back on the cell that it stands on and on those of this
    /// way, last one first.
    Cleaning { way: Vec<Cell> },
}

/// What a robot decides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decision {
    Go(Direction),
    Wait,
    /// All around is closed.
    Stop,
}

impl Robot {
    pub(super) fn new(id: RobotId, start: Cell, cells: usize, now: u32) -> Self {
        Self {
            id,
            position: start,
            mode: Mode::Detection,
            trail: vec![start],
            before: None,
            passes: vec![0; cells],
            view: Vec::new(),
            time: now,
            work: 0,
        }
    }

    pub(super) fn position(&self) -> Cell {
        self.position
    }

    /// Looks around: takes note of the visible cells.
    pub(super) fn look(&mut self, board: &mut Board, sighting: &Sighting) {
        self.time += 1;
        self.position = sighting.centre();
        self.arrive(board);
        self.view.clear();
        self.view.extend(sighting.free_cells());
        let centre = self.position;
        self.view
            .sort_by_key(|&cell| (std::cmp::Reverse(cell.distance_squared(centre)), cell));
    }

    /// Is where it is.
    fn arrive(&mut self, board: &mut Board) {
        board.locate(self.id, self.position, self.time);
        if let Some(index) = board.index(self.position) {
            self.passes[index] = self.time;
        }
    }

    pub(super) fn decide(&mut self, board: &mut Board) -> Decision {
        self.close_visible(board);
        let next = loop {
            // A mode may hand over to the next one within the tick, at most
            // Standby, Control, Cleaning, Detection.
            match std::mem::replace(&mut self.mode, Mode::Detection) {
                Mode::Detection => match self.find_loop() {
                    Some(cells) => self.mode = Mode::Control { cells, at: 0 },
                    None => break self.explore(board),
                },
                Mode::Control { cells, at } => {
                    if let Some(next) = self.control(board, cells, at) {
                        break Some(next);
                    }
                }
                Mode::Standby { cells, at, until } => {
                    if self.has_to_wait(board, &cells, at, until) {
                        self.mode = Mode::Standby { cells, at, until };
                        return Decision::Wait;
                    }
                }
                Mode::Closing { cells, at, is_open } => {
                    if let Some(next) = self.close(board, cells, at, is_open) {
                        break Some(next);
                    }
                }
                Mode::Cleaning { way } => {
                    if let Some(next) = self.clean(board, way) {
                        break Some(next);
                    }
                }
            }
        };
        let around = Direction::ALL.map(|direction| self.position.step(direction));
        match next.and_then(|next| self.position.direction_to(next)) {
            Some(direction) => Decision::Go(direction),
            None if around.iter().any(|&cell| board.is_open(cell)) => Decision::Wait,
            None => Decision::Stop,
        }
    }

    /// The step that was decided has been made.
    pub(super) fn step(&mut self, board: &mut Board, to: Cell) {
        self.before = Some(self.position);
        self.position = to;
        self.arrive(board);
        match &mut self.mode {
            Mode::Detection => self.trail.push(to),
            Mode::Control { at, .. } | Mode::Closing { at, .. } => *at += 1,
            Mode::Cleaning { way } => {
                way.pop();
            }
            Mode::Standby { .. } => {}
        }
    }

    /// Long range vision: closes every visible cell that nobody needs, the
    /// farthest first, until none is left.
    fn close_visible(&mut self, board: &mut Board) {
        loop {
            self.work += self.view.len() as u32;
            let before = self.view.len();
            self.view.retain(|&cell| !board.close_needless(cell));
            if self.view.len() == before {
                return;
            }
        }
    }

    /// A loop: the way has come back to a cell that it holds, other than by a
    /// step back. The loop begins with that cell.
    fn find_loop(&mut self) -> Option<Vec<Cell>> {
        let (&here, way) = self.trail.split_last()?;
        let first = way.iter().position(|&cell| cell == here)?;
        let cells = self.trail[first..self.trail.len() - 1].to_vec();
        self.trail.truncate(first + 1);
        (cells.len() > 2).then_some(cells)
    }

    /// The open neighbour to go to: one where nobody has been, of those the one
    /// with most blocked neighbours; else the one where this robot has not been
    /// for longest. The rendezvous only if there is no other, back only if there
    /// is not even that. A cell that only the robot on it keeps open leads
    /// nowhere.
    fn explore(&self, board: &Board) -> Option<Cell> {
        let turn = |step: u8| Direction::from_index(self.id.0.wrapping_add(step));
        let ahead = (0..4).map(|step| self.position.step(turn(step)));
        let leads_on = |cell: &Cell| {
            board.is_open(*cell) && !(board.is_held(*cell) && board.is_needless(*cell))
        };
        ahead.filter(leads_on).min_by_key(|&cell| {
            let around = Direction::ALL.map(|direction| cell.step(direction));
            let blocked = around.iter().filter(|&&cell| !board.is_open(cell)).count();
            let last = board.index(cell).map_or(0, |index| self.passes[index]);
            if Some(cell) == self.before {
                (3, 0, 0)
            } else if cell == board.rendezvous() {
                (2, 0, 0)
            } else if board.is_trodden(cell) {
                (1, 0, last)
            } else {
                (0, 4 - blocked, 0)
            }
        })
    }

    /// Marks the cell `at` of a loop, on which it stands; the next one to go to.
    fn control(&mut self, board: &mut Board, cells: Vec<Cell>, at: usize) -> Option<Cell> {
        let is_round = at == cells.len();
        if let Some(other) = board.controller(self.position).filter(|&id| id != self.id) {
            if board.is_silent(other) {
                board.forget(other);
            } else if other < self.id {
                return self.turn_back(&cells[..at]);
            } else {
                // Time for the other to walk its way and back.
                let until = self.time + 8 * cells.len() as u32 + 64;
                self.mode = Mode::Standby { cells, at, until };
                return None;
            }
        }
        if is_round {
            self.mode = Mode::Closing {
                cells,
                at: 0,
                is_open: false,
            };
            return None;
        }
        board.control(self.position, Some(self.id));
        let next = cells[(at + 1) % cells.len()];
        if !board.is_open(next) {
            return self.turn_back(&cells[..at]);
        }
        self.mode = Mode::Control { cells, at };
        Some(next)
    }

    /// Whether a robot that waits goes on waiting; if not, it has a new mode.
    fn has_to_wait(&mut self, board: &mut Board, cells: &[Cell], at: usize, until: u32) -> bool {
        let other = board.controller(self.position).filter(|&id| id != self.id);
        if other.is_some_and(|other| !board.is_silent(other)) {
            if self.time < until {
                return true;
            }
            self.turn_back(&cells[..at]);
        } else {
            let cells = cells.to_vec();
            self.mode = Mode::Control { cells, at };
        }
        false
    }

    /// Gives up a loop, whose `marked` cells lie behind.
    fn turn_back(&mut self, marked: &[Cell]) -> Option<Cell> {
        self.mode = Mode::Cleaning {
            way: marked.to_vec(),
        };
        None
    }

    /// Closes the cell of the loop that lies behind; the next one to go to. The
    /// first cell opens the loop, the following ones are then dead ends, up to
    /// the first intersection.
    fn close(
        &mut self,
        board: &mut Board,
        cells: Vec<Cell>,
        at: usize,
        is_open: bool,
    ) -> Option<Cell> {
        let count = cells.len();
        let behind = (at > 0).then(|| cells[(at - 1) % count]);
        let mut is_open = is_open;
        if let Some(behind) = behind {
            if is_open {
                board.control(behind, None);
                if !board.close_needless(behind) {
                    return self.clean_up(board, &cells, at);
                }
            } else {
                is_open = board.close_on_loop(behind, self.id, &cells);
                if !is_open && at == count {
                    return self.clean_up(board, &cells, at);
                }
            }
        }
        let next = cells[(at + 1) % count];
        if !board.is_open(next) {
            return self.clean_up(board, &cells, at);
        }
        self.mode = Mode::Closing { cells, at, is_open };
        Some(next)
    }

    /// Is done with a loop that it controlled, and sets out to take its marks
    /// back: if the loop is open along what is left of it, else all the way in
    /// reverse.
    fn clean_up(&mut self, board: &Board, cells: &[Cell], at: usize) -> Option<Cell> {
        let here = at % cells.len();
        let onward = cells[here + 1..].iter().chain(&cells[..here]).copied();
        let is_mine = |cell: &Cell| board.controller(*cell) == Some(self.id);
        let mut way: Vec<Cell> = onward.take_while(is_mine).collect();
        if way.len() + 1 < cells.len() {
            way.reverse();
        }
        self.mode = Mode::Cleaning { way };
        None
    }

    /// Takes its mark back here; the next cell to go to.
    fn clean(&mut self, board: &mut Board, way: Vec<Cell>) -> Option<Cell> {
        if board.controller(self.position) == Some(self.id) {
            board.control(self.position, None);
        }
        let next = way.last().copied();
        if next.is_some() {
            self.mode = Mode::Cleaning { way };
        } else {
            self.trail = vec![self.position];
        }
        next
    }
}
