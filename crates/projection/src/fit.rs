//! One direction of a radial distortion fitted to the other.
//!
//! Programs and papers write distortion in either direction; a polynomial of one direction has no polynomial of the other
//! as its inverse, but one comes near over a picture. The fit is least squares of the radius and says how far it is off.

use crate::radial::{DistortionError, RadialDistortion, Sense};

/// A distortion fitted to another over a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The fitted distortion.
    pub distortion: RadialDistortion,
    /// The largest difference of its radius from the other's, mm, over the radii of the fit.
    pub worst_mm: f64,
}

impl RadialDistortion {
    /// The polynomial of direction `sense` and the same radius unit that comes nearest to this distortion, by least
    /// squares of the radius over the radii of a picture.
    ///
    /// # Errors
    /// Where this distortion folds inside the picture, or the fitted one does.
    pub fn fitted(&self, sense: Sense, max_observed_mm: f64) -> Result<Fit, DistortionError> {
        self.check(max_observed_mm)?;
        let samples = self.pairs(sense, max_observed_mm);
        let [k1, k2] = least_squares(&samples);
        let distortion = Self::new(sense, k1, k2, self.unit_mm())?;
        distortion.check(max_observed_mm)?;
        let worst = samples.iter().map(|[r, out]| (distortion.polynomial_at(*r) - out).abs()).fold(0.0, f64::max);
        Ok(Fit { distortion, worst_mm: worst * self.unit_mm() })
    }

    /// Argument and value, in radius units, of the map of direction `sense` over the radii of a picture.
    fn pairs(&self, sense: Sense, max_observed_mm: f64) -> Vec<[f64; 2]> {
        (1..=FIT_SAMPLES)
            .filter_map(|i| {
                let observed_mm = max_observed_mm * i as f64 / FIT_SAMPLES as f64;
                let ideal = self.ideal_radius_mm(observed_mm)? / self.unit_mm();
                let observed = observed_mm / self.unit_mm();
                Some(if sense == Sense::ObservedToIdeal { [observed, ideal] } else { [ideal, observed] })
            })
            .collect()
    }

    fn polynomial_at(&self, r: f64) -> f64 {
        self.polynomial.forward(r).unwrap_or(f64::INFINITY)
    }
}

/// Radii at which a fit compares: many more than a fifth-degree difference has turning points.
const FIT_SAMPLES: usize = 256;

/// k₁, k₂ that minimise Σ (r (1 + k₁ r² + k₂ r⁴) − r′)², by normal equations in the radius scaled to 1 at its end.
fn least_squares(samples: &[[f64; 2]]) -> [f64; 2] {
    let end = samples.iter().map(|[r, _]| *r).fold(0.0, f64::max);
    let (mut a, mut b, mut c, mut p, mut q) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for [r, out] in samples {
        let s = r / end;
        let (cubic, quintic) = (s * s * s, s * s * s * s * s);
        let rest = (out - r) / end;
        a += cubic * cubic;
        b += cubic * quintic;
        c += quintic * quintic;
        p += cubic * rest;
        q += quintic * rest;
    }
    let determinant = a * c - b * b;
    let [k1, k2] = [(p * c - q * b) / determinant, (q * a - p * b) / determinant];
    [k1 / (end * end), k2 / (end * end * end * end)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_of_the_other_direction_comes_near_and_says_how_near() {
        let d = RadialDistortion::new(Sense::IdealToObserved, -0.08, 0.01, 10.0).expect("legal");
        let fit = d.fitted(Sense::ObservedToIdeal, 5.0).expect("no fold");
        let [k1, _] = fit.distortion.coefficients();
        // Series reversal: k1 of the inverse is −k1 + O(r²).
        assert!((k1 - 0.08).abs() < 0.01, "k1 = {k1}");
        assert!(fit.worst_mm > 0.0 && fit.worst_mm < 1e-3, "{}", fit.worst_mm);
        for i in 0..=50 {
            let r = 0.1 * f64::from(i);
            let gap = fit.distortion.ideal_radius_mm(r).expect("inside") - d.ideal_radius_mm(r).expect("inside");
            // The fit's own grid is finer than this one by five; its worst is within a few per cent of the true worst.
            assert!(gap.abs() <= 1.05 * fit.worst_mm, "{gap} at {r}");
        }
        let same = d.fitted(Sense::IdealToObserved, 5.0).expect("no fold");
        // A fit to a member of the family returns it, to the conditioning of the normal equations (about 1e3 · ε).
        assert!(same.worst_mm < 1e-11, "{}", same.worst_mm);
    }
}
