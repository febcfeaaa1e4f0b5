//! Colour error of a chart's patches after a fitted matrix.
//!
//! ```text
//! M minimises Σ |M c − t|²          c: mean readings of a patch less black, t: its CIE XYZ under the reference illuminant
//! ΔE00 of (M c) against t           CIEDE2000, L*a*b* against the reference white
//! ```
//!
//! M contains the camera's exposure. Uncertainty of each ΔE00 and of their mean: from the means of all patches, through M,
//! propagated to second order. As ΔE00 is never negative, noise biases small values upwards; if that bias exceeds an eighth of
//! the value, no uncertainty is stated. The largest ΔE00 has none either, as its selection depends on noise. Limitations: no
//! matrices that preserve white, no weights by perceived difference, three channels only.

mod processing;

use etendue_spectra::colour::{Lab, ciede2000, lab};

use crate::estimate::{SecondOrderEstimate, propagate_curved};
use crate::patch_statistics::{patch_statistics, saturated_percent};
use crate::{Estimate, Image, linear::Normal};

pub use processing::{ColourProcessing, colour_processing, white_balance};

/// A patch of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourPatch {
    pub name: String,
    /// Pixels: red, green, blue.
    pub pixels: [Image; 3],
    /// CIE XYZ under the reference illuminant, with Y = 1 for white.
    pub reference: [f64; 3],
}

/// The matrix and the remaining errors.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourError {
    /// From readings less black to XYZ, row by row.
    pub matrix: [[f64; 3]; 3],
    /// ΔE00 of each patch.
    pub differences: Vec<Estimate>,
    /// Their mean.
    pub mean: Estimate,
    pub largest: f64,
    /// L*a*b* of each patch from the matrix, and of its reference.
    pub colours: Vec<[[f64; 3]; 2]>,
}

/// Reason why colours cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ColourMeasurementError {
    /// Too few patches for a matrix.
    #[error("a colour matrix needs at least six patches, not {0}")]
    TooFew(usize),
    /// A patch is too small.
    #[error("the patch {0} has fewer than four pixels: give an image in which the chart is larger")]
    TooSmall(String),
    /// A patch is clipped.
    #[error("{percent:.1} % of the patch {name} is saturated: expose less")]
    Saturated {
        /// The patch.
        name: String,
        /// Percentage of clipped pixels.
        percent: f64,
    },
    /// The patches do not distinguish the channels.
    #[error(
        "two channels of the camera have equal readings of the patches, so no colour matrix can be fitted: check that this is a colour image of the chart"
    )]
    Ambiguous,
    /// The patches have other colours.
    #[error(
        "the patches do not match the chart (mean ΔE00 {0:.1} with the best matrix; a few are usual): check the chart and its orientation"
    )]
    Unlike(f64),
}

/// Maximum mean ΔE00 of a plausible colour camera.
const MAX_DELTA: f64 = 15.0;

/// Fits the matrix and measures the remaining colour errors; `white` is the XYZ of the reference white, `shared_px` the side of
/// the blocks of pixels with equal errors (1: none).
///
/// # Errors
/// If there are too few patches, or they are too small, clipped or grey.
pub fn measure_colour(
    patches: &[ColourPatch],
    black: f64,
    full_scale: Option<f64>,
    white: [f64; 3],
    shared_px: usize,
) -> Result<ColourError, ColourMeasurementError> {
    if patches.len() < 6 {
        return Err(ColourMeasurementError::TooFew(patches.len()));
    }
    patches.iter().try_for_each(|patch| check(patch, full_scale))?;
    let less_black = |e: Estimate| Estimate::new(e.value - black, e.standard_uncertainty);
    let means: Vec<Vec<Estimate>> = patches
        .iter()
        .map(|p| p.pixels.iter().map(|c| less_black(patch_statistics(c, shared_px).mean)).collect())
        .collect();
    let values: Vec<f64> = means.iter().flatten().map(|e| e.value).collect();
    let matrix = fitted(patches, &values).ok_or(ColourMeasurementError::Ambiguous)?;
    let colours = lab_colours(&values, matrix, white);
    let references: Vec<Lab> = patches.iter().map(|p| lab(p.reference, white)).collect();
    // ΔE00 of each patch, then their mean, from a matrix of the same readings.
    let figures = propagate_curved(&means.concat(), |x| {
        let colours = lab_colours(x, fitted(patches, x).unwrap_or(matrix), white);
        let each: Vec<f64> = colours.iter().zip(&references).map(|(c, r)| ciede2000(*c, *r)).collect();
        let mean = each.iter().sum::<f64>() / each.len() as f64;
        each.into_iter().chain([mean]).collect()
    });
    let mut differences: Vec<Estimate> = figures.into_iter().map(SecondOrderEstimate::above_zero).collect();
    let mean = differences.pop().expect("the mean is last");
    if mean.value > MAX_DELTA {
        return Err(ColourMeasurementError::Unlike(mean.value));
    }
    let triple = |c: &Lab| [c.l, c.a, c.b];
    Ok(ColourError {
        matrix,
        mean,
        largest: differences.iter().map(|d| d.value).fold(0.0, f64::max),
        colours: colours.iter().zip(&references).map(|(c, r)| [triple(c), triple(r)]).collect(),
        differences,
    })
}

/// The colours of the readings of all patches.
fn lab_colours(readings: &[f64], matrix: [[f64; 3]; 3], white: [f64; 3]) -> Vec<Lab> {
    let xyz = |reading: &[f64]| matrix.map(|row| row.iter().zip(reading).map(|(m, r)| m * r).sum::<f64>());
    readings.chunks_exact(3).map(|reading| lab(xyz(reading), white)).collect()
}

fn check(patch: &ColourPatch, full_scale: Option<f64>) -> Result<(), ColourMeasurementError> {
    if patch.pixels.iter().any(|p| p.samples().len() < 4) {
        return Err(ColourMeasurementError::TooSmall(patch.name.clone()));
    }
    match saturated_percent(&patch.pixels, full_scale) {
        Some(percent) => Err(ColourMeasurementError::Saturated { name: patch.name.clone(), percent }),
        None => Ok(()),
    }
}

/// The matrix from the readings of all patches.
fn fitted(patches: &[ColourPatch], readings: &[f64]) -> Option<[[f64; 3]; 3]> {
    let row = |c: usize| {
        let mut normal = Normal::new(3);
        for (patch, reading) in patches.iter().zip(readings.chunks_exact(3)) {
            normal.add(reading, patch.reference[c], 1.0);
        }
        let row = normal.solve()?;
        Some([row[0], row[1], row[2]])
    };
    Some([row(0)?, row(1)?, row(2)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::{colour::D65_WHITE, illuminant, observer, reflectance::colorchecker};

    fn patches(readings: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<ColourPatch> {
        let patch = |p: &etendue_spectra::reflectance::Patch| {
            let reference = observer::xyz_of_reflectance(&p.reflectance, illuminant::d65());
            let pixels = readings(reference).map(|r| Image::filled(4, 4, (r + 16.0) as f32));
            ColourPatch { name: p.name.to_owned(), pixels, reference }
        };
        colorchecker().iter().map(patch).collect()
    }

    #[test]
    fn a_camera_that_is_a_matrix_of_xyz_has_no_error() {
        let camera =
            |[x, y, z]: [f64; 3]| [500.0 * x + 90.0 * y, 40.0 * x + 600.0 * y + 20.0 * z, 70.0 * y + 450.0 * z];
        let result = measure_colour(&patches(camera), 16.0, Some(1023.0), D65_WHITE, 1).expect("a chart");
        // Readings are stored in f32.
        assert!(result.largest < 1e-3, "{:?}", result.largest);
        let white = camera(D65_WHITE);
        let back = result.matrix.map(|row| row.iter().zip(white).map(|(m, w)| m * w).sum::<f64>());
        assert!(back.iter().zip(D65_WHITE).all(|(a, b)| (a - b).abs() < 1e-5));
    }

    #[test]
    fn what_is_no_colour_chart_is_refused() {
        let grey = measure_colour(&patches(|[_, y, _]| [500.0 * y; 3]), 16.0, None, D65_WHITE, 1);
        assert_eq!(grey, Err(ColourMeasurementError::Ambiguous));
        let mut turned = patches(|xyz| xyz.map(|v| 500.0 * v));
        let pixels: Vec<_> = turned.iter().rev().map(|p| p.pixels.clone()).collect();
        turned.iter_mut().zip(pixels).for_each(|(patch, pixels)| patch.pixels = pixels);
        let turned = measure_colour(&turned, 16.0, None, D65_WHITE, 1);
        assert!(matches!(turned, Err(ColourMeasurementError::Unlike(_))), "{turned:?}");
        let clipped = measure_colour(&patches(|xyz| xyz.map(|v| 1200.0 * v)), 16.0, Some(1000.0), D65_WHITE, 1);
        assert!(matches!(clipped, Err(ColourMeasurementError::Saturated { .. })));
        assert_eq!(measure_colour(&[], 0.0, None, D65_WHITE, 1), Err(ColourMeasurementError::TooFew(0)));
    }
}
