//! How surfaces reflect: the list of types, and the records of opaque surfaces (glass, signs and mixes have files of their own).

use std::path::PathBuf;

use super::factor::{Factor, any_factor};
use super::glass::{Dielectric, Leaf, ThinSheet};
use super::mix::Mix;
use super::road::{RoadMarking, Sheeting};
use super::wet::WetGround;
use crate::asset::COAT_INDICES;
use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::{AssetKind, Values};
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{choice, flag, keyed, known, list, number, path, record, variants, vector, words};
use crate::record::curve::{Curve, curve};
use crate::record::reflectance::{Colour, Reflectance, any_colour, any_reflectance};
use etendue_spectra::metal;

/// The list of surfaces: each row is the word of a type and its record, which says by [`NamesFiles`] which files it names.
macro_rules! surfaces {
    ($( $(#[doc = $doc:literal])* $word:literal => $record:ident, )*) => {
        variants! {
            /// How a surface reflects.
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
    /// Lambert's law.
    "diffuse" => Diffuse,
    /// A bare metal, smooth or rough.
    "conductor" => Conductor,
    /// A diffuse base under a clear dielectric coat.
    "coated" => Coated,
    /// Ground under a film of water, which stands in its low parts: darker, and a mirror at grazing view.
    "wet_ground" => WetGround,
    /// Cook and Torrance's model: bare microfacets of any refractive index, and nothing below them.
    "cook_torrance" => CookTorrance,
    /// Lafortune's model: a diffuse base with generalised cosine lobes.
    "lafortune" => Lafortune,
    /// Blinn and Phong's model: a diffuse base with a glossy lobe.
    "blinn_phong" => BlinnPhong,
    /// Metallic car paint: flakes in pigment under a clear coat.
    "car_paint" => CarPaint,
    /// Cloth with a sheen.
    "cloth" => Cloth,
    /// Retro-reflective sheeting over a matt base: signs, number plates.
    "retro_sheeting" => Sheeting,
    /// A road marking with glass beads.
    "road_marking" => RoadMarking,
    /// Clear or tinted glass or water as a solid with two sides: refracts, and absorbs inside. The mesh must be closed.
    "dielectric" => Dielectric,
    /// A pane without thickness of its own: reflects and lets light straight through, all inner reflections included.
    "thin_sheet" => ThinSheet,
    /// A leaf: reflects from the side that is lit and glows through on the other, both by Lambert's law.
    "leaf" => Leaf,
    /// Two other materials side by side, finer than anything seen.
    "mix" => Mix,
    /// Reflects nothing, gives light: needs "emission".
    "emitter" => Emitter,
}

record! {
    /// Lambert's law.
    pub struct Diffuse {
        /// Share of light reflected: a number, `[r, g, b]` (linear sRGB), `{ srgb = [r, g, b] }`,
        /// `{ spectrum = file }` or `{ texture = name, scale = … }`; 0 … 1.
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
    /// A metal with a rough surface of microfacets.
    pub struct Conductor {
        /// Which metal.
        inside metal: Metal;
        /// Roughness α of the facets' distribution (not its square root), 0 … 1; below 0.0001 it is a mirror. A number, or
        /// `{ texture = name, channel = "r" }`.
        required alpha: Factor = any_factor();
        /// How the slopes of the facets are distributed. Default: "ggx".
        optional distribution: Placed<Distribution> = choice();
        /// Whether light that meets several facets before it leaves is added (Kulla and Conty 2017); without it rough metals
        /// are too dark, by up to six tenths. Default: false.
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
        /// A tabulated metal: "Al", "Ag", "Au", "Cu", "Cr", "Fe".
        metal => Named(Placed<String>) = known("a metal", metal::names());
        /// A table of three columns: wavelength in nm, n, k (above 0 where it absorbs); end values hold beyond the table.
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
    /// A rough interface of microfacets with the exact Fresnel reflectance; what enters is absorbed.
    pub struct CookTorrance {
        /// What it is made of.
        inside interface: Interface;
        /// Roughness α of the facets' distribution (not its square root), 0 … 1; below 0.0001 it is a mirror. A number, or
        /// `{ texture = name, channel = "r" }`.
        required alpha: Factor = any_factor();
        /// How the slopes of the facets are distributed. Default: "ggx".
        optional distribution: Placed<Distribution> = choice();
        /// Whether light that meets several facets before it leaves is added (Kulla and Conty 2017); without it rough
        /// surfaces are too dark. Default: false.
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
    /// What an interface is made of, by its refractive index.
    pub enum Interface {
        /// A tabulated metal: "Al", "Ag", "Au", "Cu", "Cr", "Fe".
        metal => Named(Placed<String>) = known("a metal", metal::names());
        /// A table of three columns: wavelength in nm, n, k; end values hold beyond the table.
        index_file => File(Placed<PathBuf>) = path(&["csv"]);
        /// A real refractive index against air, 1 … 4: a number, or `{ spectrum = file }`.
        index => Index(Curve) = curve(number("").at_least(1.0).at_most(4.0));
    }
}

impl NamesFiles for Interface {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Named(_) => {}
            Self::File(file) => files.add(AssetKind::ComplexIndex, file),
            Self::Index(curve) => curve.name_file(Values::Index, files),
        }
    }
}

words! {
    /// How the slopes of microfacets are distributed.
    pub enum Distribution {
        /// Trowbridge and Reitz 1975; Walter et al. 2007: long tails, as most real surfaces have.
        "ggx" => Ggx,
        /// Beckmann and Spizzichino 1963: Gaussian slopes.
        "beckmann" => Beckmann,
    }
}

record! {
    /// A diffuse base under a dielectric coat with a GGX distribution of microfacets.
    pub struct Coated {
        /// Share of light that the base reflects, as for "diffuse".
        required reflectance: Reflectance = any_reflectance();
        /// Refractive index of the coat, 1.1 … 4. Default: 1.5.
        optional index: Placed<f64> = number("").at_least(*COAT_INDICES.start()).at_most(*COAT_INDICES.end());
        /// Roughness α of the coat's GGX distribution (not its square root), 0 … 1; below 0.0001 it is a mirror. A number, or
        /// `{ texture = name, channel = "r" }`.
        required alpha: Factor = any_factor();
    }
}

impl NamesFiles for Coated {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, index: _, alpha: _ } = self;
        reflectance.name_files(files);
    }
}

record! {
    /// A diffuse base and up to four cosine lobes, f = k_d/π + Σ w [C_t (wᵢₓ wₒₓ + wᵢ_y wₒ_y) + C_n wᵢ_z wₒ_z]ⁿ.
    pub struct Lafortune {
        /// Share of light that the base reflects, as for "diffuse".
        required reflectance: Reflectance = any_reflectance();
        /// The lobes, one to four.
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
    /// A lobe of a generalised cosine.
    pub struct Lobe check(check_lobe) {
        /// Where it points.
        inside direction: LobeDirection;
        /// Exponent n, 0 … 10 000: the greater, the narrower.
        required exponent: Placed<f64> = number("").at_least(0.0).at_most(1e4);
        /// How strong it is.
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
    /// Where a lobe points.
    pub enum LobeDirection {
        /// "mirror" (C_t = −1, C_n = 1) or "retro" (C_t = C_n = 1).
        kind => Kind(Placed<LobeKind>) = choice();
        /// C_t and C_n: factors along the surface and along the normal. C_t < 0 on the mirror's side (off-specular where
        /// C_n < −C_t), > 0 back towards the light; C_n at least 0, not both 0.
        factors => Factors(Placed<[f64; 2]>) = vector::<2>(number(""));
    }
}

keyed! {
    /// How strong a lobe is.
    pub enum LobeStrength {
        /// Share of light that the lobe sends back at normal incidence: a number, `[r, g, b]` (linear sRGB),
        /// `{ srgb = … }` or `{ spectrum = file }`; needs C_n above 0.
        albedo => Albedo(Colour) = any_colour();
        /// Its weight w, 1/sr, 0 or more: a number, or `{ spectrum = file }`.
        weight_per_sr => Weight(Curve) = curve(number("1/sr").at_least(0.0));
    }
}

impl NamesFiles for LobeStrength {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Albedo(colour) => colour.name_files(files),
            Self::Weight(curve) => curve.name_file(Values::Light, files),
        }
    }
}

words! {
    /// Where a lobe points.
    pub enum LobeKind {
        /// To the mirror direction.
        "mirror" => Mirror,
        /// Back to where light comes from.
        "retro" => Retro,
    }
}

record! {
    /// A diffuse base and a glossy lobe about the half vector, with its exact normalisation.
    pub struct BlinnPhong {
        /// Share of light that the base reflects, as for "diffuse".
        required reflectance: Reflectance = any_reflectance();
        /// Share of light that the lobe sends back at normal incidence: a number, `[r, g, b]` (linear sRGB),
        /// `{ srgb = … }` or `{ spectrum = file }`.
        required specular: Colour = any_colour();
        /// Exponent n, 0 … 100 000: the greater, the narrower. It is no roughness.
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

fn check_lobe(lobe: &Lobe, faults: &mut Faults) {
    if let (LobeDirection::Factors(factors), LobeStrength::Albedo(albedo)) = (&lobe.direction, &lobe.strength)
        && factors[1] <= 0.0
    {
        let problem =
            "a lobe with C_n = 0 sends nothing back at normal incidence, so \"albedo\" cannot tell its strength";
        faults.add(ErrorCode::Degenerate, albedo.place(), problem, "give \"weight_per_sr\" in place of it");
    }
}

record! {
    /// Metal flakes in pigment under a clear coat. Solid paint without flakes is "coated".
    pub struct CarPaint {
        /// Share of light that the pigment between the flakes reflects, as for "diffuse".
        required reflectance: Reflectance = any_reflectance();
        /// The metal of the flakes.
        inside metal: Metal;
        /// A tint on the light that the flakes reflect, as of stained lacquer: a number, `[r, g, b]` (linear sRGB),
        /// `{ srgb = … }` or `{ spectrum = file }`. Default: 1.
        optional flake_tint: Colour = any_colour();
        /// Share of the area that flakes cover, 0 … 1.
        required flake_coverage: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// How unevenly the flakes lie: GGX α (not its square root), 0.05 … 1. Default: 0.25.
        optional flake_alpha: Placed<f64> = number("").at_least(0.05).at_most(1.0);
        /// Refractive index of the coat, 1.1 … 4. Default: 1.5.
        optional index: Placed<f64> = number("").at_least(*COAT_INDICES.start()).at_most(*COAT_INDICES.end());
        /// Roughness α of the coat's GGX distribution (not its square root), 0 … 1; below 0.0001 it is a mirror. Default: 0.01.
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
    /// Cloth: a matt base under a sheen of fibres that stand up.
    pub struct Cloth {
        /// Share of light that the base reflects, as for "diffuse".
        required reflectance: Reflectance = any_reflectance();
        /// Colour of the sheen, 0 … 1: a number, `[r, g, b]` (linear sRGB), `{ srgb = … }` or `{ spectrum = file }`.
        /// Default: 0.1.
        optional sheen: Colour = any_colour();
        /// Roughness α of the sheen, 0.1 … 1: the less, the narrower the rim of light. Default: 0.5.
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
