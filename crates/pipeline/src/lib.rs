//! Compile a description into a plan, render the plan, and report what it takes.
//!
//! The modules stand in one order, and none uses a later one:
//!
//! - [`sizes`] counts tiles, blocks of pixels and bytes of films.
//! - [`plan`] is the data that a rendering needs: an immutable [`plan::Plan`].
//! - [`compile`](mod@compile) resolves what a description names, collects all contradictions and makes the plan.
//! - [`render`] takes a plan, a request and an [`Observer`], and answers with planes of light and of ground truth.
//! - [`camera`] takes light on to irradiance, electrons, digital numbers and pictures.
//! - [`report`] states what a plan models and leaves out, its time and memory, in figures and in words.
//!
//! Nothing here reads files, prints, looks at a clock or starts a thread pool.

pub mod camera;
pub mod compile;
pub mod plan;
pub mod render;
pub mod report;
pub mod sizes;

pub use camera::{datasheet, defocus, flat, light_meter, photograph, sampling, stored, weather};
pub use compile::{
    Choices, Refinement, compile, compile_camera, compile_camera_with_remarks, compile_weather, stated_projection,
};
pub use plan::{Plan, raw_colour, rectified, remark};
pub use render::observer::{Observer, Unobserved};
pub use render::{
    adaptive, boxes, film, frame_view, gather, identity_coverage, light, mosaic, motion, noise_reached, pupil_depth,
    rays, truth, weather_layers,
};
pub use report::summary;
pub use sizes::{block, spectrum_spread, tile};
