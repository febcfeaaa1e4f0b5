//! A point's light at one place of the field, as lens programs write it.

/// Where in the field a point is, in the lens program's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldPoint {
    /// By the angles of x and y in front of the lens, degrees.
    Degrees([f64; 2]),
    /// By x and y of the picture, mm.
    Millimetres([f64; 2]),
}

/// The light of a point on samples of the sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct PointSpreadAsset {
    /// The field that the file states.
    pub field: FieldPoint,
    /// Where the point is on the sensor, x and y, mm from the axis; `None`: the file does not say it.
    pub place_mm: Option<[f64; 2]>,
    /// Shortest and longest wavelength, nm; alike of one wavelength.
    pub wavelengths_nm: [f64; 2],
    /// Distance of samples, µm.
    pub spacing_um: f64,
    /// Samples in a row.
    pub width: usize,
    /// Light, row by row from the greatest y on, in a row from the least x on; in any unit.
    pub light: Vec<f32>,
    /// The sample at the point: column from the left and row from the top, from 0.
    pub point: [usize; 2],
    /// What was made of the file, a sentence each.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}
