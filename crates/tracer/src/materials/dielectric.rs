//! Glass, water, ice: a solid of one refractive index, smooth or rough, seen from outside and inside.
//!
//! A surface is one interface. Its geometric normal points out of the solid; η is the index of the far side over that of the viewer's: n from
//! outside, 1/n from inside. A fraction F (exact Fresnel, total reflection included) is reflected at the facet m, the rest refracted at it:
//!
//! reflection    f = F · D(m) · G₂(wo, wi) / (4 cos θₒ cos θᵢ), m = (wo + wi) normalised
//! transmission  f = (1 − F) · D(m) · G₁(wo) G₁(wi) · |wo·m| |wi·m| / (cos θₒ |cos θᵢ| (η wi·m + wo·m)²), m = ±(wo + η wi)
//!               normalised, in terms of radiance: with the factor 1/η² of radiance from a denser medium
//!
//! (Walter, Marschner, Li & Torrance 2007, equations 16, 20, 21; there the second has η_o², here divided through. Factor 1/η²: Veach 1997, section
//! 5.2.) D is GGX with roughness α, G₁ Smith's; reflection has the height-correlated G₂, as for metals. A roughness below [`super::MIRROR_ALPHA`] is
//! smooth: both directions are exact.
//!
//! Inside, light is absorbed by Beer and Lambert's law: exp(−a·s) over s metres, a(λ) in 1/m ([`super::MaterialTable::absorption`]; the path tracer
//! applies it).
//!
//! Left out: dispersion (n is one number at all wavelengths, so that a path keeps all its wavelengths), polarisation, multiple scattering among
//! facets (lost: up to some tenths at α near 1), scattering inside.

use etendue_core::{Spectral, maths};
use etendue_spectra::Spectrum;
use glam::{Vec2, Vec3};

use super::microfacet::{Ggx, half_vector, mirrored};
use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, Event, Passage, SurfaceModel};
use super::parameter::{Factor, Parameter, ShadingPoint, TextureCheck};
use super::{error::MaterialError, fresnel, gloss::Gloss};

/// Range of the refractive index against air of a solid or a pane: from that of an invisible substance.
pub const DIELECTRIC_INDICES: core::ops::RangeInclusive<f64> = 1.0..=4.0;

/// Minimum difference of the index from 1 of a rough solid. Below, it is smooth: its facets deflect light by less than a thousandth of
/// their slope, into lobes narrower than single precision resolves.
const MIN_ROUGH_INDEX_STEP: f32 = 1e-3;

/// A transparent solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Dielectric {
    n: f32,
    alpha: Factor,
    absorption: Option<Spectrum>,
}

impl Dielectric {
    /// A solid of index `n`, surface roughness `alpha` (GGX α, 0 to 1) and absorption coefficient `absorption` (1/m, 0 or more; `None` if
    /// it absorbs nothing).
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn new(n: f64, alpha: impl Into<Factor>, absorption: Option<Spectrum>) -> Result<Self, MaterialError> {
        if !DIELECTRIC_INDICES.contains(&n) {
            return Err(MaterialError::GlassIndex { n });
        }
        let alpha = alpha.into().checked_alpha()?;
        let range = absorption.iter().flat_map(|a| [a.min_value(), a.max_value()]);
        if let Some(value) = range.into_iter().find(|a| !(0.0..=f32::MAX).contains(a)) {
            return Err(MaterialError::Absorption { value });
        }
        Ok(Self { n: n as f32, alpha, absorption })
    }
}

impl SurfaceModel for Dielectric {
    type Bsdf<'a, const N: usize> = DielectricBsdf;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::alpha(self.alpha)]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::Solid(self.absorption.as_ref())
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> DielectricBsdf {
        let eta = if point.front { self.n } else { 1.0 / self.n };
        let facets =
            Ggx::from_alpha(point.widened(point.factor(self.alpha))).filter(|_| self.n - 1.0 >= MIN_ROUGH_INDEX_STEP);
        DielectricBsdf { eta, facets }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// Absorption coefficient that represents a transmittance of 0, 1/m: a micrometre passes nothing.
const OPAQUE_PER_M: f64 = 1e9;

/// The absorption coefficient (1/m) of a substance of this internal transmittance (0 to 1, without reflections) over `thickness_m`: −ln τ /
/// d. If τ is 0 it is 1e9 1/m.
///
/// # Errors
/// If the transmittance is outside 0–1 or the thickness is not above 0.
pub fn absorption_of(transmittance: &Spectrum, thickness_m: f64) -> Result<Spectrum, MaterialError> {
    let range = [transmittance.min_value(), transmittance.max_value()];
    if let Some(value) = range.into_iter().find(|v| !(0.0..=1.0).contains(v)) {
        return Err(MaterialError::Transmittance { value });
    }
    if !(thickness_m > 0.0 && thickness_m.is_finite()) {
        return Err(MaterialError::Thickness { thickness_m });
    }
    let of = |tau: f64| if tau > 0.0 { -maths::f64::ln(tau) / thickness_m } else { OPAQUE_PER_M };
    let mut nodes = transmittance.nodes().iter();
    Ok(Spectrum::from_fn(|_| nodes.next().map_or(0.0, |tau| of(f64::from(*tau)).clamp(0.0, OPAQUE_PER_M))))
}

/// One interface, from one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DielectricBsdf {
    /// Index of the far side over that of the viewer's.
    eta: f32,
    /// `None` for a smooth surface.
    facets: Option<Ggx>,
}

impl DielectricBsdf {
    /// Index of the far side over that of the viewer's.
    #[must_use]
    pub fn eta(&self) -> f32 {
        self.eta
    }

    fn reflect(&self, facets: Ggx, wo: Vec3, wi: Vec3) -> (f32, f32) {
        let m = half_vector(wo, wi);
        let fraction = fresnel::interface(wo.dot(m), self.eta);
        (fraction * facets.reflect(wo, wi, m), fraction * facets.reflect_pdf(wo, m))
    }

    fn transmit(&self, facets: Ggx, wo: Vec3, wi: Vec3) -> (f32, f32) {
        let h = wo + wi * self.eta;
        let m = (h * 1.0_f32.copysign(h.z)).normalize_or(Vec3::Z);
        let (o, i) = (wo.dot(m), wi.dot(m));
        // Both viewer and light must be on the front of the facets.
        if o <= 0.0 || i >= 0.0 {
            return (0.0, 0.0);
        }
        // dω(m)/dω(wi) is this times η²; the factor of radiance cancels it.
        let jacobian = -i / ((self.eta * i + o) * (self.eta * i + o));
        let visible = facets.visible_pdf(wo, m) * (1.0 - fresnel::interface(o, self.eta)) * jacobian;
        let value = visible * facets.shadowing(wi);
        let pdf = visible * self.eta * self.eta;
        // The surface seen through itself edge-on: a density beyond f32 counts as none.
        if pdf.is_finite() { (value, pdf) } else { (0.0, 0.0) }
    }
}

impl<const N: usize> BsdfModel<N> for DielectricBsdf {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags { delta: self.facets.is_none(), transmits: self.facets.is_some(), has_parts: true }
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let Some(facets) = self.facets else { return BsdfValue::ZERO };
        let (value, pdf) = if wi.z > 0.0 { self.reflect(facets, wo, wi) } else { self.transmit(facets, wo, wi) };
        BsdfValue { value_cos: Spectral::splat(value), pdf }
    }

    fn gloss(&self, _: Vec3) -> Gloss {
        Gloss::MATT
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let m = self.facets.map_or(Vec3::Z, |facets| facets.sample(wo, u));
        let fraction = fresnel::interface(wo.dot(m), self.eta);
        let reflected = choice < fraction;
        let wi = if reflected { mirrored(wo, m) } else { refracted(wo, m, self.eta)? };
        if wi.z == 0.0 || (wi.z > 0.0) != reflected {
            return None;
        }
        let thinned = if reflected { 1.0 } else { 1.0 / (self.eta * self.eta) };
        let Some(facets) = self.facets else {
            return Some(BsdfSample { wi, weight: Spectral::splat(thinned), pdf: 0.0, event: Event::Specular });
        };
        let (weight, (_, pdf)) = match reflected {
            true => (facets.weight(wo, wi), self.reflect(facets, wo, wi)),
            false => (facets.shadowing(wi) * thinned, self.transmit(facets, wo, wi)),
        };
        (pdf > 0.0).then(|| BsdfSample { wi, weight: Spectral::splat(weight), pdf, event: Event::Scatter })
    }
}

/// `wo` refracted at the facet `m` (wo·m > 0) into a medium of relative index `eta`: the direction that points away from the surface on the
/// far side. `None` at total reflection.
pub(super) fn refracted(wo: Vec3, m: Vec3, eta: f32) -> Option<Vec3> {
    if eta == 1.0 {
        return Some(-wo);
    }
    let cos = wo.dot(m);
    let square = fresnel::cos_square(cos, eta) / (eta * eta);
    (square > 0.0).then(|| m * (cos / eta - square.sqrt()) - wo / eta)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::textures::Lookup;
    use etendue_core::Wavelengths;

    #[test]
    fn light_bends_by_snell() {
        for (sine, eta) in [(0.0_f32, 1.5_f32), (0.6, 1.5), (0.999, 1.333), (0.3, 1.0 / 1.5), (0.66, 1.0 / 1.5)] {
            let wo = Vec3::new(sine, 0.0, (1.0 - sine * sine).sqrt());
            let wi = refracted(wo, Vec3::Z, eta).expect("below the critical angle");
            assert!((wi.x + sine / eta).abs() < 1e-6 && wi.z < 0.0 && (wi.length() - 1.0).abs() < 1e-6);
        }
        let steep = Vec3::new(0.67, 0.0, (1.0 - 0.67_f32 * 0.67).sqrt());
        assert_eq!(refracted(steep, Vec3::Z, 1.0 / 1.5), None);
    }

    #[test]
    fn an_index_of_1_is_not_seen_and_one_close_to_it_loses_nothing() {
        for (n, alpha) in [(1.0, 0.0), (1.0, 0.4), (1.0001, 0.0), (1.0001, 0.4), (1.001, 0.4), (1.05, 0.1)] {
            let glass = Dielectric::new(n, alpha, None).expect("legal");
            for (cos, front) in [(1.0_f32, true), (0.3, true), (1e-4, true), (0.5, false), (1e-4, false)] {
                let (lookup, wavelengths) = (Lookup::point(Vec2::ZERO), Wavelengths::<1>::uniform(400.0, 700.0, 0.5));
                let point =
                    ShadingPoint { textures: &[], lookup: &lookup, front, wavelengths: &wavelengths, min_alpha: 0.0 };
                let bsdf = glass.resolve(&point);
                let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let cell = |i: u32| {
                    let u = Vec2::new((i % 32) as f32 + 0.5, (i / 32) as f32 + 0.5) / 32.0;
                    let choice = ((i * 37) % 1024) as f32 / 1024.0;
                    BsdfModel::<1>::sample(&bsdf, wo, choice, u)
                };
                let samples: Vec<_> = (0..1024).filter_map(cell).collect();
                if n == 1.0 {
                    assert!(
                        samples.iter().all(|s| s.wi == -wo && s.weight[0] == 1.0) && samples.len() == 1024,
                        "{cos}"
                    );
                }
                // Transmitted radiance has a factor 1/η², which is undone here.
                let power =
                    |s: &BsdfSample<1>| if s.wi.z > 0.0 { s.weight[0] } else { s.weight[0] * bsdf.eta * bsdf.eta };
                let sum = samples.iter().map(power).sum::<f32>() / 1024.0;
                // A smooth surface loses nothing; facets lose by multiple scattering as much as at any index.
                let minimum = match (bsdf.facets.is_none(), cos > 0.99) {
                    (true, _) => 1.0 - 2e-3,
                    (false, true) => 0.94,
                    (false, false) => 0.0,
                };
                assert!((minimum..=1.0 + 2e-3).contains(&sum), "n {n}, alpha {alpha}, cos {cos}, {front}: {sum}");
            }
        }
    }

    #[test]
    fn absorption_gives_the_transmittance_back() {
        let tau = Spectrum::from_fn(|nm| (nm - 300.0) / 800.0);
        let a = absorption_of(&tau, 0.004).expect("legal");
        for nm in [301.0, 500.0, 1099.0] {
            let back = maths::f64::exp(-0.004 * f64::from(a.at(nm)));
            // The coefficient is stored in f32: 6e-8 of up to 7.
            assert!((back - f64::from(tau.at(nm))).abs() < 1e-6, "{nm}: {back}");
        }
        assert_eq!((a.at(300.0), a.at(1100.0)), (1e9, 0.0));
        assert!(absorption_of(&Spectrum::constant(1.1), 0.004).is_err() && absorption_of(&tau, 0.0).is_err());
    }
}
