//! Dark current over temperature, relative to a reference.
//!
//! - Doubling (EMVA 1288, equation 14): I(T) = I(T₀) 2^((T − T₀)/T_d).
//! - Band gap of silicon: thermal generation in the depleted zone, I ∝ T^1.5 exp(−E_g/(2 k T)), and diffusion from the bulk,
//!   I ∝ T³ exp(−E_g/(k T)), mixed by their fractions at T₀; E_g(T) = 1.1557 − 7.021e-4 T²/(T + 1108) eV (Varshni 1967; the form of
//!   Janesick 2001). Generation doubles every 8.5 K at 300 K and every 11.8 K at 358 K; no doubling constant holds for both.

use etendue_core::maths::f64::{exp, exp2, pow};

use crate::check::Checks;

/// Law of dark current over temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TemperatureLaw {
    /// A factor of two per temperature step.
    Doubling {
        /// Temperature step for a factor of two, K.
        step_k: f64,
    },
    /// Silicon's band gap.
    BandGap {
        /// Fraction of diffusion in the current, 0 to 1, at the reference temperature; the rest is generation.
        diffusion_fraction: f64,
    },
}

/// Temperature of a sensor, and that of its stated dark current.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temperature {
    /// Temperature of the sensor, K.
    pub sensor_k: f64,
    /// Temperature of the stated dark current, K.
    pub reference_k: f64,
    /// The law between them.
    pub law: TemperatureLaw,
}

/// k/e, eV/K, by the SI's exact constants.
const BOLTZMANN_EV_K: f64 = 1.380_649e-23 / 1.602_176_634e-19;

impl Temperature {
    pub(crate) fn check(&self, checks: &mut Checks) {
        let before = checks.errors.len();
        checks.positive("dark.temperature_c", self.sensor_k);
        checks.positive("dark.reference_c", self.reference_k);
        match self.law {
            TemperatureLaw::Doubling { step_k } => checks.positive("dark.doubling_k", step_k),
            TemperatureLaw::BandGap { diffusion_fraction } => {
                checks.fraction("dark.diffusion_fraction", diffusion_fraction);
            }
        }
        checks.agree("dark.temperature_c", checks.errors.len() > before || self.factor().is_finite(), || {
            "the dark current would exceed the range of floating-point numbers: give temperatures closer to each other".to_owned()
        });
    }

    /// Dark current at the sensor's temperature over the stated one.
    #[must_use]
    pub fn factor(&self) -> f64 {
        let (t, t0) = (self.sensor_k, self.reference_k);
        match self.law {
            TemperatureLaw::Doubling { step_k } => exp2((t - t0) / step_k),
            TemperatureLaw::BandGap { diffusion_fraction } => {
                let generation = pow(t / t0, 1.5) * exp(0.5 * (barrier(t0) - barrier(t)));
                let diffusion = pow(t / t0, 3.0) * exp(barrier(t0) - barrier(t));
                generation + diffusion_fraction * (diffusion - generation)
            }
        }
    }
}

/// E_g/(k T).
fn barrier(t_k: f64) -> f64 {
    (1.1557 - 7.021e-4 * t_k * t_k / (t_k + 1108.0)) / (BOLTZMANN_EV_K * t_k)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(law: TemperatureLaw, reference_k: f64, sensor_k: f64) -> f64 {
        Temperature { sensor_k, reference_k, law }.factor()
    }

    #[test]
    fn doubling_over_forty_kelvin() {
        for (step_k, expected) in [(8.0, 32.0), (7.0, 52.5), (6.0, 101.6)] {
            assert!((factor(TemperatureLaw::Doubling { step_k }, 300.0, 340.0) / expected - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn local_doubling_steps_of_silicon() {
        // ΔT for a factor of two, from the slope of ln I over a kelvin; the values are stated to a tenth of a kelvin.
        let step = |diffusion_fraction, t: f64| {
            let law = TemperatureLaw::BandGap { diffusion_fraction };
            core::f64::consts::LN_2 / etendue_core::maths::f64::ln(factor(law, t - 0.5, t + 0.5))
        };
        for (t, generation, diffusion) in [(300.0, 8.5, 4.2), (333.0, 10.3, 5.2), (358.0, 11.8, 5.9)] {
            assert!((step(0.0, t) - generation).abs() < 0.06, "{t}: {}", step(0.0, t));
            assert!((step(1.0, t) - diffusion).abs() < 0.06, "{t}: {}", step(1.0, t));
        }
    }

    #[test]
    fn a_factor_beyond_all_numbers_is_refused() {
        let errors = |sensor_k| {
            let mut checks = Checks::default();
            let law = TemperatureLaw::Doubling { step_k: 0.1 };
            Temperature { sensor_k, reference_k: 300.0, law }.check(&mut checks);
            checks.errors.len()
        };
        assert_eq!((errors(310.0), errors(500.0), errors(-1.0)), (0, 1, 1));
        let mut checks = Checks::default();
        checks.positive("pixel_pitch_um", -1.0);
        Temperature { sensor_k: 500.0, reference_k: 300.0, law: TemperatureLaw::Doubling { step_k: 0.1 } }
            .check(&mut checks);
        assert_eq!(checks.errors.len(), 2, "beside what else is wrong");
    }

    #[test]
    fn the_reference_is_the_reference() {
        for law in [TemperatureLaw::Doubling { step_k: 7.0 }, TemperatureLaw::BandGap { diffusion_fraction: 0.3 }] {
            assert!((factor(law, 320.0, 320.0) - 1.0).abs() < 1e-12);
        }
    }
}
