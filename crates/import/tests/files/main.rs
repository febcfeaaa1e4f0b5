//! Scene files of other programs, read into their own structure.

mod mitsuba;
mod pbrt;
