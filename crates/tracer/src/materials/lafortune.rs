//! Lafortune's model: a diffuse base and a few generalised cosine lobes.
//!
//! f = k_d/π + Σ w [ C_t (wᵢₓ wₒₓ + wᵢ_y wₒ_y) + C_n wᵢ_z wₒ_z ]₊ⁿ (Lafortune, Foo, Torrance and Greenberg 1997, eq. 5, isotropic), 1/sr. C_t = −C,
//! C_n = C: a mirror lobe; C_t = C_n = C: a retro lobe; C_t < 0, C_n < |C_t|: off-specular, its peak nearer to the horizon than the mirror direction.
//! w is a spectrum, 1/sr; with C = 1 a lobe's albedo at normal incidence is 2π w/(n + 2).
//!
//! A lobe is a power of the cosine about the axis C·wₒ, n of 0 to 10 000, and is sampled as such; lobes are chosen by their albedo at the incidence.
//! The albedo over all incidences is tabulated when the model is built: for a lobe of axis d (not of unit length) it is |d|ⁿ ∫ cosⁿγ [cos γ d̂_z +
//! sin γ d̂ₛ cos φ]₊ dω, whose integral over φ is closed. Models that reflect more than arrives, at any incidence and wavelength, are refused.
//!
//! Left out: anisotropic lobes (Cₓ ≠ C_y), which would need a direction along the surface; shadowing, beyond that included in the fitted lobes.

use core::f32::consts::{FRAC_1_PI, TAU};

use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use etendue_core::{Basis, Spectral, maths};
use etendue_spectra::Spectrum;
use glam::{Vec2, Vec3};

use super::energy::{self, AlbedoTable, WeightedLobe};
use super::error::{EnergyGain, MaterialError};
use super::gloss::{Gloss, GlossLobe, LobeCentre};
use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, DiscreteSampler, Event, Passage, SurfaceModel};
use super::parameter::{Parameter, Reflectance, ShadingPoint, TextureCheck};

/// Maximum number of lobes of a model.
pub const MAX_LOBES: usize = 4;

/// The sharpest lobe: about 0.7° wide, well resolved in f32.
const MAX_EXPONENT: f64 = 1e4;

/// One generalised cosine lobe.
#[derive(Clone, Debug, PartialEq)]
pub struct Lobe {
    /// C_t: factor along the surface; negative for lobes on the mirror's side, positive for retro lobes.
    pub tangential: f64,
    /// C_n: factor along the normal, 0 or more.
    pub normal: f64,
    /// n.
    pub exponent: f64,
    /// w, 1/sr.
    pub weight: Spectrum,
}

impl Lobe {
    /// A lobe about the mirror direction with `albedo` at normal incidence.
    #[must_use]
    pub fn mirror(exponent: f64, albedo: &Spectrum) -> Self {
        Self::from_albedo(-1.0, 1.0, exponent, albedo)
    }

    /// A lobe back towards the incoming light, with `albedo` at normal incidence.
    #[must_use]
    pub fn retro(exponent: f64, albedo: &Spectrum) -> Self {
        Self::from_albedo(1.0, 1.0, exponent, albedo)
    }

    /// A lobe of factors C_t and C_n > 0 with `albedo` at normal incidence: w = albedo (n + 2)/(2π C_nⁿ).
    #[must_use]
    pub fn from_albedo(tangential: f64, normal: f64, exponent: f64, albedo: &Spectrum) -> Self {
        let scale = (exponent + 2.0) / (core::f64::consts::TAU * maths::f64::pow(normal, exponent));
        Self { tangential, normal, exponent, weight: albedo.scaled(scale) }
    }

    /// The lobe's axis for a viewer: C·wₒ, not of unit length.
    fn axis(&self, wo: Vec3) -> Vec3 {
        Vec3::new(self.tangential as f32 * wo.x, self.tangential as f32 * wo.y, self.normal as f32 * wo.z)
    }

    /// The lobe for a viewer at a mean weight, 1/sr: cosⁿγ falls at the axis as the kernel of width 2/√n.
    fn gloss(&self, wo: Vec3, weight: f32) -> GlossLobe {
        let (axis, n) = (self.axis(wo), self.exponent as f32);
        let length = axis.length().max(f32::MIN_POSITIVE);
        let peak = weight * maths::f32::pow(length, n) * (axis.z / length);
        GlossLobe { about: LobeCentre::Direction(axis / length), width: 2.0 / n.max(1.0).sqrt(), peak, f0: 1.0 }
    }

    fn check(&self, lobe: usize) -> Result<(), LafortuneError> {
        let (t, n) = (self.tangential, self.normal);
        if !(t.is_finite() && n.is_finite() && n >= 0.0 && (t != 0.0 || n != 0.0)) {
            return Err(LafortuneError::Factors { lobe, tangential: t, normal: n });
        }
        if !(0.0..=MAX_EXPONENT).contains(&self.exponent) {
            return Err(LafortuneError::Exponent { lobe, exponent: self.exponent });
        }
        if energy::is_weight(&self.weight) { Ok(()) } else { Err(LafortuneError::Weight { lobe }) }
    }

    fn albedo(&self, cos: f32) -> f64 {
        let sin = f64::from((1.0 - cos * cos).max(0.0).sqrt());
        let (s, z) = (self.tangential.abs() * sin, self.normal * f64::from(cos));
        let length = (s * s + z * z).sqrt();
        if length == 0.0 {
            return if self.exponent == 0.0 { core::f64::consts::PI } else { 0.0 };
        }
        maths::f64::pow(length, self.exponent) * cosine_power_flux(s / length, z / length, self.exponent)
    }
}

/// ∫ cosⁿγ max(wᵢ_z, 0) dω over the half-space about an axis with components `s` along the surface and `z` ≥ 0 along the
/// normal: ∫ dt/(n + 1) over t = cosⁿ⁺¹γ by the midpoint rule.
fn cosine_power_flux(s: f64, z: f64, n: f64) -> f64 {
    const STEPS: usize = 512;
    let ring = |i: usize| {
        let cos = maths::f64::pow((i as f64 + 0.5) / STEPS as f64, 1.0 / (n + 1.0));
        positive_part(cos * z, (1.0 - cos * cos).max(0.0).sqrt() * s)
    };
    (0..STEPS).map(ring).sum::<f64>() / (STEPS as f64 * (n + 1.0))
}

/// ∫ max(a + b cos φ, 0) dφ over a turn, for a, b ≥ 0.
fn positive_part(a: f64, b: f64) -> f64 {
    if a >= b {
        return core::f64::consts::TAU * a;
    }
    let end = maths::f64::acos(-a / b);
    2.0 * (a * end + b * maths::f64::sin(end))
}

/// A model: a diffuse base and lobes.
#[derive(Clone, Debug, PartialEq)]
pub struct Lafortune {
    base: Reflectance,
    lobes: Vec<Lobe>,
    /// Albedo of each lobe at weight 1.
    albedos: Vec<AlbedoTable>,
}

impl Lafortune {
    /// A base of reflectance k_d under up to [`MAX_LOBES`] lobes.
    ///
    /// # Errors
    /// If there are too many lobes, one has no direction, an exponent or weight is out of range, or the model reflects more than arrives.
    pub fn new(base: Reflectance, mut lobes: Vec<Lobe>) -> Result<Self, LafortuneError> {
        if lobes.len() > MAX_LOBES {
            return Err(LafortuneError::TooMany { lobes: lobes.len() });
        }
        lobes.iter().enumerate().try_for_each(|(i, lobe)| lobe.check(i))?;
        // Zero times an infinite power would be NaN.
        lobes.retain(|lobe| lobe.weight.max_value() > 0.0);
        let albedos = lobes.iter().map(|lobe| AlbedoTable::new(|cos| lobe.albedo(cos))).collect();
        let model = Self { base, lobes, albedos };
        model.refuse_gain(&energy::known(&model.base))?;
        Ok(model)
    }

    /// Refuses a base under which more is reflected than arrives.
    fn refuse_gain(&self, base: &Spectrum) -> Result<(), EnergyGain> {
        let lobes = self.lobes.iter().zip(&self.albedos);
        let lobes: Vec<_> = lobes.map(|(lobe, albedo)| WeightedLobe { weight: &lobe.weight, albedo }).collect();
        energy::check(base, &lobes)
    }
}

impl SurfaceModel for Lafortune {
    type Bsdf<'a, const N: usize> = LafortuneBsdf<'a, N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Reflectance(&self.base)]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> LafortuneBsdf<'_, N> {
        let weight = |i: usize| self.lobes.get(i).map_or(Spectral::ZERO, |lobe| lobe.weight.sample(point.wavelengths));
        LafortuneBsdf { model: self, base: point.reflectance(&self.base), weights: core::array::from_fn(weight) }
    }

    fn check_energy(&self, check: &TextureCheck<'_>) -> Result<(), MaterialError> {
        let gained = |gain| MaterialError::Gain { material: check.material, gain };
        self.refuse_gain(&check.brightest(&self.base)).map_err(gained)
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// Error of a Lafortune model. Lobes are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LafortuneError {
    /// More lobes than a model may have.
    #[error("the Lafortune model has {lobes} lobes; the maximum is {MAX_LOBES}; remove the weakest")]
    TooMany {
        /// Number of lobes given.
        lobes: usize,
    },
    /// A lobe's factors give no direction.
    #[error(
        "lobe {lobe} has C_t = {tangential} and C_n = {normal}; they must be finite, not both 0, and C_n 0 or more; a mirror \
         lobe has C_t = −C_n, a retro-reflective lobe C_t = C_n"
    )]
    Factors {
        /// Index of the lobe.
        lobe: usize,
        /// C_t.
        tangential: f64,
        /// C_n.
        normal: f64,
    },
    /// An exponent is out of range.
    #[error("lobe {lobe} has an exponent of {exponent}; it must be between 0 and {MAX_EXPONENT}")]
    Exponent {
        /// Index of the lobe.
        lobe: usize,
        /// Value given.
        exponent: f64,
    },
    /// A weight is negative or not a number.
    #[error("the weight of lobe {lobe} is negative or not finite at some wavelength; it must be 0 or more")]
    Weight {
        /// Index of the lobe.
        lobe: usize,
    },
    /// The model reflects more than arrives.
    #[error(transparent)]
    Energy(#[from] EnergyGain),
}

/// A model at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct LafortuneBsdf<'a, const N: usize> {
    model: &'a Lafortune,
    base: Spectral<N>,
    weights: [Spectral<N>; MAX_LOBES],
}

impl<const N: usize> LafortuneBsdf<'_, N> {
    /// Base first, then the lobes, by the reflected light of each.
    fn discrete_sampler(&self, wo: Vec3) -> Option<DiscreteSampler<{ MAX_LOBES + 1 }>> {
        DiscreteSampler::new(core::array::from_fn(|k| match k.checked_sub(1) {
            None => self.base.mean(),
            Some(i) => self.model.albedos.get(i).map_or(0.0, |table| table.at(wo.z) * self.weights[i].mean()),
        }))
    }

    fn value(&self, discrete_sampler: &DiscreteSampler<{ MAX_LOBES + 1 }>, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let mut value_cos = self.base * (wi.z * FRAC_1_PI);
        let mut pdf = discrete_sampler.probability(0) * cosine_hemisphere_pdf(wi.z);
        for (i, lobe) in self.model.lobes.iter().enumerate() {
            let (axis, n) = (lobe.axis(wo), lobe.exponent as f32);
            let length = axis.length();
            let cos = axis.dot(wi) / length.max(f32::MIN_POSITIVE);
            if cos > 0.0 {
                let power = maths::f32::pow(cos.min(1.0), n);
                value_cos += self.weights[i] * (maths::f32::pow(length, n) * power * wi.z);
                pdf += discrete_sampler.probability(i + 1) * (n + 1.0) / TAU * power;
            }
        }
        BsdfValue { value_cos, pdf }
    }
}

impl<const N: usize> BsdfModel<N> for LafortuneBsdf<'_, N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags::LOBES
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let Some(discrete_sampler) = self.discrete_sampler(wo) else { return BsdfValue::ZERO };
        self.value(&discrete_sampler, wo, wi)
    }

    fn gloss(&self, wo: Vec3) -> Gloss {
        let diffuse = Gloss::from_diffuse(self.base.mean() * FRAC_1_PI);
        self.model
            .lobes
            .iter()
            .zip(&self.weights)
            .fold(diffuse, |gloss, (lobe, weight)| gloss.with(lobe.gloss(wo, weight.mean())))
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let discrete_sampler = self.discrete_sampler(wo)?;
        let wi = match discrete_sampler.sample(choice).checked_sub(1) {
            None => cosine_hemisphere(u),
            Some(i) => {
                let lobe = &self.model.lobes[i];
                let axis = lobe.axis(wo).normalize_or(Vec3::Z);
                Basis::about(axis).outward(cosine_power(u, lobe.exponent as f32))
            }
        };
        if wi.z <= 0.0 {
            return None;
        }
        let BsdfValue { value_cos, pdf } = self.value(&discrete_sampler, wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value_cos / pdf, pdf, event: Event::Scatter })
    }
}

/// A direction about +z with density (n + 1)/2π · cosⁿγ.
fn cosine_power(u: Vec2, n: f32) -> Vec3 {
    let cos = maths::f32::pow(u.x, 1.0 / (n + 1.0));
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let (s, c) = maths::f32::sin_cos(TAU * u.y);
    Vec3::new(sin * c, sin * s, cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::textures::Lookup;
    use etendue_core::Wavelengths;

    fn black() -> Reflectance {
        Reflectance::Spectrum(Spectrum::constant(0.0))
    }

    #[test]
    fn a_lobes_albedo_at_normal_incidence_is_closed() {
        // 2π/(n + 2): 2.0944, 0.6283, 0.0616.
        for (n, expected) in [(1.0, 2.0944), (8.0, 0.6283), (100.0, 0.0616)] {
            let lobe = Lobe { tangential: -1.0, normal: 1.0, exponent: n, weight: Spectrum::constant(1.0) };
            assert!((lobe.albedo(1.0) - expected).abs() < 1e-4, "{n}: {}", lobe.albedo(1.0));
        }
    }

    #[test]
    fn a_lobe_at_the_horizon_sends_back_half() {
        // At grazing, a mirror lobe of power n about the surface: ∫ cosⁿγ [sin γ cos φ]₊ dω, for n = 2 it is
        // 2 ∫ c² (1 − c²)^½ dc = 2 · π/16.
        let lobe = Lobe { tangential: -1.0, normal: 1.0, exponent: 2.0, weight: Spectrum::constant(1.0) };
        assert!((lobe.albedo(0.0) - core::f64::consts::PI / 8.0).abs() < 1e-4, "{}", lobe.albedo(0.0));
    }

    #[test]
    fn what_gains_is_refused_with_its_angle() {
        // An off-specular lobe: harmless along the normal, 10 times stronger towards the horizon.
        let weight = Spectrum::constant(1.0);
        let lobe = Lobe { tangential: -1.3, normal: 0.5, exponent: 20.0, weight };
        let error = Lafortune::new(black(), vec![lobe]).expect_err("it gains");
        let LafortuneError::Energy(gain) = error else { panic!("{error}") };
        assert!(gain.albedo > 1.0 && gain.incidence_deg > 45.0, "{gain}");
        let half = Spectrum::constant(0.5);
        assert!(Lafortune::new(Reflectance::Spectrum(half.clone()), vec![Lobe::mirror(30.0, &half)]).is_ok());
        let maximum = Spectrum::constant(0.6);
        let error = Lafortune::new(Reflectance::Spectrum(half), vec![Lobe::mirror(30.0, &maximum)]).expect_err("1.1");
        assert!(matches!(error, LafortuneError::Energy(g) if (g.albedo - 1.1).abs() < 1e-3 && g.incidence_deg == 0.0));
    }

    #[test]
    fn a_lobe_without_weight_is_none() {
        // 1.2¹⁰⁰⁰⁰ overflows.
        let lobe = Lobe { tangential: -1.2, normal: 1.0, exponent: 1e4, weight: Spectrum::constant(0.0) };
        let base = Reflectance::Spectrum(Spectrum::constant(0.5));
        let model = Lafortune::new(base, vec![lobe]).expect("a matt surface");
        let (lookup, wavelengths) = (Lookup::point(Vec2::ZERO), Wavelengths::<1>::uniform(400.0, 700.0, 0.5));
        let bsdf = model.resolve(&ShadingPoint {
            textures: &[],
            lookup: &lookup,
            front: true,
            wavelengths: &wavelengths,
            min_alpha: 0.0,
        });
        let (wo, wi) = (Vec3::new(0.8, 0.0, 0.6), Vec3::new(-0.8, 0.0, 0.6));
        let value = bsdf.evaluate(wo, wi);
        assert!((value.value_cos[0] - 0.3 * FRAC_1_PI).abs() < 1e-7 && value.pdf > 0.0, "{value:?}");
    }

    #[test]
    fn faulty_lobes_are_refused() {
        let weight = Spectrum::constant(0.1);
        let good = Lobe::mirror(10.0, &weight);
        let of = |lobe: Lobe| Lafortune::new(black(), vec![good.clone(), lobe]).expect_err("faulty");
        assert!(matches!(of(Lobe { normal: -1.0, ..good.clone() }), LafortuneError::Factors { lobe: 1, .. }));
        assert!(matches!(of(Lobe { exponent: -1.0, ..good.clone() }), LafortuneError::Exponent { lobe: 1, .. }));
        let negative = Spectrum::constant(-0.1);
        assert!(matches!(of(Lobe { weight: negative, ..good.clone() }), LafortuneError::Weight { lobe: 1 }));
        let many = Lafortune::new(black(), vec![good.clone(); 5]).expect_err("five");
        assert_eq!(many, LafortuneError::TooMany { lobes: 5 });
    }
}
