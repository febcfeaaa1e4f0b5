//! Conversion of a Wavefront MTL material to a material of a scene.
//!
//! `map_Kd` (sRGB-encoded) or else `Kd` (linear sRGB) becomes the diffuse reflectance. A material with highlights (`Ks` above 0, illumination model 2
//! or more or not stated, and `Ns` above 0) or with a roughness `Pr` becomes "coated". The index is `Ni`, or 1.5 if it is absent or outside 1.1 … 4,
//! which is reported. Metal, transparency, and textures of numbers: `mtl_layers.rs`. α = Pr² (Burley, "Physically based shading at Disney", 2012) or else α = √(2 / (Ns + 2)), the GGX width with the curvature of a
//! Blinn-Phong lobe of exponent Ns (Walter et al., "Microfacet models for refraction", 2007). An MTL has no unit for light, so `Ke` is reported and
//! not used; the same applies to the colour of highlights.

use std::path::PathBuf;

use super::slot_layers::SlotLayers;

/// Range of refractive indices of a coat, in scenes and in MTL files. The tracer's model of a coat has the same range
/// (`etendue_tracer::materials::COAT_INDICES`) and refuses others.
pub const COAT_INDICES: std::ops::RangeInclusive<f64> = 1.1..=4.0;

/// Index of a coat whose file gives no index in this range.
const DEFAULT_INDEX: f64 = 1.5;

/// A material, by its name in a mesh's file.
#[derive(Clone, Debug, PartialEq)]
pub struct SlotMaterial {
    /// Name in the mesh's file.
    pub name: String,
    /// Scattering model; `None` if the file gives none, so that the scene must.
    pub surface: Option<SlotSurface>,
}

/// Scattering model of a mesh's own material.
#[derive(Clone, Debug, PartialEq)]
pub enum SlotSurface {
    /// Lambertian reflection.
    Diffuse { reflectance: SlotReflectance },
    /// A diffuse base under a clear coat.
    Coated {
        /// Reflectance of the base.
        reflectance: SlotReflectance,
        /// Refractive index of the coat.
        index: f64,
        /// GGX roughness of the coat.
        alpha: f64,
    },
    /// A material of a glTF file, or of an MTL with more than a colour and a coat.
    Layers(Box<SlotLayers>),
}

impl SlotSurface {
    /// Its images that are files of their own.
    #[must_use]
    pub fn files(&self) -> Vec<&PathBuf> {
        match self {
            Self::Diffuse { reflectance } | Self::Coated { reflectance, .. } => match reflectance {
                SlotReflectance::Image(file) => vec![file],
                SlotReflectance::LinearSrgb(_) => Vec::new(),
            },
            Self::Layers(layers) => layers.files().collect(),
        }
    }
}

/// Reflectance from a mesh's file.
#[derive(Clone, Debug, PartialEq)]
pub enum SlotReflectance {
    /// Linear sRGB, 0 … 1.
    LinearSrgb([f64; 3]),
    /// An sRGB-encoded image that repeats; a readable path.
    Image(PathBuf),
}

/// The fields of an MTL material that have a meaning here or are reported; `None` if absent.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlFields {
    /// `Kd`, linear sRGB.
    pub diffuse: Option<[f64; 3]>,
    /// `map_Kd`, a readable path.
    pub diffuse_map: Option<PathBuf>,
    /// `Ks`.
    pub specular: Option<[f64; 3]>,
    /// `Ns`.
    pub exponent: Option<f64>,
    /// `Ni`.
    pub index: Option<f64>,
    /// `Ke`.
    pub emission: Option<[f64; 3]>,
    /// `Pr`.
    pub roughness: Option<f64>,
    /// `Pm`.
    pub metalness: Option<f64>,
    /// `d`, or 1 − `Tr`.
    pub opacity: Option<f64>,
    /// `illum`.
    pub illumination_model: Option<u8>,
    /// `Tf`.
    pub filter: Option<[f64; 3]>,
}

impl MtlFields {
    /// Returns the material, and sentences on its content without an equivalent in a scene, for [`super::MeshAsset::report`].
    #[must_use]
    pub fn to_slot(&self, name: &str) -> (SlotMaterial, Vec<String>) {
        let mut report = Vec::new();
        let surface = self.reflectance(name, &mut report).map(|reflectance| match self.alpha() {
            Some(alpha) => SlotSurface::Coated { reflectance, index: self.coat_index(name, &mut report), alpha },
            None => SlotSurface::Diffuse { reflectance },
        });
        self.report_unused(name, &mut report);
        (SlotMaterial { name: name.to_owned(), surface }, report)
    }

    pub(super) fn reflectance(&self, name: &str, report: &mut Vec<String>) -> Option<SlotReflectance> {
        if let Some(map) = &self.diffuse_map {
            return Some(SlotReflectance::Image(map.clone()));
        }
        let kd = self.diffuse?;
        if kd.iter().any(|v| !(0.0..=1.0).contains(v)) {
            report.push(format!(
                "material \"{name}\": Kd {kd:?} is not a reflectance (0 … 1); define its material in the scene"
            ));
            return None;
        }
        Some(SlotReflectance::LinearSrgb(kd))
    }

    /// Roughness of the coat; `None` for a material without highlights.
    pub(super) fn alpha(&self) -> Option<f64> {
        let shiny = self.specular.is_some_and(|ks| ks.iter().any(|v| *v > 0.0));
        let by_exponent = self.exponent.filter(|n| shiny && *n > 0.0 && self.illumination_model.is_none_or(|m| m >= 2));
        let alpha = match (self.roughness, by_exponent) {
            (Some(roughness), _) => roughness * roughness,
            (None, Some(exponent)) => (2.0 / (exponent + 2.0)).sqrt(),
            (None, None) => return None,
        };
        Some(alpha.min(1.0))
    }

    pub(super) fn coat_index(&self, name: &str, report: &mut Vec<String>) -> f64 {
        let Some(index) = self.index else { return DEFAULT_INDEX };
        if COAT_INDICES.contains(&index) {
            return index;
        }
        let (low, high) = (COAT_INDICES.start(), COAT_INDICES.end());
        report.push(format!(
            "material \"{name}\": Ni {index} is not a refractive index of a coat ({low} … {high}), {DEFAULT_INDEX} is \
             used; define its material in the scene"
        ));
        DEFAULT_INDEX
    }

    fn report_unused(&self, name: &str, report: &mut Vec<String>) {
        let metal = self.metalness.is_some_and(|m| m > 0.0);
        let clear = self.opacity.is_some_and(|d| d < 1.0);
        let notes = [
            (metal, "Pm (metalness) is not used; set \"conductor\" in the scene"),
            (clear, "transparency (d, Tr) is not used: the surface is opaque"),
            (self.is_tinted(), "Tf is not used"),
        ];
        self.report_light(name, report);
        report.extend(notes.iter().filter(|(is, _)| *is).map(|(_, note)| format!("material \"{name}\": {note}")));
    }

    /// True if `Tf` states a colour other than white.
    pub(super) fn is_tinted(&self) -> bool {
        self.filter.is_some_and(|filter| filter != [1.0; 3])
    }

    /// Reports emission and coloured highlights, which no conversion uses.
    pub(super) fn report_light(&self, name: &str, report: &mut Vec<String>) {
        let emits = self.emission.is_some_and(|ke| ke.iter().any(|v| *v > 0.0));
        let tinted = self.specular.is_some_and(|[r, g, b]| r != g || g != b);
        let notes = [
            (emits, "Ke has no unit and is not used; set \"emission\" in the scene"),
            (tinted, "the colour of highlights (Ks) is not used"),
        ];
        report.extend(notes.iter().filter(|(is, _)| *is).map(|(_, note)| format!("material \"{name}\": {note}")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diffuse_and_glossy_materials() {
        let diffuse = MtlFields {
            diffuse: Some([0.5; 3]),
            exponent: Some(250.0),
            specular: Some([0.0; 3]),
            ..Default::default()
        };
        assert!(matches!(diffuse.to_slot("a").0.surface, Some(SlotSurface::Diffuse { .. })), "no highlight without Ks");
        let shiny = MtlFields { specular: Some([0.5; 3]), exponent: Some(198.0), ..diffuse };
        let Some(SlotSurface::Coated { alpha, index, .. }) = shiny.to_slot("a").0.surface else { panic!("shiny") };
        assert_eq!((alpha, index), (0.1, 1.5), "√(2 / 200)");
    }

    #[test]
    fn an_index_that_no_coat_has_is_reported_where_a_coat_would_use_it() {
        let of = |index, shine| {
            let fields = MtlFields {
                diffuse: Some([0.5; 3]),
                specular: Some([shine; 3]),
                exponent: Some(198.0),
                index: Some(index),
                ..Default::default()
            };
            let (slot, report) = fields.to_slot("x");
            let index = match slot.surface {
                Some(SlotSurface::Coated { index, .. }) => Some(index),
                _ => None,
            };
            (index, report.len())
        };
        for (index, expected) in [(1.1, (1.1, 0)), (4.0, (4.0, 0)), (1.0, (1.5, 1)), (1.05, (1.5, 1)), (4.1, (1.5, 1))]
        {
            assert_eq!(of(index, 0.5), (Some(expected.0), expected.1), "Ni {index}");
        }
        assert_eq!(of(1.0, 0.0), (None, 0), "a matt surface has no coat");
    }

    #[test]
    fn what_has_no_place_is_reported() {
        let fields =
            MtlFields { emission: Some([1.0; 3]), metalness: Some(1.0), opacity: Some(0.5), ..Default::default() };
        let (slot, report) = fields.to_slot("lamp");
        assert_eq!((slot.surface, report.len()), (None, 3), "light, metal, glass");
        let bright = MtlFields { diffuse: Some([1.5, 0.0, 0.0]), ..Default::default() };
        assert_eq!(bright.to_slot("x").0.surface, None, "more light than arrives");
    }
}
