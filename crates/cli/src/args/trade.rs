//! The trade of time for accuracy, in words of the command line.

use clap::ValueEnum;

/// How much of the light's ways is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Integrator {
    /// Local shading by lamps, suns and sky, without shadows
    Flat,
    /// The same with shadows
    Direct,
    /// Everything, by path tracing
    Path,
}

impl From<Integrator> for etendue::Integrator {
    fn from(integrator: Integrator) -> Self {
        match integrator {
            Integrator::Flat => Self::Flat,
            Integrator::Direct => Self::Direct,
            Integrator::Path => Self::Path,
        }
    }
}

/// Presets of the trade of time for accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Quality {
    /// 16 samples a pixel, 4 bounces: to frame and expose
    Draft,
    /// 64 samples a pixel, 16 bounces
    Standard,
    /// 1024 samples a pixel, 64 bounces
    Reference,
}

impl From<Quality> for etendue::Quality {
    fn from(quality: Quality) -> Self {
        match quality {
            Quality::Draft => Self::Draft,
            Quality::Standard => Self::Standard,
            Quality::Reference => Self::Reference,
        }
    }
}
