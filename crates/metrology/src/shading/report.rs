//! What is found of the shading of a picture.

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
    /// a₂, a₄, a₆, a₈ of the fitted fall-off, positions as shares.
    pub coefficients: [Estimate; 4],
    /// Fitted illumination at the farthest corner relative to the centre.
    pub corner: Estimate,
    /// Block means relative to the central one, rows from the top.
    pub map: Vec<Vec<Estimate>>,
}

impl Shading {
    /// The fitted fall-off at a radial field position (1 at the farthest corner).
    #[must_use]
    pub fn falloff(&self, position: f64) -> f64 {
        let square = position * position;
        self.coefficients.iter().rev().fold(0.0, |sum, a| (sum + a.value) * square) + 1.0
    }
}
