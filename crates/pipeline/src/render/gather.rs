//! Accumulates one pixel's samples into means with an unbiased variance.
//!
//! Samples of one replicate are summed in sample order in f64 ([`ReplicateSums`]). The replicates of a pixel are scrambled independently, so that the scatter of their
//! means is an unbiased estimate of the total variance. The scatter of the samples is not: it overstates the variance of a stratified mean by factors of ten
//! to thousands.

use crate::sizes::film::FilmLayout;
use etendue_core::{Spectral, Wavelengths};
use etendue_spectra::Spectrum;

/// Running sums of a pixel over the samples of one replicate.
#[derive(Clone, Debug)]
pub struct ReplicateSums {
    layout: FilmLayout,
    slots: Vec<f64>,
    not_finite: u32,
}

impl ReplicateSums {
    /// Empty sums.
    #[must_use]
    pub fn new(layout: FilmLayout) -> Self {
        Self { slots: vec![0.0; layout.slots()], layout, not_finite: 0 }
    }

    /// Adds one sample: `radiance` (W·m⁻²·sr⁻¹·nm⁻¹, not divided by the wavelengths' density) through a pupil of weight `weight_sr`, at a pixel of
    /// `responsivity` (e⁻ per W·m⁻²; unused if no electrons are accumulated).
    pub fn add<const N: usize>(
        &mut self,
        weight_sr: f64,
        radiance: Spectral<N>,
        wavelengths: &Wavelengths<N>,
        responsivity: Option<&Spectrum>,
    ) {
        self.not_finite += u32::from(!radiance.is_finite());
        let weight_slot = self.layout.band_count();
        self.slots[weight_slot] += weight_sr;
        for i in 0..N {
            let irradiance = weight_sr * f64::from(radiance[i]) / (f64::from(wavelengths.pdf[i]) * N as f64);
            if let Some(bands) = self.layout.bands
                && let Some(band) = bands.index_of(f64::from(wavelengths.nm[i]))
            {
                self.slots[band] += irradiance / bands.width_nm();
            }
            match responsivity {
                Some(responsivity) => {
                    self.slots[weight_slot + 1] += irradiance * f64::from(responsivity.at(wavelengths.nm[i]));
                }
                None if self.layout.watched => self.slots[weight_slot + 1] += irradiance,
                None => {}
            }
        }
    }

    /// Sum of the signal monitored by a noise limit, if any.
    #[must_use]
    pub fn watched(&self) -> f64 {
        self.slots[self.layout.watched_slot()]
    }

    /// Number of samples that were not finite. They remain in the sums, which are then not finite either.
    #[must_use]
    pub fn not_finite(&self) -> u32 {
        self.not_finite
    }
}

/// Running moments of one pixel over replicates.
#[derive(Clone, Debug)]
pub struct ReplicateMoments {
    mean: Vec<f64>,
    squares: Vec<f64>,
    replicates: u32,
}

impl ReplicateMoments {
    /// Moments of no replicates.
    #[must_use]
    pub fn new(layout: &FilmLayout) -> Self {
        let slots = layout.slots();
        Self { mean: vec![0.0; slots], squares: vec![0.0; slots], replicates: 0 }
    }

    /// Adds the sums of a replicate of `samples` samples (including those that the lens blocked), and resets them.
    pub fn end_replicate(&mut self, replicate_sums: &mut ReplicateSums, samples: u32) {
        self.replicates += 1;
        let n = f64::from(self.replicates);
        for ((sum, mean), squares) in replicate_sums.slots.iter_mut().zip(&mut self.mean).zip(&mut self.squares) {
            let value = *sum / f64::from(samples);
            let step = value - *mean;
            *mean += step / n;
            *squares += step * (value - *mean);
            *sum = 0.0;
        }
    }

    /// Light of the pixel over all replicates with `samples` samples together, of which `not_finite` were not finite.
    #[must_use]
    pub fn light(self, layout: &FilmLayout, samples: u32, not_finite: u32) -> PixelLight {
        let variances = (0..self.mean.len()).map(|slot| self.variance(slot)).collect();
        PixelLight { layout: *layout, means: self.mean, variances, samples, not_finite }
    }

    /// Variance of a mean, from the scatter of the replicates; NaN for a single replicate.
    fn variance(&self, slot: usize) -> f64 {
        if self.replicates < 2 {
            return f64::NAN;
        }
        let n = f64::from(self.replicates);
        self.squares[slot] / ((n - 1.0) * n)
    }
}

/// Converts a variance to 32 bits for storage. A value beyond their range becomes the greatest finite number, a lower bound; NaN (unknown) stays NaN.
pub(crate) fn stored_variance(value: f64) -> f32 {
    if value > f64::from(f32::MAX) { f32::MAX } else { value as f32 }
}

/// Light of one pixel: means and their variances.
#[derive(Clone, Debug)]
pub struct PixelLight {
    layout: FilmLayout,
    means: Vec<f64>,
    variances: Vec<f64>,
    samples: u32,
    not_finite: u32,
}

impl PixelLight {
    /// Light from means and variances of [`FilmLayout::slots`] values.
    pub(super) fn new(
        layout: &FilmLayout,
        means: Vec<f64>,
        variances: Vec<f64>,
        samples: u32,
        not_finite: u32,
    ) -> Self {
        Self { layout: *layout, means, variances, samples, not_finite }
    }

    /// Combines the light with the independent light of `before`: means weighted by samples, m = (n a + k b)/(n + k), with variance (n² v + k² w)/(n + k)².
    #[must_use]
    pub fn joined(mut self, before: &Self) -> Self {
        if before.samples == 0 {
            return self;
        }
        let (n, k) = (f64::from(self.samples), f64::from(before.samples));
        let (own, earlier) = (n / (n + k), k / (n + k));
        for (mean, before) in self.means.iter_mut().zip(&before.means) {
            *mean = own * *mean + earlier * before;
        }
        for (variance, before) in self.variances.iter_mut().zip(&before.variances) {
            *variance = own * own * *variance + earlier * earlier * before;
        }
        self.samples += before.samples;
        self.not_finite += before.not_finite;
        self
    }

    /// Mean band irradiances, W·m⁻²·nm⁻¹ (empty if no cube is stored).
    #[must_use]
    pub fn bands(&self) -> &[f64] {
        &self.means[..self.layout.band_count()]
    }

    /// Variances of the means of [`PixelLight::bands`]; NaN for a single replicate.
    #[must_use]
    pub fn band_variances(&self) -> &[f64] {
        &self.variances[..self.layout.band_count()]
    }

    /// Mean weight of the pupil, sr.
    #[must_use]
    pub fn weight_sr(&self) -> f64 {
        self.means[self.layout.band_count()]
    }

    /// Mean electrons and the variance of that mean; `None` if no electrons are accumulated.
    #[must_use]
    pub fn electrons(&self) -> Option<(f64, f64)> {
        let slot = self.layout.watched_slot();
        self.layout.accumulates_electrons.then(|| (self.means[slot], self.variances[slot]))
    }

    /// Mean of the signal monitored by a noise limit, and the variance of that mean; `None` without a limit.
    #[must_use]
    pub fn watched(&self) -> Option<(f64, f64)> {
        let slot = self.layout.watched_slot();
        self.layout.watched.then(|| (self.means[slot], self.variances[slot]))
    }

    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Number of samples that were not finite. They remain in the means, which are then not finite either.
    #[must_use]
    pub fn not_finite(&self) -> u32 {
        self.not_finite
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::Bands;

    #[test]
    fn a_constant_radiance_gives_its_band_means_and_electrons() {
        let bands = Bands::covering(400.0, 700.0, 100.0).expect("three bands");
        let layout = FilmLayout { bands: Some(bands), accumulates_electrons: true, watched: false };
        let (mut replicate_sums, mut gather) = (ReplicateSums::new(layout), ReplicateMoments::new(&layout));
        let responsivity = Spectrum::constant(2.0);
        for replicate in 0..2 {
            for sample in 0..48 {
                let u = (f64::from(sample) + 0.25 + 0.5 * f64::from(replicate)) / 48.0;
                let wavelengths = Wavelengths::<4>::uniform(400.0, 700.0, u as f32);
                replicate_sums.add(0.5, Spectral::splat(3.0), &wavelengths, Some(&responsivity));
            }
            gather.end_replicate(&mut replicate_sums, 48);
        }
        let light = gather.light(&layout, 96, 0);
        for band in light.bands() {
            assert!((band - 1.5).abs() < 1e-6, "E = weight × L = 1.5, not {band}");
        }
        let (electrons, variance) = light.electrons().expect("folded");
        assert!((electrons - 1.5 * 300.0 * 2.0).abs() < 1e-3, "{electrons}");
        assert!(variance < 1e-6 && (light.weight_sr() - 0.5).abs() < 1e-15);
    }

    #[test]
    fn variance_is_that_of_the_replicate_means() {
        let layout = FilmLayout { bands: None, accumulates_electrons: true, watched: false };
        let (mut replicate_sums, mut gather) = (ReplicateSums::new(layout), ReplicateMoments::new(&layout));
        let one = Spectrum::constant(1.0);
        for value in [1.0, 3.0] {
            let wavelengths = Wavelengths::<1>::uniform(500.0, 501.0, 0.5);
            replicate_sums.add(1.0, Spectral::splat(value), &wavelengths, Some(&one));
            gather.end_replicate(&mut replicate_sums, 1);
        }
        let (mean, variance) = gather.light(&layout, 2, 0).electrons().expect("folded");
        assert_eq!((mean, variance), (2.0, 1.0), "s² = 2 of two means, over two");
    }

    #[test]
    fn a_sample_that_is_not_finite_is_counted_and_shows() {
        let layout = FilmLayout { bands: None, accumulates_electrons: true, watched: false };
        let (mut replicate_sums, mut gather) = (ReplicateSums::new(layout), ReplicateMoments::new(&layout));
        let wavelengths = Wavelengths::<1>::uniform(500.0, 501.0, 0.5);
        replicate_sums.add(1.0, Spectral::splat(f32::NAN), &wavelengths, Some(&Spectrum::constant(1.0)));
        gather.end_replicate(&mut replicate_sums, 1);
        let light = gather.light(&layout, 1, replicate_sums.not_finite());
        assert_eq!(light.not_finite(), 1);
        assert!(light.electrons().is_some_and(|(mean, _)| mean.is_nan()));
    }

    /// Two replicates of 10³⁰ and 3 · 10³⁰: the mean is within the range of 32 bits, its variance of 10⁶⁰ is not.
    #[test]
    fn a_stored_variance_is_never_infinite() {
        use crate::render::film::Film;
        use etendue_core::random::Pixel;
        let bands = Bands::covering(500.0, 501.0, 1.0);
        let layout = FilmLayout { bands, accumulates_electrons: true, watched: false };
        let (mut replicate_sums, mut gather) = (ReplicateSums::new(layout), ReplicateMoments::new(&layout));
        for value in [1e30, 3e30] {
            let wavelengths = Wavelengths::<1>::uniform(500.0, 501.0, 0.5);
            replicate_sums.add(1.0, Spectral::splat(value), &wavelengths, Some(&Spectrum::constant(1.0)));
            gather.end_replicate(&mut replicate_sums, 1);
        }
        let light = gather.light(&layout, 2, 0);
        let mut film = Film::new(1, 1, &layout, 2);
        film.store(Pixel { x: 0, y: 0 }, &light);
        assert_eq!(film.not_finite_samples(), 0, "the means are finite");
        let exposed = film.electron_rate.as_ref().map(|rate| rate.electrons(2.0)).expect("folded");
        let cube = film.cube().expect("a band");
        let variances = [cube.variance.planes()[0].at(0, 0), exposed.variance.at(0, 0)];
        assert_eq!(variances, [f32::MAX; 2]);
        assert!((exposed.mean.at(0, 0) / 4e30 - 1.0).abs() < 1e-6 && cube.mean.planes()[0].at(0, 0).is_finite());
    }
}
