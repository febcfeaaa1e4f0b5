//! Metallic car paint: metal flakes among pigment, under a clear coat.
//!
//! Three parts, 1/sr, with T the coat's transmittance of `coated`, n its index, ω′ the directions refracted into it:
//!
//! - the coat's own reflection F D G₂/(4 cos θₒ cos θᵢ), exact for a smooth coat;
//! - the base, hit once: T(θₒ) T(θᵢ)/n² · [ s F D G₂/(4 cos θₒ′ cos θᵢ′) + (1 − s) d/π ], flakes (GGX of roughness α_f,
//!   their reflectance F in the coat a spectrum) covering a fraction s of the area, pigment of reflectance d the rest;
//! - light reflected by the base, reflected inside the coat and returned to the base, treated as diffuse from the first internal reflection
//!   (Saunderson 1942): T(θₒ) T(θᵢ)/(n² π) · g R(θₒ) R(θᵢ). R(θ) is the fraction of light from θ that the base reflects and
//!   the coat reflects internally, g = min(ρ̄/(R̄ (1 − R̄)), 1/X). ρ̄ and R̄ are means over diffuse light inside, X the part of R
//!   that leaves. With pigment alone this is Saunderson's sum of `coated`; with white flakes no more leaves than was
//!   reflected internally.
//!
//! Reciprocal. At no incidence or wavelength is more reflected than arrives, as both parts are bounded: after one hit ρ − R, after that R g X ≤ R.
//! Sampled by parts, in proportion to the reflected light of each; flakes inside the coat by visible facets.
//!
//! The flop of colour with the angle comes from s, α_f and d alone. Left out: single flakes (sparkle), layers of flakes above one another, multiple
//! scattering among flakes, change of F with the angle (hardly any for metals below 42° inside), pearl and interference pigments, absorption in the
//! coat.

use core::f32::consts::FRAC_1_PI;

use etendue_core::Spectral;
use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use etendue_spectra::{Spectrum, metal::ComplexIndex};
use glam::{Vec2, Vec3};

use super::coated::{COAT_INDICES, Coat, RowPosition};
use super::energy::{self, AlbedoTable};
use super::gloss::{Gloss, GlossLobe, LobeCentre};
use super::microfacet::{Ggx, half_vector, mirrored};
use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, DiscreteSampler, Event, Passage, SurfaceModel};
use super::parameter::{Factor, Parameter, Reflectance, ShadingPoint, TextureCheck};
use super::{error::MaterialError, fresnel};

/// Parameters of a metallic paint.
#[derive(Clone, Debug, PartialEq)]
pub struct CarPaintParts {
    /// Reflectance d of the pigment between the flakes.
    pub pigment: Reflectance,
    /// Reflectance F of the flakes' metal in the coat, 0 to 1: see [`flake_reflectance`].
    pub flakes: Spectrum,
    /// Fraction s of the area that flakes cover, 0 to 1.
    pub coverage: f64,
    /// Roughness of the flakes' orientation: GGX α_f, 0.05 to 1.
    pub flake_alpha: f64,
    /// Refractive index n of the clear coat.
    pub coat_index: f64,
    /// Roughness of the clear coat, GGX α, 0 to 1.
    pub coat_alpha: f64,
}

/// Reflectance at normal incidence of a metal that lies in a medium of index `medium`.
#[must_use]
pub fn flake_reflectance(metal: &ComplexIndex, medium: f64) -> Spectrum {
    Spectrum::from_fn(|nm| {
        let (n, k) = (f64::from(metal.n.at(nm as f32)), f64::from(metal.k.at(nm as f32)));
        ((n - medium) * (n - medium) + k * k) / ((n + medium) * (n + medium) + k * k)
    })
}

/// A metallic paint.
#[derive(Clone, Debug, PartialEq)]
pub struct CarPaint {
    pigment: Reflectance,
    flakes: Spectrum,
    coverage: f32,
    facets: Ggx,
    coat: Coat,
    coat_alpha: f32,
    place: RowPosition,
    inside: InsideCoat,
}

/// Reflection of flakes of reflectance 1 inside the coat.
#[derive(Clone, Debug, PartialEq)]
struct InsideCoat {
    /// Reflected fraction, by the cosine outside.
    reflected: AlbedoTable,
    /// Part of it that the coat reflects internally.
    internally_reflected: AlbedoTable,
    /// Means of both over diffuse light inside.
    mean_reflected: f32,
    mean_internally_reflected: f32,
    /// Part of the second that leaves if it is emitted upwards with its own profile: X of the flakes.
    escaped: f32,
}

/// The cosine inside the coat for one outside.
fn inner_cos(cos: f32, n: f32) -> f32 {
    (1.0 - (1.0 - cos * cos).max(0.0) / (n * n)).sqrt()
}

/// The cosine outside for one inside; `None` at total reflection.
fn outer_cos(cos: f32, n: f32) -> Option<f32> {
    let square = 1.0 - n * n * (1.0 - cos * cos);
    (square > 0.0).then(|| square.sqrt())
}

/// A direction refracted at the coat's mean plane.
fn refracted(w: Vec3, scale: f32, cos: f32) -> Vec3 {
    Vec3::new(w.x * scale, w.y * scale, cos)
}

impl InsideCoat {
    fn new(facets: Ggx, coat: &Coat, place: RowPosition) -> Self {
        const STEPS: usize = 64;
        let through = |cos: f32| outer_cos(cos, coat.n).map_or(0.0, |outer| coat.transmittance(place, outer));
        let both = |cos: f32| reflected_and_internally_reflected(facets, cos, &through);
        // Means over diffuse light inside: ∫ f dμ², by the midpoint rule.
        let nodes: Vec<_> = (0..STEPS).map(|i| ((i as f32 + 0.5) / STEPS as f32).sqrt()).collect();
        let all: Vec<_> = nodes.iter().map(|cos| both(*cos)).collect();
        let mean = |f: &dyn Fn(usize) -> f64| ((0..STEPS).map(f).sum::<f64>() / STEPS as f64) as f32;
        Self {
            reflected: AlbedoTable::new(|cos| both(inner_cos(cos, coat.n)).0),
            internally_reflected: AlbedoTable::new(|cos| both(inner_cos(cos, coat.n)).1),
            mean_reflected: mean(&|i| all[i].0),
            mean_internally_reflected: mean(&|i| all[i].1),
            escaped: mean(&|i| all[i].1 * f64::from(through(nodes[i]))),
        }
    }
}

/// Fraction of light from a cosine inside that flakes reflect, and the part of it that the coat reflects internally.
fn reflected_and_internally_reflected(facets: Ggx, cos: f32, through: &impl Fn(f32) -> f32) -> (f64, f64) {
    const CELLS: usize = 24;
    let cos = cos.max(1e-4);
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let cell = |i: usize| {
        let u = Vec2::new(0.5 * ((i % CELLS) as f32 + 0.5), (i / CELLS) as f32 + 0.5) / CELLS as f32;
        let wi = mirrored(wo, facets.sample(wo, u));
        let sent = if wi.z > 0.0 { facets.weight(wo, wi) } else { 0.0 };
        (f64::from(sent), f64::from(sent * (1.0 - through(wi.z))))
    };
    let sum = (0..CELLS * CELLS).map(cell).fold((0.0, 0.0), |sum, x| (sum.0 + x.0, sum.1 + x.1));
    let cells = (CELLS * CELLS) as f64;
    (sum.0 / cells, sum.1 / cells)
}

impl CarPaint {
    /// A paint of `parts`.
    ///
    /// # Errors
    /// If a number or spectrum is out of range.
    pub fn new(parts: CarPaintParts) -> Result<Self, CarPaintError> {
        if !COAT_INDICES.contains(&parts.coat_index) {
            return Err(MaterialError::CoatIndex { n: parts.coat_index }.into());
        }
        if !(0.05..=1.0).contains(&parts.flake_alpha) {
            return Err(CarPaintError::FlakeAlpha { alpha: parts.flake_alpha });
        }
        if !(0.0..=1.0).contains(&parts.coverage) {
            return Err(CarPaintError::Coverage { coverage: parts.coverage });
        }
        if !energy::is_weight(&parts.flakes) || parts.flakes.max_value() > 1.0 {
            return Err(CarPaintError::Flakes);
        }
        let alpha = Factor::from(parts.coat_alpha).checked_alpha()?;
        let coat = Coat::new(parts.coat_index as f32, alpha);
        let place = coat.place(parts.coat_alpha as f32);
        let facets = Ggx { alpha: parts.flake_alpha as f32 };
        Ok(Self {
            inside: InsideCoat::new(facets, &coat, place),
            coat_alpha: parts.coat_alpha as f32,
            pigment: parts.pigment,
            flakes: parts.flakes,
            coverage: parts.coverage as f32,
            facets,
            coat,
            place,
        })
    }

    /// Fraction of diffuse light inside that the coat reflects internally.
    fn internal_diffuse_reflectance(&self) -> f32 {
        1.0 - self.coat.mean_transmittance(self.place) / (self.coat.n * self.coat.n)
    }
}

impl SurfaceModel for CarPaint {
    type Bsdf<'a, const N: usize> = CarPaintBsdf<'a, N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Reflectance(&self.pigment)]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> CarPaintBsdf<'_, N> {
        let flakes = self.flakes.sample(point.wavelengths) * self.coverage;
        let pigment = point.reflectance(&self.pigment) * (1.0 - self.coverage);
        let turned = self.internal_diffuse_reflectance();
        let again = Spectral::from_fn(|i| {
            let (f, d) = (flakes[i], pigment[i]);
            let sent = f * self.inside.mean_reflected + d;
            let round = f * self.inside.mean_internally_reflected + d * turned;
            let out = f * self.inside.escaped + d * turned * (1.0 - turned);
            if round > 1e-6 { (sent / (round * (1.0 - round))).min(1.0 / out) } else { 0.0 }
        });
        // Outside, the coat's refraction also spreads the light of flakes.
        let facets = Ggx { alpha: self.facets.alpha.max(point.min_alpha / self.coat.n) };
        let coat_alpha = point.widened(self.coat_alpha);
        let (coat_facets, is_widened) = (Ggx::from_alpha(coat_alpha), coat_alpha > self.coat_alpha);
        CarPaintBsdf { paint: self, facets, coat_facets, is_widened, flakes, pigment, turned, again }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// Error of a metallic paint.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CarPaintError {
    /// The flakes' roughness is out of range.
    #[error("the flakes' roughness α is {alpha}; it must be between 0.05 and 1")]
    FlakeAlpha {
        /// Value given.
        alpha: f64,
    },
    /// The coverage is out of range.
    #[error("the flakes' coverage is {coverage}; it must be between 0 and 1")]
    Coverage {
        /// Value given.
        coverage: f64,
    },
    /// The flakes' reflectance is out of range.
    #[error("the flakes' reflectance is outside 0 to 1 at some wavelength; scale it")]
    Flakes,
    /// The coat is invalid.
    #[error(transparent)]
    Coat(#[from] MaterialError),
}

/// A metallic paint at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct CarPaintBsdf<'a, const N: usize> {
    paint: &'a CarPaint,
    /// The flakes' facets, in the coat.
    facets: Ggx,
    /// `None` for a smooth coat.
    coat_facets: Option<Ggx>,
    /// True if they are rougher than the coat.
    is_widened: bool,
    /// s F.
    flakes: Spectral<N>,
    /// (1 − s) d.
    pigment: Spectral<N>,
    /// Fraction of diffuse light inside that the coat reflects internally.
    turned: f32,
    /// g.
    again: Spectral<N>,
}

impl<const N: usize> CarPaintBsdf<'_, N> {
    fn through(&self, cos: f32) -> f32 {
        self.paint.coat.transmittance(self.paint.place, cos)
    }

    /// R at a cosine outside.
    fn round(&self, cos: f32) -> Spectral<N> {
        self.flakes * self.paint.inside.internally_reflected.at(cos) + self.pigment * self.turned
    }

    /// Sampler of coat, flakes and diffuse part, by the reflected light of each.
    fn discrete_sampler(&self, wo: Vec3) -> Option<DiscreteSampler<3>> {
        let (inside, through) = (&self.paint.inside, self.through(wo.z));
        let flakes = self.flakes.mean() * (inside.reflected.at(wo.z) - inside.internally_reflected.at(wo.z)).max(0.0);
        let (f, d) = (self.flakes.mean(), self.pigment.mean());
        let out = f * inside.escaped + d * self.turned * (1.0 - self.turned);
        let diffuse = d * (1.0 - self.turned) + self.round(wo.z).mean() * self.again.mean() * out;
        DiscreteSampler::new([1.0 - through, through * flakes, through * diffuse])
    }

    fn value(&self, discrete_sampler: &DiscreteSampler<3>, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let n = self.paint.coat.n;
        let both = self.through(wo.z) * self.through(wi.z) / (n * n);
        let (flake, flake_pdf) = self.flake(wo, wi);
        let diffuse = self.pigment + self.round(wo.z) * self.round(wi.z) * self.again;
        let mut value_cos = self.flakes * (both * flake) + diffuse * (both * FRAC_1_PI * wi.z);
        let mut pdf =
            discrete_sampler.probability(1) * flake_pdf + discrete_sampler.probability(2) * cosine_hemisphere_pdf(wi.z);
        if let Some(facets) = self.coat_facets {
            let m = half_vector(wo, wi);
            let reflected = if self.is_widened { 1.0 - self.through(wo.z) } else { fresnel::dielectric(wo.dot(m), n) };
            value_cos += Spectral::splat(reflected * facets.reflect(wo, wi, m));
            pdf += discrete_sampler.probability(0) * facets.reflect_pdf(wo, m);
        }
        BsdfValue { value_cos, pdf }
    }

    /// For flakes of reflectance 1: f′ cos θᵢ for directions outside, and the density of sampling them there.
    fn flake(&self, wo: Vec3, wi: Vec3) -> (f32, f32) {
        let (n, facets) = (self.paint.coat.n, self.facets);
        let (o, i) = (refracted(wo, 1.0 / n, inner_cos(wo.z, n)), refracted(wi, 1.0 / n, inner_cos(wi.z, n)));
        let m = half_vector(o, i);
        (facets.reflect(o, i, m) * wi.z / i.z, facets.reflect_pdf(o, m) * wi.z / (n * n * i.z))
    }

    /// Samples a direction outside, reflected at a flake; `None` if the coat reflects it internally.
    fn sample_flake(&self, wo: Vec3, u: Vec2) -> Option<Vec3> {
        let n = self.paint.coat.n;
        let o = refracted(wo, 1.0 / n, inner_cos(wo.z, n));
        let i = mirrored(o, self.facets.sample(o, u));
        let cos = outer_cos(i.z, n).filter(|_| i.z > 0.0)?;
        Some(refracted(i, n, cos))
    }
}

impl<const N: usize> BsdfModel<N> for CarPaintBsdf<'_, N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags::LOBES
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        self.discrete_sampler(wo).map_or(BsdfValue::ZERO, |discrete_sampler| self.value(&discrete_sampler, wo, wi))
    }

    fn gloss(&self, wo: Vec3) -> Gloss {
        let n = self.paint.coat.n;
        let (through, inner) = (self.through(wo.z), inner_cos(wo.z, n));
        let both = through * through / (n * n);
        let diffuse = self.pigment + self.round(wo.z) * self.round(wo.z) * self.again;
        // Slopes of half vectors are those inside times n cos θ′/cos θ.
        let width = (self.facets.alpha * n * inner / wo.z).min(1.0);
        let mirror = Vec3::new(-wo.x, -wo.y, wo.z);
        let peak = self.flakes.mean() * both * self.flake(wo, mirror).0;
        let flakes = GlossLobe { about: LobeCentre::HalfVector, width, peak, f0: 1.0 };
        let gloss = Gloss::from_diffuse(diffuse.mean() * both * FRAC_1_PI).with(flakes);
        match self.coat_facets {
            Some(facets) => gloss.with(facets.gloss(wo, fresnel::dielectric(1.0, n))),
            None => gloss,
        }
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let discrete_sampler = self.discrete_sampler(wo)?;
        let wi = match (discrete_sampler.sample(choice), self.coat_facets) {
            (0, Some(facets)) => mirrored(wo, facets.sample(wo, u)),
            (0, None) => {
                let reflectance = fresnel::dielectric(wo.z, self.paint.coat.n) / discrete_sampler.probability(0);
                return Some(BsdfSample::mirror(wo, Spectral::splat(reflectance)));
            }
            (1, _) => self.sample_flake(wo, u)?,
            _ => cosine_hemisphere(u),
        };
        if wi.z <= 0.0 {
            return None;
        }
        let BsdfValue { value_cos, pdf } = self.value(&discrete_sampler, wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value_cos / pdf, pdf, event: Event::Scatter })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flakes_of_aluminium_in_lacquer_reflect_less_than_in_air() {
        let metal = etendue_spectra::metal::by_name("Al").expect("aluminium");
        let (air, lacquer) = (flake_reflectance(metal, 1.0).at(550.0), flake_reflectance(metal, 1.5).at(550.0));
        assert!((air - 0.915).abs() < 0.02 && lacquer < air && lacquer > 0.85, "{air} {lacquer}");
    }

    #[test]
    fn faulty_paints_are_refused() {
        let parts = CarPaintParts {
            pigment: Reflectance::Spectrum(Spectrum::constant(0.1)),
            flakes: Spectrum::constant(0.9),
            coverage: 0.5,
            flake_alpha: 0.3,
            coat_index: 1.5,
            coat_alpha: 0.0,
        };
        let of = |parts| CarPaint::new(parts).expect_err("faulty");
        assert!(CarPaint::new(parts.clone()).is_ok());
        assert_eq!(of(CarPaintParts { flake_alpha: 0.0, ..parts.clone() }), CarPaintError::FlakeAlpha { alpha: 0.0 });
        assert_eq!(of(CarPaintParts { coverage: 1.5, ..parts.clone() }), CarPaintError::Coverage { coverage: 1.5 });
        assert_eq!(of(CarPaintParts { flakes: Spectrum::constant(1.5), ..parts.clone() }), CarPaintError::Flakes);
        let index = MaterialError::CoatIndex { n: 1.0 };
        assert_eq!(of(CarPaintParts { coat_index: 1.0, ..parts.clone() }), CarPaintError::Coat(index));
        let alpha = MaterialError::Roughness { alpha: 2.0 };
        assert_eq!(of(CarPaintParts { coat_alpha: 2.0, ..parts }), CarPaintError::Coat(alpha));
    }

    #[test]
    fn bending_in_and_out_again_leaves_a_direction() {
        for cos in [0.01, 0.3, 0.99] {
            let back = outer_cos(inner_cos(cos, 1.5), 1.5).expect("from outside");
            assert!((back - cos).abs() < 1e-4, "{cos}: {back}");
        }
        assert!(outer_cos(0.5, 1.5).is_none());
    }
}
