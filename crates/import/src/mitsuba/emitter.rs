//! Lights that are not surfaces, environment maps included, and media.

use std::rc::Rc;

use etendue_io::{Error, picture::read_image};
use etendue_scene::record::{Emission, Environment, Level};
use glam::{DMat3, DVec3};

use super::access::{all, find, number, text, vector};
use super::{importer::Importer, transform::transform_of};
use crate::scenery::{Homogeneous, LightImage, linear_pixels};
use crate::{lamps, syntax::mitsuba::MitsubaElement};

impl<'a> Importer<'a> {
    pub(super) fn emitter(&mut self, element: &'a MitsubaElement) -> Result<(), Error> {
        let kind = element.kind();
        match kind {
            "point" => self.point(element)?,
            "spot" => self.spot(element)?,
            "directional" => self.directional(element)?,
            "constant" => {
                let unit = self.light(element, "radiance")?;
                if let Some(level) = self.note_light(kind, "cd/m²", unit.luminance) {
                    let emission = Emission::new(Level::Luminance(level.into()));
                    let emission = Emission { colour: Some(unit.colour), ..emission };
                    self.surround(Environment::Uniform(emission));
                }
            }
            "envmap" => {
                if let Some(environment) = self.envmap(element)? {
                    self.surround(environment);
                }
            }
            other => {
                self.scenery.report.note(format!("the emitter \"{other}\" is not supported and left out"));
                element.children.iter().for_each(|child| child.used.set(true));
            }
        }
        self.note_unused(element);
        Ok(())
    }

    fn surround(&mut self, environment: Environment) {
        if self.scenery.scene.environment.replace(environment).is_some() {
            self.scenery.report.note("of several environment lights only the last is used");
        }
    }

    /// Notes a light; `None` for a dark one.
    fn note_light(&mut self, kind: &str, unit: &str, level: f64) -> Option<f64> {
        if level > 0.0 {
            self.scenery.report.note(format!("emitter \"{kind}\": {level} {unit}"));
            return Some(level);
        }
        self.scenery.report.note(format!("an emitter \"{kind}\" emits no light and is left out"));
        None
    }

    fn name(&mut self, element: &MitsubaElement) -> String {
        self.scenery.names.take(element.attribute("id").unwrap_or(element.kind()), "light")
    }

    fn point(&mut self, element: &'a MitsubaElement) -> Result<(), Error> {
        let unit = self.light(element, "intensity")?;
        let to_world = transform_of(element, "to_world")?;
        let position = match find(element, "position") {
            Some(_) => vector(element, "position", DVec3::ZERO)?,
            None => to_world.translation,
        };
        let Some(candela) = self.note_light("point", "cd", unit.luminance) else { return Ok(()) };
        let name = self.name(element);
        self.scenery.scene.lights.push(lamps::point(&name, self.scenery.to_ours * position, candela, unit.colour));
        Ok(())
    }

    fn spot(&mut self, element: &'a MitsubaElement) -> Result<(), Error> {
        let unit = self.light(element, "intensity")?;
        let to_world = transform_of(element, "to_world")?;
        let outer_deg = number(element, "cutoff_angle", 20.0)?;
        let inner_deg = number(element, "beam_width", 0.75 * outer_deg)?;
        if !(0.0..=180.0).contains(&outer_deg) || outer_deg == 0.0 || !(0.0..=outer_deg).contains(&inner_deg) {
            let message = format!("the cone is from {inner_deg}° to {outer_deg}°; expected 0 ≤ beam ≤ cutoff ≤ 180");
            return Err(element.error(message));
        }
        let Some(candela) = self.note_light("spot", "cd", unit.luminance) else { return Ok(()) };
        self.scenery.report.note("the falloff of a spot follows Étendue's curve between the same angles");
        let name = self.name(element);
        let ahead = (self.scenery.to_ours * to_world.matrix3.z_axis).normalize_or(DVec3::X);
        let pose = (self.scenery.to_ours * to_world.translation, ahead);
        self.scenery.scene.lights.push(lamps::spot(
            &name,
            pose.0,
            pose.1,
            [inner_deg, outer_deg],
            candela,
            unit.colour,
        ));
        Ok(())
    }

    fn directional(&mut self, element: &'a MitsubaElement) -> Result<(), Error> {
        let unit = self.light(element, "irradiance")?;
        let to_world = transform_of(element, "to_world")?;
        let ahead = vector(element, "direction", to_world.matrix3.z_axis)?;
        let towards = (self.scenery.to_ours * -ahead).try_normalize();
        let towards = towards.ok_or_else(|| element.error("\"direction\" has zero length"))?;
        let Some(lux) = self.note_light("directional", "lx, a sun disc of 0.01°", unit.luminance) else {
            return Ok(());
        };
        let name = self.name(element);
        self.scenery.scene.lights.push(lamps::parallel(&name, towards, lux, unit.colour));
        Ok(())
    }
}

/// Rotation from Mitsuba's environment-map space to ours: its middle column is seen along +z and its upper edge is +y.
fn image_axes() -> DMat3 {
    DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X)
}

impl<'a> Importer<'a> {
    /// `None`, with a note, for an unsupported or dark image.
    fn envmap(&mut self, element: &'a MitsubaElement) -> Result<Option<Environment>, Error> {
        let file = text(element, "filename")?.ok_or_else(|| element.error("the envmap has no \"filename\""))?;
        let scale = number(element, "scale", 1.0)?;
        if scale <= 0.0 {
            self.scenery.report.note("an emitter \"envmap\" emits no light and is left out");
            return Ok(None);
        }
        let to_world = transform_of(element, "to_world")?.matrix3;
        let to_world = DMat3::from_cols(
            to_world.x_axis.normalize_or_zero(),
            to_world.y_axis.normalize_or_zero(),
            to_world.z_axis.normalize_or_zero(),
        );
        let image = read_image(&self.file(file)).map_err(|e| element.error(e.to_string()))?.in_rec_709();
        let Some(pixel) = linear_pixels(&image) else {
            let message = format!("the environment map `{file}` is left out: expected linear values (EXR, HDR)");
            self.scenery.report.note(message);
            return Ok(None);
        };
        // Transform from our environment-map space, by Mitsuba's, to our world.
        let turn = self.scenery.to_ours * to_world * image_axes().transpose();
        let path = self.path(file);
        let picture = LightImage { shown: file, path: &path, columns: image.width as usize, pixel: &*pixel };
        let result = self.scenery.light_image(&picture, image.height as usize, turn, scale);
        result.map(Some).map_err(|message| element.error(message))
    }
}

impl<'a> Importer<'a> {
    /// Name of a medium; empty if it is not supported.
    pub(super) fn medium(&mut self, element: &'a MitsubaElement) -> Result<Rc<str>, Error> {
        if let Some(known) = self.media.get(&element.number) {
            return Ok(known.clone());
        }
        self.at(element);
        let kind = element.kind();
        let name: Rc<str> = match kind {
            "homogeneous" => self.homogeneous(element)?,
            _ => {
                let message = format!("the medium \"{kind}\" is not supported and left out: expected homogeneous");
                self.scenery.report.note(message);
                element.children.iter().for_each(|child| child.used.set(true));
                "".into()
            }
        };
        self.note_unused(element);
        self.media.insert(element.number, name.clone());
        Ok(name)
    }

    fn homogeneous(&mut self, element: &'a MitsubaElement) -> Result<Rc<str>, Error> {
        let scale = number(element, "scale", 1.0)?;
        let (extinction, even) = self.coefficient(element, "sigma_t", 1.0)?;
        if scale < 0.0 || !(300..=1100).step_by(100).any(|nm| extinction.at(nm as f32) > 0.0) {
            return Err(element.error("the medium needs \"sigma_t\" and \"scale\" above 0"));
        }
        let extinction = self.scenery.curve(&extinction, even, scale);
        let (albedo, even) = self.coefficient(element, "albedo", 0.75)?;
        let albedo = self.scenery.curve(&albedo, even, 1.0);
        let stated = match all(element, "phase").next() {
            Some(phase) if phase.kind() == "hg" => number(phase, "g", 0.8)?,
            Some(phase) if phase.kind() != "isotropic" => {
                self.scenery
                    .report
                    .note(format!("the phase function \"{}\" is replaced by an isotropic one", phase.kind()));
                0.0
            }
            _ => 0.0,
        };
        let g = stated.clamp(-0.99, 0.99);
        if g != stated {
            self.scenery.report.note(format!("g = {stated} of a medium is limited to {g}"));
        }
        let name: Rc<str> = format!("{}#{}", element.attribute("id").unwrap_or("medium"), element.number).into();
        self.scenery.known.media.insert(name.to_string(), Homogeneous { extinction, albedo, g });
        Ok(name)
    }
}
