//! Uncertainty of figures that follow from many independent inputs.

use crate::Estimate;

/// The figures `f` of independent inputs, with standard uncertainties by the law of propagation (GUM, JCGM 100:2008, 5.1.2),
/// its derivatives taken as half the difference of the figures one standard uncertainty above and below each input
/// (5.1.3, note 2). Choices that depend on the inputs (which points a fit uses) must not change inside `f`.
pub(crate) fn propagate<const N: usize>(inputs: &[Estimate], f: impl Fn(&[f64]) -> [f64; N]) -> [Estimate; N] {
    let mut at: Vec<f64> = inputs.iter().map(|input| input.value).collect();
    let values = f(&at);
    let mut variances = [0.0; N];
    for (i, input) in inputs.iter().enumerate().filter(|(_, input)| input.standard_uncertainty > 0.0) {
        at[i] = input.value + input.standard_uncertainty;
        let above = f(&at);
        at[i] = input.value - input.standard_uncertainty;
        let below = f(&at);
        at[i] = input.value;
        for ((variance, above), below) in variances.iter_mut().zip(above).zip(below) {
            *variance += 0.25 * (above - below) * (above - below);
        }
    }
    core::array::from_fn(|k| Estimate::new(values[k], variances[k].sqrt()))
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
