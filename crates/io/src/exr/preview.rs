//! The colour preview of a spectral image.

use etendue_core::quantity::Quantity;
use etendue_core::{Bands, Plane, SpectralCube};
use etendue_spectra::colour::linear_srgb_from_xyz;
use etendue_spectra::observer::xyz_weights;

/// Linear sRGB planes of `cube`, (1, 1, 1) at a luminance of 1 cd/m² (1 lx for irradiance). Components may be negative:
/// spectral colours lie outside sRGB. Bands outside the visible add nothing.
pub(crate) fn linear_srgb<Q: Quantity<Sample = f32>>(cube: &SpectralCube<Q>) -> [Vec<f32>; 3] {
    let planes: Vec<&[f32]> = cube.planes().iter().map(Plane::samples).collect();
    linear_srgb_of_bands(&planes, &band_weights(cube.bands()))
}

/// What a band mean of 1 adds to linear red, green and blue, (1, 1, 1) at 1 cd/m² of radiance (1 lx of irradiance).
#[must_use]
pub fn band_weights(bands: Bands) -> Vec<[f64; 3]> {
    xyz_weights(bands).into_iter().map(linear_srgb_from_xyz).collect()
}

/// Linear sRGB of as many pixels as each band has, by the weights of the bands.
pub(super) fn linear_srgb_of_bands(bands: &[&[f32]], weights: &[[f64; 3]]) -> [Vec<f32>; 3] {
    let pixels = bands.first().map_or(0, |band| band.len());
    std::array::from_fn(|channel| {
        let mut sums = vec![0.0_f64; pixels];
        for (band, weight) in bands.iter().zip(weights) {
            for (sum, mean) in sums.iter_mut().zip(*band) {
                *sum += weight[channel] * f64::from(*mean);
            }
        }
        sums.into_iter().map(single).collect()
    })
}

/// A 32-bit float; every NaN becomes the same one, since processors differ in the bits of theirs.
fn single(value: f64) -> f32 {
    if value.is_nan() { f32::NAN } else { value as f32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::quantity::Radiance;
    use etendue_spectra::{illuminant, observer};

    #[test]
    fn daylight_of_one_candela_is_white_one() {
        let bands = Bands::covering(380.0, 780.0, 5.0).expect("80 bands");
        let relative = illuminant::named("D65").expect("D65");
        let daylight = observer::with_luminance(relative, 1.0).expect("visible");
        let planes = daylight.band_means(bands).into_iter().map(|v| Plane::filled(1, 1, v as f32)).collect();
        let cube = SpectralCube::<Radiance>::from_planes(bands, planes).expect("one plane a band");
        for channel in linear_srgb(&cube) {
            // Products of 5 nm means differ from means of products: CIE 15 tables agree to about 1e-3 at 5 nm.
            assert!((channel[0] - 1.0).abs() < 2e-3, "{}", channel[0]);
        }
    }
}
