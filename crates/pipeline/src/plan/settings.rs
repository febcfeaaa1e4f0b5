//! How the light of a camera is found.

use super::wavelength_sampling::{SpectralGain, WavelengthSampling};
use crate::sizes::block::Blocks;
use crate::sizes::tolerance::AdaptiveSampling;
use etendue_core::{Bands, Integrator, WavelengthRange};
use etendue_optics::PupilProjection;
use etendue_tracer::integrator::PathSettings;
use serde::ser::{Serialize, SerializeMap as _, Serializer};

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
    /// Which light paths are simulated; what belongs to one pass of a render is at its default.
    pub paths: PathSettings,
    /// Whether matt surfaces draw directions by what paths before the picture have found; of paths only.
    pub guiding: bool,
    /// Wavelengths a path: 1, 4 or 8.
    pub wavelengths: u32,
    /// The density by which they are drawn; evenly where no electrons are summed.
    pub wavelength_sampling: WavelengthSampling,
    /// What the spectra of the light's sources in the density of wavelengths are estimated to save; `None` where no electrons are summed or
    /// no source gives any.
    pub spectral_gain: Option<SpectralGain>,
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

impl Settings {
    /// Whether paths are traced.
    #[must_use]
    pub fn traces_paths(&self) -> bool {
        self.paths.integrator == Integrator::Path
    }
}

/// A map of the settings by their keys in a description, and of what follows from them: the one list that reports and side-cars are made of.
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
        map.serialize_entry("sums_electrons", &self.folded)?;
        map.serialize_entry("seed", &self.seed)?;
        map.end()
    }
}

impl Route {
    /// The word of the key `route`.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Lens => "lens",
            Self::Pupil(_) => "pupil",
        }
    }
}
