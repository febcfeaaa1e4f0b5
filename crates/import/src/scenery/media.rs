//! Media in parts of the world.

use super::known::Homogeneous;
use super::stage::Scenery;
use etendue_scene::record::medium::{Extinction, HenyeyGreenstein, Isotropic, MediumShape, Phase};
use etendue_scene::record::{Medium, Transform};

impl Scenery {
    /// Fills a part of the world with a medium; nothing where the name is empty or not understood.
    pub(crate) fn fill(&mut self, name: &str, shape: MediumShape, transform: Transform) {
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
}
