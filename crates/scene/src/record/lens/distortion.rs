//! Radial distortion of a paraxial lens.

use crate::place::Placed;
use crate::reader::{choice, number, record, words};

record! {
    /// Radial distortion r′ = r·(1 + k1·r² + k2·r⁴) about the principal point.
    pub struct Distortion {
        /// Coefficient of r².
        required k1: Placed<f64> = number("");
        /// Coefficient of r⁴. Default: 0.
        optional k2: Placed<f64> = number("");
        /// Whether r is the radius of the ideal picture and r′ the observed one, or the other way round.
        required direction: Placed<Direction> = choice();
        /// The unit of r and r′.
        required radius_unit: Placed<RadiusUnit> = choice();
    }
}

words! {
    /// Which way a distortion polynomial maps.
    pub enum Direction {
        /// From the undistorted picture to the distorted one (OpenCV).
        "ideal_to_observed" => IdealToObserved,
        /// From the distorted picture to the undistorted one.
        "observed_to_ideal" => ObservedToIdeal,
    }
}

words! {
    /// The unit of a radius on the sensor.
    pub enum RadiusUnit {
        /// Millimetres.
        "mm" => Millimetres,
        /// Focal lengths (OpenCV).
        "focal_lengths" => FocalLengths,
        /// Half the diagonal of the picture.
        "half_diagonals" => HalfDiagonals,
        /// Pixels.
        "pixels" => Pixels,
    }
}
