//! From a camera's white-balanced colours to linear sRGB.
//!
//! A matrix of three rows and as many columns as the picture has channels. Rows that sum to 1 keep neutral what white
//! balance made neutral; [`fit_colour_matrix`] finds such a matrix from the camera's own spectra.

mod fit;

pub use fit::{FitError, NOISE_OF_OTHER_CHANNELS, fit_colour_matrix};

/// Rows give red, green and blue of linear sRGB, columns are the channels.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourMatrix {
    rows: [Vec<f64>; 3],
}

/// Why rows are no matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MatrixError {
    /// Rows of different lengths.
    #[error("the rows of a colour matrix have one number for each of the camera's channels; these differ in length")]
    Ragged,
    /// An entry that is not finite.
    #[error("the colour matrix has an entry that is not finite")]
    NotFinite,
}

impl ColourMatrix {
    /// A matrix by rows.
    ///
    /// # Errors
    /// Where the rows differ in length or an entry is not finite.
    pub fn new(rows: [Vec<f64>; 3]) -> Result<Self, MatrixError> {
        if rows.iter().any(|row| row.len() != rows[0].len()) {
            return Err(MatrixError::Ragged);
        }
        if !rows.iter().flatten().all(|m| m.is_finite()) {
            return Err(MatrixError::NotFinite);
        }
        Ok(Self { rows })
    }

    /// Three channels as they are.
    #[must_use]
    pub fn identity() -> Self {
        Self { rows: [0, 1, 2].map(|i| (0..3).map(|j| f64::from(u8::from(i == j))).collect()) }
    }

    /// Red, green and blue by rows.
    #[must_use]
    pub fn rows(&self) -> &[Vec<f64>; 3] {
        &self.rows
    }

    /// Channels of the camera.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.rows[0].len()
    }

    /// The colour of each channel under the matrix.
    #[must_use]
    pub fn apply(&self, channels: &[f64]) -> [f64; 3] {
        self.rows.each_ref().map(|row| row.iter().zip(channels).map(|(m, c)| m * c).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_colours_and_columns_channels() {
        let matrix = ColourMatrix::new([vec![1.0, 2.0], vec![0.5, 0.0], vec![-1.0, 1.0]]).expect("a matrix");
        assert_eq!((matrix.channels(), matrix.apply(&[1.0, 3.0])), (2, [7.0, 0.5, 2.0]));
        assert_eq!(ColourMatrix::identity().apply(&[0.1, 0.2, 0.3]), [0.1, 0.2, 0.3]);
        assert_eq!(ColourMatrix::new([vec![1.0], vec![], vec![1.0]]), Err(MatrixError::Ragged));
        assert_eq!(ColourMatrix::new([0, 1, 2].map(|_| vec![f64::NAN])), Err(MatrixError::NotFinite));
    }
}
