//! Splats a beam's light onto the sensor, at a resolution that suits its size.
//!
//! Level l has square cells of 2^l pixels. Light is splatted with tents as wide as a cell on both sides of its point, which preserves its sum. Points
//! are at most 0.35 cells apart, so the ripple is at most a few per cent. One row of cells around the image is kept too, so that levels can be
//! interpolated up to its edges.

use etendue_projection::Raster;
use glam::DVec2;

use super::{footprint::Footprint, source::SPLIT_FRACTION};

/// Cells across a ghost of a source with [`SPLIT_FRACTION`] of the light, and the maximum.
const CELLS: f64 = 32.0;
const MAX_CELLS: f64 = 192.0;
/// Distance of points, cells.
const STEP: f32 = 0.35;
/// Minimum cells across the shorter side of the image at the coarsest level.
const MIN_COARSE_CELLS: usize = 12;

/// The cells of one level about an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    level: u32,
    /// Cells, with the margin.
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// A cell's area on the sensor, mm².
    area_mm2: f64,
    principal: DVec2,
    cell_mm: DVec2,
}

impl Level {
    pub(super) fn new(raster: &Raster, level: u32) -> Self {
        let side = f64::from(1_u32 << level);
        let cell_mm = raster.pitch_mm() * side;
        let cells = |pixels: usize| pixels.div_ceil(1 << level) + 2;
        Self {
            level,
            columns: cells(raster.width()),
            rows: cells(raster.height()),
            area_mm2: cell_mm.x * cell_mm.y,
            principal: raster.principal_px() / side,
            cell_mm,
        }
    }

    /// All levels of an image, finest first.
    pub(super) fn all(raster: &Raster) -> Vec<Self> {
        let shorter = raster.width().min(raster.height());
        (0..24).take_while(|l| *l == 0 || shorter >> l >= MIN_COARSE_CELLS).map(|l| Self::new(raster, l)).collect()
    }

    /// The cell whose centre lies at or before that of a pixel's column or row, and the fraction towards the next.
    pub(super) fn pixel(&self, pixel: usize) -> (usize, f32) {
        let place = (pixel as f64 + 0.5) / f64::from(1_u32 << self.level) + 0.5;
        (place as usize, (place - place.floor()) as f32)
    }

    /// Coordinates in cells (the centre of cell i at i) of a point of the image, mm.
    fn place(&self, mm: DVec2) -> DVec2 {
        // The margin adds a cell, the centre subtracts half of one.
        self.principal + mm / self.cell_mm + 0.5
    }
}

/// Light on a window of a level: area of the beam over area of the cell, by wavelength.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SplattedLight {
    pub(super) level: usize,
    /// First column and row of the window.
    pub(super) from: [usize; 2],
    /// Columns of the window.
    pub(super) columns: usize,
    /// By wavelength, row by row.
    pub(super) light: Vec<Vec<f32>>,
    /// Mean cosine of the angle of incidence on the sensor.
    pub(super) cosine: f64,
}

/// Splats the footprints (by wavelength) of a source in the direction `outward` from the axis with a fraction of all light; `None` if nothing falls
/// on the image.
pub(super) fn splat_footprints(
    footprints: &[Footprint],
    outward: DVec2,
    fraction: f64,
    levels: &[Level],
) -> Option<SplattedLight> {
    let bounds = bounds(footprints)?;
    let level = level(bounds, fraction, levels);
    let at = &levels[level];
    let mut window = SplatWindow::new(bounds, outward, at)?;
    let (mut cosines, mut area) = (0.0, 0.0);
    let light = footprints.iter().map(|footprint| {
        let step_mm = STEP * at.cell_mm.min_element() as f32;
        footprint.each(step_mm, |landed| {
            window.add(landed.x, landed.y, landed.area_mm2);
            cosines += f64::from(landed.area_mm2 * landed.cosine);
            area += f64::from(landed.area_mm2);
        });
        window.take()
    });
    let light: Vec<Vec<f32>> = light.collect();
    let lit = light.iter().flatten().any(|value| *value > 0.0);
    lit.then(|| SplattedLight { level, from: window.from, columns: window.size[0], light, cosine: cosines / area })
}

/// A box about all footprints, mm.
fn bounds(footprints: &[Footprint]) -> Option<[DVec2; 2]> {
    let boxes = footprints.iter().filter_map(Footprint::bounds);
    let vector = |[x, y]: [f32; 2]| DVec2::new(f64::from(x), f64::from(y));
    boxes.map(|b| b.map(vector)).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// The coarsest level with enough cells across a ghost for the fraction of its source.
fn level(bounds: [DVec2; 2], fraction: f64, levels: &[Level]) -> usize {
    let cells = (CELLS * (fraction / SPLIT_FRACTION).max(1.0).sqrt()).min(MAX_CELLS);
    let cell_mm = (bounds[1] - bounds[0]).max_element() / cells;
    levels.iter().rposition(|level| level.cell_mm.max_element() <= cell_mm).unwrap_or(0)
}

/// Part of a level.
struct SplatWindow {
    from: [usize; 2],
    size: [usize; 2],
    light: Vec<f32>,
    per_mm2: f32,
    /// From the beam's own axes to cells of the window.
    origin: [f32; 2],
    x_axis: [f32; 2],
    y_axis: [f32; 2],
}

impl SplatWindow {
    fn new([low, high]: [DVec2; 2], outward: DVec2, level: &Level) -> Option<Self> {
        let turned = |x: f64, y: f64| level.place(outward * x + outward.perp() * y);
        let corners = [turned(low.x, low.y), turned(low.x, high.y), turned(high.x, low.y), turned(high.x, high.y)];
        let minimum = corners.into_iter().reduce(DVec2::min)?.floor().max(DVec2::ZERO);
        let all = DVec2::new(level.columns as f64, level.rows as f64);
        let maximum = (corners.into_iter().reduce(DVec2::max)?.floor() + 2.0).min(all);
        let size = maximum - minimum;
        if !(size.x > 0.0 && size.y > 0.0) {
            return None;
        }
        let (from, size) = ([minimum.x as usize, minimum.y as usize], [size.x as usize, size.y as usize]);
        let single = |v: DVec2| [v.x as f32, v.y as f32];
        Some(Self {
            from,
            size,
            light: vec![0.0; size[0] * size[1]],
            per_mm2: (1.0 / level.area_mm2) as f32,
            origin: single(level.place(DVec2::ZERO) - minimum),
            x_axis: single(outward / level.cell_mm),
            y_axis: single(outward.perp() / level.cell_mm),
        })
    }

    /// Adds light that lands at a point of the beam's own axes, mm.
    #[inline]
    fn add(&mut self, x: f32, y: f32, area_mm2: f32) {
        let column = self.origin[0] + x * self.x_axis[0] + y * self.y_axis[0];
        let row = self.origin[1] + x * self.x_axis[1] + y * self.y_axis[1];
        let [columns, rows] = self.size;
        // Light outside the window also falls outside the image's margin.
        if !(column >= 0.0 && row >= 0.0 && column < (columns as f32) - 1.0 && row < (rows as f32) - 1.0) {
            return;
        }
        let (i, j) = (column as usize, row as usize);
        let (u, v) = (column - i as f32, row - j as f32);
        let light = area_mm2 * self.per_mm2;
        let at = j * columns + i;
        self.light[at] += light * (1.0 - u) * (1.0 - v);
        self.light[at + 1] += light * u * (1.0 - v);
        self.light[at + columns] += light * (1.0 - u) * v;
        self.light[at + columns + 1] += light * u * v;
    }

    fn take(&mut self) -> Vec<f32> {
        let empty = vec![0.0; self.light.len()];
        core::mem::replace(&mut self.light, empty)
    }
}
