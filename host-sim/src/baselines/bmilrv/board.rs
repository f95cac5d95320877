//! The marks that all robots share.

use planner_core::{Cell, Direction, Extent, RobotId, Sighting};

/// What a cell is marked as. The rendezvous is kept apart: it is a cell like
/// any other, but never closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    Unexplored,
    /// Seen, and perhaps still needed to get somewhere.
    Explored,
    /// Nobody needs to go here any more.
    Closed,
    Obstacle,
}

/// Ticks after which a robot that has not been heard of counts for nothing.
const SILENCE: u32 = 20;

/// The map of marks [Gauville2019 §2.2]: state and controlling robot of every
/// cell, and where the robots are.
#[derive(Debug)]
pub(super) struct Board {
    extent: Extent,
    marks: Vec<Mark>,
    /// Whether any robot has been on a cell.
    trodden: Vec<bool>,
    controllers: Vec<Option<RobotId>>,
    rendezvous: Cell,
    /// By id: where each robot is, and when it was last heard of.
    robots: Vec<Option<(Cell, u32)>>,
    now: u32,
}

/// The places of the ring that are neighbours.
const NEIGHBOURS: u8 = 0b0101_0101;

/// The eight cells around one in a circle, from the east. Those at even places
/// are its neighbours.
const RING: [(i16, i16); 8] = [
    (1, 0),
    (1, 1),
    (0, 1),
    (-1, 1),
    (-1, 0),
    (-1, -1),
    (0, -1),
    (1, -1),
];

impl Board {
    /// A board without marks.
    pub(super) fn new(extent: Extent, rendezvous: Cell) -> Self {
        let cells = extent.cells() as usize;
        Self {
            extent,
            marks: vec![Mark::Unexplored; cells],
            trodden: vec![false; cells],
            controllers: vec![None; cells],
            rendezvous,
            robots: Vec::new(),
            now: 0,
        }
    }

    /// Index of a cell among those of the board, row by row.
    pub(super) fn index(&self, cell: Cell) -> Option<usize> {
        let index = || cell.y as usize * usize::from(self.extent.width) + cell.x as usize;
        self.extent.contains(cell).then(index)
    }

    /// Cells outside are obstacles.
    pub(super) fn mark(&self, cell: Cell) -> Mark {
        self.index(cell)
            .map_or(Mark::Obstacle, |index| self.marks[index])
    }

    /// Whether a robot may go there.
    pub(super) fn is_open(&self, cell: Cell) -> bool {
        self.mark(cell) == Mark::Explored
    }

    pub(super) fn rendezvous(&self) -> Cell {
        self.rendezvous
    }

    /// Whether any robot has been on a cell.
    pub(super) fn is_trodden(&self, cell: Cell) -> bool {
        self.index(cell).is_some_and(|index| self.trodden[index])
    }

    /// The robot that controls a cell.
    pub(super) fn controller(&self, cell: Cell) -> Option<RobotId> {
        self.controllers[self.index(cell)?]
    }

    pub(super) fn control(&mut self, cell: Cell, controller: Option<RobotId>) {
        if let Some(index) = self.index(cell) {
            self.controllers[index] = controller;
        }
    }

    /// Takes back all marks of control of a robot.
    pub(super) fn forget(&mut self, robot: RobotId) {
        for controller in &mut self.controllers {
            controller.take_if(|controller| *controller == robot);
        }
    }

    /// A robot begins, perhaps anew after it lost its memory; the time by which
    /// it is to set its clock.
    pub(super) fn enter(&mut self, robot: RobotId, cell: Cell) -> u32 {
        self.forget(robot);
        self.locate(robot, cell, self.now);
        self.now
    }

    /// A robot is somewhere, at a time of its own clock.
    pub(super) fn locate(&mut self, robot: RobotId, cell: Cell, time: u32) {
        self.now = self.now.max(time);
        let number = usize::from(robot.0);
        if self.robots.len() <= number {
            self.robots.resize(number + 1, None);
        }
        self.robots[number] = Some((cell, time));
        if let Some(index) = self.index(cell) {
            self.trodden[index] = true;
        }
    }

    /// Whether a robot has not been heard of for so long that it must be dead.
    pub(super) fn is_silent(&self, robot: RobotId) -> bool {
        let robot = self.robots.get(usize::from(robot.0));
        !robot.is_some_and(|&robot| self.is_live(robot))
    }

    /// Whether a living robot is on a cell.
    pub(super) fn is_held(&self, cell: Cell) -> bool {
        let mut robots = self.robots.iter();
        robots.any(|&robot| self.is_live(robot) && robot.is_some_and(|(at, _)| at == cell))
    }

    fn is_live(&self, robot: Option<(Cell, u32)>) -> bool {
        robot.is_some_and(|(_, heard)| self.now - heard <= SILENCE)
    }

    /// Marks what a robot sees.
    pub(super) fn observe(&mut self, sighting: &Sighting) {
        let free = sighting.free_cells().map(|cell| (cell, Mark::Explored));
        let blocked = sighting.blocked_cells().map(|cell| (cell, Mark::Obstacle));
        for (cell, mark) in free.chain(blocked) {
            if let Some(index) = self.index(cell)
                && self.marks[index] == Mark::Unexplored
            {
                self.marks[index] = mark;
            }
        }
    }

    /// Closes a cell if nobody needs it: it is not the rendezvous, no robot
    /// controls it or stands on it, and its open neighbours stay connected.
    /// Whether it did.
    pub(super) fn close_needless(&mut self, cell: Cell) -> bool {
        let closes = self.is_needless(cell) && !self.is_held(cell);
        if closes {
            self.close(cell);
        }
        closes
    }

    /// Whether nobody needs a cell, but for robots that may stand on it.
    pub(super) fn is_needless(&self, cell: Cell) -> bool {
        cell != self.rendezvous
            && self.controller(cell).is_none()
            && self
                .ways_through(cell)
                .is_some_and(|ways| ways.count() == 1)
    }

    /// Closes a cell of a loop all of which `robot` controls. The rest of the
    /// loop connects all that touches it, so whatever the cell connects must
    /// touch it. Whether it did.
    pub(super) fn close_on_loop(&mut self, cell: Cell, robot: RobotId, cells: &[Cell]) -> bool {
        let is_intact = |&at: &Cell| self.is_open(at) && self.controller(at) == Some(robot);
        let closes = cell != self.rendezvous
            && !self.is_held(cell)
            && cells.iter().all(is_intact)
            && self.ways_through(cell).is_some_and(|mut ways| {
                ways.all(|way| ring(cell, way).any(|at| cells.contains(&at)))
            });
        if closes {
            self.close(cell);
        }
        closes
    }

    fn close(&mut self, cell: Cell) {
        self.control(cell, None);
        if let Some(index) = self.index(cell) {
            self.marks[index] = Mark::Closed;
        }
    }

    /// What an open cell connects: the connected sets of open cells in the ring
    /// around it that hold a neighbour. `None` if the cell is not open, or a
    /// neighbour is unexplored: then the cell is needed.
    fn ways_through(&self, cell: Cell) -> Option<impl Iterator<Item = u8>> {
        let unexplored = |direction| self.mark(cell.step(direction)) == Mark::Unexplored;
        if !self.is_open(cell) || Direction::ALL.into_iter().any(unexplored) {
            return None;
        }
        let open = ring(cell, u8::MAX).zip(0..8);
        let open = open.filter(|&(at, _)| self.is_open(at));
        let open = open.fold(0, |open, (_, place)| open | 1 << place);
        Some(arcs(open).filter(|arc| arc & NEIGHBOURS != 0))
    }
}

/// The cells around `cell` at the `places` of the ring.
fn ring(cell: Cell, places: u8) -> impl Iterator<Item = Cell> {
    RING.into_iter()
        .zip(0..8)
        .filter(move |(_, place)| places >> place & 1 == 1)
        .map(move |((dx, dy), _)| Cell::new(cell.x + dx, cell.y + dy))
}

/// The connected parts of a set of places on the ring.
fn arcs(mut places: u8) -> impl Iterator<Item = u8> {
    std::iter::from_fn(move || {
        let mut arc = places & places.wrapping_neg();
        loop {
            let grown = (arc | arc.rotate_left(1) | arc.rotate_right(1)) & places;
            if grown == arc {
                break;
            }
            arc = grown;
        }
        places &= !arc;
        (arc != 0).then_some(arc)
    })
}

#[cfg(test)]
impl Board {
    /// The marks as text: `?` unexplored, `.` open, `x` closed, `R` rendezvous,
    /// a letter for the robot in control.
    pub(super) fn picture(&self) -> String {
        let symbol = |cell| match (self.mark(cell), self.controller(cell)) {
            (_, Some(robot)) => char::from(b'a' + robot.0),
            _ if cell == self.rendezvous => 'R',
            (Mark::Unexplored, None) => '?',
            (Mark::Explored, None) => '.',
            (Mark::Closed, None) => 'x',
            (Mark::Obstacle, None) => '#',
        };
        let row = |y| (0..self.extent.width as i16).map(move |x| symbol(Cell::new(x, y)));
        let rows = (0..self.extent.height as i16).flat_map(|y| row(y).chain(['\n']));
        rows.collect()
    }
}
