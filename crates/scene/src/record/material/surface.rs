//! Scattering models of surfaces: the list of types, and the records of opaque surfaces (glass, signs and mixes have files of their own).

use std::path::PathBuf;

use super::factor::{Factor, any_factor};
use super::glass::{Dielectric, Leaf, ThinSheet};
use super::mix::Mix;
use super::road::{RoadMarking, Sheeting};
use super::wet::WetGround;
use crate::asset::COAT_INDICES;
use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::{AssetKind, SpectrumValues};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{choice, flag, keyed, known, list, number, path, record, variants, vector, words};
use crate::record::curve::{Curve, curve};
use crate::record::reflectance::{Colour, Reflectance, any_colour, any_reflectance};
use etendue_spectra::metal;

/// The list of surfaces. Each row is the word of a type and its record, which states by [`NamesFiles`] the files that it names.
macro_rules! surfaces {
    ($( $(#[doc = $doc:literal])* $word:literal => $record:ident, )*) => {
        variants! {
            /// Scattering model of a surface.
            pub enum Surface by "type" {
                $( $(#[doc = $doc])* $word => $record($record), )*
            }
        }

        impl NamesFiles for Surface {
            fn name_files(&self, files: &mut FileList) {
                match self {
                    $( Self::$record(record) => record.name_files(files), )*
                }
            }
        }
    };
}

surfaces! {
    /// Lambertian reflection.
    "diffuse" => Diffuse,
    /// A bare metal, smooth or rough.
    "conductor" => Conductor,
    /// A diffuse base under a clear dielectric coat.
    "coated" => CoatedDiffuse,
    /// Ground under a film of water, with puddles in its low parts.
    "wet_ground" => WetGround,
    /// Cook and Torrance: microfacets of any refractive index, without a base.
    "cook_torrance" => CookTorrance,
    /// Lafortune: a diffuse base with generalised cosine lobes.
    "lafortune" => Lafortune,
    /// Blinn and Phong: a diffuse base with a glossy lobe.
    "blinn_phong" => BlinnPhong,
    /// Metallic car paint: flakes in pigment under a clear coat.
    "car_paint" => CarPaint,
    /// Cloth with a sheen.
    "cloth" => Cloth,
    /// Retro-reflective sheeting over a diffuse base: signs, number plates.
    "retro_sheeting" => Sheeting,
    /// A road marking with glass beads.
    "road_marking" => RoadMarking,
    /// Clear or tinted glass or water as a solid; the mesh must be closed.
    "dielectric" => Dielectric,
    /// A pane without thickness, with all internal reflections.
    "thin_sheet" => ThinSheet,
    /// A leaf: Lambertian reflection and transmission.
    "leaf" => Leaf,
    /// Two other materials side by side, finer than visible.
    "mix" => Mix,
    /// Emits and does not reflect; needs "emission".
    "emitter" => Emitter,
}

record! {
    /// Lambertian reflection.
    pub struct Diffuse {
        /// Reflectance; lists are linear sRGB.
        required reflectance: Reflectance = any_reflectance();
    }
}

impl NamesFiles for Diffuse {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance } = self;
        reflectance.name_files(files);
    }
}

record! {
    /// A metal with a rough microfacet surface.
    pub struct Conductor {
        /// Metal.
        inside metal: Metal;
        /// Microfacet roughness α (not its square root); a mirror below 0.0001.
        required alpha: Factor = any_factor();
        /// Distribution of microfacet slopes. Default: "ggx".
        optional distribution: Placed<Distribution> = choice();
        /// Adds scattering between facets (Kulla and Conty 2017); without it rough metals are up to 0.6 too dark. Default: false.
        optional multiple_scattering: Placed<bool> = flag();
    }
}

impl NamesFiles for Conductor {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, metal, alpha: _, distribution: _, multiple_scattering: _ } = self;
        metal.name_files(files);
    }
}

keyed! {
    /// A metal, by its complex refractive index.
    pub enum Metal {
        /// A tabulated metal.
        metal => Named(Placed<String>) = known("a metal", metal::names());
        /// Three columns: wavelength in nm, n, k.
        index_file => File(Placed<PathBuf>) = path(&["csv"]);
    }
}

impl NamesFiles for Metal {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Named(_) => {}
            Self::File(file) => files.add(AssetKind::ComplexIndex, file),
        }
    }
}

record! {
    /// A rough microfacet interface with exact Fresnel reflectance; transmitted light is absorbed.
    pub struct CookTorrance {
        /// Substance.
        inside interface: Interface;
        /// Microfacet roughness α (not its square root); a mirror below 0.0001.
        required alpha: Factor = any_factor();
        /// Distribution of microfacet slopes. Default: "ggx".
        optional distribution: Placed<Distribution> = choice();
        /// Adds scattering between facets (Kulla and Conty 2017). Default: false.
        optional multiple_scattering: Placed<bool> = flag();
    }
}

impl NamesFiles for CookTorrance {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, interface, alpha: _, distribution: _, multiple_scattering: _ } = self;
        interface.name_files(files);
    }
}

keyed! {
    /// Substance of an interface, by its refractive index.
    pub enum Interface {
        /// A tabulated metal.
        metal => Named(Placed<String>) = known("a metal", metal::names());
        /// Three columns: wavelength in nm, n, k.
        index_file => File(Placed<PathBuf>) = path(&["csv"]);
        /// Real refractive index relative to air.
        index => Index(Curve) = curve(number("").at_least(1.0).at_most(4.0));
    }
}

impl NamesFiles for Interface {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Named(_) => {}
            Self::File(file) => files.add(AssetKind::ComplexIndex, file),
            Self::Index(curve) => curve.name_file(SpectrumValues::Index, files),
        }
    }
}

words! {
    /// Distribution of microfacet slopes.
    pub enum Distribution {
        /// Trowbridge and Reitz 1975; Walter et al. 2007: long tails, as for most real surfaces.
        "ggx" => Ggx,
        /// Beckmann and Spizzichino 1963: Gaussian slopes.
        "beckmann" => Beckmann,
    }
}

record! {
    /// A diffuse base under a dielectric coat with a GGX microfacet distribution.
    pub struct CoatedDiffuse {
        /// Reflectance of the base.
        required reflectance: Reflectance = any_reflectance();
        /// Refractive index of the coat. Default: 1.5.
        optional index: Placed<f64> = number("").at_least(*COAT_INDICES.start()).at_most(*COAT_INDICES.end());
        /// GGX roughness α of the coat; a mirror below 0.0001.
        required alpha: Factor = any_factor();
    }
}

impl NamesFiles for CoatedDiffuse {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, index: _, alpha: _ } = self;
        reflectance.name_files(files);
    }
}

record! {
    /// A diffuse base and up to four cosine lobes, f = k_d/π + Σ w [C_t (wᵢₓ wₒₓ + wᵢ_y wₒ_y) + C_n wᵢ_z wₒ_z]ⁿ.
    pub struct Lafortune {
        /// Reflectance of the base.
        required reflectance: Reflectance = any_reflectance();
        /// One to four lobes.
        many lobes: Lobe = list(record(), 1);
    }
}

impl NamesFiles for Lafortune {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, lobes } = self;
        reflectance.name_files(files);
        lobes.iter().for_each(|lobe| lobe.name_files(files));
    }
}

record! {
    /// A generalised cosine lobe.
    pub struct Lobe check(check_lobe) {
        /// Direction.
        inside direction: LobeDirection;
        /// Exponent n; larger is narrower.
        required exponent: Placed<f64> = number("").at_least(0.0).at_most(1e4);
        /// Strength.
        inside strength: LobeStrength;
    }
}

impl NamesFiles for Lobe {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, direction: _, exponent: _, strength } = self;
        strength.name_files(files);
    }
}

keyed! {
    /// Direction of a lobe.
    pub enum LobeDirection {
        /// "mirror" (C_t = −1, C_n = 1) or "retro" (C_t = C_n = 1).
        kind => Kind(Placed<LobeKind>) = choice();
        /// C_t and C_n along surface and normal: C_t < 0 mirrors, C_t > 0 points back to the light; C_n at least 0, not both 0.
        factors => Factors(Placed<[f64; 2]>) = vector::<2>(number(""));
    }
}

keyed! {
    /// Strength of a lobe.
    pub enum LobeStrength {
        /// Albedo of the lobe at normal incidence; needs C_n above 0.
        albedo => Albedo(Colour) = any_colour();
        /// Weight w.
        weight_per_sr => Weight(Curve) = curve(number("1/sr").at_least(0.0));
    }
}

impl NamesFiles for LobeStrength {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Albedo(colour) => colour.name_files(files),
            Self::Weight(curve) => curve.name_file(SpectrumValues::Light, files),
        }
    }
}

words! {
    /// Direction of a lobe.
    pub enum LobeKind {
        /// The mirror direction.
        "mirror" => Mirror,
        /// Back towards the light.
        "retro" => Retro,
    }
}

record! {
    /// A diffuse base and a glossy lobe about the half vector, with its exact normalisation.
    pub struct BlinnPhong {
        /// Reflectance of the base.
        required reflectance: Reflectance = any_reflectance();
        /// Albedo of the lobe at normal incidence.
        required specular: Colour = any_colour();
        /// Exponent n; larger is narrower. It is not a roughness.
        required exponent: Placed<f64> = number("").at_least(0.0).at_most(1e5);
    }
}

impl NamesFiles for BlinnPhong {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, specular, exponent: _ } = self;
        reflectance.name_files(files);
        specular.name_files(files);
    }
}

fn check_lobe(lobe: &Lobe, errors: &mut DescriptionErrors) {
    if let (LobeDirection::Factors(factors), LobeStrength::Albedo(albedo)) = (&lobe.direction, &lobe.strength)
        && factors[1] <= 0.0
    {
        let problem =
            "a lobe with C_n = 0 reflects nothing at normal incidence, so \"albedo\" cannot determine its strength";
        errors.add(ErrorCode::Degenerate, albedo.place(), problem, "give \"weight_per_sr\" instead");
    }
}

record! {
    /// Metal flakes in pigment under a clear coat. Solid paint without flakes is "coated".
    pub struct CarPaint {
        /// Reflectance of the pigment.
        required reflectance: Reflectance = any_reflectance();
        /// The metal of the flakes.
        inside metal: Metal;
        /// Tint of light from the flakes. Default: 1.
        optional flake_tint: Colour = any_colour();
        /// Fraction of the area with flakes.
        required flake_coverage: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// GGX α of the flakes' orientation. Default: 0.25.
        optional flake_alpha: Placed<f64> = number("").at_least(0.05).at_most(1.0);
        /// Refractive index of the coat. Default: 1.5.
        optional index: Placed<f64> = number("").at_least(*COAT_INDICES.start()).at_most(*COAT_INDICES.end());
        /// GGX roughness α of the coat; a mirror below 0.0001. Default: 0.01.
        optional alpha: Placed<f64> = number("").at_least(0.0).at_most(1.0);
    }
}

impl NamesFiles for CarPaint {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, metal, flake_tint, flake_coverage: _, flake_alpha: _, index: _, alpha: _ } =
            self;
        reflectance.name_files(files);
        metal.name_files(files);
        flake_tint.name_files(files);
    }
}

record! {
    /// Cloth: a diffuse base under a sheen of upright fibres.
    pub struct Cloth {
        /// Reflectance of the base.
        required reflectance: Reflectance = any_reflectance();
        /// Colour of the sheen. Default: 0.1.
        optional sheen: Colour = any_colour();
        /// Roughness α of the sheen; smaller is narrower. Default: 0.5.
        optional alpha: Placed<f64> = number("").at_least(0.1).at_most(1.0);
    }
}

impl NamesFiles for Cloth {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, sheen, alpha: _ } = self;
        reflectance.name_files(files);
        sheen.name_files(files);
    }
}

record! {
    /// A surface that reflects nothing.
    pub struct Emitter {}
}

impl NamesFiles for Emitter {
    fn name_files(&self, _files: &mut FileList) {
        let Self { place: _ } = self;
    }
}
