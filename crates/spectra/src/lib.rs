//! Spectra: wavelength dependence of light, surfaces, glass and sensors, and their colour.
//!
//! A [`Spectrum`] is a function of wavelength on a dense grid of 1 nm from 300 to 1 100 nm. The crate includes measured and standard tables
//! (`data/SOURCES.md` lists their sources and licences), parsed once on first use.
//!
//! **Outside a table** sensitivities and emissions are zero, and reflectances, transmittances and refractive indices hold their end value;
//! [`Extrapolation`] selects the rule and [`Spectrum::covered_nm`] returns the range of the table.

pub mod camera;
pub mod colour;
pub mod dielectric;
pub mod glass;
pub mod illuminant;
pub mod metal;
pub mod mie;
pub mod observer;
pub mod reflectance;
pub mod sky;
mod spectrum;
mod table;
pub mod upsample;

pub use spectrum::Spectrum;
pub use table::{Extrapolation, SpectrumError, TablePlace};
