//! Measured numbers, how well they are known, and how figures that follow from them are.

use etendue_core::maths::f64::hypot;

/// A measured number with its standard uncertainty (GUM, JCGM 100:2008, 2.3.1), both in the unit that their owner states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The best value.
    pub value: f64,
    /// One standard deviation of what is not known; infinite where the picture says nothing about it.
    pub standard_uncertainty: f64,
}

impl Estimate {
    /// A number known to a standard uncertainty.
    #[must_use]
    pub fn new(value: f64, standard_uncertainty: f64) -> Self {
        Self { value, standard_uncertainty }
    }

    /// The same in a unit that is `factor` times smaller.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { value: self.value * factor, standard_uncertainty: self.standard_uncertainty * factor.abs() }
    }

    /// How far this is from `other` in expanded uncertainties (k = 2) of the difference, E_n of ISO 13528: at most 1 in
    /// magnitude where the two agree. They must not share errors. Infinite where both claim to be exact and differ, 0
    /// where they are exact and equal.
    #[must_use]
    pub fn normalised_error(self, other: Self) -> f64 {
        let difference = self.value - other.value;
        let expanded = 2.0 * hypot(self.standard_uncertainty, other.standard_uncertainty);
        if difference == 0.0 { 0.0 } else { difference / expanded }
    }
}

/// The figures `f` of independent inputs, with standard uncertainties by the law of propagation (GUM, JCGM 100:2008, 5.1.2),
/// its derivatives taken as half the difference of the figures one standard uncertainty above and below each input
/// (5.1.3, note 2). Choices that depend on the inputs (which points a fit uses) must not change inside `f`.
pub(crate) fn propagate<const N: usize>(inputs: &[Estimate], f: impl Fn(&[f64]) -> [f64; N]) -> [Estimate; N] {
    let figures = propagate_curved(inputs, |x| f(x).to_vec());
    core::array::from_fn(|k| figures[k].first_order)
}

/// A figure of noisy inputs to second order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curved {
    /// Its value, with the standard uncertainty of first order.
    pub first_order: Estimate,
    /// By how much the inputs' noise shifts it on average: half of the second differences s of its inputs.
    bias: f64,
    /// What curvature adds to its variance: s²/2 of each input (of a normal one).
    variance: f64,
}

impl Curved {
    /// Of a figure that cannot fall below 0, such as a length: its root mean square error, shift and curvature included; not known where
    /// the shift is more than an eighth of the figure. (Of a length of several components of variance V in all the shift is V/2 over it,
    /// so lengths below 2 √V are not told from 0. One that is 0 exceeds that by chance in 1 to 2 % of cases.)
    pub(crate) fn above_zero(self) -> Estimate {
        let (value, u) = (self.first_order.value, self.first_order.standard_uncertainty);
        let error = (u * u + self.variance + self.bias * self.bias).sqrt();
        Estimate::new(value, if self.bias.abs() <= 0.125 * value.abs() { error } else { f64::INFINITY })
    }
}

/// Any number of figures of independent inputs, to second order (5.1.2, note).
pub(crate) fn propagate_curved(inputs: &[Estimate], f: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Curved> {
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
    let curved = |(value, [first, bias, variance]): (&f64, [f64; 3])| Curved {
        first_order: Estimate::new(*value, first.sqrt()),
        bias,
        variance,
    };
    values.iter().zip(sums).map(curved).collect()
}

/// √x of a variance that may have come out negative: 0 then. Its uncertainty is half the way to the farther end of the 95 %
/// interval, √(x ± 2 u): u/(2 √x) where x is well known, √(u/2) where it is not told from 0.
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
