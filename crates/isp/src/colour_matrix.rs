//! From a camera's white-balanced colours to linear sRGB.
//!
//! A matrix of three rows and as many columns as the image has channels. Rows that sum to 1 preserve the neutral colours of white balance;
//! [`fit_colour_matrix`] finds such a matrix from the camera's own spectra.
//!
//! A colour matrix from the camera's own spectra.
//!
//! The fit minimises, among all matrices with rows that sum to 1, over the reflectances of a chart,
//!
//! ```text
//! Σ |M c − t|² + n σ² |M|²
//! ```
//!
//! c the camera's response under the scene's illuminant over its response to a perfect white, t the linear sRGB colour of the reflectance under D65,
//! n the number of reflectances. The second term is the contribution of noise of σ (a fraction of white, equal in all channels) to the expected error
//! of n patches. It keeps nearly equal channels (a clear filter in addition to red, green and blue) from receiving large opposite factors that would
//! amplify noise. Each row m solves (A + n σ² 1) m = b + μ e, e all ones and μ such that the row sums to 1, by Cholesky's method.
//!
//! Left out: weights by perceived difference, matrices between two illuminants.

use etendue_spectra::{Spectrum, colour, illuminant, observer};

use crate::raw::MAX_CHANNELS;
use crate::white_balance::{NoResponse, response};

/// Rows give red, green and blue of linear sRGB, columns are the channels.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourMatrix {
    rows: [Vec<f64>; 3],
}

/// Error of a matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MatrixError {
    /// Rows of different lengths.
    #[error("the rows of the colour matrix differ in length; each needs one number per channel of the camera")]
    Ragged,
    /// An entry that is not finite.
    #[error("the colour matrix has an entry that is not finite: give finite numbers")]
    NotFinite,
}

impl ColourMatrix {
    /// Creates a matrix from rows.
    ///
    /// # Errors
    /// If the rows differ in length or an entry is not finite.
    pub fn new(rows: [Vec<f64>; 3]) -> Result<Self, MatrixError> {
        if rows.iter().any(|row| row.len() != rows[0].len()) {
            return Err(MatrixError::Ragged);
        }
        if !rows.iter().flatten().all(|m| m.is_finite()) {
            return Err(MatrixError::NotFinite);
        }
        Ok(Self { rows })
    }

    /// Three channels unchanged.
    #[must_use]
    pub fn identity() -> Self {
        Self { rows: [0, 1, 2].map(|i| (0..3).map(|j| f64::from(u8::from(i == j))).collect()) }
    }

    /// Red, green and blue by rows.
    #[must_use]
    pub fn rows(&self) -> &[Vec<f64>; 3] {
        &self.rows
    }

    /// Channels of the camera.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.rows[0].len()
    }

    /// The colour of each channel under the matrix.
    #[must_use]
    pub fn apply(&self, channels: &[f64]) -> [f64; 3] {
        self.rows.each_ref().map(|row| row.iter().zip(channels).map(|(m, c)| m * c).sum())
    }
}

/// σ for images with channels other than red, green and blue. Red, green and blue are well separated, and σ = 0 is best for them. The green of red,
/// blue and clear has factors of 6 without it and of 4 with it, at a ΔE higher by two.
pub const NOISE_OF_OTHER_CHANNELS: f64 = 0.01;

/// Error of fitting a matrix.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FitError {
    /// A channel that does not respond to the light.
    #[error(transparent)]
    NoResponse(#[from] NoResponse),
    /// Reflectances that do not separate the channels.
    #[error(
        "two of the camera's channels respond equally to the reflectances, so no colour matrix can be fitted: give more colours, or check that the \
         channels differ"
    )]
    Ambiguous,
    /// An unsupported number of channels.
    #[error("a colour matrix has one to {MAX_CHANNELS} channels, not {0}")]
    Channels(usize),
}

/// Fits the matrix of a camera (responsivities of its channels, any common scale) under an illuminant (any scale) to the reflectances of a chart, for
/// noise of `noise_fraction` of white in each channel (0: none).
///
/// # Errors
/// If a channel does not respond to the illuminant or the reflectances do not separate the channels.
pub fn fit_colour_matrix<'a>(
    responsivities: &[&Spectrum],
    light: &Spectrum,
    chart: impl IntoIterator<Item = &'a Spectrum>,
    noise_fraction: f64,
) -> Result<ColourMatrix, FitError> {
    if !(1..=MAX_CHANNELS).contains(&responsivities.len()) {
        return Err(FitError::Channels(responsivities.len()));
    }
    let pairs = chart
        .into_iter()
        .map(|patch| Ok((balanced_response(responsivities, light, patch)?, reference(patch))))
        .collect::<Result<Vec<_>, NoResponse>>()?;
    let channels = responsivities.len();
    // Four channels may be redundant for three dimensions of colour; the noise term decides between them.
    if channels < MAX_CHANNELS && NormalEquations::new(&pairs, channels, 0.0).cholesky().is_none() {
        return Err(FitError::Ambiguous);
    }
    let normal = NormalEquations::new(&pairs, channels, noise_fraction);
    let lower = normal.cholesky().ok_or(FitError::Ambiguous)?;
    Ok(ColourMatrix { rows: [0, 1, 2].map(|row| normal.solve(&lower, row)) })
}

/// The camera's response to a reflectance over its response to a perfect white.
fn balanced_response(
    responsivities: &[&Spectrum],
    light: &Spectrum,
    reflectance: &Spectrum,
) -> Result<Vec<f64>, NoResponse> {
    let channel_response = |(channel, responsivity): (usize, &&Spectrum)| {
        let white = response(responsivity, light, None);
        if white <= 0.0 {
            Err(NoResponse(channel))
        } else {
            Ok(response(responsivity, light, Some(reflectance)) / white)
        }
    };
    responsivities.iter().enumerate().map(channel_response).collect()
}

/// Linear sRGB of a reflectance under D65.
fn reference(reflectance: &Spectrum) -> [f64; 3] {
    colour::linear_srgb_from_xyz(observer::xyz_of_reflectance(reflectance, illuminant::d65()))
}

type ChannelMatrix = [[f64; MAX_CHANNELS]; MAX_CHANNELS];

/// The normal equations: products of the channels with each other, and with the targets.
struct NormalEquations {
    channels: usize,
    products: ChannelMatrix,
    targets: [[f64; MAX_CHANNELS]; 3],
}

impl NormalEquations {
    fn new(pairs: &[(Vec<f64>, [f64; 3])], channels: usize, noise_fraction: f64) -> Self {
        let mut normal = Self { channels, products: ChannelMatrix::default(), targets: Default::default() };
        for (c, t) in pairs {
            for i in 0..channels {
                (0..channels).for_each(|j| normal.products[i][j] += c[i] * c[j]);
                (0..3).for_each(|row| normal.targets[row][i] += c[i] * t[row]);
            }
        }
        let noise = pairs.len() as f64 * noise_fraction * noise_fraction;
        (0..channels).for_each(|i| normal.products[i][i] += noise);
        normal
    }

    /// The lower triangle L of L Lᵀ; `None` if there is no unique solution.
    fn cholesky(&self) -> Option<ChannelMatrix> {
        let mut lower = ChannelMatrix::default();
        for i in 0..self.channels {
            for j in 0..=i {
                let rest = self.products[i][j] - (0..j).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
                if i != j {
                    lower[i][j] = rest / lower[j][j];
                } else if rest > 1e-9 * self.products[i][i] {
                    // Colour charts leave 1e-3 of a channel's own square. For greys, f32 spectra leave 1e-14.
                    lower[i][i] = rest.sqrt();
                } else {
                    return None;
                }
            }
        }
        Some(lower)
    }

    /// The row that sums to 1.
    fn solve(&self, lower: &ChannelMatrix, row: usize) -> Vec<f64> {
        let free = substitute(lower, self.targets[row], self.channels);
        let ones = substitute(lower, [1.0; MAX_CHANNELS], self.channels);
        let sum = |v: &[f64; MAX_CHANNELS]| v[..self.channels].iter().sum::<f64>();
        let pull = (1.0 - sum(&free)) / sum(&ones);
        (0..self.channels).map(|c| free[c] + pull * ones[c]).collect()
    }
}

/// x of L Lᵀ x = b.
fn substitute(lower: &ChannelMatrix, b: [f64; MAX_CHANNELS], channels: usize) -> [f64; MAX_CHANNELS] {
    let mut x = b;
    for i in 0..channels {
        let rest = x[i] - (0..i).map(|k| lower[i][k] * x[k]).sum::<f64>();
        x[i] = rest / lower[i][i];
    }
    for i in (0..channels).rev() {
        let rest = x[i] - (i + 1..channels).map(|k| lower[k][i] * x[k]).sum::<f64>();
        x[i] = rest / lower[i][i];
    }
    x
}

#[cfg(test)]
mod tests {
    use etendue_spectra::{camera, reflectance};

    use super::*;

    #[test]
    fn rows_are_colours_and_columns_channels() {
        let matrix = ColourMatrix::new([vec![1.0, 2.0], vec![0.5, 0.0], vec![-1.0, 1.0]]).expect("a matrix");
        assert_eq!((matrix.channels(), matrix.apply(&[1.0, 3.0])), (2, [7.0, 0.5, 2.0]));
        assert_eq!(ColourMatrix::identity().apply(&[0.1, 0.2, 0.3]), [0.1, 0.2, 0.3]);
        assert_eq!(ColourMatrix::new([vec![1.0], vec![], vec![1.0]]), Err(MatrixError::Ragged));
        assert_eq!(ColourMatrix::new([0, 1, 2].map(|_| vec![f64::NAN])), Err(MatrixError::NotFinite));
    }

    fn canon() -> [&'static Spectrum; 3] {
        let canon = camera::by_name("canon-eos-5d-mark-ii").expect("a camera");
        [&canon.r, &canon.g, &canon.b]
    }

    fn chart_spectra() -> impl Iterator<Item = &'static Spectrum> {
        reflectance::colorchecker().iter().map(|patch| &patch.reflectance)
    }

    fn lab_of(linear: [f64; 3]) -> colour::Lab {
        colour::lab(colour::xyz_from_linear_srgb(linear), colour::D65_WHITE)
    }

    #[test]
    fn a_measured_camera_sees_the_chart() {
        let matrix = fit_colour_matrix(&canon(), illuminant::d65(), chart_spectra(), 0.0).expect("a matrix");
        let difference = |patch: &'static Spectrum| {
            let actual = balanced_response(&canon(), illuminant::d65(), patch).expect("light");
            colour::ciede2000(lab_of(matrix.apply(&actual)), lab_of(reference(patch)))
        };
        let differences: Vec<f64> = chart_spectra().map(difference).collect();
        let mean = differences.iter().sum::<f64>() / 24.0;
        // The best matrix reaches 0.71; an error in balance, tables or fit makes it several.
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
        let matrix = fit_colour_matrix(&eyes.each_ref(), illuminant::d65(), chart_spectra(), 0.0).expect("a matrix");
        for patch in chart_spectra() {
            let actual = matrix.apply(&balanced_response(&eyes.each_ref(), illuminant::d65(), patch).expect("light"));
            let expected = reference(patch);
            // Spectra are f32: 1e-7 a node, amplified by the matrix's entries of up to 5.
            assert!((0..3).all(|c| (actual[c] - expected[c]).abs() < 2e-6), "{actual:?} {expected:?}");
        }
    }

    #[test]
    fn neutrals_stay_neutral() {
        let light = illuminant::blackbody(2856.0);
        let matrix = fit_colour_matrix(&canon(), &light, chart_spectra(), 0.0).expect("a matrix");
        for row in matrix.rows() {
            assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn what_cannot_be_fitted_is_refused() {
        let greys = [Spectrum::constant(0.2), Spectrum::constant(0.7)];
        assert_eq!(fit_colour_matrix(&canon(), illuminant::d65(), &greys, 0.0), Err(FitError::Ambiguous));
        let dark = Spectrum::constant(0.0);
        assert_eq!(fit_colour_matrix(&canon(), &dark, &greys, 0.0), Err(FitError::NoResponse(NoResponse(0))));
        let [r, g, _] = canon();
        for noise in [0.0, NOISE_OF_OTHER_CHANNELS] {
            let fit = fit_colour_matrix(&[r, g, g], illuminant::d65(), chart_spectra(), noise);
            assert_eq!(fit, Err(FitError::Ambiguous));
        }
    }

    /// Mean ΔE₀₀ of the chart under D65, and the largest entry.
    fn figures(channels: &[&Spectrum], noise: f64) -> (f64, f64) {
        let light = illuminant::d65();
        let matrix = fit_colour_matrix(channels, light, chart_spectra(), noise).expect("a matrix");
        let error = |patch: &'static Spectrum| {
            let actual = matrix.apply(&balanced_response(channels, light, patch).expect("light"));
            colour::ciede2000(lab_of(actual), lab_of(reference(patch)))
        };
        let mean = chart_spectra().map(error).sum::<f64>() / 24.0;
        (mean, matrix.rows().iter().flatten().fold(0.0, |m: f64, e| m.max(e.abs())))
    }

    /// A clear channel: the sum of the three, and the gaps between them.
    fn clear() -> Spectrum {
        let [r, g, b] = canon();
        Spectrum::from_fn(|nm| {
            let at = |s: &Spectrum| f64::from(s.at(nm as f32));
            0.4 * (at(r) + at(g) + at(b)) + if (430.0..=680.0).contains(&nm) { 0.3 } else { 0.0 }
        })
    }

    #[test]
    fn more_and_fewer_channels_have_a_matrix_too() {
        let ([r, g, b], clear) = (canon(), clear());
        let (rgbw, largest) = figures(&[r, g, b, &clear], NOISE_OF_OTHER_CHANNELS);
        let (rccb, wild) = figures(&[r, b, &clear], 0.0);
        let (rccb_tamed, mild) = figures(&[r, b, &clear], NOISE_OF_OTHER_CHANNELS);
        let (rccc, _) = figures(&[r, &clear], NOISE_OF_OTHER_CHANNELS);
        // Three broad channels still distinguish all colours, less well; two lack a dimension of colour.
        assert!(rgbw < 1.5 && largest < 4.0, "RGBW: mean ΔE₀₀ {rgbw}, largest entry {largest}");
        assert!(rccb < 5.0, "RCCB: mean ΔE₀₀ {rccb}");
        assert!(rccb_tamed < rccb + 2.5 && mild < 0.75 * wild, "RCCB: {rccb_tamed}, {mild} of {wild}");
        assert!(rccc > 5.0 && rccc < 30.0, "RCCC: mean ΔE₀₀ {rccc}");
    }

    #[test]
    fn noise_tames_the_factors() {
        let ([r, g, b], clear) = (canon(), clear());
        let channels = [r, g, b, &clear];
        let (free, wild) = figures(&channels, 0.0);
        let (tamed, largest) = figures(&channels, 0.05);
        assert!(largest < wild && tamed > free, "{wild} {largest}, {free} {tamed}");
    }

    #[test]
    fn cameras_have_one_to_four_channels() {
        let [r, ..] = canon();
        let fit = |channels: &[&Spectrum]| fit_colour_matrix(channels, illuminant::d65(), chart_spectra(), 0.0);
        assert_eq!(fit(&[]), Err(FitError::Channels(0)));
        assert_eq!(fit(&[r; 5]), Err(FitError::Channels(5)));
        // One channel: the same grey in red, green and blue.
        assert!(fit(&[r]).expect("a matrix").rows().iter().all(|row| (row[0] - 1.0).abs() < 1e-12));
    }
}
