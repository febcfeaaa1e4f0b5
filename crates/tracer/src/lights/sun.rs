//! The sun: a disc of uniform radiance at infinity.
//!
//! A disc of half angle δ seen at radiance L gives a surface that faces it the irradiance E = π sin² δ · L. At
//! 0.5338° across that is 6.817·10⁻⁵ sr · L. Limb darkening is left out.

use core::f32::consts::TAU;
use etendue_core::warp::uniform_cone;
use etendue_core::{Basis, Spectral, Wavelengths, maths};
use etendue_spectra::Spectrum;
use glam::{DVec3, Vec2, Vec3};

use super::LightSample;

/// Mean angular diameter of the sun, degrees.
pub const SUN_ANGULAR_DIAMETER_DEG: f64 = 0.5338;

/// Why a sun is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SunError {
    /// The direction has no length.
    #[error("the direction to the sun must be a finite vector that is not zero; give it one")]
    Direction,
    /// The diameter is out of range.
    #[error("a sun of {degrees} degrees was given, but its angular diameter must be between 0.001 and 90; correct it")]
    Diameter {
        /// What was given.
        degrees: f64,
    },
    /// The radiance is negative or not finite.
    #[error("the sun's radiance or irradiance must be 0 or more and finite at every wavelength; correct it")]
    Radiance,
}

/// A disc of uniform radiance at infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct Sun {
    basis: Basis,
    radiance: Spectrum,
    /// 1 − cos δ and sin² δ of the half angle δ.
    one_minus_cos: f32,
    sin2: f64,
}

impl Sun {
    /// A sun in `direction` (world, towards it) of spectral `radiance`, W·m⁻²·sr⁻¹·nm⁻¹.
    ///
    /// # Errors
    /// Where the direction is zero, the diameter out of range, or the radiance negative.
    pub fn of_radiance(direction: DVec3, angular_diameter_deg: f64, radiance: Spectrum) -> Result<Self, SunError> {
        let z = direction.try_normalize().ok_or(SunError::Direction)?;
        if !(1e-3..=90.0).contains(&angular_diameter_deg) {
            return Err(SunError::Diameter { degrees: angular_diameter_deg });
        }
        if !(radiance.min_value() >= 0.0 && radiance.max_value().is_finite()) {
            return Err(SunError::Radiance);
        }
        let sin = maths::f64::sin(0.5 * angular_diameter_deg.to_radians());
        let one_minus_cos = sin * sin / (1.0 + (1.0 - sin * sin).sqrt());
        let basis = Basis::about(z.as_vec3().normalize());
        Ok(Self { basis, radiance, one_minus_cos: one_minus_cos as f32, sin2: sin * sin })
    }

    /// A sun that gives a surface facing it the spectral `irradiance`, W·m⁻²·nm⁻¹.
    ///
    /// # Errors
    /// As [`Sun::of_radiance`].
    pub fn of_irradiance(direction: DVec3, angular_diameter_deg: f64, irradiance: &Spectrum) -> Result<Self, SunError> {
        let sun = Self::of_radiance(direction, angular_diameter_deg, irradiance.clone())?;
        let radiance = irradiance.scaled(1.0 / (core::f64::consts::PI * sun.sin2));
        Self::of_radiance(direction, angular_diameter_deg, radiance)
    }

    /// Spectral radiance of the disc, W·m⁻²·sr⁻¹·nm⁻¹.
    #[must_use]
    pub fn radiance(&self) -> &Spectrum {
        &self.radiance
    }

    /// Unit direction towards the sun's centre, world.
    #[must_use]
    pub fn direction(&self) -> Vec3 {
        self.basis.z
    }

    pub(super) fn mean_irradiance(&self, low_nm: f64, high_nm: f64) -> f64 {
        core::f64::consts::PI * self.sin2 * self.radiance.band_mean(low_nm, high_nm)
    }

    /// Whether the unit `direction` meets the disc. By the sine, which f32 resolves where it cannot the cosine.
    pub(super) fn covers(&self, direction: Vec3) -> bool {
        let aside2 = self.basis.z.cross(direction).length_squared();
        aside2 <= self.sin2 as f32 && self.basis.z.dot(direction) > 0.0
    }

    /// Density of a draw within the disc, 1/sr.
    pub(super) fn pdf(&self) -> f32 {
        1.0 / (TAU * self.one_minus_cos)
    }

    pub(super) fn sample<const N: usize>(&self, u: Vec2, wavelengths: &Wavelengths<N>) -> LightSample<N> {
        let radiance: Spectral<N> = self.radiance.sample(wavelengths);
        let direction = self.basis.outward(uniform_cone(u, self.one_minus_cos));
        LightSample { direction, target: None, radiance, pdf: self.pdf(), delta: false, surrounds: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn irradiance_is_radiance_times_the_projected_solid_angle() {
        let irradiance = Spectrum::constant(1.5);
        let sun = Sun::of_irradiance(DVec3::new(1.0, 2.0, 3.0), SUN_ANGULAR_DIAMETER_DEG, &irradiance).expect("a sun");
        assert!((f64::from(sun.radiance().at(550.0)) * 6.8171e-5 - 1.5).abs() < 1e-4);
        assert!((sun.mean_irradiance(400.0, 700.0) - 1.5).abs() < 1e-6);
    }

    #[test]
    fn draws_lie_on_the_disc_and_its_edge_is_sharp() {
        let sun = Sun::of_radiance(DVec3::new(0.3, -0.2, 0.9), 0.5338, Spectrum::constant(1.0)).expect("a sun");
        let half = 0.2669_f32.to_radians();
        for i in 0..1000 {
            let u = Vec2::new(i as f32 / 1000.0 * 0.999, (i * 7 % 1000) as f32 / 1000.0);
            assert!(sun.covers(sun.sample(u, &etendue_core::Wavelengths::<1>::uniform(400.0, 700.0, 0.5)).direction));
        }
        for (k, inside) in [(0.999, true), (1.001, false)] {
            let (s, c) = maths::f32::sin_cos(k * half);
            assert_eq!(sun.covers(sun.basis.outward(Vec3::new(s, 0.0, c))), inside, "{k}");
        }
        assert!(!sun.covers(-sun.direction()));
    }

    #[test]
    fn suns_that_are_none_are_refused() {
        let light = Spectrum::constant(1.0);
        assert_eq!(Sun::of_radiance(DVec3::ZERO, 0.5, light.clone()), Err(SunError::Direction));
        assert_eq!(Sun::of_radiance(DVec3::Z, 0.0, light), Err(SunError::Diameter { degrees: 0.0 }));
        assert_eq!(Sun::of_radiance(DVec3::Z, 0.5, Spectrum::constant(-1.0)), Err(SunError::Radiance));
    }
}
