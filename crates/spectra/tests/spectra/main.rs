//! Spectra and skies compared with other programs.

mod colour_science;
mod mitsuba_sky;
