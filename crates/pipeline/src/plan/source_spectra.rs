//! Spectra of a scene's light sources, grouped by shape.

use etendue_core::WavelengthRange;
use etendue_spectra::Spectrum;

/// Minimum cosine of the angle between two spectra, as vectors of their values, for one group.
const MIN_COSINE: f64 = 0.9995;
/// Maximum number of groups; further sources join the most similar one.
const MAX_GROUPS: usize = 16;
/// Minimum fraction of a pixel's total response; sources below it are omitted.
const MIN_FRACTION: f64 = 1e-6;

/// Spectral fluxes of groups of sources, W·nm⁻¹.
#[derive(Clone, Debug, Default)]
pub struct SourceSpectra {
    fluxes: Vec<Spectrum>,
}

/// Response of a pixel to a group of sources.
#[derive(Clone, Debug)]
pub(crate) struct SourceResponse {
    /// Fraction of the samples for the group; those of all groups add up to 1.
    pub(crate) weight: f64,
    /// Responsivity times spectrum.
    pub(crate) product: Spectrum,
    pub(crate) integral: f64,
}

impl SourceSpectra {
    /// Groups the fluxes of all sources, W·nm⁻¹.
    #[must_use]
    pub fn from_fluxes(fluxes: Vec<Spectrum>) -> Self {
        let mut groups: Vec<Spectrum> = Vec::new();
        for flux in fluxes.into_iter().filter(|flux| flux.max_value() > 0.0) {
            let similarity = |group: &Spectrum| cosine(group, &flux);
            let nearest = (0..groups.len()).max_by(|a, b| similarity(&groups[*a]).total_cmp(&similarity(&groups[*b])));
            match nearest.filter(|i| groups.len() == MAX_GROUPS || similarity(&groups[*i]) >= MIN_COSINE) {
                Some(i) => groups[i] = sum(&groups[i], &flux),
                None => groups.push(flux),
            }
        }
        Self { fluxes: groups }
    }

    /// Returns true if there is no light.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        self.fluxes.is_empty()
    }

    /// Responses of a pixel of a given responsivity to each group over a range, nm.
    ///
    /// Samples are divided in proportion to the square root of the responses. If a group is the only light of a pixel, and spectra do not overlap, the mean
    /// square is 1/w in units of the squared mean, with w the group's fraction of the samples. If every pixel is lit by one group, with as many pixels per
    /// group as its light (c), the sum of c/w is minimal for w ∝ √c.
    pub(crate) fn responses(&self, responsivity: &Spectrum, range: WavelengthRange) -> Vec<SourceResponse> {
        let WavelengthRange { low_nm, high_nm } = range;
        let response = |flux: &Spectrum| {
            let product = responsivity.product(flux);
            let integral = product.integral(low_nm, high_nm);
            SourceResponse { weight: integral.max(0.0).sqrt(), product, integral }
        };
        let mut responses: Vec<SourceResponse> = self.fluxes.iter().map(response).collect();
        let all: f64 = responses.iter().map(|group| group.integral).sum();
        responses.retain(|group| group.integral > MIN_FRACTION * all);
        let total: f64 = responses.iter().map(|group| group.weight).sum();
        responses.iter_mut().for_each(|group| group.weight /= total);
        responses
    }
}

fn sum(a: &Spectrum, b: &Spectrum) -> Spectrum {
    Spectrum::from_fn(|nm| f64::from(a.at(nm as f32)) + f64::from(b.at(nm as f32)))
}

fn cosine(a: &Spectrum, b: &Spectrum) -> f64 {
    let dot = |a: &Spectrum, b: &Spectrum| -> f64 {
        a.nodes().iter().zip(b.nodes()).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
    };
    let (a, b) = (&unit(a), &unit(b));
    dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
}

/// The spectrum with maximum 1, so that no square overflows.
fn unit(spectrum: &Spectrum) -> Spectrum {
    spectrum.scaled(1.0 / f64::from(spectrum.max_value()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(nm: f64, height: f64) -> Spectrum {
        Spectrum::from_fn(|at| if (at - nm).abs() < 5.0 { height } else { 0.0 })
    }

    #[test]
    fn sources_of_one_shape_are_one_group_sampled_by_the_root_of_their_light() {
        let fluxes = vec![line(500.0, 1.0), line(600.0, 16.0), Spectrum::constant(0.0), line(500.0, 3.0)];
        let spectra = SourceSpectra::from_fluxes(fluxes);
        let responses = spectra.responses(&Spectrum::constant(2.0), WavelengthRange::new(400.0, 700.0));
        let weights: Vec<f64> = responses.iter().map(|group| group.weight).collect();
        // 4 and 16 parts of light: a third and two thirds of the samples.
        assert_eq!(weights.len(), 2);
        assert!((weights[0] - 1.0 / 3.0).abs() < 1e-9 && (weights[1] - 2.0 / 3.0).abs() < 1e-9, "{weights:?}");
        let blind = spectra.responses(&line(450.0, 1.0), WavelengthRange::new(400.0, 700.0));
        assert!(blind.is_empty() && !spectra.is_dark() && SourceSpectra::default().is_dark());
    }

    #[test]
    fn many_shapes_join_the_most_similar_group() {
        let fluxes: Vec<_> = (0..60).map(|i| line(400.0 + 5.0 * f64::from(i), 1e-30)).collect();
        let spectra = SourceSpectra::from_fluxes(fluxes);
        assert_eq!(spectra.fluxes.len(), MAX_GROUPS);
        let responses = spectra.responses(&Spectrum::constant(1.0), WavelengthRange::new(300.0, 1100.0));
        // 60 lines of 9 nm are all included.
        let sum: f64 = responses.iter().map(|group| group.integral).sum();
        assert!((sum / (60.0 * 9.0 * 1e-30) - 1.0).abs() < 1e-5, "{sum}");
    }
}
