//! Materials: scattering and emission of surfaces.
//!
//! # Contract
//! - A [`Material`] is a [`Surface`] and, optionally, an [`Emission`], an opacity and a normal map.
//! - At a point of a surface, [`MaterialTable::resolve`] resolves mixes at random, [`MaterialTable::shading_normal`] bends the normal,
//!   and [`MaterialTable::bsdf`] evaluates textures and spectra once and returns a [`Bsdf`] for the path's wavelengths. The visible
//!   side (`front`) matters only to solids such as glass.
//! - Directions `wo` (towards the viewer) and `wi` (towards the light) are unit vectors that point away from the
//!   surface, in the shading frame: z is the shading normal on the side of `wo`, which has z > 0. Light with wi.z > 0 is
//!   reflected, with wi.z < 0 transmitted.
//! - `value_cos` is bsdf × |cos θᵢ| (1/sr), so that there is no division by a vanishing cosine. `weight` of a sample is
//!   bsdf × |cos θᵢ| / pdf. `pdf` is by solid angle, 1/sr, of the whole sampling routine.
//! - Radiance is transported: if light comes from a medium of relative index η (the far side's over the
//!   viewer's), values and weights include its factor 1/η² (Veach 1997, section 5.2).
//! - A reflected or refracted direction has no finite density, nor has one that goes straight through: samples state this by
//!   their [`Event`], and evaluation leaves such parts out.
//! - A model itself states its textures, its transmission and its direction-independent properties (`model`); the list below forwards every
//!   call to it by a `match`.
//! - Every bsdf is reciprocal, f(wo, wi)/n²(wi's side) = f(wi, wo)/n²(wo's side) if it transmits, and never gains
//!   power; no input in range gives a NaN.

mod beckmann;
mod blinn_phong;
mod car_paint;
mod check;
mod cloth;
mod coated;
mod conductor;
mod dielectric;
mod diffuse;
mod emission;
mod energy;
mod error;
pub mod fresnel;
mod gloss;
#[cfg(test)]
mod glossy_surfaces;
mod interreflection;
mod lafortune;
mod leaf;
mod list;
mod material;
mod material_table;
mod microfacet;
mod model;
mod parameter;
mod puddles;
mod retro;
mod shading;
mod slopes;
#[cfg(test)]
mod tests;
mod thin_sheet;

pub use blinn_phong::{BlinnPhong, BlinnPhongBsdf, BlinnPhongError, blinn_phong_normalisation};
pub use car_paint::{CarPaint, CarPaintBsdf, CarPaintError, CarPaintParts, flake_reflectance};
pub use cloth::{Cloth, ClothBsdf, ClothError};
pub use coated::{COAT_INDICES, CoatedBsdf, CoatedDiffuse, WATER};
pub use conductor::{Conductor, ConductorBsdf};
pub use dielectric::{DIELECTRIC_INDICES, Dielectric, DielectricBsdf, absorption_of};
pub use diffuse::DiffuseBsdf;
pub use emission::{Emission, EmissionQuery, EmissionSides};
pub use error::{EnergyGain, MaterialError};

use etendue_core::Spectral;
use glam::{Vec2, Vec3};
pub(crate) use gloss::{Gloss, GlossLobe, LobeCentre, MAX_GLOSS_LOBES, schlick};
#[cfg(test)]
pub(crate) use glossy_surfaces::glossy_surfaces;

use list::surfaces;
use model::{BsdfFlags, BsdfModel, Passage, SurfaceModel};
use parameter::{Parameter, ShadingPoint, TextureCheck};

pub use emission::{Modulation, selection_level};
pub use lafortune::{Lafortune, LafortuneBsdf, LafortuneError, Lobe, MAX_LOBES};
pub use leaf::{Leaf, LeafBsdf};
pub use material::{Material, Mix};
pub use material_table::MaterialTable;
pub use microfacet::{Distribution, Ggx, MIRROR_ALPHA};
pub use model::{BsdfSample, BsdfValue, Event};
pub use parameter::{Factor, Reflectance};
pub use puddles::{GroundRelief, Puddles};
pub use retro::{
    DaytimeBrightness, MarkingBsdf, MarkingError, RetroTable, RetroTableError, RoadMarking, SHEETING_CLASSES,
    SHEETING_COLOURS, Sheeting, SheetingBsdf, SheetingError, SheetingPreset, marking_class,
};
pub use shading::{GreenDirection, NormalMap, ShadingFrame};
pub use thin_sheet::{ThinSheet, ThinSheetBsdf};

surfaces! {
    /// Lambert's law with a reflectance.
    Diffuse(Reflectance) from Reflectance => DiffuseBsdf<N>,
    /// A smooth or rough metal.
    Conductor(Box<Conductor>) from Conductor => ConductorBsdf<N>,
    /// A diffuse base under a clear coat.
    Coated(Box<CoatedDiffuse>) from CoatedDiffuse => CoatedBsdf<'a, N>,
    /// A diffuse base with generalised cosine lobes.
    Lafortune(Box<Lafortune>) from Lafortune => LafortuneBsdf<'a, N>,
    /// A diffuse base with a glossy lobe about the half vector.
    BlinnPhong(Box<BlinnPhong>) from BlinnPhong => BlinnPhongBsdf<'a, N>,
    /// Metal flakes and pigment under a clear coat.
    CarPaint(Box<CarPaint>) from CarPaint => CarPaintBsdf<'a, N>,
    /// A diffuse base with the sheen of fibres.
    Cloth(Box<Cloth>) from Cloth => ClothBsdf<'a, N>,
    /// Retro-reflective sheeting.
    Sheeting(Box<Sheeting>) from Sheeting => SheetingBsdf<'a, N>,
    /// A road marking with glass beads.
    Marking(Box<RoadMarking>) from RoadMarking => MarkingBsdf<'a, N>,
    /// The outside of a transparent solid.
    Dielectric(Box<Dielectric>) from Dielectric => DielectricBsdf,
    /// A thin pane.
    ThinSheet(Box<ThinSheet>) from ThinSheet => ThinSheetBsdf<N>,
    /// A thin sheet that scatters to both sides.
    Leaf(Box<Leaf>) from Leaf => LeafBsdf<N>,
}
