//! Photon transfer after EMVA 1288, release 4.0, linear model (including the figures of 3.1).
//!
//! ```text
//! μ_e = η μ_p        μ_y = μ_y.dark + K μ_e        σ_y² = K² σ_d² + 1/12 + K (μ_y − μ_y.dark)
//! ```
//!
//! | module | content |
//! | --- | --- |
//! | [`Stack`] | mean and temporal variance of one light level, from frames added one at a time |
//! | [`Pattern`] | spatial variances of a stack, with row, column and pixel parts |
//! | [`TransferData`] | saturation, K, η, dark noise, thresholds, dynamic range, linearity, dark current: [`Figures`] |
//! | [`nonuniformity()`] | DSNU and PRNU |
//! | [`temperature`] | growth of the dark current with temperature |
//! | [`spatial`] | power spectra of rows and columns |
//! | [`Deviations`] | histograms of defect pixels |
//! | [`Outliers`] | hot and dead pixels: positions, fraction, mean current |
//!
//! Units: readings DN, light photons per pixel and exposure, charge e⁻, time s. If only relative light is known (an exposure
//! series under a constant light of unknown strength), "photons" are any unit of light, and η and the thresholds in photons are
//! meaningless; all figures in e⁻ and DN are valid.
//!
//! Limitations: no general model of release 4.0 (cameras that are not linear), no multi-channel and polarisation cameras as a
//! whole (measure the pixels of one colour at a time), no spectral sensitivity.

mod data;
mod defects;
mod figures;
mod outliers;
pub mod spatial;
mod stack;
pub mod temperature;
#[cfg(test)]
mod tests;

pub use data::{Level, Nonuniformity, TransferData, nonuniformity};
pub use defects::Deviations;
pub use figures::{Figures, SnrPoint, model_snr};
pub use outliers::{DarkStack, MIN_OUTLIERS, Outliers, dead_pixels, hot_pixels};
pub use spatial::{Pattern, VarianceComponents};
pub use stack::{LevelStatistics, Stack};

/// Reason why frames cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransferError {
    /// Frames of different sizes.
    #[error(
        "a frame has {} × {} pixels, the frames before it {} × {}: all frames must have the same size",
        size.0, size.1, expected.0, expected.1
    )]
    Size {
        /// Width and height of the frame.
        size: (usize, usize),
        /// Width and height of the frames before it.
        expected: (usize, usize),
    },
    /// A reading is NaN or infinite.
    #[error("a frame contains readings that are not finite: give finite values")]
    NotFinite,
    /// Two frames are equal.
    #[error(
        "two frames are equal in every pixel: noise cannot be measured from copies; give frames captured one after another"
    )]
    Copies,
    /// A level with one frame.
    #[error("temporal noise needs at least two frames of two or more pixels per level, not {frames} frame(s)")]
    TooFewFrames {
        /// Number of frames.
        frames: usize,
    },
    /// Too few rows or columns to separate them.
    #[error("row and column patterns need at least 3 × 3 pixels, not {width} × {height}")]
    TooSmall {
        /// Pixels per row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// No frames without light.
    #[error("no dark frames for the exposure time {exposure_s} s: every exposure time needs a level without light")]
    NoDark {
        /// Exposure time.
        exposure_s: f64,
    },
    /// A curve with too few points.
    #[error(
        "a photon transfer curve needs at least three levels of light below 70 % of saturation, not {levels}: give more exposures"
    )]
    TooFewLevels {
        /// Number of levels.
        levels: usize,
    },
    /// The light of a level is not a positive number.
    #[error("the light of a level must be a positive number, not {0}")]
    Light(f64),
    /// Readings do not increase with the light.
    #[error(
        "the readings do not increase with the light: check the order of the levels, and that the sensor is not saturated at all of them"
    )]
    NoResponse,
    /// Variance does not increase with the signal.
    #[error(
        "the temporal variance does not increase with the signal: photon transfer needs linear raw frames with shot noise, not processed or averaged images"
    )]
    NoShotNoise,
    /// The stack for PRNU is saturated.
    #[error(
        "the mean of the bright stack, {mean_dn} DN, is at or above saturation ({saturation_dn} DN): give a stack at half of saturation"
    )]
    SaturatedStack {
        /// Mean of the stack.
        mean_dn: f64,
        /// Mean at the saturation point.
        saturation_dn: f64,
    },
    /// Two stacks of different sizes, or a bright one that is no brighter.
    #[error("the bright stack is no brighter than the dark one: PRNU needs a stack at about half of saturation")]
    NotBrighter,
    /// Dark currents at too few temperatures.
    #[error("the dark current over temperature needs at least three different temperatures, not {0}")]
    TooFewTemperatures(usize),
    /// An impossible temperature.
    #[error("the temperature {0} °C is invalid: expected a number above -273.15")]
    NoTemperature(f64),
    /// A dark current without an uncertainty for its weight.
    #[error(
        "the uncertainty of the dark current at {0} °C, its weight in the fit, is unknown: give more pixels or exposure times"
    )]
    DarkCurrentUnknown(f64),
    /// No growth of the dark current.
    #[error("the dark currents are not above zero on average: give longer exposures or warmer sensors")]
    NoDarkCurrent,
}
