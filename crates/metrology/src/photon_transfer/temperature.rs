//! Growth of the dark current with the sensor temperature.
//!
//! ```text
//! doubling:    I = I_ref 2^((T − T_ref)/T_d)                                   EMVA 1288, section 7
//! generation:  I ∝ T^1.5 exp(−E_g/(2 k T))      diffusion:  I ∝ T³ exp(−E_g/(k T))
//! E_g = 1.1557 − 7.021·10⁻⁴ T²/(T + 1108) eV
//! ```
//!
//! (T in kelvin in the laws of silicon; Varshni's form with the constants of Pyxel's dark-current model.) Each law is fitted to
//! the currents themselves, not to their logarithms, so that currents that are negative due to noise count as well. The fit is
//! least squares with weights from the uncertainties; χ² over its degrees of freedom shows which law fits. The doubling
//! temperature of the generation and diffusion laws is that at T_ref.

use core::f64::consts::LN_2;

use etendue_core::maths::f64::{exp, ln};

use super::TransferError;
use crate::Estimate;

/// Boltzmann's constant, eV/K (exact in SI, rounded).
const BOLTZMANN_EV_PER_K: f64 = 8.617_333_262e-5;
/// 0 °C in kelvin.
pub const ZERO_CELSIUS_K: f64 = 273.15;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrowthLaw {
    /// Doubling per constant temperature step.
    Doubling,
    /// Generation in the depleted silicon.
    Generation,
    /// Diffusion from the bulk.
    Diffusion,
}

impl GrowthLaw {
    /// All laws.
    pub const ALL: [Self; 3] = [Self::Doubling, Self::Generation, Self::Diffusion];

    /// ln of the law's shape at a temperature; not used for the doubling law, whose slope is free.
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
pub struct DarkCurrentFit {
    pub law: GrowthLaw,
    /// Dark current at the reference temperature, e⁻/s.
    pub reference_e_per_s: Estimate,
    /// Temperature rise that doubles it, K, at the reference temperature; exact for the laws of silicon.
    pub doubling_k: Estimate,
    /// Sum of squared deviations relative to the uncertainties.
    pub chi_square: f64,
    /// Points less parameters.
    pub degrees_of_freedom: usize,
}

/// Fits a law to (temperature in °C, dark current in e⁻/s).
///
/// # Errors
/// If there are fewer than three different temperatures, one is impossible, a current has no uncertainty, or none is above zero.
pub fn fit(law: GrowthLaw, currents: &[(f64, Estimate)], reference_c: f64) -> Result<DarkCurrentFit, TransferError> {
    check(currents)?;
    let points: Vec<CurrentPoint> = currents.iter().map(|(t, e)| CurrentPoint::new(law, *t, *e, reference_c)).collect();
    let none = TransferError::NoDarkCurrent;
    let free = law == GrowthLaw::Doubling;
    let [ln_reference, slope] =
        if free { growing(&points).ok_or(none)? } else { [ln(scale(&points, 0.0).ok_or(none)?), 0.0] };
    let normal = normal(&points, ln_reference, slope);
    let determinant = normal[0] * normal[2] - normal[1] * normal[1];
    let [u_reference, u_slope] = match free {
        true => [(normal[2] / determinant).sqrt(), (normal[0] / determinant).sqrt()],
        false => [1.0 / normal[0].sqrt(), 0.0],
    };
    let doubling = if free { slope } else { law.ln_shape(reference_c + 0.5) - law.ln_shape(reference_c - 0.5) };
    let reference = exp(ln_reference);
    Ok(DarkCurrentFit {
        law,
        reference_e_per_s: Estimate::new(reference, reference * u_reference),
        doubling_k: Estimate::new(LN_2 / doubling, LN_2 / (doubling * doubling) * u_slope),
        chi_square: chi_square(&points, ln_reference, slope),
        degrees_of_freedom: points.len() - if free { 2 } else { 1 },
    })
}

fn check(currents: &[(f64, Estimate)]) -> Result<(), TransferError> {
    if let Some((celsius, _)) = currents.iter().find(|(t, _)| !(t.is_finite() && *t > -ZERO_CELSIUS_K)) {
        return Err(TransferError::NoTemperature(*celsius));
    }
    let known =
        |e: &Estimate| e.value.is_finite() && e.standard_uncertainty > 0.0 && e.standard_uncertainty.is_finite();
    if let Some((celsius, _)) = currents.iter().find(|(_, e)| !known(e)) {
        return Err(TransferError::DarkCurrentUnknown(*celsius));
    }
    let mut temperatures: Vec<f64> = currents.iter().map(|(t, _)| *t).collect();
    temperatures.sort_unstable_by(f64::total_cmp);
    temperatures.dedup();
    if temperatures.len() < 3 { Err(TransferError::TooFewTemperatures(temperatures.len())) } else { Ok(()) }
}

/// A current, its shape factor relative to the reference temperature without the law's slope, and its weight.
struct CurrentPoint {
    from_reference_k: f64,
    current: f64,
    shape: f64,
    weight: f64,
}

impl CurrentPoint {
    fn new(law: GrowthLaw, temperature_c: f64, current: Estimate, reference_c: f64) -> Self {
        Self {
            from_reference_k: temperature_c - reference_c,
            current: current.value,
            shape: exp(law.ln_shape(temperature_c) - law.ln_shape(reference_c)),
            weight: 1.0 / (current.standard_uncertainty * current.standard_uncertainty),
        }
    }

    fn model(&self, ln_reference: f64, slope: f64) -> f64 {
        self.shape * exp(ln_reference + slope * self.from_reference_k)
    }
}

/// The best-fitting current at the reference temperature for a slope; `None` if it is not above zero.
fn scale(points: &[CurrentPoint], slope: f64) -> Option<f64> {
    let sum = |f: &dyn Fn(&CurrentPoint, f64) -> f64| points.iter().map(|p| f(p, p.model(0.0, slope))).sum::<f64>();
    let best = sum(&|p, m| p.weight * m * p.current) / sum(&|p, m| p.weight * m * m);
    (best > 0.0).then_some(best)
}

fn chi_square(points: &[CurrentPoint], ln_reference: f64, slope: f64) -> f64 {
    let off = |p: &CurrentPoint| p.current - p.model(ln_reference, slope);
    points.iter().map(|p| p.weight * off(p) * off(p)).sum()
}

/// JᵀJ for ln I_ref and the slope: its elements 00, 01, 11.
fn normal(points: &[CurrentPoint], ln_reference: f64, slope: f64) -> [f64; 3] {
    points.iter().fold([0.0; 3], |sum, p| {
        let (m, x) = (p.model(ln_reference, slope), p.from_reference_k);
        let square = p.weight * m * m;
        [sum[0] + square, sum[1] + square * x, sum[2] + square * x * x]
    })
}

/// ln I_ref and ln 2 over the doubling temperature: the best of slopes from halving to doubling per kelvin, then by Gauss and
/// Newton.
fn growing(points: &[CurrentPoint]) -> Option<[f64; 2]> {
    let slopes = (-70..=70).map(|i| 0.01 * f64::from(i));
    let candidates = slopes.filter_map(|slope| Some([ln(scale(points, slope)?), slope]));
    let mut best =
        candidates.min_by(|a, b| chi_square(points, a[0], a[1]).total_cmp(&chi_square(points, b[0], b[1])))?;
    for _ in 0..20 {
        let [aa, ab, bb] = normal(points, best[0], best[1]);
        let [ra, rb] = points.iter().fold([0.0; 2], |sum, p| {
            let m = p.model(best[0], best[1]);
            let weighted_residual = p.weight * m * (p.current - m);
            [sum[0] + weighted_residual, sum[1] + weighted_residual * p.from_reference_k]
        });
        let determinant = aa * bb - ab * ab;
        let next = [best[0] + (bb * ra - ab * rb) / determinant, best[1] + (aa * rb - ab * ra) / determinant];
        let better = chi_square(points, next[0], next[1]) <= chi_square(points, best[0], best[1]);
        if !better {
            break;
        }
        best = next;
    }
    Some(best)
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
        let growth = fit(GrowthLaw::Doubling, &doubling, 30.0).expect("a fit");
        assert!((growth.reference_e_per_s.value / 12.0 - 1.0).abs() < 1e-12);
        assert!((growth.doubling_k.value / 8.0 - 1.0).abs() < 1e-12 && growth.chi_square < 1e-18);
        let silicon = series(|t| exp(30.0 + GrowthLaw::Generation.ln_shape(t)));
        assert!(fit(GrowthLaw::Generation, &silicon, 30.0).expect("a fit").chi_square < 1e-18);
        // One doubling temperature cannot be valid from 20 to 80 °C.
        for law in [GrowthLaw::Doubling, GrowthLaw::Diffusion] {
            assert!(fit(law, &silicon, 30.0).expect("a fit").chi_square > 30.0, "{law:?}");
        }
    }

    #[test]
    fn silicon_doubles_as_in_the_tables() {
        // To one decimal: generation 8.5 K at 300 K, 10.3 K at 333 K; diffusion 4.2, 5.2.
        for (law, kelvin, expected) in [
            (GrowthLaw::Generation, 300.0, 8.5),
            (GrowthLaw::Generation, 333.0, 10.3),
            (GrowthLaw::Diffusion, 300.0, 4.2),
            (GrowthLaw::Diffusion, 333.0, 5.2),
        ] {
            let at = kelvin - ZERO_CELSIUS_K;
            let doubling = fit(law, &series(|t| exp(law.ln_shape(t))), at).expect("a fit").doubling_k.value;
            assert!((doubling - expected).abs() < 0.06, "{law:?} {kelvin}: {doubling}");
        }
    }

    #[test]
    fn two_temperatures_are_too_few() {
        assert_eq!(fit(GrowthLaw::Doubling, &series(|t| t)[..2], 30.0), Err(TransferError::TooFewTemperatures(2)));
        let at =
            |celsius: f64, e: Estimate| fit(GrowthLaw::Doubling, &[&series(|t| t)[..], &[(celsius, e)]].concat(), 30.0);
        let one = Estimate::new(1.0, 0.1);
        assert!(matches!(at(f64::NAN, one), Err(TransferError::NoTemperature(_))));
        assert_eq!(at(-300.0, one), Err(TransferError::NoTemperature(-300.0)));
        assert_eq!(at(5.0, Estimate::new(1.0, 0.0)), Err(TransferError::DarkCurrentUnknown(5.0)));
        let same = [(25.0, one); 3];
        assert_eq!(fit(GrowthLaw::Doubling, &same, 30.0), Err(TransferError::TooFewTemperatures(1)));
        let none: Vec<(f64, Estimate)> =
            series(|t| t).iter().map(|(t, e)| (*t, Estimate::new(-1.0, e.value))).collect();
        assert_eq!(fit(GrowthLaw::Diffusion, &none, 30.0), Err(TransferError::NoDarkCurrent));
    }

    /// A cold current that is negative due to noise counts: omitting it would increase the doubling temperature.
    #[test]
    fn negative_currents_count() {
        let mut noisy = series(|t| exp((t - 30.0) / 8.0 * LN_2));
        noisy[0] = (20.0, Estimate::new(-0.5, 0.5));
        noisy[1] = (30.0, Estimate::new(1.8, 0.5));
        let growth = |points: &[(f64, Estimate)]| fit(GrowthLaw::Doubling, points, 30.0).expect("a fit");
        assert!(growth(&noisy).chi_square > growth(&noisy[1..]).chi_square + 1.0);
        assert!((growth(&noisy).doubling_k.value - 8.0).abs() < 3.0 * growth(&noisy).doubling_k.standard_uncertainty);
    }
}
