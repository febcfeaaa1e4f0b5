//! Lateral colour: an image whose size depends on the wavelength.
//!
//! At the wavelength λ the image is m(λ) times as large as at 587.56 nm, about the principal point: the light of λ at a sensor
//! point s looks where that of 587.56 nm does at s/m(λ), before any distortion. m is linear between the points of the table
//! and holds beyond its ends; only ratios count, so the table is divided by its value at 587.56 nm. Weights stay those of the
//! sensor point itself. Typical lenses keep |m − 1| below 0.002. Left out: displacements that are not proportional to the
//! distance from the axis (a prescription brings its own).

use crate::error::OpticsError;
use crate::wavelength::PRINCIPAL_NM;

/// Image size by wavelength over that at 587.56 nm.
#[derive(Clone, Debug, PartialEq)]
pub struct LateralColour {
    points: Vec<(f64, f64)>,
}

impl LateralColour {
    /// The table of wavelengths (nm, rising) and magnifications (above 0).
    ///
    /// # Errors
    /// Where the points are not so, or fewer than two.
    pub fn new(mut points: Vec<(f64, f64)>) -> Result<Self, OpticsError> {
        let rising = points.windows(2).all(|pair| pair[1].0 > pair[0].0);
        let legal = points.iter().all(|(nm, m)| nm.is_finite() && m.is_finite() && *nm > 0.0 && *m > 0.0);
        if points.len() < 2 || !rising || !legal {
            return Err(OpticsError::LateralColour);
        }
        let principal = interpolated(&points, PRINCIPAL_NM);
        points.iter_mut().for_each(|(_, m)| *m /= principal);
        Ok(Self { points })
    }

    /// The magnification at a wavelength; 1 at 587.56 nm.
    #[must_use]
    pub fn at(&self, nm: f64) -> f64 {
        if nm == PRINCIPAL_NM { 1.0 } else { interpolated(&self.points, nm) }
    }
}

fn interpolated(points: &[(f64, f64)], nm: f64) -> f64 {
    let after = points.partition_point(|(at, _)| *at <= nm);
    match (points.get(after.wrapping_sub(1)), points.get(after)) {
        (Some((a, m)), Some((b, n))) => m + (n - m) * (nm - a) / (b - a),
        (Some((_, m)), None) | (None, Some((_, m))) => *m,
        (None, None) => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_linear_between_its_points_and_one_at_the_d_line() {
        let table = LateralColour::new(vec![(450.0, 1.002), (550.0, 1.001), (650.0, 0.999)]).expect("a table");
        let d = 1.001 - 0.002 * (PRINCIPAL_NM - 550.0) / 100.0;
        for (nm, m) in [(300.0, 1.002), (450.0, 1.002), (500.0, 1.0015), (600.0, 1.0), (650.0, 0.999), (900.0, 0.999)] {
            assert!((table.at(nm) - m / d).abs() < 1e-15, "{nm}");
        }
        assert_eq!(table.at(PRINCIPAL_NM), 1.0);
        let wrong = [vec![], vec![(500.0, 1.0)], vec![(500.0, 1.0), (500.0, 1.1)], vec![(500.0, 1.0), (600.0, 0.0)]];
        assert!(wrong.into_iter().all(|points| LateralColour::new(points).is_err()));
    }
}
