//! Defocus by the circles of confusion of the real pupil.
//!
//! 1. `footprint.rs`: the outline of the pupil for a scene point, by field point and distance, traced through the lens. It is inverted between the
//!    front and the back of the plane in focus.
//! 2. `hidden.rs`: surfaces behind the edges of near objects are estimated from their visible neighbours.
//! 3. `layers.rs`: pixels and estimates, sorted by distance.
//! 4. `scan.rs`, `strip.rs`: each spreads its light over its outline; the layers are composited from the nearest on, with their coverage of each
//!    pixel's pupil. A blurred near object lets the background through; a sharp one receives no light from the blur behind it.
//!
//! Weights are computed once for all bands. The cost is a pixel's outline (48 vertices) and, for each row that it spreads over, a few steps per band.
//!
//! Left out: regions hidden from the pupil's centre by a whole surface but visible from its edge (they are estimated), reflections and glass (they
//! are blurred with the surface that shows them), and the part of the pupil that an object in front of two others covers (it covers a uniform
//! fraction of both).

use core::ops::Range;

use etendue_core::{plane::SpectralCube, quantity::Radiance};
use glam::DVec2;

use super::scan::{CoverageStep, Scan, Window};
use super::strip::{Layer, Layers, Strip};
use super::{PinholeView, footprint::Footprints, hidden::HiddenSurface};

/// Rows per strip.
const ROWS: usize = 32;

/// The steps of a pixel that keeps its light.
const UNSPREAD_STEPS: [CoverageStep; 2] =
    [CoverageStep { column: 0, fraction: 1.0 }, CoverageStep { column: 1, fraction: -1.0 }];

/// A view with known footprints and layers: rows of its image can be computed on any number of threads.
#[derive(Clone, Debug)]
pub struct PhysicalDefocus<'a> {
    view: PinholeView<'a>,
    /// `None` if everything is sharp.
    blurs: Option<(Footprints, Layers)>,
}

impl<'a> PhysicalDefocus<'a> {
    /// Traces the pupil of a view and sorts its pixels.
    #[must_use]
    pub fn new(view: PinholeView<'a>) -> Self {
        let range = inverse_range_per_m(&view);
        let blurs = range.and_then(|range| {
            let footprints = Footprints::new(&view, range)?;
            let layers = Layers::new(&view, &footprints, range);
            Some((footprints, layers))
        });
        Self { view, blurs }
    }

    /// The preferred ranges of rows for computing the image, one after the other.
    pub fn strips(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let height = self.view.raster.height();
        (0..height).step_by(ROWS).map(move |first| first..(first + ROWS).min(height))
    }

    /// Some rows of the image, as a cube of that number of rows.
    #[must_use]
    pub fn rows(&self, rows: Range<usize>) -> SpectralCube<Radiance> {
        let (width, bands) = (self.view.raster.width(), self.view.radiance.bands());
        let mut cube = SpectralCube::new(width, rows.len(), bands);
        let mut strip = self.blurs.as_ref().map(|(footprints, layers)| self.strip(footprints, layers, rows.clone()));
        for y in rows.clone() {
            for x in 0..width {
                let pixel = (y + self.view.margin_px) * self.view.width() + x + self.view.margin_px;
                let light = strip.as_mut().and_then(|strip| strip.light(x, y));
                let Some(light) = light else {
                    let stored = self.view.radiance.planes().iter().map(|plane| plane.samples()[pixel]);
                    cube.planes_mut().iter_mut().zip(stored).for_each(|(to, light)| to.set(x, y - rows.start, light));
                    continue;
                };
                for (to, light) in cube.planes_mut().iter_mut().zip(light) {
                    to.set(x, y - rows.start, light as f32);
                }
            }
        }
        cube
    }

    /// The image, on the caller's thread.
    #[must_use]
    pub fn image(&self) -> SpectralCube<Radiance> {
        let strips: Vec<_> = self.strips().map(|rows| self.rows(rows)).collect();
        self.join(&strips)
    }

    /// The image assembled from the cubes of all strips, in their order.
    #[must_use]
    pub fn join(&self, strips: &[SpectralCube<Radiance>]) -> SpectralCube<Radiance> {
        let (width, height) = (self.view.raster.width(), self.view.raster.height());
        let mut image = SpectralCube::new(width, height, self.view.radiance.bands());
        for (band, to) in image.planes_mut().iter_mut().enumerate() {
            let from = strips.iter().flat_map(|strip| strip.planes()[band].samples());
            to.samples_mut().iter_mut().zip(from).for_each(|(to, from)| *to = *from);
        }
        image
    }

    fn strip(&self, footprints: &Footprints, layers: &Layers, rows: Range<usize>) -> Strip {
        let mut strip = Strip::new(rows.clone(), self.view.raster.width(), self.view.radiance.bands().count());
        let mut splat = StripSplatter { view: &self.view, footprints, fills: &layers.fills, scan: Scan::default() };
        let mut light = vec![0.0; self.view.radiance.bands().count() + 1];
        for (number, layer) in layers.layers.iter().enumerate() {
            splat.layer(layer, &rows, &mut light, &mut strip);
            strip.composite_layer(number);
        }
        strip
    }
}

/// The smallest and the largest inverse distance of a view, 1/m; `None` if no pixel has a ray.
fn inverse_range_per_m(view: &PinholeView<'_>) -> Option<[f64; 2]> {
    let all = (0..view.width() * view.height()).filter_map(|pixel| view.inverse_per_m(pixel));
    let range = all.fold([f32::INFINITY, 0.0], |[far, near], w| [far.min(w), near.max(w)]);
    (range[0] <= range[1]).then(|| range.map(f64::from))
}

/// Spreads sources over strips.
struct StripSplatter<'a> {
    view: &'a PinholeView<'a>,
    footprints: &'a Footprints,
    fills: &'a [HiddenSurface],
    scan: Scan,
}

impl StripSplatter<'_> {
    /// Spreads the sources of a layer that reach some rows of the image.
    fn layer(&mut self, layer: &Layer, rows: &Range<usize>, light: &mut [f64], strip: &mut Strip) {
        let (margin, width) = (self.view.margin_px, self.view.width());
        let reach = layer.reach_px.ceil() as usize + 1;
        let first = (rows.start + margin).saturating_sub(reach);
        let end = (rows.end + margin + reach).min(self.view.height());
        for source in layer.rows(first, end, width) {
            let place = [source.pixel as usize % width, source.pixel as usize / width];
            let [column, row] = place.map(|p| p as i64 - margin as i64);
            self.light(source.pixel as usize, source.fill, light);
            let inverse = f64::from(source.inverse_per_m);
            if self.footprints.within_pixel(inverse) {
                strip.add(row, column, &UNSPREAD_STEPS, light);
                continue;
            }
            let px = DVec2::new(place[0] as f64, place[1] as f64) + 0.5;
            let polygon = self.footprints.outline_at(px, inverse);
            let window = Window {
                columns: -column..self.view.raster.width() as i64 - column,
                rows: rows.start as i64 - row..rows.end as i64 - row,
            };
            self.scan.spread(&polygon, &window, |down, steps| strip.add(row + down, column, steps, light));
        }
    }

    /// The light of a source: 1, then its radiance in each band.
    fn light(&self, pixel: usize, fill: Option<u32>, light: &mut [f64]) {
        light[0] = 1.0;
        let planes = self.view.radiance.planes().iter().zip(&mut light[1..]);
        match fill {
            None => planes.for_each(|(plane, to)| *to = f64::from(plane.samples()[pixel])),
            Some(i) => {
                let taps = self.fills[i as usize].taps;
                let used = move || taps.into_iter().filter(|(_, fraction)| *fraction > 0.0);
                let mean = |samples: &[f32]| {
                    used().map(|(from, fraction)| f64::from(samples[from as usize]) * f64::from(fraction)).sum()
                };
                planes.for_each(|(plane, to)| *to = mean(plane.samples()));
            }
        }
    }
}
