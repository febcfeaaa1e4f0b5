//! Camera models: unit direction ↔ point of the normalised image plane.
//!
//! Directions are of the camera frame (x right, y down, z forward); a point is what the camera matrix takes to pixels
//! ([`Calibration`](crate::Calibration)). Angles are in radians from the optical axis θ.
//!
//! | model | r(θ) or map | field, where nothing folds before |
//! | --- | --- | --- |
//! | [`Perspective`] | tan θ, then OpenCV's distortion and tilt | below 90° |
//! | [`RadialDistortion`] | tan θ, then r (1 + k₁ r² + k₂ r⁴) in either direction | below 90° |
//! | [`Division`] | tan θ = r/(1 + k r²) | to 180° for k < 0 |
//! | [`FieldOfView`] | atan(2 tan θ tan(ω/2))/ω | below 90° |
//! | [`KannalaBrandt`] | θ (1 + k₁ θ² + …) | to 180° |
//! | [`ThinPrismFisheye`] | the same, then tangential and prism terms | to 180° |
//! | [`Unified`] | sin θ/(cos θ + ξ), then OpenCV's distortion | by ξ |
//! | [`ExtendedUnified`] | sin θ/(α √(β sin² θ + cos² θ) + (1 − α) cos θ) | by α, β |
//! | [`DoubleSphere`] | sin θ/(α d + (1 − α)(ξ + cos θ)) | by ξ, α |
//! | [`Ocam`] | tan θ = −r/f(r), then an affine map | by f |
//! | [`FTheta`] | a polynomial r(θ) or θ(r), then an affine map | as stated |
//! | [`Tabulated`] | θ q(θ), q a spline through a table | as far as the table |
//! | [`Ideal`] | equidistant, equisolid, stereographic, orthographic, rectilinear | 180° or 90° |
//! | [`Panorama`] | cylindrical, equirectangular | the sphere |
//!
//! Every model is exact in both directions: inverses are in closed form or solved to the last few units in the last
//! place. Outside its field, at a fold and beyond, a model answers `None`.
//!
//! Left out: models whose rays do not share a centre. An orthographic telecentric camera maps every point to the same
//! direction and differs by the ray's origin alone; together with pushbroom and non-central catadioptric cameras it
//! belongs to optics, where a ray has an origin.

mod division;
mod double_sphere;
mod extended_unified;
mod f_theta;
mod field_of_view;
mod ideal;
mod kannala_brandt;
mod ocam;
mod panorama;
mod perspective;
mod profile;
mod radial_polynomial;
mod staged;
mod tabulated;
mod thin_prism_fisheye;
mod unified;

use glam::{DVec2, DVec3};

pub use crate::model_error::ModelError;
use crate::radial::RadialDistortion;
pub use division::Division;
pub use double_sphere::DoubleSphere;
pub use extended_unified::ExtendedUnified;
pub use f_theta::{FTheta, FThetaSense};
pub use field_of_view::FieldOfView;
pub use ideal::Ideal;
pub use kannala_brandt::KannalaBrandt;
pub use ocam::Ocam;
pub use panorama::Panorama;
pub use perspective::Perspective;
use profile::Projection;
pub(crate) use profile::field_angle;
pub use profile::{Edge, Sight};
pub use tabulated::Tabulated;
pub use thin_prism_fisheye::ThinPrismFisheye;
pub use unified::Unified;

/// A camera model.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// Perspective with OpenCV's distortion.
    Perspective(Perspective),
    /// Perspective with the radial polynomial in either direction; its lengths are principal distances here.
    Radial(RadialDistortion),
    /// Fitzgibbon's division model.
    Division(Division),
    /// The FOV model.
    FieldOfView(FieldOfView),
    /// Polynomial fisheye.
    KannalaBrandt(KannalaBrandt),
    /// Polynomial fisheye with tangential and prism terms.
    ThinPrismFisheye(ThinPrismFisheye),
    /// Unified omnidirectional (Mei).
    Unified(Unified),
    /// Extended unified.
    ExtendedUnified(ExtendedUnified),
    /// Double sphere.
    DoubleSphere(DoubleSphere),
    /// Scaramuzza's polynomial.
    Ocam(Ocam),
    /// F-theta polynomial.
    FTheta(FTheta),
    /// A table.
    Tabulated(Tabulated),
    /// An ideal projection about the axis.
    Ideal(Ideal),
    /// A panorama.
    Panorama(Panorama),
}

impl Model {
    /// The image point of a direction of any length; `None` outside the field.
    #[must_use]
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        self.projection().project(direction)
    }

    /// The unit direction seen at an image point; `None` where nothing is.
    #[must_use]
    pub fn unproject(&self, point: DVec2) -> Option<DVec3> {
        self.projection().unproject(point)
    }

    /// dΩ/dA, the solid angle (sr) that unit area of the image plane sees at an image point; `None` where nothing is seen.
    #[must_use]
    pub fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        self.projection().solid_angle_per_area(point)
    }

    /// The direction and the solid angle of an image point, for little more than one of them; `None` where nothing is seen.
    #[must_use]
    pub fn sight(&self, point: DVec2) -> Option<Sight> {
        self.projection().sight(point)
    }

    /// Where the field ends.
    #[must_use]
    pub fn edge(&self) -> Edge {
        self.projection().edge()
    }

    fn projection(&self) -> &dyn Projection {
        match self {
            Self::Perspective(m) => m,
            Self::Radial(m) => m,
            Self::Division(m) => m,
            Self::FieldOfView(m) => m,
            Self::KannalaBrandt(m) => m,
            Self::ThinPrismFisheye(m) => m.projection(),
            Self::Unified(m) => m.projection(),
            Self::ExtendedUnified(m) => m,
            Self::DoubleSphere(m) => m,
            Self::Ocam(m) => m.projection(),
            Self::FTheta(m) => m.projection(),
            Self::Tabulated(m) => m,
            Self::Ideal(m) => m,
            Self::Panorama(m) => m,
        }
    }
}
