//! Looks that err: what a planner is told of what is seen.

use std::borrow::Cow;

use planner_core::volume::Voxel;

use crate::dice::Lot;
use crate::scenario::Trouble;

/// `view` from `eye` with voxels mistaken by `lot`, that of the look.
pub(super) fn told<'a>(
    trouble: &Trouble,
    lot: Lot,
    eye: Voxel,
    view: &'a [(Voxel, bool)],
) -> Cow<'a, [(Voxel, bool)]> {
    let Trouble {
        false_walls,
        false_frees,
        ..
    } = *trouble;
    if !trouble.mistakes_places() {
        return Cow::Borrowed(view);
    }
    let mistaken = |&(voxel, occupied): &(Voxel, bool)| {
        let share = if occupied { false_frees } else { false_walls };
        let lot = lot.at(voxel.cell()).of(voxel.z as u64);
        (voxel, occupied ^ (voxel != eye && lot.happens(share)))
    };
    view.iter().map(mistaken).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYE: Voxel = Voxel::new(0, 0, 0);

    fn told_in(tick: u64, trouble: &Trouble) -> Vec<(Voxel, bool)> {
        let voxel = |i: i16| Voxel::new(i % 20, i / 20 % 20, i / 400);
        let view: Vec<_> = (0..4000).map(|i| (voxel(i), i % 2 == 1)).collect();
        told(trouble, Lot::new(3).of(tick), EYE, &view).into_owned()
    }

    #[test]
    fn voxels_are_mistaken_as_often_as_is_said_and_anew_by_each_look() {
        let trouble = Trouble {
            false_walls: 0.1,
            false_frees: 0.3,
            ..Trouble::default()
        };
        let told = told_in(0, &trouble);
        let share = |is_wall: bool| {
            let of_kind = told
                .iter()
                .zip(0..)
                .filter(|(_, i)| (i % 2 == 1) == is_wall);
            of_kind.filter(|((_, told), _)| *told != is_wall).count() as f64 / 2000.0
        };
        assert!((share(false) - 0.1).abs() < 0.03, "{}", share(false));
        assert!((share(true) - 0.3).abs() < 0.05, "{}", share(true));
        assert!(!told[0].1, "where the robot is nothing else is");
        assert_eq!(told, told_in(0, &trouble));
        assert_ne!(told, told_in(1, &trouble));
    }
}
