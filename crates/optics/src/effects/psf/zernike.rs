//! Zernike's circle polynomials, of root mean square one over the unit disc.
//!
//! Z = √(n + 1) R_n⁰ for m = 0, else √(2(n + 1)) R_n^|m| times cos mθ (m > 0) or sin |m|θ (m < 0), with the angle from x
//! towards y. Single indices by Noll (1976), from 1, or by ANSI Z80.28 / OSA, from 0.

use etendue_core::maths::f64::{atan2, sin_cos};
use glam::DVec2;

/// The largest radial order.
const MAX_ORDER: u32 = 12;

/// A polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Zernike {
    n: u32,
    m: i32,
}

impl Zernike {
    /// By Noll's index, from 1; `None` beyond the order 12.
    #[must_use]
    pub fn noll(index: u32) -> Option<Self> {
        let n = (0..=MAX_ORDER).find(|n| index >= 1 && index <= (n + 1) * (n + 2) / 2)?;
        let k = index - n * (n + 1) / 2 - 1;
        let m = if n.is_multiple_of(2) { 2 * k.div_ceil(2) } else { 2 * (k / 2) + 1 };
        let m = m.cast_signed();
        Some(Self { n, m: if index.is_multiple_of(2) { m } else { -m } })
    }

    /// By the index of OSA and ANSI, from 0; `None` beyond the order 12.
    #[must_use]
    pub fn osa(index: u32) -> Option<Self> {
        let n = (0..=MAX_ORDER).find(|n| index < (n + 1) * (n + 2) / 2)?;
        Some(Self { n, m: (2 * index).cast_signed() - (n * (n + 2)).cast_signed() })
    }

    /// Radial and azimuthal order.
    #[must_use]
    pub fn radial_and_azimuthal_order(&self) -> (u32, i32) {
        (self.n, self.m)
    }

    /// The polynomial at a point of the pupil; beyond the unit disc it goes on.
    #[must_use]
    pub fn at(&self, point: DVec2) -> f64 {
        let m = self.m.unsigned_abs();
        let norm = f64::from(if m == 0 { self.n + 1 } else { 2 * (self.n + 1) }).sqrt();
        let (sine, cosine) = sin_cos(f64::from(m) * atan2(point.y, point.x));
        norm * self.radial(point.length()) * if self.m < 0 { sine } else { cosine }
    }

    /// R_n^m = Σ (−1)^k (n − k)! / (k! ((n + m)/2 − k)! ((n − m)/2 − k)!) r^(n − 2k).
    fn radial(&self, r: f64) -> f64 {
        let m = self.m.unsigned_abs();
        let term = |k: u32| {
            let below = factorial(k) * factorial((self.n + m) / 2 - k) * factorial((self.n - m) / 2 - k);
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign * factorial(self.n - k) / below * (0..self.n - 2 * k).map(|_| r).product::<f64>()
        };
        (0..=(self.n - m) / 2).map(term).sum()
    }
}

fn factorial(n: u32) -> f64 {
    (1..=n).map(f64::from).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_those_of_the_tables() {
        // Noll (1976), table I; ANSI Z80.28.
        let noll =
            [(1, 0, 0), (2, 1, 1), (3, 1, -1), (4, 2, 0), (5, 2, -2), (6, 2, 2), (7, 3, -1), (8, 3, 1), (11, 4, 0)];
        for (j, n, m) in noll {
            assert_eq!(Zernike::noll(j).expect("known").radial_and_azimuthal_order(), (n, m), "Noll {j}");
        }
        let osa =
            [(0, 0, 0), (1, 1, -1), (2, 1, 1), (3, 2, -2), (4, 2, 0), (5, 2, 2), (7, 3, -1), (8, 3, 1), (12, 4, 0)];
        for (j, n, m) in osa {
            assert_eq!(Zernike::osa(j).expect("known").radial_and_azimuthal_order(), (n, m), "OSA {j}");
        }
        assert!(Zernike::noll(0).is_none() && Zernike::noll(92).is_none() && Zernike::osa(91).is_none());
    }

    #[test]
    fn they_are_orthogonal_with_root_mean_square_one() {
        let all: Vec<_> = (1..=28).filter_map(Zernike::noll).collect();
        let (rings, angles) = (400, 64);
        let mut sums = vec![0.0; all.len() * all.len()];
        for i in 0..rings * angles {
            let r = ((f64::from(i / angles) + 0.5) / f64::from(rings)).sqrt();
            let (s, c) = sin_cos(core::f64::consts::TAU * f64::from(i % angles) / f64::from(angles));
            let values: Vec<f64> = all.iter().map(|z| z.at(DVec2::new(c, s) * r)).collect();
            for (a, row) in values.iter().zip(sums.chunks_mut(all.len())) {
                values.iter().zip(row).for_each(|(b, sum)| *sum += a * b / f64::from(rings * angles));
            }
        }
        for (i, sum) in sums.iter().enumerate() {
            let expected = f64::from(u8::from(i % all.len() == i / all.len()));
            // Midpoint rule in 400 rings: second order, times the slopes of polynomials of the sixth order.
            assert!((sum - expected).abs() < 1e-3, "{i}: {sum}");
        }
    }
}
