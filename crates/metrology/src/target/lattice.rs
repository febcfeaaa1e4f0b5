//! Points put in rows and columns.
//!
//! From a point and two steps to neighbours, the lattice grows by one place at a time: the next point is looked for where
//! the last steps in that direction lead, so that rows may bend and spacings shrink as far as they do so gradually (up to
//! 30 % from one step to the next), in any perspective and distortion. Of all lattices that points can start the largest
//! is taken. Steps are told from diagonals by `linked`; where it cannot tell (dots), by length: squares that are seen at
//! more than 50° from the front along their diagonal may be taken for rhombi.

use super::neighbours::Neighbours;
use glam::DVec2;
use std::collections::{BTreeMap, VecDeque};

/// Places of points: column and row to point.
pub(super) type Places = BTreeMap<[i32; 2], usize>;

/// How far a point may lie from where it is expected, in steps.
const TOLERANCE: f64 = 0.3;

/// The largest lattice that points form; `linked` says of two points whether one is the next of the other.
pub(super) fn largest(points: &[DVec2], linked: &impl Fn(usize, usize) -> bool) -> Places {
    let search = Search { points, neighbours: Neighbours::of(points), linked };
    let mut best = Places::new();
    let mut seen = vec![false; points.len()];
    let mut left = points.len();
    for seed in search.seeds() {
        if seen[seed] {
            continue;
        }
        if left <= best.len() {
            break;
        }
        let found = search.around_seed(seed);
        seen[seed] = true;
        left -= 1;
        if found.len() >= 4 {
            for point in found.values().filter(|p| **p != seed) {
                left -= usize::from(!seen[*point]);
                seen[*point] = true;
            }
        }
        if found.len() > best.len() {
            best = found;
        }
    }
    best
}

struct Search<'a, L> {
    points: &'a [DVec2],
    neighbours: Neighbours<'a>,
    linked: &'a L,
}

/// A placed point's steps to the next column and row.
type Steps = [DVec2; 2];

impl<L: Fn(usize, usize) -> bool> Search<'_, L> {
    /// All points, those in the midst of the others first.
    fn seeds(&self) -> Vec<usize> {
        let centre = self.points.iter().sum::<DVec2>() / self.points.len().max(1) as f64;
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        order.sort_by(|a, b| {
            let distance = |i: &usize| (self.points[*i] - centre).length_squared();
            distance(a).total_cmp(&distance(b)).then(a.cmp(b))
        });
        order
    }

    fn around_seed(&self, seed: usize) -> Places {
        match self.first_steps(seed) {
            Some(steps) => self.grown(seed, steps),
            None => Places::new(),
        }
    }

    /// Two steps from a point: to the nearest linked one, and to the nearest linked one across.
    fn first_steps(&self, seed: usize) -> Option<Steps> {
        const AROUND: usize = 12;
        let steps: Vec<DVec2> = self
            .neighbours
            .nearest(seed, AROUND)
            .into_iter()
            .filter(|i| (self.linked)(seed, *i))
            .map(|i| self.points[i] - self.points[seed])
            .collect();
        let first = *steps.first()?;
        // The sine of 37°.
        let across = |step: &&DVec2| first.perp_dot(**step).abs() > 0.6 * first.length() * step.length();
        let second = *steps.iter().find(across)?;
        Some([first, second])
    }

    fn grown(&self, seed: usize, steps: Steps) -> Places {
        let mut places = Places::from([([0, 0], seed)]);
        let mut used = BTreeMap::from([(seed, steps)]);
        let mut queue = VecDeque::from([[0, 0]]);
        while let Some(place) = queue.pop_front() {
            let point = places[&place];
            for (axis, sign) in [(0, 1), (1, 1), (0, -1), (1, -1)] {
                let next = moved(place, axis, sign);
                if places.contains_key(&next) {
                    continue;
                }
                let step = self.expected_step(&places, place, axis, sign, used[&point][axis]);
                let free = |i: &usize| !used.contains_key(i) && self.fits_beside(&places, place, next, *i);
                let Some(found) = self.found(point, step).filter(free) else { continue };
                let mut steps = used[&point];
                steps[axis] = f64::from(sign) * (self.points[found] - self.points[point]);
                used.insert(found, steps);
                places.insert(next, found);
                queue.push_back(next);
            }
        }
        self.smooth(places)
    }

    /// The step from a place, after the two before it in the same line where they are known.
    fn expected_step(&self, places: &Places, place: [i32; 2], axis: usize, sign: i32, known: DVec2) -> DVec2 {
        let at = |back: i32| places.get(&moved(place, axis, -sign * back)).map(|i| self.points[*i]);
        match (at(0), at(1), at(2)) {
            (Some(p), Some(q), Some(r)) => 2.0 * (p - q) - (q - r),
            (Some(p), Some(q), None) => p - q,
            _ => f64::from(sign) * known,
        }
    }

    /// Whether the step from a place to the next is like the same step in the lines beside, where these are known.
    fn fits_beside(&self, places: &Places, place: [i32; 2], next: [i32; 2], point: usize) -> bool {
        let at = |place| places.get(&place).map(|i| self.points[*i]);
        let Some(from) = at(place) else { return false };
        let step = self.points[point] - from;
        let axis = usize::from(place[0] == next[0]);
        [1, -1].iter().all(|side| {
            let beside = [place, next].map(|p| at(moved(p, 1 - axis, *side)));
            let [Some(a), Some(b)] = beside else { return true };
            (b - a - step).length() < TOLERANCE * step.length()
        })
    }

    fn found(&self, from: usize, step: DVec2) -> Option<usize> {
        let near = self.neighbours.within(self.points[from] + step, TOLERANCE * step.length());
        near.into_iter().find(|i| *i != from && (self.linked)(from, *i))
    }

    /// Without points that lie off the middle of their neighbours on both sides by more than a quarter of a step.
    fn smooth(&self, mut places: Places) -> Places {
        let at = |places: &Places, place| places.get(&place).map(|i| self.points[*i]);
        let off = |places: &Places, place: [i32; 2]| {
            (0..2).any(|axis| {
                let (before, after) = (at(places, moved(place, axis, -1)), at(places, moved(place, axis, 1)));
                let (Some(a), Some(p), Some(b)) = (before, at(places, place), after) else { return false };
                (0.5 * (a + b) - p).length() > 0.25 * 0.5 * (b - a).length()
            })
        };
        let strays: Vec<[i32; 2]> = places.keys().copied().filter(|place| off(&places, *place)).collect();
        strays.iter().for_each(|place| {
            places.remove(place);
        });
        places
    }
}

fn moved(mut place: [i32; 2], axis: usize, by: i32) -> [i32; 2] {
    place[axis] += by;
    place
}
