//! Media.

use super::parameters::Parameters;
use crate::scenery::{Homogeneous, Scenery};
use etendue_scene::record::Transform;
use etendue_scene::record::medium::{Everywhere, MediumShape};
use etendue_spectra::Spectrum;

impl Scenery {
    pub(super) fn medium(&mut self, name: &str, parameters: Parameters<'_>) -> Result<(), String> {
        let kind = parameters.text("type")?.unwrap_or_default();
        if kind != "homogeneous" {
            self.report
                .note(format!("the medium \"{name}\" ({kind}) is not understood and left out: expected homogeneous"));
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
        let share = Spectrum::from_fn(|nm| if at(&sum, nm) > 0.0 { at(&scattered, nm) / at(&sum, nm) } else { 0.0 });
        let even = even_a.zip(even_s);
        let extinction = self.curve(&sum, even.map(|(a, s)| a + s), scale);
        let albedo = self.curve(&share, even.map(|(a, s)| if a + s > 0.0 { s / (a + s) } else { 0.0 }), 1.0);
        let stated = parameters.number("g", 0.0)?;
        let g = stated.clamp(-0.99, 0.99);
        if g != stated {
            self.report.note(format!("a medium of g = {stated} is one of {g}"));
        }
        self.known.media.insert(name.to_owned(), Homogeneous { extinction, albedo, g });
        Ok(())
    }

    /// The medium that the camera stands in.
    pub(super) fn fill_air(&mut self, name: &str) {
        if !name.is_empty() {
            self.report.note(format!(
                "the camera's medium \"{name}\" fills the whole world, and adds to those of shapes within it"
            ));
            self.fill(name, MediumShape::Everywhere(Everywhere::default()), Transform::default());
        }
    }
}
