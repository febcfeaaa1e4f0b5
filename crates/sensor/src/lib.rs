//! Irradiance to electrons to digital numbers, every noise with a cause.
//!
//! ```text
//! E(λ) W·m⁻²·nm⁻¹ ──responsivity──▶ mean electrons ──charge effects──▶ electrons ──converter──▶ DN
//! ```
//!
//! - [`Sensor::responsivity`] says how many electrons a channel makes of an irradiance during the exposure; an irradiance
//!   cube ([`Sensor::electrons`]) or the caller's own accumulation makes mean electrons of it.
//! - [`Sensor::step`] makes a raw picture of mean electrons: shot noise, dark current, full well, read noise, converter,
//!   in that order ([`effects`]). It is an ordered fold over frames; its state is [`SensorState`].
//! - [`Sensor::needs`] says which effects a sensor has, and why others are absent.
//!
//! The model is that of EMVA 1288 (linear). Every random number has an address, so a picture's bits do not depend on
//! threads or on the order of work.
//!
//! Left out for now: temperature, fixed patterns (PRNU, DSNU, defects), crosstalk, blooming, smear, lag.

pub mod cfa;
pub mod effects;
mod electrons;
pub mod photon;
pub mod random;
mod sensor;
mod step;

pub use cfa::{BayerPhase, Cfa, CfaError};
pub use effects::{Effect, Need, Verdict};
pub use sensor::{Channel, Pixel, Sensor, SensorError, SensorParameters};
pub use step::{FrameAddress, Raw, SensorState};
