//! Media.

use super::known::Homogeneous;
use super::parameters::Parameters;
use super::scenery::Scenery;
use etendue_scene::record::medium::{Everywhere, Extinction, HenyeyGreenstein, Isotropic, MediumShape, Phase};
use etendue_scene::record::{Medium, Transform};
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

    /// Fills a part of the world with a medium; nothing where the name is empty or not understood.
    pub(super) fn fill(&mut self, name: &str, shape: MediumShape, transform: Transform) {
        let Some(Homogeneous { extinction, albedo, g }) = self.known.media.get(name).cloned() else {
            self.report.note(format!("a part of the world has no medium: \"{name}\" is not there or not understood"));
            return;
        };
        let phase = match g {
            0.0 => Phase::Isotropic(Isotropic::default()),
            g => Phase::HenyeyGreenstein(HenyeyGreenstein::new(g)),
        };
        let own = self.names.take(name, "medium");
        self.scene.media.push(Medium {
            albedo: Some(albedo),
            phase: Some(phase),
            shape: Some(shape),
            ..Medium::new(own.as_str(), Extinction::PerMetre(extinction), transform)
        });
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
