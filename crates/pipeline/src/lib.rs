//! Compile a description into a plan, and render the plan.
//!
//! `compile` resolves what a description names, collects all contradictions and makes an immutable [`plan::Plan`];
//! rendering takes a plan, a request and an [`Observer`], and answers with planes. Nothing here reads files, prints,
//! looks at a clock or starts a thread pool.

pub mod block;
pub mod compile;
pub mod datasheet;
pub mod defocus;
mod effects;
pub mod film;
mod fingerprint;
pub mod flat;
pub mod gather;
pub mod light;
pub mod light_meter;
pub mod mosaic;
mod observer;
pub mod photograph;
pub mod plan;
pub mod pupil_depth;
pub mod raw_colour;
pub mod rays;
pub mod rectified;
pub mod remark;
pub mod render;
mod shared_light;
pub mod spectrum_spread;
pub mod stored;
pub mod summary;
pub mod tile;
pub mod truth;
mod warnings;

pub use compile::{Choices, Quality, compile, compile_camera, compile_camera_with_remarks};
pub use observer::{Observer, Unobserved};
pub use plan::Plan;
