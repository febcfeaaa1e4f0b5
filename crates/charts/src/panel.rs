//! A sheet in its place in the world.

use crate::shape::Sheet;
use glam::{DMat3, DVec2, DVec3};

/// A sheet in its place in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Its name, which is that of its mesh.
    pub name: String,
    /// What it is.
    pub sheet: Sheet,
    /// Where its middle stands, m.
    pub position_m: DVec3,
    /// Columns: the directions in the world of the sheet's x, of its y, and of the way behind it.
    pub rotation: DMat3,
}

impl Panel {
    /// A sheet square before a camera at the origin that looks along +x.
    #[must_use]
    pub fn facing(name: impl Into<String>, sheet: Sheet, distance_m: f64) -> Self {
        let rotation = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
        Self { name: name.into(), sheet, position_m: DVec3::X * distance_m, rotation }
    }

    /// A point of the sheet (mm) in the world, m.
    #[must_use]
    pub fn world_m(&self, point_mm: DVec2) -> DVec3 {
        self.position_m + self.local_m(point_mm)
    }

    /// The same from the sheet's middle: a point of its mesh.
    #[must_use]
    pub fn local_m(&self, point_mm: DVec2) -> DVec3 {
        self.rotation * (point_mm / 1e3).extend(0.0)
    }
}
