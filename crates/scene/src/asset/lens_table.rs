//! A table of a lens, as written by lens programs.

/// Quantity of a lens table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LensQuantity {
    /// Irradiance over that on the axis, by the field.
    RelativeIllumination,
    /// Image radius over that of a lens without distortion, by the field angle.
    Distortion,
    /// Modulation by the spatial frequency.
    Modulation,
}

/// Meaning of a table's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LensNumbers {
    /// Angle from the axis in front of the lens, degrees, from 0; irradiance over that on the axis.
    IlluminationByAngle,
    /// Distance from the axis on the image, mm, from 0; irradiance over that on the axis.
    IlluminationByRadius,
    /// Angle from the axis, degrees, from 0; radius over that of `beside`, whose focal length is `focal_length_mm` if the file states it.
    Distortion {
        /// The lens without distortion.
        reference: UndistortedProjection,
        /// Focal length of that lens, mm; `None` if the file does not state it.
        focal_length_mm: Option<f64>,
    },
    /// Spatial frequency on the image, cycles/mm, increasing; modulation, 1 at 0.
    Modulation,
}

/// Projection of a lens without distortion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UndistortedProjection {
    /// r = f tan θ.
    Tangent,
    /// r = f θ.
    Angle,
}

/// A table of a lens.
#[derive(Clone, Debug, PartialEq)]
pub struct LensTableAsset {
    /// Meaning of its numbers.
    pub numbers: LensNumbers,
    /// Pairs of numbers, the first increasing.
    pub points: Vec<(f64, f64)>,
    /// Interpreted and ignored content of the file, one sentence each.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}
