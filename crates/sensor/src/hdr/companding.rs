//! Companding: fewer bits by straight lines of falling slope, and its inverse.
//!
//! Between the knees (x_i, y_i), from (0, 0): y = y_i + (x − x_i) s_i, s_i = (y_{i+1} − y_i)/(x_{i+1} − x_i) ≤ 1, rounded to the nearest integer.
//! Beyond the last knee y is constant. Inverse: x = x_i + (y − y_i)/s_i. As no slope exceeds 1, the round trip is exact for all numbers y. A step of
//! y is 1/s_i of x: it should stay below √12 times the noise there. Companding acts on the merged number before rounding, and after all noise.

use etendue_core::EffectStatus;

use crate::effect::{Effect, SensorFacts};
use crate::{capture::Operation, check::Checks};

/// A piecewise linear curve to fewer bits.
#[derive(Clone, Debug, PartialEq)]
pub struct Companding {
    /// Ends of the lines after (0, 0): linear number, companded number.
    pub knees: Vec<[f64; 2]>,
    /// Bits of the companded number.
    pub bits: u32,
}

impl Effect for Companding {
    const NAME: &'static str = "companding";
    const KEY: &'static str = "sensor.companding";

    /// Checked with the whole sensor, because it begins where merging ends.
    fn check(&self, _: &SensorFacts, _: &mut Checks) {}

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        EffectStatus::Modelled(format!("{} linear segments to {} bits", self.knees.len(), self.bits))
    }
}

impl Companding {
    /// Refuses a curve that does not accept numbers of this many bits, or is not invertible.
    pub(crate) fn check_curve(&self, linear_bits: u32, checks: &mut Checks) {
        checks.legal(
            "companding.bits",
            f64::from(self.bits),
            (1..=24).contains(&self.bits),
            "a whole number from 1 to 24",
        );
        if !checks.errors.is_empty() {
            return;
        }
        let largest = f64::from((1_u32 << self.bits) - 1);
        let ends = self.ends();
        let slope = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        let slopes: Vec<f64> = ends.windows(2).map(slope).collect();
        let rising = ends.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] < pair[1][1]);
        let falling = slopes.windows(2).all(|pair| pair[0] >= pair[1]) && slopes.iter().all(|s| *s <= 1.0);
        checks.agree("companding.knees", rising && falling && !slopes.is_empty(), || {
            "both numbers must increase from (0, 0), with slopes that start at 1 or less and do not increase".to_owned()
        });
        let last = ends[ends.len() - 1];
        let reaches = last[0] >= f64::from((1_u32 << linear_bits) - 1) && last[1] <= largest;
        checks.agree("companding.knees", reaches, || {
            format!(
                "the last knee must reach the maximum linear number, {}, at no more than {largest}",
                (1_u32 << linear_bits) - 1
            )
        });
    }

    fn ends(&self) -> Vec<[f64; 2]> {
        [[0.0, 0.0]].into_iter().chain(self.knees.iter().copied()).collect()
    }

    /// The companded number of a linear one, not rounded.
    #[must_use]
    pub fn companded(&self, linear: f64) -> f64 {
        along(&self.knees, linear, |[x, y]| [x, y])
    }

    /// The linear number of a companded one.
    #[must_use]
    pub fn linear(&self, companded: f64) -> f64 {
        along(&self.knees, companded, |[x, y]| [y, x])
    }
}

/// Linear interpolation from (0, 0) over the knees transformed by `turned`, constant beyond the last.
fn along(knees: &[[f64; 2]], x: f64, turned: impl Fn([f64; 2]) -> [f64; 2]) -> f64 {
    let above = knees.partition_point(|knee| turned(*knee)[0] <= x);
    let [x0, y0] = above.checked_sub(1).map_or([0.0, 0.0], |i| turned(knees[i]));
    match knees.get(above).map(|knee| turned(*knee)) {
        Some([x1, y1]) => y0 + (x.max(0.0) - x0) * ((y1 - y0) / (x1 - x0)),
        None => y0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 20 to 12 bits, as in an automotive sensor.
    fn curve() -> Companding {
        let knees = vec![[512.0, 512.0], [4096.0, 1408.0], [65_536.0, 2368.0], [1_048_575.0, 4095.0]];
        Companding { knees, bits: 12 }
    }

    #[test]
    fn the_inverse_is_exact_on_the_grid() {
        let curve = curve();
        for y in 0..4096_u32 {
            let back = curve.companded(curve.linear(f64::from(y)));
            assert_eq!(back.round_ties_even() as u32, y, "{y} came back as {back}");
        }
    }

    #[test]
    fn knees_are_on_the_curve_and_steps_are_one_over_the_slope() {
        let curve = curve();
        for [x, y] in &curve.knees {
            assert!((curve.companded(*x) - y).abs() < 1e-9 && (curve.linear(*y) - x).abs() < 1e-6);
        }
        assert_eq!((curve.companded(100.0), curve.companded(2e6)), (100.0, 4095.0));
        assert!((curve.linear(1001.0) - curve.linear(1000.0) - 4.0).abs() < 1e-9);
    }

    #[test]
    fn curves_that_cannot_be_undone_are_refused() {
        let errors = |knees: Vec<[f64; 2]>, bits| {
            let mut checks = Checks::default();
            Companding { knees, bits }.check_curve(16, &mut checks);
            checks.errors.len()
        };
        assert_eq!(errors(vec![[1000.0, 1000.0], [65_535.0, 4095.0]], 12), 0);
        assert_eq!(errors(vec![[1000.0, 1000.0], [60_000.0, 4095.0]], 12), 1);
        assert_eq!(errors(vec![[1000.0, 500.0], [2000.0, 1500.0], [65_535.0, 4095.0]], 12), 1);
        assert_eq!(errors(vec![[65_535.0, 4095.0]], 0), 1);
    }
}
