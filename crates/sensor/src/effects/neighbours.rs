//! Exchange between a pixel and its eight neighbours: a symmetric 3 × 3 kernel, for optical crosstalk and inter-pixel capacitance.
//!
//! out(p) = in(p) + Σ w_n (in(n) − in(p)) over the neighbours n inside the array. Each pair exchanges equal amounts, so the sum is preserved to
//! rounding, a uniform plane stays uniform, and nothing crosses the array's edge.
//!
//! Optical crosstalk: light that enters one pixel and is detected in its neighbour.
//!
//! Fractions of the mean photo-electrons go to the eight neighbours ([`Neighbours`]); energy is preserved. At the array's edge a pixel keeps the
//! fraction of missing neighbours, as if the light beyond were the same. Left out: dependence on wavelength and angle, neighbours farther away.
//!
//! Inter-pixel capacitance: the voltage of a pixel couples to its neighbours.
//!
//! Fractions of the voltage are exchanged with the eight neighbours ([`Neighbours`]) after the well and the response. Counts and their noise arise
//! before it, so it correlates noise without adding any (Moore, Ninkov and Forrest 2006). Sums are preserved. Left out: dependence on the signal.

use etendue_core::quantity::{MeanElectrons, Quantity, Voltage};
use etendue_core::{EffectStatus, Plane};
use rayon::prelude::*;

use crate::effect::{Action, Context, Effect, Memory, PlaneEffect, QuantityEffect, SensorFacts, Traces};
use crate::{capture::Operation, check::Checks, signal_breakdown::SignalComponent};

/// Fractions given to each neighbour, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbours {
    /// To each neighbour left and right.
    pub horizontal: f64,
    /// To each neighbour above and below.
    pub vertical: f64,
    /// To each neighbour across a corner.
    pub corner: f64,
}

impl Neighbours {
    pub(crate) fn check(&self, key: &'static str, checks: &mut Checks) {
        for fraction in [self.horizontal, self.vertical, self.corner] {
            checks.fraction(key, fraction);
        }
        let total = self.total_fraction();
        checks.agree(key, total <= 0.75, || {
            format!("a pixel passes on {total} in total: give at most 0.75, so that it retains the largest part")
        });
    }

    /// Total fraction that a pixel gives away.
    #[must_use]
    pub fn total_fraction(&self) -> f64 {
        2.0 * self.horizontal + 2.0 * self.vertical + 4.0 * self.corner
    }

    /// The fraction of a pixel's final value that comes from the pixel `dx` − 1 columns and `dy` − 1 rows from it, away from edges; `dx` and `dy` are
    /// 0 to 2, and (1, 1) is the pixel itself.
    #[must_use]
    pub fn weight(&self, dx: usize, dy: usize) -> f64 {
        match (dx, dy) {
            (1, 1) => 1.0 - self.total_fraction(),
            (_, 1) => self.horizontal,
            (1, _) => self.vertical,
            _ => self.corner,
        }
    }

    /// The plane after the exchange.
    fn exchange<Q: Quantity<Sample = f32>>(&self, plane: &Plane<Q>) -> Plane<Q> {
        let (width, height) = (plane.width(), plane.height());
        let mut out = Plane::new(width, height);
        if width > 0 {
            let row = |y: usize| &plane.samples()[y * width..(y + 1) * width];
            out.samples_mut().par_chunks_mut(width).enumerate().for_each(|(y, out)| {
                let above = (y > 0).then(|| row(y - 1));
                let below = (y + 1 < height).then(|| row(y + 1));
                self.exchange_row(above, row(y), below, out);
            });
        }
        out
    }

    fn exchange_row(&self, above: Option<&[f32]>, here: &[f32], below: Option<&[f32]>, out: &mut [f32]) {
        let flow = |row: &[f32], x: usize, own: f64, straight: f64, across: f64| {
            let term = |fraction: f64, value: Option<&f32>| value.map_or(0.0, |v| fraction * (f64::from(*v) - own));
            let left = term(across, x.checked_sub(1).and_then(|i| row.get(i)));
            left + term(straight, row.get(x)) + term(across, row.get(x + 1))
        };
        for (x, out) in out.iter_mut().enumerate() {
            let own = f64::from(here[x]);
            let mut sum = flow(here, x, own, 0.0, self.horizontal);
            for row in [above, below].into_iter().flatten() {
                sum += flow(row, x, own, self.vertical, self.corner);
            }
            *out = (own + sum) as f32;
        }
    }
}

pub(crate) struct PreparedExchange(pub(crate) Neighbours);

impl<Q: Quantity<Sample = f32>> PlaneEffect<Q> for PreparedExchange {
    fn apply(&self, plane: Plane<Q>, _: &mut Traces<'_>) -> Plane<Q> {
        self.0.exchange(&plane)
    }
}

/// Fractions of a pixel's light detected by its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crosstalk(pub Neighbours);

impl Effect for Crosstalk {
    const NAME: &'static str = "optical crosstalk";
    const KEY: &'static str = "sensor.crosstalk";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        self.0.check("crosstalk", checks);
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        EffectStatus::Modelled(format!("{} of a pixel's light is collected by its neighbours", self.0.total_fraction()))
    }
}

impl QuantityEffect for Crosstalk {
    type Signal = MeanElectrons;
    const COMPONENT: SignalComponent = SignalComponent::Transfer;

    fn prepare(&self, _: &Context, _: &mut Memory) -> Action<MeanElectrons> {
        Action::plane(PreparedExchange(self.0))
    }
}

/// Fractions of a pixel's voltage coupled to its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterPixelCapacitance(pub Neighbours);

impl Effect for InterPixelCapacitance {
    const NAME: &'static str = "inter-pixel capacitance";
    const KEY: &'static str = "sensor.inter_pixel_capacitance";

    fn check(&self, _: &SensorFacts, checks: &mut Checks) {
        self.0.check("inter_pixel_capacitance", checks);
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        EffectStatus::Modelled(format!("{} of a pixel's voltage couples to its neighbours", self.0.total_fraction()))
    }
}

impl QuantityEffect for InterPixelCapacitance {
    type Signal = Voltage;
    const COMPONENT: SignalComponent = SignalComponent::Transfer;

    fn prepare(&self, _: &Context, _: &mut Memory) -> Action<Voltage> {
        Action::plane(PreparedExchange(self.0))
    }
}

#[cfg(test)]
mod tests {
    use etendue_core::{Plane, quantity::Voltage};

    use super::*;
    use crate::frame::tests::{ADDRESS, covariance, one_dn_an_electron, run};

    const NEIGHBOURS: Neighbours = Neighbours { horizontal: 0.02, vertical: 0.03, corner: 0.005 };

    #[test]
    fn a_point_becomes_the_kernel() {
        let mut plane = Plane::<Voltage>::new(5, 5);
        plane.set(2, 2, 1000.0);
        let out = NEIGHBOURS.exchange(&plane);
        let near = |x, y, expected: f32| assert!((out.at(x, y) - expected).abs() < 1e-3, "{x} {y}: {}", out.at(x, y));
        near(1, 2, 20.0);
        near(2, 3, 30.0);
        near(3, 1, 5.0);
        near(2, 2, 880.0);
        near(0, 2, 0.0);
    }

    #[test]
    fn sums_are_kept_and_even_planes_stay() {
        for (width, height) in [(1, 1), (1, 7), (6, 1), (7, 5)] {
            let value = |i: usize| (i * 7919 % 977) as f32;
            let plane = Plane::from_samples(width, height, (0..width * height).map(value).collect()).expect("filled");
            let sum = |plane: &Plane<Voltage>| plane.samples().iter().map(|v| f64::from(*v)).sum::<f64>();
            let out = NEIGHBOURS.exchange(&plane);
            // Samples are f32: 24 bits each.
            assert!((sum(&out) - sum(&plane)).abs() <= 6e-8 * sum(&plane).max(1.0));
            let even = Plane::<Voltage>::filled(width, height, 3.5);
            assert_eq!(NEIGHBOURS.exchange(&even), even);
        }
    }

    #[test]
    fn noise_is_correlated_and_the_variance_falls() {
        let mut p = one_dn_an_electron();
        let neighbours = Neighbours { horizontal: 0.01, vertical: 0.01, corner: 0.0 };
        p.voltage.capacitance = Some(InterPixelCapacitance(neighbours));
        let raw = run(&p, &Plane::filled(512, 512, 10_000.0), ADDRESS);
        // White noise of variance μ through the kernel: Σ k² at no shift, 2 k₀ k₁ at a shift of one (and 1/12 of rounding).
        let (own, one) = (0.96, 0.01);
        let variance = 10_000.0 * (own * own + 4.0 * one * one) + 1.0 / 12.0;
        // A variance of n numbers is known to √(2/n) = 0.28 %, a covariance to √(1/n) = 0.2 % of the variance; tolerance: four of each.
        assert!((covariance(&raw, 0, 0) / variance - 1.0).abs() < 0.011);
        assert!((covariance(&raw, 1, 0) - 10_000.0 * 2.0 * own * one).abs() < 78.0);
        assert!((covariance(&raw, 0, 1) - 10_000.0 * 2.0 * own * one).abs() < 78.0);
    }
}
