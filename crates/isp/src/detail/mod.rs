//! Detail: noise reduction before colour, sharpening after tone; both off by default.

mod bilateral;
pub(crate) mod blur;
mod error;
mod median;
mod unsharp;

pub use error::DetailError;
use error::within;

pub use bilateral::Bilateral;
pub use unsharp::Unsharp;

/// How noise is reduced, on linear colours of the camera after demosaic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseReduction {
    /// Means over near pixels of like colour.
    Bilateral(Bilateral),
    /// The median of each channel over squares of 2 r + 1 pixels, r from 1 to 3.
    Median {
        /// r, px.
        radius_px: usize,
    },
}

impl NoiseReduction {
    /// Whether its numbers are in range.
    ///
    /// # Errors
    /// Where one is not.
    pub fn check(&self) -> Result<(), DetailError> {
        match self {
            Self::Bilateral(bilateral) => bilateral.check(),
            Self::Median { radius_px } if (1..=3).contains(radius_px) => Ok(()),
            Self::Median { radius_px } => {
                Err(DetailError::Range { name: "radius_px", value: *radius_px as f64, range: "from 1 to 3" })
            }
        }
    }

    /// The smoothed picture. Runs in the rayon pool of the caller; the result does not depend on it.
    pub(crate) fn apply<const N: usize>(&self, picture: &[[f32; N]], width: usize) -> Vec<[f32; N]> {
        match self {
            Self::Bilateral(bilateral) => bilateral.apply(picture, width),
            Self::Median { radius_px } => median::apply(picture, width, *radius_px),
        }
    }
}
