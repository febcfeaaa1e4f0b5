//! Lights that are not surfaces, the directive of emissive surfaces, and media.

use std::f64::consts::{PI, TAU};

use etendue_core::maths::f64 as maths;
use etendue_scene::record::medium::{MediumShape, UnboundedRegion};
use etendue_scene::record::{LightColour, Transform};
use etendue_spectra::{Extrapolation, Spectrum};
use glam::DVec3;

use super::colour::table;
use super::infinite::spectrum_of;
use super::parameters::Parameters;
use crate::lamps;
use crate::scenery::{AreaLight, Graphics, Homogeneous, InfiniteLight, SceneBuilder, UniformLight};
use crate::syntax::pbrt::PbrtValues;

impl SceneBuilder {
    pub(super) fn light_source(
        &mut self,
        kind: &str,
        parameters: Parameters<'_>,
        graphics: &Graphics,
    ) -> Result<(), String> {
        let scale = parameters.number("scale", 1.0)?;
        if scale < 0.0 {
            return Err("\"scale\" is below 0".to_owned());
        }
        match kind {
            "point" => self.point(parameters, graphics, scale),
            "spot" => self.spot(parameters, graphics, scale),
            "distant" => self.distant(parameters, graphics, scale),
            "infinite" => self.infinite(parameters, graphics, scale),
            other => {
                self.report.note(format!("the light \"{other}\" is not supported and left out"));
                parameters.0.iter().for_each(|p| p.used.set(true));
                Ok(())
            }
        }
    }

    /// Value of `power`, lm, if the file states one.
    fn power(parameters: Parameters<'_>) -> Result<Option<f64>, String> {
        Ok(parameters.numbers("power")?.and_then(|n| n.first().copied()).filter(|p| *p > 0.0))
    }

    fn point(&mut self, parameters: Parameters<'_>, graphics: &Graphics, scale: f64) -> Result<(), String> {
        let unit = self.light(parameters, "I")?;
        let from = DVec3::from_array(parameters.triple("from", [0.0; 3])?);
        let candela = Self::power(parameters)?.map_or(1.0, |lm| lm / (4.0 * PI)) * scale * unit.luminance;
        let Some(candela) = self.note_light("point", "cd", candela) else { return Ok(()) };
        let position = self.to_ours * graphics.to_world.transform_point3(from);
        let name = self.names.take("point", "point");
        self.scene.lights.push(lamps::point(&name, position, candela, unit.colour));
        Ok(())
    }

    fn spot(&mut self, parameters: Parameters<'_>, graphics: &Graphics, scale: f64) -> Result<(), String> {
        let unit = self.light(parameters, "I")?;
        let [from, to] = [("from", [0.0; 3]), ("to", [0.0, 0.0, 1.0])]
            .map(|(name, default)| parameters.triple(name, default).map(DVec3::from_array));
        let (from, to) = (graphics.to_world.transform_point3(from?), graphics.to_world.transform_point3(to?));
        let ahead = (self.to_ours * (to - from)).try_normalize().ok_or("\"from\" and \"to\" coincide")?;
        let outer_deg = parameters.number("coneangle", 30.0)?;
        let inner_deg = outer_deg - parameters.number("conedeltaangle", 5.0)?;
        if !(0.0..=180.0).contains(&outer_deg) || outer_deg == 0.0 || !(0.0..=outer_deg).contains(&inner_deg) {
            return Err(format!("the cone is from {inner_deg}° to {outer_deg}°; expected 0 ≤ inner ≤ outer ≤ 180"));
        }
        let [inner, outer] = [inner_deg, outer_deg].map(|a| maths::cos(a.to_radians()));
        let solid_angle = TAU * ((1.0 - inner) + 0.5 * (inner - outer));
        let candela = Self::power(parameters)?.map_or(1.0, |lm| lm / solid_angle) * scale * unit.luminance;
        let Some(candela) = self.note_light("spot", "cd", candela) else { return Ok(()) };
        let name = self.names.take("spot", "spot");
        let pose = (self.to_ours * from, ahead);
        self.scene.lights.push(lamps::spot(&name, pose.0, pose.1, [inner_deg, outer_deg], candela, unit.colour));
        Ok(())
    }

    fn distant(&mut self, parameters: Parameters<'_>, graphics: &Graphics, scale: f64) -> Result<(), String> {
        let unit = self.light(parameters, "L")?;
        let from = DVec3::from_array(parameters.triple("from", [0.0; 3])?);
        let to = DVec3::from_array(parameters.triple("to", [0.0, 0.0, 1.0])?);
        let towards = self.to_ours * (graphics.to_world.matrix3 * (from - to));
        let towards = towards.try_normalize().ok_or("\"from\" and \"to\" coincide")?;
        let stated = parameters.numbers("illuminance")?.and_then(|n| n.first().copied()).filter(|e| *e > 0.0);
        let Some(lux) = self.note_light("distant", "lx", stated.unwrap_or(1.0) * scale * unit.luminance) else {
            return Ok(());
        };
        let name = self.names.take("distant", "distant");
        self.scene.lights.push(lamps::parallel(&name, towards, lux, unit.colour));
        Ok(())
    }

    fn infinite(&mut self, parameters: Parameters<'_>, graphics: &Graphics, scale: f64) -> Result<(), String> {
        let lux = parameters.numbers("illuminance")?.and_then(|n| n.first().copied()).filter(|e| *e > 0.0);
        if parameters.find("portal").is_some() {
            self.report.note("a portal is not used: the light also comes from outside it");
        }
        let light = match (parameters.text("filename")?, parameters.find("L")) {
            (Some(_), Some(_)) => return Err("\"L\" contradicts \"filename\"; remove one of them".to_owned()),
            (Some(file), None) => {
                if lux.is_some() {
                    // Its sum over the upper half uses 2π instead of 4π.
                    self.report
                        .note("\"illuminance\" of an environment map is in lx; pbrt-v4 itself renders twice as much");
                }
                self.square_light(file, graphics, scale, lux)?.map(InfiniteLight::Image)
            }
            (None, _) => self.uniform_light(parameters, lux.map_or(1.0, |lux| lux / PI) * scale)?,
        };
        self.known.infinite_lights.extend(light);
        Ok(())
    }

    /// Uniform light of the colour `L`; `None`, with a note, if it is dark.
    fn uniform_light(&mut self, parameters: Parameters<'_>, scale: f64) -> Result<Option<InfiniteLight>, String> {
        let unit = self.light(parameters, "L")?;
        let Some(luminance_cd_m2) = self.note_light("infinite", "cd/m²", scale * unit.luminance) else {
            return Ok(None);
        };
        let spectrum = match (&unit.colour, parameters.find("L").map(|p| &p.values)) {
            (LightColour::Spectrum(_), Some(PbrtValues::Numbers(numbers))) => table("L", numbers, Extrapolation::Zero)?,
            (LightColour::Spectrum(_), Some(PbrtValues::Texts(texts))) => {
                let pairs = self.named_points("L", texts)?;
                Spectrum::from_points(&pairs, Extrapolation::Zero).map_err(|e| format!("\"L\": {e}"))?
            }
            _ => spectrum_of(&unit.colour),
        };
        Ok(Some(InfiniteLight::Uniform(UniformLight { colour: unit.colour, luminance_cd_m2, spectrum })))
    }

    /// Notes a light; `None` for a dark one.
    fn note_light(&mut self, kind: &str, unit: &str, level: f64) -> Option<f64> {
        if level > 0.0 && level.is_finite() {
            self.report.note(format!("light \"{kind}\": {level} {unit}"));
            return Some(level);
        }
        self.report.note(format!("a light \"{kind}\" emits no light and is left out"));
        None
    }
}

impl SceneBuilder {
    /// `None` for a dark light.
    pub(super) fn area_light(&mut self, kind: &str, parameters: Parameters<'_>) -> Result<Option<AreaLight>, String> {
        if kind != "diffuse" {
            self.report.note(format!("the area light \"{kind}\" is not supported and left out"));
            return Ok(None);
        }
        if parameters.find("filename").is_some() {
            self.report.note("the image of an area light is not used: its emission is uniform");
        }
        let unit = self.light(parameters, "L")?;
        let luminance = parameters.number("scale", 1.0)? * unit.luminance;
        let power = parameters.numbers("power")?.and_then(|n| n.first().copied()).filter(|p| *p > 0.0);
        if luminance <= 0.0 {
            self.report.note("an area light emits no light and is left out");
            return Ok(None);
        }
        let two_sided = parameters.flag("twosided", false)?;
        Ok(Some(AreaLight { colour: unit.colour, luminance, flux: power.map(|lm| lm * luminance), two_sided }))
    }
}

impl SceneBuilder {
    pub(super) fn medium(&mut self, name: &str, parameters: Parameters<'_>) -> Result<(), String> {
        let kind = parameters.text("type")?.unwrap_or_default();
        if kind != "homogeneous" {
            self.report
                .note(format!("the medium \"{name}\" ({kind}) is not supported and left out: expected homogeneous"));
            parameters.0.iter().for_each(|p| p.used.set(true));
            return Ok(());
        }
        for unread in ["preset", "Le", "Lescale"] {
            if parameters.find(unread).is_some() {
                self.report.note(format!("\"{unread}\" of a medium is not used"));
            }
        }
        let scale = parameters.number("scale", 1.0)?;
        let (absorbed, even_a) = self.coefficient(parameters, "sigma_a", [0.0011, 0.0024, 0.014])?;
        let (scattered, even_s) = self.coefficient(parameters, "sigma_s", [2.55, 3.21, 3.77])?;
        let at = |s: &Spectrum, nm: f64| f64::from(s.at(nm as f32));
        let sum = Spectrum::from_fn(|nm| at(&absorbed, nm) + at(&scattered, nm));
        let fraction = Spectrum::from_fn(|nm| if at(&sum, nm) > 0.0 { at(&scattered, nm) / at(&sum, nm) } else { 0.0 });
        let even = even_a.zip(even_s);
        let extinction = self.curve(&sum, even.map(|(a, s)| a + s), scale);
        let albedo = self.curve(&fraction, even.map(|(a, s)| if a + s > 0.0 { s / (a + s) } else { 0.0 }), 1.0);
        let stated = parameters.number("g", 0.0)?;
        let g = stated.clamp(-0.99, 0.99);
        if g != stated {
            self.report.note(format!("g = {stated} of a medium is limited to {g}"));
        }
        self.known.media.insert(name.to_owned(), Homogeneous { extinction, albedo, g });
        Ok(())
    }

    /// Fills the world with the medium around the camera.
    pub(super) fn fill_air(&mut self, name: &str) {
        if !name.is_empty() {
            self.report.note(format!(
                "the medium \"{name}\" of the camera fills the whole scene and adds to the media of shapes in it"
            ));
            self.fill(name, MediumShape::Everywhere(UnboundedRegion::default()), Transform::default());
        }
    }
}
