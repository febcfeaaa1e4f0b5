//! Tables of materials: refractive indices of metals, coefficients of retro-reflection.

/// Complex refractive index n + i k by wavelength, as stored in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ComplexIndexAsset {
    /// Wavelength (nm, increasing), n (above 0) and k (0 or more).
    pub points: Vec<(f64, f64, f64)>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

/// Coefficients of retro-reflection R_A (cd·lx⁻¹·m⁻²) by observation and entrance angle (CIE 54.2; ASTM E810).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RetroTableAsset {
    /// Observation angles between the directions to the light and to the observer, degrees, increasing, 0 … 180.
    pub observation_deg: Vec<f64>,
    /// Entrance angles between the direction to the light and the normal, degrees, increasing, 0 … 90.
    pub entrance_deg: Vec<f64>,
    /// R_A: all entrance angles of the first observation angle, then of the next; 0 or more.
    pub coefficients: Vec<f64>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

impl RetroTableAsset {
    /// Coefficients of the observation angle with this index, one per entrance angle.
    #[must_use]
    pub fn row(&self, observation: usize) -> &[f64] {
        let columns = self.entrance_deg.len();
        &self.coefficients[observation * columns..][..columns]
    }
}

/// Numbers in rows of equal length: a tone curve, a map of defects, a grid of gains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NumbersAsset {
    /// Numbers of a row.
    pub columns: usize,
    /// All rows one after the other.
    pub values: Vec<f64>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

impl NumbersAsset {
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks(self.columns.max(1))
    }
}
