//! How the dark current grows with the sensor's temperature.
//!
//! ```text
//! doubling:    I = I_ref 2^((T − T_ref)/T_d)                                   EMVA 1288, section 7
//! generation:  I ∝ T^1.5 exp(−E_g/(2 k T))      diffusion:  I ∝ T³ exp(−E_g/(k T))
//! E_g = 1.1557 − 7.021·10⁻⁴ T²/(T + 1108) eV
//! ```
//!
//! (T in kelvin in the laws of silicon; Varshni's form with the constants of Pyxel's dark-current model.) Each law is fitted to ln I by weighted least
//! squares, weights from the currents' uncertainties; χ² over its degrees of freedom says which one fits. The doubling
//! temperature of the laws without one of their own is that at T_ref.

use super::TransferError;
use crate::Estimate;
use core::f64::consts::LN_2;
use etendue_core::maths::f64::{exp, ln};

/// Boltzmann's constant, eV/K (exact in SI, rounded).
const BOLTZMANN_EV_PER_K: f64 = 8.617_333_262e-5;
/// 0 °C in kelvin.
pub const ZERO_CELSIUS_K: f64 = 273.15;

/// A law of growth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// It doubles every so many kelvin.
    Doubling,
    /// Generation in the depleted silicon.
    Generation,
    /// Diffusion from the bulk.
    Diffusion,
}

impl Law {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Doubling, Self::Generation, Self::Diffusion];

    /// ln of the law's shape at a temperature; the doubling law has a free slope and is not asked.
    fn ln_shape(self, temperature_c: f64) -> f64 {
        let kelvin = temperature_c + ZERO_CELSIUS_K;
        let gap_ev = 1.1557 - 7.021e-4 * kelvin * kelvin / (kelvin + 1108.0);
        match self {
            Self::Doubling => 0.0,
            Self::Generation => 1.5 * ln(kelvin) - gap_ev / (2.0 * BOLTZMANN_EV_PER_K * kelvin),
            Self::Diffusion => 3.0 * ln(kelvin) - gap_ev / (BOLTZMANN_EV_PER_K * kelvin),
        }
    }
}

/// A law fitted to dark currents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Which one.
    pub law: Law,
    /// Dark current at the reference temperature, e⁻/s.
    pub reference_e_per_s: Estimate,
    /// Kelvin to its doubling, at the reference temperature; known exactly to the laws of silicon.
    pub doubling_k: Estimate,
    /// Sum of squared deviations over uncertainties.
    pub chi_square: f64,
    /// Points less parameters.
    pub degrees_of_freedom: usize,
}

/// Fits a law to (temperature in °C, dark current in e⁻/s).
///
/// # Errors
/// Where fewer than three currents are above zero with a known uncertainty.
pub fn fit(law: Law, currents: &[(f64, Estimate)], reference_c: f64) -> Result<Growth, TransferError> {
    let usable = |(_, e): &&(f64, Estimate)| e.value > 0.0 && e.standard_uncertainty > 0.0;
    let points: Vec<[f64; 3]> = currents.iter().filter(usable).map(|(t, e)| point(law, *t, *e, reference_c)).collect();
    if points.len() < 3 {
        return Err(TransferError::TooFewTemperatures(points.len()));
    }
    let sum = |f: fn(&[f64; 3]) -> f64| points.iter().map(f).sum::<f64>();
    let (w, x, y) = (sum(|p| p[2]), sum(|p| p[2] * p[0]), sum(|p| p[2] * p[1]));
    let (xx, xy) = (sum(|p| p[2] * p[0] * p[0]), sum(|p| p[2] * p[0] * p[1]));
    let free = law == Law::Doubling;
    let determinant = w * xx - x * x;
    let (slope, u_slope) = if free { ((w * xy - x * y) / determinant, (w / determinant).sqrt()) } else { (0.0, 0.0) };
    let offset = if free { (xx * y - x * xy) / determinant } else { y / w };
    let u_offset = if free { (xx / determinant).sqrt() } else { 1.0 / w.sqrt() };
    let chi_square =
        points.iter().map(|p| p[2] * (p[1] - offset - slope * p[0]) * (p[1] - offset - slope * p[0])).sum();
    let slope = if free { slope } else { law.ln_shape(reference_c + 0.5) - law.ln_shape(reference_c - 0.5) };
    let reference = exp(offset);
    Ok(Growth {
        law,
        reference_e_per_s: Estimate::new(reference, reference * u_offset),
        doubling_k: Estimate::new(LN_2 / slope, LN_2 / (slope * slope) * u_slope),
        chi_square,
        degrees_of_freedom: points.len() - if free { 2 } else { 1 },
    })
}

/// (T − T_ref, ln I less the law's shape, weight).
fn point(law: Law, temperature_c: f64, current: Estimate, reference_c: f64) -> [f64; 3] {
    let relative = current.standard_uncertainty / current.value;
    let shape = law.ln_shape(temperature_c) - law.ln_shape(reference_c);
    [temperature_c - reference_c, ln(current.value) - shape, 1.0 / (relative * relative)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(law: impl Fn(f64) -> f64) -> Vec<(f64, Estimate)> {
        (0..7).map(|i| 20.0 + 10.0 * f64::from(i)).map(|t| (t, Estimate::new(law(t), 0.01 * law(t)))).collect()
    }

    #[test]
    fn each_law_is_known_by_its_own_series() {
        let doubling = series(|t| 12.0 * exp((t - 30.0) / 8.0 * LN_2));
        let growth = fit(Law::Doubling, &doubling, 30.0).expect("a fit");
        assert!((growth.reference_e_per_s.value / 12.0 - 1.0).abs() < 1e-12);
        assert!((growth.doubling_k.value / 8.0 - 1.0).abs() < 1e-12 && growth.chi_square < 1e-18);
        let silicon = series(|t| exp(30.0 + Law::Generation.ln_shape(t)));
        assert!(fit(Law::Generation, &silicon, 30.0).expect("a fit").chi_square < 1e-18);
        // One doubling temperature cannot hold from 20 to 80 °C.
        for law in [Law::Doubling, Law::Diffusion] {
            assert!(fit(law, &silicon, 30.0).expect("a fit").chi_square > 30.0, "{law:?}");
        }
    }

    #[test]
    fn silicon_doubles_as_in_the_tables() {
        // PHYSICS.md's figures, to their one decimal: generation 8.5 K at 300 K, 10.3 K at 333 K; diffusion 4.2, 5.2.
        for (law, kelvin, want) in [
            (Law::Generation, 300.0, 8.5),
            (Law::Generation, 333.0, 10.3),
            (Law::Diffusion, 300.0, 4.2),
            (Law::Diffusion, 333.0, 5.2),
        ] {
            let at = kelvin - ZERO_CELSIUS_K;
            let doubling = fit(law, &series(|t| exp(law.ln_shape(t))), at).expect("a fit").doubling_k.value;
            assert!((doubling - want).abs() < 0.06, "{law:?} {kelvin}: {doubling}");
        }
    }

    #[test]
    fn two_temperatures_are_too_few() {
        assert_eq!(fit(Law::Doubling, &series(|t| t)[..2], 30.0), Err(TransferError::TooFewTemperatures(2)));
    }
}
