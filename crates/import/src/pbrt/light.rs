//! Lights that are no surfaces.

use super::parameters::Parameters;
use crate::lamps;
use crate::scenery::{Graphics, Scenery};
use etendue_core::maths::f64 as maths;
use etendue_scene::record::{Emission, Environment, Level};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

impl Scenery {
    pub(super) fn light_source(
        &mut self,
        kind: &str,
        parameters: Parameters<'_>,
        graphics: &Graphics,
    ) -> Result<(), String> {
        let scale = parameters.number("scale", 1.0)?;
        if scale < 0.0 {
            return Err("\"scale\" below 0".to_owned());
        }
        match kind {
            "point" => self.point(parameters, graphics, scale),
            "spot" => self.spot(parameters, graphics, scale),
            "distant" => self.distant(parameters, graphics, scale),
            "infinite" => self.infinite(parameters, graphics, scale),
            other => {
                self.report.note(format!("the light \"{other}\" is not understood and left out"));
                parameters.0.iter().for_each(|p| p.used.set(true));
                Ok(())
            }
        }
    }

    /// `power`, where the file gives one, lm.
    fn power(parameters: Parameters<'_>) -> Result<Option<f64>, String> {
        Ok(parameters.numbers("power")?.and_then(|n| n.first().copied()).filter(|p| *p > 0.0))
    }

    fn point(&mut self, parameters: Parameters<'_>, graphics: &Graphics, scale: f64) -> Result<(), String> {
        let unit = self.light(parameters, "I")?;
        let from = DVec3::from_array(parameters.triple("from", [0.0; 3])?);
        let candela = Self::power(parameters)?.map_or(1.0, |lm| lm / (4.0 * PI)) * scale * unit.luminance;
        let Some(candela) = self.lit("point", "cd", candela) else { return Ok(()) };
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
        let ahead = (self.to_ours * (to - from)).try_normalize().ok_or("\"from\" and \"to\" are one point")?;
        let outer_deg = parameters.number("coneangle", 30.0)?;
        let inner_deg = outer_deg - parameters.number("conedeltaangle", 5.0)?;
        if !(0.0..=180.0).contains(&outer_deg) || outer_deg == 0.0 || !(0.0..=outer_deg).contains(&inner_deg) {
            return Err(format!("a cone from {inner_deg}° to {outer_deg}°; expected 0 ≤ inner ≤ outer ≤ 180"));
        }
        let [inner, outer] = [inner_deg, outer_deg].map(|a| maths::cos(a.to_radians()));
        let solid_angle = TAU * ((1.0 - inner) + 0.5 * (inner - outer));
        let candela = Self::power(parameters)?.map_or(1.0, |lm| lm / solid_angle) * scale * unit.luminance;
        let Some(candela) = self.lit("spot", "cd", candela) else { return Ok(()) };
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
        let towards = towards.try_normalize().ok_or("\"from\" and \"to\" are one point")?;
        let stated = parameters.numbers("illuminance")?.and_then(|n| n.first().copied()).filter(|e| *e > 0.0);
        let Some(lux) = self.lit("distant", "lx", stated.unwrap_or(1.0) * scale * unit.luminance) else {
            return Ok(());
        };
        let name = self.names.take("distant", "distant");
        self.scene.lights.push(lamps::parallel(&name, towards, lux, unit.colour));
        Ok(())
    }

    fn infinite(&mut self, parameters: Parameters<'_>, graphics: &Graphics, scale: f64) -> Result<(), String> {
        let lux = parameters.numbers("illuminance")?.and_then(|n| n.first().copied()).filter(|e| *e > 0.0);
        if parameters.find("portal").is_some() {
            self.report.note("a portal is not used: it changes noise alone");
        }
        let environment = match parameters.text("filename")? {
            Some(file) => {
                if lux.is_some() {
                    // Its sum over the upper half has 2π in the place of 4π.
                    self.report
                        .note("\"illuminance\" of a picture of light is lx; pbrt-v4 itself makes it twice as much");
                }
                self.environment(file, graphics, scale, lux)?
            }
            None => {
                let unit = self.light(parameters, "L")?;
                let level = lux.map_or(1.0, |lux| lux / PI) * scale * unit.luminance;
                let Some(level) = self.lit("infinite", "cd/m²", level) else { return Ok(()) };
                let emission = Emission::new(Level::Luminance(level.into()));
                Some(Environment::Uniform(Emission { colour: Some(unit.colour), ..emission }))
            }
        };
        let Some(environment) = environment else { return Ok(()) };
        if self.scene.environment.replace(environment).is_some() {
            self.report.note("of several lights from infinity only the last is used");
        }
        Ok(())
    }

    /// Notes a light; `None` of one that is dark.
    fn lit(&mut self, kind: &str, unit: &str, level: f64) -> Option<f64> {
        if level > 0.0 && level.is_finite() {
            self.report.note(format!("light \"{kind}\": {level} {unit}"));
            return Some(level);
        }
        self.report.note(format!("a light \"{kind}\" is dark and left out"));
        None
    }
}
