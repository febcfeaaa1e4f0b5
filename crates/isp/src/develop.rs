//! The whole way from a raw picture to a display.

use crate::colour_matrix::ColourMatrix;
use crate::demosaic::demosaic;
use crate::mosaic::Mosaic;
use crate::tone::encode;
use crate::white_balance::gain;
use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Display, LinearRgb};
use rayon::prelude::*;

/// A raw picture, with what development needs to know.
#[derive(Clone, Copy, Debug)]
pub struct RawPicture<'a> {
    /// Digital numbers.
    pub plane: &'a Plane<DigitalNumber>,
    /// Digital number of no light.
    pub black_level_dn: f64,
    /// Digital number of a saturated pixel.
    pub white_level_dn: f64,
    /// Which pixel measures which colour.
    pub mosaic: &'a Mosaic,
}

/// How colours of a camera become those of a display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour {
    /// Gains of red, green and blue, each at least 1 so that saturated pixels stay white.
    pub white_balance: [f64; 3],
    /// From white-balanced camera colours to linear sRGB.
    pub matrix: ColourMatrix,
}

/// How a raw picture is developed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Processing {
    /// Colour; `None` for a mono picture, and only for one.
    pub colour: Option<Colour>,
    /// Digital gain after colour, above 0; 1 shows the white level as white.
    pub exposure_gain: f64,
}

/// A developed picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Developed {
    /// Linear sRGB, not clipped below 0 nor above 1.
    pub linear: Plane<LinearRgb>,
    /// The same, clipped and encoded.
    pub display: Plane<Display>,
}

/// Why a picture cannot be developed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DevelopError {
    /// There is no range between black and white.
    #[error("the white level is {white} DN and the black level {black} DN: white must be above black")]
    Levels {
        /// Black level, DN.
        black: f64,
        /// White level, DN.
        white: f64,
    },
    /// Gains that are no gains.
    #[error("white balance is {0:?}, but finite gains of at least 1 are needed: divide them by the smallest")]
    WhiteBalance([f64; 3]),
    /// A matrix with an entry that is not finite.
    #[error("the colour matrix has an entry that is not finite")]
    Matrix,
    /// An exposure gain that is none.
    #[error("exposure_gain is {0}, but a finite number above 0 is needed")]
    ExposureGain(f64),
    /// Colour settings for a picture without colour.
    #[error("a mono picture has no colour to balance: leave white balance and colour matrix out")]
    ColourOfMono,
    /// No colour settings for a picture with colour.
    #[error("a colour mosaic needs white balance and a colour matrix, but neither is given")]
    NoColour,
    /// Too few pixels to interpolate.
    #[error("a colour mosaic of {width} × {height} pixels cannot be demosaiced: at least 2 × 2 are needed")]
    TooSmall {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
}

/// Develops a raw picture. Runs in the rayon pool of the caller; the bits do not depend on it.
///
/// # Errors
/// Where picture and processing contradict each other or a number is out of range.
pub fn develop(raw: &RawPicture<'_>, processing: &Processing) -> Result<Developed, DevelopError> {
    check(raw, processing)?;
    let mut linear = demosaic(&balanced(raw, processing.colour.as_ref()), raw.plane.width(), raw.mosaic);
    let matrix = output_matrix(processing);
    linear.samples_mut().par_iter_mut().for_each(|rgb| *rgb = product(&matrix, *rgb));
    let display = encode(&linear);
    Ok(Developed { linear, display })
}

fn check(raw: &RawPicture<'_>, processing: &Processing) -> Result<(), DevelopError> {
    let (black, white) = (raw.black_level_dn, raw.white_level_dn);
    if !(black.is_finite() && white.is_finite() && white > black) {
        return Err(DevelopError::Levels { black, white });
    }
    let exposure = processing.exposure_gain;
    if !(exposure.is_finite() && exposure > 0.0) {
        return Err(DevelopError::ExposureGain(exposure));
    }
    match (raw.mosaic, &processing.colour) {
        (Mosaic::Mono, None) => Ok(()),
        (Mosaic::Mono, Some(_)) => Err(DevelopError::ColourOfMono),
        (Mosaic::Tile(_), None) => Err(DevelopError::NoColour),
        (Mosaic::Tile(_), Some(colour)) => check_colour(raw, colour),
    }
}

fn check_colour(raw: &RawPicture<'_>, colour: &Colour) -> Result<(), DevelopError> {
    let (width, height) = (raw.plane.width(), raw.plane.height());
    if width < 2 || height < 2 {
        return Err(DevelopError::TooSmall { width, height });
    }
    if !colour.white_balance.iter().all(|g| g.is_finite() && *g >= 1.0) {
        return Err(DevelopError::WhiteBalance(colour.white_balance));
    }
    if !colour.matrix.as_flattened().iter().all(|m| m.is_finite()) {
        return Err(DevelopError::Matrix);
    }
    Ok(())
}

/// Samples with black at 0 and white at 1, balanced; no sample exceeds 1. Noise below black stays negative.
fn balanced(raw: &RawPicture<'_>, colour: Option<&Colour>) -> Vec<f32> {
    let width = raw.plane.width();
    let black = raw.black_level_dn as f32;
    let scale = (1.0 / (raw.white_level_dn - raw.black_level_dn)) as f32;
    let gain_at = |i: usize| match (raw.mosaic, colour) {
        (Mosaic::Tile(tile), Some(colour)) => gain(colour.white_balance, tile.at(i % width, i / width)),
        _ => 1.0,
    };
    // Digital numbers have at most 24 bits, which f32 holds.
    let value = |(i, dn): (usize, &u32)| ((*dn as f32 - black) * scale).min(1.0) * gain_at(i);
    raw.plane.samples().par_iter().enumerate().map(|sample| value(sample).min(1.0)).collect()
}

/// Colour matrix and digital gain in one.
fn output_matrix(processing: &Processing) -> [[f32; 3]; 3] {
    const IDENTITY: ColourMatrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let matrix = processing.colour.map_or(IDENTITY, |c| c.matrix);
    matrix.map(|row| row.map(|m| (m * processing.exposure_gain) as f32))
}

fn product(matrix: &[[f32; 3]; 3], rgb: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mosaic::Filter::{Blue, Green, Red};
    use crate::tone::to_8_bit;
    use etendue_spectra::colour;

    const COLOUR: Colour =
        Colour { white_balance: [2.0, 1.0, 1.5], matrix: [[1.75, -0.5, -0.25], [-0.25, 1.5, -0.25], [0.0, -0.5, 1.5]] };
    const PROCESSING: Processing = Processing { colour: Some(COLOUR), exposure_gain: 1.0 };

    fn bayer() -> Mosaic {
        Mosaic::tile(2, 2, vec![Red, Green, Green, Blue]).expect("Bayer")
    }

    fn developed(dn: [u32; 4], processing: Processing) -> Developed {
        let samples = (0..48).map(|i| dn[i / 8 % 2 * 2 + i % 2]).collect();
        let plane = Plane::from_samples(8, 6, samples).expect("filled");
        let raw = RawPicture { plane: &plane, black_level_dn: 100.0, white_level_dn: 1100.0, mosaic: &bayer() };
        develop(&raw, &processing).expect("legal")
    }

    #[test]
    fn neutral_stays_neutral() {
        // 0.2 of the range in green, and as much after balance in red and blue.
        let picture = developed([200, 300, 300, 233], Processing { exposure_gain: 2.0, ..PROCESSING });
        for rgb in picture.linear.samples() {
            // Blue is off by a third of a digital number: 0.0005 · 1.5 · 2, times up to 1.5 by the matrix.
            assert!(rgb.iter().all(|v| (v - 0.4).abs() < 2.5e-3), "{rgb:?}");
        }
        let code = (255.0 * colour::encode(0.4)).round() as u8;
        assert!(to_8_bit(&picture.display).iter().flatten().all(|v| v.abs_diff(code) <= 1));
    }

    #[test]
    fn saturation_is_white_and_not_magenta() {
        for dn in [[1100; 4], [4095; 4], [900, 1100, 1100, 950]] {
            let picture = developed(dn, PROCESSING);
            assert!(picture.linear.samples().iter().flatten().all(|v| (v - 1.0).abs() < 1e-6));
            assert!(to_8_bit(&picture.display).iter().all(|rgb| *rgb == [255; 3]));
        }
    }

    #[test]
    fn noise_below_black_survives_to_the_linear_picture() {
        let picture = developed([90; 4], PROCESSING);
        assert!(picture.linear.samples().iter().all(|rgb| rgb[1] < 0.0));
        assert!(to_8_bit(&picture.display).iter().all(|rgb| *rgb == [0; 3]));
    }

    #[test]
    fn mono_is_grey() {
        let plane = Plane::from_samples(3, 1, vec![100, 600, 1100]).expect("filled");
        let raw = RawPicture { plane: &plane, black_level_dn: 100.0, white_level_dn: 1100.0, mosaic: &Mosaic::Mono };
        let picture = develop(&raw, &Processing { colour: None, exposure_gain: 1.0 }).expect("legal");
        assert_eq!(picture.linear.samples(), [[0.0; 3], [0.5; 3], [1.0; 3]]);
    }

    #[test]
    fn contradictions_are_refused() {
        let plane = Plane::new(4, 4);
        let mosaic = bayer();
        let raw = RawPicture { plane: &plane, black_level_dn: 0.0, white_level_dn: 10.0, mosaic: &mosaic };
        let mono = RawPicture { mosaic: &Mosaic::Mono, ..raw };
        let with = |white_balance| Processing { colour: Some(Colour { white_balance, ..COLOUR }), ..PROCESSING };
        let dim = Processing { exposure_gain: 0.0, ..PROCESSING };
        let no_colour = Processing { colour: None, ..PROCESSING };
        let thin = Plane::new(4, 1);
        let cases = [
            (RawPicture { white_level_dn: 0.0, ..raw }, PROCESSING, DevelopError::Levels { black: 0.0, white: 0.0 }),
            (raw, with([0.5, 1.0, 2.0]), DevelopError::WhiteBalance([0.5, 1.0, 2.0])),
            (raw, dim, DevelopError::ExposureGain(0.0)),
            (raw, no_colour, DevelopError::NoColour),
            (mono, PROCESSING, DevelopError::ColourOfMono),
            (RawPicture { plane: &thin, ..raw }, PROCESSING, DevelopError::TooSmall { width: 4, height: 1 }),
        ];
        for (raw, processing, error) in cases {
            assert_eq!(develop(&raw, &processing), Err(error));
        }
    }

    #[test]
    fn threads_change_no_bit() {
        let plane =
            Plane::from_samples(31, 17, (0..31 * 17).map(|i| (i * 37 % 1200) as u32).collect()).expect("filled");
        let mosaic = bayer();
        let raw = RawPicture { plane: &plane, black_level_dn: 64.0, white_level_dn: 1100.0, mosaic: &mosaic };
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| develop(&raw, &PROCESSING).expect("legal"))
        };
        assert_eq!(with(1), with(3));
    }
}
