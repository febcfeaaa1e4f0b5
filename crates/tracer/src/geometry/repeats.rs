//! Search for duplicate triangles.
//!
//! A hash of each triangle is sorted together with its number, so that equal triangles are adjacent. Equal hashes count only if the triangles
//! themselves are equal.

use rayon::prelude::*;

/// The corners of a triangle, as bits in an order that all its rotations and mirror images share.
pub(super) type CornerBits = [[u32; 3]; 3];

/// A triangle and the hash of its corners; ordered by the hash.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HashedTriangle {
    hash: u64,
    number: u32,
}

/// Of the triangles that are `kept`, those that are equal to an earlier one of them. Runs on the caller's thread pool.
pub(super) fn duplicates(is_used: &[bool], corners: impl Fn(u32) -> CornerBits + Sync) -> Vec<u32> {
    let numbers = 0..is_used.len() as u32;
    let candidates = numbers.into_par_iter().filter(|number| is_used[*number as usize]);
    let hashed = |number| HashedTriangle { hash: hash(&corners(number)), number };
    let mut hashed: Vec<HashedTriangle> = candidates.map(hashed).collect();
    hashed.par_sort_unstable();
    let runs = hashed.chunk_by(|a, b| a.hash == b.hash).filter(|run| run.len() > 1);
    runs.flat_map(|run| duplicates_of_run(run, &corners)).collect()
}

/// The same for triangles of one hash, in increasing order: nearly always copies of one triangle.
fn duplicates_of_run(run: &[HashedTriangle], corners: &impl Fn(u32) -> CornerBits) -> Vec<u32> {
    let mut first: Vec<CornerBits> = Vec::new();
    let mut repeats = Vec::new();
    for HashedTriangle { number, .. } in run {
        let own = corners(*number);
        match first.contains(&own) {
            true => repeats.push(*number),
            false => first.push(own),
        }
    }
    repeats
}

/// Word by word: added, multiplied by an odd number, upper bits folded into lower ones (the step of Fowler, Noll and Vo's
/// FNV-1a on 32 bits at a time, with a shift so that upper bits count).
fn hash(corners: &CornerBits) -> u64 {
    const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
    const FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
    corners.as_flattened().iter().fold(OFFSET, |hash, word| {
        let mixed = (hash ^ u64::from(*word)).wrapping_mul(FACTOR);
        mixed ^ (mixed >> 32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_triangles_is_no_repeat_and_what_is_dropped_does_not_count() {
        let list = [3, 1, 3, 2, 1, 3, 2].map(|n: u32| [[n, 0, 0], [0, n, 0], [0, 0, n]]);
        let is_used = [false, true, true, true, true, true, true];
        let mut duplicates_found = duplicates(&is_used, |i| list[i as usize]);
        duplicates_found.sort_unstable();
        assert_eq!(duplicates_found, [4, 5, 6]);
    }

    #[test]
    fn equal_hashes_are_no_proof() {
        let list = [1, 2, 1].map(|n: u32| [[n; 3]; 3]);
        let run = [0, 1, 2].map(|number| HashedTriangle { hash: 7, number });
        assert_eq!(duplicates_of_run(&run, &|i| list[i as usize]), [2]);
    }
}
