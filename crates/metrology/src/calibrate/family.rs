//! Which models can be fitted: their names, and the coefficients of each as a list of numbers.

use etendue_projection::model::{
    Division, DoubleSphere, ExtendedUnified, FieldOfView, Ideal, KannalaBrandt, ModelError, Perspective, Unified,
};
use etendue_projection::plane::DistortionTerms;
use etendue_projection::{Model, RadialDistortion, Sense};

/// The closed list of models by name: each with what it is, and its family.
macro_rules! camera_models {
    ($($Model:ident $name:literal, $about:literal: $family:expr;)*) => {
        /// A model that can be fitted, by name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum CameraModel {
            $(#[doc = $about] $Model,)*
        }

        impl CameraModel {
            /// All of them, the simplest first.
            pub const ALL: &[Self] = &[$(Self::$Model),*];

            /// Its name, as a user types it.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$Model => $name,)* }
            }

            /// What it is, in a few words.
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
    Pinhole "pinhole", "No distortion": perspective(Radial::Polynomial(0), false);
    Opencv "opencv", "k1 k2 p1 p2": perspective(Radial::Polynomial(2), true);
    Opencv5 "opencv5", "k1 k2 p1 p2 k3": perspective(Radial::Polynomial(3), true);
    Opencv8 "opencv8", "k1 … k6 p1 p2": perspective(Radial::Rational, true);
    Radial "radial", "k1 k2, from ideal to observed": Family::Polynomial(Sense::IdealToObserved);
    RadialInverse "radial-inverse", "k1 k2, from observed to ideal": Family::Polynomial(Sense::ObservedToIdeal);
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

fn perspective(radial: Radial, tangential: bool) -> Family {
    Family::Perspective { radial, tangential }
}

/// Radial terms of a perspective camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Radial {
    /// k₁ … kₙ, n from 0 to 3.
    Polynomial(usize),
    /// k₁ … k₆ of OpenCV's rational model.
    Rational,
}

/// A family of models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Family {
    /// Perspective with OpenCV's radial terms, and p₁, p₂ where wanted.
    Perspective {
        /// Radial terms.
        radial: Radial,
        /// Whether p₁ and p₂ are fitted.
        tangential: bool,
    },
    /// Perspective with r (1 + k₁ r² + k₂ r⁴) in either direction, r in focal lengths.
    Polynomial(Sense),
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
    /// Double sphere.
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
                    Radial::Polynomial(n) => n.min(3),
                    Radial::Rational => 6,
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

    /// Coefficients to begin with.
    pub(super) fn first(self) -> Vec<f64> {
        match self {
            Self::FieldOfView => vec![0.8],
            Self::Unified => vec![0.8, 0.0, 0.0],
            Self::ExtendedUnified => vec![0.5, 1.0],
            Self::DoubleSphere => vec![0.0, 0.5],
            _ => vec![0.0; self.names().len()],
        }
    }

    /// The model of coefficients.
    ///
    /// # Errors
    /// Where they are not legal.
    pub fn model(self, c: &[f64]) -> Result<Model, ModelError> {
        let at = |i: usize| c.get(i).copied().unwrap_or(0.0);
        Ok(match self {
            Self::Perspective { radial, tangential } => {
                let terms = self.names().len() - if tangential { 2 } else { 0 };
                let k = |i: usize| if i < terms { at(i) } else { 0.0 };
                let denominator = if radial == Radial::Rational { [k(3), k(4), k(5)] } else { [0.0; 3] };
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
