//! Compiles a description into a plan, renders the plan, and reports its cost.
//!
//! The modules are in order of dependency; none uses a later one:
//!
//! - [`sizes`] counts tiles, blocks of pixels and bytes of films.
//! - [`plan`] is the data that a render needs: an immutable [`plan::Plan`].
//! - [`compile`](mod@compile) resolves the names in a description, collects all contradictions and makes the plan.
//! - [`render`] takes a plan, a request and an [`Observer`], and returns planes of light and of ground truth.
//! - [`camera`] converts light to irradiance, electrons, digital numbers and images.
//! - [`report`] states what a plan models and omits, its time and its memory, in figures and as text.
//!
//! Nothing here reads files, prints, reads a clock or starts a thread pool.

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
pub use plan::{Plan, note, raw_colour, rectified};
pub use render::observer::{NullObserver, Observer};
pub use render::{
    adaptive, boxes, film, frame_view, gather, identity_coverage, light, mosaic, motion, noise_reached, pupil_depth,
    rays, truth, weather_layers,
};
pub use report::summary;
pub use sizes::{block, spectrum_spread, tile};
