//! Worlds of voxels: streets, undersides, rooms.

mod look;
pub mod octree;

use planner_core::Extent;
use planner_core::volume::Voxel;

use crate::dice::Dice;

pub use look::look;
pub(crate) use look::visible;

/// A box of voxels; voxels of one cell's side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scene {
    name: String,
    extent: Extent,
    levels: u8,
    occupied: Vec<bool>,
}

/// Columns along a side of the largest scene.
pub(crate) const LARGEST: u16 = 64;
/// Levels of the highest scene.
pub(crate) const LEVELS: u8 = 24;

impl Scene {
    /// A scene in which `is_occupied` says where something is.
    pub fn from_fn(
        name: impl Into<String>,
        extent: Extent,
        levels: u8,
        is_occupied: impl FnMut(Voxel) -> bool,
    ) -> Self {
        Self {
            name: name.into(),
            extent,
            levels,
            occupied: voxels(extent, levels).map(is_occupied).collect(),
        }
    }

    /// A town of `side`×`side` columns drawn by `seed`: streets, buildings of one or
    /// two storeys with rooms, doors, windows, upper floors that stand out over the
    /// street, footbridges, and vehicles with room beneath. Robots fly in towns of up to
    /// 64×64 columns.
    pub fn town(seed: u64, side: u16) -> Self {
        /// A block with its street, the street, and a storey with its ceiling.
        const BLOCK: i16 = 20;
        const STREET: i16 = 8;
        const STOREY: i16 = 6;
        let mut dice = Dice::new(seed);
        let mut scene = Self::from_fn(format!("town-{seed}"), Extent::new(side, side), 18, |v| {
            v.z == 0
        });
        let blocks = side as i16 / BLOCK + 1;
        for block in 0..blocks * blocks {
            let (west, north) = (
                block % blocks * BLOCK + STREET,
                block / blocks * BLOCK + STREET,
            );
            let (east, south) = (west + BLOCK - STREET - 1, north + BLOCK - STREET - 1);
            let storeys = 1 + dice.residue(2) as i16;
            let juts_out = dice.residue(2) == 0;
            for storey in 0..storeys {
                let floor = 1 + storey * STOREY;
                let out = if storey > 0 && juts_out { 2 } else { 0 };
                let (w, n, e, s) = (west - out, north - out, east, south);
                if storey > 0 {
                    scene.fill([w, n, floor - 1], [e, s, floor - 1], true);
                }
                scene.fill([w, n, floor], [e, s, floor + STOREY - 1], true);
                scene.fill(
                    [w + 1, n + 1, floor],
                    [e - 1, s - 1, floor + STOREY - 2],
                    false,
                );
                // A door or a large window of 3×3 on one side, a slit on another.
                let middle = (north + south) / 2;
                let (x, slit) = if dice.residue(2) == 0 { (w, e) } else { (e, w) };
                scene.fill([x, middle - 1, floor], [x, middle + 1, floor + 3], false);
                scene.fill([slit, middle, floor + 2], [slit, middle, floor + 2], false);
            }
            if dice.residue(3) == 0 {
                let x = (west + east) / 2;
                scene.fill([x, south + 1, 6], [x + 2, south + STREET, 6], true);
            }
            let along = west + dice.residue(6) as i16;
            scene.fill([along, north - 5, 2], [along + 3, north - 4, 2], true);
        }
        scene
    }

    /// Makes the cuboid between two corners, both included, solid or empty.
    fn fill(&mut self, low: [i16; 3], high: [i16; 3], occupied: bool) {
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                for x in low[0]..=high[0] {
                    if let Some(index) = self.index(Voxel::new(x, y, z)) {
                        self.occupied[index] = occupied;
                    }
                }
            }
        }
    }

    fn index(&self, voxel: Voxel) -> Option<usize> {
        let inside =
            self.extent.contains(voxel.cell()) && (0..self.levels.into()).contains(&voxel.z);
        let (width, height) = (
            usize::from(self.extent.width),
            usize::from(self.extent.height),
        );
        inside.then(|| (voxel.z as usize * height + voxel.y as usize) * width + voxel.x as usize)
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Size on the ground plan.
    pub fn extent(&self) -> Extent {
        self.extent
    }

    /// Number of levels.
    pub fn levels(&self) -> u8 {
        self.levels
    }

    /// Whether something is at `voxel`; `None` outside.
    pub fn is_occupied(&self, voxel: Voxel) -> Option<bool> {
        self.index(voxel).map(|index| self.occupied[index])
    }

    /// Whether a robot may be at `voxel`: it and its neighbours are free.
    pub fn is_pose(&self, voxel: Voxel) -> bool {
        self.is_occupied(voxel) == Some(false)
            && voxel
                .beside()
                .iter()
                .all(|&v| self.is_occupied(v) != Some(true))
    }

    /// All voxels, level by level.
    pub fn voxels(&self) -> impl Iterator<Item = Voxel> + use<> {
        voxels(self.extent, self.levels)
    }
}

fn voxels(extent: Extent, levels: u8) -> impl Iterator<Item = Voxel> {
    let (width, height) = (extent.width as i16, extent.height as i16);
    (0..i16::from(levels)).flat_map(move |z| {
        (0..height).flat_map(move |y| (0..width).map(move |x| Voxel::new(x, y, z)))
    })
}
