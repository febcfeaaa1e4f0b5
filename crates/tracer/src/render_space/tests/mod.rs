//! Tests of what a view answers about surfaces.

mod motion;
mod spawn;
mod surface;
mod truth;
