//! Where robots must not go, and where alone they shall look.

use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::fmt;
use std::str::FromStr;
use std::sync::{LazyLock, Mutex, PoisonError};

use clap::Args;
use planner_core::{Cell, CellSet, Extent};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::world::World;

/// Cells in a rectangle or a polygon.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Area {
    /// One cell, two opposite corners of a rectangle, or the corners of a polygon in turn.
    corners: Vec<Cell>,
}

/// What a fleet keeps out of. Nothing by default; for the explorer only.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// Robots enter none of these.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keep_out: Vec<Area>,
    /// If there are any, robots stay within them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub only: Vec<Area>,
}

impl Area {
    /// Whether a cell lies in it, its edge included.
    pub fn contains(&self, cell: Cell) -> bool {
        match self.corners[..] {
            [] => false,
            [a] => a == cell,
            [a, b] => {
                let is_between = |a: i16, x: i16, b: i16| (a.min(b)..=a.max(b)).contains(&x);
                is_between(a.x, cell.x, b.x) && is_between(a.y, cell.y, b.y)
            }
            _ => self.is_within(cell),
        }
    }

    /// By the number of sides that a ray from the cell's middle to the east crosses.
    fn is_within(&self, cell: Cell) -> bool {
        let next = self.corners.iter().cycle().skip(1);
        let mut is_inside = false;
        for (a, b) in self.corners.iter().zip(next) {
            let of = |at: &Cell| {
                (
                    i64::from(at.x) - i64::from(cell.x),
                    i64::from(at.y) - i64::from(cell.y),
                )
            };
            let ((ax, ay), (bx, by)) = (of(a), of(b));
            let turn = ax * by - ay * bx;
            if turn == 0 && ax * bx <= 0 && ay * by <= 0 {
                return true;
            }
            // It crosses the row, and to the east of the cell.
            if (ay > 0) != (by > 0) && (turn > 0) == (by > ay) {
                is_inside = !is_inside;
            }
        }
        is_inside
    }

    /// Rectangles that hold the cells of a grid that `holds` names, and no others.
    pub fn covering(extent: Extent, holds: impl Fn(Cell) -> bool) -> Vec<Self> {
        let (width, height) = (extent.width as i16, extent.height as i16);
        let mut areas: Vec<Self> = Vec::new();
        // Rectangles that reach down to the row above, by their first and last columns.
        let mut open: HashMap<(i16, i16), usize> = HashMap::new();
        for y in 0..height {
            let mut next = HashMap::new();
            let mut x = 0;
            while x < width {
                let first = x;
                while x < width && holds(Cell::new(x, y)) {
                    x += 1;
                }
                if x > first {
                    let last = Cell::new(x - 1, y);
                    let columns = (first, last.x);
                    let area = open.remove(&columns).unwrap_or_else(|| {
                        let corners = vec![Cell::new(first, y), last];
                        areas.push(Self { corners });
                        areas.len() - 1
                    });
                    areas[area].corners[1] = last;
                    next.insert(columns, area);
                }
                x += 1;
            }
            open = next;
        }
        areas
    }

    /// Its corners.
    pub fn corners(&self) -> &[Cell] {
        &self.corners
    }
}

impl Limits {
    pub(crate) fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Whether robots keep out of a cell.
    pub fn keeps_out(&self, cell: Cell) -> bool {
        let is_in = |areas: &[Area]| areas.iter().any(|area| area.contains(cell));
        is_in(&self.keep_out) || !self.only.is_empty() && !is_in(&self.only)
    }

    /// The areas, with the options that name them.
    pub(crate) fn areas(&self) -> impl Iterator<Item = (&'static str, &Area)> {
        let keep_out = self.keep_out.iter().map(|area| ("keep-out", area));
        keep_out.chain(self.only.iter().map(|area| ("only", area)))
    }

    /// What is set, as names and values of options.
    pub(crate) fn settings(&self) -> impl Iterator<Item = (&'static str, String)> {
        self.areas()
            .map(|(option, area)| (option, area.to_string()))
    }

    /// The cells of a grid that robots keep out of, for planners: made once, and kept for as
    /// long as the program runs. `None`: they may go anywhere.
    pub(crate) fn cells<const TW: usize, const TH: usize>(
        &self,
        extent: Extent,
    ) -> Option<&'static CellSet<TW, TH>> {
        type Key = (TypeId, (u16, u16), Limits);
        type All = HashMap<Key, &'static (dyn Any + Send + Sync)>;
        static ALL: LazyLock<Mutex<All>> = LazyLock::new(Mutex::default);
        if self.is_none() {
            return None;
        }
        let size = (extent.width, extent.height);
        let key = (TypeId::of::<CellSet<TW, TH>>(), size, self.clone());
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        let made = all.entry(key).or_insert_with(|| {
            let mut set = CellSet::<TW, TH>::new();
            let kept_out = crate::world::cells(extent).filter(|cell| self.keeps_out(*cell));
            kept_out.for_each(|cell| set.insert(cell));
            Box::leak(Box::new(set))
        });
        made.downcast_ref()
    }
}

/// `X,Y`, `X,Y:X,Y` or `X,Y:X,Y:X,Y…`.
impl FromStr for Area {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let cell = |text: &str| {
            let (x, y) = text.split_once(',')?;
            Some(Cell::new(x.trim().parse().ok()?, y.trim().parse().ok()?))
        };
        let corners = text.split(':').map(cell).collect::<Option<_>>();
        corners.map(|corners| Self { corners }).ok_or_else(|| {
            "expected X,Y:X,Y in cells, for example 3,4:9,12: the rectangle between two corners, \
             both in it; three corners and more: a polygon"
                .into()
        })
    }
}

impl fmt::Display for Area {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (cell, number) in self.corners.iter().zip(0..) {
            let colon = if number > 0 { ":" } else { "" };
            write!(f, "{colon}{},{}", cell.x, cell.y)?;
        }
        Ok(())
    }
}

impl TryFrom<String> for Area {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Area> for String {
    fn from(area: Area) -> Self {
        area.to_string()
    }
}

/// The options that set [`Limits`].
#[derive(Args, Clone)]
pub struct LimitsArgs {
    /// X,Y:X,Y: robots neither enter nor touch these cells, and need not see them: a
    /// rectangle, or a polygon of three corners and more. With an m behind it, for example
    /// 0.5,1:2,3.5m, in metres of the map's frame (y up; from the origin of a .yaml): each
    /// corner is the cell that it lies in. May be given again. Explorer only.
    #[arg(long, value_name = "X,Y:X,Y[m]", allow_hyphen_values = true)]
    keep_out: Vec<Given>,
    /// X,Y:X,Y: robots stay within this area, or with several within any of them; also in
    /// metres. Explorer only.
    #[arg(long, value_name = "X,Y:X,Y[m]", allow_hyphen_values = true)]
    only: Vec<Given>,
}

/// An area as it is given.
#[derive(Clone)]
enum Given {
    Cells(Area),
    /// Corners in the map's frame.
    Metres(Vec<(f64, f64)>),
}

/// An area in metres on a map of cells of unknown width; the option that names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "--{0}: an area in metres needs a map that says how wide its cells are (.yaml); give corners \
     in cells, without the m"
)]
pub struct NoMetres(pub &'static str);

impl FromStr for Given {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some(metres) = text.trim_end().strip_suffix('m') else {
            return text.parse().map(Self::Cells);
        };
        let corner = |text: &str| {
            let (x, y) = text.split_once(',')?;
            let metres = |text: &str| text.trim().parse().ok().filter(|of: &f64| of.is_finite());
            Some((metres(x)?, metres(y)?))
        };
        let corners = metres.split(':').map(corner).collect::<Option<_>>();
        corners.map(Self::Metres).ok_or_else(|| {
            "expected X,Y:X,Y and m, in metres, for example 0.5,1:2,3.5m: the rectangle between \
             two corners; three corners and more: a polygon"
                .into()
        })
    }
}

impl LimitsArgs {
    /// The option that names cells, if one is given.
    pub(crate) fn option(&self) -> Option<&'static str> {
        let keep_out = (!self.keep_out.is_empty()).then_some("keep-out");
        keep_out.or((!self.only.is_empty()).then_some("only"))
    }

    /// Finds the cells of areas in metres.
    pub(crate) fn lay(&mut self, world: &World) -> Result<(), NoMetres> {
        for (option, areas) in [("keep-out", &mut self.keep_out), ("only", &mut self.only)] {
            for area in areas {
                if let Given::Metres(corners) = area {
                    let cells = corners.iter().map(|&(x, y)| world.cell_at(x, y));
                    let corners = cells.collect::<Option<_>>();
                    let corners = corners.ok_or(NoMetres(option))?;
                    *area = Given::Cells(Area { corners });
                }
            }
        }
        Ok(())
    }

    pub(crate) fn over(self, limits: &mut Limits) -> Result<(), NoMetres> {
        let all = [
            ("keep-out", self.keep_out, &mut limits.keep_out),
            ("only", self.only, &mut limits.only),
        ];
        for (option, given, areas) in all {
            for area in given {
                match area {
                    Given::Cells(area) => areas.push(area),
                    Given::Metres(_) => return Err(NoMetres(option)),
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn area(text: &str) -> Area {
        text.parse().unwrap()
    }

    #[test]
    fn what_is_written_is_read() {
        for text in ["3,4", "3,4:9,12", "0,0:4,0:0,4", "-1,2:3,4"] {
            assert_eq!(area(text).to_string(), text);
        }
        for text in ["", "3", "3,4:", "3,4:5", "3,4-5,6", "a,b:c,d"] {
            let error = text.parse::<Area>().unwrap_err();
            assert!(error.contains("X,Y:X,Y"), "{text}: {error}");
        }
    }

    #[test]
    fn a_triangle_holds_its_edge_and_what_is_within() {
        let triangle = area("1,1:5,1:1,5");
        let rows: Vec<String> = (0..7)
            .map(|y| {
                let sign = |x| {
                    if triangle.contains(Cell::new(x, y)) {
                        '#'
                    } else {
                        '.'
                    }
                };
                (0..7).map(sign).collect()
            })
            .collect();
        let expected = [
            ".......", ".#####.", ".####..", ".###...", ".##....", ".#.....", ".......",
        ];
        assert_eq!(rows, expected);
    }

    #[test]
    fn corners_in_metres_are_the_cells_that_they_lie_in() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.yaml");
        std::fs::write(
            folder.path().join("map.pgm"),
            "P2 6 4 255\n".to_owned() + &"255 ".repeat(24),
        )
        .unwrap();
        let read = |origin: &str, scale| {
            let yaml = format!(
                "image: map.pgm\nresolution: 0.5\norigin: {origin}\nnegate: 0\n\
                 occupied_thresh: 0.65\nfree_thresh: 0.196\n"
            );
            std::fs::write(&path, yaml).unwrap();
            World::read(
                &path,
                &crate::world::ReadOptions {
                    scale,
                    ..Default::default()
                },
            )
            .unwrap()
        };
        use crate::world::Scale;
        let laid = |world: &World, text: &str| {
            let mut args = LimitsArgs {
                keep_out: vec![text.parse().unwrap()],
                only: Vec::new(),
            };
            let mut limits = Limits::default();
            args.lay(world)?;
            args.over(&mut limits)?;
            Ok::<_, NoMetres>(limits.keep_out[0].to_string())
        };
        let world = read("[-1, 2, 0]", Scale::Pixel);
        assert_eq!(laid(&world, "-0.9,2.1:0.2,2.6m").unwrap(), "0,3:2,2");
        // Two cells of 3 × 3 pixels on a side; the lower ones lack two rows.
        let world = read("[-1, 2, 0]", Scale::Pixels(3));
        assert_eq!(laid(&world, "-0.9,2.1:0.6,3.9m").unwrap(), "0,1:1,0");
        // A quarter turn counter-clockwise: x goes up, y to the left.
        let world = read("[0, 0, 1.5707963267948966]", Scale::Pixel);
        assert_eq!(laid(&world, "-0.1,0.1:-0.6,0.6m").unwrap(), "0,3:1,2");
        let unknown = World::from_fn("room", Extent::new(3, 3), |_| false).unwrap();
        let error = laid(&unknown, "0,0:1,1m").unwrap_err().to_string();
        assert!(
            error.contains("--keep-out") && error.contains("in cells"),
            "{error}"
        );
        for text in ["m", "1m", "1,2:3m", "a,bm", "1,infm"] {
            let error = text.parse::<Given>().map(|_| ()).unwrap_err();
            assert!(error.contains("in metres"), "{text}: {error}");
        }
    }

    proptest! {
        #[test]
        fn what_covers_cells_holds_them_and_no_others(
            cells in proptest::collection::vec(any::<bool>(), 7 * 5),
        ) {
            let holds = |cell: Cell| cells[cell.y as usize * 7 + cell.x as usize];
            let extent = Extent::new(7, 5);
            let areas = Area::covering(extent, holds);
            for cell in crate::world::cells(extent) {
                let covering = areas.iter().filter(|area| area.contains(cell)).count();
                prop_assert_eq!(covering, usize::from(holds(cell)), "{}", cell);
            }
        }

        #[test]
        fn a_polygon_of_four_corners_of_a_rectangle_is_that_rectangle(
            [ax, bx] in [0i16..20, 0..20], [ay, by] in [0i16..20, 0..20],
        ) {
            let rectangle = area(&format!("{ax},{ay}:{bx},{by}"));
            let polygon = area(&format!("{ax},{ay}:{bx},{ay}:{bx},{by}:{ax},{by}"));
            for cell in (0..20).flat_map(|y| (0..20).map(move |x| Cell::new(x, y))) {
                prop_assert_eq!(rectangle.contains(cell), polygon.contains(cell), "{}", cell);
            }
        }
    }
}
