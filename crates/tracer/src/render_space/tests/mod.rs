//! Tests of what a view answers about surfaces.

mod spawn;
mod surface;
mod truth;
