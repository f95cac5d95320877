//! Sets of voxels of a scene.

use planner_core::volume::Voxel;

use super::Scene;

/// One bit for each voxel of a scene, and their number.
#[derive(Clone, Debug)]
pub(crate) struct Marks {
    words: Vec<u64>,
    count: u32,
}

impl Marks {
    /// None of the voxels of `scene`.
    pub(crate) fn of(scene: &Scene) -> Self {
        Self {
            words: vec![0; scene.contents.len().div_ceil(64)],
            count: 0,
        }
    }

    /// Says whether `voxel` is in the scene and was not marked before.
    pub(crate) fn insert(&mut self, scene: &Scene, voxel: Voxel) -> bool {
        let Some(index) = scene.index(voxel) else {
            return false;
        };
        let (word, bit) = (&mut self.words[index / 64], 1 << (index % 64));
        let is_new = *word & bit == 0;
        *word |= bit;
        self.count += u32::from(is_new);
        is_new
    }

    /// Marks `voxel` or takes its mark away; says whether that was news.
    pub(crate) fn put(&mut self, scene: &Scene, voxel: Voxel, is_marked: bool) -> bool {
        if is_marked {
            return self.insert(scene, voxel);
        }
        let is_news = self.contains(scene, voxel);
        if let Some(index) = scene.index(voxel).filter(|_| is_news) {
            self.words[index / 64] &= !(1 << (index % 64));
            self.count -= 1;
        }
        is_news
    }

    pub(crate) fn contains(&self, scene: &Scene, voxel: Voxel) -> bool {
        let index = scene.index(voxel);
        index.is_some_and(|index| self.words[index / 64] & 1 << (index % 64) != 0)
    }

    /// How many are marked.
    pub(crate) fn count(&self) -> u32 {
        self.count
    }
}
