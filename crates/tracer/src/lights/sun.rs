//! The sun: a disc at infinity.
//!
//! A surface that faces a disc of half angle δ and mean radiance L receives the irradiance E = π sin² δ · L. At 0.5338° across that is 6.817·10⁻⁵ sr
//! · L. The disc is of one radiance, or darkens towards its limb. With µ = √(1 − sin² γ/sin² δ) at the angle γ from its centre, the radiance is that
//! of the centre times Σ aₖ(λ) µᵏ, k = 0…5 (`etendue_spectra::sky::sun`). Its mean is 2 Σ aₖ/(k + 2), so that the irradiance is as stated, exactly.
//! Directions are sampled uniformly over the disc in both cases. Left out: refraction, which flattens a low sun; sunspots.

use core::f32::consts::TAU;

use etendue_core::{Basis, Spectral, Wavelengths, maths, warp::uniform_cone};
use etendue_spectra::Spectrum;
use etendue_spectra::sky::{BANDS, FIRST_NM, STEP_NM, sun as model};
use glam::{DVec3, Vec2, Vec3};

use super::{LightSample, MAX_LIGHT_VALUE};

/// Mean angular diameter of the sun, degrees.
pub const SUN_ANGULAR_DIAMETER_DEG: f64 = 0.5338;

/// Coefficients aₖ in each band.
type Limb = [[f32; 6]; BANDS];

/// Error of a sun.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SunError {
    /// The direction has no length.
    #[error("the direction to the sun must be a finite vector other than zero")]
    Direction,
    /// The diameter is out of range.
    #[error("the sun's angular diameter is {degrees}°; it must be between 0.001° and 90°")]
    Diameter {
        /// Value given.
        degrees: f64,
    },
    /// The radiance is negative or not finite.
    #[error("the sun's radiance or irradiance must be 0 to 1e30 at every wavelength")]
    Radiance,
}

/// A disc at infinity.
#[derive(Clone, Debug, PartialEq)]
pub struct Sun {
    basis: Basis,
    /// Radiance at the centre.
    radiance: Spectrum,
    /// Coefficients aₖ in each band, if there is limb darkening.
    limb: Option<Box<Limb>>,
    /// 1 − cos δ and sin² δ of the half angle δ.
    one_minus_cos: f32,
    sin2: f64,
}

impl Sun {
    /// A sun in `direction` (world, towards it) of spectral `radiance`, W·m⁻²·sr⁻¹·nm⁻¹.
    ///
    /// # Errors
    /// If the direction is zero, the diameter out of range, or the radiance negative.
    pub fn from_radiance(direction: DVec3, angular_diameter_deg: f64, radiance: Spectrum) -> Result<Self, SunError> {
        let z = direction.try_normalize().ok_or(SunError::Direction)?;
        if !(1e-3..=90.0).contains(&angular_diameter_deg) {
            return Err(SunError::Diameter { degrees: angular_diameter_deg });
        }
        if !(radiance.min_value() >= 0.0 && radiance.max_value() <= MAX_LIGHT_VALUE) {
            return Err(SunError::Radiance);
        }
        let sin = maths::f64::sin(0.5 * angular_diameter_deg.to_radians());
        let one_minus_cos = sin * sin / (1.0 + (1.0 - sin * sin).sqrt());
        let basis = Basis::about(z.as_vec3().normalize());
        Ok(Self { basis, radiance, limb: None, one_minus_cos: one_minus_cos as f32, sin2: sin * sin })
    }

    /// A sun of spectral `irradiance` on a surface that faces it, W·m⁻²·nm⁻¹.
    ///
    /// # Errors
    /// As [`Sun::from_radiance`].
    pub fn from_irradiance(
        direction: DVec3,
        angular_diameter_deg: f64,
        irradiance: &Spectrum,
    ) -> Result<Self, SunError> {
        let sun = Self::from_radiance(direction, angular_diameter_deg, irradiance.clone())?;
        let radiance = irradiance.scaled(1.0 / (core::f64::consts::PI * sun.sin2));
        Self::from_radiance(direction, angular_diameter_deg, radiance)
    }

    /// Adds the limb darkening of the real sun at the same irradiance: the centre becomes brighter.
    #[must_use]
    pub fn with_limb(self) -> Self {
        if self.limb.is_some() {
            return self;
        }
        let per_mean = Spectrum::from_fn(|nm| 1.0 / model::limb_mean(nm));
        let band = |b: usize| model::limb(FIRST_NM + STEP_NM * b as f64).map(|a| a as f32);
        let limb = Some(Box::new(core::array::from_fn(band)));
        Self { radiance: self.radiance.product(&per_mean), limb, ..self }
    }

    /// Spectral radiance of the disc's centre, W·m⁻²·sr⁻¹·nm⁻¹.
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
        let mean = match self.limb {
            Some(_) => self.radiance.product(&Spectrum::from_fn(model::limb_mean)).band_mean(low_nm, high_nm),
            None => self.radiance.band_mean(low_nm, high_nm),
        };
        core::f64::consts::PI * self.sin2 * mean
    }

    /// Spectral irradiance of a surface that faces it, W·m⁻²·nm⁻¹.
    #[must_use]
    pub fn irradiance(&self) -> Spectrum {
        let mean = match self.limb {
            Some(_) => self.radiance.product(&Spectrum::from_fn(model::limb_mean)),
            None => self.radiance.clone(),
        };
        mean.scaled(core::f64::consts::PI * self.sin2)
    }

    /// True if any part of the disc is above the horizon of a surface of this unit normal.
    pub(super) fn rises_over(&self, normal: Vec3) -> bool {
        // Margin for the rounding of both vectors.
        self.basis.z.dot(normal) > -(self.sin2 as f32).sqrt() - 1e-5
    }

    /// Spectral radiance from a unit direction within the disc.
    pub(super) fn radiance_from<const N: usize>(&self, direction: Vec3, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        let centre = self.radiance.sample(wavelengths);
        let Some(limb) = &self.limb else { return centre };
        let aside2 = self.basis.z.cross(direction).length_squared();
        let mu = (1.0 - aside2 / self.sin2 as f32).max(0.0).sqrt();
        let band = |b: usize| limb[b].iter().rev().fold(0.0, |sum, a| sum * mu + a);
        let darkening = Spectral(wavelengths.nm.map(|nm| {
            let x = ((nm - FIRST_NM as f32) * (1.0 / STEP_NM as f32)).clamp(0.0, (BANDS - 1) as f32);
            let low = (x as i32 as usize).min(BANDS - 2);
            let (below, above) = (band(low), band(low + 1));
            (below + (x - low as f32) * (above - below)).max(0.0)
        }));
        centre * darkening
    }

    /// Sine of half its diameter.
    pub(super) fn sin(&self) -> f32 {
        (self.sin2 as f32).sqrt()
    }

    /// True if the unit `direction` is within the disc. By the sine, which f32 resolves where it cannot resolve the cosine.
    pub(super) fn covers(&self, direction: Vec3) -> bool {
        let aside2 = self.basis.z.cross(direction).length_squared();
        aside2 <= self.sin2 as f32 && self.basis.z.dot(direction) > 0.0
    }

    /// Density of samples within the disc, 1/sr.
    pub(super) fn pdf(&self) -> f32 {
        1.0 / (TAU * self.one_minus_cos)
    }

    pub(super) fn sample<const N: usize>(&self, u: Vec2, wavelengths: &Wavelengths<N>) -> LightSample<N> {
        let direction = self.basis.outward(uniform_cone(u, self.one_minus_cos));
        let radiance = self.radiance_from(direction, wavelengths);
        LightSample { direction, target: None, radiance, pdf: self.pdf(), delta: false, is_environment: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn irradiance_is_radiance_times_the_projected_solid_angle() {
        let irradiance = Spectrum::constant(1.5);
        let sun =
            Sun::from_irradiance(DVec3::new(1.0, 2.0, 3.0), SUN_ANGULAR_DIAMETER_DEG, &irradiance).expect("a sun");
        assert!((f64::from(sun.radiance().at(550.0)) * 6.8171e-5 - 1.5).abs() < 1e-4);
        assert!((sun.mean_irradiance(400.0, 700.0) - 1.5).abs() < 1e-6);
    }

    #[test]
    fn samples_lie_on_the_disc_and_its_edge_is_sharp() {
        let sun = Sun::from_radiance(DVec3::new(0.3, -0.2, 0.9), 0.5338, Spectrum::constant(1.0)).expect("a sun");
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
    fn a_dark_limb_keeps_the_irradiance_and_has_the_centre_of_the_table() {
        let irradiance = model::normal_irradiance(3.0, 1.0).expect("a sun");
        let sun =
            Sun::from_irradiance(DVec3::new(0.2, 0.5, 0.7), SUN_ANGULAR_DIAMETER_DEG, &irradiance).expect("a sun");
        let sun = sun.with_limb();
        let table = model::radiance(3.0, 1.0).expect("a radiance");
        for nm in [330.0, 450.0, 555.0, 700.0, 1000.0] {
            // Values are rounded to f32 three times; the mean of the limb is exact at whole nanometres.
            assert!((sun.radiance().at(nm) / table.at(nm) - 1.0).abs() < 1e-6, "{nm}");
        }
        let wavelengths = etendue_core::Wavelengths::<4> { nm: [330.0, 450.0, 555.0, 700.0], pdf: [1.0; 4] };
        let n = 4096;
        let mut sums = [0.0; 4];
        for i in 0..n {
            let u = Vec2::new((i as f32 + 0.5) / n as f32, (0.618_034 * f64::from(i)).fract() as f32);
            let sample = sun.sample(u, &wavelengths);
            let cos = f64::from(sample.direction.dot(sun.direction()));
            (0..4).for_each(|k| sums[k] += f64::from(sample.radiance[k]) * cos / f64::from(sample.pdf));
        }
        for (k, sum) in sums.iter().enumerate() {
            let expected = f64::from(irradiance.at(wavelengths.nm[k]));
            // The midpoint rule of 4096 rings; µ has a vertical tangent at the limb.
            assert!((sum / f64::from(n) / expected - 1.0).abs() < 1e-4, "{k}: {} {expected}", sum / f64::from(n));
        }
        assert!((sun.mean_irradiance(400.0, 700.0) / irradiance.band_mean(400.0, 700.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_sun_rises_with_its_upper_edge() {
        let sun = Sun::from_radiance(DVec3::Z, 0.5338, Spectrum::constant(1.0)).expect("a sun");
        for (below_deg, rises) in [(-1.0_f32, true), (0.266, true), (0.27, false), (30.0, false)] {
            let (sin, cos) = maths::f32::sin_cos(below_deg.to_radians());
            assert_eq!(sun.rises_over(Vec3::new(cos, 0.0, -sin)), rises, "{below_deg}");
        }
    }

    #[test]
    fn suns_that_are_none_are_refused() {
        let light = Spectrum::constant(1.0);
        assert_eq!(Sun::from_radiance(DVec3::ZERO, 0.5, light.clone()), Err(SunError::Direction));
        assert_eq!(Sun::from_radiance(DVec3::Z, 0.0, light), Err(SunError::Diameter { degrees: 0.0 }));
        assert_eq!(Sun::from_radiance(DVec3::Z, 0.5, Spectrum::constant(-1.0)), Err(SunError::Radiance));
    }
}
