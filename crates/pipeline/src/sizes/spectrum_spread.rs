//! Distribution of the wavelengths of a pixel's samples over its spectrum.
//!
//! A path's N wavelengths are rotations of one number by steps of 1/N in their cumulative distribution. If the product is a spectral cube, that number is
//! chosen so that all N · n wavelengths of n samples are equidistant: bands are covered as uniformly as this number of wavelengths allows. The hero
//! wavelength among the N remains a random choice of the path. Each wavelength alone follows the density, and the sum over a path's wavelengths remains
//! unbiased.
//!
//! Replicates that estimate the variance must be independent: each is spread by itself. If the variance is not requested, the wavelengths of all replicates
//! are spread together, which leaves less noise.

/// Set of samples over which wavelengths are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpectrumSpread {
    /// Each replicate's hero wavelengths are a stratified sequence; used by pixels that accumulate electrons.
    Drawn,
    /// The wavelengths of each replicate are equidistant.
    EachReplicate,
    /// The wavelengths of all replicates of a pass together are equidistant.
    AllReplicates,
    /// The wavelengths of each replicate are evenly distributed for any number of samples.
    Open,
}

impl SpectrumSpread {
    /// Number of groups of samples that are spread independently.
    fn groups(self, replicates: u32) -> u32 {
        if self == Self::AllReplicates { 1 } else { replicates }
    }

    /// Standard deviation over mean, from the choice of `wavelengths` per path alone, of a band of a uniform spectrum in uniform light; the fraction `share`
    /// of the density falls in the band. With ⌊m⌋ or ⌈m⌉ wavelengths in the band, m their mean in a group, the variance is f (1 − f), f the fractional part
    /// of m. `None` if wavelengths are sampled independently, or their number is unknown.
    #[must_use]
    pub fn band_noise(self, spp: u32, replicates: u32, wavelengths: u32, band_fraction: f64) -> Option<f64> {
        let (mean, groups) = self.samples_in_band(spp, replicates, wavelengths, band_fraction)?;
        let fraction = (mean - (mean + 1e-9).floor()).max(0.0);
        Some((fraction * (1.0 - fraction) / groups).sqrt() / mean)
    }

    /// Maximum of [`SpectrumSpread::band_noise`] if at least the fraction `share` of the density falls in the band.
    #[must_use]
    pub fn max_band_noise(self, spp: u32, replicates: u32, wavelengths: u32, band_fraction: f64) -> Option<f64> {
        let (mean, groups) = self.samples_in_band(spp, replicates, wavelengths, band_fraction)?;
        let fraction = mean.min(0.5);
        Some((fraction * (1.0 - fraction) / groups).sqrt() / mean)
    }

    /// Mean number of wavelengths of a group in a band, and the number of groups.
    fn samples_in_band(self, spp: u32, replicates: u32, wavelengths: u32, band_fraction: f64) -> Option<(f64, f64)> {
        let groups = f64::from(self.groups(replicates));
        matches!(self, Self::EachReplicate | Self::AllReplicates)
            .then(|| (f64::from(spp) * f64::from(wavelengths) * band_fraction / groups, groups))
    }
}
