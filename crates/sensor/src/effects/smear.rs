//! Smear of a CCD: light collected by charge while it is moved down its column.
//!
//! Every row that a charge packet passes adds ε rate(x, y) t_line. Under constant light the total is the same for the whole column:
//!
//! S(x) = ε t_line Σ_y μ(x, y) / t_exp, added to the mean of every pixel of the column, dark rows included.
//!
//! - Interline: ε is a leak into the covered register, from the smear figure of the data sheet (dB, a spot of one tenth of the
//!   image's height): ε = 10 · 10^(Sm/20) · (t_acc/t_frame of that measurement); t_line = frame period / rows.
//! - Frame transfer: the rows pass the open pixels, ε = 1, t_line = the time of one fast shift.
//!
//! S is added to the mean before counting, so it has its own shot noise: a sum of Poisson counts is a Poisson count.
//! Left out: light that changes during the frame; blooming into the register.

use etendue_core::{EffectStatus, Plane, maths::f64::pow, quantity::MeanElectrons};
use rayon::prelude::*;

use crate::effect::{Action, Context, Effect, Memory, PlaneEffect, QuantityEffect, SensorFacts, Traces};
use crate::{capture::Operation, check::Checks, signal_breakdown::SignalComponent};

/// Transfer of charge past the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smear {
    /// Down a covered register next to the pixels.
    Interline {
        /// The data sheet's figure, dB: below 0.
        smear_db: f64,
        /// Accumulation time over frame time of the data sheet's measurement, (0, 1].
        measured_exposure_ratio: f64,
    },
    /// Through the pixels themselves, fast.
    FrameTransfer {
        /// Time of a shift by one row, s.
        line_shift_s: f64,
    },
}

impl Smear {
    /// The time for which charge passes one of this number of rows, s.
    fn line_s(&self, frame_period_s: Option<f64>, rows: usize) -> f64 {
        match *self {
            Self::Interline { .. } => frame_period_s.expect("checked with the parameters") / rows as f64,
            Self::FrameTransfer { line_shift_s } => line_shift_s,
        }
    }

    /// The exposure, s, that smear adds to every pixel of a uniformly and steadily lit image of this number of lit rows among `rows`.
    pub(crate) fn uniform_smear_s(&self, frame_period_s: Option<f64>, lit_rows: usize, rows: usize) -> f64 {
        self.leak() * self.line_s(frame_period_s, rows) * lit_rows as f64
    }

    /// The fraction ε of the light collected by passing charge.
    #[must_use]
    pub fn leak(&self) -> f64 {
        match *self {
            Self::Interline { smear_db, measured_exposure_ratio } => {
                10.0 * pow(10.0, smear_db / 20.0) * measured_exposure_ratio
            }
            Self::FrameTransfer { .. } => 1.0,
        }
    }
}

impl Effect for Smear {
    const NAME: &'static str = "smear";
    const KEY: &'static str = "sensor.smear";

    fn check(&self, facts: &SensorFacts, checks: &mut Checks) {
        match *self {
            Self::Interline { smear_db, measured_exposure_ratio } => {
                let legal = smear_db.is_finite() && smear_db <= -20.0;
                checks.legal("smear.smear_db", smear_db, legal, "a data sheet's figure of at most -20 dB");
                checks.fraction_above_0("smear.measured_exposure_ratio", measured_exposure_ratio);
                checks.agree("smear.smear_db", facts.frame_period_s.is_some(), || {
                    "smear depends on the time of a whole frame: give \"frame_period_s\"".to_owned()
                });
            }
            Self::FrameTransfer { line_shift_s } => checks.positive("smear.line_shift_s", line_shift_s),
        }
        checks.agree("smear", facts.exposure_s > 0.0, || {
            "the rate of light is not known at an exposure_s of 0: give a longer one".to_owned()
        });
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        EffectStatus::Modelled(match self {
            Self::Interline { smear_db, .. } => {
                format!("interline, {smear_db} dB: relative leakage {:.3e}", self.leak())
            }
            Self::FrameTransfer { line_shift_s } => format!("frame transfer, {line_shift_s} s per row"),
        })
    }
}

impl QuantityEffect for Smear {
    type Signal = MeanElectrons;
    const COMPONENT: SignalComponent = SignalComponent::Smear;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<MeanElectrons> {
        let line_s = self.line_s(context.facts.frame_period_s, context.height);
        Action::plane(ColumnSmear { factor: self.leak() * line_s / context.operation.exposure_s })
    }
}

/// Smear, prepared: the factor on the sum of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ColumnSmear {
    factor: f64,
}

impl PlaneEffect<MeanElectrons> for ColumnSmear {
    fn apply(&self, mut means: Plane<MeanElectrons>, _: &mut Traces<'_>) -> Plane<MeanElectrons> {
        let width = means.width();
        if width > 0 {
            let smear = self.column_sums(&means);
            means.samples_mut().par_chunks_mut(width).for_each(|row| {
                row.iter_mut().zip(&smear).for_each(|(mean, s)| *mean = (f64::from(*mean) + s) as f32);
            });
        }
        means
    }
}

impl ColumnSmear {
    /// Each column is summed from the top by one thread, so the bits do not depend on threads.
    fn column_sums(&self, means: &Plane<MeanElectrons>) -> Vec<f64> {
        const BLOCK: usize = 64;
        let mut sums = vec![0.0; means.width()];
        sums.par_chunks_mut(BLOCK).enumerate().for_each(|(block, sums)| {
            for row in means.samples().chunks(means.width()) {
                sums.iter_mut().zip(&row[block * BLOCK..]).for_each(|(sum, mean)| *sum += f64::from(*mean));
            }
            sums.iter_mut().for_each(|sum| *sum *= self.factor);
        });
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::tests::{ADDRESS, one_dn_an_electron, quiet, run};
    use crate::parameters::SensorParameters;
    use etendue_stats::Moments;

    const INTERLINE: Smear = Smear::Interline { smear_db: -80.0, measured_exposure_ratio: 1.0 };

    fn smeared(noise: bool, exposure_s: f64) -> SensorParameters {
        let mut p = if noise { one_dn_an_electron() } else { quiet() };
        p.light.smear = Some(INTERLINE);
        p.charge.full_well.capacity_e = 1e9;
        (p.exposure.exposure_s, p.exposure.frame_period_s) = (exposure_s, Some(0.04));
        p
    }

    #[test]
    fn leaks_of_data_sheets() {
        for (smear_db, expected) in [(-80.0, 1e-3), (-100.0, 1e-4), (-120.0, 1e-5)] {
            let smear = Smear::Interline { smear_db, measured_exposure_ratio: 1.0 };
            assert!((smear.leak() / expected - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_data_sheet_s_own_measurement_gives_its_figure() {
        // A spot of a tenth of the height, accumulated for the whole frame: smear over signal is Sm.
        let p = smeared(false, 0.04);
        let mut means = Plane::new(3, 200);
        (90..110).for_each(|y| means.set(1, y, 5e7_f32));
        let raw = run(&p, &means, ADDRESS);
        assert_eq!(raw.plane.at(1, 0), 5000);
        assert_eq!(raw.plane.at(1, 199), 5000);
        assert_eq!(raw.plane.at(0, 0), 0);
    }

    /// A uniform image has the stated exposure, with and without shielded rows.
    #[test]
    fn a_uniform_image_has_the_exposure_stated() {
        for dark in [0, 20] {
            let mut p = smeared(false, 1e-3);
            p.read_out.layout.optical_black.rows = dark;
            let raw = run(&p, &Plane::filled(3, 80, 1000.0_f32), ADDRESS);
            let raw = raw.linear();
            let expected = 1000.0 * (1.0 + p.uniform_smear_s(80) / 1e-3);
            let pixel = f64::from(raw.plane.at(1, raw.plane.height() - 1));
            assert!((pixel - expected).abs() <= 0.5 && expected > 1025.0, "{dark}: {pixel} {expected}");
        }
    }

    #[test]
    fn a_short_shutter_shows_it_most() {
        let column = |exposure_s: f64, mean: f32| {
            let mut means = Plane::new(1, 100);
            means.set(0, 50, mean);
            run(&smeared(false, exposure_s), &means, ADDRESS).plane.at(0, 0)
        };
        // The same rate of light: 1e8 e⁻ in 0.04 s.
        assert_eq!(column(0.04, 1e8), column(0.004, 1e7));
    }

    #[test]
    fn smear_has_its_own_shot_noise() {
        let mut means = Plane::new(64, 1000);
        (0..64).for_each(|x| means.set(x, 0, 5e7_f32));
        let raw = run(&smeared(true, 0.04), &means, ADDRESS);
        let dark = (1..1000).flat_map(|y| (0..64).map(move |x| (x, y)));
        let moments = Moments::from_values(dark.map(|(x, y)| f64::from(raw.plane.at(x, y))));
        // 50 e⁻ per pixel; 63 936 pixels give the mean to 0.028 and the variance to 0.56 %; tolerance: four of each (and 1/12 of rounding).
        assert!((moments.mean() - 50.0).abs() < 0.12, "{}", moments.mean());
        assert!((moments.variance().expect("many") / 50.0 - 1.0).abs() < 0.023);
    }

    #[test]
    fn frame_transfer_passes_the_open_pixels() {
        let mut p = quiet();
        p.light.smear = Some(Smear::FrameTransfer { line_shift_s: 1e-6 });
        p.exposure.exposure_s = 0.01;
        let raw = run(&p, &Plane::filled(2, 100, 10_000.0), ADDRESS);
        // 100 rows · 1 µs · 1e6 e⁻/s.
        assert!(raw.plane.samples().iter().all(|dn| *dn == 10_100));
    }
}
