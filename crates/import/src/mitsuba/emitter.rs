//! Lights that are no surfaces.

use super::access::{find, number, vector};
use super::importer::Importer;
use super::transform::transform_of;
use crate::lamps;
use crate::syntax::mitsuba::MitsubaElement;
use etendue_io::Error;
use etendue_scene::record::{Emission, Environment, Level};
use glam::DVec3;

impl<'a> Importer<'a> {
    pub(super) fn emitter(&mut self, element: &'a MitsubaElement) -> Result<(), Error> {
        let kind = element.kind();
        match kind {
            "point" => self.point(element)?,
            "spot" => self.spot(element)?,
            "directional" => self.directional(element)?,
            "constant" => {
                let unit = self.light(element, "radiance")?;
                if let Some(level) = self.lit(kind, "cd/m²", unit.luminance) {
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
                self.scenery.report.note(format!("the emitter \"{other}\" is not understood and left out"));
                element.children.iter().for_each(|child| child.used.set(true));
            }
        }
        self.note_unused(element);
        Ok(())
    }

    fn surround(&mut self, environment: Environment) {
        if self.scenery.scene.environment.replace(environment).is_some() {
            self.scenery.report.note("of several lights from infinity only the last is used");
        }
    }

    /// Notes a light; `None` of one that is dark.
    fn lit(&mut self, kind: &str, unit: &str, level: f64) -> Option<f64> {
        if level > 0.0 {
            self.scenery.report.note(format!("emitter \"{kind}\": {level} {unit}"));
            return Some(level);
        }
        self.scenery.report.note(format!("an emitter \"{kind}\" is dark and left out"));
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
        let Some(candela) = self.lit("point", "cd", unit.luminance) else { return Ok(()) };
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
            let told = format!("a cone from {inner_deg}° to {outer_deg}°; expected 0 ≤ beam ≤ cutoff ≤ 180");
            return Err(element.fault(told));
        }
        let Some(candela) = self.lit("spot", "cd", unit.luminance) else { return Ok(()) };
        self.scenery.report.note("the edge of a spot falls by our own curve between the same angles");
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
        let towards = towards.ok_or_else(|| element.fault("a \"direction\" without length"))?;
        let Some(lux) = self.lit("directional", "lx, a sun's disc of 0.01°", unit.luminance) else { return Ok(()) };
        let name = self.name(element);
        self.scenery.scene.lights.push(lamps::parallel(&name, towards, lux, unit.colour));
        Ok(())
    }
}
