//! Measurements of synthetic images and readings: closed forms, other programs, and coverage of intervals.

#[path = "../../src/coverage.rs"]
mod coverage;
mod draws;
mod geometry;
mod intervals;

use etendue_metrology::Estimate;
