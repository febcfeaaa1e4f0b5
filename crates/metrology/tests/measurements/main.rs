//! Measurements of synthetic pictures and readings: closed forms, other programs, and intervals that cover the truth.

#[path = "../../src/coverage.rs"]
mod coverage;
mod draws;
mod geometry;
mod intervals;

use etendue_metrology::Estimate;
