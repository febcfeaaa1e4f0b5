//! A few rows of the image while layers are composited, the nearest first.
//!
//! Each pixel holds three sums of a coverage and of light times coverage: of the current layer (as differences along the row), of the current
//! surface, and of everything in front of it. Within a surface (layers that follow each other without a gap) coverages add, because its parts cover
//! different parts of the pupil, up to one; any excess is hidden. Between surfaces they multiply: the part of the pupil left by those in front counts
//! as uniform. At the end light is divided by coverage.
//!
//! Pixels as sources of light, sorted into layers by distance, the nearest first.
//!
//! Layers are equally thick in inverse distance, in which rays through the pupil are straight lines of the image: over the thickness of a layer the
//! blur grows by a pixel. Each source keeps its own distance; layers give the order.

use core::ops::Range;

use super::hidden::{HiddenSurface, fills};
use super::{PinholeView, footprint::Footprints, scan::CoverageStep};

/// Coverage below this is rounding.
const MIN_COVERAGE: f64 = 1e-9;
/// Empty layers that separate two surfaces.
const EMPTY_LAYERS: usize = 2;

/// Rows of the image.
#[derive(Debug)]
pub(super) struct Strip {
    rows: Range<usize>,
    width: usize,
    /// Values per pixel: coverage, then light of each band.
    depth: usize,
    layer: Vec<f64>,
    surface: Vec<f64>,
    front: Vec<f64>,
    /// Fraction of the pupil left by the surfaces in front.
    left: Vec<f64>,
    /// The layer that last touched the current surface.
    last: Vec<usize>,
    /// Columns of each row touched by the current layer: the first, and one beyond the last.
    changed: Vec<[usize; 2]>,
    running: Vec<f64>,
}

const UNTOUCHED: [usize; 2] = [usize::MAX, 0];

impl Strip {
    pub(super) fn new(rows: Range<usize>, width: usize, bands: usize) -> Self {
        let (pixels, depth) = (rows.len() * width, bands + 1);
        let empty = || vec![0.0; pixels * depth];
        Self {
            width,
            depth,
            layer: empty(),
            surface: empty(),
            front: empty(),
            left: vec![1.0; pixels],
            last: vec![0; pixels],
            changed: vec![UNTOUCHED; rows.len()],
            running: vec![0.0; depth],
            rows,
        }
    }

    /// Adds a source's steps in a row: `light` holds 1 and the radiance of each band, `column` is the source's.
    pub(super) fn add(&mut self, row: i64, column: i64, steps: &[CoverageStep], light: &[f64]) {
        let Some(row) = usize::try_from(row).ok().filter(|row| self.rows.contains(row)) else { return };
        let row = row - self.rows.start;
        for step in steps {
            let x = (column + step.column).max(0) as usize;
            if x < self.width {
                let at = (row * self.width + x) * self.depth;
                for (sum, light) in self.layer[at..at + self.depth].iter_mut().zip(light) {
                    *sum += step.fraction * light;
                }
            }
            let [first, end] = &mut self.changed[row];
            (*first, *end) = ((*first).min(x), (*end).max(x.min(self.width)));
        }
    }

    /// Composites the current layer behind the existing ones.
    pub(super) fn composite_layer(&mut self, number: usize) {
        for row in 0..self.rows.len() {
            let [first, end] = core::mem::replace(&mut self.changed[row], UNTOUCHED);
            if first < self.width {
                self.composite_row(row, first..(end + 1).min(self.width), number);
            }
        }
    }

    fn composite_row(&mut self, row: usize, columns: Range<usize>, number: usize) {
        self.running.fill(0.0);
        for x in columns {
            let pixel = row * self.width + x;
            let at = pixel * self.depth;
            for (sum, step) in self.running.iter_mut().zip(&mut self.layer[at..at + self.depth]) {
                *sum += core::mem::take(step);
            }
            if self.running[0] > MIN_COVERAGE && self.left[pixel] > MIN_COVERAGE {
                self.composite_pixel(pixel, number);
            }
        }
    }

    fn composite_pixel(&mut self, pixel: usize, number: usize) {
        if number > self.last[pixel] + EMPTY_LAYERS {
            self.close_surface(pixel);
        }
        self.last[pixel] = number;
        let surface = &mut self.surface[pixel * self.depth..(pixel + 1) * self.depth];
        let room = (1.0 - surface[0]).max(0.0);
        let fraction = (room / self.running[0]).min(1.0);
        for (sum, light) in surface.iter_mut().zip(&self.running) {
            *sum += fraction * light;
        }
    }

    /// Composites the current surface behind those in front.
    fn close_surface(&mut self, pixel: usize) {
        let range = pixel * self.depth..(pixel + 1) * self.depth;
        let left = self.left[pixel];
        self.left[pixel] = left * (1.0 - self.surface[range.start]).max(0.0);
        for (sum, light) in self.front[range.clone()].iter_mut().zip(&mut self.surface[range]) {
            *sum += left * core::mem::take(light);
        }
    }

    /// The light of a pixel, a value per band; `None` if it received none.
    pub(super) fn light(&mut self, x: usize, y: usize) -> Option<impl Iterator<Item = f64>> {
        let pixel = (y - self.rows.start) * self.width + x;
        self.close_surface(pixel);
        let sums = &self.front[pixel * self.depth..(pixel + 1) * self.depth];
        let coverage = sums[0];
        (coverage > MIN_COVERAGE).then(|| sums[1..].iter().map(move |light| light / coverage))
    }
}

/// Maximum number of layers; layers become thicker where more would be needed.
const MAX_LAYERS: f64 = 1024.0;

/// A source of light in the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StripSource {
    /// The pixel of the view in which it is seen.
    pub(super) pixel: u32,
    pub(super) inverse_per_m: f32,
    /// Index of its light in the list of fills; `None`: its pixel's own light.
    pub(super) fill: Option<u32>,
}

/// Sources of one layer, by increasing pixels.
#[derive(Clone, Debug, Default)]
pub(super) struct Layer {
    pub(super) sources: Vec<StripSource>,
    /// Maximum reach of the layer's light, px.
    pub(super) reach_px: f64,
}

/// All sources of a view.
#[derive(Clone, Debug)]
pub(super) struct Layers {
    /// Layers, the nearest first.
    pub(super) layers: Vec<Layer>,
    pub(super) fills: Vec<HiddenSurface>,
}

impl Layers {
    pub(super) fn new(view: &PinholeView<'_>, footprints: &Footprints, inverse_range_per_m: [f64; 2]) -> Self {
        let [far, near] = inverse_range_per_m;
        let count = ((near - far) * footprints.spread_px()).floor().min(MAX_LAYERS - 1.0) + 1.0;
        let per_layer = (near - far) / count;
        let mut layers = vec![Layer::default(); count as usize];
        let place = |inverse: f32| {
            if per_layer == 0.0 {
                0
            } else {
                (((near - f64::from(inverse)) / per_layer) as usize).min(count as usize - 1)
            }
        };
        let visible = (0..view.width() * view.height())
            .filter_map(|i| Some(StripSource { pixel: i as u32, inverse_per_m: view.inverse_per_m(i)?, fill: None }));
        let fills = fills(view, footprints);
        let hidden = fills.iter().enumerate().map(|(i, fill)| StripSource {
            pixel: fill.pixel,
            inverse_per_m: fill.inverse_per_m,
            fill: Some(i as u32),
        });
        for source in visible.chain(hidden) {
            let layer = &mut layers[place(source.inverse_per_m)];
            layer.reach_px = layer.reach_px.max(footprints.reach_px(f64::from(source.inverse_per_m)));
            layer.sources.push(source);
        }
        for layer in &mut layers {
            layer.sources.sort_by_key(|source| source.pixel);
        }
        Self { layers, fills }
    }
}

impl Layer {
    /// The sources in rows `first` to before `end`, of `width` pixels each.
    pub(super) fn rows(&self, first: usize, end: usize, width: usize) -> &[StripSource] {
        let before = |row: usize| self.sources.partition_point(|s| (s.pixel as usize) < row * width);
        &self.sources[before(first)..before(end)]
    }
}
