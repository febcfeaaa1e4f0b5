//! Plastics and paints: a diffuse base under a clear, rough coat.
//!
//! f = F(n) · D · G₂ / (4 cos θₒ cos θᵢ) + (a/π) · T(θᵢ) T(θₒ) / (n² (1 − a·Fᵢₙₜ))
//!
//! The first term is the coat's GGX reflection with the exact dielectric Fresnel factor (index n, without dispersion). The second is the base of
//! albedo a, seen through the coat, with all reflections between base and coat's inner side (Saunderson 1942). T(θ) = 1 − E(θ), E = the coat's
//! directional-hemispherical reflectance, tabulated at construction by quadrature over slopes. The inner diffuse reflectance follows from
//! reciprocity, Fᵢₙₜ = 1 − T̄/n² with T̄ = 2 ∫ T(μ) μ dμ. A white base thus returns exactly the light that the coat let in: energy is conserved at a
//! = 1 and lost below. Symmetric in both directions by construction. If the roughness is a texture, T is also tabulated over roughness and
//! interpolated.
//!
//! Left out: absorption in the coat, dispersion, refraction of the roughness at entry and exit.

use core::f32::consts::FRAC_1_PI;

use etendue_core::Spectral;
use etendue_core::maths::f32::{exp, ln};
use etendue_core::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use glam::{Vec2, Vec3};

use super::microfacet::{Distribution, Ggx, MIRROR_ALPHA, half_vector, mirrored};
use super::model::{BsdfFlags, BsdfModel, BsdfSample, BsdfValue, Event, Passage, SurfaceModel};
use super::parameter::{Factor, Parameter, Reflectance, ShadingPoint, TextureCheck};
use super::{
    energy::CosineTable, error::MaterialError, fresnel, gloss::Gloss, puddles::Puddles, slopes::VisibleFacets,
};

/// Range of a coat's refractive index: from a little above air's, below which neither f32 nor the table would resolve the coat, to that of
/// germanium. Scene files state the same range.
pub const COAT_INDICES: core::ops::RangeInclusive<f64> = 1.1..=4.0;

/// Refractive index of water (without dispersion).
pub const WATER: f64 = 1.333;

/// A coated diffuse surface.
#[derive(Clone, Debug, PartialEq)]
pub struct CoatedDiffuse {
    pub(super) base: Reflectance,
    coat: Coat,
    /// Water that stands in low parts and smooths them; `None` for coats of their own roughness only.
    puddles: Option<Puddles>,
}

impl CoatedDiffuse {
    /// A base of reflectance `base` under a coat of index `n` and roughness `alpha` (GGX α, 0 to 1).
    ///
    /// # Errors
    /// If the roughness is outside 0–1 or the index outside [`COAT_INDICES`].
    pub fn new(base: Reflectance, n: f64, alpha: impl Into<Factor>) -> Result<Self, MaterialError> {
        if !COAT_INDICES.contains(&n) {
            return Err(MaterialError::CoatIndex { n });
        }
        Ok(Self { base, coat: Coat::new(n as f32, alpha.into().checked_alpha()?), puddles: None })
    }

    /// Ground of the (dry) reflectance `base` under a film of water that stands in its low parts.
    #[must_use]
    pub fn under_water(base: Reflectance, puddles: Puddles) -> Self {
        Self { base, coat: Coat::new(WATER as f32, puddles.height), puddles: Some(puddles) }
    }
}

impl SurfaceModel for CoatedDiffuse {
    type Bsdf<'a, const N: usize> = CoatedBsdf<'a, N>;

    fn parameters(&self) -> Vec<Parameter<'_>> {
        let factor = match self.puddles {
            None => Parameter::alpha(self.coat.alpha),
            Some(puddles) => Parameter::Factor(puddles.height, "a height"),
        };
        vec![Parameter::Reflectance(&self.base), factor]
    }

    fn passage(&self) -> Passage<'_> {
        Passage::None
    }

    fn resolve<const N: usize>(&self, point: &ShadingPoint<'_, N>) -> CoatedBsdf<'_, N> {
        let own_alpha = point.factor(self.coat.alpha);
        let alpha = self.puddles.as_ref().map_or(own_alpha, |puddles| puddles.alpha(own_alpha));
        let place = self.coat.place(alpha);
        let mean = self.coat.mean_transmittance(place);
        let n2 = self.coat.n * self.coat.n;
        let inner = 1.0 - mean / n2;
        let base = point.reflectance(&self.base).map(|a| a / (n2 * (1.0 - a * inner)));
        let minimum = point.widened(alpha);
        CoatedBsdf {
            coat: &self.coat,
            facets: Ggx::from_alpha(minimum),
            is_widened: minimum > alpha,
            place,
            mean_transmittance: mean,
            base_mean: base.mean(),
            base,
        }
    }

    fn check_energy(&self, _: &TextureCheck<'_>) -> Result<(), MaterialError> {
        Ok(())
    }

    fn straight_transmittance<const N: usize>(&self, _: &ShadingPoint<'_, N>, _: f32) -> Spectral<N> {
        Spectral::ZERO
    }
}

/// The clear coat and its tabulated transmittance.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coat {
    pub(super) n: f32,
    /// The roughness; for ground under water the height from which it follows.
    alpha: Factor,
    /// One row for a roughness that is a number. For a texture that of a smooth coat, then [`ROWS`] + 1 at equal ratios of α from
    /// [`MIRROR_ALPHA`] to 1.
    rows: Box<[CoatRow]>,
}

/// The transmittance of a coat of one roughness.
#[derive(Clone, Debug, PartialEq)]
struct CoatRow {
    /// T, with more steps than albedos have: it changes sharply towards grazing.
    transmittance: CosineTable<192>,
    /// T̄ = 2 ∫ T μ dμ.
    mean: f32,
}

/// Position of a roughness among the rows: between `row` and the next, at `beyond` in [0, 1]; 0 needs no next row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RowPosition {
    row: u32,
    beyond: f32,
}

/// Steps of the table over roughness: each is 1.15 times as rough as the previous one.
const ROWS: usize = 64;

/// The roughness of a row of a table over roughness.
fn alpha_of(row: usize) -> f32 {
    if row == 0 { 0.0 } else { exp(ln(MIRROR_ALPHA) * (1.0 - (row - 1) as f32 / ROWS as f32)).max(MIRROR_ALPHA) }
}

impl Coat {
    pub(super) fn new(n: f32, alpha: Factor) -> Self {
        let rows = match alpha {
            Factor::Number(alpha) => Box::new([CoatRow::new(n, alpha)]) as Box<[CoatRow]>,
            Factor::Texture(..) => (0..=ROWS + 1).map(|i| CoatRow::new(n, alpha_of(i))).collect(),
        };
        Self { n, alpha, rows }
    }

    pub(super) fn place(&self, alpha: f32) -> RowPosition {
        if self.rows.len() == 1 || alpha < MIRROR_ALPHA {
            return RowPosition { row: 0, beyond: 0.0 };
        }
        let x = (1.0 - ln(alpha) / ln(MIRROR_ALPHA)).clamp(0.0, 1.0) * ROWS as f32;
        let row = (x as usize).min(ROWS - 1);
        RowPosition { row: row as u32 + 1, beyond: x - row as f32 }
    }

    fn between(&self, place: RowPosition, of: impl Fn(&CoatRow) -> f32) -> f32 {
        let row = place.row as usize;
        let low = of(&self.rows[row]);
        if place.beyond > 0.0 { low + (of(&self.rows[row + 1]) - low) * place.beyond } else { low }
    }

    pub(super) fn mean_transmittance(&self, place: RowPosition) -> f32 {
        self.between(place, |row| row.mean)
    }

    pub(super) fn transmittance(&self, place: RowPosition, cos: f32) -> f32 {
        self.between(place, |row| row.transmittance.at(cos))
    }
}

impl CoatRow {
    fn new(n: f32, alpha: f32) -> Self {
        let facets = Ggx::from_alpha(alpha);
        let transmittance = CosineTable::new(|cos| 1.0 - reflectance_of_coat(n, facets, cos));
        Self { mean: transmittance.mean(), transmittance }
    }
}

/// Directional-hemispherical reflectance of the coat at `cos_o`.
fn reflectance_of_coat(n: f32, facets: Option<Ggx>, cos_o: f32) -> f64 {
    let fresnel = |cos: f64| f64::from(fresnel::dielectric(cos as f32, n));
    match facets {
        None => fresnel(f64::from(cos_o)),
        Some(facets) => {
            VisibleFacets::new(Distribution::Ggx, facets.alpha, cos_o).reflected(|cos_facet, _| fresnel(cos_facet))
        }
    }
}

/// A coated surface at one point and a path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct CoatedBsdf<'a, const N: usize> {
    coat: &'a Coat,
    /// `None` for a smooth coat.
    facets: Option<Ggx>,
    /// True if they are rougher than the coat.
    is_widened: bool,
    place: RowPosition,
    /// T̄ here.
    mean_transmittance: f32,
    /// a / (n² (1 − a·Fᵢₙₜ)).
    base: Spectral<N>,
    base_mean: f32,
}

impl<const N: usize> CoatedBsdf<'_, N> {
    /// Probability of sampling the coat: its fraction of the energy reflected towards `wo`.
    fn coat_fraction(&self, through: f32) -> f32 {
        let coat = 1.0 - through;
        let base = self.base_mean * through * self.mean_transmittance;
        if coat + base > 0.0 { coat / (coat + base) } else { 1.0 }
    }

    fn base_value_cos(&self, through: f32, wi: Vec3) -> Spectral<N> {
        self.base * (FRAC_1_PI * wi.z * through * self.coat.transmittance(self.place, wi.z))
    }
}

impl<const N: usize> BsdfModel<N> for CoatedBsdf<'_, N> {
    #[inline]
    fn flags(&self) -> BsdfFlags {
        BsdfFlags::LOBES
    }

    fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        let through = self.coat.transmittance(self.place, wo.z);
        let fraction = self.coat_fraction(through);
        let base = self.base_value_cos(through, wi);
        let base_pdf = (1.0 - fraction) * cosine_hemisphere_pdf(wi.z);
        let Some(facets) = self.facets else { return BsdfValue { value_cos: base, pdf: base_pdf } };
        let m = half_vector(wo, wi);
        // Wider facets spread the light that the coat reflects; their tilt does not reduce it.
        let share_reflected = if self.is_widened { 1.0 - through } else { fresnel::dielectric(wo.dot(m), self.coat.n) };
        let coat = share_reflected * facets.reflect(wo, wi, m);
        BsdfValue { value_cos: base + Spectral::splat(coat), pdf: base_pdf + fraction * facets.reflect_pdf(wo, m) }
    }

    fn gloss(&self, wo: Vec3) -> Gloss {
        let Some(facets) = self.facets else { return Gloss::MATT };
        let diffuse = self.base_mean * self.coat.transmittance(self.place, wo.z) * self.mean_transmittance * FRAC_1_PI;
        Gloss::from_diffuse(diffuse).with(facets.gloss(wo, fresnel::dielectric(1.0, self.coat.n)))
    }

    fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        let fraction = self.coat_fraction(self.coat.transmittance(self.place, wo.z));
        let wi = match self.facets {
            _ if choice >= fraction => cosine_hemisphere(u),
            Some(facets) => mirrored(wo, facets.sample(wo, u)),
            None => {
                let reflectance = fresnel::dielectric(wo.z, self.coat.n) / fraction;
                return Some(BsdfSample::mirror(wo, Spectral::splat(reflectance)));
            }
        };
        if wi.z <= 0.0 {
            return None;
        }
        let BsdfValue { value_cos, pdf } = self.evaluate(wo, wi);
        (pdf > 0.0).then(|| BsdfSample { wi, weight: value_cos / pdf, pdf, event: Event::Scatter })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::textures::{Channel, TextureId};

    const ALONE: RowPosition = RowPosition { row: 0, beyond: 0.0 };

    #[test]
    fn a_smooth_coat_has_the_textbook_diffuse_reflectances() {
        // n = 1.5: external 0.0918, internal 0.5963 (Judd 1942; Duntley's closed form).
        let mean = Coat::new(1.5, Factor::Number(0.0)).mean_transmittance(ALONE);
        assert!((1.0 - mean - 0.0918).abs() < 2e-4, "{mean}");
        assert!((1.0 - mean / 2.25 - 0.5963).abs() < 2e-4, "{mean}");
    }

    #[test]
    fn the_table_follows_fresnel_between_its_nodes() {
        let coat = Coat::new(1.5, Factor::Number(0.0));
        for i in 0..=1000 {
            let c = i as f32 / 1000.0;
            // Linear interpolation: h²/8 · max |d²T/dt²| with h = 1/192 and curvature below 40.
            assert!((coat.transmittance(ALONE, c) - (1.0 - fresnel::dielectric(c, 1.5))).abs() < 2e-4, "{c}");
        }
    }

    #[test]
    fn a_table_over_roughness_follows_those_of_single_roughnesses() {
        let map = Coat::new(1.5, Factor::Texture(TextureId(0), Channel::Red));
        for alpha in [0.0, 9e-5, 1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.06, 0.13, 0.33, 0.74, 0.92, 1.0] {
            let (one, place) = (Coat::new(1.5, Factor::Number(alpha)), map.place(alpha));
            for i in 0..=200 {
                let t = i as f32 / 200.0;
                let c = t * t * t;
                let (table, exact) = (map.transmittance(place, c), one.transmittance(ALONE, c));
                // Measured: 2.9e-4.
                assert!((table - exact).abs() < 5e-4, "α {alpha} at {c}: {table} {exact}");
            }
            assert!((map.mean_transmittance(place) - one.mean_transmittance(ALONE)).abs() < 1e-4, "{alpha}");
        }
    }
}
