//! Irradiance to electrons to digital numbers, every noise with a cause.
//!
//! ```text
//! E(λ) W·m⁻²·nm⁻¹ ──responsivity──▶ mean electrons ──shot noise──▶ charge ──response──▶ voltage ──converter──▶ DN
//! ```
//!
//! - [`Sensor::responsivity`] says how many electrons a channel makes of an irradiance during the exposure; an irradiance
//!   cube ([`Sensor::electrons`]) or the caller's own accumulation makes mean electrons of it.
//! - [`Sensor::step`] makes a raw image of mean electrons by the effects a sensor has, in their physical order
//!   ([`effects`]). It is an ordered fold over frames; its state is [`SensorState`]. [`Sensor::step_with_breakdown`] says
//!   beside it what each pixel's value is made of.
//! - [`Sensor::effects`] says which effects a sensor has, and why others are absent.
//!
//! The model is that of EMVA 1288 (linear), with what the standard leaves out. Every random number has an address, so a
//! image's bits do not depend on threads or on the order of work. Noise from frame to frame is drawn from the job's seed,
//! fixed patterns from the specimen's.

mod capture;
pub mod cfa;
mod check;
mod effect;
pub mod effects;
mod electrons;
pub mod exposure_control;
pub mod figures;
mod frame;
pub mod hdr;
pub mod layout;
mod mixture;
mod parameters;
pub mod photon;
pub mod random;
mod raw;
mod reading;
mod sensor;
mod signal_breakdown;
mod validity;

pub use capture::{CaptureLight, FrameAddress, OperatingPoint, SensorState};
pub use cfa::{BayerPhase, Cfa, CfaError};
pub use check::SensorError;
pub use effect::SensorEffect;
pub use effects::{ChargeEffects, LightEffects, VoltageEffects};
pub use figures::{DynamicRange, TemporalNoise};
pub use parameters::{Channel, Exposure, Pixel, ReadOut, SensorParameters};
pub use raw::{LinearRaw, Raw};
pub use sensor::Sensor;
pub use signal_breakdown::{ChargeAccount, SignalBreakdown, SignalComponent};
