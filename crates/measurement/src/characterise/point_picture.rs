//! The point-spread image that a camera file names: a Gaussian with the variances measured from edges.

use etendue_core::maths::f64::exp;
use etendue_io::{failure::Error, png::encode_grey16};
use etendue_metrology::sfr::Blur;

use super::spread::{Spread, is_significant};

const SAMPLES_PER_PIXEL: f64 = 8.0;
/// Half extent in standard deviations.
const HALF_EXTENT: f64 = 4.0;

/// Image of a point spread.
pub(super) struct PointSpreadImage {
    /// Variances along rows and along columns, px².
    variances_px2: [f64; 2],
    /// Pixel pitch on the sensor, µm.
    pub(super) pitch_um: f64,
}

impl PointSpreadImage {
    /// `None` if the spread does not differ significantly from zero.
    pub(super) fn from_spread(spread: &Spread, pixel_pitch_um: f64) -> Option<Self> {
        let variance = |blur: Option<Blur>| {
            blur.map(|blur| blur.variance_px2).filter(|v| is_significant(*v)).map_or(0.0, |v| v.value)
        };
        let variances_px2 = [variance(spread.along_rows), variance(spread.along_columns)];
        variances_px2
            .iter()
            .any(|v| *v > 0.0)
            .then_some(Self { variances_px2, pitch_um: pixel_pitch_um / SAMPLES_PER_PIXEL })
    }

    pub(super) fn about(&self) -> String {
        let [x, y] = self.variances_px2.map(f64::sqrt);
        format!("a Gaussian, standard deviation {x:.3} px along rows and {y:.3} px along columns")
    }

    /// Encodes a 16-bit grey PNG.
    pub(super) fn png(&self) -> Result<Vec<u8>, Error> {
        let [columns, rows] = self.variances_px2.map(profile);
        let value = |y: f64, x: &f64| (f64::from(u16::MAX) * x * y).round() as u16;
        let values: Vec<u16> = rows.iter().flat_map(|y| columns.iter().map(move |x| value(*y, x))).collect();
        encode_grey16(columns.len(), rows.len(), &values).map_err(Error::run)
    }
}

/// A Gaussian at steps of a fine pixel, 1 in the middle; a single step if the width is zero.
fn profile(variance_px2: f64) -> Vec<f64> {
    let reach = (HALF_EXTENT * SAMPLES_PER_PIXEL * variance_px2.sqrt()).ceil() as i32;
    let at = |i: i32| f64::from(i) / SAMPLES_PER_PIXEL;
    (-reach..=reach).map(|i| if i == 0 { 1.0 } else { exp(-0.5 * at(i) * at(i) / variance_px2) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn its_variance_is_the_stated_one() {
        for variance in [0.09, 0.5, 2.0] {
            let profile = profile(variance);
            let middle = (profile.len() / 2) as f64;
            let sum: f64 = profile.iter().sum();
            let second: f64 =
                profile.iter().enumerate().map(|(i, p)| p * (i as f64 - middle) * (i as f64 - middle)).sum();
            // Four standard deviations contain all but 6e-5 of the light.
            assert!(
                (second / sum / (SAMPLES_PER_PIXEL * SAMPLES_PER_PIXEL) / variance - 1.0).abs() < 2e-3,
                "{variance}"
            );
        }
        assert_eq!(profile(0.0), [1.0]);
    }
}
