//! How the light of a camera is found.

use super::wavelength_sampling::WavelengthSampling;
use crate::sizes::block::Blocks;
use crate::sizes::tolerance::AdaptiveSampling;
use etendue_core::{Bands, WavelengthRange};
use etendue_optics::PupilProjection;
use etendue_tracer::integrator::{Level, LightSampling};

/// The way to the sensor plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one a camera, and settings that hold it stay Copy")]
pub enum Route {
    /// Every sample goes through the lens.
    Lens,
    /// Radiance at the centre of the entrance pupil in this geometry, then the lens on the picture.
    Pupil(PupilProjection),
}

/// How the light of a camera is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Samples a pixel; the most that a pixel gets where noise decides.
    pub spp: u32,
    /// Where noise decides how many samples a pixel gets.
    pub adaptive: Option<AdaptiveSampling>,
    /// Independent replicates; divides `spp`.
    pub replicates: u32,
    /// How much of the light's ways is followed.
    pub level: Level,
    /// Greatest number of scattering events; 1 where no paths are traced.
    pub max_bounces: u32,
    /// Whether caustics of lamps are followed.
    pub caustics: bool,
    /// Whether lobes are widened that come after wider ones; of paths only.
    pub regularize: bool,
    /// Whether matt surfaces draw directions by what paths before the picture have found; of paths only.
    pub guiding: bool,
    /// How many paths go on, and lights are drawn, at the first surface; 1 where no paths are traced.
    pub branches: u32,
    /// What lights are drawn by.
    pub light_sampling: LightSampling,
    /// Wavelengths a path: 1, 4 or 8.
    pub wavelengths: u32,
    /// The density by which they are drawn; evenly where no electrons are summed.
    pub wavelength_sampling: WavelengthSampling,
    /// The way to the sensor plane.
    pub route: Route,
    /// Wavelengths sampled.
    pub range: WavelengthRange,
    /// Spectral bands, where a cube is kept.
    pub bands: Option<Bands>,
    /// Whether pixels fold their responsivity into electrons.
    pub folded: bool,
    /// Side of a tile, px.
    pub tile_px: u32,
    /// Pixels whose paths share their tails.
    pub blocks: Blocks,
    /// Seed of every random number.
    pub seed: u64,
}
