//! Lights of UsdLux.

use std::{f64::consts::PI, rc::Rc};

use etendue_core::maths::f64 as maths;
use etendue_scene::record::{Light, LightColour};
use glam::{DAffine3, DMat3, DVec3};

use super::access::{flag, number};
use super::importer::{Importer, TraversalState};
use super::shape::{axis_rotation, cylinder};
use crate::scenery::{AreaLight, Graphics, LightUnit};
use crate::{lamps, syntax::usd::UsdPrim};

/// Minimum angular diameter of parallel light, degrees.
const PARALLEL_DEG: f64 = 0.01;
/// Maximum angular diameter of a sun, degrees.
const MAX_SUN_DEG: f64 = 20.0;

impl<'a> Importer<'a> {
    pub(super) fn light(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>) -> Result<(), String> {
        let message = |what: String| format!("{}: {what}", prim.path);
        let usual = if prim.kind == "DistantLight" { 50_000.0 } else { 1.0 };
        let kinds =
            ["DistantLight", "SphereLight", "DiskLight", "RectLight", "CylinderLight", "DomeLight", "DomeLight_1"];
        if !kinds.contains(&prim.kind.as_str()) {
            super::access::mark_used(prim);
            self.scenery.report.note(format!("a \"{}\" is not supported and left out", prim.kind));
            return Ok(());
        }
        let Some(unit) = self.light_unit(prim, usual) else { return Ok(()) };
        let is_divided = flag(prim, "inputs:normalize", false);
        match prim.kind.as_str() {
            "DistantLight" => {
                self.distant(prim, state, unit, is_divided);
                return Ok(());
            }
            "DomeLight" | "DomeLight_1" => return self.dome(prim, state, unit).map_err(message),
            _ => {}
        }
        let cone = cone_of(prim);
        match (cone, prim.kind.as_str()) {
            (Some(cone), "SphereLight") => {
                let candela = self.candela(prim, state, unit.luminance);
                self.spot(prim, state, cone, candela, unit.colour);
                return Ok(());
            }
            (Some(_), _) => {
                self.scenery
                    .report
                    .note(format!("the cone of a {} is not used: it emits in all directions", prim.kind));
            }
            (None, "SphereLight") if flag(prim, "treatAsPoint", false) || number(prim, "inputs:radius", 0.5) <= 0.0 => {
                let candela = self.candela(prim, state, unit.luminance);
                self.point(prim, state, candela, unit.colour);
                return Ok(());
            }
            (None, _) => {}
        }
        let area = area_of(prim, self.scales(state));
        let luminance = if is_divided && area > 0.0 { unit.luminance / area } else { unit.luminance };
        self.area(prim, state, LightUnit { luminance, ..unit }).map_err(message)
    }

    /// Lengths of a light's axes in the stage's unit.
    fn scales(&self, state: &TraversalState<'a>) -> [f64; 3] {
        let m = state.to_world.matrix3;
        [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.length() / self.stage.metres_per_unit)
    }

    /// Adds an emissive surface with a black BSDF.
    fn area(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>, unit: LightUnit) -> Result<(), String> {
        self.scenery.report.note(format!("{}: {} cd/m²", prim.kind, unit.luminance));
        if super::access::asset(prim, "inputs:texture:file").is_some() {
            self.scenery.report.note("the texture of a RectLight is not used: it is a uniform white of 1");
        }
        let light = AreaLight { colour: unit.colour, luminance: unit.luminance, flux: None, two_sided: false };
        let graphics = Graphics {
            to_world: state.to_world,
            name: Self::name(prim),
            material: self.scenery.black(),
            area_light: Some(Rc::new(light)),
            ..Graphics::plain()
        };
        // Flat lights emit towards −z.
        let turned = DAffine3::from_mat3(DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)));
        let flat = Graphics { to_world: state.to_world * turned, ..graphics.clone() };
        self.shines = true;
        match prim.kind.as_str() {
            "SphereLight" => self.round(number(prim, "inputs:radius", 0.5), &graphics),
            "DiskLight" => self.scenery.whole_disc(number(prim, "inputs:radius", 0.5).abs(), 0.0, &flat),
            "RectLight" => {
                let size = ["inputs:width", "inputs:height"].map(|name| number(prim, name, 1.0).abs());
                self.scenery.quad(size, &flat);
            }
            _ => {
                let radius = number(prim, "inputs:radius", 0.5).abs();
                let tube = cylinder([radius; 2], number(prim, "inputs:length", 1.0).abs(), false);
                let along = DAffine3::from_mat3(axis_rotation("X"));
                self.add(tube, &Graphics { to_world: state.to_world * along, ..graphics })?;
            }
        }
        self.extend_bounds(state.to_world.translation);
        self.scenery.check_size()
    }

    /// Intensity of a sphere of this luminance from afar, cd: L π r². With "normalize", which divides by its surface 4 π r², a quarter of L unit², whatever its
    /// radius.
    fn candela(&self, prim: &UsdPrim, state: &TraversalState<'a>, luminance: f64) -> f64 {
        if flag(prim, "inputs:normalize", false) {
            let _ = number(prim, "inputs:radius", 0.5);
            return 0.25 * luminance * self.stage.metres_per_unit * self.stage.metres_per_unit;
        }
        let radius = number(prim, "inputs:radius", 0.5);
        let scale = maths::cbrt(self.scales(state).iter().product::<f64>()) * self.stage.metres_per_unit;
        luminance * PI * (radius * scale) * (radius * scale)
    }

    fn point(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>, candela: f64, colour: LightColour) {
        if candela <= 0.0 {
            self.note_dark_point();
            return;
        }
        self.scenery.report.note(format!("SphereLight as a point: {candela} cd"));
        let name = self.scenery.names.take(prim.name(), "light");
        let position = self.scenery.to_ours * state.to_world.translation;
        self.scenery.scene.lights.push(lamps::point(&name, position, candela, colour));
    }

    fn spot(
        &mut self,
        prim: &'a UsdPrim,
        state: &TraversalState<'a>,
        cone: [f64; 2],
        candela: f64,
        colour: LightColour,
    ) {
        if candela <= 0.0 {
            self.note_dark_point();
            return;
        }
        let [inner_deg, outer_deg] = cone;
        self.scenery.report.note(format!(
            "SphereLight with a cone of {outer_deg}° becomes a point-like spot of {candela} cd; its falloff from {inner_deg}° follows Étendue's curve"
        ));
        let name = self.scenery.names.take(prim.name(), "light");
        let ahead = (self.scenery.to_ours * -state.to_world.matrix3.z_axis).normalize_or(DVec3::X);
        let position = self.scenery.to_ours * state.to_world.translation;
        self.scenery.scene.lights.push(lamps::spot(&name, position, ahead, cone, candela, colour));
    }

    fn note_dark_point(&mut self) {
        self.scenery
            .report
            .note("a SphereLight without a radius and without \"normalize\" emits no light and is left out");
    }

    /// Disc at infinity: its illuminance is its luminance times its projected solid angle.
    fn distant(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>, unit: LightUnit, is_divided: bool) {
        let angle_deg = number(prim, "inputs:angle", 0.53).clamp(0.0, 360.0);
        let half = maths::sin(0.5 * angle_deg.min(180.0).to_radians());
        let lux = if is_divided || half == 0.0 { unit.luminance } else { unit.luminance * PI * half * half };
        let disc_deg = angle_deg.clamp(PARALLEL_DEG, MAX_SUN_DEG);
        self.scenery.report.note(format!("DistantLight: {lux} lx, a sun disc of {disc_deg}°"));
        if angle_deg > MAX_SUN_DEG {
            self.scenery.report.note(format!("the disc {angle_deg}° of a DistantLight is limited to {MAX_SUN_DEG}°"));
        }
        let name = self.scenery.names.take(prim.name(), "light");
        let from = (self.scenery.to_ours * state.to_world.matrix3.z_axis).normalize_or(DVec3::Z);
        let mut light = lamps::parallel(&name, from, lux, unit.colour);
        if let Light::Sun(sun) = &mut light {
            sun.angular_diameter_deg = Some(disc_deg.into());
        }
        self.scenery.scene.lights.push(light);
    }
}

/// Area of a light's surface, in the stage's unit, from the lengths of its axes.
fn area_of(prim: &UsdPrim, [x, y, z]: [f64; 3]) -> f64 {
    let radius = number(prim, "inputs:radius", 0.5);
    match prim.kind.as_str() {
        "RectLight" => number(prim, "inputs:width", 1.0) * x * number(prim, "inputs:height", 1.0) * y,
        "DiskLight" => PI * radius * radius * x * y,
        "CylinderLight" => 2.0 * PI * radius * (y * z).sqrt() * number(prim, "inputs:length", 1.0) * x,
        _ => 4.0 * PI * radius * radius * maths::cbrt(x * y * z) * maths::cbrt(x * y * z),
    }
}

/// Angles of a light's cone from its axis, degrees: start and end of the falloff; `None` for a light without a cone.
fn cone_of(prim: &UsdPrim) -> Option<[f64; 2]> {
    let outer_deg = number(prim, "inputs:shaping:cone:angle", 90.0);
    let softness = number(prim, "inputs:shaping:cone:softness", 0.0).clamp(0.0, 1.0);
    (prim.has_schema("ShapingAPI") && outer_deg > 0.0 && outer_deg < 90.0)
        .then_some([outer_deg * (1.0 - softness), outer_deg])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::usd::{UsdAttribute, UsdValue};

    #[test]
    fn areas_are_those_of_the_world() {
        let value = |v| UsdAttribute { value: Some(UsdValue::Number(v)), ..UsdAttribute::default() };
        let attributes = [("inputs:radius", 2.0), ("inputs:length", 3.0), ("inputs:width", 4.0)];
        let prim = |kind: &str| UsdPrim {
            path: "/a".to_owned(),
            kind: kind.to_owned(),
            attributes: attributes.iter().map(|(name, v)| ((*name).to_owned(), value(*v))).collect(),
            ..UsdPrim::default()
        };
        let near = |kind: &str, expected: f64| assert!((area_of(&prim(kind), [2.0; 3]) / expected - 1.0).abs() < 1e-12);
        near("RectLight", 8.0 * 2.0);
        near("DiskLight", 16.0 * PI);
        near("SphereLight", 64.0 * PI);
        near("CylinderLight", 2.0 * PI * 4.0 * 6.0);
    }
}
