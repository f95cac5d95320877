//! Line of sight between voxels, in whole numbers.

use super::Voxel;

/// Whether the straight line from the centre of `from` to the centre of `to` is clear:
/// every voxel between them for which `is_clear` is asked. Where the line passes
/// through an edge or a corner, one of the voxels beside it must be clear: sight does
/// not slip through where two walls touch. It is the same in both directions.
///
/// Cost: at most 3 calls of `is_clear` for each voxel on the line.
// [Amanatides1987]
pub fn in_sight(from: Voxel, to: Voxel, mut is_clear: impl FnMut(Voxel) -> bool) -> bool {
    let ends = [(from.x, to.x), (from.y, to.y), (from.z, to.z)];
    let length = ends.map(|(from, to)| i64::from(from.abs_diff(to)));
    let sign = ends.map(|(from, to)| to.saturating_sub(from).signum());
    let mut here = [from.x, from.y, from.z];
    let mut crossed = [0i64; 3];
    let [a, b, c] = length;
    // The line crosses a border of axis i at (2·crossed + 1) / (2·length): compared
    // over a common denominator.
    let product = a.max(1) * b.max(1) * c.max(1);
    for _ in 0..a + b + c {
        let mut next = [i64::MAX; 3];
        for ((next, &length), &crossed) in next.iter_mut().zip(&length).zip(&crossed) {
            if crossed < length {
                *next = (2 * crossed + 1) * (product / length.max(1));
            }
        }
        let first = next.iter().copied().min().unwrap_or(i64::MAX);
        if first == i64::MAX {
            break;
        }
        let mut after = here;
        let (mut axes, mut any_clear) = (0, false);
        for axis in 0..3 {
            let (Some(&next), Some(&sign)) = (next.get(axis), sign.get(axis)) else {
                continue;
            };
            if next != first {
                continue;
            }
            axes += 1;
            let mut side = here;
            for (moved, crossed) in [(&mut side, None), (&mut after, Some(&mut crossed))] {
                if let Some(coordinate) = moved.get_mut(axis) {
                    *coordinate = coordinate.saturating_add(sign);
                }
                if let Some(count) = crossed.and_then(|crossed| crossed.get_mut(axis)) {
                    *count += 1;
                }
            }
            let [x, y, z] = side;
            any_clear = any_clear || is_clear(Voxel::new(x, y, z));
        }
        here = after;
        let [x, y, z] = here;
        let at = Voxel::new(x, y, z);
        if axes > 1 && !any_clear {
            return false;
        }
        if at == to {
            return true;
        }
        if !is_clear(at) {
            return false;
        }
    }
    true
}
