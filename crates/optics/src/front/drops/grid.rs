//! A uniform grid over the glass that finds the drops near a point or a line.

use glam::{DVec2, IVec2};

/// Maximum cells per side.
const MAX_SIDE: f64 = 2048.0;

/// Discs in the cells of a uniform grid.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DiscGrid {
    origin_mm: DVec2,
    cell_mm: f64,
    cells: IVec2,
    /// Offset of the discs of each cell in `discs`, and the end.
    starts: Vec<u32>,
    discs: Vec<u32>,
}

impl DiscGrid {
    /// Builds a grid of discs: centres and radii, mm. Cells hold about one disc each.
    pub(super) fn new(discs: &[(DVec2, f64)]) -> Self {
        let corner = |side: f64| discs.iter().map(move |(at, r)| *at + side * *r);
        let low = corner(-1.0).reduce(DVec2::min).unwrap_or(DVec2::ZERO);
        let high = corner(1.0).reduce(DVec2::max).unwrap_or(DVec2::ZERO);
        let size = high - low;
        let even_mm = (size.x * size.y / discs.len().max(1) as f64).sqrt();
        let cell_mm = even_mm.max(size.max_element() / MAX_SIDE).max(f64::MIN_POSITIVE);
        let cells = (size / cell_mm).floor().as_ivec2() + 1;
        let mut grid = Self { origin_mm: low, cell_mm, cells, starts: Vec::new(), discs: Vec::new() };
        grid.fill(discs);
        grid
    }

    fn fill(&mut self, discs: &[(DVec2, f64)]) {
        let mut entries: Vec<(usize, u32)> = Vec::new();
        for (i, (at, radius)) in discs.iter().enumerate() {
            let (low, high) = (self.cell(*at - *radius), self.cell(*at + *radius));
            for y in low.y.max(0)..=high.y.min(self.cells.y - 1) {
                entries.extend((low.x.max(0)..=high.x.min(self.cells.x - 1)).map(|x| (self.number(x, y), i as u32)));
            }
        }
        entries.sort_unstable();
        let all = (self.cells.x * self.cells.y) as usize;
        self.starts = (0..=all).map(|cell| entries.partition_point(|(c, _)| *c < cell) as u32).collect();
        self.discs = entries.into_iter().map(|(_, disc)| disc).collect();
    }

    fn cell(&self, at: DVec2) -> IVec2 {
        ((at - self.origin_mm) / self.cell_mm).floor().as_ivec2()
    }

    fn number(&self, x: i32, y: i32) -> usize {
        (y * self.cells.x + x) as usize
    }

    fn cell_discs(&self, cell: IVec2) -> &[u32] {
        if cell.cmplt(IVec2::ZERO).any() || cell.cmpge(self.cells).any() {
            return &[];
        }
        let number = self.number(cell.x, cell.y);
        &self.discs[self.starts[number] as usize..self.starts[number + 1] as usize]
    }

    /// Discs in the cell of a point.
    pub(super) fn at(&self, point_mm: DVec2) -> &[u32] {
        self.cell_discs(self.cell(point_mm))
    }

    /// Calls `visit` with the discs of every cell that a segment crosses; a disc in several cells is visited several times.
    pub(super) fn along(&self, from_mm: DVec2, to_mm: DVec2, mut visit: impl FnMut(&[u32])) {
        let Some((from, to)) = self.clip(from_mm, to_mm) else { return };
        let (mut cell, last) = (self.cell(from), self.cell(to));
        let direction = to - from;
        let step = IVec2::new(direction.x.signum() as i32, direction.y.signum() as i32);
        // Fractions of the segment at the next border, and from border to border.
        let border = |i: usize| {
            let next = f64::from(cell[i] + step[i].max(0)) * self.cell_mm + self.origin_mm[i];
            if direction[i] == 0.0 { f64::INFINITY } else { (next - from[i]) / direction[i] }
        };
        let mut next = DVec2::new(border(0), border(1));
        let between = DVec2::splat(self.cell_mm) / direction.abs();
        let maximum = (last - cell).abs();
        for _ in 0..=(maximum.x + maximum.y) {
            visit(self.cell_discs(cell));
            let axis = usize::from(next.y < next.x);
            cell[axis] += step[axis];
            next[axis] += between[axis];
        }
    }

    /// The part of a segment over the grid.
    fn clip(&self, from: DVec2, to: DVec2) -> Option<(DVec2, DVec2)> {
        let high = self.origin_mm + self.cells.as_dvec2() * self.cell_mm;
        let direction = to - from;
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for i in 0..2 {
            if direction[i] == 0.0 {
                if from[i] < self.origin_mm[i] || from[i] > high[i] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((self.origin_mm[i] - from[i]) / direction[i], (high[i] - from[i]) / direction[i]);
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        }
        (first <= last).then(|| (from + direction * first, from + direction * last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::philox4x32;

    fn word(i: u32, draw: usize) -> f64 {
        f64::from(philox4x32([i, 0, 0, 0], [3, 0])[draw]) / 4_294_967_296.0
    }

    fn discs() -> Vec<(DVec2, f64)> {
        (0..400).map(|i| (DVec2::new(word(i, 0) * 300.0 - 150.0, word(i, 1) * 90.0), 0.1 + 4.0 * word(i, 2))).collect()
    }

    #[test]
    fn every_disc_that_a_segment_crosses_is_visited() {
        let discs = discs();
        let grid = DiscGrid::new(&discs);
        let mut crossed = 0;
        for i in 1000..1400 {
            let from = DVec2::new(word(i, 0) * 400.0 - 200.0, word(i, 1) * 120.0 - 10.0);
            let to = match i % 4 {
                0 => DVec2::new(from.x, from.y + 20.0),
                1 => DVec2::new(from.x - 30.0, from.y),
                2 => from + 12.0 * DVec2::new(word(i, 2) - 0.5, word(i, 3) - 0.5),
                _ => DVec2::new(word(i, 2) * 400.0 - 200.0, word(i, 3) * 120.0 - 10.0),
            };
            let mut visible = Vec::new();
            grid.along(from, to, |some| visible.extend_from_slice(some));
            for (disc, (at, radius)) in (0_u32..).zip(&discs) {
                let along = ((*at - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
                if at.distance(from + (to - from) * along) < *radius {
                    crossed += 1;
                    assert!(visible.contains(&disc), "segment {i}, disc {disc}");
                }
            }
        }
        assert!(crossed > 1000, "{crossed}");
    }

    #[test]
    fn every_disc_over_a_point_is_found() {
        let discs = discs();
        let grid = DiscGrid::new(&discs);
        for i in 2000..4000 {
            let point = DVec2::new(word(i, 0) * 320.0 - 160.0, word(i, 1) * 100.0 - 5.0);
            let over = (0_u32..).zip(&discs).filter(|(_, (at, radius))| at.distance(point) < *radius);
            over.for_each(|(disc, _)| assert!(grid.at(point).contains(&disc)));
        }
    }
}
