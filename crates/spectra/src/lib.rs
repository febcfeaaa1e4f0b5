//! Spectra: how light, surfaces, glass and sensors depend on wavelength, and what colour they have.
//!
//! A [`Spectrum`] is a function of wavelength on a dense grid of 1 nm from 300 to 1 100 nm. Measured and standard
//! tables come with the crate (`data/SOURCES.md` names their sources and licences) and are parsed once, on first use.
//!
//! **Outside a table** sensitivities and emissions are zero, and reflectances, transmittances and refractive indices
//! hold their end value; [`Outside`] names the choice and [`Spectrum::covered_nm`] says how far a table reached.

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
pub use table::{Outside, Place, SpectrumError};
