//! Distortion of the image plane: rational radial, tangential and thin-prism terms.
//!
//! ```text
//! x′ = x g(r²) + 2 p₁ x y + p₂ (r² + 2 x²) + s₁ r² + s₂ r⁴
//! y′ = y g(r²) + p₁ (r² + 2 y²) + 2 p₂ x y + s₃ r² + s₄ r⁴          r² = x² + y²
//! g(s) = (1 + n₁ s + n₂ s² + n₃ s³ + n₄ s⁴)/(1 + d₁ s + d₂ s² + d₃ s³)
//! ```
//!
//! (Brown 1971, Weng, Cohen & Herniou 1992; the order and signs of OpenCV's `projectPoints`.) It is defined on the largest disc about the axis in
//! which its Jacobian determinant stays positive; at the disc's edge and beyond the result is `None`.

use core::f64::consts::TAU;

use etendue_core::maths::f64::{atan, sin_cos, tan};
use glam::{DMat2, DVec2};

use super::radial::Rational;
use crate::rectilinear::{ModelError, finite_list};
use crate::root::crossing;

/// The coefficients of a distortion; all zero for none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DistortionTerms {
    /// n₁ … n₄: the radial numerator (k₁, k₂, k₃ of OpenCV; k₁ … k₄ of thin-prism fisheyes).
    pub numerator: [f64; 4],
    /// d₁ … d₃: the radial denominator (k₄, k₅, k₆ of OpenCV).
    pub denominator: [f64; 3],
    /// p₁, p₂.
    pub tangential: [f64; 2],
    /// s₁ … s₄.
    pub prism: [f64; 4],
}

impl DistortionTerms {
    /// Refuses non-finite values.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        finite_list("radial numerator ", 1, &self.numerator)?;
        finite_list("radial denominator ", 1, &self.denominator)?;
        finite_list("p", 1, &self.tangential)?;
        finite_list("s", 1, &self.prism)
    }

    fn radial(&self) -> Rational {
        Rational::new(self.numerator, self.denominator)
    }

    fn is_radial(&self) -> bool {
        self.tangential == [0.0; 2] && self.prism == [0.0; 4]
    }
}

/// The map from the ideal point to the distorted one, and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distortion {
    terms: DistortionTerms,
    limit: f64,
    folds: bool,
}

impl Distortion {
    /// The distortion of a plane whose ideal points lie within `reach`.
    pub(crate) fn new(terms: DistortionTerms, reach: f64) -> Self {
        let limit = terms.radial().fold(reach).unwrap_or(reach);
        let mut distortion = Self { terms, limit, folds: limit < reach };
        if !terms.is_radial()
            && let Some(fold) = distortion.first_fold()
        {
            distortion = Self { limit: fold, folds: true, ..distortion };
        }
        distortion
    }

    /// Coefficients.
    #[must_use]
    pub fn terms(&self) -> DistortionTerms {
        self.terms
    }

    /// The ideal radius of the fold; `None` if there is none.
    #[must_use]
    pub fn fold(&self) -> Option<f64> {
        self.folds.then_some(self.limit)
    }

    /// The distorted point of an ideal one; `None` at the fold and beyond.
    #[must_use]
    pub fn distorted(&self, ideal: DVec2) -> Option<DVec2> {
        (ideal.length() < self.limit).then(|| self.image(ideal)).filter(|p| p.is_finite())
    }

    /// The ideal point of a distorted one; `None` if no point before the fold maps to it.
    #[must_use]
    pub fn ideal(&self, distorted: DVec2) -> Option<DVec2> {
        if !distorted.is_finite() {
            return None;
        }
        let guess = self.radial_ideal(distorted);
        if self.terms.is_radial() {
            return guess;
        }
        // Beyond the image of the disc's edge by the radial terms alone, the search starts at the edge.
        let guess = guess.unwrap_or_else(|| distorted * (self.limit / distorted.length()));
        let ideal = self.newton(distorted, guess).or_else(|| self.continued_newton(distorted))?;
        (ideal.length() < self.limit).then_some(ideal)
    }

    /// Distorted area per ideal area at an ideal point.
    pub(crate) fn area_ratio(&self, ideal: DVec2) -> f64 {
        self.jacobian(ideal).determinant()
    }

    fn image(&self, p: DVec2) -> DVec2 {
        let (s, cross) = (p.length_squared(), 2.0 * p.x * p.y);
        let ([p1, p2], [s1, s2, s3, s4]) = (self.terms.tangential, self.terms.prism);
        let [g, _] = self.terms.radial().factor(s);
        DVec2::new(
            p.x * g + p1 * cross + p2 * (s + 2.0 * p.x * p.x) + s * (s1 + s * s2),
            p.y * g + p1 * (s + 2.0 * p.y * p.y) + p2 * cross + s * (s3 + s * s4),
        )
    }

    fn jacobian(&self, p: DVec2) -> DMat2 {
        let s = p.length_squared();
        let ([p1, p2], [s1, s2, s3, s4]) = (self.terms.tangential, self.terms.prism);
        let [g, dg] = self.terms.radial().factor(s);
        let radial = |a: f64, b: f64| 2.0 * a * b * dg;
        let prism = [2.0 * (s1 + 2.0 * s * s2), 2.0 * (s3 + 2.0 * s * s4)];
        let off_x = radial(p.x, p.y) + 2.0 * p1 * p.x + 2.0 * p2 * p.y;
        DMat2::from_cols_array(&[
            g + radial(p.x, p.x) + 2.0 * p1 * p.y + 6.0 * p2 * p.x + prism[0] * p.x,
            off_x + prism[1] * p.x,
            off_x + prism[0] * p.y,
            g + radial(p.y, p.y) + 6.0 * p1 * p.y + 2.0 * p2 * p.x + prism[1] * p.y,
        ])
    }

    /// The ideal point of a distorted one by the radial terms alone; `None` if it is not in the disc.
    fn radial_ideal(&self, distorted: DVec2) -> Option<DVec2> {
        let r = distorted.length();
        let ideal = self.terms.radial().inverse(r, self.limit)?;
        Some(if r > 0.0 { distorted * (ideal / r) } else { distorted })
    }

    /// Damped Newton from `p`: steps are halved until the residual falls. `None` if it does not converge.
    fn newton(&self, distorted: DVec2, mut p: DVec2) -> Option<DVec2> {
        let scale = 1.0 + distorted.length();
        let mut error = self.image(p) - distorted;
        for _ in 0..60 {
            let step = self.jacobian(p).inverse() * error;
            let Some((next, left)) = self.nearer(distorted, p, step, error.length()) else {
                break;
            };
            (p, error) = (next, left);
            if error.length() <= f64::EPSILON * distorted.length() {
                break;
            }
        }
        // Rounding of a residual: a few dozen operations on numbers of this size.
        (error.length() <= 1e-14 * scale).then_some(p)
    }

    /// The longest of the step and its halves that lowers the residual within the disc.
    fn nearer(&self, distorted: DVec2, p: DVec2, step: DVec2, residual: f64) -> Option<(DVec2, DVec2)> {
        (0..30).map(|i| p - step / f64::from(1 << i)).find_map(|next| {
            let error = self.image(next) - distorted;
            (next.length() <= self.limit && error.length() < residual).then_some((next, error))
        })
    }

    /// Newton along the straight line from the axis to the point, used if it fails from the radial guess.
    fn continued_newton(&self, distorted: DVec2) -> Option<DVec2> {
        const STAGES: i32 = 64;
        (1..=STAGES).try_fold(DVec2::ZERO, |p, i| self.newton(distorted * (f64::from(i) / f64::from(STAGES)), p))
    }

    /// The smallest radius in any direction at which the determinant vanishes within the limit.
    fn first_fold(&self) -> Option<f64> {
        const DIRECTIONS: i32 = 64;
        let (width, radii) = (TAU / f64::from(DIRECTIONS), self.scanned_radii());
        let folds =
            (0..DIRECTIONS).map(|i| f64::from(i) * width).map(|azimuth| (self.fold_towards(azimuth, &radii), azimuth));
        let (nearest, azimuth) = folds.fold((f64::INFINITY, 0.0), |a, b| if b.0 < a.0 { b } else { a });
        nearest.is_finite().then(|| self.min_fold([azimuth - width, azimuth + width], &radii).min(nearest))
    }

    /// The radii between which a change of sign is searched: equal steps of the angle, up to the limit.
    fn scanned_radii(&self) -> Vec<f64> {
        const STEPS: i32 = 256;
        let end = atan(self.limit);
        (0..=STEPS).map(|i| tan(end * f64::from(i) / f64::from(STEPS)).min(self.limit)).collect()
    }

    /// The fold's smallest radius over a range of azimuths with a single minimum, by golden section.
    fn min_fold(&self, [mut low, mut high]: [f64; 2], radii: &[f64]) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let mut minimum = f64::INFINITY;
        // The radius has a minimum there: its error is the square of the azimuth's, 1e-4.
        for _ in 0..18 {
            let (a, b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
            let (at_a, at_b) = (self.fold_towards(a, radii), self.fold_towards(b, radii));
            minimum = minimum.min(at_a).min(at_b);
            if at_a < at_b {
                high = b;
            } else {
                low = a;
            }
        }
        minimum
    }

    /// The first radius towards an azimuth at which the determinant vanishes within the limit; infinite if there is none.
    fn fold_towards(&self, azimuth: f64, radii: &[f64]) -> f64 {
        let (sin, cos) = sin_cos(azimuth);
        let determinant = |r: f64| self.area_ratio(DVec2::new(cos, sin) * r);
        let mut negative = radii.iter().map(|r| determinant(*r) < 0.0);
        let Some(first) = negative.next() else { return f64::INFINITY };
        let Some(i) = negative.position(|sign| sign != first) else { return f64::INFINITY };
        crossing([radii[i], radii[i + 1]], determinant).unwrap_or(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real() -> DistortionTerms {
        DistortionTerms {
            numerator: [-0.28, 0.07, 0.01, 0.0],
            denominator: [0.02, -0.005, 0.001],
            tangential: [0.0012, -0.0007],
            prism: [0.002, -0.001, 0.0015, 0.0004],
        }
    }

    #[test]
    fn the_jacobian_is_the_derivative() {
        let d = Distortion::new(real(), 1e3);
        let (p, h) = (DVec2::new(0.4, -0.3), 1e-6);
        let slope = |step: DVec2| (d.image(p + step) - d.image(p - step)) / (2.0 * h);
        let expected = DMat2::from_cols(slope(DVec2::X * h), slope(DVec2::Y * h));
        let gap = d.jacobian(p) - expected;
        // Central differences: ε/h.
        assert!(gap.to_cols_array().iter().all(|g| g.abs() < 1e-9), "{gap}");
    }

    #[test]
    fn nothing_folds_inside_the_disc_and_something_does_at_its_rim() {
        let d = Distortion::new(real(), 1e3);
        let limit = d.fold().expect("folds");
        let around = |r: f64| (0..2000).map(move |i| r * DVec2::from(sin_cos(TAU * f64::from(i) / 2000.0)));
        for fraction in [0.1, 0.5, 0.9, 0.999_99] {
            assert!(around(limit * fraction).all(|p| d.area_ratio(p) > 0.0), "at {fraction}");
        }
        assert!(around(limit * 1.000_01).any(|p| d.area_ratio(p) < 0.0));
        assert!(d.distorted(DVec2::new(limit, 0.0)).is_none());
    }

    #[test]
    fn the_inverse_inverts_up_to_the_rim() {
        let d = Distortion::new(real(), 1e3);
        let limit = d.fold().expect("folds");
        for i in 0..1000 {
            let (r, azimuth) = (limit * f64::from(i) / 1001.0, 2.4 * f64::from(i));
            let p = r * DVec2::from(sin_cos(azimuth));
            let there = d.distorted(p).expect("inside");
            let back = d.ideal(there).and_then(|p| d.distorted(p)).expect("inside");
            assert!((back - there).length() < 3e-14 * (1.0 + there.length()), "{i}: {back} for {there}");
        }
        assert!(d.ideal(DVec2::splat(1e3)).is_none() && d.ideal(DVec2::NAN).is_none());
    }
}
