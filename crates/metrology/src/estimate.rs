//! Measured quantities with uncertainty, and its propagation to derived quantities.

use etendue_core::maths::f64::hypot;

/// A measured quantity with its standard uncertainty (GUM, JCGM 100:2008, 2.3.1), both in the unit that the owner states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Best estimate.
    pub value: f64,
    /// One standard deviation; infinite if the image does not determine the value.
    pub standard_uncertainty: f64,
}

impl Estimate {
    /// A value with a standard uncertainty.
    #[must_use]
    pub fn new(value: f64, standard_uncertainty: f64) -> Self {
        Self { value, standard_uncertainty }
    }

    /// Converts to a unit that is `factor` times smaller.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { value: self.value * factor, standard_uncertainty: self.standard_uncertainty * factor.abs() }
    }

    /// Difference from `other` in expanded uncertainties (k = 2) of the difference, E_n of ISO 13528: at most 1 in magnitude if the
    /// two agree. Their errors must be independent. Infinite if both are exact and differ, 0 if they are exact and equal.
    #[must_use]
    pub fn normalised_error(self, other: Self) -> f64 {
        let difference = self.value - other.value;
        let expanded = 2.0 * hypot(self.standard_uncertainty, other.standard_uncertainty);
        if difference == 0.0 { 0.0 } else { difference / expanded }
    }
}

/// Evaluates `f` of independent inputs, with standard uncertainties by the law of propagation (GUM, JCGM 100:2008, 5.1.2).
/// Derivatives are half the difference of the results one standard uncertainty above and below each input (5.1.3, note 2).
/// Choices that depend on the inputs (such as the points of a fit) must not change inside `f`.
pub(crate) fn propagate<const N: usize>(inputs: &[Estimate], f: impl Fn(&[f64]) -> [f64; N]) -> [Estimate; N] {
    let figures = propagate_curved(inputs, |x| f(x).to_vec());
    core::array::from_fn(|k| figures[k].first_order)
}

/// A quantity derived from noisy inputs, to second order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SecondOrderEstimate {
    /// Value, with the standard uncertainty of first order.
    pub first_order: Estimate,
    /// Mean shift due to the inputs' noise: half the sum of the second differences s of its inputs.
    bias: f64,
    /// Contribution of curvature to the variance: s²/2 for each (normal) input.
    variance: f64,
}

impl SecondOrderEstimate {
    /// Estimate of a quantity that cannot be negative, such as a length: its root mean square error, with shift and curvature;
    /// unknown if the shift exceeds an eighth of the value. (For a length of several components of total variance V the shift is
    /// V/2 over it, so lengths below 2 √V are not distinguished from 0. One that is 0 exceeds that by chance in 1 to 2 % of cases.)
    pub(crate) fn above_zero(self) -> Estimate {
        let (value, u) = (self.first_order.value, self.first_order.standard_uncertainty);
        let error = (u * u + self.variance + self.bias * self.bias).sqrt();
        Estimate::new(value, if self.bias.abs() <= 0.125 * value.abs() { error } else { f64::INFINITY })
    }
}

/// Any number of derived quantities of independent inputs, to second order (5.1.2, note).
pub(crate) fn propagate_curved(inputs: &[Estimate], f: impl Fn(&[f64]) -> Vec<f64>) -> Vec<SecondOrderEstimate> {
    let mut at: Vec<f64> = inputs.iter().map(|input| input.value).collect();
    let values = f(&at);
    let mut sums = vec![[0.0; 3]; values.len()];
    for (i, input) in inputs.iter().enumerate().filter(|(_, input)| input.standard_uncertainty > 0.0) {
        at[i] = input.value + input.standard_uncertainty;
        let above = f(&at);
        at[i] = input.value - input.standard_uncertainty;
        let below = f(&at);
        at[i] = input.value;
        for (k, [first, bias, curved]) in sums.iter_mut().enumerate() {
            let second = above[k] + below[k] - 2.0 * values[k];
            *first += 0.25 * (above[k] - below[k]) * (above[k] - below[k]);
            *bias += 0.5 * second;
            *curved += 0.5 * second * second;
        }
    }
    let curved = |(value, [first, bias, variance]): (&f64, [f64; 3])| SecondOrderEstimate {
        first_order: Estimate::new(*value, first.sqrt()),
        bias,
        variance,
    };
    values.iter().zip(sums).map(curved).collect()
}

/// √x of a variance whose estimate may be negative, then 0. Its uncertainty is half the distance to the farther end of the 95 %
/// interval, √(x ± 2 u): u/(2 √x) if x is well determined, √(u/2) if it does not differ from 0.
pub(crate) fn root(x: Estimate) -> Estimate {
    let at = |variance: f64| variance.max(0.0).sqrt();
    let (root, two) = (at(x.value), 2.0 * x.standard_uncertainty);
    let (above, below) = (at(x.value.max(0.0) + two) - root, root - at(x.value - two));
    Estimate::new(root, 0.5 * above.max(below))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalised_error_counts_expanded_uncertainties() {
        let e_n = Estimate::new(10.5, 0.3).normalised_error(Estimate::new(9.5, 0.4));
        assert!((e_n - 1.0).abs() < 1e-15, "{e_n}");
        assert_eq!(Estimate::new(1.0, 0.0).normalised_error(Estimate::new(1.0, 0.0)), 0.0);
        assert_eq!(Estimate::new(2.0, 0.0).normalised_error(Estimate::new(1.0, 0.0)), f64::INFINITY);
    }

    #[test]
    fn a_product_adds_relative_variances() {
        let inputs = [Estimate::new(3.0, 0.003), Estimate::new(5.0, 0.02)];
        let [product] = propagate(&inputs, |x| [x[0] * x[1]]);
        assert_eq!(product.value, 15.0);
        let relative = (1e-3_f64 * 1e-3 + 4e-3 * 4e-3).sqrt();
        assert!((product.standard_uncertainty / 15.0 - relative).abs() < 1e-12);
    }

    #[test]
    fn roots_of_known_and_unknown_variances() {
        let known = root(Estimate::new(4.0, 0.004));
        assert!((known.standard_uncertainty - 0.001).abs() < 1e-6);
        assert_eq!(root(Estimate::new(-1.0, 0.08)), Estimate::new(0.0, 0.2));
    }
}
