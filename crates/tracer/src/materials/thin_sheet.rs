//! A thin pane: window glass, a windscreen, film, as one surface without thickness of its own.
//!
//! Two smooth, parallel interfaces of index n with an absorbing sheet between. Light that enters is refracted, crosses the sheet, is reflected back
//! and forth, and leaves on either side; the contributions of all orders sum to geometric series. With ρ an interface's reflectance in one plane of
//! polarisation and a = τ^(1/cos θₜ) the transmittance of one crossing (τ: internal transmittance along the normal, θₜ the angle inside, sin θₜ = sin
//! θ/n),
//!
//! R = ρ + ρ (1 − ρ)² a² / (1 − ρ² a²),  T = (1 − ρ)² a / (1 − ρ² a²),
//!
//! each the mean of both planes, which is exact for unpolarised light (Stokes 1862; Born & Wolf, ch. 7.6, without interference). R + T = 1 if nothing
//! is absorbed. Transmitted light goes straight on ([`Event::Null`]). Left out: its lateral shift by up to the pane's thickness, interference,
//! dispersion and dirt. Both sides are equal.

use etendue_core::{Spectral, maths};
use glam::{Vec2, Vec3};

use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, Event, Passage, SurfaceModel};
use super::parameter::{Parameter, Reflectance, ShadingPoint, TextureCheck};
use super::{dielectric::DIELECTRIC_INDICES, error::MaterialError, fresnel, gloss::Gloss};

/// A thin pane.
#[derive(Clone, Debug, PartialEq)]
pub struct ThinSheet {
    n: f32,
    transmittance: Reflectance,
}

impl ThinSheet {
    /// A pane of index `n` with the internal transmittance `transmittance` (0 to 1, along the normal, without reflections) of its whole
    /// thickness.
    ///
    /// # Errors
    /// If the index is out of range.
    pub fn new(n: f64, transmittance: Reflectance) -> Result<Self, MaterialError> {
        if !DIELECTRIC_INDICES.contains(&n) {
            return Err(MaterialError::GlassIndex { n });
        }
        Ok(Self { n: n as f32, transmittance })
    }
}

impl SurfaceModel for ThinSheet {
    type Bsdf<'a, const N: usize> = ThinSheetBsdf<N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Reflectance(&self.transmittance)]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::Straight
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> ThinSheetBsdf<N> {
        ThinSheetBsdf { n: self.n, inner: point.reflectance(&self.transmittance) }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, point: &ShadingPoint<'_, N>, cos: f32) -> Spectral<N> {
        self.resolve(point).reflectance_and_transmittance(cos).1
    }
}

/// A pane at a path's wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinSheetBsdf<const N: usize> {
    n: f32,
    /// Internal transmittance along the normal.
    inner: Spectral<N>,
}

impl<const N: usize> ThinSheetBsdf<N> {
    /// Reflectance and transmittance of the pane at a cosine of incidence.
    fn reflectance_and_transmittance(&self, cos: f32) -> (Spectral<N>, Spectral<N>) {
        let cos = cos.clamp(0.0, 1.0);
        let planes = fresnel::planes(cos, self.n);
        let cos_inside = (fresnel::cos_square(cos, self.n) / (self.n * self.n)).sqrt();
        let (mut reflected, mut passed) = (Spectral::ZERO, Spectral::ZERO);
        for i in 0..N {
            let a = crossing(self.inner[i], cos_inside);
            for rho in planes {
                let orders = (1.0 - rho) * (1.0 - rho) / (1.0 - rho * rho * a * a).max(f32::MIN_POSITIVE);
                reflected[i] += 0.5 * (rho + rho * orders * a * a).min(1.0);
                passed[i] += 0.5 * orders * a;
            }
        }
        (reflected, passed)
    }
}

impl<const N: usize> BsdfModel<N> for ThinSheetBsdf<N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags { delta: true, transmits: false, has_parts: true }
    }

    fn evaluate(&self, _wo: Vec3, _wi: Vec3) -> BsdfValue<N> {
        BsdfValue::ZERO
    }

    fn gloss(&self, _: Vec3) -> Gloss {
        Gloss::MATT
    }

    fn sample(&self, wo: Vec3, choice: f32, _u: Vec2) -> Option<BsdfSample<N>> {
        let (reflected, passed) = self.reflectance_and_transmittance(wo.z);
        let (r, t) = (reflected.mean(), passed.mean());
        let fraction = r / (r + t);
        if choice < fraction {
            return Some(BsdfSample::mirror(wo, reflected / fraction));
        }
        // If nothing passes, the fraction is 1; NaN if the pane neither reflects nor transmits.
        (fraction < 1.0).then(|| BsdfSample {
            wi: -wo,
            weight: passed / (1.0 - fraction),
            pdf: 0.0,
            event: Event::Null,
        })
    }
}

/// Transmittance of one crossing at the cosine inside.
fn crossing(inner: f32, cos_inside: f32) -> f32 {
    if inner >= 1.0 {
        return 1.0;
    }
    if inner > 0.0 { maths::f32::exp(maths::f32::ln(inner) / cos_inside) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pane(n: f32, inner: f32) -> ThinSheetBsdf<1> {
        ThinSheetBsdf { n, inner: Spectral::splat(inner) }
    }

    #[test]
    fn a_pane_of_index_1_is_its_sheet_alone() {
        for cos in [1.0_f32, 0.5, 1e-4] {
            assert_eq!(pane(1.0, 1.0).reflectance_and_transmittance(cos), (Spectral::ZERO, Spectral::ONE), "{cos}");
            let (reflected, passed) = pane(1.0, 0.5).reflectance_and_transmittance(cos);
            let expected = maths::f64::exp(maths::f64::ln(0.5) / f64::from(cos)) as f32;
            assert!(
                reflected.is_zero() && (passed[0] - expected).abs() <= 1e-6 * expected.max(1e-30),
                "{cos}: {passed:?}"
            );
        }
    }

    /// Rays traced order by order in f64, for one plane of polarisation.
    fn followed(rho: f64, a: f64) -> (f64, f64) {
        let (mut reflected, mut passed, mut inside) = (rho, 0.0, 1.0 - rho);
        for order in 0..200 {
            inside *= a;
            *(if order % 2 == 0 { &mut passed } else { &mut reflected }) += inside * (1.0 - rho);
            inside *= rho;
        }
        (reflected, passed)
    }

    #[test]
    fn the_series_is_that_of_rays_followed_one_by_one() {
        for cos in [1.0, 0.7, 0.3, 0.05] {
            for inner in [1.0_f32, 0.6, 0.01] {
                let inside = (1.0 - (1.0 - cos * cos) / (1.52_f32 * 1.52)).sqrt();
                let a = maths::f64::exp(maths::f64::ln(f64::from(inner)) / f64::from(inside));
                let by_plane = fresnel::planes(cos, 1.52).map(|rho| followed(f64::from(rho), a));
                let (r, t) = (by_plane[0].0 + by_plane[1].0, by_plane[0].1 + by_plane[1].1);
                let (reflected, passed) = pane(1.52, inner).reflectance_and_transmittance(cos);
                // Roundings of f32; at grazing incidence 1 − ρ² keeps fewer digits.
                assert!((f64::from(reflected[0]) - r / 2.0).abs() < 2e-6, "{cos} {inner}");
                assert!((f64::from(passed[0]) - t / 2.0).abs() < 2e-6, "{cos} {inner}");
            }
        }
    }

    #[test]
    fn clear_glass_has_the_textbook_shares() {
        // ρ = ((n − 1)/(n + 1))² = 0.04: R = 2ρ/(1 + ρ) = 0.0769, T = (1 − ρ)/(1 + ρ) = 0.9231 along the normal.
        let (reflected, passed) = pane(1.5, 1.0).reflectance_and_transmittance(1.0);
        assert!((reflected[0] - 0.08 / 1.04).abs() < 1e-6 && (passed[0] - 0.96 / 1.04).abs() < 1e-6);
        for i in 0..=1000 {
            let (reflected, passed) = pane(1.5, 1.0).reflectance_and_transmittance(i as f32 / 1000.0);
            assert!((reflected[0] + passed[0] - 1.0).abs() < 1e-6, "{i}");
        }
    }

    #[test]
    fn no_input_is_no_number() {
        for cos in [0.0, 1e-20, 1e-4, 1.0] {
            for inner in [0.0, 1e-38, 1.0, 1.000_1] {
                let (reflected, passed) = pane(1.1, inner).reflectance_and_transmittance(cos);
                assert!((0.0..=1.0).contains(&reflected[0]) && (0.0..=1.0).contains(&passed[0]), "{cos} {inner}");
                for choice in [0.0, 0.5, 0.999_999_94] {
                    let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                    let sample = pane(1.1, inner).sample(wo, choice, Vec2::ZERO);
                    assert!(sample.is_none_or(|s| s.weight.is_finite()), "{cos} {inner} {sample:?}");
                }
            }
        }
    }
}
