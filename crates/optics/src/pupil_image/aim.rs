//! Where the points of a picture look, by wavelength, at the cost of a table where the lens itself is dear.
//!
//! A prescription's chief rays (through the centre of the stop, of the wavelength) are traced at [`KNOTS`] radii; their field
//! angles are interpolated by cubics through the neighbours' slopes (Catmull and Rom 1974). The angle is a smooth function
//! of the radius, and the error is tested to stay below 1e-7 rad, a thousandth of any pixel.

use crate::lens::{FieldAngles, Lens};
use crate::wavelength::PRINCIPAL_NM;
use glam::{DVec2, DVec3};

/// Radii at which a prescription is traced.
const KNOTS: usize = 512;

/// The chief rays of a wavelength.
#[derive(Clone, Debug)]
pub(crate) enum Aim<'a> {
    /// Asked of the lens, point by point.
    Lens {
        /// The lens.
        lens: &'a Lens,
        /// The wavelength, nm.
        nm: f64,
    },
    /// Field angles by radius.
    Table(FieldAngles),
}

impl<'a> Aim<'a> {
    /// Of points as far as `reach_mm` from the axis.
    pub(crate) fn new(lens: &'a Lens, reach_mm: f64, nm: f64) -> Self {
        match lens {
            Lens::Prescription(prescribed) => Self::Table(prescribed.field_angles(reach_mm, nm, KNOTS)),
            _ => Self::Lens { lens, nm },
        }
    }

    /// Of the wavelength of ground truth.
    pub(crate) fn principal(lens: &'a Lens, reach_mm: f64) -> Self {
        Self::new(lens, reach_mm, PRINCIPAL_NM)
    }

    /// The unit direction seen at a sensor point; `None` where there is none.
    pub(crate) fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        match self {
            Self::Lens { lens, nm } => lens.direction_at(sensor_mm, *nm).map(DVec3::normalize),
            Self::Table(table) => table.direction(sensor_mm),
        }
    }
}
