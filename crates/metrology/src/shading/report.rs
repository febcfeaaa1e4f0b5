//! What is found of the shading of a picture.

use super::basis::{Basis, TERMS};
use crate::Estimate;

/// A ring of the profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Radial field position, share of the distance from the centre to the farthest corner.
    pub position: f64,
    /// Illumination relative to the centre.
    pub relative: Estimate,
}

/// A flat field's shading.
#[derive(Clone, Debug, PartialEq)]
pub struct Shading {
    /// From the centre outwards.
    pub profile: Vec<Ring>,
    /// The centre's reading less black.
    pub centre: Estimate,
    /// a₂, a₄, a₆, a₈ of the polynomial that is nearest to the fitted fall-off over the circle, positions as shares.
    pub coefficients: [Estimate; 4],
    /// Fitted illumination at the farthest corner relative to the centre.
    pub corner: Estimate,
    /// Block means relative to the central one, rows from the top.
    pub map: Vec<Vec<Estimate>>,
    /// The fitted fall-off: its terms, and their coefficients over that of the centre.
    pub(super) fitted: (Basis, [f64; TERMS]),
}

impl Shading {
    /// The fitted fall-off at a radial field position (1 at the farthest corner).
    #[must_use]
    pub fn falloff(&self, position: f64) -> f64 {
        let (basis, shape) = self.fitted;
        basis.at(position * position).iter().zip(shape).map(|(term, b)| term * b).sum()
    }
}
