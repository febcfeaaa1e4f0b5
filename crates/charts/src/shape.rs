//! Plane geometry: outlines, sheets partitioned into pieces, lattices of cells with figures in them.
//!
//! All pieces are in one plane, and neighbours share their vertices: no depth offsets, no cracks, no textures at sharp edges.
//! Coordinates are mm, x to the right and y down; an outline's area is positive if it turns clockwise as seen.

use std::f64::consts::TAU;

use etendue_core::maths::f64::sin_cos;
use glam::DVec2;

/// The area between a convex outline and the next inner one (all of it for the innermost).
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// The outer outline, about the figure's centre.
    pub outline: Vec<DVec2>,
    /// One fill for the zone, or one for each edge of the outline (sectors).
    pub fills: Vec<Fill>,
}

/// Zones from the inside out, around a centre.
#[derive(Clone, Debug, PartialEq)]
pub struct ZoneFigure {
    /// The centre, inside of all zones.
    pub centre: DVec2,
    /// From the inside out. A zone with sectors follows the centre itself or a zone with as many corners at the same
    /// angles.
    pub zones: Vec<Zone>,
}

impl Zone {
    /// A zone of one fill.
    #[must_use]
    pub fn even(outline: Vec<DVec2>, ink: usize) -> Self {
        Self { outline, fills: vec![Fill::Ink(ink)] }
    }
}

impl ZoneFigure {
    /// A figure of one zone.
    #[must_use]
    pub fn one(centre: DVec2, outline: Vec<DVec2>, ink: usize) -> Self {
        Self { centre, zones: vec![Zone::even(outline, ink)] }
    }

    /// Returns its pieces, and those of the rest of `cell` around it.
    #[must_use]
    pub fn pieces(&self, cell: &[DVec2], ground: Fill) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let mut within: Option<&[DVec2]> = None;
        for zone in &self.zones {
            self.add_zone(within, &zone.outline, &zone.fills, &mut pieces);
            within = Some(&zone.outline);
        }
        self.add_zone(within, cell, &[ground], &mut pieces);
        pieces
    }

    fn add_zone(&self, within: Option<&[DVec2]>, outline: &[DVec2], fills: &[Fill], pieces: &mut Vec<Piece>) {
        match (within, fills) {
            (None, [fill]) => pieces.push(Piece { outline: outline.to_vec(), fill: *fill }),
            (Some(within), [fill]) => {
                let triangles = ring(self.centre, within, outline).into_iter();
                pieces.extend(triangles.map(|t| Piece { outline: t.to_vec(), fill: *fill }));
            }
            (within, fills) => pieces.extend(self.sectors(within, outline, fills)),
        }
    }

    fn sectors(&self, within: Option<&[DVec2]>, outline: &[DVec2], fills: &[Fill]) -> Vec<Piece> {
        assert_eq!(fills.len(), outline.len(), "one fill an edge");
        assert!(within.is_none_or(|w| w.len() == outline.len()), "sectors between outlines of as many corners");
        let next = |i: usize| (i + 1) % outline.len();
        let corners = |i: usize| match within {
            None => vec![self.centre, outline[i], outline[next(i)]],
            Some(within) => vec![within[i], outline[i], outline[next(i)], within[next(i)]],
        };
        fills.iter().enumerate().map(|(i, fill)| Piece { outline: corners(i), fill: *fill }).collect()
    }
}

/// Triangles that partition the area between a convex outline and another around it, with only both outlines' own corners. Both
/// turn the same way about `centre`, which is inside both.
///
/// The corners of both are visited in the order of their angle about the centre: each step joins an edge of one outline with a
/// corner of the other.
#[must_use]
pub fn ring(centre: DVec2, inner: &[DVec2], outer: &[DVec2]) -> Vec<[DVec2; 3]> {
    let start = nearest(centre, inner[0], outer);
    let (n, m) = (inner.len(), outer.len());
    let at = |i: usize, j: usize| (inner[i % n], outer[(start + j) % m]);
    let (mut i, mut j) = (0, 0);
    let mut triangles = Vec::with_capacity(n + m);
    while i < n || j < m {
        let (a, b) = at(i, j);
        let (next_a, next_b) = at(i + 1, j + 1);
        let inner_triangle = [next_a, a, b];
        let outer_triangle = [a, b, next_b];
        // The next corner in the order of angles, or the other one if that would fold the ring.
        let turn = (next_a - centre).perp_dot(next_b - centre);
        let inner_first = j == m || (i < n && turn > 0.0);
        if (inner_first && area(&inner_triangle) > 0.0) || j == m {
            triangles.push(inner_triangle);
            i += 1;
        } else {
            triangles.push(outer_triangle);
            j += 1;
        }
    }
    triangles
}

/// The outer corner whose direction from the centre is nearest to that of `corner`.
fn nearest(centre: DVec2, corner: DVec2, outer: &[DVec2]) -> usize {
    let towards = (corner - centre).normalize_or_zero();
    let along = |i: &usize| (outer[*i] - centre).normalize_or_zero().dot(towards);
    (0..outer.len()).max_by(|a, b| along(a).total_cmp(&along(b))).unwrap_or(0)
}

/// Fill of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// Printed with an ink, by its index in the drawing's list.
    Ink(usize),
    /// Open.
    Hole,
}

/// A convex piece of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Corners, mm, clockwise as seen.
    pub outline: Vec<DVec2>,
    pub fill: Fill,
}

/// A rectangle about the origin, partitioned.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Width and height, mm.
    pub size_mm: DVec2,
    pub pieces: Vec<Piece>,
}

impl Sheet {
    /// A sheet without pieces.
    #[must_use]
    pub fn new(size_mm: DVec2) -> Self {
        Self { size_mm, pieces: Vec::new() }
    }

    /// A sheet of one ink.
    #[must_use]
    pub fn plain(size_mm: DVec2, ink: usize) -> Self {
        let mut sheet = Self::new(size_mm);
        sheet.add(rectangle(-size_mm / 2.0, size_mm / 2.0), Fill::Ink(ink));
        sheet
    }

    /// Adds a piece.
    pub fn add(&mut self, outline: Vec<DVec2>, fill: Fill) {
        self.pieces.push(Piece { outline, fill });
    }
}

/// Area by the shoelace formula, mm²; positive for outlines that turn clockwise as seen (x right, y down).
#[must_use]
pub fn area(outline: &[DVec2]) -> f64 {
    edges(outline).map(|(a, b)| a.perp_dot(b)).sum::<f64>() / 2.0
}

/// Centroid of the area; the mean of the corners if the area is zero.
#[must_use]
pub fn centroid(outline: &[DVec2]) -> DVec2 {
    let first = outline.first().copied().unwrap_or_default();
    let weighed =
        edges(outline).map(|(a, b)| (a - first, b - first)).fold((DVec2::ZERO, 0.0), |(sum, weight), (a, b)| {
            let double_area = a.perp_dot(b);
            (sum + (a + b) * double_area, weight + double_area)
        });
    match weighed {
        (sum, weight) if weight != 0.0 => first + sum / (3.0 * weight),
        _ => outline.iter().sum::<DVec2>() / outline.len().max(1) as f64,
    }
}

/// Minimum and maximum coordinates.
#[must_use]
pub fn bounds(outline: &[DVec2]) -> (DVec2, DVec2) {
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    outline.iter().fold(none, |(low, high), point| (low.min(*point), high.max(*point)))
}

/// A rectangle by its top left and bottom right corners.
#[must_use]
pub fn rectangle(low: DVec2, high: DVec2) -> Vec<DVec2> {
    vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
}

/// A regular polygon of `corners` corners with the area of the disc of `radius`, the first corner at `start_rad` from +x towards
/// +y. Its outline departs from the circle by at most radius · (π/corners)²/3 on either side; its centroid is the disc's.
#[must_use]
pub fn disc(centre: DVec2, radius: f64, corners: usize, start_rad: f64) -> Vec<DVec2> {
    let step = TAU / corners as f64;
    let reach = radius * (step / sin_cos(step).0).sqrt();
    (0..corners).map(|i| centre + reach * direction(start_rad + step * i as f64)).collect()
}

/// An outline rotated about `centre` by `angle_rad`, clockwise as seen, and scaled.
#[must_use]
pub fn rotated(outline: &[DVec2], centre: DVec2, angle_rad: f64) -> Vec<DVec2> {
    let axis = direction(angle_rad);
    outline.iter().map(|point| centre + axis.rotate(*point - centre)).collect()
}

/// The unit vector at an angle from +x towards +y.
pub(crate) fn direction(angle_rad: f64) -> DVec2 {
    let (sin, cos) = sin_cos(angle_rad);
    DVec2::new(cos, sin)
}

/// Edges from corner to corner.
pub(crate) fn edges(outline: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = outline.iter().cycle().skip(1);
    outline.iter().copied().zip(next.copied())
}

/// Content of a lattice cell.
#[derive(Clone, Debug, PartialEq)]
pub enum CellContent {
    /// One fill.
    Plain(Fill),
    /// A figure on a ground.
    Figure(ZoneFigure, Fill),
}

/// The lines of a lattice; the first and the last are the sheet's borders.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    xs: Vec<f64>,
    ys: Vec<f64>,
}

impl Lattice {
    /// A lattice by its increasing lines, two or more in each direction, mm.
    #[must_use]
    pub fn new(xs: Vec<f64>, ys: Vec<f64>) -> Self {
        let rising = |v: &[f64]| v.len() > 1 && v.windows(2).all(|w| w[0] < w[1]);
        assert!(rising(&xs) && rising(&ys), "lines of a lattice rise: {xs:?} {ys:?}");
        Self { xs, ys }
    }

    /// `columns` × `rows` cells of `pitch` about the origin, numbered from 1, and a margin around them, numbered 0 and last, up to
    /// a sheet of `size` or 2 % larger than the cells.
    #[must_use]
    pub fn framed(columns: usize, rows: usize, pitch: DVec2, size: DVec2) -> Self {
        let lines = |count: usize, pitch: f64, size: f64| {
            let first = -pitch * count as f64 / 2.0;
            let edge = (size / 2.0).max(-first * 1.02);
            let inside = (0..=count).map(|i| first + pitch * i as f64);
            [-edge].into_iter().chain(inside).chain([edge]).collect()
        };
        Self::new(lines(columns, pitch.x, size.x), lines(rows, pitch.y, size.y))
    }

    /// True if a cell of a framed lattice is not part of its margin.
    #[must_use]
    pub fn is_inside(&self, column: usize, row: usize) -> bool {
        (1..self.columns() - 1).contains(&column) && (1..self.rows() - 1).contains(&row)
    }

    /// Columns of cells.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.xs.len() - 1
    }

    /// Rows of cells.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.ys.len() - 1
    }

    /// The corners of a cell.
    #[must_use]
    pub fn cell(&self, column: usize, row: usize) -> Vec<DVec2> {
        let low = DVec2::new(self.xs[column], self.ys[row]);
        rectangle(low, DVec2::new(self.xs[column + 1], self.ys[row + 1]))
    }

    /// The centre of a cell.
    #[must_use]
    pub fn middle(&self, column: usize, row: usize) -> DVec2 {
        let mean = |lines: &[f64], i: usize| (lines[i] + lines[i + 1]) / 2.0;
        DVec2::new(mean(&self.xs, column), mean(&self.ys, row))
    }

    /// The sheet, from the content of each cell (column, row).
    #[must_use]
    pub fn sheet(&self, mut cell_content: impl FnMut(usize, usize) -> CellContent) -> Sheet {
        let size = DVec2::new(self.xs[self.columns()] - self.xs[0], self.ys[self.rows()] - self.ys[0]);
        let mut sheet = Sheet::new(size);
        for row in 0..self.rows() {
            for column in 0..self.columns() {
                let outline = self.cell(column, row);
                match cell_content(column, row) {
                    CellContent::Plain(fill) => sheet.add(outline, fill),
                    CellContent::Figure(figure, ground) => sheet.pieces.extend(figure.pieces(&outline, ground)),
                }
            }
        }
        sheet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(centre: DVec2, inner: &[DVec2], outer: &[DVec2]) {
        let triangles = ring(centre, inner, outer);
        assert_eq!(triangles.len(), inner.len() + outer.len());
        assert!(triangles.iter().all(|t| area(t) > 0.0), "{inner:?} {outer:?}");
        let sum: f64 = triangles.iter().map(|t| area(t)).sum();
        // Triangles that all have the right orientation and add up cannot overlap.
        assert!((sum / (area(outer) - area(inner)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rings_are_partitioned() {
        let centre = DVec2::new(3.0, -2.0);
        let cell = rectangle(centre - DVec2::new(10.0, 8.0), centre + DVec2::new(10.0, 8.0));
        for corners in [3, 4, 5, 64, 128] {
            for start in [0.0, 0.1, 0.8, 2.0] {
                check(centre, &disc(centre, 4.0, corners, start), &cell);
                check(centre, &disc(centre, 2.0, corners, start), &disc(centre, 5.0, 37, 0.2));
            }
        }
        let square = rectangle(centre - 4.0, centre + 4.0);
        for degrees in [-43.0_f64, -5.0, 0.0, 2.0, 5.0, 20.0, 45.0] {
            check(centre, &rotated(&square, centre, degrees.to_radians()), &cell);
        }
    }

    #[test]
    fn areas_and_centroids_of_known_shapes() {
        let square = rectangle(DVec2::new(1.0, 2.0), DVec2::new(4.0, 4.0));
        assert_eq!((area(&square), centroid(&square)), (6.0, DVec2::new(2.5, 3.0)));
        let triangle = [DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::new(0.0, 3.0)];
        assert_eq!((area(&triangle), centroid(&triangle)), (4.5, DVec2::ONE));
    }

    #[test]
    fn a_disc_has_the_circle_s_area_and_hugs_it() {
        for corners in [8, 64, 128] {
            let centre = DVec2::new(100.0, -40.0);
            let polygon = disc(centre, 5.0, corners, 0.3);
            let exact = std::f64::consts::PI * 25.0;
            assert!((area(&polygon) / exact - 1.0).abs() < 1e-13, "{corners}");
            assert!((centroid(&polygon) - centre).length() < 1e-12);
            let half = std::f64::consts::PI / corners as f64;
            let bound = 5.0 * half * half / 3.0;
            let middles = edges(&polygon).map(|(a, b)| (a + b) / 2.0);
            let worst =
                polygon.iter().copied().chain(middles).map(|p| ((p - centre).length() - 5.0).abs()).fold(0.0, f64::max);
            // The next order of the series adds 2 % at eight corners.
            assert!(worst < 1.05 * bound, "{corners}: {worst} {bound}");
        }
    }
}
