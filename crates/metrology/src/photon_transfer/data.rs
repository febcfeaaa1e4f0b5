//! Sorted light levels, and the points that the standard's fits use.
//!
//! DSNU and PRNU.
//!
//! ```text
//! DSNU = s_dark/K                                    e⁻
//! PRNU = √(s_50² − s_dark²)/(μ_50 − μ_dark)          of the mean, both parts of rows, columns and pixels
//! ```
//!
//! (EMVA 1288 release 4.0 linear, section on spatial nonuniformity; stacks of L frames without light and at 50 % of saturation.)

use super::spatial::{Pattern, VarianceComponents};
use super::{LevelStatistics, TransferError};
use crate::Estimate;
use crate::estimate::{propagate, root};

/// One light level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Exposure time, s.
    pub exposure_s: f64,
    /// Photons per pixel; 0 without light.
    pub photons: f64,
    /// Statistics of its frames.
    pub statistics: LevelStatistics,
}

/// All levels of a measurement, in order of their light, each with its dark level.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferData {
    bright: Vec<Level>,
    dark: Vec<Level>,
    /// Index of the dark level with the same exposure time, for each bright level.
    dark_of: Vec<usize>,
    saturation: usize,
    saturation_reached: bool,
}

impl TransferData {
    /// Sorts levels and finds the saturation point: the level of largest temporal variance, searched downwards from the brightest
    /// until the variance has decreased over two levels (a single dip is noise), EMVA 1288, section 6.6. Levels with less than half
    /// of the largest variance are fully saturated, and dips among them do not end the search.
    ///
    /// # Errors
    /// If an exposure time has no dark level, light is not a positive number, or fewer than three levels are below 70 % of
    /// saturation.
    pub fn new(levels: &[Level]) -> Result<Self, TransferError> {
        if let Some(level) = levels.iter().find(|l| !(l.photons >= 0.0 && l.photons.is_finite())) {
            return Err(TransferError::Light(level.photons));
        }
        let (mut dark, mut bright): (Vec<Level>, Vec<Level>) = levels.iter().partition(|l| l.photons == 0.0);
        dark.sort_by(|a, b| a.exposure_s.total_cmp(&b.exposure_s));
        let dark: Vec<Level> = dark.chunk_by(|a, b| a.exposure_s == b.exposure_s).map(pooled).collect();
        bright.sort_by(|a, b| a.photons.total_cmp(&b.photons).then(a.exposure_s.total_cmp(&b.exposure_s)));
        let find = |level: &Level| {
            let exposure_s = level.exposure_s;
            dark.iter().position(|d| d.exposure_s == exposure_s).ok_or(TransferError::NoDark { exposure_s })
        };
        let dark_of = bright.iter().map(find).collect::<Result<Vec<_>, _>>()?;
        if bright.len() < 3 {
            return Err(TransferError::TooFewLevels { levels: bright.len() });
        }
        let saturation = saturation(&bright);
        let saturation_reached = saturation + 1 < bright.len();
        let data = Self { bright, dark, dark_of, saturation, saturation_reached };
        data.check()?;
        Ok(data)
    }

    fn check(&self) -> Result<(), TransferError> {
        if self.signal_dn(self.saturation) <= 0.0 {
            return Err(TransferError::NoResponse);
        }
        let levels = self.sensitivity_end();
        if levels < 3 { Err(TransferError::TooFewLevels { levels }) } else { Ok(()) }
    }

    /// Levels with light, dimmest first.
    #[must_use]
    pub fn bright(&self) -> &[Level] {
        &self.bright
    }

    /// Levels without light, shortest exposure first; those of one exposure time are merged.
    #[must_use]
    pub fn dark(&self) -> &[Level] {
        &self.dark
    }

    /// The dark level of a bright one.
    #[must_use]
    pub fn dark_of(&self, level: usize) -> &Level {
        &self.dark[self.dark_of[level]]
    }

    pub(super) fn dark_index(&self, level: usize) -> usize {
        self.dark_of[level]
    }

    /// Index of the saturation point.
    #[must_use]
    pub fn saturation(&self) -> usize {
        self.saturation
    }

    /// True if the variance decreases beyond the saturation point. Otherwise saturation is at or above the brightest level, and
    /// capacity and dynamic range are lower bounds.
    #[must_use]
    pub fn saturation_reached(&self) -> bool {
        self.saturation_reached
    }

    /// Mean less dark mean, DN.
    #[must_use]
    pub fn signal_dn(&self, level: usize) -> f64 {
        self.bright[level].statistics.mean_dn.value - self.dark_of(level).statistics.mean_dn.value
    }

    /// Number of levels from the dimmest to the last one up to 70 % of saturation: those of the fits for K and R.
    #[must_use]
    pub fn sensitivity_end(&self) -> usize {
        self.last_up_to(0.7) + 1
    }

    /// Levels from 5 % to 95 % of saturation: those of the linearity fit.
    #[must_use]
    pub fn linearity_range(&self) -> core::ops::Range<usize> {
        let min_signal = 0.05 * self.signal_dn(self.saturation);
        let first = (0..self.bright.len()).find(|i| self.signal_dn(*i) >= min_signal).unwrap_or(0);
        first..self.last_up_to(0.95) + 1
    }

    fn last_up_to(&self, fraction: f64) -> usize {
        let max_signal = fraction * self.signal_dn(self.saturation);
        (0..self.bright.len()).rev().find(|i| self.signal_dn(*i) <= max_signal).unwrap_or(0)
    }

    /// Light at the saturation point. The variance increases with the light up to saturation and decreases steeply beyond, so the
    /// level of largest variance is usually the last one before it. For levels a few standard deviations of the charge apart, the
    /// true maximum is uniformly distributed from 0.15 of a step below the level to 0.85 above (wells that clip a Gaussian, steps
    /// of 3 to 16 standard deviations). ± 0.82 of a step contains 95 % of that, so the standard uncertainty is 0.42 of a step. If
    /// the brightest level is the point itself, the step before it is used instead of the next one.
    pub(super) fn saturation_photons(&self) -> Estimate {
        let last = self.bright.len() - 1;
        let above = (self.saturation + 1).min(last);
        let width = self.bright[above].photons - self.bright[above - 1].photons;
        Estimate::new(self.bright[self.saturation].photons, 0.42 * width)
    }
}

/// Merges levels without light at one exposure time: they give no information on the growth of the dark signal with time.
fn pooled(levels: &[Level]) -> Level {
    let count = levels.len() as f64;
    let mean = |statistic: fn(&LevelStatistics) -> Estimate| {
        let all = || levels.iter().map(|level| statistic(&level.statistics));
        let squares = all().map(|e| e.standard_uncertainty * e.standard_uncertainty).sum::<f64>();
        Estimate::new(all().map(|e| e.value).sum::<f64>() / count, squares.sqrt() / count)
    };
    let statistics = LevelStatistics { mean_dn: mean(|s| s.mean_dn), variance_dn2: mean(|s| s.variance_dn2) };
    Level { statistics, ..levels[0] }
}

fn saturation(bright: &[Level]) -> usize {
    let variance = |i: usize| bright[i].statistics.variance_dn2.value;
    let largest = (0..bright.len()).map(variance).fold(0.0, f64::max);
    let mut best = bright.len() - 1;
    for i in (0..best).rev() {
        let falls = i == 0 || variance(i - 1) < variance(best);
        if variance(i) > variance(best) {
            best = i;
        } else if falls && variance(best) >= 0.5 * largest {
            break;
        }
    }
    best
}

/// Fixed patterns of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nonuniformity {
    /// Dark signal nonuniformity, e⁻.
    pub dsnu_e: VarianceComponents<Estimate>,
    /// Dark signal nonuniformity, DN.
    pub dsnu_dn: VarianceComponents<Estimate>,
    /// Photo response nonuniformity, relative to the mean.
    pub prnu: VarianceComponents<Estimate>,
    /// Temporal row noise in the dark, DN (not a figure of the standard).
    pub row_noise_dn: f64,
    /// Temporal column noise in the dark, DN (not a figure of the standard).
    pub column_noise_dn: f64,
}

/// DSNU and PRNU from stacks without light and at about half of saturation.
///
/// # Errors
/// If the bright stack is saturated or no brighter than the dark one.
pub fn nonuniformity(
    dark: &Pattern,
    bright: &Pattern,
    gain_dn_per_e: Estimate,
    data: &TransferData,
) -> Result<Nonuniformity, TransferError> {
    let saturation_dn = data.bright()[data.saturation()].statistics.mean_dn.value;
    let mean_dn = bright.mean_dn.value;
    if data.saturation_reached() && mean_dn >= saturation_dn {
        return Err(TransferError::SaturatedStack { mean_dn, saturation_dn });
    }
    if mean_dn <= dark.mean_dn.value {
        return Err(TransferError::NotBrighter);
    }
    let quotient = |a: Estimate, b: Estimate| propagate(&[a, b], |x| [x[0] / x[1]])[0];
    let [signal] = propagate(&[bright.mean_dn, dark.mean_dn], |x| [x[0] - x[1]]);
    let dsnu_dn = dark.variances_dn2().map(root);
    let (row, column) = dark.shared_temporal_dn2();
    Ok(Nonuniformity {
        dsnu_dn,
        dsnu_e: dsnu_dn.map(|s| quotient(s, gain_dn_per_e)),
        prnu: bright.without_dark(dark).map(|s| quotient(root(s), signal)),
        row_noise_dn: row.sqrt(),
        column_noise_dn: column.sqrt(),
    })
}
