//! Line of sight between voxels, in whole numbers.

use super::Voxel;

/// Whether the straight line from the centre of `from` to the centre of `to` is clear:
/// every voxel between them for which `is_clear` is asked. Where the line passes
/// through an edge, one of the two voxels beside it must be clear; through a corner, one
/// way round it, over two voxels side by side: sight does not slip through where walls
/// touch. It is the same in both directions.
///
/// Cost: at most 7 calls of `is_clear` for each voxel on the line.
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
        let mut crosses = [false; 3];
        for axis in 0..3 {
            if let (Some(crosses), Some(&next)) = (crosses.get_mut(axis), next.get(axis))
                && next == first
                && let Some(crossed) = crossed.get_mut(axis)
            {
                *crosses = true;
                *crossed += 1;
                after = moved(after, axis, sign);
            }
        }
        let [x, y, z] = after;
        let at = Voxel::new(x, y, z);
        let mut is_clear_at = |[x, y, z]: [i16; 3]| is_clear(Voxel::new(x, y, z));
        let axes = crosses.map(u8::from).iter().sum::<u8>();
        if axes > 1 {
            let back = sign.map(i16::saturating_neg);
            let mut before = [false; 3];
            let mut behind = [false; 3];
            for (axis, (before, behind)) in before.iter_mut().zip(&mut behind).enumerate() {
                if crosses.get(axis) == Some(&true) {
                    *before = is_clear_at(moved(here, axis, sign));
                    // Through an edge both ways lead over the same voxels.
                    *behind = axes == 2 || is_clear_at(moved(after, axis, back));
                }
            }
            let leads_round = |i: usize, j: usize| {
                i != j && before.get(i) == Some(&true) && behind.get(j) == Some(&true)
            };
            if !(0..3).any(|i| (0..3).any(|j| leads_round(i, j))) {
                return false;
            }
        }
        here = after;
        if at == to {
            return true;
        }
        if !is_clear(at) {
            return false;
        }
    }
    true
}

/// The voxel beside `at` along an axis.
fn moved(mut at: [i16; 3], axis: usize, sign: [i16; 3]) -> [i16; 3] {
    if let (Some(coordinate), Some(&sign)) = (at.get_mut(axis), sign.get(axis)) {
        *coordinate = coordinate.saturating_add(sign);
    }
    at
}
