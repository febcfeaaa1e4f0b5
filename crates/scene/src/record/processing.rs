//! `[processing]`: from raw to picture.

use super::light::illuminants;
use crate::place::Placed;
use crate::reader::{Rule, RuleExt as _, either, exactly, keyed, number, record, vector};

record! {
    /// From raw to picture, which is encoded by the curve of IEC 61966-2-1 (sRGB).
    pub struct Processing {
        /// Factors on red, green and blue, above 0, or the name of the illuminant that shall come out neutral.
        /// Default: 1, 1, 1.
        optional white_balance: WhiteBalance = white_balance();
        /// From the sensor's red, green and blue to linear sRGB: three rows of three, or `{ fit = illuminant }` for the
        /// matrix that fits the colour chart best under an illuminant. Default: none, the sensor's colours are kept.
        optional colour_matrix: ColourMatrix = colour_matrix();
        /// Factor on the linear picture, above 0. Default: 1.
        optional exposure_gain: Placed<f64> = number("").above(0.0);
    }
}

/// What makes grey grey.
#[derive(Clone, Debug)]
pub enum WhiteBalance {
    /// Factors on red, green and blue.
    Factors(Placed<[f64; 3]>),
    /// The illuminant that comes out neutral.
    Illuminant(Placed<String>),
}

/// From the sensor's colours to linear sRGB.
#[derive(Clone, Debug)]
pub enum ColourMatrix {
    /// By rows.
    Rows([Placed<[f64; 3]>; 3]),
    /// Fitted under an illuminant.
    Fit(Placed<String>),
}

keyed! {
    /// How a colour matrix is found.
    pub enum ColourMatrixTable {
        /// The name of the illuminant under which the colour chart is fitted.
        fit => Fit(Placed<String>) = illuminants();
    }
}

fn white_balance() -> impl Rule<Out = WhiteBalance> {
    let factors = vector::<3>(number("").above(0.0)).map(WhiteBalance::Factors);
    either(factors, illuminants().map(WhiteBalance::Illuminant))
}

fn colour_matrix() -> impl Rule<Out = ColourMatrix> {
    let rows = exactly(vector::<3>(number(""))).map(|rows| ColourMatrix::Rows(rows.value));
    let fit = record::<ColourMatrixTable>().map(|ColourMatrixTable::Fit(name)| ColourMatrix::Fit(name));
    either(rows, fit)
}
