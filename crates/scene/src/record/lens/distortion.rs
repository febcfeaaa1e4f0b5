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
        /// Direction of the mapping from r to r′.
        required direction: Placed<Direction> = choice();
        /// Unit of r and r′.
        required radius_unit: Placed<RadiusUnit> = choice();
    }
}

words! {
    /// Direction of a distortion polynomial.
    pub enum Direction {
        /// From the undistorted image to the distorted one (OpenCV).
        "ideal_to_observed" => IdealToObserved,
        /// From the distorted image to the undistorted one.
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
        /// Half the diagonal of the image.
        "half_diagonals" => HalfDiagonals,
        /// Pixels.
        "pixels" => Pixels,
    }
}
