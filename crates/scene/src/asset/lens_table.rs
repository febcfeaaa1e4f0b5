//! A table of a lens, as lens programs write it.

/// What a table of a lens tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LensQuantity {
    /// Irradiance over that on the axis, by the field.
    RelativeIllumination,
    /// The radius in the picture over that of a lens without distortion, by the field angle.
    Distortion,
    /// Modulation by the spatial frequency.
    Modulation,
}

/// What the numbers of a table are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LensNumbers {
    /// Angle from the axis in front of the lens, degrees, from 0; irradiance over that on the axis.
    IlluminationByAngle,
    /// Distance from the axis in the picture, mm, from 0; irradiance over that on the axis.
    IlluminationByRadius,
    /// Angle from the axis, degrees, from 0; radius over that of `beside`, whose focal length is `focal_length_mm` where the file says it.
    Distortion {
        /// The lens without distortion.
        beside: Undistorted,
        /// Its focal length, mm; `None`: the file does not say it.
        focal_length_mm: Option<f64>,
    },
    /// Spatial frequency in the picture, cycles/mm, rising; modulation, 1 at 0.
    Modulation,
}

/// What a lens without distortion would do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undistorted {
    /// r = f tan θ.
    Tangent,
    /// r = f θ.
    Angle,
}

/// A table of a lens.
#[derive(Clone, Debug, PartialEq)]
pub struct LensTableAsset {
    /// What its numbers are.
    pub numbers: LensNumbers,
    /// Pairs of numbers, the first rising.
    pub points: Vec<(f64, f64)>,
    /// What was made of the file and what was passed over, a sentence each.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}
