//! The landing positions of the beam of one field angle, pair and wavelength: a grid of rays, interpolated.
//!
//! The grid is perpendicular to the beam and covers half of it (the other half is its mirror image). Positions, weights and fillings (above 1 a ray
//! is clipped) are bilinear within a cell, so edges are found more finely than the grid. A cell is dark if the ray of one of its corners misses a
//! surface or is totally reflected.

use etendue_core::maths::f64::sin_cos;
use glam::{DVec2, DVec3};

use crate::{prescription::Prescription, prescription::ghost::GhostPair, prescription::trace::LensRay};

/// Cells across the whole beam in the meridional plane, and across half of it.
const COLUMNS: usize = 32;
const ROWS: usize = 16;
/// The same for a first coarse pass, over the whole front.
const COARSE_COLUMNS: usize = 32;
const COARSE_ROWS: usize = 16;
/// Number of rays of either grid.
pub(super) const NODES: usize = (COLUMNS + 1) * (ROWS + 1);
pub(super) const COARSE_NODES: usize = (COARSE_COLUMNS + 1) * (COARSE_ROWS + 1);

/// Rays that land farther from the axis than this count as lost, mm.
const MAX_MM: f32 = 1e4;

/// The end of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    /// On the sensor, mm: away from the axis in the direction of the source's image, and across.
    x: f32,
    y: f32,
    /// Fraction of the light.
    weight: f32,
    /// Infinite for a lost ray.
    filling: f32,
    /// Cosine of the angle of incidence on the sensor.
    cosine: f32,
}

impl Node {
    const LOST: Self = Self { x: 0.0, y: 0.0, weight: 0.0, filling: f32::INFINITY, cosine: 0.0 };

    fn arrives(&self) -> bool {
        self.filling.is_finite()
    }

    fn mix(self, other: Self, fraction: f32) -> Self {
        match (self.arrives(), other.arrives()) {
            (true, true) => self.between(other, fraction),
            (true, false) => self,
            _ => other,
        }
    }

    #[inline]
    fn between(self, other: Self, fraction: f32) -> Self {
        let mix = |a: f32, b: f32| a + fraction * (b - a);
        Self {
            x: mix(self.x, other.x),
            y: mix(self.y, other.y),
            weight: mix(self.weight, other.weight),
            filling: mix(self.filling, other.filling),
            cosine: mix(self.cosine, other.cosine),
        }
    }
}

/// Collimated light at an angle to the axis.
pub(super) struct GhostBeam<'a> {
    lens: &'a Prescription,
    direction: DVec3,
    across: DVec3,
    angle: f64,
}

impl<'a> GhostBeam<'a> {
    pub(super) fn new(lens: &'a Prescription, angle: f64) -> Self {
        let (sine, cosine) = sin_cos(angle);
        Self { lens, direction: DVec3::new(sine, 0.0, cosine), across: DVec3::new(cosine, 0.0, -sine), angle }
    }

    /// Rays on the corners of a grid over a window across the beam.
    fn grid(&self, pair: GhostPair, nm: f64, window: [DVec2; 2], size: [usize; 2]) -> Vec<Node> {
        let media = self.lens.media(nm);
        let node = |i: usize| {
            let fraction =
                DVec2::new((i % (size[0] + 1)) as f64 / size[0] as f64, (i / (size[0] + 1)) as f64 / size[1] as f64);
            let at = window[0] + (window[1] - window[0]) * fraction;
            let ray = LensRay { point: self.across * at.x + DVec3::Y * at.y, direction: self.direction };
            let Ok(ghost) = self.lens.ghost_in(pair, ray, nm, &media) else { return Node::LOST };
            let d = ghost.ray.direction;
            let end = ghost.ray.point + d * ((self.lens.sensor_position_mm() - ghost.ray.point.z) / d.z);
            let x = end.x * self.lens.inversion();
            let (x, y, weight, filling) = (x as f32, end.y as f32, ghost.weight as f32, ghost.filling as f32);
            // Rays parallel to the sensor or away from it do not land.
            let lands = d.z > 0.0 && x.abs().max(y.abs()) < MAX_MM;
            if lands { Node { x, y, weight, filling, cosine: d.z as f32 } } else { Node::LOST }
        };
        (0..(size[0] + 1) * (size[1] + 1)).map(node).collect()
    }

    /// The window in which a pair passes rays, and the passed area times its weight, mm².
    pub(super) fn survey(&self, pair: GhostPair, nm: f64) -> Option<([DVec2; 2], f64)> {
        let size = [COARSE_COLUMNS, COARSE_ROWS];
        let [low, high] = self.lens.front_box(self.angle);
        let cell = (high - low) / DVec2::new(size[0] as f64, size[1] as f64);
        let nodes = self.grid(pair, nm, [low, high], size);
        let (mut minimum, mut maximum, mut weight) = (DVec2::INFINITY, DVec2::NEG_INFINITY, 0.0);
        for (i, node) in nodes.iter().enumerate().filter(|(_, node)| node.filling <= 1.0) {
            let place = DVec2::new((i % (size[0] + 1)) as f64, (i / (size[0] + 1)) as f64);
            (minimum, maximum) = (minimum.min(place), maximum.max(place));
            // The row in the plane of symmetry belongs to both halves.
            weight += f64::from(node.weight) * if place.y == 0.0 { 1.0 } else { 2.0 };
        }
        let window = [minimum - 1.0, maximum + 1.0].map(|place| low + cell * place);
        let window = [DVec2::new(window[0].x, 0.0), window[1]];
        (weight > 0.0).then_some((window, weight * cell.x * cell.y))
    }

    /// The footprint of a pair's light that enters through a window.
    pub(super) fn footprint(&self, pair: GhostPair, nm: f64, window: [DVec2; 2]) -> Footprint {
        let area = window[1] - window[0];
        let cell_mm2 = area.x * area.y / (COLUMNS * ROWS) as f64;
        Footprint { nodes: self.grid(pair, nm, window, [COLUMNS, ROWS]), cell_mm2: cell_mm2 as f32 }
    }
}

/// A grid of rays' ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Footprint {
    nodes: Vec<Node>,
    /// Cross-section of the beam per cell, mm².
    cell_mm2: f32,
}

/// Light that lands at a point, mm: the cross-section of its part of the beam times the remaining fractions, mm².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LandedLight {
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) area_mm2: f32,
    pub(super) cosine: f32,
}

impl Footprint {
    /// Interpolates between two angles.
    pub(super) fn mix(&self, other: &Self, fraction: f32) -> Self {
        let nodes = self.nodes.iter().zip(&other.nodes).map(|(a, b)| a.mix(*b, fraction)).collect();
        Self { nodes, cell_mm2: self.cell_mm2 + fraction * (other.cell_mm2 - self.cell_mm2) }
    }

    /// The same position with a fraction of the light.
    pub(super) fn dimmed(&self, fraction: f32) -> Self {
        Self { nodes: self.nodes.clone(), cell_mm2: self.cell_mm2 * fraction }
    }

    fn cells(&self) -> impl Iterator<Item = [Node; 4]> {
        let node = |column: usize, row: usize| self.nodes[row * (COLUMNS + 1) + column];
        let corners = move |i: usize| {
            let (column, row) = (i % COLUMNS, i / COLUMNS);
            [node(column, row), node(column + 1, row), node(column, row + 1), node(column + 1, row + 1)]
        };
        let lit = |cell: &[Node; 4]| cell.iter().all(Node::arrives) && cell.iter().any(|n| n.filling < 1.0);
        (0..COLUMNS * ROWS).map(corners).filter(lit)
    }

    /// The smallest box about the light, mm; `None` if there is none.
    pub(super) fn bounds(&self) -> Option<[[f32; 2]; 2]> {
        let mut bounds = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];
        for node in self.cells().flatten() {
            bounds[0] = [bounds[0][0].min(node.x), bounds[0][1].min(-node.y.abs())];
            bounds[1] = [bounds[1][0].max(node.x), bounds[1][1].max(node.y.abs())];
        }
        bounds[0][0].is_finite().then_some(bounds)
    }

    /// Calls `lands` for points closer to each other than `step_mm` that together carry all light.
    #[inline]
    pub(super) fn each(&self, step_mm: f32, mut lands: impl FnMut(LandedLight)) {
        for cell in self.cells() {
            let finer = finer(&cell, step_mm);
            let fraction = self.cell_mm2 / (finer * finer) as f32;
            let at = |i: usize| (i as f32 + 0.5) / finer as f32;
            for row in 0..finer {
                let [left, right] = [cell[0].between(cell[2], at(row)), cell[1].between(cell[3], at(row))];
                for node in (0..finer).map(|column| left.between(right, at(column))).filter(|n| n.filling <= 1.0) {
                    let landed =
                        LandedLight { x: node.x, y: node.y, area_mm2: fraction * node.weight, cosine: node.cosine };
                    lands(landed);
                    lands(LandedLight { y: -node.y, ..landed });
                }
            }
        }
    }
}

/// Minimum and maximum number of points along a cell's side; more than the minimum only for density.
const MIN_CELL_POINTS: usize = 3;
const MAX_CELL_POINTS: usize = 256;

fn finer(cell: &[Node; 4], step_mm: f32) -> usize {
    let side = |a: Node, b: Node| (a.x - b.x).abs().max((a.y - b.y).abs());
    let [a, b, c, d] = *cell;
    let longest = side(a, b).max(side(c, d)).max(side(a, c)).max(side(b, d));
    ((longest / step_mm).ceil() as usize).clamp(MIN_CELL_POINTS, MAX_CELL_POINTS)
}
