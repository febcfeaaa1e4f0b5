//! Distortion and raster by resampling a stored radiance image.
//!
//! A pixel of the picture is cut into 2 × 2 cells; each cell's footprint in the stored image is taken as the upright
//! rectangle between the images of its edges' middles, and the cell's radiance is the mean over that rectangle of the
//! stored image, whose pixels count as uniform. Weights sum to one, so a uniform radiance stays uniform.
//!
//! Blur: the picture's own pixel box, widened by the stored pixel's box. Where both grids have one pitch this is exactly
//! linear interpolation of the stored pixels (the identity where the grids coincide: then nothing is blurred); where the
//! stored image is finer it tends to the exact pixel mean. The shear of the footprint within a cell is left out: at most
//! a quarter pixel times the off-diagonal of the distortion's derivative.

use super::irradiance::check_size;
use super::projection::PupilProjection;
use crate::error::OpticsError;
use crate::lens::Lens;
use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::Radiance;
use etendue_projection::Raster;
use glam::DVec2;

/// Cells a pixel along each axis.
const CELLS: usize = 2;

/// The map from a stored radiance image to the picture of a lens and a raster.
#[derive(Clone, Copy, Debug)]
pub struct Resampling<'a> {
    stored: PupilProjection,
    lens: &'a Lens,
    raster: &'a Raster,
}

/// A share of one stored pixel in a pixel of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tap {
    index: usize,
    weight: f64,
}

impl<'a> Resampling<'a> {
    /// A resampling of images of geometry `stored`.
    ///
    /// # Errors
    /// Where the picture needs directions that the image does not hold, or the lens cannot image the picture.
    pub fn new(stored: PupilProjection, lens: &'a Lens, raster: &'a Raster) -> Result<Self, OpticsError> {
        stored.check_covers(lens, raster)?;
        Ok(Self { stored, lens, raster })
    }

    /// The radiance image in the raster of the picture.
    ///
    /// # Errors
    /// Where the image's size is not that of its geometry.
    pub fn apply(&self, radiance: &SpectralCube<Radiance>) -> Result<SpectralCube<Radiance>, OpticsError> {
        check_size(radiance, self.stored.width(), self.stored.height())?;
        let mut result = SpectralCube::new(self.raster.width(), self.raster.height(), radiance.bands());
        let mut taps = Vec::new();
        for y in 0..self.raster.height() {
            for x in 0..self.raster.width() {
                taps.clear();
                self.pixel_taps(x, y, &mut taps);
                for (from, to) in radiance.planes().iter().zip(result.planes_mut()) {
                    to.set(x, y, weighted(from, &taps));
                }
            }
        }
        Ok(result)
    }

    fn pixel_taps(&self, x: usize, y: usize, taps: &mut Vec<Tap>) {
        let side = 1.0 / CELLS as f64;
        for cell in 0..CELLS * CELLS {
            let corner = DVec2::new((cell % CELLS) as f64, (cell / CELLS) as f64) * side;
            let [low, high] = self.footprint(DVec2::new(x as f64, y as f64) + corner, side);
            self.rectangle_taps(low, high, side * side, taps);
        }
    }

    /// Corners (px of the stored image) of the rectangle that a square of the picture covers.
    fn footprint(&self, corner: DVec2, side: f64) -> [DVec2; 2] {
        let middle = corner + 0.5 * side;
        let far = corner + side;
        let left = self.stored_px(DVec2::new(corner.x, middle.y)).x;
        let right = self.stored_px(DVec2::new(far.x, middle.y)).x;
        let top = self.stored_px(DVec2::new(middle.x, corner.y)).y;
        let bottom = self.stored_px(DVec2::new(middle.x, far.y)).y;
        [DVec2::new(left, top), DVec2::new(right, bottom)]
    }

    /// The stored image's coordinates at raster coordinates of the picture. All of the picture has an image, which
    /// [`Resampling::new`] made sure of; a NaN would show up as one in the picture.
    fn stored_px(&self, raster_px: DVec2) -> DVec2 {
        let tangent = self.lens.tangent(self.raster.sensor_mm(raster_px));
        tangent.map_or(DVec2::NAN, |t| self.stored.px_of_tangent(t))
    }

    /// Adds the stored pixels under a rectangle, their weights summing to `share`.
    fn rectangle_taps(&self, low: DVec2, high: DVec2, share: f64, taps: &mut Vec<Tap>) {
        let scale = share / ((high.x - low.x) * (high.y - low.y));
        for (j, tall) in overlaps(low.y, high.y, self.stored.height()) {
            for (i, wide) in overlaps(low.x, high.x, self.stored.width()) {
                taps.push(Tap { index: j * self.stored.width() + i, weight: wide * tall * scale });
            }
        }
    }
}

/// The pixels that the interval [low, high] touches, with the length in each. Pixels at the edge stand for what lies beyond
/// (rounding only: the picture lies inside).
fn overlaps(low: f64, high: f64, count: usize) -> impl Iterator<Item = (usize, f64)> {
    let last = count - 1;
    let index = move |p: f64| (p.floor().max(0.0) as usize).min(last);
    let (first, end) = (index(low), index(high));
    (first..=end).map(move |i| {
        let from = if i == first { low } else { i as f64 };
        let to = if i == end { high } else { (i + 1) as f64 };
        (i, to - from)
    })
}

fn weighted(plane: &Plane<Radiance>, taps: &[Tap]) -> f32 {
    let samples = plane.samples();
    taps.iter().map(|tap| f64::from(samples[tap.index]) * tap.weight).sum::<f64>() as f32
}
