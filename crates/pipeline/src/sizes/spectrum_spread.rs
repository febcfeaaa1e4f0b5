//! How the wavelengths of a pixel's samples lie over its spectrum.
//!
//! A path's N wavelengths are rotations of one number by steps of 1/N in the cumulative distribution that they are drawn by.
//! Where a spectral cube is the product, that number is taken so that all N · n wavelengths of n samples lie at equal steps:
//! every band is met as evenly as so many wavelengths can meet it. Which of the N is the hero stays a draw of the path.
//! Each wavelength alone is drawn by the density, and the sum over a path's wavelengths stays unbiased.
//!
//! Replicates that tell the variance must be independent: each is spread by itself. Where nobody asks for the variance, the
//! wavelengths of all replicates are spread together, which leaves less noise.

/// Over what wavelengths are spread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpectrumSpread {
    /// Each replicate's heroes are a stratified sequence: what pixels that fold electrons draw.
    Drawn,
    /// The wavelengths of each replicate lie at equal steps.
    EachReplicate,
    /// The wavelengths of all replicates of a pass together lie at equal steps.
    AllReplicates,
    /// The wavelengths of each replicate lie evenly however many there will be.
    Open,
}

impl SpectrumSpread {
    /// Groups of samples that are spread, each independently.
    fn groups(self, replicates: u32) -> u32 {
        if self == Self::AllReplicates { 1 } else { replicates }
    }

    /// Standard deviation of a band of an even spectrum in even light over its mean, by the choice of `wavelengths` a path
    /// alone: a part `share` of the density falls in the band. Of ⌊m⌋ or ⌈m⌉ wavelengths in the band, m their mean in a group,
    /// the variance is f (1 − f), f the fraction of m. `None` where wavelengths are drawn, or nobody knows how many there will be.
    #[must_use]
    pub fn band_noise(self, spp: u32, replicates: u32, wavelengths: u32, share: f64) -> Option<f64> {
        let (mean, groups) = self.in_band(spp, replicates, wavelengths, share)?;
        let fraction = (mean - (mean + 1e-9).floor()).max(0.0);
        Some((fraction * (1.0 - fraction) / groups).sqrt() / mean)
    }

    /// The most that [`SpectrumSpread::band_noise`] may be where at least a part `share` of the density falls in the band.
    #[must_use]
    pub fn most_band_noise(self, spp: u32, replicates: u32, wavelengths: u32, share: f64) -> Option<f64> {
        let (mean, groups) = self.in_band(spp, replicates, wavelengths, share)?;
        let fraction = mean.min(0.5);
        Some((fraction * (1.0 - fraction) / groups).sqrt() / mean)
    }

    /// Mean wavelengths of a group in a band, and the groups.
    fn in_band(self, spp: u32, replicates: u32, wavelengths: u32, share: f64) -> Option<(f64, f64)> {
        let groups = f64::from(self.groups(replicates));
        matches!(self, Self::EachReplicate | Self::AllReplicates)
            .then(|| (f64::from(spp) * f64::from(wavelengths) * share / groups, groups))
    }
}
