//! Where robots must not go, and where alone they shall look.

use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::fmt;
use std::str::FromStr;
use std::sync::{LazyLock, Mutex, PoisonError};

use clap::Args;
use planner_core::{Cell, CellSet, Extent};
use serde::{Deserialize, Serialize};

/// Cells in a rectangle or a polygon.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Area {
    /// One cell, two opposite corners of a rectangle, or the corners of a polygon in turn.
    corners: Vec<Cell>,
}

/// What a fleet keeps out of. Nothing by default; the explorer's alone.
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
    /// rectangle, or a polygon of three corners and more. May be given again. The explorer's
    /// alone.
    #[arg(long, value_name = "X,Y:X,Y")]
    keep_out: Vec<Area>,
    /// X,Y:X,Y: robots stay within this area, or with several within all of them. The
    /// explorer's alone.
    #[arg(long, value_name = "X,Y:X,Y")]
    only: Vec<Area>,
}

impl LimitsArgs {
    pub(crate) fn over(self, limits: &mut Limits) {
        limits.keep_out.extend(self.keep_out);
        limits.only.extend(self.only);
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

    proptest! {
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
