//! What `heapless::Vec` does with a panic path, without one.

use core::mem;

use heapless::Vec;

/// Puts `value` at `place`, or behind all others if there are fewer. Not if the list is
/// full; says whether it did.
pub(crate) fn insert<T, const N: usize>(list: &mut Vec<T, N>, place: usize, value: T) -> bool {
    let has_room = list.push(value).is_ok();
    if has_room
        && let Some(behind) = list.get_mut(place..)
        && let Some((last, rest)) = behind.split_last_mut()
    {
        for next in rest {
            mem::swap(next, last);
        }
    }
    has_room
}

/// Puts `value` in its place in a list with the least number in front; of a full list the
/// last one leaves, if it has a greater number. Says whether the value is in the list.
pub(crate) fn keep_least<T, const N: usize>(
    list: &mut Vec<(f32, T), N>,
    number: f32,
    value: T,
) -> bool {
    if list.is_full() {
        if list.last().is_none_or(|last| number >= last.0) {
            return false;
        }
        list.pop();
    }
    let place = list
        .iter()
        .take_while(|(least, _)| *least <= number)
        .count();
    insert(list, place, (number, value))
}

/// Puts `value` behind all others. Of a full list the first one leaves.
pub(crate) fn push_out<T, const N: usize>(list: &mut Vec<T, N>, value: T) {
    if list.is_full()
        && let Some((last, rest)) = list.split_last_mut()
    {
        for next in rest.iter_mut().rev() {
            mem::swap(next, last);
        }
        *last = value;
    } else {
        let _ = list.push(value);
    }
}

/// Takes out what is at `place`, if there is something; the last one takes its place.
pub(crate) fn take_out<T, const N: usize>(list: &mut Vec<T, N>, place: usize) {
    if let Some(last) = list.len().checked_sub(1)
        && place <= last
    {
        list.swap(place, last);
        list.pop();
    }
}

/// As many of `values` as there is room for.
pub(crate) fn collect<T, const N: usize>(values: impl IntoIterator<Item = T>) -> Vec<T, N> {
    let mut list = Vec::new();
    for value in values {
        if list.push(value).is_err() {
            break;
        }
    }
    list
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn lists_are_as_those_without_a_limit(
            calls in prop::collection::vec((any::<bool>(), 0..7usize, any::<u8>()), 0..20),
        ) {
            let mut list: Vec<u8, 4> = Vec::new();
            let mut oracle = std::vec::Vec::new();
            for (inserts, place, value) in calls {
                if inserts {
                    let had_room = oracle.len() < 4;
                    prop_assert_eq!(insert(&mut list, place, value), had_room);
                    if had_room {
                        oracle.insert(place.min(oracle.len()), value);
                    }
                } else {
                    push_out(&mut list, value);
                    oracle.push(value);
                    if oracle.len() > 4 {
                        oracle.remove(0);
                    }
                }
                prop_assert_eq!(list.as_slice(), oracle.as_slice());
            }
        }
    }

    #[test]
    fn the_last_takes_the_place_of_what_is_taken_out() {
        let mut list: Vec<u8, 4> = collect(0..4);
        for (place, left) in [(1, &[0, 3, 2][..]), (2, &[0, 3]), (2, &[0, 3]), (0, &[3])] {
            take_out(&mut list, place);
            assert_eq!(list.as_slice(), left);
        }
    }

    #[test]
    fn what_fits_is_collected() {
        assert_eq!(collect::<u8, 3>(0..9).as_slice(), [0, 1, 2]);
        assert_eq!(collect::<u8, 3>(0..2).as_slice(), [0, 1]);
        let mut none: Vec<u8, 0> = collect(0..2);
        push_out(&mut none, 1);
        assert!(!insert(&mut none, 0, 1) && none.is_empty());
    }
}
