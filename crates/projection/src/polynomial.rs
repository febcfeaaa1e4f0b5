//! The even radial polynomial r′ = r (1 + k₁ r² + k₂ r⁴), its inverse, and where it folds.
//!
//! The first radius at which dr′/dr = 1 + 3 k₁ r² + 5 k₂ r⁴ vanishes is the fold: beyond it two radii would share one
//! image. Only the branch from 0 to the fold exists here; beyond it every function answers `None`.
//! r is dimensionless: its unit is the caller's ([`RadialDistortion`](crate::RadialDistortion) states it).

use crate::root::increasing;

/// r (1 + k₁ r² + k₂ r⁴) on [0, fold).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadialPolynomial {
    k1: f64,
    k2: f64,
    fold: f64,
}

impl RadialPolynomial {
    /// The polynomial with these coefficients.
    #[must_use]
    pub fn new(k1: f64, k2: f64) -> Self {
        Self { k1, k2, fold: fold(k1, k2) }
    }

    /// The coefficients k₁ and k₂.
    #[must_use]
    pub fn coefficients(&self) -> [f64; 2] {
        [self.k1, self.k2]
    }

    /// The first radius with a vanishing derivative; infinite where there is none.
    #[must_use]
    pub fn fold(&self) -> f64 {
        self.fold
    }

    /// The value at the fold: the least upper bound of what [`forward`](Self::forward) returns.
    #[must_use]
    pub fn fold_value(&self) -> f64 {
        if self.fold.is_finite() { self.value(self.fold) } else { f64::INFINITY }
    }

    /// r′ of r ≥ 0; `None` at the fold and beyond.
    #[must_use]
    pub fn forward(&self, r: f64) -> Option<f64> {
        (r < self.fold).then(|| self.value(r))
    }

    /// The derivative dr′/dr.
    #[must_use]
    pub fn derivative(&self, r: f64) -> f64 {
        let s = r * r;
        1.0 + s * (3.0 * self.k1 + s * 5.0 * self.k2)
    }

    /// r of r′ ≥ 0 on the branch before the fold, by Newton's method kept in a bracket, to the last few units in the
    /// last place (looser only where the fold itself makes the root ill-conditioned); `None` beyond the fold's value.
    #[must_use]
    pub fn inverse(&self, value: f64) -> Option<f64> {
        if value.is_nan() || value >= self.fold_value() {
            return None;
        }
        increasing(value, [0.0, self.bracket(value)], value, |r| [self.value(r), self.derivative(r)])
    }

    fn value(&self, r: f64) -> f64 {
        let s = r * r;
        r * (1.0 + s * (self.k1 + s * self.k2))
    }

    /// An upper bound of the root of `value`.
    fn bracket(&self, value: f64) -> f64 {
        let mut high = value.max(f64::MIN_POSITIVE);
        while high < self.fold && self.value(high) <= value {
            high *= 2.0;
        }
        high.min(self.fold)
    }
}

/// The smallest positive root in r of 1 + 3 k₁ r² + 5 k₂ r⁴; infinite where there is none.
fn fold(k1: f64, k2: f64) -> f64 {
    let (a, b) = (5.0 * k2, 3.0 * k1);
    let discriminant = b * b - 4.0 * a;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // Both roots without cancellation: q = −(b + sign(b) √D)/2, s = 1/q and s = q/a (the constant term is 1).
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let roots = [1.0 / q, q / a];
    roots.into_iter().filter(|s| *s > 0.0 && s.is_finite()).fold(f64::INFINITY, f64::min).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_fold_is_the_first_zero_of_the_derivative() {
        assert_eq!(RadialPolynomial::new(0.1, 0.02).fold(), f64::INFINITY);
        assert_eq!(RadialPolynomial::new(0.0, 0.0).fold(), f64::INFINITY);
        // 1 − 3·0.1·r² = 0.
        assert!((RadialPolynomial::new(-0.1, 0.0).fold() - (1.0_f64 / 0.3).sqrt()).abs() < 1e-15);
        for (k1, k2) in [(-0.3, 0.01), (-0.4, 0.05), (0.2, -0.1), (0.0, -1.0), (-1e-9, -1e-3)] {
            let p = RadialPolynomial::new(k1, k2);
            assert!(p.derivative(p.fold()).abs() < 1e-9, "k1 {k1}, k2 {k2}: fold {}", p.fold());
            for i in 0..100 {
                assert!(p.derivative(p.fold() * f64::from(i) / 100.0) > 0.0, "an earlier zero");
            }
        }
    }

    #[test]
    fn beyond_the_fold_there_is_nothing() {
        let p = RadialPolynomial::new(-0.1, 0.0);
        assert!(p.forward(p.fold()).is_none() && p.forward(10.0).is_none());
        assert!(p.inverse(p.fold_value()).is_none() && p.inverse(f64::NAN).is_none());
        assert!(p.forward(p.fold() * 0.999).is_some() && p.inverse(p.fold_value() * 0.999).is_some());
    }

    proptest! {
        #[test]
        fn the_inverse_inverts(k1 in -0.5..0.5f64, k2 in -0.2..0.2f64, share in 0.0..0.98f64) {
            let p = RadialPolynomial::new(k1, k2);
            let r = share * p.fold().min(4.0);
            let back = p.inverse(p.forward(r).expect("before the fold")).expect("before the fold");
            // The root's condition number is r′/(r · dr′/dr) ≤ 1/0.04 at 98 % of the fold.
            prop_assert!((back - r).abs() <= 1e-12 * r, "{back} for {r}");
        }
    }
}
