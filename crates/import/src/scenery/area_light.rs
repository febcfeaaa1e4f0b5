//! Light of surfaces.

use etendue_scene::record::material::Sides;
use etendue_scene::record::{Emission, Level, LightColour, SurfaceEmission};

/// The light of the shapes that follow.
#[derive(Clone, Debug)]
pub(crate) struct AreaLight {
    pub(crate) colour: LightColour,
    /// cd/m², of shapes without a flux.
    pub(crate) luminance: f64,
    /// Flux of each of pbrt's shapes, a triangle or a sphere, lm.
    pub(crate) flux: Option<f64>,
    pub(crate) two_sided: bool,
}

impl AreaLight {
    /// The emission of an object that is `count` of pbrt's shapes.
    pub(crate) fn emission(&self, count: usize) -> SurfaceEmission {
        let level = match self.flux {
            Some(lm) => Level::LuminousFlux((lm * count as f64).into()),
            None => Level::Luminance(self.luminance.into()),
        };
        let light = Emission { colour: Some(self.colour.clone()), ..Emission::new(level) };
        SurfaceEmission { sides: self.two_sided.then(|| Sides::Both.into()), ..SurfaceEmission::new(light) }
    }

    /// Whether it gives each of pbrt's shapes a flux.
    pub(crate) fn has_flux(&self) -> bool {
        self.flux.is_some()
    }
}
