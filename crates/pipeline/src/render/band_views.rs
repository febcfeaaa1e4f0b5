//! Views of bands: in another quantity, or without a margin.

use etendue_core::Plane;
use etendue_core::quantity::SolidAngle;
use etendue_core::storage::BandReader;
use std::ops::Range;
use std::sync::Arc;

/// Bands divided by the pupil's weight: radiance from irradiance; 0 where no light passes the lens.
#[derive(Debug)]
pub(crate) struct BandsOverWeight {
    /// The bands, of the size of the weight.
    pub(crate) bands: Arc<dyn BandReader>,
    /// Mean weight of the pupil.
    pub(crate) weight: Arc<Plane<SolidAngle>>,
    /// Divisor as a function of the weight.
    pub(crate) divisor: fn(f32) -> f32,
}

impl BandReader for BandsOverWeight {
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        self.bands.read(band, rows.clone(), samples)?;
        let width = self.weight.width();
        let weights = &self.weight.samples()[rows.start * width..rows.end * width];
        samples.iter_mut().zip(weights).for_each(|(value, weight)| *value = divide(*value, *weight, self.divisor));
        Ok(())
    }
}

/// Returns a value divided by a function of the weight; 0 if no light passes the lens. A quotient beyond the range of 32 bits, as with a weight whose square
/// underflows, is the greatest finite number.
pub(crate) fn divide(value: f32, weight: f32, divisor: fn(f32) -> f32) -> f32 {
    if weight <= 0.0 || value == 0.0 {
        return 0.0;
    }
    let quotient = value / divisor(weight);
    if quotient == f32::INFINITY && value.is_finite() { f32::MAX } else { quotient }
}

/// A part of larger bands.
#[derive(Debug)]
pub(crate) struct CroppedBands {
    /// The larger bands.
    pub(crate) bands: Arc<dyn BandReader>,
    /// Their columns.
    pub(crate) full_width: usize,
    /// First column and row of the part.
    pub(crate) first: [usize; 2],
    /// Columns of the part.
    pub(crate) width: usize,
}

impl BandReader for CroppedBands {
    fn read(&self, band: usize, rows: Range<usize>, samples: &mut [f32]) -> Result<(), String> {
        let [x, y] = self.first;
        let mut rows_of_all = vec![0.0; self.full_width * rows.len()];
        self.bands.read(band, rows.start + y..rows.end + y, &mut rows_of_all)?;
        for (to, from) in samples.chunks_exact_mut(self.width).zip(rows_of_all.chunks_exact(self.full_width)) {
            to.copy_from_slice(&from[x..x + self.width]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::divide;

    /// A pupil of f/10²⁰, and light of 10³⁰: the variance of their radiance exceeds the range of 32 bits.
    #[test]
    fn no_variance_of_a_narrow_pupil_is_infinite() {
        let square = |weight: f32| weight * weight;
        assert_eq!(divide(1e-30, 1e-25, square), f32::MAX);
        assert_eq!(divide(1e30, 1e-5, square), f32::MAX);
        assert_eq!((divide(0.0, 1e-25, square), divide(1.0, 0.0, square)), (0.0, 0.0));
        assert!(divide(f32::NAN, 1e-5, square).is_nan(), "unknown stays NaN");
        assert_eq!(divide(3.0, 2.0, square), 0.75);
    }
}
