//! Media.

use super::access::{all, number};
use super::importer::Importer;
use crate::scenery::Homogeneous;
use crate::syntax::mitsuba::MitsubaElement;
use etendue_io::Error;
use std::rc::Rc;

impl<'a> Importer<'a> {
    /// The name of a medium; empty where it is not understood.
    pub(super) fn medium(&mut self, element: &'a MitsubaElement) -> Result<Rc<str>, Error> {
        if let Some(known) = self.media.get(&element.number) {
            return Ok(known.clone());
        }
        self.at(element);
        let kind = element.kind();
        let name: Rc<str> = match kind {
            "homogeneous" => self.homogeneous(element)?,
            _ => {
                let told = format!("the medium \"{kind}\" is not understood and left out: expected homogeneous");
                self.scenery.report.note(told);
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
            return Err(element.fault("a medium without \"sigma_t\" or \"scale\" above 0"));
        }
        let extinction = self.scenery.curve(&extinction, even, scale);
        let (albedo, even) = self.coefficient(element, "albedo", 0.75)?;
        let albedo = self.scenery.curve(&albedo, even, 1.0);
        let stated = match all(element, "phase").next() {
            Some(phase) if phase.kind() == "hg" => number(phase, "g", 0.8)?,
            Some(phase) if phase.kind() != "isotropic" => {
                self.scenery.report.note(format!("the phase function \"{}\" is taken as isotropic", phase.kind()));
                0.0
            }
            _ => 0.0,
        };
        let g = stated.clamp(-0.99, 0.99);
        if g != stated {
            self.scenery.report.note(format!("a medium of g = {stated} is one of {g}"));
        }
        let name: Rc<str> = format!("{}#{}", element.attribute("id").unwrap_or("medium"), element.number).into();
        self.scenery.known.media.insert(name.to_string(), Homogeneous { extinction, albedo, g });
        Ok(name)
    }
}
