//! Point-spread function at one field point, as written by lens programs.

/// Field point, in the lens program's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldPoint {
    /// Field angles in x and y in front of the lens, degrees.
    Degrees([f64; 2]),
    /// Position x, y on the image, mm.
    Millimetres([f64; 2]),
}

/// Image of a point, sampled on the sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct PointSpreadAsset {
    /// Field point that the file states.
    pub field: FieldPoint,
    /// Position of the point on the sensor, x and y, mm from the axis; `None` if the file does not state it.
    pub place_mm: Option<[f64; 2]>,
    /// Shortest and longest wavelength, nm; equal for one wavelength.
    pub wavelengths_nm: [f64; 2],
    /// Sample spacing, µm.
    pub spacing_um: f64,
    /// Samples in a row.
    pub width: usize,
    /// Irradiance, row by row from the greatest y on, in a row from the least x on; in any unit.
    pub light: Vec<f32>,
    /// Sample at the point: column from the left and row from the top, from 0.
    pub point: [usize; 2],
    /// Interpretation of the file, one sentence each.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}
