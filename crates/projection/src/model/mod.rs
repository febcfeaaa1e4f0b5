//! Camera models: unit direction ↔ point of the normalised image plane.
//!
//! Directions are of the camera frame (x right, y down, z forward); a point is what the camera matrix takes to pixels
//! ([`Calibration`](crate::Calibration)). Angles are in radians from the optical axis.
//!
//! | model | r(θ) or map | range |
//! | --- | --- | --- |
//! | [`Perspective`] | tan θ, then OpenCV's distortion and tilt | below 90° |
//! | [`KannalaBrandt`] | θ (1 + k₁ θ² + …) | to 180° |
//!
//! Every model is exact in both directions: inverses are solved to the last few units in the last place. Outside its range,
//! at a fold and beyond, a model answers `None`.
//!
//! Left out: models whose rays do not share a centre. An orthographic parallel camera maps every point to the same
//! direction and differs by the ray's origin alone; together with pushbroom and non-central catadioptric cameras it
//! belongs to optics, where a ray has an origin.

mod error;
mod kannala_brandt;
mod perspective;
mod profile;

use glam::{DVec2, DVec3};

pub use error::ModelError;
pub(crate) use error::finite_list;
pub use kannala_brandt::KannalaBrandt;
pub use perspective::Perspective;
pub use profile::Edge;
use profile::Profile;
pub(crate) use profile::field_angle;

/// A camera model.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// Perspective with OpenCV's distortion.
    Perspective(Perspective),
    /// Polynomial fisheye.
    KannalaBrandt(KannalaBrandt),
}

impl Model {
    /// The image point of a direction of any length; `None` outside the field.
    #[must_use]
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        match self {
            Self::Perspective(m) => m.project(direction),
            Self::KannalaBrandt(m) => m.project(direction),
        }
    }

    /// The unit direction seen at an image point; `None` where nothing is.
    #[must_use]
    pub fn unproject(&self, point: DVec2) -> Option<DVec3> {
        match self {
            Self::Perspective(m) => m.unproject(point),
            Self::KannalaBrandt(m) => m.unproject(point),
        }
    }

    /// dΩ/dA, the solid angle (sr) that unit area of the image plane sees at an image point; `None` where nothing is seen.
    #[must_use]
    pub fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        match self {
            Self::Perspective(m) => m.solid_angle_per_area(point),
            Self::KannalaBrandt(m) => m.solid_angle_per_area(point),
        }
    }

    /// Where the field ends.
    #[must_use]
    pub fn edge(&self) -> Edge {
        match self {
            Self::Perspective(m) => m.edge(),
            Self::KannalaBrandt(m) => m.edge(),
        }
    }
}
