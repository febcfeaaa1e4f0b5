//! Arrangement of points in rows and columns, and lookup of points by position.
//!
//! From a point and two steps to neighbours, the lattice grows by one position at a time: the next point is searched where the
//! last steps in that direction lead. Rows may bend and spacings shrink, if they do so gradually (up to 30 % from one step to the
//! next), in any perspective and distortion. The largest of all lattices from different starting points is used.
//!
//! `linked` distinguishes steps from diagonals. If it cannot (dots), length does; this is most reliable where a cell is nearest
//! to a square, so the lattice starts there. If squares appear as rhombi everywhere, one of their diagonals may be the shorter
//! step, and rows run obliquely: a lattice that is a full rectangle (to a tenth) after its rows or columns are shifted by one or
//! two positions per line is converted to that.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use glam::DVec2;

/// Map from positions (column and row) to points.
pub(super) type PointMap = BTreeMap<[i32; 2], usize>;

/// Maximum distance of a point from its expected position, in steps.
const TOLERANCE: f64 = 0.3;

/// Minimum number of points of a lattice.
const MIN_POINTS: usize = 4;

/// The largest lattice of the points, and the number of points of the second largest; `linked` is true if two points are
/// neighbours in a row or column. Further lattices are searched among more points than `least`.
pub(super) fn largest(
    points: &[DVec2],
    min_points: usize,
    linked: &impl Fn(usize, usize) -> bool,
) -> (PointMap, usize) {
    let search = Search { points, neighbours: PointCells::new(points), linked };
    let mut lattices: Vec<PointMap> = Vec::new();
    let mut visited = vec![false; points.len()];
    let mut left = points.len();
    for seed in search.seeds() {
        if visited[seed] {
            continue;
        }
        if left < min_points.max(MIN_POINTS) && !lattices.is_empty() {
            break;
        }
        let lattice = search.around_seed(seed);
        visited[seed] = true;
        left -= 1;
        if lattice.len() >= MIN_POINTS {
            for point in lattice.values().filter(|p| **p != seed) {
                left -= usize::from(!visited[*point]);
                visited[*point] = true;
            }
            lattices.push(lattice);
        }
    }
    // The first of equal ones.
    lattices.sort_by_key(|lattice| std::cmp::Reverse(lattice.len()));
    let mut lattices = lattices.into_iter();
    let best = lattices.next().unwrap_or_default();
    let own: BTreeSet<usize> = best.values().copied().collect();
    let outside = lattices.map(|other| other.values().filter(|p| !own.contains(p)).count()).max().unwrap_or(0);
    (best, outside)
}

/// For points whose links do not distinguish steps from diagonals (dots): the lattice with its lines shifted so that it is a full
/// rectangle, if it is one only then.
pub(super) fn straight(places: PointMap) -> PointMap {
    const MIN_FULLNESS: f64 = 0.9;
    const MAX_SKEWED_FULLNESS: f64 = 0.8;
    if fullness(&places) > MAX_SKEWED_FULLNESS {
        return places;
    }
    let shifts = [1, -1, 2, -2].into_iter().flat_map(|by| [(0, by), (1, by)]);
    let sheared = shifts.map(|(axis, by)| {
        let shifted = |mut place: [i32; 2]| {
            place[axis] += by * place[1 - axis];
            place
        };
        places.iter().map(|(place, i)| (shifted(*place), *i)).collect::<PointMap>()
    });
    let best = sheared.max_by(|a, b| fullness(a).total_cmp(&fullness(b)));
    best.filter(|best| fullness(best) > MIN_FULLNESS).unwrap_or(places)
}

/// Points divided by the positions of their bounding rectangle.
fn fullness(places: &PointMap) -> f64 {
    let span = |axis: usize| {
        let lines = || places.keys().map(|p| p[axis]);
        lines().max().zip(lines().min()).map_or(1.0, |(high, low)| f64::from(high - low + 1))
    };
    places.len() as f64 / (span(0) * span(1))
}

struct Search<'a, L> {
    points: &'a [DVec2],
    neighbours: PointCells<'a>,
    linked: &'a L,
}

/// Steps of a placed point to the next column and row.
type Steps = [DVec2; 2];

impl<L: Fn(usize, usize) -> bool> Search<'_, L> {
    /// All points; first those whose two steps are nearest to a square's, among equal ones those in the middle of the others.
    fn seeds(&self) -> Vec<usize> {
        /// Maximum difference of equal skews.
        const MAX_SKEW_DIFFERENCE: f64 = 0.1;
        let centre = self.points.iter().sum::<DVec2>() / self.points.len().max(1) as f64;
        let rank = |i: usize| {
            let skew = self.first_steps(i).map_or(f64::INFINITY, skew);
            ((skew / MAX_SKEW_DIFFERENCE).floor(), (self.points[i] - centre).length_squared())
        };
        let mut order: Vec<((f64, f64), usize)> = (0..self.points.len()).map(|i| (rank(i), i)).collect();
        order.sort_by(|(a, i), (b, j)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(i.cmp(j)));
        order.into_iter().map(|(_, i)| i).collect()
    }

    fn around_seed(&self, seed: usize) -> PointMap {
        match self.first_steps(seed) {
            Some(steps) => self.grown(seed, steps),
            None => PointMap::new(),
        }
    }

    /// Two steps from a point: to the nearest linked one, and to the nearest linked one in another direction.
    fn first_steps(&self, seed: usize) -> Option<Steps> {
        const NEIGHBOUR_COUNT: usize = 12;
        let steps: Vec<DVec2> = self
            .neighbours
            .nearest(seed, NEIGHBOUR_COUNT)
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

    fn grown(&self, seed: usize, steps: Steps) -> PointMap {
        let mut places = PointMap::from([([0, 0], seed)]);
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
                let free = |i: &usize| !used.contains_key(i) && self.fits_neighbours(&places, place, next, *i);
                let Some(neighbour) = self.find_point(point, step).filter(free) else { continue };
                let mut steps = used[&point];
                steps[axis] = f64::from(sign) * (self.points[neighbour] - self.points[point]);
                used.insert(neighbour, steps);
                places.insert(next, neighbour);
                queue.push_back(next);
            }
        }
        self.smooth(places)
    }

    /// The step from a position, extrapolated from the two before it in the same line if they are known.
    fn expected_step(&self, places: &PointMap, place: [i32; 2], axis: usize, sign: i32, known: DVec2) -> DVec2 {
        let at = |back: i32| places.get(&moved(place, axis, -sign * back)).map(|i| self.points[*i]);
        match (at(0), at(1), at(2)) {
            (Some(p), Some(q), Some(r)) => 2.0 * (p - q) - (q - r),
            (Some(p), Some(q), None) => p - q,
            _ => f64::from(sign) * known,
        }
    }

    /// True if the step from a position to the next is similar to the same step in the adjacent lines, where these are known.
    fn fits_neighbours(&self, places: &PointMap, place: [i32; 2], next: [i32; 2], point: usize) -> bool {
        let at = |place| places.get(&place).map(|i| self.points[*i]);
        let Some(from) = at(place) else { return false };
        let step = self.points[point] - from;
        let axis = usize::from(place[0] == next[0]);
        [1, -1].iter().all(|side| {
            let adjacent = [place, next].map(|p| at(moved(p, 1 - axis, *side)));
            let [Some(a), Some(b)] = adjacent else { return true };
            (b - a - step).length() < TOLERANCE * step.length()
        })
    }

    fn find_point(&self, from: usize, step: DVec2) -> Option<usize> {
        let near = self.neighbours.within(self.points[from] + step, TOLERANCE * step.length());
        near.into_iter().find(|i| *i != from && (self.linked)(from, *i))
    }

    /// Removes points that are off the middle of their neighbours on both sides by more than a quarter of a step.
    fn smooth(&self, mut places: PointMap) -> PointMap {
        let at = |places: &PointMap, place| places.get(&place).map(|i| self.points[*i]);
        let off = |places: &PointMap, place: [i32; 2]| {
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

/// Deviation of two steps from a square's: the cosine between them, and the relative difference of their lengths.
fn skew([a, b]: Steps) -> f64 {
    let (p, q) = (a.length(), b.length());
    (a.dot(b) / (p * q)).abs().max(1.0 - p.min(q) / p.max(q))
}

fn moved(mut place: [i32; 2], axis: usize, by: i32) -> [i32; 2] {
    place[axis] += by;
    place
}

/// Points sorted into square cells.
#[derive(Debug)]
pub(super) struct PointCells<'a> {
    points: &'a [DVec2],
    low: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<usize>>,
}

impl<'a> PointCells<'a> {
    /// Cells of about two points each.
    pub(super) fn new(points: &'a [DVec2]) -> Self {
        let (low, high) =
            points.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
        let (low, size) = if points.is_empty() { (DVec2::ZERO, DVec2::ONE) } else { (low, high - low + 1.0) };
        let cell = (2.0 * size.x * size.y / points.len().max(1) as f64).sqrt();
        let (columns, rows) = ((size.x / cell) as usize + 1, (size.y / cell) as usize + 1);
        let mut cells = vec![Vec::new(); columns * rows];
        for (i, p) in points.iter().enumerate() {
            let [x, y] = ((*p - low) / cell).to_array().map(|c| c as usize);
            cells[y * columns + x].push(i);
        }
        Self { points, low, cell, columns, rows, cells }
    }

    /// Points within `radius` of a position, nearest first.
    pub(super) fn within(&self, place: DVec2, radius: f64) -> Vec<usize> {
        let span = |c: f64, count: usize| {
            let cell = |c: f64| (c / self.cell).floor().clamp(0.0, count as f64 - 1.0) as usize;
            cell(c - radius)..=cell(c + radius)
        };
        let from = place - self.low;
        let mut neighbours: Vec<(f64, usize)> = Vec::new();
        for y in span(from.y, self.rows) {
            for x in span(from.x, self.columns) {
                let cell = self.cells[y * self.columns + x].iter();
                neighbours.extend(cell.map(|i| ((self.points[*i] - place).length(), *i)).filter(|(d, _)| *d <= radius));
            }
        }
        neighbours.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        neighbours.into_iter().map(|(_, i)| i).collect()
    }

    /// The `count` points nearest to a point, excluding itself, nearest first.
    pub(super) fn nearest(&self, point: usize, count: usize) -> Vec<usize> {
        let mut radius = self.cell;
        let all = self.cell * (self.columns + self.rows) as f64;
        loop {
            let mut candidates = self.within(self.points[point], radius);
            candidates.retain(|i| *i != point);
            if candidates.len() >= count || radius > all {
                candidates.truncate(count);
                return candidates;
            }
            radius *= 2.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A long board that the image borders cut obliquely: each row begins one position after the row before it.
    #[test]
    fn links_that_exclude_diagonals_are_followed() {
        let points: Vec<DVec2> = (0..10)
            .flat_map(|row| (0..12).map(move |column| DVec2::new(f64::from(column + row), f64::from(row))))
            .collect();
        let linked = |a: usize, b: usize| (points[a] - points[b]).length() < 1.2;
        let (places, _) = largest(&points, MIN_POINTS, &linked);
        assert_eq!(places.len(), 120);
        for (place, point) in &places {
            let right = places.get(&moved(*place, 0, 1)).map(|next| (points[*next] - points[*point]).length());
            let down = places.get(&moved(*place, 1, 1)).map(|next| (points[*next] - points[*point]).length());
            assert!([right, down].into_iter().flatten().all(|step| (step - 1.0).abs() < 1e-9), "{right:?} {down:?}");
        }
        assert!(fullness(&straight(places)) > 0.99, "as dots they would be a rectangle");
    }
}
