//! The trade of time for accuracy, in words of the command line.

use clap::ValueEnum;

/// How much of the light's ways is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Local shading by lamps, suns and sky, without shadows
    Flat,
    /// The same with shadows
    Direct,
    /// Everything, by path tracing
    Path,
}

impl Integrator {
    /// Its word in the key `render.level`.
    pub fn level(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Direct => "direct",
            Self::Path => "path",
        }
    }
}

/// Presets of the trade of time for accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// 16 samples a pixel, 4 bounces: to frame and expose
    Draft,
    /// 64 samples a pixel, 16 bounces
    Standard,
    /// 1024 samples a pixel, 64 bounces
    Reference,
}
