//! The pictures of docs/how-it-decides.md: moments of an exploration, and what the explorer
//! knows and wants in them.
//!
//! `cargo run --release -p host-sim --example decides [-- --out docs/images]`

use std::collections::{HashMap, VecDeque};
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Parser;
use host_sim::sensor::Sensor;
use host_sim::world::{ReadOptions, World};
use planner_core::explorer::{Config, Explorer};
use planner_core::radio::MAX_LEN;
use planner_core::tile::TileIndex;
use planner_core::{Action, Cell, Direction, Extent, Inspect, Map, Motion, Planner, RobotId, Wait};

#[derive(Parser)]
struct Arguments {
    /// Folder of the pictures.
    #[arg(long, default_value = "docs/images")]
    out: PathBuf,
}

const MAP: &str = "fixtures/maps/ward.txt";
const RANGE: u8 = 5;
/// Pixels of a cell.
const SIDE: i32 = 12;
const ROBOTS: [&str; 3] = ["#0072b2", "#d55e00", "#009e73"];

type Robot = Explorer<8, 8>;

/// Explorers that share a radio without losses.
struct Swarm {
    sensor: Sensor,
    robots: Vec<Robot>,
    at: Vec<Cell>,
    ways: Vec<Vec<Cell>>,
    has_stopped: Vec<bool>,
}

impl Swarm {
    fn new(robots: u8) -> Result<Self, Box<dyn Error>> {
        let world = World::read(Path::new(MAP), &ReadOptions::default())?;
        let extent = world.extent();
        let start = *world.starts().first().ok_or("the map names no start")?;
        let made = (0..robots).map(|id| Robot::new(Config::new(), RobotId(id), extent, start));
        Ok(Self {
            robots: made.collect::<Result<_, _>>()?,
            at: vec![start; robots.into()],
            ways: vec![vec![start]; robots.into()],
            has_stopped: vec![false; robots.into()],
            sensor: Sensor::new(Arc::new(world), RANGE),
        })
    }

    /// Everybody looks, then everybody speaks, then everybody decides and makes a step.
    fn tick(&mut self) {
        for (robot, &at) in self.robots.iter_mut().zip(&self.at) {
            robot.observe(&self.sensor.view(at, Direction::East).sighting);
        }
        for sender in 0..self.robots.len() {
            let mut frame = [0; MAX_LEN];
            while let Some(length) = self.robots[sender].transmit(&mut frame) {
                for (number, robot) in self.robots.iter_mut().enumerate() {
                    if number != sender {
                        // A robot that refuses a frame has said why.
                        let _ = robot.receive(&frame[..length]);
                    }
                }
            }
        }
        for (number, robot) in self.robots.iter_mut().enumerate() {
            match robot.tick() {
                Action::Move(step) => {
                    self.at[number] = self.at[number].step(step);
                    self.ways[number].push(self.at[number]);
                    robot.report(Motion::Moved);
                }
                Action::Wait => {}
                Action::Stop(_) => self.has_stopped[number] = true,
            }
        }
    }

    /// Ticks until this is so.
    fn until(&mut self, is_so: impl Fn(&Self) -> bool) -> Result<(), Box<dyn Error>> {
        for _ in 0..5000 {
            self.tick();
            if is_so(self) {
                return Ok(());
            }
        }
        Err("the moment to draw never came".into())
    }
}

/// A picture under way.
struct Picture<'a> {
    swarm: &'a Swarm,
    /// Whose map it shows.
    robot: usize,
    body: String,
    legend: Vec<(String, String)>,
    corner: Cell,
    columns: i32,
    rows: i32,
}

impl<'a> Picture<'a> {
    /// The robot's map from one corner to the opposite one.
    fn new(swarm: &'a Swarm, robot: usize, corner: Cell, opposite: Cell) -> Self {
        let mut picture = Self {
            swarm,
            robot,
            body: String::new(),
            legend: Vec::new(),
            corner,
            columns: i32::from(opposite.x - corner.x) + 1,
            rows: i32::from(opposite.y - corner.y) + 1,
        };
        picture.fill("unknown", "#cdd0d6", |_, _| true);
        picture.fill("free", "#ffffff", |map, cell| map.is_free(cell));
        picture.fill("wall", "#404650", |map, cell| map.is_obstacle(cell));
        picture
    }

    fn all(swarm: &'a Swarm, robot: usize) -> Self {
        let extent = swarm.sensor.world().extent();
        let opposite = Cell::new(extent.width as i16 - 1, extent.height as i16 - 1);
        Self::new(swarm, robot, Cell::new(0, 0), opposite)
    }

    /// The upper left corner of a cell, in pixels.
    fn place(&self, cell: Cell) -> (i32, i32) {
        let offset = |at: i16, first: i16| i32::from(at - first) * SIDE;
        (offset(cell.x, self.corner.x), offset(cell.y, self.corner.y))
    }

    fn holds(&self, cell: Cell) -> bool {
        let (x, y) = self.place(cell);
        (0..self.columns * SIDE).contains(&x) && (0..self.rows * SIDE).contains(&y)
    }

    /// Colours the cells for which something is so; the legend names it if there are any.
    fn fill(&mut self, name: &str, color: &str, is_so: impl Fn(&Map<8, 8>, Cell) -> bool) {
        let map = self.swarm.robots[self.robot].map();
        let those: Vec<Cell> = cells(map.extent())
            .filter(|&cell| self.holds(cell) && is_so(map, cell))
            .collect();
        // Cells beside each other in one piece.
        let beside = |a: &Cell, b: &Cell| a.step(Direction::East) == *b;
        for row in those.chunk_by(beside) {
            let ((x, y), width) = (self.place(row[0]), SIDE * row.len() as i32);
            let _ = writeln!(
                self.body,
                r#"<rect x="{x}" y="{y}" width="{width}" height="{SIDE}" fill="{color}"/>"#
            );
        }
        if !those.is_empty() {
            let sign =
                format!(r##"<rect width="12" height="12" y="-6" fill="{color}" stroke="#888"/>"##);
            self.legend.push((name.to_owned(), sign));
        }
    }

    fn frontiers(&mut self) {
        self.fill("frontier", "#f5c542", |map, cell| map.is_frontier(cell));
    }

    fn line(&mut self, way: &[Cell], style: &str) {
        let points = way.iter().map(|&cell| {
            let (x, y) = self.place(cell);
            format!("{},{}", x + SIDE / 2, y + SIDE / 2)
        });
        let points = points.collect::<Vec<_>>().join(" ");
        let _ = writeln!(
            self.body,
            r#"<polyline points="{points}" fill="none" {style}/>"#
        );
    }

    /// Robots with their ways so far, and where they go.
    fn robots(&mut self, with_goals: bool) {
        let swarm = self.swarm;
        for (number, &at) in swarm.at.iter().enumerate() {
            let color = ROBOTS[number % ROBOTS.len()];
            self.line(
                &swarm.ways[number],
                &format!(r#"stroke="{color}" stroke-width="2" opacity="0.35""#),
            );
            let robot = &swarm.robots[number];
            if let Some(goal) = robot.status().goal.filter(|_| with_goals) {
                let way: Vec<Cell> = [at].into_iter().chain(robot.way()).collect();
                self.line(
                    &way,
                    &format!(r#"stroke="{color}" stroke-width="3" stroke-dasharray="4 3""#),
                );
                let (x, y) = self.place(goal);
                let (x, y) = (x + SIDE / 2, y + SIDE / 2);
                let _ = writeln!(
                    self.body,
                    r#"<circle cx="{x}" cy="{y}" r="8" fill="none" stroke="{color}" stroke-width="3"/>"#
                );
            }
        }
        for (number, &at) in swarm.at.iter().enumerate() {
            let color = ROBOTS[number % ROBOTS.len()];
            let (x, y) = self.place(at);
            let (x, y) = (x + SIDE / 2, y + SIDE / 2);
            let _ = writeln!(
                self.body,
                r##"<circle cx="{x}" cy="{y}" r="8" fill="{color}" stroke="#fff"/><text x="{x}" y="{}" fill="#fff" text-anchor="middle" font-size="11">{number}</text>"##,
                y + 4
            );
        }
        self.legend.push((
            "robot, its way so far".into(),
            r##"<line x2="14" stroke="#0072b2" stroke-width="2" opacity="0.35"/><circle cx="7" r="5" fill="#0072b2"/>"##.into(),
        ));
        if with_goals {
            self.legend.push((
                "its plan, its goal".into(),
                r##"<line x2="8" stroke="#0072b2" stroke-width="3" stroke-dasharray="4 3"/><circle cx="14" r="5" fill="none" stroke="#0072b2" stroke-width="3"/>"##.into(),
            ));
        }
    }

    /// A frame around cells.
    fn frame(&mut self, name: &str, corner: Cell, opposite: Cell) {
        let (x, y) = self.place(corner);
        let (right, bottom) = self.place(opposite);
        let (x, y) = (x.max(1), y.max(1));
        let right = right.min((self.columns - 1) * SIDE - 1);
        let bottom = bottom.min((self.rows - 1) * SIDE - 1);
        let style = r##"fill="none" stroke="#a02060" stroke-width="2" stroke-dasharray="7 4""##;
        let _ = writeln!(
            self.body,
            r#"<rect x="{x}" y="{y}" width="{}" height="{}" {style}/>"#,
            right - x + SIDE,
            bottom - y + SIDE
        );
        let sign = format!(r#"<rect width="14" height="10" y="-5" {style}/>"#);
        self.legend.push((name.to_owned(), sign));
    }

    /// Numbers in cells.
    fn numbers(&mut self, numbers: impl IntoIterator<Item = (Cell, u32)>) {
        for (cell, number) in numbers {
            let (x, y) = self.place(cell);
            let (x, y) = (x + SIDE / 2, y + SIDE / 2 + 3);
            let _ = writeln!(
                self.body,
                r#"<text x="{x}" y="{y}" text-anchor="middle" font-size="8">{number}</text>"#
            );
        }
    }

    fn svg(&self) -> String {
        const LINE: i32 = 20;
        let width = self.columns * SIDE;
        let height = self.rows * SIDE;
        let (mut x, mut y) = (4, height + LINE);
        let mut legend = String::new();
        for (name, sign) in &self.legend {
            let room = 30 + 7 * name.chars().count() as i32;
            if x > 4 && x + room > width {
                (x, y) = (4, y + LINE);
            }
            let _ = writeln!(
                legend,
                r#"<g transform="translate({x},{y})">{sign}<text x="24" y="4" font-size="12">{name}</text></g>"#
            );
            x += room + 8;
        }
        let all = y + LINE / 2 + 2;
        format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-2 -2 {} {}" width="{}" font-family="sans-serif"><rect x="-2" y="-2" width="{}" height="{}" fill="#fff"/>
{}<rect width="{width}" height="{height}" fill="none" stroke="#404650"/>
{legend}</svg>
"##,
            width + 4,
            all + 4,
            width + 4,
            width + 4,
            all + 4,
            self.body
        )
    }
}

/// All cells, row by row.
fn cells(extent: Extent) -> impl Iterator<Item = Cell> {
    let columns = 0..extent.width as i16;
    (0..extent.height as i16).flat_map(move |y| columns.clone().map(move |x| Cell::new(x, y)))
}

/// Steps from some cells over the free cells of a map, and from which of them.
fn steps(map: &Map<8, 8>, from: &[Cell]) -> HashMap<Cell, (u32, usize)> {
    let mut reached: HashMap<Cell, (u32, usize)> = HashMap::new();
    let mut queue: VecDeque<Cell> = VecDeque::new();
    for (number, &cell) in from.iter().enumerate() {
        reached.entry(cell).or_insert((0, number));
        queue.push_back(cell);
    }
    while let Some(cell) = queue.pop_front() {
        let (steps, number) = reached[&cell];
        for next in Direction::ALL.map(|direction| cell.step(direction)) {
            if map.is_free(next) && !reached.contains_key(&next) {
                reached.insert(next, (steps + 1, number));
                queue.push_back(next);
            }
        }
    }
    reached
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    fs::create_dir_all(&arguments.out)?;
    let put = |name: &str, picture: &Picture| {
        fs::write(
            arguments.out.join(format!("decides-{name}.svg")),
            picture.svg(),
        )
    };

    let mut alone = Swarm::new(1)?;
    alone.tick();
    let Cell { x, y } = alone.ways[0][0];
    let mut look = Picture::new(&alone, 0, Cell::new(x - 3, y - 7), Cell::new(x + 17, y + 7));
    look.frontiers();
    look.robots(false);
    put("look", &look)?;

    for _ in 0..40 {
        alone.tick();
    }
    let mut near = Picture::all(&alone, 0);
    near.frontiers();
    near.robots(true);
    let (map, at) = (alone.robots[0].map(), alone.at[0]);
    let reached = steps(map, &[at]);
    let frontiers = reached.iter().filter(|(cell, _)| map.is_frontier(**cell));
    near.numbers(frontiers.map(|(&cell, &(steps, _))| (cell, steps)));
    // Two tiles on the side where the robot is in its tile's half, and two on the other.
    let first = |at: i16| (at + 4).div_euclid(8) * 8 - 16;
    let corner = Cell::new(first(at.x), first(at.y));
    near.frame(
        "the window",
        corner,
        Cell::new(corner.x + 31, corner.y + 31),
    );
    put("near", &near)?;

    let mut three = Swarm::new(3)?;
    three.until(|swarm| {
        let goals: Vec<Cell> = { swarm.robots.iter() }
            .filter_map(|robot| robot.status().goal)
            .collect();
        let far = |(goal, at): (&Cell, &Cell)| (goal.x - at.x).abs() + (goal.y - at.y).abs() > 20;
        goals.len() == 3 && goals.iter().zip(&swarm.at).any(far)
    })?;
    let reached = steps(three.robots[0].map(), &three.at);
    let mut far = Picture::all(&three, 0);
    for (number, color) in ["#cfe5f3", "#f9dcc4", "#c9ebe0"].into_iter().enumerate() {
        let is_nearest = |_: &Map<8, 8>, cell| reached.get(&cell).is_some_and(|it| it.1 == number);
        far.fill(&format!("robot {number} is nearest"), color, is_nearest);
    }
    far.frontiers();
    far.robots(true);
    put("far", &far)?;

    let mut three = Swarm::new(3)?;
    let searched = |robot: &Robot, cell: Cell| {
        let at = TileIndex::new((cell.x / 8) as u8, (cell.y / 8) as u8);
        robot.searched(at) >> (cell.y % 8 * 8 + cell.x % 8) & 1 == 1
    };
    let waits = |swarm: &Swarm| {
        let waits = |robot: &Robot| robot.waiting() == Some(Wait::Search);
        swarm.robots.iter().position(waits)
    };
    three.until(|swarm| {
        waits(swarm).is_some_and(|robot| {
            let robot = &swarm.robots[robot];
            cells(robot.map().extent()).any(|cell| searched(robot, cell))
        })
    })?;
    let waiting = waits(&three).ok_or("nobody waits")?;
    let mut wait = Picture::all(&three, waiting);
    let robot = &three.robots[waiting];
    wait.fill("searched so far", "#d9c7ec", |_, cell| {
        searched(robot, cell)
    });
    wait.frontiers();
    wait.robots(true);
    put("wait", &wait)?;

    three.until(|swarm| swarm.has_stopped.iter().all(|it| *it))?;
    let mut complete = Picture::all(&three, 0);
    complete.frontiers();
    complete.robots(false);
    put("complete", &complete)?;
    Ok(())
}
