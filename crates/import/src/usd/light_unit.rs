//! Strength and colour of lights.
//!
//! UsdLux: the luminance of a light's surface is intensity · 2^exposure, in cd/m², times its colour, times that of a black body of luminance 1 if a temperature
//! applies; "normalize" divides by the surface's area in the world's unit.

use etendue_core::maths::f64 as maths;
use etendue_scene::record::LightColour;
use etendue_spectra::colour::{BT709, linear_srgb_from_xyz};
use etendue_spectra::{illuminant, observer};

use super::access::{flag, number, tuple};
use super::importer::Importer;
use crate::scenery::{AreaLight, LightUnit, grey, illuminant_of};
use crate::syntax::usd::UsdPrim;

impl<'a> Importer<'a> {
    /// Luminance and colour, without the divisor of "normalize"; `None`, with a note, for a dark light.
    pub(super) fn light_unit(&mut self, prim: &'a UsdPrim, usual: f64) -> Option<LightUnit> {
        let exposure = number(prim, "inputs:exposure", 0.0).clamp(-100.0, 100.0);
        let strength = number(prim, "inputs:intensity", usual) * maths::pow(2.0, exposure);
        let rgb = tuple::<3>(prim, "inputs:color").unwrap_or([1.0; 3]).map(|v| v.max(0.0));
        let colour_luminance: f64 = rgb.iter().zip(BT709).map(|(v, weight)| v * weight).sum();
        let kelvin = number(prim, "inputs:colorTemperature", 6500.0);
        let has_temperature = flag(prim, "inputs:enableColorTemperature", false);
        let connected = ["inputs:intensity", "inputs:color", "inputs:exposure"];
        if connected.iter().any(|name| prim.attributes.get(*name).is_some_and(|a| !a.connections.is_empty())) {
            self.scenery.report.note("connections of the inputs of a light are not used: their own values are used");
        }
        for (name, usual) in [("inputs:diffuse", 1.0), ("inputs:specular", 1.0)] {
            if number(prim, name, usual) != usual {
                self.scenery.report.note("the diffuse and specular factors of a light are not used");
            }
        }
        let unit = match (has_temperature, grey(rgb)) {
            (false, Some(_)) => LightUnit { colour: illuminant_of("D65"), luminance: strength * colour_luminance },
            (false, None) => LightUnit { colour: LightColour::Rgb(rgb.into()), luminance: strength * colour_luminance },
            (true, even) => {
                let legal = kelvin.clamp(500.0, 20_000.0);
                if legal != kelvin {
                    self.scenery.report.note(format!("the colour temperature {kelvin} K is limited to {legal} K"));
                }
                match even {
                    Some(level) => {
                        LightUnit { colour: LightColour::Temperature(legal.into()), luminance: strength * level }
                    }
                    None => tinted(rgb, legal, strength),
                }
            }
        };
        if unit.luminance > 0.0 && unit.luminance.is_finite() {
            return Some(unit);
        }
        self.scenery.report.note(format!("a {} emits no light and is left out", prim.kind));
        None
    }

    /// Light of an emissive mesh, without "normalize".
    pub(super) fn mesh_light(&mut self, prim: &'a UsdPrim) -> Option<AreaLight> {
        let unit = self.light_unit(prim, 1.0)?;
        self.scenery
            .report
            .note(format!("mesh light: {} cd/m², in addition to the emission of its material", unit.luminance));
        Some(AreaLight { colour: unit.colour, luminance: unit.luminance, flux: None, two_sided: false })
    }
}

/// Light of a black body through a colour filter.
fn tinted(rgb: [f64; 3], kelvin: f64, strength: f64) -> LightUnit {
    let body = illuminant::blackbody(kelvin);
    let own = linear_srgb_from_xyz(observer::xyz(&body));
    let luminance = |rgb: [f64; 3]| -> f64 { rgb.iter().zip(BT709).map(|(v, weight)| v * weight).sum() };
    // Luminance 1, clipped to the gamut of sRGB.
    let level = luminance(own);
    let scale = if level > 0.0 { 1.0 / level } else { 1.0 };
    let tint: [f64; 3] = std::array::from_fn(|i| (rgb[i] * own[i] * scale).max(0.0));
    LightUnit { colour: LightColour::Rgb(tint.into()), luminance: strength * luminance(tint) }
}
