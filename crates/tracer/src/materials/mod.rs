//! Materials: how a surface scatters light, and what it emits.
//!
//! # Contract
//! - A [`Material`] is a [`Surface`] and, where it has them, an [`Emission`], an opacity and a normal map.
//! - At a point of a surface, [`MaterialTable::resolve`] follows mixes by chance, [`MaterialTable::shading_normal`] bends the normal,
//!   and [`MaterialTable::bsdf`] evaluates textures and spectra once and gives a [`Bsdf`] for the path's wavelengths. Which side
//!   is seen (`front`) matters to solids like glass alone.
//! - Directions `wo` (towards the viewer) and `wi` (towards the light) are unit vectors that point away from the
//!   surface, in the shading frame: z is the shading normal on the side of `wo`, which has z > 0. Light with wi.z > 0 is
//!   reflected, with wi.z < 0 transmitted.
//! - `value_cos` is bsdf × |cos θᵢ| (1/sr), so that nothing divides by a cosine that vanishes. `weight` of a sample is
//!   bsdf × |cos θᵢ| / pdf. `pdf` is by solid angle, 1/sr, of the whole sampling routine.
//! - Radiance is what is transported: where light comes from a medium of relative index η (the far side's over the
//!   viewer's), values and weights hold its factor 1/η² (Veach 1997, section 5.2).
//! - A mirrored or refracted direction has no finite density, nor has one that goes straight through: samples say so by
//!   their [`Event`], and evaluation leaves such parts out.
//! - Every bsdf is reciprocal, f(wo, wi)/n²(wi's side) = f(wi, wo)/n²(wo's side) where it transmits, and sends on no
//!   more power than arrives; no input in range gives a NaN.

mod beckmann;
mod blinn_phong;
mod car_paint;
mod check;
mod cloth;
mod coated;
mod conductor;
mod dielectric;
mod diffuse;
mod discrete_sampler;
mod emission;
mod energy;
mod error;
mod facets;
mod factor;
mod flags;
pub mod fresnel;
mod gauss;
mod interreflection;
mod lafortune;
mod leaf;
mod material_table;
mod microfacet;
mod mix;
mod normal_map;
mod reflectance;
mod retro;
mod shading;
mod slopes;
#[cfg(test)]
mod tests;
mod thin_sheet;

pub use blinn_phong::{BlinnPhong, BlinnPhongBsdf, BlinnPhongError, blinn_phong_normalisation};
pub use car_paint::{CarPaint, CarPaintBsdf, CarPaintError, CarPaintParts, flake_reflectance};
pub use cloth::{Cloth, ClothBsdf, ClothError};
pub use coated::{COAT_INDICES, Coated, CoatedBsdf};
pub use conductor::{Conductor, ConductorBsdf};
pub use dielectric::{DIELECTRIC_INDICES, Dielectric, DielectricBsdf, absorption_of};
pub use diffuse::DiffuseBsdf;
pub use emission::{Emission, Glow};
pub use energy::EnergyGain;
pub use error::MaterialError;
pub use facets::Distribution;
pub use factor::Factor;
pub use lafortune::{Lafortune, LafortuneBsdf, LafortuneError, Lobe, MAX_LOBES};
pub use leaf::{Leaf, LeafBsdf};
pub use material_table::MaterialTable;
pub use microfacet::MIRROR_ALPHA;
pub use mix::Mix;
pub use normal_map::{Green, NormalMap};
pub use reflectance::Reflectance;
pub use retro::{
    DayTime, MarkingBsdf, MarkingError, RetroTable, RetroTableError, RoadMarking, SHEETING_CLASSES, SHEETING_COLOURS,
    Sheeting, SheetingBsdf, SheetingError, SheetingPreset, marking_class,
};
pub use shading::ShadingFrame;
pub use thin_sheet::{ThinSheet, ThinSheetBsdf};

use etendue_core::Spectral;
use glam::{Vec2, Vec3};

/// A material: what happens to light at a surface, and what light starts there.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// How it scatters.
    pub surface: Surface,
    /// What it emits; `None` where it does not glow.
    pub emission: Option<Emission>,
    /// Share of the surface that is there, 0 to 1: through the rest light goes straight. `None` where all of it is.
    pub opacity: Option<Factor>,
    /// Finer normals than the mesh's.
    pub normal_map: Option<NormalMap>,
}

impl Material {
    /// A material that only scatters.
    #[must_use]
    pub fn new(surface: Surface) -> Self {
        Self { surface, emission: None, opacity: None, normal_map: None }
    }
}

/// How a surface scatters light.
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// All light that arrives is absorbed: a pure emitter, or black.
    Absorber,
    /// Lambert's law with a reflectance.
    Diffuse(Reflectance),
    /// A smooth or rough metal.
    Conductor(Box<Conductor>),
    /// A matt base under a clear coat.
    Coated(Box<Coated>),
    /// A matt base with generalised cosine lobes.
    Lafortune(Box<Lafortune>),
    /// A matt base with a glossy lobe about the half vector.
    BlinnPhong(Box<BlinnPhong>),
    /// Metal flakes and pigment under a clear coat.
    CarPaint(Box<CarPaint>),
    /// A matt base with the sheen of fibres.
    Cloth(Box<Cloth>),
    /// Retro-reflective sheeting.
    Sheeting(Box<Sheeting>),
    /// A road marking with glass beads.
    Marking(Box<RoadMarking>),
    /// The outside of a transparent solid.
    Dielectric(Box<Dielectric>),
    /// A thin pane.
    ThinSheet(Box<ThinSheet>),
    /// A thin sheet that scatters to both sides.
    Leaf(Box<Leaf>),
    /// Two materials side by side.
    Mix(Mix),
}

/// Scattering at one point, at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub enum Bsdf<'a, const N: usize> {
    /// Nothing is scattered.
    Absorber,
    /// Lambert's law.
    Diffuse(DiffuseBsdf<N>),
    /// A metal.
    Conductor(ConductorBsdf<N>),
    /// A coated base.
    Coated(CoatedBsdf<'a, N>),
    /// Generalised cosine lobes.
    Lafortune(LafortuneBsdf<'a, N>),
    /// A lobe about the half vector.
    BlinnPhong(BlinnPhongBsdf<'a, N>),
    /// Metal flakes under a clear coat.
    CarPaint(CarPaintBsdf<'a, N>),
    /// The sheen of fibres.
    Cloth(ClothBsdf<'a, N>),
    /// Retro-reflective sheeting.
    Sheeting(SheetingBsdf<'a, N>),
    /// Glass beads.
    Marking(MarkingBsdf<'a, N>),
    /// An interface.
    Dielectric(DielectricBsdf),
    /// A pane.
    ThinSheet(ThinSheetBsdf<N>),
    /// A sheet that scatters to both sides.
    Leaf(LeafBsdf<N>),
}

/// What a bsdf says of a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfValue<const N: usize> {
    /// bsdf × |cos θᵢ|, 1/sr.
    pub value_cos: Spectral<N>,
    /// Density with which sampling would give this `wi`, 1/sr.
    pub pdf: f32,
}

impl<const N: usize> BsdfValue<N> {
    /// Nothing goes this way.
    pub const ZERO: Self = Self { value_cos: Spectral::ZERO, pdf: 0.0 };
}

/// What happened to a path at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// It was scattered, by a finite density.
    Scatter,
    /// It was reflected or refracted in the one exact direction.
    Specular,
    /// It went straight on, as if nothing had been there: no scattering event. The path keeps the direction it had.
    Null,
}

/// A direction drawn from a bsdf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample<const N: usize> {
    /// Where light comes from; unit, never in the surface's plane.
    pub wi: Vec3,
    /// bsdf × |cos θᵢ| / pdf; of an exact direction its reflectance or transmittance over the probability of choosing it.
    pub weight: Spectral<N>,
    /// Density of `wi`, 1/sr; 0 and without meaning for an exact direction.
    pub pdf: f32,
    /// What happened.
    pub event: Event,
}

impl<const N: usize> BsdfSample<N> {
    fn mirror(wo: Vec3, weight: Spectral<N>) -> Self {
        Self { wi: Vec3::new(-wo.x, -wo.y, wo.z), weight, pdf: 0.0, event: Event::Specular }
    }
}

impl<const N: usize> Bsdf<'_, N> {
    /// Whether light goes on in exact directions only, so that asking for a light drawn elsewhere is in vain.
    #[must_use]
    pub fn is_delta(&self) -> bool {
        match self {
            Self::Conductor(conductor) => conductor.is_delta(),
            Self::Dielectric(dielectric) => dielectric.is_smooth(),
            Self::ThinSheet(_) => true,
            Self::Absorber | Self::Diffuse(_) | Self::Coated(_) | Self::Leaf(_) => false,
            Self::Lafortune(_) | Self::BlinnPhong(_) | Self::Sheeting(_) | Self::Marking(_) => false,
            Self::CarPaint(_) | Self::Cloth(_) => false,
        }
    }

    /// Whether light may come from behind (wi.z < 0) by a finite density.
    #[must_use]
    pub fn transmits(&self) -> bool {
        match self {
            Self::Absorber | Self::Diffuse(_) | Self::Conductor(_) | Self::Coated(_) | Self::ThinSheet(_) => false,
            Self::Lafortune(_) | Self::BlinnPhong(_) | Self::Sheeting(_) | Self::Marking(_) => false,
            Self::CarPaint(_) | Self::Cloth(_) => false,
            Self::Dielectric(dielectric) => !dielectric.is_smooth(),
            Self::Leaf(_) => true,
        }
    }

    /// Whether [`Bsdf::sample`] looks at the number that picks a lobe.
    #[must_use]
    pub fn has_parts(&self) -> bool {
        !matches!(self, Self::Absorber | Self::Diffuse(_))
    }

    /// Value and density of a pair of directions; zero where `wo` is behind the surface, or light from there is not let
    /// through.
    #[must_use]
    pub fn evaluate(&self, wo: Vec3, wi: Vec3) -> BsdfValue<N> {
        if wo.z <= 0.0 || wi.z == 0.0 || (wi.z < 0.0 && !self.transmits()) {
            return BsdfValue::ZERO;
        }
        match self {
            Self::Absorber => BsdfValue::ZERO,
            Self::Diffuse(diffuse) => diffuse.evaluate(wi),
            Self::Conductor(conductor) => conductor.evaluate(wo, wi),
            Self::Coated(coated) => coated.evaluate(wo, wi),
            Self::Lafortune(lafortune) => lafortune.evaluate(wo, wi),
            Self::BlinnPhong(blinn_phong) => blinn_phong.evaluate(wo, wi),
            Self::CarPaint(paint) => paint.evaluate(wo, wi),
            Self::Cloth(cloth) => cloth.evaluate(wo, wi),
            Self::Sheeting(sheeting) => sheeting.evaluate(wo, wi),
            Self::Marking(marking) => marking.evaluate(wo, wi),
            Self::Dielectric(dielectric) => dielectric.evaluate(wo, wi),
            Self::ThinSheet(_) => BsdfValue::ZERO,
            Self::Leaf(leaf) => leaf.evaluate(wi),
        }
    }

    /// A direction for light to come from; `None` where the light is absorbed. `choice` picks a lobe, `u` a direction.
    #[must_use]
    pub fn sample(&self, wo: Vec3, choice: f32, u: Vec2) -> Option<BsdfSample<N>> {
        if wo.z <= 0.0 {
            return None;
        }
        match self {
            Self::Absorber => None,
            Self::Diffuse(diffuse) => diffuse.sample(u),
            Self::Conductor(conductor) => conductor.sample(wo, choice, u),
            Self::Coated(coated) => coated.sample(wo, choice, u),
            Self::Lafortune(lafortune) => lafortune.sample(wo, choice, u),
            Self::BlinnPhong(blinn_phong) => blinn_phong.sample(wo, choice, u),
            Self::CarPaint(paint) => paint.sample(wo, choice, u),
            Self::Cloth(cloth) => cloth.sample(wo, choice, u),
            Self::Sheeting(sheeting) => sheeting.sample(wo, choice, u),
            Self::Marking(marking) => marking.sample(wo, choice, u),
            Self::Dielectric(dielectric) => dielectric.sample(wo, choice, u),
            Self::ThinSheet(sheet) => sheet.sample(wo, choice),
            Self::Leaf(leaf) => leaf.sample(choice, u),
        }
    }
}
