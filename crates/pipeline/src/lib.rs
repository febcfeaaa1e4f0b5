//! Compile a description into a plan, and render the plan.
//!
//! - [`compile`](mod@compile) resolves what a description names, collects all contradictions and makes an immutable [`plan::Plan`].
//! - [`plan`] is what it makes, what is remarked of it, and its summary in words.
//! - [`render`] takes a plan, a request and an [`Observer`], and answers with planes of light and of ground truth.
//! - [`camera`] takes light on to irradiance, electrons, digital numbers and pictures.
//!
//! Nothing here reads files, prints, looks at a clock or starts a thread pool.

pub mod camera;
pub mod compile;
pub mod plan;
pub mod render;

pub use camera::{datasheet, defocus, flat, light_meter, photograph, raw_colour, rectified, sampling, stored, weather};
pub use compile::{
    Choices, Quality, Refinement, compile, compile_camera, compile_camera_with_remarks, compile_weather,
};
pub use plan::{Plan, remark, summary};
pub use render::observer::{Observer, Unobserved};
pub use render::{
    adaptive, block, boxes, film, frame_view, gather, identity_coverage, light, mosaic, motion, noise_reached,
    pupil_depth, rays, spectrum_spread, tile, truth, weather_layers,
};
