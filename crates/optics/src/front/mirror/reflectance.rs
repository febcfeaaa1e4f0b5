//! Reflectance of a mirror.

use etendue_spectra::metal::ComplexIndex;

use super::super::Curve;
use crate::error::FrontError;

/// Reflectance of a mirror.
#[derive(Clone, Debug, PartialEq)]
pub enum Reflectance {
    /// A reflectance independent of the angle.
    Fraction(Curve),
    /// A bare metal: Fresnel's equations with a complex index, mean of both polarisations.
    Metal(Box<ComplexIndex>),
}

impl Reflectance {
    pub(super) fn check(&self) -> Result<(), FrontError> {
        let Self::Fraction(curve) = self else { return Ok(()) };
        let (low, high) = curve.range();
        let value = if low >= 0.0 { high } else { low };
        let right = low >= 0.0 && high <= 1.0 && high > 0.0;
        if right {
            Ok(())
        } else {
            Err(FrontError::Fraction { name: "reflectance", value, range: "0 and 1, not all 0" })
        }
    }

    /// True if it depends on the wavelength.
    #[must_use]
    pub fn varies(&self) -> bool {
        match self {
            Self::Fraction(curve) => curve.varies(),
            Self::Metal(_) => true,
        }
    }

    /// The reflectance at a wavelength and the cosine of the angle of incidence.
    #[must_use]
    pub fn at(&self, nm: f64, cosine: f64) -> f64 {
        match self {
            Self::Fraction(curve) => curve.at(nm),
            Self::Metal(index) => {
                let at = |s: &etendue_spectra::Spectrum| f64::from(s.at(nm as f32));
                metal(at(&index.n), at(&index.k), cosine)
            }
        }
    }
}

/// Fresnel reflection at a metal of index n + ik in air (Born and Wolf, "Principles of optics", 14.2): with
/// a² + b² = |(n + ik)² − sin² θ| and a² half of that plus the real part,
/// R_s = (a² + b² − 2a c + c²)/(a² + b² + 2a c + c²), R_p = R_s (a² + b² − 2a s t + s²t²)/(a² + b² + 2a s t + s²t²), t = tan θ.
fn metal(n: f64, k: f64, cosine: f64) -> f64 {
    let c2 = cosine * cosine;
    let s2 = (1.0 - c2).max(0.0);
    let real = n * n - k * k - s2;
    let sum = (real * real + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (sum + real)).max(0.0).sqrt();
    let s = (sum - 2.0 * a * cosine + c2) / (sum + 2.0 * a * cosine + c2);
    // Multiplied by cos², so that grazing light has no infinite tangent.
    let (square, mixed) = (sum * c2 + s2 * s2, 2.0 * a * cosine * s2);
    let p = s * (square - mixed) / (square + mixed);
    0.5 * (s + if square + mixed > 0.0 { p } else { s })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_metal_reflects_as_fresnel_says() {
        // Normal incidence: ((n − 1)² + k²)/((n + 1)² + k²).
        let (n, k) = (0.96, 6.69);
        let normal = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
        assert!((metal(n, k, 1.0) - normal).abs() < 1e-14);
        assert!((metal(n, k, 0.0) - 1.0).abs() < 1e-12, "grazing light is all reflected");
        // Glass (k = 0) at 60°: amplitudes r_s = (c − n c′)/(c + n c′), r_p = (n c − c′)/(n c + c′).
        let (index, c): (f64, f64) = (1.5, 0.5);
        let beyond = (1.0 - 0.75 / (index * index)).sqrt();
        let (rs, rp) = ((c - index * beyond) / (c + index * beyond), (index * c - beyond) / (index * c + beyond));
        assert!((metal(index, 0.0, c) - 0.5 * (rs * rs + rp * rp)).abs() < 1e-14);
    }
}
