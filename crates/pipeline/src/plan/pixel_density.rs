//! Probability density of the wavelengths of a pixel that accumulates electrons.
//!
//! - [`WavelengthSampling::Response`]: p₀ = u U + (1 − u) R/∫R, the responsivity R in steps of 5 nm and the uniform density U; u is 5 % if
//!   only electrons are accumulated, 50 % if a spectral cube is stored too.
//! - [`WavelengthSampling::ResponseAndSource`]: the part that follows R is divided, ε of it as before and 1 − ε to
//!   Σ w_k R S_k/∫R S_k in steps of 1 nm, over the groups k of the light's sources (`SourceSpectra::lit`); if only electrons are accumulated, ε
//!   of the uniform part remains.
//!
//! p ≥ ε p₀ everywhere, so that for any light f = R L the mean square of a sample, ∫f²/p, is at most 1/ε of that with the response alone:
//! the reflections of the light need not be known. A pixel lit by the group k alone has ∫f²/p ≤ 1/((1 − ε) w_k) times the squared mean (for surfaces
//! of uniform reflectance; 1/(1 − u) times that if bands are stored).

use crate::plan::{SourceSpectra, WavelengthSampling};
use etendue_core::{WavelengthDensity, WavelengthRange};
use etendue_spectra::Spectrum;

/// Maximum width of the response's steps, nm.
const STEP_NM: f64 = 5.0;
/// Steps of the source's spectrum in one of the response's: the grid of spectra.
const FINE_STEPS: usize = 5;
/// Fraction of the uniform density if only electrons are accumulated: guards against a step whose mean is far below its peak.
const UNIFORM_FRACTION: f64 = 0.05;
/// Fraction of the uniform density if spectral bands are stored too.
pub(crate) const UNIFORM_FRACTION_WITH_BANDS: f64 = 0.5;
/// ε: fraction of the density by the response alone, if the density includes the source's spectrum.
pub(crate) const DEFENSIVE_FRACTION: f64 = 0.2;

/// Wavelength sampling of a camera's pixels.
#[derive(Clone, Copy, Debug)]
pub struct PixelDensity<'a> {
    /// Method.
    pub sampling: WavelengthSampling,
    /// The light's sources.
    pub sources: &'a SourceSpectra,
    /// Range of wavelengths, nm.
    pub range: WavelengthRange,
    /// True if a spectral cube is stored in addition to electrons.
    pub keeps_bands: bool,
}

impl PixelDensity<'_> {
    /// Density for a pixel of a given responsivity. A pixel that receives nothing from any source samples by its response; one that responds to nothing
    /// samples uniformly.
    #[must_use]
    pub fn density(&self, responsivity: &Spectrum) -> WavelengthDensity {
        let weights = match self.sampling {
            WavelengthSampling::Uniform => vec![1.0],
            WavelengthSampling::Response => self.by_response(responsivity),
            WavelengthSampling::ResponseAndSource => {
                self.by_source(responsivity).unwrap_or_else(|| self.by_response(responsivity))
            }
        };
        let weights: Vec<f32> = weights.iter().map(|weight| *weight as f32).collect();
        let WavelengthRange { low_nm, high_nm } = self.range;
        WavelengthDensity::new(&weights, low_nm as f32, high_nm as f32).expect("weights are positive and finite")
    }

    fn uniform_fraction(&self) -> f64 {
        if self.keeps_bands { UNIFORM_FRACTION_WITH_BANDS } else { UNIFORM_FRACTION }
    }

    /// Steps of the response.
    fn steps(&self) -> usize {
        (self.range.width_nm() / STEP_NM).ceil().max(1.0) as usize
    }

    /// Weights of the response's steps, with mean 1.
    fn by_response(&self, responsivity: &Spectrum) -> Vec<f64> {
        let uniform_fraction = self.uniform_fraction();
        match Means::compute(responsivity, self.range, self.steps()) {
            Some(Means { steps, mean }) => {
                steps.iter().map(|m| uniform_fraction + (1.0 - uniform_fraction) * m / mean).collect()
            }
            None => vec![1.0; self.steps()],
        }
    }

    /// Weights of the fine steps, with mean 1; `None` if the pixel receives nothing from any source.
    fn by_source(&self, responsivity: &Spectrum) -> Option<Vec<f64>> {
        let responses = self.sources.responses(responsivity, self.range);
        let response = Means::compute(responsivity, self.range, self.steps()).filter(|_| !responses.is_empty())?;
        let uniform = self.uniform_fraction() * if self.keeps_bands { 1.0 } else { DEFENSIVE_FRACTION };
        let by_response = (1.0 - self.uniform_fraction()) * DEFENSIVE_FRACTION;
        let by_source = 1.0 - uniform - by_response;
        let count = FINE_STEPS * self.steps();
        let mut weights: Vec<f64> =
            (0..count).map(|i| uniform + by_response * response.steps[i / FINE_STEPS] / response.mean).collect();
        for group in &responses {
            let light = Means::compute(&group.product, self.range, count)?;
            let add = |(weight, m): (&mut f64, f64)| *weight += by_source * group.weight * m / light.mean;
            weights.iter_mut().zip(light.steps).for_each(add);
        }
        Some(weights)
    }
}

/// Means of a spectrum over equal steps of a range, and over the whole range.
struct Means {
    steps: Vec<f64>,
    mean: f64,
}

impl Means {
    /// `None` if the spectrum is zero in the range.
    fn compute(spectrum: &Spectrum, range: WavelengthRange, count: usize) -> Option<Self> {
        let WavelengthRange { low_nm, high_nm } = range;
        let count_f = count as f64;
        let edge = |i: f64| low_nm + (high_nm - low_nm) * i / count_f;
        let steps: Vec<f64> = (0..count).map(|i| spectrum.band_mean(edge(i as f64), edge(i as f64 + 1.0))).collect();
        let mean = steps.iter().sum::<f64>() / count_f;
        (mean > 0.0).then_some(Self { steps, mean })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGE: WavelengthRange = WavelengthRange::new(400.0, 700.0);

    fn between(low_nm: f64, high_nm: f64) -> Spectrum {
        Spectrum::from_fn(|nm| if (low_nm..=high_nm).contains(&nm) { 2.0 } else { 0.0 })
    }

    fn density(
        sampling: WavelengthSampling,
        keeps_bands: bool,
        sources: &[Spectrum],
        response: &Spectrum,
    ) -> WavelengthDensity {
        let sources = &SourceSpectra::from_fluxes(sources.to_vec());
        PixelDensity { sampling, sources, range: RANGE, keeps_bands }.density(response)
    }

    #[test]
    fn wavelengths_are_sampled_where_a_pixel_responds_and_a_few_everywhere() {
        let density = density(WavelengthSampling::Response, true, &[], &between(500.0, 600.0));
        let (inside, outside) = (300.0 * density.pdf(550.0), 300.0 * density.pdf(430.0));
        // A third of the range has half of the density, in addition to a uniform half.
        assert!((inside - (0.5 + 0.5 * 3.0)).abs() < 0.05 && (outside - 0.5).abs() < 0.01, "{inside} {outside}");
    }

    #[test]
    fn a_pixel_without_response_samples_uniformly() {
        for sampling in
            [WavelengthSampling::Uniform, WavelengthSampling::Response, WavelengthSampling::ResponseAndSource]
        {
            let density = density(sampling, false, &[between(500.0, 600.0)], &Spectrum::constant(0.0));
            assert!((300.0 * density.pdf(490.0) - 1.0).abs() < 1e-5);
        }
    }

    /// The bound that the module's documentation derives.
    #[test]
    fn the_density_with_the_source_is_nowhere_below_its_share_of_the_one_without() {
        let lamp = [between(589.0, 590.0), between(430.0, 470.0).scaled(1e-3)];
        for (keeps_bands, response) in [(false, between(420.0, 610.0)), (true, Spectrum::constant(0.3))] {
            let [with, without] = [WavelengthSampling::ResponseAndSource, WavelengthSampling::Response]
                .map(|sampling| density(sampling, keeps_bands, &lamp, &response));
            let mut sum = 0.0;
            for i in 0..3000 {
                let nm = 400.05 + 0.1 * i as f32;
                // Fractions are rounded to 2⁻²⁴; for a step of 1 nm with a fraction of 3e-5 that is 1e-3.
                assert!(with.pdf(nm) >= 0.997 * DEFENSIVE_FRACTION as f32 * without.pdf(nm), "{nm}");
                sum += 0.1 * f64::from(with.pdf(nm));
            }
            assert!((sum - 1.0).abs() < 1e-3, "{sum}");
            // Most samples are at the lamp's line.
            let line: f32 = (0..30).map(|i| 0.1 * with.pdf(588.05 + 0.1 * i as f32)).sum();
            assert!(line > if keeps_bands { 0.3 } else { 0.6 }, "{line}");
        }
    }
}
