//! Camera models: unit direction ↔ point of the normalised image plane.
//!
//! Directions are in the camera frame (x right, y down, z forward); the camera matrix maps points to pixels ([`Calibration`](crate::Calibration)).
//! Angles θ are in radians from the optical axis.
//!
//! | model | r(θ) or map | field, unless it folds before |
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
//! | [`TabulatedProjection`] | θ q(θ), q a spline through a table | as far as the table |
//! | [`Ideal`] | equidistant, equisolid, stereographic, orthographic, rectilinear | 180° or 90° |
//! | [`Panorama`] | cylindrical, equirectangular | the sphere |
//!
//! Every model is exact in both directions: inverses are in closed form or solved to the last few units in the last place. Outside its field, at a
//! fold and beyond, a model returns `None`.
//!
//! The models available for fitting, by name and with their coefficients as a list of numbers, are below: [`CameraModel`], [`Family`].
//!
//! Left out: models whose rays do not share a centre. An orthographic telecentric camera maps every point to the same direction; only the ray's
//! origin differs. Together with pushbroom and non-central catadioptric cameras it belongs to the optics crate, where a ray has an origin.

mod f_theta;
mod fisheye;
mod ideal;
mod ocam;
mod perspective;
mod profile;
mod spherical;
mod tabulated;

use glam::{DVec2, DVec3};

use crate::plane::DistortionTerms;
use crate::radial::{DistortionDirection, RadialDistortion};
use profile::Projection;

pub use crate::rectilinear::ModelError;
pub use f_theta::{FTheta, FThetaSense};
pub use fisheye::{KannalaBrandt, ThinPrismFisheye};
pub use ideal::{Ideal, Panorama};
pub use ocam::Ocam;
pub use perspective::{Division, FieldOfView, Perspective};
pub use profile::{DirectionAndSolidAngle, FieldEdge};
pub use spherical::{DoubleSphere, ExtendedUnified, Unified};
pub use tabulated::TabulatedProjection;

pub(crate) use profile::field_angle;

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
    ExtendedUnified(ExtendedUnified),
    DoubleSphere(DoubleSphere),
    /// Scaramuzza's polynomial.
    Ocam(Ocam),
    /// F-theta polynomial.
    FTheta(FTheta),
    /// A table.
    Tabulated(TabulatedProjection),
    /// An ideal projection about the axis.
    Ideal(Ideal),
    Panorama(Panorama),
}

impl Model {
    /// The image point of a direction of any length; `None` outside the field.
    #[must_use]
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        self.projection().project(direction)
    }

    /// The unit direction seen at an image point; `None` if there is none.
    #[must_use]
    pub fn unproject(&self, point: DVec2) -> Option<DVec3> {
        self.projection().unproject(point)
    }

    /// dΩ/dA, the solid angle (sr) seen per unit area of the image plane at an image point; `None` if there is no direction.
    #[must_use]
    pub fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        self.projection().solid_angle_per_area(point)
    }

    /// The direction and the solid angle of an image point, at little more than the cost of one of them; `None` if there is no direction.
    #[must_use]
    pub fn sight(&self, point: DVec2) -> Option<DirectionAndSolidAngle> {
        self.projection().sight(point)
    }

    /// The edge of the field.
    #[must_use]
    pub fn edge(&self) -> FieldEdge {
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

/// The closed list of models by name, each with a description and its family.
macro_rules! camera_models {
    ($($Model:ident $name:literal, $about:literal: $family:expr;)*) => {
        /// A model that can be fitted, by name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum CameraModel {
            $(#[doc = $about] $Model,)*
        }

        impl CameraModel {
            /// All models, the simplest first.
            pub const ALL: &[Self] = &[$(Self::$Model),*];

            /// Name as typed by a user.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$Model => $name,)* }
            }

            /// Short description.
            #[must_use]
            pub fn about(self) -> &'static str {
                match self { $(Self::$Model => $about,)* }
            }

            /// The family whose coefficients are fitted.
            #[must_use]
            pub fn family(self) -> Family {
                match self { $(Self::$Model => $family,)* }
            }
        }
    };
}

camera_models! {
    Pinhole "pinhole", "No distortion": perspective(RadialTerms::Polynomial(0), false);
    Opencv "opencv", "k1 k2 p1 p2": perspective(RadialTerms::Polynomial(2), true);
    Opencv5 "opencv5", "k1 k2 p1 p2 k3": perspective(RadialTerms::Polynomial(3), true);
    Opencv8 "opencv8", "k1 … k6 p1 p2": perspective(RadialTerms::Rational, true);
    Radial "radial", "k1 k2, from ideal to observed": Family::Polynomial(DistortionDirection::IdealToObserved);
    RadialInverse "radial-inverse", "k1 k2, from observed to ideal": Family::Polynomial(DistortionDirection::ObservedToIdeal);
    KannalaBrandt "kannala-brandt", "Polynomial fisheye, k1 … k4": Family::KannalaBrandt(4);
    Division "division", "Division model": Family::Division;
    FieldOfView "field-of-view", "FOV model": Family::FieldOfView;
    Unified "unified", "Unified omnidirectional, with k1 k2": Family::Unified;
    ExtendedUnified "extended-unified", "Extended unified": Family::ExtendedUnified;
    DoubleSphere "double-sphere", "Double sphere": Family::DoubleSphere;
    Equidistant "equidistant", "Ideal fisheye, r = f θ": Family::Ideal(Ideal::Equidistant);
    Equisolid "equisolid", "Ideal fisheye of equal areas": Family::Ideal(Ideal::Equisolid);
    Stereographic "stereographic", "Ideal fisheye that keeps angles": Family::Ideal(Ideal::Stereographic);
    Orthographic "orthographic", "r = f sin θ": Family::Ideal(Ideal::Orthographic);
}

fn perspective(radial: RadialTerms, tangential: bool) -> Family {
    Family::Perspective { radial, tangential }
}

/// Radial terms of a perspective camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadialTerms {
    /// k₁ … kₙ, n from 0 to 3.
    Polynomial(usize),
    /// k₁ … k₆ of OpenCV's rational model.
    Rational,
}

/// A family of models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Family {
    /// Perspective with OpenCV's radial terms, and optionally p₁, p₂.
    Perspective {
        /// Radial terms.
        radial: RadialTerms,
        /// True if p₁ and p₂ are fitted.
        tangential: bool,
    },
    /// Perspective with r (1 + k₁ r² + k₂ r⁴) in either direction, r in focal lengths.
    Polynomial(DistortionDirection),
    /// Polynomial fisheye with k₁ … kₙ, n from 0 to 4.
    KannalaBrandt(usize),
    /// Division model.
    Division,
    /// FOV model.
    FieldOfView,
    /// Unified model with k₁, k₂.
    Unified,
    /// Extended unified model.
    ExtendedUnified,
    DoubleSphere,
    /// An ideal projection.
    Ideal(Ideal),
}

impl Family {
    /// Names of the coefficients.
    #[must_use]
    pub fn names(self) -> Vec<&'static str> {
        const K: [&str; 6] = ["k1", "k2", "k3", "k4", "k5", "k6"];
        match self {
            Self::Perspective { radial, tangential } => {
                let terms = match radial {
                    RadialTerms::Polynomial(n) => n.min(3),
                    RadialTerms::Rational => 6,
                };
                let tangential: &[&str] = if tangential { &["p1", "p2"] } else { &[] };
                [&K[..terms], tangential].concat()
            }
            Self::Polynomial(_) => K[..2].to_vec(),
            Self::KannalaBrandt(n) => K[..n.min(4)].to_vec(),
            Self::Division => vec!["k"],
            Self::FieldOfView => vec!["omega_rad"],
            Self::Unified => vec!["xi", "k1", "k2"],
            Self::ExtendedUnified => vec!["alpha", "beta"],
            Self::DoubleSphere => vec!["xi", "alpha"],
            Self::Ideal(_) => Vec::new(),
        }
    }

    /// Initial coefficients.
    #[must_use]
    pub fn first(self) -> Vec<f64> {
        match self {
            Self::FieldOfView => vec![0.8],
            Self::Unified => vec![0.8, 0.0, 0.0],
            Self::ExtendedUnified => vec![0.5, 1.0],
            Self::DoubleSphere => vec![0.0, 0.5],
            _ => vec![0.0; self.names().len()],
        }
    }

    /// Creates the model from its coefficients.
    ///
    /// # Errors
    /// If they are not legal.
    pub fn model(self, c: &[f64]) -> Result<Model, ModelError> {
        let at = |i: usize| c.get(i).copied().unwrap_or(0.0);
        Ok(match self {
            Self::Perspective { radial, tangential } => {
                let terms = self.names().len() - if tangential { 2 } else { 0 };
                let k = |i: usize| if i < terms { at(i) } else { 0.0 };
                let denominator = if radial == RadialTerms::Rational { [k(3), k(4), k(5)] } else { [0.0; 3] };
                let tangential = if tangential { [at(terms), at(terms + 1)] } else { [0.0; 2] };
                let numerator = [k(0), k(1), k(2), 0.0];
                let terms = DistortionTerms { numerator, denominator, tangential, ..DistortionTerms::default() };
                Model::Perspective(Perspective::new(terms, [0.0; 2])?)
            }
            Self::Polynomial(sense) => {
                Model::Radial(RadialDistortion::new(sense, at(0), at(1), 1.0).map_err(|_| ModelError {
                    name: "k1".to_owned(),
                    value: at(0),
                    expected: "finite k1 and k2",
                })?)
            }
            Self::KannalaBrandt(_) => Model::KannalaBrandt(KannalaBrandt::new([at(0), at(1), at(2), at(3)])?),
            Self::Division => Model::Division(Division::new(at(0))?),
            Self::FieldOfView => Model::FieldOfView(FieldOfView::new(at(0))?),
            Self::Unified => {
                let terms = DistortionTerms { numerator: [at(1), at(2), 0.0, 0.0], ..DistortionTerms::default() };
                Model::Unified(Unified::new(at(0), terms)?)
            }
            Self::ExtendedUnified => Model::ExtendedUnified(ExtendedUnified::new(at(0), at(1))?),
            Self::DoubleSphere => Model::DoubleSphere(DoubleSphere::new(at(0), at(1))?),
            Self::Ideal(ideal) => Model::Ideal(ideal),
        })
    }
}
