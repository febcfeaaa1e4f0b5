//! Compile a description into a plan, and render the plan.
//!
//! `compile` resolves what a description names, collects all contradictions and makes an immutable [`plan::Plan`];
//! rendering takes a plan, a request and an [`Observer`], and answers with planes. Nothing here reads files, prints,
//! looks at a clock or starts a thread pool.

pub mod film;
pub mod gather;
pub mod light;
mod observer;
pub mod tile;

pub use observer::{Observer, Unobserved};
