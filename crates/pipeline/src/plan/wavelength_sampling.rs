//! By which density the wavelengths of pixels that sum electrons are drawn, and what that is foretold to save.

/// By which density wavelengths are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WavelengthSampling {
    /// Evenly over the range.
    Uniform,
    /// By the pixel's response.
    Response,
    /// By the pixel's response times the spectra of the light's sources.
    ResponseAndSource,
}

impl WavelengthSampling {
    /// The word for it in descriptions and reports.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Response => "response",
            Self::ResponseAndSource => "response_and_source",
        }
    }
}

/// What the source's spectrum in the density is foretold to do: mean squares of a sample's electrons by the response alone over those with
/// the source's spectrum. Where the samples of a pixel differ much by where their paths go, the variances of its mean have this ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralGain {
    /// Geometric mean over the pixels of the colour filter's tile, the groups of sources by their shares of the draws, and four surfaces (grey, red,
    /// green, blue).
    pub mean: f64,
    /// The least of them.
    pub least: f64,
    /// The greatest of them.
    pub most: f64,
}

/// Least mean gain for which the density follows the source.
const WORTHWHILE: f64 = 1.02;

impl SpectralGain {
    /// Whether it pays: samples are worth more in the mean, and by more than they may lose anywhere.
    #[must_use]
    pub fn pays(&self) -> bool {
        self.mean >= WORTHWHILE && self.mean * self.least >= 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gain_pays_where_it_is_felt_and_outweighs_the_worst_loss() {
        let gain = |mean, least| SpectralGain { mean, least, most: 10.0 };
        assert!(gain(1.05, 0.98).pays() && gain(2.0, 0.6).pays());
        assert!(!gain(1.01, 1.0).pays() && !gain(1.05, 0.9).pays());
    }
}
