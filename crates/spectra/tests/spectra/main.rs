//! Spectra and skies beside other programs.

mod colour_science;
mod mitsuba_sky;
