//! From a camera's white-balanced colours to linear sRGB.
//!
//! A matrix M with rows that sum to 1, so that what white balance made neutral stays neutral. [`fit_colour_matrix`] finds
//! the M that minimises Σ |M c − t|² over reflectances: c the camera's response under the scene's illuminant over its
//! response to a perfect white, t the linear sRGB colour of the reflectance under D65. With m_r = 1 − m_g − m_b each row
//! is a least-squares problem of two unknowns.
//!
//! Left out: weights by perceived difference, matrices between two illuminants.

use crate::white_balance::{NoResponse, response};
use etendue_spectra::{Spectrum, colour, illuminant, observer};

/// Rows give red, green and blue of linear sRGB.
pub type ColourMatrix = [[f64; 3]; 3];

/// Why no matrix can be fitted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FitError {
    /// A channel does not see the light.
    #[error(transparent)]
    NoResponse(#[from] NoResponse),
    /// The reflectances do not tell the channels apart.
    #[error(
        "the reflectances look the same to two of the camera's channels, so no colour matrix can be fitted: give more colours, or check that the channels differ"
    )]
    Ambiguous,
}

/// The colour of each channel triple under the matrix.
#[must_use]
pub fn apply(matrix: &ColourMatrix, rgb: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2])
}

/// The matrix for a camera (responsivities of red, green and blue, any common scale) under an illuminant (any scale),
/// fitted to the reflectances of a chart.
///
/// # Errors
/// Where a channel does not respond to the illuminant or the reflectances do not tell the channels apart.
pub fn fit_colour_matrix<'a>(
    responsivities: [&Spectrum; 3],
    light: &Spectrum,
    chart: impl IntoIterator<Item = &'a Spectrum>,
) -> Result<ColourMatrix, FitError> {
    let pairs = chart
        .into_iter()
        .map(|patch| Ok((balanced_response(responsivities, light, patch)?, reference(patch))))
        .collect::<Result<Vec<_>, NoResponse>>()?;
    let rows: Vec<[f64; 3]> = (0..3).filter_map(|row| fit_row(&pairs, row)).collect();
    rows.try_into().map_err(|_| FitError::Ambiguous)
}

/// The camera's response to a reflectance over its response to a perfect white.
fn balanced_response(
    responsivities: [&Spectrum; 3],
    light: &Spectrum,
    reflectance: &Spectrum,
) -> Result<[f64; 3], NoResponse> {
    let white = responsivities.map(|r| response(r, light, None));
    match white.iter().position(|w| *w <= 0.0) {
        Some(channel) => Err(NoResponse(channel)),
        None => Ok(core::array::from_fn(|c| response(responsivities[c], light, Some(reflectance)) / white[c])),
    }
}

/// Linear sRGB of a reflectance under D65.
fn reference(reflectance: &Spectrum) -> [f64; 3] {
    colour::linear_srgb_from_xyz(observer::xyz_of_reflectance(reflectance, illuminant::d65()))
}

/// One row: least squares of t − c_r = m_g (c_g − c_r) + m_b (c_b − c_r). `None` where it has no single solution.
fn fit_row(pairs: &[([f64; 3], [f64; 3])], row: usize) -> Option<[f64; 3]> {
    let (mut gg, mut gb, mut bb, mut gt, mut bt, mut brightness) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (c, t) in pairs {
        let (g, b, t) = (c[1] - c[0], c[2] - c[0], t[row] - c[0]);
        gg += g * g;
        gb += g * b;
        bb += b * b;
        gt += g * t;
        bt += b * t;
        brightness += c[0] * c[0];
    }
    let determinant = gg * bb - gb * gb;
    // Charts of colours reach 1e-3 of the square of their brightness. What spectra of f32 leave of greys is 1e-14.
    if determinant.is_nan() || determinant <= 1e-9 * brightness * brightness {
        return None;
    }
    let green = (bb * gt - gb * bt) / determinant;
    let blue = (gg * bt - gb * gt) / determinant;
    Some([1.0 - green - blue, green, blue])
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::{camera, chart};

    fn canon() -> [&'static Spectrum; 3] {
        let canon = camera::named("canon-eos-5d-mark-ii").expect("a camera");
        [&canon.r, &canon.g, &canon.b]
    }

    fn chart_spectra() -> impl Iterator<Item = &'static Spectrum> {
        chart::colorchecker().iter().map(|patch| &patch.reflectance)
    }

    fn lab_of(linear: [f64; 3]) -> colour::Lab {
        colour::lab(colour::xyz_from_linear_srgb(linear), colour::D65_WHITE)
    }

    #[test]
    fn a_measured_camera_sees_the_chart() {
        let matrix = fit_colour_matrix(canon(), illuminant::d65(), chart_spectra()).expect("a matrix");
        let difference = |patch: &'static Spectrum| {
            let seen = balanced_response(canon(), illuminant::d65(), patch).expect("light");
            colour::ciede2000(lab_of(apply(&matrix, seen)), lab_of(reference(patch)))
        };
        let differences: Vec<f64> = chart_spectra().map(difference).collect();
        let mean = differences.iter().sum::<f64>() / 24.0;
        // The best matrix reaches 0.71; a fault in balance, tables or fit makes it several.
        assert!(differences.len() == 24 && mean < 1.0, "mean ΔE₀₀ {mean}, {differences:?}");
    }

    #[test]
    fn a_camera_with_the_eyes_of_the_observer_is_exact() {
        // Sensitivities that are linear combinations of the observer's have an exact matrix.
        let mix = |w: [f64; 3]| {
            Spectrum::from_fn(|nm| {
                let at = |s: &Spectrum| f64::from(s.at(nm as f32));
                w[0] * at(observer::x_bar()) + w[1] * at(observer::y_bar()) + w[2] * at(observer::z_bar())
            })
        };
        let eyes = [mix([0.9, 0.2, 0.1]), mix([0.1, 0.9, 0.2]), mix([0.1, 0.1, 0.9])];
        let eyes = eyes.each_ref();
        let matrix = fit_colour_matrix(eyes, illuminant::d65(), chart_spectra()).expect("a matrix");
        for patch in chart_spectra() {
            let seen = apply(&matrix, balanced_response(eyes, illuminant::d65(), patch).expect("light"));
            let want = reference(patch);
            // Spectra are f32: 1e-7 a node, amplified by the matrix's entries of up to 5.
            assert!((0..3).all(|c| (seen[c] - want[c]).abs() < 2e-6), "{seen:?} {want:?}");
        }
    }

    #[test]
    fn neutrals_stay_neutral() {
        let light = illuminant::blackbody(2856.0);
        let matrix = fit_colour_matrix(canon(), &light, chart_spectra()).expect("a matrix");
        for row in matrix {
            assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn what_cannot_be_fitted_is_refused() {
        let greys = [Spectrum::constant(0.2), Spectrum::constant(0.7)];
        assert_eq!(fit_colour_matrix(canon(), illuminant::d65(), &greys), Err(FitError::Ambiguous));
        let dark = Spectrum::constant(0.0);
        assert_eq!(fit_colour_matrix(canon(), &dark, &greys), Err(FitError::NoResponse(NoResponse(0))));
        let [r, g, _] = canon();
        assert_eq!(fit_colour_matrix([r, g, g], illuminant::d65(), chart_spectra()), Err(FitError::Ambiguous));
    }
}
