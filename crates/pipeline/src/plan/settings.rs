//! Render settings of a camera.

use super::wavelength_sampling::{SpectralGain, WavelengthSampling};
use crate::sizes::block::Blocks;
use crate::sizes::tolerance::AdaptiveSampling;
use etendue_core::{Bands, Integrator, WavelengthRange};
use etendue_optics::PupilProjection;
use etendue_tracer::integrator::PathSettings;
use serde::ser::{Serialize, SerializeMap as _, Serializer};

/// Route to the sensor plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one a camera, and settings that hold it stay Copy")]
pub enum Route {
    /// Each sample passes through the lens.
    Lens,
    /// Radiance at the centre of the entrance pupil in this projection; the lens is then applied to the image.
    Pupil(PupilProjection),
}

/// Render settings of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Samples per pixel; with noise-limited sampling the maximum.
    pub spp: u32,
    /// Limits of noise-limited sampling; `None` without it.
    pub adaptive: Option<AdaptiveSampling>,
    /// Independent replicates; divides `spp`.
    pub replicates: u32,
    /// Light paths that are simulated; settings of a single pass of a render have their defaults.
    pub paths: PathSettings,
    /// If true, directions at diffuse surfaces are sampled by the results of paths before the image (path guiding); only for paths.
    pub guiding: bool,
    /// Wavelengths per path: 1, 4 or 8.
    pub wavelengths: u32,
    /// Density of their sampling; uniform if no electrons are accumulated.
    pub wavelength_sampling: WavelengthSampling,
    /// Estimated gain of including the spectra of the light's sources in the density of wavelengths; `None` if no electrons are accumulated or no source
    /// contributes.
    pub spectral_gain: Option<SpectralGain>,
    /// Route to the sensor plane.
    pub route: Route,
    /// Wavelengths sampled.
    pub range: WavelengthRange,
    /// Spectral bands, if a cube is stored.
    pub bands: Option<Bands>,
    /// True if pixels weight radiance by their responsivity and accumulate electrons.
    pub accumulates_electrons: bool,
    /// Side of a tile, px.
    pub tile_px: u32,
    /// Blocks of pixels whose paths share their tails.
    pub blocks: Blocks,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Settings {
    /// Returns true if paths are traced.
    #[must_use]
    pub fn traces_paths(&self) -> bool {
        self.paths.integrator == Integrator::Path
    }
}

/// Serialises the settings by their keys in a description, with derived values: the single list for reports and side-cars.
impl Serialize for Settings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for setting in self.paths.stated() {
            map.serialize_entry(setting.key, &setting.value)?;
        }
        map.serialize_entry("guiding", &self.guiding)?;
        map.serialize_entry("spp", &self.spp)?;
        map.serialize_entry("min_spp", &self.adaptive.map(|limit| limit.min_spp))?;
        map.serialize_entry("noise_threshold", &self.adaptive.map(|limit| limit.threshold))?;
        map.serialize_entry("replicates", &self.replicates)?;
        map.serialize_entry("pixels_sharing_paths", &self.blocks.len_px())?;
        map.serialize_entry("wavelengths_per_path", &self.wavelengths)?;
        map.serialize_entry("wavelength_density", self.wavelength_sampling.word())?;
        map.serialize_entry("spectral_gain", &self.spectral_gain)?;
        map.serialize_entry("route", self.route.word())?;
        map.serialize_entry("wavelength_range_nm", &[self.range.low_nm, self.range.high_nm])?;
        map.serialize_entry("bands", &self.bands.map(Bands::count))?;
        map.serialize_entry("band_width_nm", &self.bands.map(Bands::width_nm))?;
        map.serialize_entry("sums_electrons", &self.accumulates_electrons)?;
        map.serialize_entry("seed", &self.seed)?;
        map.end()
    }
}

impl Route {
    /// Value of the key `route`.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Lens => "lens",
            Self::Pupil(_) => "pupil",
        }
    }
}
