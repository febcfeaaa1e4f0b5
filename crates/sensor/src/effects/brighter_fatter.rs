//! Brighter-fatter: a full pixel repels charge, so its borders move inwards and its neighbours gain.
//!
//! The border between a pixel p and its neighbour n moves by a (q_p − q_n) pixel widths into the fuller one. During the
//! exposure the shift grows from nothing to this, half of it on average, and over it lies the mean of both charges, so
//!
//! p gives n: T = ½ a (q_p − q_n) · ½ (q_p + q_n) = ¼ a (q_p² − q_n²), over the four sides.
//!
//! What one gives the other gets: charge is conserved, and nothing crosses the array's edge. For an even picture of mean μ the
//! covariance of neighbours is a μ² and the variance μ − 4 a μ² in first order: the photon-transfer curve bends (Antilogus et
//! al. 2014; Astier et al. 2019, whose a₁₀ is a). Charges above the full well count as a full well.
//! Left out: neighbours farther away, different borders along rows and columns, colour.

use super::Verdict;
use crate::check::Checks;
use crate::operation::Context;
use crate::parameters::SensorParameters;
use etendue_core::Plane;
use etendue_core::quantity::Electrons;
use rayon::prelude::*;

pub(crate) fn check(p: &SensorParameters, checks: &mut Checks) {
    let a = p.charge.brighter_fatter_per_e;
    checks.not_negative("brighter_fatter_per_e", a);
    let full_well_e = p.hdr.captures.iter().filter_map(|c| c.full_well_e).fold(p.charge.full_well_e, f64::max);
    checks.agree("brighter_fatter_per_e", a * full_well_e <= 0.25, || {
        format!(
            "a full well would move its borders by {} pixels, and the model holds for small shifts: give at most {}",
            a * full_well_e,
            0.25 / full_well_e
        )
    });
}

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    match p.charge.brighter_fatter_per_e {
        0.0 => (Verdict::Skipped, super::NOT_DESCRIBED.into()),
        a => (Verdict::Required, format!("borders move by {a} pixels an electron")),
    }
}

/// Brighter-fatter, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PreparedBrighterFatter {
    quarter: f64,
    full_well_e: f64,
}

impl PreparedBrighterFatter {
    pub(crate) fn new(context: &Context<'_>) -> Self {
        let quarter = 0.25 * context.p.charge.brighter_fatter_per_e;
        Self { quarter, full_well_e: context.operation.full_well_e }
    }

    pub(crate) fn apply(&self, plane: &Plane<Electrons>) -> Plane<Electrons> {
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
            let given: f64 = sides.into_iter().chain(rows).flatten().map(|q| own - square(q)).sum();
            *out = (f64::from(here[x]) - self.quarter * given) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::tests::{ADDRESS, covariance, one_dn_an_electron, quiet, run};

    #[test]
    fn flat_pictures_get_the_variance_and_covariance_of_the_model() {
        let (mu, a) = (50_000.0, 5e-7);
        let mut p = one_dn_an_electron();
        (p.charge.full_well_e, p.charge.brighter_fatter_per_e) = (2e5, a);
        let raw = run(&p, &Plane::filled(1024, 1024, mu as f32), ADDRESS);
        // Linear in the fluctuations: the kernel 1 − 2aμ and aμ/2 on each side, and 1/12 of rounding.
        let (own, side) = (1.0 - 2.0 * a * mu, 0.5 * a * mu);
        let variance = mu * (own * own + 4.0 * side * side) + 1.0 / 12.0;
        let one = mu * 2.0 * own * side;
        // 2²⁰ pixels know a variance to 0.14 % and a covariance to 0.1 % of the variance; four of each.
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
        (p.charge.full_well_e, p.charge.brighter_fatter_per_e) = (1e5, 2.5e-6);
        let value = |i: usize| if i.is_multiple_of(7) { 100_000.0 } else { (i * 7919 % 977) as f32 };
        let plane = Plane::from_samples(20, 15, (0..300).map(value).collect()).expect("filled");
        let context = crate::frame::tests::context(&p, 20, 15);
        let out = PreparedBrighterFatter::new(&context).apply(&plane);
        let sum = |p: &Plane<Electrons>| p.samples().iter().map(|q| f64::from(*q)).sum::<f64>();
        assert!((sum(&out) / sum(&plane) - 1.0).abs() < 1e-7);
        assert!(out.samples().iter().all(|q| *q >= 0.0));
        let refused = |p: &SensorParameters| {
            let mut checks = Checks::default();
            check(p, &mut checks);
            !checks.errors.is_empty()
        };
        assert!(!refused(&p));
        // A capture with a larger well, too.
        let larger = crate::hdr::Capture { full_well_e: Some(2e5), ..crate::hdr::Capture::default() };
        assert!(refused(&SensorParameters {
            hdr: crate::hdr::HighDynamicRange { captures: vec![larger], ..Default::default() },
            ..p.clone()
        }));
        p.charge.brighter_fatter_per_e = 1e-5;
        assert!(refused(&p));
    }
}
