//! The directive of surfaces that give light.

use super::parameters::Parameters;
use crate::scenery::{AreaLight, Scenery};

impl Scenery {
    /// `None` of one that is dark.
    pub(super) fn area_light(&mut self, kind: &str, parameters: Parameters<'_>) -> Result<Option<AreaLight>, String> {
        if kind != "diffuse" {
            self.report.note(format!("the area light \"{kind}\" is not understood and left out"));
            return Ok(None);
        }
        if parameters.find("filename").is_some() {
            self.report.note("the picture of an area light is not used: it is as bright everywhere");
        }
        let unit = self.light(parameters, "L")?;
        let luminance = parameters.number("scale", 1.0)? * unit.luminance;
        let power = parameters.numbers("power")?.and_then(|n| n.first().copied()).filter(|p| *p > 0.0);
        if luminance <= 0.0 {
            self.report.note("an area light is dark and left out");
            return Ok(None);
        }
        let two_sided = parameters.flag("twosided", false)?;
        Ok(Some(AreaLight { colour: unit.colour, luminance, flux: power.map(|lm| lm * luminance), two_sided }))
    }
}
