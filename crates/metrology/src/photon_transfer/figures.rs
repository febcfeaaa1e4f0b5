//! Figures of a photon transfer measurement.
//!
//! With x = μ_y − μ_y.dark and the levels up to 70 % of saturation (EMVA 1288 release 3.1 and 4.0 linear, sections 6.4–6.7, 7):
//!
//! ```text
//! K = Σ x (σ_y² − σ_y.dark²)/Σ x²     R = Σ μ_p x/Σ μ_p²      η = R/K
//! σ_y.dark²: intercept over exposure time (or of the one exposure), at least 0.24 DN²
//! σ_d = √(σ_y.dark² − 1/12)/K         μ_p.min = (σ_y.dark/K + 1/2)/η
//! μ_e.sat = η μ_p.sat   SNR_max = √μ_e.sat   DR = μ_p.sat/μ_p.min
//! linearity: y = a μ_p + b over 5…95 %, weights 1/x²; δ = (x − y)/y; LE = ⟨|δ|⟩
//! dark current: slope over exposure time of μ_y.dark (over K) and of σ_y.dark² (over K²)
//! ```
//!
//! Standard uncertainties: the law of propagation through every mean and variance of every level, bright and dark, and the
//! spacing of levels near saturation, for a fixed choice of levels. The linearity error and its extremes have none: a mean of
//! magnitudes and extremes of noisy numbers are never 0, even for a linear sensor. The error of a linear sensor due to noise
//! alone, √(2/π) times the mean standard uncertainty of the deviations, is reported with them. The covariance of a level's mean
//! with its variance (skewness of the shot noise) is neglected: it is below a per cent of either. η, μ_p.min and μ_p.sat exclude
//! the uncertainty of the photon scale itself: add that of the light's calibration.

use super::{TransferData, TransferError};
use crate::Estimate;
use crate::estimate::{propagate, propagate_curved};

/// Quantisation noise, DN².
const QUANTISATION_DN2: f64 = 1.0 / 12.0;
/// Minimum dark variance of the standard, DN²: below it quantisation dominates.
const MIN_DARK_VARIANCE_DN2: f64 = 0.24;

/// Results of a photon transfer curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Overall system gain K, DN/e⁻.
    pub gain_dn_per_e: Estimate,
    /// Responsivity R, DN per photon.
    pub responsivity_dn_per_photon: Estimate,
    /// Quantum efficiency η.
    pub quantum_efficiency: Estimate,
    /// Temporal dark noise σ_y.dark at zero exposure time, DN.
    pub dark_noise_dn: Estimate,
    /// Temporal dark noise σ_d, e⁻.
    pub dark_noise_e: Estimate,
    /// Absolute sensitivity threshold μ_p.min, photons.
    pub threshold_photons: Estimate,
    /// Sensitivity threshold μ_e.min, e⁻.
    pub threshold_e: Estimate,
    /// Light at saturation μ_p.sat, photons.
    pub saturation_photons: Estimate,
    /// Saturation capacity μ_e.sat, e⁻.
    pub saturation_e: Estimate,
    /// Largest signal-to-noise ratio.
    pub snr_max: Estimate,
    /// Dynamic range μ_p.sat/μ_p.min.
    pub dynamic_range: Estimate,
    /// Mean of the magnitudes of relative deviations from the straight line, 5…95 % of saturation.
    pub linearity_error: f64,
    /// Expected value of the same for a linear sensor with the noise of its levels.
    pub linearity_error_of_noise: f64,
    /// Most negative relative deviation.
    pub linearity_error_min: f64,
    /// Most positive relative deviation.
    pub linearity_error_max: f64,
    /// Dark mean at zero exposure time, DN.
    pub dark_level_dn: Estimate,
    /// Dark current from the dark mean, e⁻/s; `None` for fewer than three exposure times.
    pub dark_current_mean_e_per_s: Option<Estimate>,
    /// Dark current from the dark variance, e⁻/s; `None` for fewer than three exposure times.
    pub dark_current_variance_e_per_s: Option<Estimate>,
}

/// A level's signal-to-noise ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnrPoint {
    /// Photons per pixel.
    pub photons: f64,
    /// Signal over temporal noise.
    pub snr: Estimate,
}

impl TransferData {
    /// Computes the figures of the standard.
    ///
    /// # Errors
    /// If readings do not increase with light, or their variance not with the signal.
    pub fn figures(&self) -> Result<Figures, TransferError> {
        let inputs = self.inputs();
        let values = |x: &[f64]| Values::new(self, x).figures();
        let [gain, responsivity] = { [values(&at(&inputs))[0], values(&at(&inputs))[1]] };
        if gain.is_nan() || gain <= 0.0 {
            return Err(TransferError::NoShotNoise);
        }
        if responsivity.is_nan() || responsivity <= 0.0 {
            return Err(TransferError::NoResponse);
        }
        let figures = propagate(&inputs, values);
        let current = |figure: Estimate| (self.dark().len() >= 3).then_some(figure);
        let [k, r, eta, sd_dn, sd, pmin, emin, psat, esat, snr, dr, level, mean, variance] = figures;
        let [error, min_error, max_error] = Values::new(self, &at(&inputs)).linearity();
        Ok(Figures {
            gain_dn_per_e: k,
            responsivity_dn_per_photon: r,
            quantum_efficiency: eta,
            dark_noise_dn: sd_dn,
            dark_noise_e: sd,
            threshold_photons: pmin,
            threshold_e: emin,
            saturation_photons: psat,
            saturation_e: esat,
            snr_max: snr,
            dynamic_range: dr,
            linearity_error: error,
            linearity_error_of_noise: self.linearity_noise(&inputs),
            linearity_error_min: min_error,
            linearity_error_max: max_error,
            dark_level_dn: level,
            dark_current_mean_e_per_s: current(mean),
            dark_current_variance_e_per_s: current(variance),
        })
    }

    /// Signal over temporal noise of every light level.
    #[must_use]
    pub fn snr(&self) -> Vec<SnrPoint> {
        let point = |i: usize| {
            let (bright, dark) = (self.bright()[i].statistics, self.dark_of(i).statistics);
            let inputs = [bright.mean_dn, dark.mean_dn, bright.variance_dn2];
            let [snr] = propagate(&inputs, |x| [(x[0] - x[1]) / x[2].max(0.0).sqrt()]);
            SnrPoint { photons: self.bright()[i].photons, snr }
        };
        (0..self.bright().len()).map(point).collect()
    }

    /// (mean, variance) of each bright level, then of each dark one, then the light at saturation.
    fn inputs(&self) -> Vec<Estimate> {
        let levels = self.bright().iter().chain(self.dark());
        let pairs = levels.flat_map(|l| [l.statistics.mean_dn, l.statistics.variance_dn2]);
        pairs.chain([self.saturation_photons()]).collect()
    }

    /// √(2/π) times the mean standard uncertainty of the deviations: the expected mean magnitude due to noise.
    fn linearity_noise(&self, inputs: &[Estimate]) -> f64 {
        let range = self.linearity_range();
        let deviations = propagate_curved(inputs, |x| Values::new(self, x).deviations(range.clone()));
        let sum: f64 = deviations.iter().map(|d| d.first_order.standard_uncertainty).sum();
        core::f64::consts::FRAC_2_PI.sqrt() * sum / deviations.len() as f64
    }

    /// Relative deviation of each level from the straight line of the linearity fit.
    #[must_use]
    pub fn linearity_deviations(&self) -> Vec<f64> {
        Values::new(self, &at(&self.inputs())).deviations(0..self.bright().len())
    }
}

/// The signal-to-noise ratio of the linear model for μ_e electrons, with dark noise σ_d (e⁻) and gain K; with DSNU (e⁻) and PRNU
/// it is the total one.
#[must_use]
pub fn model_snr(electrons: f64, dark_noise_e: f64, gain_dn_per_e: f64, dsnu_e: f64, prnu: f64) -> f64 {
    let quantisation = QUANTISATION_DN2 / (gain_dn_per_e * gain_dn_per_e);
    let fixed = dsnu_e * dsnu_e + prnu * prnu * electrons * electrons;
    electrons / (dark_noise_e * dark_noise_e + quantisation + electrons + fixed).sqrt()
}

fn at(inputs: &[Estimate]) -> Vec<f64> {
    inputs.iter().map(|input| input.value).collect()
}

/// The figures' formulas on one set of inputs.
struct Values<'a> {
    data: &'a TransferData,
    x: &'a [f64],
}

impl<'a> Values<'a> {
    fn new(data: &'a TransferData, x: &'a [f64]) -> Self {
        Self { data, x }
    }

    fn dark(&self, j: usize) -> (f64, f64) {
        let at = 2 * (self.data.bright().len() + j);
        (self.x[at], self.x[at + 1])
    }

    /// (photons, mean less dark mean, variance less dark variance).
    fn point(&self, i: usize) -> (f64, f64, f64) {
        let (mean, variance) = self.dark(self.data.dark_index(i));
        (self.data.bright()[i].photons, self.x[2 * i] - mean, self.x[2 * i + 1] - variance)
    }

    fn figures(&self) -> [f64; 14] {
        let end = self.data.sensitivity_end();
        let k = through_zero((0..end).map(|i| (self.point(i).1, self.point(i).2)));
        let r = through_zero((0..end).map(|i| (self.point(i).0, self.point(i).1)));
        let eta = r / k;
        let (level, mean_slope, variance, variance_slope) = self.dark_lines();
        let variance = variance.max(MIN_DARK_VARIANCE_DN2);
        let dark_e = (variance - QUANTISATION_DN2).sqrt() / k;
        let emin = variance.sqrt() / k + 0.5;
        let psat = self.x[self.x.len() - 1];
        let esat = eta * psat;
        [
            k,
            r,
            eta,
            variance.sqrt(),
            dark_e,
            emin / eta,
            emin,
            psat,
            esat,
            esat.sqrt(),
            esat / emin,
            level,
            mean_slope / k,
            variance_slope / (k * k),
        ]
    }

    /// Intercept and slope over exposure time of the dark means and of the dark variances; for fewer than three times the values at
    /// the shortest.
    fn dark_lines(&self) -> (f64, f64, f64, f64) {
        let levels = self.data.dark();
        if levels.len() < 3 {
            let (mean, variance) = self.dark(0);
            return (mean, 0.0, variance, 0.0);
        }
        let line = |value: fn((f64, f64)) -> f64| {
            straight_line(levels.iter().enumerate().map(|(j, l)| (l.exposure_s, value(self.dark(j)), 1.0)))
        };
        let ((level, mean_slope), (variance, variance_slope)) = (line(|d| d.0), line(|d| d.1));
        (level, mean_slope, variance, variance_slope)
    }

    fn deviations(&self, levels: core::ops::Range<usize>) -> Vec<f64> {
        let fit = self.data.linearity_range().map(|i| self.point(i)).map(|(p, y, _)| (p, y, 1.0 / (y * y)));
        let (offset, slope) = straight_line(fit);
        levels.map(|i| self.point(i)).map(|(p, y, _)| y / (offset + slope * p) - 1.0).collect()
    }

    fn linearity(&self) -> [f64; 3] {
        let deviations = self.deviations(self.data.linearity_range());
        let mean = deviations.iter().map(|d| d.abs()).sum::<f64>() / deviations.len() as f64;
        let extreme = |f: fn(f64, f64) -> f64| deviations.iter().copied().reduce(f).unwrap_or(f64::NAN);
        [mean, extreme(f64::min), extreme(f64::max)]
    }
}

/// Slope of the least-squares line through the origin.
fn through_zero(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (xy, xx) = points.fold((0.0, 0.0), |(xy, xx), (x, y)| (xy + x * y, xx + x * x));
    xy / xx
}

/// (offset, slope) of the weighted least-squares line through (x, y, weight).
fn straight_line(points: impl Iterator<Item = (f64, f64, f64)> + Clone) -> (f64, f64) {
    let sum = |f: fn((f64, f64, f64)) -> f64| points.clone().map(f).sum::<f64>();
    let weight = sum(|p| p.2);
    let (x, y) = (sum(|p| p.0 * p.2) / weight, sum(|p| p.1 * p.2) / weight);
    let (xy, xx) = points
        .clone()
        .fold((0.0, 0.0), |(xy, xx), p| (xy + p.2 * (p.0 - x) * (p.1 - y), xx + p.2 * (p.0 - x) * (p.0 - x)));
    let slope = xy / xx;
    (y - slope * x, slope)
}
