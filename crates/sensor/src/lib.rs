//! Irradiance to electrons to digital numbers, with a physical cause for every noise.
//!
//! ```text
//! E(λ) W·m⁻²·nm⁻¹ ──responsivity──▶ mean electrons ──shot noise──▶ charge ──response──▶ voltage ──converter──▶ DN
//! ```
//!
//! - [`Sensor::responsivity`] states the electrons of a channel per irradiance during the exposure. An irradiance cube ([`Sensor::electrons`]) or the
//!   caller's own accumulation turns irradiance into mean electrons.
//! - [`Sensor::step`] computes a raw image from mean electrons by the effects of a sensor, in their physical order ([`effects`]). It is an ordered
//!   fold over frames; its state is [`SensorState`]. [`Sensor::step_with_breakdown`] also returns the components of each pixel's value.
//! - [`Sensor::effects`] lists the effects of a sensor, with reasons for absent ones.
//!
//! The model is that of EMVA 1288 (linear), with additions beyond the standard. Every random number has an address, so an image's bits do not depend
//! on threads or on the order of work. Temporal noise uses the job's seed, fixed patterns that of the unit.

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
