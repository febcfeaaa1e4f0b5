//! Irradiance effects: from the spectral irradiance on the sensor plane to the same.
//!
//! # Contract
//!
//! - Effects act on band means of the irradiance (W·m⁻²·nm⁻¹), one band after the other, in the order of the table. Each states whether a camera
//!   needs it and why (`status`).
//! - They need light from outside the image: the film is wider by a margin on every side ([`Effects::margin_px`]), which is cut off at the end. No
//!   light comes from beyond the margin, and light that leaves it is lost.
//! - All are linear with non-negative weights. Variances use the squared weights: errors of different pixels are taken as independent before every
//!   effect.
//! - An absent effect costs nothing: no margin, no spectrum.
//!
//! | order | effect | on |
//! | --- | --- | --- |
//! | 1 | [point spread](psf) | diffraction of the aperture, wavefront error; or [a picture](spread_image); or [tables over the field](spread_table) |
//! | 2 | [veiling glare](glare) | scatters a fraction of the light over the plane |
//! | 3 | [ghosts](crate::ghosts) | adds light that two surfaces of the lens reflect |
//!
//! Ghosts are computed from the film's own light, before the other effects, for all bands at once ([`crate::ghosts::layer`]), and are added after
//! them: they are out of focus, and their scatter is of second order.

mod band;
mod canvas;
mod chain;
mod convolve;
mod core_table;
mod error;
mod film_part;
mod fourier;
pub mod glare;
mod kernel;
mod mtf;
mod patches;
mod point_spread;
pub mod psf;
mod sample_spread;
pub mod spread_image;
pub mod spread_table;

pub use chain::{Effects, EffectsParameters, MAX_MARGIN, PreparedEffects};
pub use convolve::OperationCounts;
pub use error::EffectsError;
pub use film_part::{FilmPart, SpreadMethod, SpreadWidth};
pub use glare::{Glare, GlareParameters};
pub use mtf::spread_of_modulation;
pub use point_spread::PointSpread;
pub use psf::{Psf, PsfParameters, Zernike, ZernikeTerm};
pub use sample_spread::{SampleSpread, SpreadRandomNumbers};
pub use spread_image::{SpreadImage, SpreadImageParameters};
pub use spread_table::{FieldSpread, SpreadTable, SpreadTableParameters, WavelengthTable};

pub(crate) use canvas::Canvas;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Diffraction and wavefront error.
    PointSpread,
    /// Light scattered in the lens.
    Glare,
    /// Light reflected by two surfaces.
    Ghosts,
}

impl Effect {
    /// All effects, in their order.
    pub const ALL: [Self; 3] = [Self::PointSpread, Self::Glare, Self::Ghosts];

    /// The effect's name in a plan.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PointSpread => "point spread",
            Self::Glare => "veiling glare",
            Self::Ghosts => "ghosts",
        }
    }
}
