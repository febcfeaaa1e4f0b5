//! The presets of samples and bounces by their words on the command line.

/// Presets of samples and bounces, for what a job file leaves open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// 16 samples a pixel, 4 bounces: to frame and expose.
    Draft,
    /// 64 samples a pixel, 16 bounces.
    Standard,
    /// 1024 samples a pixel, 64 bounces.
    Reference,
}
