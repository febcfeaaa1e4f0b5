//! The parts of a plane through which rays pass the lens: its bundles.
//!
//! The plane's points q represent rays (rays of one source in front of the lens, or rays of one sensor point by their slopes). A function gives the
//! filling of the clear apertures by a ray: at most 1 if it passes, `None` if it misses a surface or is totally reflected. Both are symmetric about
//! the line q.y = 0, so only q.y ≥ 0 is searched.
//!
//! Cells are halved until those with an edge are 1/192 of the searched box. Where no ray nearby passes, cells whose filling might fall below 1,
//! judged by its variation across them, are halved further, to 1/49 152. This finds a pupil of f/90 in a front lens of a fisheye, and light that
//! passes at the edge of a lens outside its pupil. Parts closer together than a cell count as one, and so do the fragments into which the tips of a
//! thin crescent fall.

use glam::DVec2;

/// Cells across and up before the first halving.
const COLUMNS: usize = 24;
const ROWS: usize = 12;
/// Levels of halving: of all cells with an edge, and of those that may hide a small bundle.
const EDGE_HALVINGS: usize = 3;
const MAX_HALVINGS: usize = 11;
/// Levels at which cells without any ray, and cells that pass at all tested points, are halved nevertheless.
const MIN_HALVINGS: usize = 2;
/// Required variation within a cell, as a factor, for a possible passing point.
const MAX_VARIATIONS: f64 = 1.5;

/// Relative area below which a part counts as a fragment of another one nearer than a first cell.
const MAX_FRAGMENT_RATIO: f64 = 0.01;

/// A rectangle of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) low: DVec2,
    pub(super) high: DVec2,
}

impl Cell {
    fn quarters(self) -> [Self; 4] {
        let middle = 0.5 * (self.low + self.high);
        let at = |x: bool, y: bool| {
            let pick = |upper: bool, [low, middle, high]: [f64; 3]| if upper { [middle, high] } else { [low, middle] };
            let [x0, x1] = pick(x, [self.low.x, middle.x, self.high.x]);
            let [y0, y1] = pick(y, [self.low.y, middle.y, self.high.y]);
            Self { low: DVec2::new(x0, y0), high: DVec2::new(x1, y1) }
        };
        [at(false, false), at(true, false), at(false, true), at(true, true)]
    }

    /// Corners and centre.
    fn points(&self) -> [DVec2; 5] {
        let (low, high) = (self.low, self.high);
        [low, DVec2::new(high.x, low.y), DVec2::new(low.x, high.y), high, 0.5 * (low + high)]
    }

    /// Distance of a point from it; 0 inside.
    pub(super) fn distance(&self, q: DVec2) -> f64 {
        (self.low - q).max(q - self.high).max(DVec2::ZERO).length()
    }

    fn touches(&self, other: &Self) -> bool {
        let slack = 1e-6 * (self.high - self.low);
        (self.low - slack).cmple(other.high).all() && (other.low - slack).cmple(self.high).all()
    }
}

/// Classification of a cell by its points.
enum CellState {
    /// Some points pass; true if all do.
    Passes(bool),
    /// None passes, but the filling varies enough that one might.
    Near,
    /// None passes.
    Dark,
    /// No ray reaches the other side, clipped or not.
    Blind,
}

fn classify(cell: &Cell, filling: &impl Fn(DVec2) -> Option<f64>) -> CellState {
    let values = cell.points().map(filling);
    let known = values.iter().flatten();
    let minimum = known.clone().copied().fold(f64::INFINITY, f64::min);
    let maximum = known.copied().fold(f64::NEG_INFINITY, f64::max);
    if minimum <= 1.0 {
        CellState::Passes(maximum <= 1.0 && values.iter().all(Option::is_some))
    } else if minimum == f64::INFINITY {
        CellState::Blind
    } else if minimum - 1.0 <= MAX_VARIATIONS * (maximum - minimum) {
        CellState::Near
    } else {
        CellState::Dark
    }
}

/// A connected part that passes: its cells.
#[derive(Clone, Debug)]
pub(super) struct Bundle {
    pub(super) cells: Vec<Cell>,
}

impl Bundle {
    /// The box about it.
    pub(super) fn bounds(&self) -> Cell {
        let start = Cell { low: DVec2::INFINITY, high: DVec2::NEG_INFINITY };
        let grow = |b: Cell, c: &Cell| Cell { low: b.low.min(c.low), high: b.high.max(c.high) };
        self.cells.iter().fold(start, grow)
    }

    fn area(&self) -> f64 {
        self.cells.iter().map(|cell| (cell.high - cell.low).element_product()).sum()
    }

    /// Distance of a point from its cells.
    pub(super) fn distance(&self, q: DVec2) -> f64 {
        self.cells.iter().map(|cell| cell.distance(q)).fold(f64::INFINITY, f64::min)
    }
}

/// All bundles in a box (its lower edge on the line of symmetry).
pub(super) fn bundles(bounds: Cell, filling: &impl Fn(DVec2) -> Option<f64>) -> Vec<Bundle> {
    let size = (bounds.high - bounds.low) / DVec2::new(COLUMNS as f64, ROWS as f64);
    let cell = |i: usize| {
        let low = bounds.low + size * DVec2::new((i % COLUMNS) as f64, (i / COLUMNS) as f64);
        Cell { low, high: low + size }
    };
    let mut open: Vec<Cell> = (0..COLUMNS * ROWS).map(cell).collect();
    let mut parts = Vec::new();
    for level in 0..=MAX_HALVINGS {
        let (mut halved, mut near) = (Vec::new(), Vec::new());
        for cell in open {
            match classify(&cell, filling) {
                CellState::Passes(all) if level >= EDGE_HALVINGS || (all && level >= MIN_HALVINGS) => parts.push(cell),
                CellState::Near if level >= EDGE_HALVINGS => near.push(cell),
                CellState::Passes(_) | CellState::Near => halved.push(cell),
                CellState::Blind if level < MIN_HALVINGS => halved.push(cell),
                CellState::Blind | CellState::Dark => {}
            }
        }
        // The surroundings of a known bundle are its edge.
        near.retain(|cell| !parts.iter().any(|known: &Cell| known.touches(cell)));
        open = halved.into_iter().chain(near).flat_map(Cell::quarters).collect();
    }
    without_crumbs(connected(parts), size.max_element())
}

/// Joins fragments to the largest part that is nearer than `reach`.
fn without_crumbs(mut parts: Vec<Bundle>, reach: f64) -> Vec<Bundle> {
    parts.sort_by(|a, b| b.area().total_cmp(&a.area()));
    let mut list: Vec<Bundle> = Vec::new();
    for part in parts {
        let crumb_of = |parent: &Bundle| {
            let near = part.cells.iter().any(|cell| parent.distance(0.5 * (cell.low + cell.high)) < reach);
            part.area() < MAX_FRAGMENT_RATIO * parent.area() && near
        };
        match list.iter().position(crumb_of) {
            Some(i) => list[i].cells.extend(part.cells),
            None => list.push(part),
        }
    }
    list
}

/// Groups of touching cells.
fn connected(mut cells: Vec<Cell>) -> Vec<Bundle> {
    let mut list = Vec::new();
    while let Some(first) = cells.pop() {
        let (mut group, mut next) = (vec![first], 0);
        while next < group.len() {
            let (touching, others) = cells.into_iter().partition(|cell| cell.touches(&group[next]));
            cells = others;
            group.extend::<Vec<Cell>>(touching);
            next += 1;
        }
        list.push(Bundle { cells: group });
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds() -> Cell {
        Cell { low: DVec2::new(-10.0, 0.0), high: DVec2::new(10.0, 10.0) }
    }

    #[test]
    fn a_disc_of_a_ten_thousandth_of_the_box_is_found() {
        for (x, radius) in [(0.3, 0.001), (-7.77, 0.01), (4.0, 2.0)] {
            let actual = bundles(bounds(), &|q: DVec2| Some((q - DVec2::new(x, 0.0)).length() / radius));
            assert_eq!(actual.len(), 1);
            let middle = actual[0].bounds();
            assert!((0.5 * (middle.low.x + middle.high.x) - x).abs() < 0.05 + radius, "{middle:?}");
        }
    }

    #[test]
    fn a_disc_and_a_crescent_beside_it_are_two_and_a_dark_plane_is_none() {
        let disc = |q: DVec2| q.length() / 2.0;
        // The part of a ring of radii 5 to 6 with x above 4.
        let crescent = |q: DVec2| (1.0 + (q.length() - 5.5).abs() - 0.5).max(1.0 + 4.0 - q.x);
        let actual = bundles(bounds(), &|q: DVec2| Some(disc(q).min(crescent(q))));
        let mut widths: Vec<f64> = actual.iter().map(|b| b.bounds().high.x - b.bounds().low.x).collect();
        widths.sort_by(f64::total_cmp);
        assert_eq!(widths.len(), 2);
        assert!((widths[0] - 2.0).abs() < 0.3 && (widths[1] - 4.0).abs() < 0.3, "{widths:?}");
        assert!(bundles(bounds(), &|q: DVec2| Some(2.0 + q.length())).is_empty());
        assert!(bundles(bounds(), &|_| None).is_empty());
    }
}
