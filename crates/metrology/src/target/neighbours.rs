//! Points by place.

use glam::DVec2;

/// Points sorted into square cells.
#[derive(Debug)]
pub(super) struct Neighbours<'a> {
    points: &'a [DVec2],
    low: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<Vec<usize>>,
}

impl<'a> Neighbours<'a> {
    /// Cells of about two points each.
    pub(super) fn of(points: &'a [DVec2]) -> Self {
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

    /// Points within `radius` of a place, nearest first.
    pub(super) fn within(&self, place: DVec2, radius: f64) -> Vec<usize> {
        let span = |c: f64, count: usize| {
            let cell = |c: f64| (c / self.cell).floor().clamp(0.0, count as f64 - 1.0) as usize;
            cell(c - radius)..=cell(c + radius)
        };
        let from = place - self.low;
        let mut found: Vec<(f64, usize)> = Vec::new();
        for y in span(from.y, self.rows) {
            for x in span(from.x, self.columns) {
                let cell = self.cells[y * self.columns + x].iter();
                found.extend(cell.map(|i| ((self.points[*i] - place).length(), *i)).filter(|(d, _)| *d <= radius));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.into_iter().map(|(_, i)| i).collect()
    }

    /// The `count` points nearest to a point, without itself, nearest first.
    pub(super) fn nearest(&self, point: usize, count: usize) -> Vec<usize> {
        let mut radius = self.cell;
        let all = self.cell * (self.columns + self.rows) as f64;
        loop {
            let mut found = self.within(self.points[point], radius);
            found.retain(|i| *i != point);
            if found.len() >= count || radius > all {
                found.truncate(count);
                return found;
            }
            radius *= 2.0;
        }
    }
}
