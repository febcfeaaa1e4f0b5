//! How paths are followed.

use super::level::Level;
use super::mis::Strategies;

/// What a light's chance of being drawn at a surface goes by. No mean depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightSampling {
    /// Its irradiance, and how much of it the surface's narrow lobes send back along the path.
    Gloss,
    /// Its irradiance alone: cheaper at glossy surfaces, and noisier where they mirror lamps.
    Irradiance,
}

impl LightSampling {
    /// Its word in the key `light_sampling`.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Gloss => "gloss",
            Self::Irradiance => "irradiance",
        }
    }
}

/// How paths are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// How much of light transport is followed.
    pub level: Level,
    /// Greatest number of scattering events; of the level [`Level::Path`] alone.
    pub max_bounces: u32,
    /// Scattering events after which paths may end at random; those that mirrors alone have scattered never do.
    pub roulette_start: u32,
    /// How many lights are drawn and how many paths go on at the first surface that is no mirror, 1 or more (`branching.rs`).
    pub branches: u32,
    /// Samples of a replicate, or of a run of them where their number is not known before: paths that share their tails take turns over them.
    pub samples: u32,
    /// Full angle of the cone that a camera ray stands for, rad: that of a pixel over the root of its samples. Chooses the
    /// resolution of textures.
    pub cone_spread_rad: f32,
    /// Which ways of finding light are used.
    pub strategies: Strategies,
    /// What lights are drawn by.
    pub light_sampling: LightSampling,
    /// Whether light of suns and glowing surfaces that smooth surfaces throw on matt ones, and mirrors on much less glossy ones, is followed (`caustic.rs`).
    /// Without it the picture is darker by that light, and free of the rare bright samples that find it.
    pub caustics: bool,
    /// Whether micro-facets are widened whose lobes the path would find by luck (`regularize.rs`).
    pub regularize: bool,
    /// Whether only light counts that media scatter into the camera's rays before these meet a surface, a drop or a flake.
    pub only_airlight: bool,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            level: Level::Path,
            max_bounces: 16,
            roulette_start: 2,
            branches: 1,
            samples: 1,
            cone_spread_rad: 0.0,
            strategies: Strategies::Both,
            light_sampling: LightSampling::Gloss,
            caustics: true,
            regularize: false,
            only_airlight: false,
        }
    }
}
