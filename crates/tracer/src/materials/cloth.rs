//! Cloth: the sheen of fibres over a diffuse base.
//!
//! f = c f_s + (ρ/π) (1 − c E(θₒ)) (1 − c E(θᵢ))/(1 − c Ē), 1/sr. The sheen f_s = D G/(4 cos θₒ cos θᵢ) is that of Estevez and Kulla 2017: D = (2 +
//! 1/α) sin^(1/α)θ_h/2π, facets that stand upright like the ends of fibres, α from 0.1 (short nap, visible at grazing only) to 1; G = 1/(1 + Λₒ + Λᵢ)
//! with their fit of Λ, without their softened terminator, which is not reciprocal. c is the sheen's colour, 0 to 1, ρ the base's reflectance; E the
//! sheen's albedo, tabulated, Ē its mean 2 ∫ E μ dμ. The base receives the light that the sheen leaves (after Kelemen and Szirmay-Kalos 2001). A
//! white cloth therefore reflects exactly the light that arrives, and others less. If the fit itself would gain energy, f_s is scaled to E ≤ 1.
//!
//! The sheen is sampled from tables of the cosine, row by row of the viewer's, with uniform azimuth; the base by the cosine.
//!
//! Left out: the weave, highlights of threads and their direction, transmission through the cloth (see the leaf for that).

use core::f32::consts::{FRAC_1_PI, PI, TAU};

use etendue_core::Spectral;
use etendue_core::maths::f32::{exp, pow, sin_cos};
use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use etendue_spectra::Spectrum;
use glam::{Vec2, Vec3};

use super::energy::{self, AlbedoTable};
use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, DiscreteSampler, Event, Passage, SurfaceModel};
use super::parameter::{Parameter, Reflectance, ShadingPoint, TextureCheck};
use super::{error::MaterialError, gloss::Gloss, microfacet::half_vector};

#[derive(Clone, Debug, PartialEq)]
pub struct Cloth {
    base: Reflectance,
    colour: Spectrum,
    sheen: Sheen,
    albedo: AlbedoTable,
    mean: f32,
    /// For each of [`ROWS`] cosines of the viewer, the fraction of the sheen below each of [`CELLS`] cosines of light.
    cumulative: Vec<f32>,
}

const ROWS: usize = 16;
const CELLS: usize = 24;

impl Cloth {
    /// A base of reflectance `base` under a sheen of colour `colour` (0 to 1) and roughness `alpha` (0.1 to 1).
    ///
    /// # Errors
    /// If the colour or the roughness is out of range.
    pub fn new(base: Reflectance, colour: Spectrum, alpha: f64) -> Result<Self, ClothError> {
        if !(0.1..=1.0).contains(&alpha) {
            return Err(ClothError::Alpha { alpha });
        }
        if !energy::is_weight(&colour) || colour.max_value() > 1.0 {
            return Err(ClothError::Colour);
        }
        let bare = Sheen::new(alpha as f32, 1.0);
        let maximum = AlbedoTable::new(|cos| bare.albedo(cos)).max_value();
        let sheen = Sheen { scale: 1.0 / maximum.max(1.0), ..bare };
        let albedo = AlbedoTable::new(|cos| sheen.albedo(cos));
        let cumulative = (0..=ROWS).flat_map(|row| sheen.row(row)).collect();
        Ok(Self { base, colour, sheen, mean: albedo.mean(), albedo, cumulative })
    }

    /// The row of a viewer's cosine.
    fn cumulative_row(&self, cos: f32) -> &[f32] {
        let row = (cos.min(1.0).sqrt() * ROWS as f32 + 0.5) as usize;
        &self.cumulative[row * (CELLS + 1)..(row + 1) * (CELLS + 1)]
    }
}

impl SurfaceModel for Cloth {
    type Bsdf<'a, const N: usize> = ClothBsdf<'a, N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Reflectance(&self.base)]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> ClothBsdf<'_, N> {
        let colour = self.colour.sample(point.wavelengths);
        let base = point.reflectance(&self.base);
        let under = Spectral::from_fn(|i| base[i] / (1.0 - colour[i] * self.mean));
        ClothBsdf { cloth: self, colour, under, base_mean: base.mean(), colour_mean: colour.mean() }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// Error of a cloth.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ClothError {
    /// The sheen's roughness is out of range.
    #[error("the sheen's roughness α is {alpha}; it must be between 0.1 and 1")]
    Alpha {
        /// Value given.
        alpha: f64,
    },
    /// The sheen's colour is out of range.
    #[error("the sheen's colour is outside 0 to 1 at some wavelength; scale it")]
    Colour,
}

/// The sheen at colour 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sheen {
    /// 1/α.
    power: f32,
    /// The five coefficients of Λ.
    fit: [f32; 5],
    scale: f32,
}

impl Sheen {
    fn new(alpha: f32, scale: f32) -> Self {
        const SHARP: [f32; 5] = [25.3245, 3.32435, 0.16801, -1.27393, -4.85967];
        const SOFT: [f32; 5] = [21.5473, 3.82987, 0.19823, -1.97760, -4.32054];
        let sharp = (1.0 - alpha) * (1.0 - alpha);
        Self { power: 1.0 / alpha, fit: core::array::from_fn(|i| sharp * SHARP[i] + (1.0 - sharp) * SOFT[i]), scale }
    }

    fn exponent(self, cos: f32) -> f32 {
        let [a, b, c, d, e] = self.fit;
        a / (1.0 + b * pow(cos.max(1e-6), c)) + d * cos + e
    }

    fn shadow(self, cos: f32) -> f32 {
        exp(if cos < 0.5 { self.exponent(cos) } else { 2.0 * self.exponent(0.5) - self.exponent(1.0 - cos) })
    }

    /// f_s cos θᵢ.
    fn value_cos(self, wo: Vec3, wi: Vec3) -> f32 {
        let h = half_vector(wo, wi);
        let sin2 = (h.x * h.x + h.y * h.y).min(1.0);
        let density = (2.0 + self.power) * pow(sin2, 0.5 * self.power) / TAU;
        let (o, i) = (wo.z.max(GRAZING), wi.z.max(GRAZING));
        self.scale * density * wi.z / (4.0 * (1.0 + self.shadow(o) + self.shadow(i)) * o * i)
    }

    /// ∫ f_s cos θᵢ dφ over a turn, by the midpoint rule on half of it.
    fn ring(self, wo: Vec3, cos: f32) -> f64 {
        const TURN: usize = 24;
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let at = |j: usize| {
            let (s, c) = sin_cos(PI * (j as f32 + 0.5) / TURN as f32);
            f64::from(self.value_cos(wo, Vec3::new(sin * c, sin * s, cos)))
        };
        f64::from(TAU) * (0..TURN).map(at).sum::<f64>() / TURN as f64
    }

    fn albedo(self, cos: f32) -> f64 {
        let wo = from_cos(cos);
        (0..CELLS).map(|k| self.cell(wo, k)).sum()
    }

    /// Light reflected to cosines of cell `k`, by the midpoint rule on four parts of it.
    fn cell(self, wo: Vec3, k: usize) -> f64 {
        let edge = |i: usize| square((4 * k + i) as f32 / (4 * CELLS) as f32);
        (0..4).map(|i| self.ring(wo, 0.5 * (edge(i) + edge(i + 1))) * f64::from(edge(i + 1) - edge(i))).sum()
    }

    /// Fractions of the sheen below each edge, for a viewer of a row.
    fn row(self, row: usize) -> Vec<f32> {
        let wo = from_cos(square(row as f32 / ROWS as f32).max(GRAZING));
        let cells: Vec<_> = (0..CELLS).map(|k| self.cell(wo, k)).collect();
        let total: f64 = cells.iter().sum();
        let mut sum = 0.0;
        let mut fractions = vec![0.0];
        fractions.extend(cells.iter().map(|cell| {
            sum += cell / total;
            sum.min(1.0) as f32
        }));
        fractions
    }
}

/// Minimum cosine for shadowing and for the BSDF's divisor.
const GRAZING: f32 = 1e-3;

fn square(x: f32) -> f32 {
    x * x
}

fn from_cos(cos: f32) -> Vec3 {
    Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos)
}

fn edge(k: usize) -> f32 {
    square(k as f32 / CELLS as f32)
}

/// A cloth at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct ClothBsdf<'a, const N: usize> {
    cloth: &'a Cloth,
    colour: Spectral<N>,
    /// ρ/(1 − c Ē).
    under: Spectral<N>,
    base_mean: f32,
    colour_mean: f32,
}

impl<const N: usize> ClothBsdf<'_, N> {
    fn discrete_sampler(&self, wo_albedo: f32) -> Option<DiscreteSampler<2>> {
        let sheen = self.colour_mean * wo_albedo;
        DiscreteSampler::new([self.base_mean * (1.0 - sheen), sheen])
    }

    fn value(&self, discrete_sampler: DiscreteSampler<2>, wo_albedo: f32, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let wi_albedo = self.cloth.albedo.at(wi.z);
        let left = self.colour.map(|c| (1.0 - c * wo_albedo) * (1.0 - c * wi_albedo));
        BsdfValue {
            value_cos: self.under * left * (FRAC_1_PI * wi.z) + self.colour * self.cloth.sheen.value_cos(wo, wi),
            pdf: discrete_sampler.probability(0) * cosine_hemisphere_pdf(wi.z)
                + discrete_sampler.probability(1) * self.sheen_pdf(wo, wi),
        }
    }

    fn sheen_pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let k = ((wi.z.min(1.0).sqrt() * CELLS as f32) as usize).min(CELLS - 1);
        let fractions = self.cloth.cumulative_row(wo.z);
        (fractions[k + 1] - fractions[k]) / (TAU * (edge(k + 1) - edge(k)))
    }

    fn sample_sheen(&self, wo: Vec3, u: Vec2) -> Vec3 {
        let fractions = self.cloth.cumulative_row(wo.z);
        let k = fractions.partition_point(|c| *c <= u.x).clamp(1, CELLS) - 1;
        let within = ((u.x - fractions[k]) / (fractions[k + 1] - fractions[k]).max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        let cos = edge(k) + (edge(k + 1) - edge(k)) * within;
        let (s, c) = sin_cos(TAU * u.y);
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        Vec3::new(sin * c, sin * s, cos)
    }
}

impl<const N: usize> BsdfModel<N> for ClothBsdf<'_, N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags::LOBES
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let wo_albedo = self.cloth.albedo.at(wo.z);
        self.discrete_sampler(wo_albedo)
            .map_or(BsdfValue::ZERO, |discrete_sampler| self.value(discrete_sampler, wo_albedo, wo, wi))
    }

    fn gloss(&self, _: Vec3) -> Gloss {
        Gloss::MATT
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let wo_albedo = self.cloth.albedo.at(wo.z);
        let discrete_sampler = self.discrete_sampler(wo_albedo)?;
        let wi = if discrete_sampler.sample(choice) == 0 { cosine_hemisphere(u) } else { self.sample_sheen(wo, u) };
        if wi.z <= 0.0 {
            return None;
        }
        let BsdfValue { value_cos, pdf } = self.value(discrete_sampler, wo_albedo, wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value_cos / pdf, pdf, event: Event::Scatter })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faulty_cloths_are_refused() {
        let of = |colour, alpha| {
            let base = Reflectance::Spectrum(Spectrum::constant(0.5));
            Cloth::new(base, Spectrum::constant(colour), alpha).expect_err("faulty")
        };
        assert_eq!(of(0.5, 0.0), ClothError::Alpha { alpha: 0.0 });
        assert_eq!(of(1.5, 0.5), ClothError::Colour);
    }

    #[test]
    fn sheen_grows_towards_grazing() {
        let base = Reflectance::Spectrum(Spectrum::constant(0.0));
        let cloth = Cloth::new(base, Spectrum::constant(1.0), 0.3).expect("a cloth");
        assert!(cloth.albedo.at(0.1) > 4.0 * cloth.albedo.at(0.9), "{} {}", cloth.albedo.at(0.1), cloth.albedo.at(0.9));
    }
}
