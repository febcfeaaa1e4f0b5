//! The affine map of catadioptric and f-theta calibrations: a plane point to a scaled and sheared one.
//!
//! x′ = x + e y, y′ = d x + c y with x to the right and y down: Scaramuzza's stretch matrix [c d; e 1], whose first
//! coordinate runs down the rows (Scaramuzza, Martinelli & Siegwart 2006, eq. 6).

use glam::{DMat2, DVec2};

use crate::model_error::ModelError;

/// The stretch c, d, e; 1, 0, 0 is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Scale of the rows.
    pub c: f64,
    /// What a step to the right adds downwards.
    pub d: f64,
    /// What a step downwards adds to the right.
    pub e: f64,
}

impl Default for Affine {
    fn default() -> Self {
        Self { c: 1.0, d: 0.0, e: 0.0 }
    }
}

impl Affine {
    /// Refuses a map that mirrors or flattens the plane.
    pub(crate) fn check(&self) -> Result<(), ModelError> {
        let determinant = self.area_ratio();
        if determinant > 0.0 && determinant.is_finite() {
            return Ok(());
        }
        Err(ModelError::value("affine determinant c − d e", determinant, "a positive number"))
    }

    pub(crate) fn there(&self, p: DVec2) -> DVec2 {
        self.matrix() * p
    }

    pub(crate) fn back(&self, p: DVec2) -> DVec2 {
        self.matrix().inverse() * p
    }

    pub(crate) fn area_ratio(&self) -> f64 {
        self.c - self.d * self.e
    }

    fn matrix(&self) -> DMat2 {
        DMat2::from_cols_array(&[1.0, self.d, self.e, self.c])
    }
}
