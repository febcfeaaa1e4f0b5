//! White balance and colour matrix of a camera, as its processing uses them, from a chart's patches and a uniform white.
//!
//! ```text
//! factors  max_j w_j / w_k                           w: readings of a white less black; the smallest factor is 1
//! c = s y / w                                        y: mean readings of a patch less black; s: Σ Y c_G/Σ c_G² over the grey patches is 1
//! M minimises Σ |M c − t|², rows that sum to 1       t: linear sRGB of the patch
//! ```
//!
//! (the matrix that `colour_matrix = { fit = … }` finds from a camera's spectra, with c measured.) Uncertainty: from the means of
//! all patches and of the white, by the law of propagation. The white is assumed to have the colour of the light. Limitations:
//! D65 only; other lights need another t.

use etendue_core::maths::f64::hypot;
use etendue_spectra::colour::{D65_WHITE, lab, linear_srgb_from_xyz};

use super::{ColourMeasurementError, ColourPatch, check};
use crate::{Estimate, Image, estimate::propagate_curved, linear::Normal, patch_statistics::patch_statistics};

/// Maximum chroma C*ab of a grey patch.
const MAX_GREY_CHROMA: f64 = 5.0;

/// Parameters of colour processing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourProcessing {
    /// Factors on red, green and blue; the smallest is 1.
    pub white_balance: [Estimate; 3],
    /// From colours balanced and relative to white to linear sRGB, row by row.
    pub matrix: [[Estimate; 3]; 3],
}

/// White balance from the readings of a white less black: factors on red, green and blue, the smallest 1.
#[must_use]
pub fn white_balance(white: &[Estimate; 3]) -> [Estimate; 3] {
    let factors = propagate_curved(white, |w| balancing(w).to_vec());
    [0, 1, 2].map(|k| factors[k].first_order)
}

/// White balance and matrix from the patches of a chart in daylight D65 and from the readings of a white in the same light, less
/// black.
///
/// # Errors
/// If there are too few patches, or they are too small, clipped or grey.
pub fn colour_processing(
    patches: &[ColourPatch],
    white: &[Estimate; 3],
    black: f64,
    full_scale: Option<f64>,
    shared_px: usize,
) -> Result<ColourProcessing, ColourMeasurementError> {
    if patches.len() < 6 {
        return Err(ColourMeasurementError::TooFew(patches.len()));
    }
    patches.iter().try_for_each(|patch| check(patch, full_scale))?;
    let mean = |image: &Image| less(patch_statistics(image, shared_px).mean, black);
    let inputs: Vec<Estimate> = patches.iter().flat_map(|p| &p.pixels).map(mean).chain(*white).collect();
    let values: Vec<f64> = inputs.iter().map(|e| e.value).collect();
    let start = fitted(patches, &values).ok_or(ColourMeasurementError::Ambiguous)?;
    let processing = propagate_curved(&inputs, |x| {
        let matrix = fitted(patches, x).unwrap_or(start);
        let factors = balancing(&x[x.len() - 3..]);
        factors.into_iter().chain(matrix.into_iter().flatten()).collect()
    });
    let at = |k: usize| processing[k].first_order;
    Ok(ColourProcessing {
        white_balance: [0, 1, 2].map(at),
        matrix: [0, 1, 2].map(|row| [0, 1, 2].map(|column| at(3 + 3 * row + column))),
    })
}

fn less(e: Estimate, black: f64) -> Estimate {
    Estimate::new(e.value - black, e.standard_uncertainty)
}

fn balancing(white: &[f64]) -> [f64; 3] {
    let max_value = white.iter().copied().fold(0.0, f64::max);
    [0, 1, 2].map(|k| max_value / white[k])
}

fn is_grey(patch: &ColourPatch) -> bool {
    let colour = lab(patch.reference, D65_WHITE);
    hypot(colour.a, colour.b) < MAX_GREY_CHROMA
}

/// The matrix from the readings of all patches, then of the white.
fn fitted(patches: &[ColourPatch], readings: &[f64]) -> Option<[[f64; 3]; 3]> {
    let (patch_readings, white) = readings.split_at(readings.len() - 3);
    let balanced: Vec<[f64; 3]> = patch_readings.chunks_exact(3).map(|y| [0, 1, 2].map(|k| y[k] / white[k])).collect();
    let greys = patches.iter().zip(&balanced).filter(|(patch, _)| is_grey(patch));
    let (yc, cc) = greys.fold((0.0, 0.0), |(yc, cc), (p, c)| (yc + p.reference[1] * c[1], cc + c[1] * c[1]));
    let scale = yc / cc;
    let row = |colour: usize| {
        let mut normal = Normal::new(3);
        for (patch, c) in patches.iter().zip(&balanced) {
            normal.add(&c.map(|c| scale * c), linear_srgb_from_xyz(patch.reference)[colour], 1.0);
        }
        let (free, inverse) = (normal.solve()?, normal.inverse()?);
        let ones = [0, 1, 2].map(|i| (0..3).map(|j| inverse.at(i, j)).sum::<f64>());
        let pull = (1.0 - free.iter().sum::<f64>()) / ones.iter().sum::<f64>();
        Some([0, 1, 2].map(|i| free[i] + pull * ones[i]))
    };
    scale.is_finite().then_some([row(0)?, row(1)?, row(2)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::{illuminant, observer, reflectance::colorchecker};

    #[test]
    fn a_camera_that_is_a_matrix_of_srgb_gives_its_inverse() {
        // Rows that sum to 1 map white to white.
        let sees = |t: [f64; 3]| {
            [[0.7, 0.2, 0.1], [0.2, 0.7, 0.1], [0.0, 0.3, 0.7]]
                .map(|row: [f64; 3]| row.iter().zip(t).map(|(m, t)| m * t).sum::<f64>())
        };
        let strength = [400.0, 800.0, 500.0];
        let image = |c: [f64; 3]| [0, 1, 2].map(|k| Image::filled(4, 4, (strength[k] * c[k] + 16.0) as f32));
        let patches: Vec<ColourPatch> = colorchecker()
            .iter()
            .map(|p| {
                let reference = observer::xyz_of_reflectance(&p.reflectance, illuminant::d65());
                let pixels = image(sees(linear_srgb_from_xyz(reference)));
                ColourPatch { name: p.name.to_owned(), pixels, reference }
            })
            .collect();
        let white = strength.map(|w| Estimate::new(w, 0.0));
        let result = colour_processing(&patches, &white, 16.0, None, 1).expect("a chart");
        // Readings are stored in f32.
        let near = |a: f64, b: f64, tolerance: f64| assert!((a - b).abs() < tolerance, "{a} {b}");
        result.white_balance.iter().zip([2.0, 1.0, 1.6]).for_each(|(e, f)| near(e.value, f, 1e-6));
        // The chart's greys are not exactly neutral: they determine the scale to 0.3 %.
        for t in [[0.8, 0.1, 0.2], [0.1, 0.6, 0.3], [0.3, 0.2, 0.9]] {
            let back = result.matrix.map(|row| row.iter().zip(sees(t)).map(|(m, c)| m.value * c).sum::<f64>());
            back.iter().zip(t).for_each(|(a, b)| near(*a, b, 5e-3));
        }
        let balance = white_balance(&white);
        assert_eq!(balance.map(|e| e.value), result.white_balance.map(|e| e.value));
    }
}
