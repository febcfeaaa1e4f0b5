//! Vocabulary of Étendue.
//!
//! Quantities with units, coordinate frames, transforms and light over time, rays, wavelength sets, planes of pixels, random addresses and deterministic
//! mathematics: the types that the stages of the simulation exchange.
//!
//! This crate depends on no stage, does no input or output and holds no policy.
//!
//! # Frames
//!
//! | frame | axes | unit |
//! | --- | --- | --- |
//! | world | right-handed, x forward, y left, z up (ISO 8855, REP-103) | m, f64 |
//! | render | axes of the world, origin at the centre of the camera's entrance pupil | m, f32 |
//! | camera | x right, y down, z forward (OpenCV), origin at the centre of the entrance pupil | m, f64 |
//! | sensor | x right, y down as the erect picture is seen, origin at the principal point | mm, f64 |
//! | raster | x right, y down, the top-left corner is (0, 0), pixel centres at + 0.5 | px, f64 |

mod camera_path;
pub mod distribution;
mod effect_status;
mod exact_time;
pub mod frame;
pub mod maths;
mod motion;
pub mod observer;
pub mod plane;
pub mod quantity;
pub mod random;
pub mod ray;
mod shutter;
pub mod storage;
mod time_interval;
pub mod track;
pub mod warp;
pub mod waveform;
pub mod wavelength;
mod wavelength_density;
pub mod words;

pub use camera_path::CameraPath;
pub use effect_status::{EffectStatus, KeyChange, KnownError};
pub use exact_time::{Cycle, Epoch, ExactTime};
pub use frame::{Basis, CameraPose};
pub use motion::Motion;
pub use plane::{Plane, SpectralCube};
pub use ray::{FieldRay, PrimitiveId, PupilRay, RadianceField, Ray};
pub use shutter::{RowTiming, Shutter};
pub use storage::StoredCube;
pub use time_interval::TimeInterval;
pub use track::Track;
pub use waveform::Waveform;
pub use wavelength::{Bands, Spectral, WavelengthRange, Wavelengths};
pub use wavelength_density::WavelengthDensity;
pub use words::{Accelerator, Integrator, LightSampling, Quality, RawFormat, Setting, Word};
