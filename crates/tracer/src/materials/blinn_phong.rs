//! Blinn–Phong model with its exact normalisation.
//!
//! f = k_d/π + k_s c_n (n·h)ⁿ, 1/sr, h the unit vector half-way between both directions (Blinn 1977), with c_n = (n + 2)(n + 4)/(8π(2^(−n/2) + n)),
//! so that k_s is exactly the lobe's albedo at normal incidence (Arvo's moment integrals; the usual (n + 8)/8π errs by up to 7.5 %). k_d and k_s are
//! spectra in 0–1, n lies in 0–100 000.
//!
//! Half vectors are sampled with density (n + 2)/2π · cosⁿ⁺¹θ, mixed with the cosine for the base in proportion to the reflected light of each; below
//! n = 4 the cosine serves both. The albedo over all incidences is tabulated; models that reflect more than arrives are refused. Towards grazing
//! incidence the lobe loses energy, as it has no Fresnel factor; shadowing is left out.

use core::f32::consts::{FRAC_1_PI, TAU};

use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use etendue_core::{Spectral, maths};
use etendue_spectra::Spectrum;
use glam::{Vec2, Vec3};

use super::energy::{self, AlbedoTable, WeightedLobe};
use super::error::{EnergyGain, MaterialError};
use super::gloss::{Gloss, GlossLobe, LobeCentre};
use super::microfacet::{half_vector, mirrored};
use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, DiscreteSampler, Event, Passage, SurfaceModel};
use super::parameter::{Parameter, Reflectance, ShadingPoint, TextureCheck};

/// The sharpest lobe: about 0.2° wide.
const MAX_EXPONENT: f64 = 1e5;

/// Exponent below which the cosine samples lobes better than half vectors do.
const MAX_COSINE_EXPONENT: f32 = 4.0;

/// c_n: normalisation that gives the lobe (n·h)ⁿ an albedo of 1 at normal incidence.
#[must_use]
pub fn blinn_phong_normalisation(n: f64) -> f64 {
    (n + 2.0) * (n + 4.0) / (8.0 * core::f64::consts::PI * (maths::f64::exp2(-0.5 * n) + n))
}

/// A diffuse base and a glossy lobe.
#[derive(Clone, Debug, PartialEq)]
pub struct BlinnPhong {
    base: Reflectance,
    gloss: Spectrum,
    lobe: CosineLobe,
    /// Albedo of the lobe at k_s = 1.
    albedo: AlbedoTable,
}

impl BlinnPhong {
    /// A base of reflectance k_d and a lobe of exponent n with albedo k_s at normal incidence.
    ///
    /// # Errors
    /// If the exponent is out of range, k_s is negative or the model reflects more than arrives.
    pub fn new(base: Reflectance, gloss: Spectrum, exponent: f64) -> Result<Self, BlinnPhongError> {
        if !(0.0..=MAX_EXPONENT).contains(&exponent) {
            return Err(BlinnPhongError::Exponent { exponent });
        }
        if !energy::is_weight(&gloss) {
            return Err(BlinnPhongError::Gloss);
        }
        let lobe = CosineLobe { n: exponent as f32, scale: blinn_phong_normalisation(exponent) as f32 };
        let model = Self { base, gloss, lobe, albedo: AlbedoTable::new(|cos| lobe.albedo(cos)) };
        model.refuse_gain(&energy::known(&model.base))?;
        Ok(model)
    }

    /// Refuses a base with which more is reflected than arrives.
    fn refuse_gain(&self, base: &Spectrum) -> Result<(), EnergyGain> {
        energy::check(base, &[WeightedLobe { weight: &self.gloss, albedo: &self.albedo }])
    }
}

impl SurfaceModel for BlinnPhong {
    type Bsdf<'a, const N: usize> = BlinnPhongBsdf<'a, N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Reflectance(&self.base)]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> BlinnPhongBsdf<'_, N> {
        BlinnPhongBsdf { model: self, base: point.reflectance(&self.base), gloss: self.gloss.sample(point.wavelengths) }
    }

    fn check_energy(&self, check: &TextureCheck<'_>) -> Result<(), MaterialError> {
        let gained = |gain| MaterialError::Gain { material: check.material, gain };
        self.refuse_gain(&check.brightest(&self.base)).map_err(gained)
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// Error of a Blinn–Phong model.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BlinnPhongError {
    /// The exponent is out of range.
    #[error("the exponent is {exponent}; it must be between 0 and {MAX_EXPONENT}")]
    Exponent {
        /// Value given.
        exponent: f64,
    },
    /// The gloss is negative or not a number.
    #[error("the specular reflectance is negative or not finite at some wavelength; it must lie between 0 and 1")]
    Gloss,
    /// The model reflects more than arrives.
    #[error(transparent)]
    Energy(#[from] EnergyGain),
}

/// The lobe c_n (n·h)ⁿ.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CosineLobe {
    n: f32,
    scale: f32,
}

impl CosineLobe {
    fn half_vector(self, u: Vec2) -> Vec3 {
        let cos = maths::f32::pow(u.x, 1.0 / (self.n + 2.0));
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let (s, c) = maths::f32::sin_cos(TAU * u.y);
        Vec3::new(sin * c, sin * s, cos)
    }

    /// f cos θᵢ over the density of `wi`, for a sampled half vector.
    fn weight(self, wo: Vec3, wi: Vec3, h: Vec3) -> f32 {
        self.scale * 4.0 * TAU / (self.n + 2.0) * wo.dot(h) * wi.z / h.z.max(f32::MIN_POSITIVE)
    }

    /// By the midpoint rule over the sample square (half a turn: the lobe is symmetric): cosine sampling for a wide lobe, half vectors for
    /// a narrow one.
    fn albedo(self, cos: f32) -> f64 {
        const CELLS: usize = 64;
        let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
        let place = |i: usize| (i as f32 + 0.5) / CELLS as f32;
        let cell = |i: usize| {
            let u = Vec2::new(place(i / CELLS), 0.5 * place(i % CELLS));
            f64::from(if self.n < 64.0 { self.wide(wo, u) } else { self.narrow(wo, u) })
        };
        (0..CELLS * CELLS).map(cell).sum::<f64>() / (CELLS * CELLS) as f64
    }

    /// f cos θᵢ over the density of a direction sampled by the cosine.
    fn wide(self, wo: Vec3, u: Vec2) -> f32 {
        let (s, c) = maths::f32::sin_cos(TAU * u.y);
        let r = u.x.sqrt();
        let h = half_vector(wo, Vec3::new(r * c, r * s, (1.0 - u.x).sqrt()));
        core::f32::consts::PI * self.scale * maths::f32::pow(h.z, self.n)
    }

    /// The same for a direction sampled by its half vector.
    fn narrow(self, wo: Vec3, u: Vec2) -> f32 {
        let h = self.half_vector(u);
        let wi = mirrored(wo, h);
        if wi.z > 0.0 && wo.dot(h) > 0.0 { self.weight(wo, wi, h) } else { 0.0 }
    }
}

/// A model at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct BlinnPhongBsdf<'a, const N: usize> {
    model: &'a BlinnPhong,
    base: Spectral<N>,
    gloss: Spectral<N>,
}

impl<const N: usize> BlinnPhongBsdf<'_, N> {
    fn discrete_sampler(&self, wo: Vec3) -> Option<DiscreteSampler<2>> {
        let (base, lobe) = (self.base.mean(), self.gloss.mean() * self.model.albedo.at(wo.z));
        DiscreteSampler::new(if self.model.lobe.n < MAX_COSINE_EXPONENT { [base + lobe, 0.0] } else { [base, lobe] })
    }

    fn value(&self, discrete_sampler: DiscreteSampler<2>, wo: Vec3, wi: Vec3, h: Vec3) -> BsdfValue<N> {
        let CosineLobe { n, scale } = self.model.lobe;
        let power = maths::f32::pow(h.z.clamp(0.0, 1.0), n);
        let lobe_pdf = (n + 2.0) / TAU * power * h.z / (4.0 * wo.dot(h)).max(1e-20);
        BsdfValue {
            value_cos: self.base * (wi.z * FRAC_1_PI) + self.gloss * (scale * power * wi.z),
            pdf: discrete_sampler.probability(0) * cosine_hemisphere_pdf(wi.z)
                + discrete_sampler.probability(1) * lobe_pdf,
        }
    }
}

impl<const N: usize> BsdfModel<N> for BlinnPhongBsdf<'_, N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags::LOBES
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        self.discrete_sampler(wo)
            .map_or(BsdfValue::ZERO, |discrete_sampler| self.value(discrete_sampler, wo, wi, half_vector(wo, wi)))
    }

    fn gloss(&self, wo: Vec3) -> Gloss {
        let CosineLobe { n, scale } = self.model.lobe;
        // cosⁿ of the half vector's angle and the kernel have the same curvature at the axis, t² n/2 = 2 t² (1/w² − 1).
        let width = (4.0 / (n + 4.0)).sqrt();
        let peak = self.gloss.mean() * scale * wo.z;
        Gloss::from_diffuse(self.base.mean() * FRAC_1_PI).with(GlossLobe {
            about: LobeCentre::HalfVector,
            width,
            peak,
            f0: 1.0,
        })
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let discrete_sampler = self.discrete_sampler(wo)?;
        let (wi, h) = if discrete_sampler.sample(choice) == 0 {
            let wi = cosine_hemisphere(u);
            (wi, half_vector(wo, wi))
        } else {
            let h = self.model.lobe.half_vector(u);
            (mirrored(wo, h), h)
        };
        if wi.z <= 0.0 || wo.dot(h) <= 0.0 {
            return None;
        }
        let BsdfValue { value_cos, pdf } = self.value(discrete_sampler, wo, wi, h);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value_cos / pdf, pdf, event: Event::Scatter })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_normalisation_has_its_known_values() {
        for (n, expected) in [(1.0, 0.34962), (10.0, 0.66637), (100.0, 4.22079), (1000.0, 40.02779)] {
            assert!((blinn_phong_normalisation(n) - expected).abs() < 1e-5 * expected.max(1.0), "{n}");
        }
    }

    #[test]
    fn all_light_comes_back_at_normal_incidence_and_less_elsewhere() {
        for n in [0.0, 1.0, 10.0, 65.0, 1000.0, 1e5] {
            let lobe = CosineLobe { n: n as f32, scale: blinn_phong_normalisation(n) as f32 };
            // The midpoint rule over 64² cells: second order where it is smooth, 64^-1.5/4 at a kink at the horizon.
            assert!((lobe.albedo(1.0) - 1.0).abs() < 5e-4, "{n}: {}", lobe.albedo(1.0));
            assert!((0..100).all(|i| lobe.albedo(i as f32 / 100.0) < 1.0005), "{n}");
        }
    }

    #[test]
    fn what_gains_is_refused() {
        let grey = |v| Reflectance::Spectrum(Spectrum::constant(v));
        assert!(BlinnPhong::new(grey(0.6), Spectrum::constant(0.39), 50.0).is_ok());
        let error = BlinnPhong::new(grey(0.6), Spectrum::constant(0.5), 50.0).expect_err("1.1");
        assert!(matches!(error, BlinnPhongError::Energy(g) if (g.albedo - 1.1).abs() < 2e-3 && g.incidence_deg < 10.0));
        let of = |gloss, n| BlinnPhong::new(grey(0.0), Spectrum::constant(gloss), n).expect_err("faulty");
        assert_eq!(of(0.5, -1.0), BlinnPhongError::Exponent { exponent: -1.0 });
        assert_eq!(of(-0.5, 1.0), BlinnPhongError::Gloss);
    }
}
