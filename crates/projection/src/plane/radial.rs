//! The rational radial factor g(s) = N(s)/D(s) of s = r², r′ = r g(r²), its inverse, and its fold.
//!
//! N = 1 + n₁ s + … + n₄ s⁴ and D = 1 + d₁ s + … + d₃ s³ cover OpenCV's k₁ … k₆ and the four coefficients of thin-prism
//! fisheyes. dr′/dr = (N D + 2 s (N′ D − N D′))/D²; the first radius at which it or D vanishes is the fold.

use crate::root::{derivative, first_sign_change, increasing, product};

/// Radius beyond which values count as infinite (6e-7° from 90° for a tangent).
const MAX_RADIUS: f64 = 1e8;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rational {
    numerator: [f64; 5],
    denominator: [f64; 4],
}

impl Rational {
    pub(super) fn new(numerator: [f64; 4], denominator: [f64; 3]) -> Self {
        let ([a, b, c, d], [e, f, g]) = (numerator, denominator);
        Self { numerator: [1.0, a, b, c, d], denominator: [1.0, e, f, g] }
    }

    /// g and dg/ds.
    pub(super) fn factor(&self, s: f64) -> [f64; 2] {
        let (n, dn) = value_and_slope(&self.numerator, s);
        let (d, dd) = value_and_slope(&self.denominator, s);
        let g = n / d;
        [g, (dn - g * dd) / d]
    }

    /// The first radius with a vanishing derivative or a pole; `None` if there is none below `reach`.
    pub(super) fn fold(&self, reach: f64) -> Option<f64> {
        let reach = reach.min(MAX_RADIUS);
        let pole = first_sign_change(&self.denominator, reach * reach);
        let stationary = first_sign_change(&self.stationary(), reach * reach);
        let first = [pole, stationary].into_iter().flatten().fold(f64::INFINITY, f64::min);
        // A few units before it, so that rounding does not land beyond a pole.
        first.is_finite().then(|| first.sqrt() * (1.0 - 4.0 * f64::EPSILON))
    }

    /// N D + 2 s (N′ D − N D′).
    fn stationary(&self) -> Vec<f64> {
        let (n, d) = (&self.numerator, &self.denominator);
        let mut sum = product(n, d);
        for (i, (a, b)) in product(&derivative(n), d).iter().zip(&product(n, &derivative(d))).enumerate() {
            sum[i + 1] += 2.0 * (a - b);
        }
        sum
    }

    /// r of r′; `None` if r would not be below `limit`.
    pub(super) fn inverse(&self, distorted: f64, limit: f64) -> Option<f64> {
        increasing(distorted, [0.0, limit], distorted, |r| {
            let [g, dg] = self.factor(r * r);
            [r * g, g + 2.0 * r * r * dg]
        })
    }
}

fn value_and_slope(c: &[f64], x: f64) -> (f64, f64) {
    let (mut value, mut slope) = (0.0, 0.0);
    for c in c.iter().rev() {
        slope = slope * x + value;
        value = value * x + c;
    }
    (value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fold_is_where_the_radius_stops_growing_or_has_a_pole() {
        // 1 − 3·0.1 s = 0.
        let fold = Rational::new([-0.1, 0.0, 0.0, 0.0], [0.0; 3]).fold(f64::INFINITY).expect("folds");
        assert!((fold - (1.0_f64 / 0.3).sqrt()).abs() < 1e-14);
        // r/(1 − r²/4): a pole at 2, rising before it.
        let pole = Rational::new([0.0; 4], [-0.25, 0.0, 0.0]).fold(f64::INFINITY).expect("pole");
        assert!((pole - 2.0).abs() < 1e-14);
        // r/(1 + r²/4) turns at 2.
        let turn = Rational::new([0.0; 4], [0.25, 0.0, 0.0]).fold(f64::INFINITY).expect("turns");
        assert!((turn - 2.0).abs() < 1e-14);
        assert!(Rational::new([0.1, 0.02, 0.0, 0.0], [0.0; 3]).fold(f64::INFINITY).is_none());
        assert!(Rational::new([-0.1, 0.0, 0.0, 0.0], [0.0; 3]).fold(1.0).is_none());
    }

    #[test]
    fn the_slope_of_the_factor_is_its_derivative() {
        let rational = Rational::new([-0.3, 0.1, -0.02, 0.001], [0.05, -0.01, 0.002]);
        let (s, h) = (0.7, 1e-6);
        let [_, dg] = rational.factor(s);
        let difference = (rational.factor(s + h)[0] - rational.factor(s - h)[0]) / (2.0 * h);
        // Central difference: ε/h.
        assert!((dg - difference).abs() < 1e-9);
    }
}
