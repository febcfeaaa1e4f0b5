//! Dark current: thermally generated electrons, with their own shot noise.
//!
//! k ~ Poisson(I t), I the dark current (e⁻/s) of the pixel at the sensor's temperature ([`temperature`](super::temperature)); the mean I t itself if
//! noise is off. I is the same for all pixels unless the description states a variation:
//!
//! - spread: I f, f of mean 1 (except for clipping) with a white, a row and a column part of stated standard deviation (fractions of the mean).
//!   Normal: f = max(1 + d, 0). Log-normal (the long tail of most sensors): the white part is exp(s z − s²/2), s² = ln(1 + σ²);
//! - hot pixels: a fraction of pixels has an additional exponential current of a stated mean;
//! - blinking pixels: a fraction of pixels has it only at the upper of two levels ([`two_level`]).
//!
//! Random numbers: `Dark` of the pixel; of the unit: `PixelDark`, `RowDark`, `ColumnDark`, `Hot`, `Blinking`; `BlinkingFlip`. All currents are stated
//! at the reference temperature. Left out: amplifier glow, activation energies per pixel.

use etendue_core::maths::f64::{exp, ln_1p};
use etendue_core::random::{NoiseDraw, NoiseKey, Pixel};
use etendue_core::{EffectStatus, KeyChange, KnownError, quantity::Charge};

use super::temperature::Temperature;
use super::two_level::{self, RandomPurposes, RtsPixel, TwoLevel, high_in_row};
use crate::effect::{Action, Context, Effect, Memory, QuantityEffect, Row, RowEffect, SensorFacts, SignalLevels};
use crate::random::pattern::{self, Deviations, Sigmas};
use crate::random::{Poisson, standard_normal};
use crate::{capture::Operation, check::Checks, signal_breakdown::SignalComponent};

/// Shape of the distribution of dark currents over pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpreadDistribution {
    /// Normal, clipped at 0.
    #[default]
    Normal,
    /// Log-normal, of the same mean and standard deviation.
    LogNormal,
}

/// Variation of dark current over pixels: standard deviations as fractions of the mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DarkSpread {
    /// From pixel to pixel.
    pub white: f64,
    /// From row to row.
    pub row: f64,
    /// From column to column.
    pub column: f64,
    /// Shape of the white part.
    pub distribution: SpreadDistribution,
}

/// Pixels with far more dark current.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HotPixels {
    /// Fraction of pixels, above 0 and up to 1.
    pub fraction: f64,
    /// Mean of their additional current, e⁻/s.
    pub mean_e_s: f64,
}

/// Dark current of a sensor. The default has none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DarkCurrent {
    /// Mean dark current of a pixel at the reference temperature, e⁻·s⁻¹.
    pub current_e_s: f64,
    /// Temperatures; `None` if the stated current is that of the sensor as operated.
    pub temperature: Option<Temperature>,
    /// Variation over pixels.
    pub spread: DarkSpread,
    /// Hot pixels.
    pub hot: Option<HotPixels>,
    /// Blinking pixels; the amplitude is a current, e⁻/s.
    pub dark_current_rts: Option<TwoLevel>,
}

impl DarkCurrent {
    /// The same current for all pixels, at the sensor's own temperature.
    #[must_use]
    pub fn uniform(current_e_s: f64) -> Self {
        Self { current_e_s, temperature: None, spread: DarkSpread::default(), hot: None, dark_current_rts: None }
    }

    /// Factor of the sensor's temperature on all currents.
    #[must_use]
    pub fn temperature_factor(&self) -> f64 {
        self.temperature.map_or(1.0, |t| t.factor())
    }

    /// Mean over all pixels, hot ones included, e⁻/s at the sensor's temperature; without blinking pixels, and ignoring the clipping of a wide normal
    /// spread at zero current.
    #[must_use]
    pub fn mean_e_s(&self) -> f64 {
        let hot = self.hot.map_or(0.0, |hot| hot.fraction * hot.mean_e_s);
        (self.current_e_s + hot) * self.temperature_factor()
    }

    fn is_even(&self) -> bool {
        let s = self.spread;
        s.white == 0.0 && s.row == 0.0 && s.column == 0.0 && self.hot.is_none() && self.dark_current_rts.is_none()
    }
}

impl Effect for DarkCurrent {
    const NAME: &'static str = "dark current";
    const KEY: &'static str = "sensor.dark_current_e_s";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        checks.not_negative("dark_current_e_s", self.current_e_s);
        if let Some(temperature) = &self.temperature {
            temperature.check(checks);
        }
        checks.not_negative("dark.spread", self.spread.white);
        checks.not_negative("dark.spread_row", self.spread.row);
        checks.not_negative("dark.spread_column", self.spread.column);
        if let Some(hot) = &self.hot {
            checks.fraction_above_0("dark.hot.fraction", hot.fraction);
            checks.positive("dark.hot.mean_e_s", hot.mean_e_s);
        }
        if let Some(rts) = &self.dark_current_rts {
            rts.check(
                [
                    "dark.dark_current_rts.fraction",
                    "dark.dark_current_rts.mean_e_s",
                    "dark.dark_current_rts.dwell_frames",
                ],
                checks,
            );
        }
    }

    fn status(&self, facts: &SensorFacts, operation: &Operation) -> EffectStatus {
        let exposure_s = operation.exposure_s;
        let mean_e = self.current_e_s * self.temperature_factor() * exposure_s;
        let none = mean_e == 0.0 && self.hot.is_none() && self.dark_current_rts.is_none();
        if none || exposure_s == 0.0 {
            let text = format!("{} e⁻/s over {exposure_s} s generates no electrons", self.current_e_s);
            return EffectStatus::LeftOut(text);
        }
        let mean_e = four_digits(mean_e);
        let counted = if facts.noise {
            format!("{mean_e} e⁻ per pixel on average, Poisson")
        } else {
            format!("{mean_e} e⁻ per pixel; its shot noise is switched off")
        };
        EffectStatus::Modelled(counted + &differences(self))
    }

    fn left_out_by(&self) -> Vec<KeyChange> {
        let parts = [
            ("sensor.dark.hot", self.hot.is_some()),
            ("sensor.dark.dark_current_rts", self.dark_current_rts.is_some()),
        ];
        let parts = parts.into_iter().filter(|(_, is_there)| *is_there);
        std::iter::once(KeyChange::zero(Self::KEY)).chain(parts.map(|(key, _)| KeyChange::removed(key))).collect()
    }

    fn errors_without(&self, facts: &SensorFacts, _: &SignalLevels) -> Vec<KnownError> {
        let value = self.current_e_s * self.temperature_factor() * facts.exposure_s;
        vec![KnownError { quantity: "missing dark signal", value, unit: "e⁻" }]
    }
}

impl QuantityEffect for DarkCurrent {
    type Signal = Charge;
    const COMPONENT: SignalComponent = SignalComponent::Dark;

    fn prepare(&self, context: &Context, memory: &mut Memory) -> Action<Charge> {
        Action::rows(DarkElectrons::new(self, context, &self.at_upper_level(context, memory)))
    }
}

impl DarkCurrent {
    /// The blinking pixels at their upper level; none without noise from frame to frame.
    fn at_upper_level(&self, context: &Context, memory: &mut Memory) -> Vec<RtsPixel> {
        let Some(two) = self.dark_current_rts.filter(|_| context.facts.noise) else { return Vec::new() };
        let purposes = RandomPurposes { which: NoiseDraw::Blinking, flip: NoiseDraw::BlinkingFlip };
        let (sites, high) = two_level::next_levels(&two, purposes, context, &memory.before.dark_current_rts_high);
        let up = sites.into_iter().zip(&high).filter(|(_, high)| **high).map(|(site, _)| site).collect();
        memory.after.dark_current_rts_high = high;
        up
    }
}

/// A number as a plan states it, to four digits.
fn four_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

fn differences(dark: &DarkCurrent) -> String {
    let mut text = String::new();
    if let Some(t) = dark.temperature {
        text += &format!("; {:.4} times the stated current at this temperature", t.factor());
    }
    if dark.spread.white > 0.0 || dark.spread.row > 0.0 || dark.spread.column > 0.0 {
        text += "; non-uniform (DSNU)";
    }
    if let Some(hot) = dark.hot {
        text += &format!("; {} of the pixels are hot", hot.fraction);
    }
    if let Some(rts) = dark.dark_current_rts {
        text += &format!("; {} of the pixels have random telegraph noise (RTS)", rts.fraction);
    }
    text
}

/// Dark current, prepared.
#[derive(Clone, Debug, PartialEq)]
struct DarkElectrons {
    key: NoiseKey,
    /// Mean of an ordinary pixel, e⁻.
    mean_e: f64,
    /// `None` if only the mean is added.
    counts: Option<Poisson>,
    /// `None` if all pixels are equal.
    pattern: Option<DarkPattern>,
}

/// Variation over pixels, prepared.
#[derive(Clone, Debug, PartialEq)]
struct DarkPattern {
    deviations: Deviations,
    /// s of the log-normal white part, and its key.
    log_normal: Option<(f64, NoiseKey)>,
    /// Fraction, and mean in electrons.
    hot: Option<(f64, f64, NoiseKey)>,
    /// Pixels at their upper level, amplitudes in electrons.
    dark_current_rts: Vec<RtsPixel>,
}

impl DarkElectrons {
    /// `high`: the blinking pixels at their upper level.
    fn new(dark: &DarkCurrent, context: &Context, high: &[RtsPixel]) -> Self {
        let electrons_per_current = dark.temperature_factor() * context.operation.exposure_s;
        let mean_e = dark.current_e_s * electrons_per_current;
        Self {
            key: context.noise(NoiseDraw::Dark),
            mean_e,
            counts: Poisson::new(mean_e).filter(|_| context.facts.noise),
            pattern: (!dark.is_even()).then(|| DarkPattern::new(dark, context, high, electrons_per_current)),
        }
    }

    fn sample(&self, counts: &Poisson, x: usize, y: u32) -> f64 {
        counts.sample(&mut self.key.stream(Pixel { x: x as u32, y }))
    }
}

impl RowEffect<Charge> for DarkElectrons {
    /// Adds dark electrons.
    fn apply(&self, row: &mut Row<'_, Charge>) {
        let (electrons, y) = (&mut *row.values, row.y);
        match (&self.pattern, self.counts) {
            (None, None) => electrons.iter_mut().for_each(|e| *e += self.mean_e),
            (None, Some(counts)) => {
                electrons.iter_mut().enumerate().for_each(|(x, e)| *e += self.sample(&counts, x, y));
            }
            (Some(pattern), counts) => {
                let means = pattern.means(self.mean_e, electrons.len(), y);
                for ((x, e), mean) in electrons.iter_mut().enumerate().zip(means) {
                    let poisson = counts.and_then(|_| Poisson::new(mean));
                    *e += poisson.map_or(mean, |poisson| self.sample(&poisson, x, y));
                }
            }
        }
    }
}

impl DarkPattern {
    fn new(dark: &DarkCurrent, context: &Context, high: &[RtsPixel], electrons_per_current: f64) -> Self {
        let DarkSpread { white, row, column, distribution } = dark.spread;
        let log_normal = (distribution == SpreadDistribution::LogNormal && white > 0.0)
            .then(|| (ln_1p(white * white).sqrt(), context.pattern(NoiseDraw::PixelDark)));
        let sigmas = Sigmas { white: if log_normal.is_some() { 0.0 } else { white }, row, column };
        let purposes = [NoiseDraw::PixelDark, NoiseDraw::RowDark, NoiseDraw::ColumnDark];
        let in_electrons = |site: &RtsPixel| RtsPixel { amplitude: site.amplitude * electrons_per_current, ..*site };
        Self {
            deviations: Deviations::new(sigmas, purposes, |purpose| context.pattern(purpose), context.width),
            log_normal,
            hot: dark.hot.map(|h| (h.fraction, h.mean_e_s * electrons_per_current, context.pattern(NoiseDraw::Hot))),
            dark_current_rts: high.iter().map(in_electrons).collect(),
        }
    }

    /// Mean dark electrons of a row's pixels.
    fn means(&self, mean_e: f64, width: usize, y: u32) -> Vec<f64> {
        let mut means = vec![0.0; width];
        self.deviations.for_row(y, width, |x, d| means[x] = mean_e * (1.0 + d).max(0.0));
        if let Some((s, key)) = self.log_normal {
            for (x, mean) in means.iter_mut().enumerate() {
                let z = standard_normal(&mut key.stream(Pixel { x: x as u32, y }));
                *mean *= exp(s * z - 0.5 * s * s);
            }
        }
        if let Some((fraction, hot_e, key)) = self.hot {
            pattern::each(key, y, fraction, width, |x, stream| means[x] += pattern::exponential(hot_e, stream));
        }
        for site in high_in_row(&self.dark_current_rts, y) {
            means[site.x as usize] += site.amplitude;
        }
        means
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capture::{FrameAddress, SensorState};
    use crate::frame::tests::{ADDRESS, covariance, one_dn_an_electron, quiet, run};
    use crate::parameters::SensorParameters;
    use crate::sensor::Sensor;
    use etendue_core::Plane;
    use etendue_stats::Moments;

    fn moments(p: &SensorParameters, size: usize) -> Moments {
        let raw = run(p, &Plane::filled(size, size, 0.0), ADDRESS);
        Moments::from_values(raw.plane.samples().iter().map(|dn| f64::from(*dn)))
    }

    #[test]
    fn dark_electrons_are_counted_at_every_mean() {
        for mean in [0.1, 1.0, 50.0, 1e4] {
            let mut p = one_dn_an_electron();
            p.charge.dark.current_e_s = mean / p.exposure.exposure_s;
            let m = moments(&p, 512);
            // 512² counts; their variance is known to √((2 + 1/μ)/n); tolerance: four of each. Integer DN lose nothing.
            let n: f64 = 262_144.0;
            assert!((m.mean() - mean).abs() < 4.0 * (mean / n).sqrt(), "{mean}: {}", m.mean());
            let relative = 4.0 * ((2.0 + 1.0 / mean) / n).sqrt();
            assert!((m.variance().expect("many") / mean - 1.0).abs() < relative, "{mean}");
        }
    }

    #[test]
    fn both_tails_have_the_stated_mean_and_spread() {
        for distribution in [SpreadDistribution::Normal, SpreadDistribution::LogNormal] {
            let mut p = quiet();
            p.charge.dark.current_e_s = 1e4 / p.exposure.exposure_s;
            p.charge.dark.spread = DarkSpread { white: 0.1, row: 0.0, column: 0.0, distribution };
            let m = moments(&p, 512);
            // The variance of a log-normal variable with 10 % is known slightly less well than that of a normal one: √(2.6/n) = 0.31 %.
            assert!((m.mean() / 1e4 - 1.0).abs() < 4.0 * 0.1 / 512.0, "{distribution:?}");
            assert!((m.variance().expect("many") / 1e6 - 1.0).abs() < 0.0125, "{distribution:?}");
        }
    }

    #[test]
    fn heat_doubles_the_mean() {
        let mut p = quiet();
        p.charge.dark.current_e_s = 1e3 / p.exposure.exposure_s;
        let law = super::super::temperature::TemperatureLaw::Doubling { step_k: 7.0 };
        p.charge.dark.temperature = Some(Temperature { sensor_k: 307.0, reference_k: 300.0, law });
        assert!((moments(&p, 8).mean() - 2000.0).abs() < 1e-9);
        p.charge.dark.temperature = Some(Temperature { sensor_k: -1.0, reference_k: 300.0, law });
        assert!(Sensor::new(p).is_err());
    }

    #[test]
    fn hot_pixels_are_a_few_and_stay() {
        let mut p = quiet();
        p.charge.dark.hot = Some(HotPixels { fraction: 0.01, mean_e_s: 1e4 / p.exposure.exposure_s });
        let first = run(&p, &Plane::filled(256, 256, 0.0), ADDRESS);
        let hot = first.plane.samples().iter().filter(|dn| **dn > 0).count();
        // 655 ± 25.
        assert!((hot as f64 - 655.0).abs() < 102.0, "{hot}");
        assert!(covariance(&first, 0, 0) > 0.0);
        let later = run(&p, &Plane::filled(256, 256, 0.0), FrameAddress { frame: 5, ..ADDRESS });
        assert_eq!(first.plane, later.plane);
    }

    #[test]
    fn blinking_pixels_blink_over_frames() {
        let mut p = one_dn_an_electron();
        p.charge.dark.dark_current_rts =
            Some(TwoLevel { fraction: 0.02, mean: 1e6 / p.exposure.exposure_s, dwell_frames: 2.0 });
        let sensor = Sensor::new(p).expect("legal");
        let dark = Plane::filled(64, 64, 0.0);
        let (state, first) = sensor.step(SensorState::default(), &dark, ADDRESS);
        let (_, second) = sensor.step(state.clone(), &dark, FrameAddress { frame: 3, ..ADDRESS });
        let up = |raw: &crate::Raw| raw.plane.samples().iter().map(|dn| *dn > 0).collect::<Vec<_>>();
        assert_ne!(up(&first), up(&second));
        assert_eq!(
            state.dark_current_rts_high.iter().filter(|h| **h).count(),
            up(&first).iter().filter(|h| **h).count()
        );
    }
}
