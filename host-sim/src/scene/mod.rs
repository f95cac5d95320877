//! Worlds of voxels: streets, undersides, rooms.

mod error;
mod file;
mod look;
mod marks;
mod mesh;
pub mod octree;
mod pcd;
mod ply;
mod sensor;
mod shape;
mod space;
mod stl;

use planner_core::Extent;
use planner_core::volume::{Content, Voxel, body_voxels};
use serde::{Deserialize, Serialize};

use crate::dice::Dice;

pub use error::SceneError;
pub use file::SceneOptions;
pub use look::look;
pub(crate) use look::{look_towards, visible};
pub(crate) use marks::Marks;
pub use sensor::{Fov, Sensor};
pub use shape::Free;

/// A box of voxels. What a scan left unknown is neither free nor occupied: nothing flies
/// or sees there.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    name: String,
    extent: Extent,
    levels: u8,
    frame: Option<Frame>,
    free: Option<Free>,
    contents: Vec<Content>,
}

/// Where the box of a scene lies in the coordinates of the file that it comes from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Side of a voxel in metres.
    pub voxel_size: f64,
    /// The scene's voxel (0, 0, 0) counted from the origin of the coordinates: its lower
    /// corner lies there times `voxel_size`.
    pub corner: octree::Voxel,
}

impl Frame {
    /// Of scenes that nothing says more of: a voxel is a metre wide.
    pub const PLAIN: Self = Self {
        voxel_size: 1.0,
        corner: [0; 3],
    };

    /// Whether its voxels have a size and lie where an octree has voxels.
    pub(crate) fn is_good(&self) -> bool {
        let is_near = |corner: &i32| corner.unsigned_abs() <= 1 << 15;
        self.voxel_size.is_finite() && self.voxel_size > 0.0 && self.corner.iter().all(is_near)
    }

    /// The voxel in which a point lies, in metres; `None` beyond all boxes.
    pub fn voxel(&self, point: [f64; 3]) -> Option<Voxel> {
        let mut voxel = [0i16; 3];
        for (axis, voxel) in voxel.iter_mut().enumerate() {
            let at = (point[axis] / self.voxel_size).floor() - f64::from(self.corner[axis]);
            *voxel = (at.abs() < f64::from(i16::MAX)).then_some(at as i16)?;
        }
        let [x, y, z] = voxel;
        Some(Voxel::new(x, y, z))
    }

    /// A voxel counted from the origin of the coordinates.
    pub(crate) fn key(&self, voxel: Voxel) -> octree::Voxel {
        let at = [voxel.x, voxel.y, voxel.z];
        [0, 1, 2].map(|axis| i32::from(at[axis]) + self.corner[axis])
    }

    /// The middle of a voxel, in metres.
    pub fn middle(&self, voxel: Voxel) -> [f64; 3] {
        let key = self.key(voxel);
        key.map(|at| (f64::from(at) + 0.5) * self.voxel_size)
    }
}

/// Columns along a side of the largest scene.
pub(crate) const LARGEST: u16 = 512;
/// Levels of the highest scene.
pub(crate) const LEVELS: u8 = 255;

impl Scene {
    /// A scene in which `is_occupied` says where something is.
    pub fn from_fn(
        name: impl Into<String>,
        extent: Extent,
        levels: u8,
        mut is_occupied: impl FnMut(Voxel) -> bool,
    ) -> Self {
        let content = |voxel| match is_occupied(voxel) {
            true => Content::Occupied,
            false => Content::Free,
        };
        Self::from_contents(name, extent, levels, content)
    }

    /// A scene of what `content` says of each voxel.
    pub fn from_contents(
        name: impl Into<String>,
        extent: Extent,
        levels: u8,
        content: impl FnMut(Voxel) -> Content,
    ) -> Self {
        Self {
            name: name.into(),
            extent,
            levels,
            frame: None,
            free: None,
            contents: voxels(extent, levels).map(content).collect(),
        }
    }

    /// The same in the coordinates of a file.
    pub fn framed(self, frame: Option<Frame>) -> Self {
        Self { frame, ..self }
    }

    /// The same with what was taken for free.
    pub fn freed(self, free: Option<Free>) -> Self {
        Self { free, ..self }
    }

    /// The same by another name.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
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
                        self.contents[index] = match occupied {
                            true => Content::Occupied,
                            false => Content::Free,
                        };
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

    /// Its coordinates, where it comes from a file.
    pub fn frame(&self) -> Option<Frame> {
        self.frame
    }

    /// What was taken for free, if the file did not say that.
    pub fn free(&self) -> Option<Free> {
        self.free
    }

    /// What is at `voxel`; `None` outside.
    pub fn content(&self, voxel: Voxel) -> Option<Content> {
        self.index(voxel).map(|index| self.contents[index])
    }

    /// Whether something is known to be at `voxel`.
    pub fn is_occupied(&self, voxel: Voxel) -> bool {
        self.content(voxel) == Some(Content::Occupied)
    }

    /// Whether it says what is at `voxel`.
    pub fn is_known(&self, voxel: Voxel) -> bool {
        !matches!(self.content(voxel), None | Some(Content::Unknown))
    }

    /// Whether sight and flight end at `voxel`: something is there, or may be.
    pub fn is_solid(&self, voxel: Voxel) -> bool {
        matches!(
            self.content(voxel),
            Some(Content::Occupied | Content::Unknown)
        )
    }

    /// Whether a robot of this clearance may be at `voxel`: it is free, and its body touches
    /// nothing solid.
    pub fn is_pose(&self, voxel: Voxel, clearance: u8) -> bool {
        self.content(voxel) == Some(Content::Free)
            && body_voxels(clearance, voxel).all(|at| !self.is_solid(at))
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
