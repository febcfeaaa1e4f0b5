//! The integrators by their words in a job.

/// How much of the light transport is followed: the key `render.integrator`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Local shading by lamps, suns and sky, without shadows.
    Flat,
    /// The same with shadows.
    Direct,
    /// Everything, by path tracing.
    Path,
}

impl Integrator {
    /// Its word in the key `render.integrator`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Direct => "direct",
            Self::Path => "path",
        }
    }
}
