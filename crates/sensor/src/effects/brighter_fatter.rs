//! Brighter-fatter effect: a full pixel repels charge, so its borders move inwards and its neighbours gain.
//!
//! The border between a pixel p and its neighbour n moves by a (q_p − q_n) pixel widths into the fuller one. During the exposure the shift grows from
//! zero to this value, half of it on average; the charge in the shifted area is the mean of both charges, so
//!
//! p gives n: T = ½ a (q_p − q_n) · ½ (q_p + q_n) = ¼ a (q_p² − q_n²), over the four sides.
//!
//! Charge is conserved, and nothing crosses the array's edge. For a uniform image of mean μ the covariance of neighbours is a μ² and the variance μ −
//! 4 a μ² in first order: the photon-transfer curve bends (Antilogus et al. 2014; Astier et al. 2019, whose a₁₀ is a). Charges above the full well
//! count as a full well. Left out: neighbours farther away, different borders along rows and columns, colour.

use etendue_core::{EffectStatus, Plane, quantity::Charge};
use rayon::prelude::*;

use crate::effect::{Action, Context, Effect, Memory, PlaneEffect, QuantityEffect, SensorFacts, Traces};
use crate::{capture::Operation, check::Checks, signal_breakdown::SignalComponent};

/// Pixel borders shifted by charge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BrighterFatter {
    /// Shift of a pixel's border by its own charge, pixels per electron, 0 or more; 0: none.
    pub shift_per_e: f64,
}

impl Effect for BrighterFatter {
    const NAME: &'static str = "brighter-fatter";
    const KEY: &'static str = "sensor.brighter_fatter_per_e";

    fn check(&self, facts: &SensorFacts, checks: &mut Checks) {
        let (a, full_well_e) = (self.shift_per_e, facts.max_full_well_e);
        checks.not_negative("brighter_fatter_per_e", a);
        checks.agree("brighter_fatter_per_e", a * full_well_e <= 0.25, || {
            format!(
                "a full well would shift the pixel's borders by {} pixels, and the model is valid for small shifts: give at most {}",
                a * full_well_e,
                0.25 / full_well_e
            )
        });
    }

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        match self.shift_per_e {
            0.0 => EffectStatus::NotDescribed,
            a => EffectStatus::Modelled(format!("borders shift by {a} pixels per electron")),
        }
    }
}

impl QuantityEffect for BrighterFatter {
    type Signal = Charge;
    const COMPONENT: SignalComponent = SignalComponent::Transfer;

    fn prepare(&self, context: &Context, _: &mut Memory) -> Action<Charge> {
        Action::plane(PreparedBrighterFatter::new(self.shift_per_e, context.operation.full_well_e))
    }
}

/// Brighter-fatter, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PreparedBrighterFatter {
    quarter: f64,
    full_well_e: f64,
}

impl PlaneEffect<Charge> for PreparedBrighterFatter {
    fn apply(&self, plane: Plane<Charge>, _: &mut Traces<'_>) -> Plane<Charge> {
        self.moved(&plane)
    }
}

impl PreparedBrighterFatter {
    fn new(shift_per_e: f64, full_well_e: f64) -> Self {
        Self { quarter: 0.25 * shift_per_e, full_well_e }
    }

    fn moved(&self, plane: &Plane<Charge>) -> Plane<Charge> {
        let (width, height) = (plane.width(), plane.height());
        let mut out = Plane::new(width, height);
        if width == 0 {
            return out;
        }
        let row = |y: usize| &plane.samples()[y * width..(y + 1) * width];
        out.samples_mut().par_chunks_mut(width).enumerate().for_each(|(y, out)| {
            let near = [(y > 0).then(|| row(y - 1)), (y + 1 < height).then(|| row(y + 1))];
            self.row(row(y), near, out);
        });
        out
    }

    fn row(&self, here: &[f32], near: [Option<&[f32]>; 2], out: &mut [f32]) {
        let square = |q: f32| {
            let q = f64::from(q).clamp(0.0, self.full_well_e);
            q * q
        };
        for (x, out) in out.iter_mut().enumerate() {
            let own = square(here[x]);
            let sides = [x.checked_sub(1).map(|i| here[i]), here.get(x + 1).copied()];
            let rows = near.map(|row| row.map(|row| row[x]));
            let given_away: f64 = sides.into_iter().chain(rows).flatten().map(|q| own - square(q)).sum();
            *out = (f64::from(here[x]) - self.quarter * given_away) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::tests::{ADDRESS, covariance, one_dn_an_electron, quiet, run};
    use crate::parameters::SensorParameters;

    #[test]
    fn flat_images_get_the_variance_and_covariance_of_the_model() {
        let (mu, a) = (50_000.0, 5e-7);
        let mut p = one_dn_an_electron();
        (p.charge.full_well.capacity_e, p.charge.brighter_fatter.shift_per_e) = (2e5, a);
        let raw = run(&p, &Plane::filled(1024, 1024, mu as f32), ADDRESS);
        // Linear in the fluctuations: the kernel 1 − 2aμ and aμ/2 on each side, and 1/12 of rounding.
        let (own, side) = (1.0 - 2.0 * a * mu, 0.5 * a * mu);
        let variance = mu * (own * own + 4.0 * side * side) + 1.0 / 12.0;
        let one = mu * 2.0 * own * side;
        // 2²⁰ pixels give a variance to 0.14 % and a covariance to 0.1 % of the variance; tolerance: four of each.
        assert!((covariance(&raw, 0, 0) / variance - 1.0).abs() < 5.6e-3);
        for (dx, dy) in [(1, 0), (0, 1)] {
            assert!((covariance(&raw, dx, dy) - one).abs() < 4e-3 * mu, "{}", covariance(&raw, dx, dy));
            // In first order a μ², to the size of the second order.
            assert!((one / (a * mu * mu) - 1.0).abs() < 0.06);
        }
        assert!((covariance(&raw, 2, 0)).abs() < 4e-3 * mu + mu * side * side);
    }

    #[test]
    fn charge_is_kept_and_never_negative() {
        let mut p = quiet();
        (p.charge.full_well.capacity_e, p.charge.brighter_fatter.shift_per_e) = (1e5, 2.5e-6);
        let value = |i: usize| if i.is_multiple_of(7) { 100_000.0 } else { (i * 7919 % 977) as f32 };
        let plane = Plane::from_samples(20, 15, (0..300).map(value).collect()).expect("filled");
        let out = PreparedBrighterFatter::new(2.5e-6, 1e5).moved(&plane);
        let sum = |p: &Plane<Charge>| p.samples().iter().map(|q| f64::from(*q)).sum::<f64>();
        assert!((sum(&out) / sum(&plane) - 1.0).abs() < 1e-7);
        assert!(out.samples().iter().all(|q| *q >= 0.0));
        let refused = |p: &SensorParameters| {
            let mut checks = Checks::default();
            p.charge.brighter_fatter.check(&p.facts(), &mut checks);
            !checks.errors.is_empty()
        };
        assert!(!refused(&p));
        // A capture with a larger well, too.
        let larger = crate::hdr::Capture { full_well_e: Some(2e5), ..crate::hdr::Capture::default() };
        assert!(refused(&SensorParameters {
            hdr: crate::hdr::HighDynamicRange { captures: vec![larger], ..Default::default() },
            ..p.clone()
        }));
        p.charge.brighter_fatter.shift_per_e = 1e-5;
        assert!(refused(&p));
    }
}
