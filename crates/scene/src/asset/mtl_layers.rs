//! Conversion of an MTL material with metal, transparency or textures of numbers.
//!
//! | MTL | becomes |
//! | --- | --- |
//! | `d`, `Tr`, `map_d` | opacity: the fraction of the surface that is present |
//! | `illum` 6 or 7 with `Ni` above 1 | a solid dielectric; with `d` below 1 a fraction 1 − d of the surface |
//! | `illum` 4 or 9 with `Ni` above 1, and `d` below 1 or `Tf` | a thin sheet (glass without refraction), tinted by `Tf` |
//! | `Pm`, `map_Pm` | fraction of metal |
//! | `Pr`, `map_Pr` | α = Pr² |
//! | `norm` | normal map |
//!
//! Wavefront's specification calls 4 and 9 "glass on" without refraction, 6 and 7 "refraction on".

use super::mtl::{MtlFields, SlotMaterial, SlotReflectance, SlotSurface};
use super::slot_layers::{
    SlotColour, SlotLayers, SlotNumber, SlotPicture, SlotSolid, SlotTopLayer, SlotTransmission, SlotWrap,
};

/// Numbers over the surface from images of an MTL material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlPictures {
    /// `map_d`.
    pub opacity: Option<SlotNumber>,
    /// Squares of `map_Pr`.
    pub alpha: Option<SlotNumber>,
    /// `map_Pm`.
    pub metal: Option<SlotNumber>,
    /// `norm`, and a factor on its slopes.
    pub normals: Option<(SlotPicture, f64)>,
}

impl MtlPictures {
    fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Glass of an illumination model.
struct MtlGlass {
    index: f64,
    /// Fraction of the surface that is clear.
    fraction: f64,
    is_solid: bool,
}

impl MtlFields {
    /// True if [`Self::to_layers`] represents more of the material than [`Self::to_slot`].
    #[must_use]
    pub fn needs_layers(&self, pictures: &MtlPictures) -> bool {
        let is_metal = self.metalness.is_some_and(|m| m > 0.0);
        !pictures.is_empty() || is_metal || self.opacity.is_some_and(|d| d < 1.0) || self.glass().is_some()
    }

    /// Returns the material in layers, and sentences on its content without an equivalent in a scene.
    #[must_use]
    pub fn to_layers(&self, name: &str, pictures: MtlPictures) -> (SlotMaterial, Vec<String>) {
        let mut report = Vec::new();
        let surface = self.layers(name, pictures, &mut report).map(|layers| SlotSurface::Layers(Box::new(layers)));
        self.report_light(name, &mut report);
        (SlotMaterial { name: name.to_owned(), surface }, report)
    }

    fn layers(&self, name: &str, pictures: MtlPictures, report: &mut Vec<String>) -> Option<SlotLayers> {
        let mut note = |text: String| report.push(format!("material \"{name}\": {text}"));
        let glass = self.glass();
        if let Some(glass) = &glass {
            note(glass.describe());
        }
        let is_pane = glass.as_ref().is_some_and(|glass| !glass.is_solid);
        if self.is_tinted() && !is_pane {
            note("Tf is not used".to_owned());
        }
        for (is, key) in [(pictures.alpha.is_some(), "Pr"), (pictures.metal.is_some(), "Pm")] {
            let stated = if key == "Pr" { self.roughness } else { self.metalness };
            if is && stated.is_some() {
                note(format!("{key} is not used with map_{key}"));
            }
        }
        let has_roughness = pictures.alpha.is_some() || self.roughness.is_some();
        let metal = pictures.metal.unwrap_or(SlotNumber::Number(self.metalness.unwrap_or(0.0)));
        let is_metal = metal != SlotNumber::Number(0.0);
        let coat = pictures.alpha.or_else(|| self.alpha().map(SlotNumber::Number));
        let has_coat = coat.is_some();
        let rough = coat.is_none() && is_metal && self.exponent.is_none_or(|n| n <= 0.0);
        if rough {
            note("metal without a roughness (Pr): α = 1 is used".to_owned());
        }
        let is_glass = glass.is_some();
        let base = match self.reflectance(name, report) {
            Some(reflectance) => colour(reflectance),
            None if glass.as_ref().is_some_and(|glass| glass.fraction >= 1.0) => SlotColour::LinearSrgb([1.0; 3]),
            None => return None,
        };
        let top_layer = match has_coat {
            true => SlotTopLayer::Coat { index: self.coat_index(name, report) },
            false => SlotTopLayer::Nothing,
        };
        Some(SlotLayers {
            alpha: coat.filter(|_| !is_glass || has_roughness).unwrap_or(SlotNumber::Number(self.bare_alpha(is_glass))),
            transmission: glass.map(|glass| glass.transmission(self.filter)),
            opacity: self.opacity_of(pictures.opacity, is_glass),
            normals: pictures.normals,
            emission: None,
            top_layer,
            metal,
            base,
        })
    }

    /// α of glass and metal whose material has no coat: clear glass is smooth.
    fn bare_alpha(&self, is_glass: bool) -> f64 {
        match self.exponent.filter(|exponent| *exponent > 0.0) {
            _ if is_glass => 0.0,
            Some(exponent) => (2.0 / (exponent + 2.0)).sqrt().min(1.0),
            None => 1.0,
        }
    }

    /// Opacity: `map_d` with its `d`, else `d`; of glass `d` is its fraction.
    fn opacity_of(&self, picture: Option<SlotNumber>, is_glass: bool) -> Option<SlotNumber> {
        let number = self.opacity.filter(|d| *d < 1.0 && !is_glass).map(SlotNumber::Number);
        picture.or(number).filter(|opacity| *opacity != SlotNumber::Number(1.0))
    }

    fn glass(&self) -> Option<MtlGlass> {
        let index = self.index.filter(|index| *index > 1.0 && *index <= 4.0)?;
        let opacity = self.opacity.unwrap_or(1.0);
        let fraction = if opacity < 1.0 { 1.0 - opacity } else { 1.0 };
        let is_clear = opacity < 1.0 || self.filter.is_some_and(|filter| filter != [0.0; 3]);
        match self.illumination_model? {
            6 | 7 => Some(MtlGlass { index, fraction, is_solid: true }),
            4 | 9 if is_clear => Some(MtlGlass { index, fraction, is_solid: false }),
            _ => None,
        }
    }
}

impl MtlGlass {
    fn describe(&self) -> String {
        let Self { index, fraction, is_solid } = self;
        let percentage = if *fraction < 1.0 { format!(" on a fraction of {fraction}") } else { String::new() };
        match is_solid {
            true => format!("illum is glass: a solid of index {index}{percentage}; the mesh must be closed"),
            false => format!("illum is glass without refraction: a thin pane of index {index}{percentage}"),
        }
    }

    fn transmission(self, filter: Option<[f64; 3]>) -> SlotTransmission {
        let solid = SlotSolid { colour: [1.0; 3], distance_m: None };
        let tint = filter.unwrap_or([1.0; 3]).map(|v| v.clamp(0.0, 1.0));
        SlotTransmission {
            fraction: SlotNumber::Number(self.fraction),
            index: self.index,
            solid: self.is_solid.then_some(solid),
            tint: Some(tint),
        }
    }
}

fn colour(reflectance: SlotReflectance) -> SlotColour {
    match reflectance {
        SlotReflectance::LinearSrgb(rgb) => SlotColour::LinearSrgb(rgb),
        SlotReflectance::Image(file) => {
            SlotColour::Picture(SlotPicture { file, is_embedded: false, is_encoded: true, wrap: [SlotWrap::Repeat; 2] })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layers(fields: &MtlFields) -> SlotLayers {
        let fields = MtlFields { diffuse: Some([0.5; 3]), ..fields.clone() };
        match fields.to_layers("a", MtlPictures::default()).0.surface {
            Some(SlotSurface::Layers(layers)) => *layers,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn transparency_is_opacity_and_glass_is_glass() {
        let fields = |model: u8, opacity: f64| MtlFields {
            illumination_model: Some(model),
            opacity: Some(opacity),
            index: Some(1.5),
            ..MtlFields::default()
        };
        let plain = layers(&fields(2, 0.25));
        assert_eq!((plain.opacity, plain.transmission), (Some(SlotNumber::Number(0.25)), None));
        for (model, is_solid) in [(4, false), (6, true), (7, true), (9, false)] {
            let glass = layers(&fields(model, 0.25));
            let transmission = glass.transmission.expect("glass");
            assert_eq!((glass.opacity, transmission.solid.is_some()), (None, is_solid), "illum {model}");
            assert_eq!((transmission.index, transmission.fraction), (1.5, SlotNumber::Number(0.75)));
            assert_eq!(glass.alpha, SlotNumber::Number(0.0), "smooth");
        }
        let none = MtlPictures::default();
        assert!(fields(7, 1.0).needs_layers(&none) && !fields(4, 1.0).needs_layers(&none));
        assert!(
            !MtlFields { index: Some(1.0), ..fields(7, 1.0) }.needs_layers(&none),
            "an index of 1 refracts nothing"
        );
    }

    #[test]
    fn metal_has_the_roughness_of_its_highlight() {
        let metal = MtlFields { metalness: Some(1.0), ..MtlFields::default() };
        assert_eq!(layers(&metal).alpha, SlotNumber::Number(1.0));
        assert_eq!(layers(&MtlFields { exponent: Some(198.0), ..metal.clone() }).alpha, SlotNumber::Number(0.1));
        assert_eq!(layers(&MtlFields { roughness: Some(0.5), ..metal }).alpha, SlotNumber::Number(0.25));
    }
}
