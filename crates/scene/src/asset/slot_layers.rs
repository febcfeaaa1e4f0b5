//! Materials of mesh files in layers: glTF, and MTL with textures of numbers, metal or glass.

use std::path::{Path, PathBuf};

/// A material of glTF's metallic-roughness model with its extensions: a metal and a non-metal, side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct SlotLayers {
    /// Reflectance of the non-metal's base, and reflectance of the metal at normal incidence.
    pub base: SlotColour,
    /// Fraction of the surface that is metal, 0 … 1.
    pub metal: SlotNumber,
    /// Roughness of metal and coat: GGX α, 0 … 1.
    pub alpha: SlotNumber,
    /// Layer over the base of the non-metal.
    pub top_layer: SlotTopLayer,
    /// Transmission of the non-metal; `None` if there is none.
    pub transmission: Option<SlotTransmission>,
    /// Emission of the surface; `None` if there is none.
    pub emission: Option<SlotEmission>,
    /// Opacity: fraction of the surface that is present, 0 … 1; `None` if opaque.
    pub opacity: Option<SlotNumber>,
    /// Normal map, and a factor on its slopes; `None` for the mesh's own normals.
    pub normals: Option<(SlotPicture, f64)>,
}

/// Layer over a non-metal base.
#[derive(Clone, Debug, PartialEq)]
pub enum SlotTopLayer {
    /// Nothing: Lambertian reflection.
    Nothing,
    /// A clear coat of a refractive index within [`super::COAT_INDICES`], with the roughness of the material.
    Coat {
        /// The refractive index.
        index: f64,
    },
    /// A clear coat of its own roughness over a fraction of the surface, and the material's own over the rest.
    TwoCoats {
        /// The refractive index of both.
        index: f64,
        /// Fraction of the surface under the second, 0 … 1.
        fraction: f64,
        /// GGX α of the second, 0 … 1.
        alpha: f64,
    },
    /// The sheen of fibres.
    Sheen {
        /// Linear sRGB, 0 … 1.
        colour: [f64; 3],
        /// Roughness α of the sheen, 0.1 … 1.
        alpha: f64,
    },
}

#[derive(Clone, Debug, PartialEq)]
pub struct SlotTransmission {
    /// Fraction of the surface that is clear, 0 … 1.
    pub fraction: SlotNumber,
    /// Refractive index, 1 … 4.
    pub index: f64,
    /// Absorption inside a solid; `None` for a pane without thickness.
    pub solid: Option<SlotSolid>,
    /// Transmittance of a pane, linear sRGB, 0 … 1; `None` for the base colour.
    pub tint: Option<[f64; 3]>,
}

/// The inside of a clear solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlotSolid {
    /// Transmittance over `distance_m`, linear sRGB, 0 … 1.
    pub colour: [f64; 3],
    /// The distance, m; `None` without absorption.
    pub distance_m: Option<f64>,
}

/// Emission of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SlotEmission {
    /// Luminance by components, linear sRGB in cd/m².
    pub rgb_cd_m2: [f64; 3],
    /// Factors on it over the surface; `None` if constant.
    pub picture: Option<SlotPicture>,
    /// True if the back emits the same light.
    pub both_sides: bool,
}

/// A colour over a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum SlotColour {
    /// Linear sRGB, 0 … 1.
    LinearSrgb([f64; 3]),
    /// An image.
    Picture(SlotPicture),
}

/// A number over a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum SlotNumber {
    /// Constant over the surface.
    Number(f64),
    /// The first channel of an image of plain values.
    Picture(SlotPicture),
}

/// An image that is embedded in or named by the mesh's file, or was made from one.
#[derive(Clone, Debug, PartialEq)]
pub struct SlotPicture {
    /// Its name among the images of the assets.
    pub file: PathBuf,
    /// True if it is part of the mesh's asset; false if it is a file of its own.
    pub is_embedded: bool,
    /// True if its values are encoded by the curve of sRGB.
    pub is_encoded: bool,
    /// Extension outside u, v = 0 … 1, along u and v.
    pub wrap: [SlotWrap; 2],
}

/// Extension outside an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlotWrap {
    /// Repeated.
    Repeat,
    /// Clamped to its edge.
    Clamp,
    /// Mirrored.
    Mirror,
}

impl SlotLayers {
    /// Its images that are files of their own.
    pub(super) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let base = match &self.base {
            SlotColour::Picture(picture) => Some(picture),
            SlotColour::LinearSrgb(_) => None,
        };
        let numbers = [Some(&self.metal), Some(&self.alpha), self.opacity.as_ref()].into_iter();
        let clear = self.transmission.as_ref().map(|transmission| &transmission.fraction);
        let numbers = numbers.chain([clear]).flatten().filter_map(|number| match number {
            SlotNumber::Picture(picture) => Some(picture),
            SlotNumber::Number(_) => None,
        });
        let emission = self.emission.as_ref().and_then(|emission| emission.picture.as_ref());
        let normals = self.normals.as_ref().map(|(picture, _)| picture);
        let pictures = base.into_iter().chain(numbers).chain(emission).chain(normals);
        pictures.filter(|picture| !picture.is_embedded).map(|picture| &picture.file)
    }

    /// True if any part is an image, which needs texture coordinates.
    #[must_use]
    pub fn has_picture(&self) -> bool {
        let numbers = [Some(&self.metal), Some(&self.alpha), self.opacity.as_ref()];
        let clear = self.transmission.as_ref().map(|t| &t.fraction);
        matches!(self.base, SlotColour::Picture(_))
            || numbers.into_iter().chain([clear]).flatten().any(|n| matches!(n, SlotNumber::Picture(_)))
            || self.emission.as_ref().is_some_and(|e| e.picture.is_some())
            || self.normals.is_some()
    }
}

/// True if the name of a mesh's file is that of a glTF file.
#[must_use]
pub fn is_gltf(file: &Path) -> bool {
    file.extension().is_some_and(|e| e.eq_ignore_ascii_case("glb") || e.eq_ignore_ascii_case("gltf"))
}

impl SlotLayers {
    /// The resulting material, in words.
    #[must_use]
    pub fn describe(&self) -> String {
        let layered = match &self.top_layer {
            SlotTopLayer::Nothing => "diffuse".to_owned(),
            SlotTopLayer::Coat { index } => format!("coated, index {index:.3}"),
            SlotTopLayer::TwoCoats { index, fraction, .. } => {
                format!("coated, index {index:.3}, a fraction of {fraction} under a clear coat")
            }
            SlotTopLayer::Sheen { .. } => "cloth".to_owned(),
        };
        let transmissive = match &self.transmission {
            None => layered,
            Some(clear) => {
                let what = if clear.solid.is_some() { "dielectric" } else { "thin_sheet" };
                format!("mix of {layered} and {what} of index {} by {}", clear.index, words(&clear.fraction))
            }
        };
        let surface = match &self.metal {
            SlotNumber::Number(0.0) => transmissive,
            SlotNumber::Number(1.0) => "conductor of the base colour".to_owned(),
            fraction => format!("mix of {transmissive} and conductor by {}", words(fraction)),
        };
        let mut parts = vec![surface];
        if self.top_layer != SlotTopLayer::Nothing || self.metal != SlotNumber::Number(0.0) {
            parts.push(format!("alpha {}", words(&self.alpha)));
        }
        if let SlotColour::Picture(_) = &self.base {
            parts.push("colour from an image".to_owned());
        }
        if let Some(opacity) = &self.opacity {
            parts.push(format!("opacity {}", words(opacity)));
        }
        if let Some(emission) = &self.emission {
            let [r, g, b] = emission.rgb_cd_m2;
            parts.push(format!("emission of ({r:.4}, {g:.4}, {b:.4}) cd/m²"));
        }
        if self.normals.is_some() {
            parts.push("normal map".to_owned());
        }
        parts.join(", ")
    }
}

fn words(number: &SlotNumber) -> String {
    match number {
        SlotNumber::Number(value) => format!("{value:.4}"),
        SlotNumber::Picture(_) => "a picture".to_owned(),
    }
}
