//! Dyed cotton, by what its dyes absorb.
//!
//! Kubelka & Munk (1931): an opaque layer reflects R = 1 + q − √(q² + 2q), with q = K/S the ratio of absorption to
//! scattering; q = (1 − R)²/2R turns it round. Dyes add their absorption: q(λ) = q(cotton) + Σ sₖ exp(−½((λ − λₖ)/wₖ)²).
//! Textile dyes absorb little beyond 750 nm, so that cloth of any colour is bright in the infrared, as it is in fact.
//!
//! **Left out:** brighteners, the loss of scattering in wet cloth, carbon black (which absorbs infrared too).

use super::named;
use crate::Spectrum;
use etendue_core::maths;

/// A band of absorption.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dye {
    /// Wavelength of the strongest absorption, nm.
    pub centre_nm: f64,
    /// Standard deviation, above 0, nm.
    pub width_nm: f64,
    /// K/S at the centre, 0 or more: 1 is pale, 10 deep.
    pub strength: f64,
}

impl Dye {
    fn absorption(&self, nm: f64) -> f64 {
        let x = (nm - self.centre_nm) / self.width_nm;
        self.strength * maths::f64::exp(-0.5 * x * x)
    }
}

/// The reflectance of cotton with dyes in it.
#[must_use]
pub fn dyed_cotton(dyes: &[Dye]) -> Spectrum {
    let cotton = named("cotton").expect("cotton is in the table");
    Spectrum::from_fn(|nm| {
        let bare = ratio(f64::from(cotton.at(nm as f32)));
        reflectance(bare + dyes.iter().map(|dye| dye.absorption(nm)).sum::<f64>())
    })
}

/// K/S of an opaque layer that reflects `r`.
fn ratio(r: f64) -> f64 {
    (1.0 - r) * (1.0 - r) / (2.0 * r)
}

/// What an opaque layer of this K/S reflects.
fn reflectance(q: f64) -> f64 {
    // 1 + q − √(q² + 2q), without taking nearly equal numbers from each other.
    1.0 / (1.0 + q + (q * q + 2.0 * q).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_dye_it_is_cotton() {
        let (bare, cotton) = (dyed_cotton(&[]), named("cotton").expect("cotton"));
        for nm in [300.0, 431.0, 700.0, 1100.0] {
            assert!((bare.at(nm) - cotton.at(nm)).abs() < 1e-6, "stored in single precision: {nm} nm");
        }
    }

    #[test]
    fn known_ratios() {
        // R = 1/2: (1/2)²/1 = 1/4; 1 + 1/4 − √(1/16 + 1/2) = 1/2.
        assert!((ratio(0.5) - 0.25).abs() < 1e-15 && (reflectance(0.25) - 0.5).abs() < 1e-15);
        assert_eq!(reflectance(0.0), 1.0);
        assert!((reflectance(1e6) - 0.5e-6).abs() < 1e-11, "1/2q where little comes back");
    }

    #[test]
    fn dye_darkens_its_band_and_leaves_the_infrared() {
        let indigo = |strength| dyed_cotton(&[Dye { centre_nm: 650.0, width_nm: 50.0, strength }]);
        let (pale, deep) = (indigo(0.5), indigo(8.0));
        assert!(deep.at(650.0) < 0.06 && pale.at(650.0) > 0.3 && deep.at(450.0) > 0.6);
        assert!((deep.at(1000.0) - named("cotton").expect("cotton").at(1000.0)).abs() < 1e-4);
        assert!(deep.min_value() > 0.0 && deep.max_value() < 1.0);
    }
}
