//! The path tracer: spectral radiance along a ray.
//!
//! Unidirectional paths from the camera (Kajiya 1986). At each vertex a light is drawn and asked (next-event
//! estimation), then the surface draws where the path goes on; light found in both ways is weighed by its densities
//! (multiple importance sampling). Paths end at random in proportion to what they still carry (Russian roulette), which
//! leaves the mean unchanged. Nothing is clamped.
//!
//! `max_bounces` is the greatest number of scattering events between a light and the camera: 0 shows only what
//! glows, 1 adds direct light, 2 light that was scattered twice. Beside the filtering of textures it is the only bias, and it is
//! darkness.
//!
//! All wavelengths of a path share its directions, drawn by densities common to them.

mod caustic;
mod cone;
mod level;
mod medium;
mod mis;
mod path;
mod shadow;
mod shared;
mod surroundings;

#[cfg(test)]
mod tests;

pub use level::Level;
pub use mis::Strategies;
pub use surroundings::Surroundings;

use etendue_core::random::PathStream;
use etendue_core::{FieldRay, RadianceField, Ray, Spectral, Wavelengths};

use crate::lights::Lights;
use crate::materials::MaterialTable;
use crate::view::View;
use medium::Medium;
use path::Path;

/// How paths are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// How much of light transport is followed.
    pub level: Level,
    /// Greatest number of scattering events; of the level [`Level::Path`] alone.
    pub max_bounces: u32,
    /// Scattering events after which paths may end at random.
    pub roulette_start: u32,
    /// Samples of a replicate: paths that share their tails take turns over them.
    pub samples: u32,
    /// Full angle of the cone that a camera ray stands for, rad: that of a pixel over the root of its samples. Chooses the
    /// resolution of textures.
    pub cone_spread_rad: f32,
    /// Which ways of finding light are used.
    pub strategies: Strategies,
    /// Whether light of suns and glowing surfaces that smooth surfaces throw on matt ones is followed (`caustic.rs`).
    /// Without it the picture is darker by that light, and free of the rare bright samples that find it.
    pub caustics: bool,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            level: Level::Path,
            max_bounces: 16,
            roulette_start: 4,
            samples: 1,
            cone_spread_rad: 0.0,
            strategies: Strategies::Both,
            caustics: true,
        }
    }
}

/// Answers rays of a view with spectral radiance.
#[derive(Clone, Copy, Debug)]
pub struct PathTracer<'a> {
    view: &'a View<'a>,
    material_table: &'a MaterialTable,
    lights: &'a Lights,
    settings: PathSettings,
    /// What the entrance pupil lies in: paths begin there.
    medium: Medium<'a>,
}

impl<'a> PathTracer<'a> {
    /// A path tracer of a view with the materials that its instances name; `lights` must be collected from the same
    /// view and material_table.
    #[must_use]
    pub fn new(
        view: &'a View<'a>,
        material_table: &'a MaterialTable,
        lights: &'a Lights,
        settings: PathSettings,
    ) -> Self {
        let solid = Surroundings::of(view, material_table).solid;
        let medium = Medium::inside(solid.and_then(|id| material_table.absorption(id)));
        Self { view, material_table, lights, settings, medium }
    }

    /// How paths are followed.
    #[must_use]
    pub fn settings(&self) -> &PathSettings {
        &self.settings
    }

    /// Scattering events that a path may have.
    fn max_bounces(&self) -> u32 {
        match self.settings.level {
            Level::Flat | Level::Direct => 1,
            Level::Path => self.settings.max_bounces,
        }
    }

    /// The lights.
    #[must_use]
    pub fn lights(&self) -> &'a Lights {
        self.lights
    }
}

impl<const N: usize> RadianceField<N> for PathTracer<'_> {
    fn radiance(&self, ray: &Ray, wavelengths: &Wavelengths<N>, stream: &PathStream) -> Spectral<N> {
        Path::new(self, ray, wavelengths, stream).follow()
    }

    fn radiance_of_group(&self, rays: &[FieldRay], wavelengths: &Wavelengths<N>, radiance: &mut Vec<Spectral<N>>) {
        if rays.len() > 1 && self.shares() {
            self.radiance_shared(rays, wavelengths, radiance);
        } else {
            radiance.extend(rays.iter().map(|FieldRay { ray, stream }| self.radiance(ray, wavelengths, stream)));
        }
    }
}
