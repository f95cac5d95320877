//! What is known of a box of voxels, and what was found out about it: nothing is looked at
//! again before something near it has changed.

use std::collections::BTreeSet;

use planner_core::Extent;
use planner_core::volume::{Content, Voxel, body_voxels, in_sight};

/// Side of a block of voxels, the unit in which changes are noted.
const BLOCK: i16 = 8;

/// What planners have to know of robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Body {
    /// How far their sensors show, in voxels.
    pub range: u8,
    /// Voxels that they reach beyond the one of their middle.
    pub clearance: u8,
}

/// What is known, where frontiers are, and what places show.
#[derive(Clone, Debug)]
pub struct Chart {
    extent: Extent,
    levels: u8,
    body: Body,
    contents: Vec<Content>,
    /// Whether a robot may be there.
    poses: Vec<bool>,
    /// By index: level by level.
    frontiers: BTreeSet<usize>,
    /// The same by block.
    of_block: Vec<BTreeSet<usize>>,
    /// Changes so far, and of each block the number of the last one.
    changes: u32,
    changed: Vec<u32>,
    /// Of each place the changes after which it showed no frontier; 0: never asked.
    barren: Vec<u32>,
    /// Of each frontier the changes after which places were looked for that show it, and
    /// these.
    shown_from: Vec<(u32, Vec<Voxel>)>,
    /// The voxels within range of the middle one.
    ball: Vec<Voxel>,
    /// Lines of sight that were tried.
    lines: u32,
}

impl Chart {
    /// Of a box of which nothing is known, for robots that are all the same.
    pub fn new(extent: Extent, levels: u8, body: Body) -> Self {
        let size = extent.cells() as usize * usize::from(levels);
        let mut chart = Self {
            extent,
            levels,
            body,
            contents: vec![Content::Unknown; size],
            poses: vec![false; size],
            frontiers: BTreeSet::new(),
            of_block: Vec::new(),
            changes: 1,
            changed: Vec::new(),
            barren: vec![0; size],
            shown_from: vec![(0, Vec::new()); size],
            ball: ball(body.range),
            lines: 0,
        };
        let [x, y, z] = chart.blocks();
        chart.of_block = vec![BTreeSet::new(); x * y * z];
        chart.changed = vec![1; x * y * z];
        chart
    }

    /// Takes in what one look shows.
    pub fn learn(&mut self, view: &[(Voxel, bool)]) {
        let content = |is_solid| match is_solid {
            true => Content::Occupied,
            false => Content::Free,
        };
        let view = view.iter().map(|&(voxel, solid)| (voxel, content(solid)));
        self.take(view);
    }

    /// Takes in a whole map.
    pub fn copy(&mut self, content: impl Fn(Voxel) -> Content) {
        let all = (0..self.contents.len()).map(|index| self.voxel(index));
        let all: Vec<_> = all.map(|voxel| (voxel, content(voxel))).collect();
        self.take(all.into_iter());
    }

    fn take(&mut self, news: impl Iterator<Item = (Voxel, Content)>) {
        self.changes += 1;
        let mut changed = Vec::new();
        for (voxel, content) in news {
            if let Some(index) = self.index(voxel)
                && self.contents[index] != content
            {
                self.contents[index] = content;
                changed.push(voxel);
                let block = self.block(voxel);
                self.changed[block] = self.changes;
            }
        }
        for voxel in changed {
            // A frontier is beside it, a pose has it in its body.
            for at in body_voxels(self.body.clearance.max(1), voxel) {
                self.judge(at);
            }
        }
    }

    /// Whether `voxel` is a frontier and whether a robot may be there.
    fn judge(&mut self, voxel: Voxel) {
        let Some(index) = self.index(voxel) else {
            return;
        };
        let beside = voxel.beside();
        let is_free = |at: &Voxel| self.content(*at) == Content::Free;
        let is_pose = body_voxels(self.body.clearance, voxel).all(|at| is_free(&at));
        let is_known_free = |at: &Voxel| self.index(*at).is_some() && is_free(at);
        let is_frontier =
            self.contents[index] == Content::Unknown && beside.iter().any(is_known_free);
        self.poses[index] = is_pose;
        let block = self.block(voxel);
        if is_frontier {
            self.frontiers.insert(index);
            self.of_block[block].insert(index);
        } else {
            self.frontiers.remove(&index);
            self.of_block[block].remove(&index);
        }
    }

    /// What is known of `voxel`; outside of the box it is free.
    fn content(&self, voxel: Voxel) -> Content {
        self.index(voxel)
            .map_or(Content::Free, |index| self.contents[index])
    }

    /// The sensor's range.
    pub(super) fn range(&self) -> u8 {
        self.body.range
    }

    /// Number of voxels.
    pub(super) fn size(&self) -> usize {
        self.contents.len()
    }

    /// Lines of sight that were tried so far.
    pub(super) fn lines(&self) -> u32 {
        self.lines
    }

    /// Whether a robot may be at `voxel`: its body is known to be free.
    pub fn is_pose(&self, voxel: Voxel) -> bool {
        self.index(voxel).is_some_and(|index| self.poses[index])
    }

    /// The frontiers, level by level.
    pub(super) fn frontiers(&self) -> impl Iterator<Item = Voxel> {
        self.frontiers.iter().map(|&index| self.voxel(index))
    }

    /// Whether a frontier is in sight of `place`.
    pub(super) fn shows_frontier(&mut self, place: Voxel) -> bool {
        let Some(index) = self.index(place) else {
            return false;
        };
        if self.is_as_after(self.barren[index], place) {
            return false;
        }
        let most = u32::from(self.body.range).pow(2);
        let mut lines = 0;
        let is_shown = self.blocks_about(place).any(|block| {
            self.of_block[block].iter().any(|&frontier| {
                let voxel = self.voxel(frontier);
                place.distance_squared(voxel) <= most && {
                    lines += 1;
                    self.is_in_sight(place, voxel)
                }
            })
        });
        self.lines += lines;
        if !is_shown {
            self.barren[index] = self.changes;
        }
        is_shown
    }

    /// The places where a robot may be that have `frontier` in sight.
    pub(super) fn shown_from(&mut self, frontier: Voxel) -> &[Voxel] {
        let Some(index) = self.index(frontier) else {
            return &[];
        };
        if !self.is_as_after(self.shown_from[index].0, frontier) {
            let places = self.ball.iter().map(|at| moved(frontier, *at));
            let places: Vec<_> = places.filter(|&place| self.is_pose(place)).collect();
            self.lines += places.len() as u32;
            let shows = |place: &Voxel| self.is_in_sight(*place, frontier);
            let places = places.into_iter().filter(shows).collect();
            self.shown_from[index] = (self.changes, places);
        }
        &self.shown_from[index].1
    }

    fn is_in_sight(&self, eye: Voxel, voxel: Voxel) -> bool {
        in_sight(eye, voxel, |at| self.content(at) == Content::Free)
    }

    /// Whether nothing has changed about `middle`, within range and beside that, since there
    /// were so many changes.
    fn is_as_after(&self, changes: u32, middle: Voxel) -> bool {
        let mut blocks = self.blocks_about(middle);
        changes > 0 && blocks.all(|block| self.changed[block] <= changes)
    }

    /// Blocks along the sides of the box.
    fn blocks(&self) -> [usize; 3] {
        let Extent { width, height } = self.extent;
        let sides = [width, height, u16::from(self.levels)];
        sides.map(|side| usize::from(side.div_ceil(BLOCK as u16)))
    }

    fn block(&self, voxel: Voxel) -> usize {
        let [x, y, z] = [voxel.x, voxel.y, voxel.z].map(|at| (at / BLOCK) as usize);
        let [width, height, _] = self.blocks();
        (z * height + y) * width + x
    }

    /// The blocks that reach within range of `middle`, or beside that.
    fn blocks_about(&self, middle: Voxel) -> impl Iterator<Item = usize> + use<> {
        let reach = i16::from(self.body.range) + 1;
        let [width, height, levels] = self.blocks();
        let span = move |at: i16, side: usize| {
            let first = (at - reach).max(0) / BLOCK;
            let last = ((at + reach) / BLOCK).min(side as i16 - 1);
            first as usize..(last + 1) as usize
        };
        let planes = span(middle.z, levels)
            .flat_map(move |z| span(middle.y, height).map(move |y| z * height + y));
        planes.flat_map(move |plane| span(middle.x, width).map(move |x| plane * width + x))
    }

    /// The place of a voxel of the box in a table, level by level.
    pub(super) fn index(&self, voxel: Voxel) -> Option<usize> {
        let Extent { width, height } = self.extent;
        let is_inside =
            self.extent.contains(voxel.cell()) && (0..i16::from(self.levels)).contains(&voxel.z);
        let [x, y, z] = [voxel.x, voxel.y, voxel.z].map(|at| at as usize);
        is_inside.then(|| (z * usize::from(height) + y) * usize::from(width) + x)
    }

    fn voxel(&self, index: usize) -> Voxel {
        let Extent { width, height } = self.extent;
        let (width, height) = (usize::from(width), usize::from(height));
        let [x, y, z] = [
            index % width,
            index / width % height,
            index / (width * height),
        ];
        Voxel::new(x as i16, y as i16, z as i16)
    }
}

/// The voxels within `range` of the one at 0, 0, 0, level by level.
fn ball(range: u8) -> Vec<Voxel> {
    let reach = i16::from(range);
    let side = move || -reach..=reach;
    let planes = side().flat_map(move |z| side().map(move |y| (y, z)));
    let voxels = planes.flat_map(move |(y, z)| side().map(move |x| Voxel::new(x, y, z)));
    let (middle, most) = (Voxel::new(0, 0, 0), u32::from(range).pow(2));
    let is_near = |at: &Voxel| at.distance_squared(middle) <= most;
    voxels.filter(is_near).collect()
}

fn moved(voxel: Voxel, by: Voxel) -> Voxel {
    Voxel::new(voxel.x + by.x, voxel.y + by.y, voxel.z + by.z)
}
