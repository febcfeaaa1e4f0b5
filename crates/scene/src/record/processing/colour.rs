//! Conversion of the sensor's channels to colours.

use super::super::light::illuminants;
use crate::place::Placed;
use crate::reader::{Rule, either, exactly, keyed, known, list, number, record, variant, words};
use etendue_spectra::illuminant;

words! {
    /// Demosaicing method.
    pub enum Demosaic {
        /// Weighted means of the neighbours of each colour.
        "bilinear" => Bilinear,
        /// Malvar, He & Cutler 2004: bilinear with a correction by the measured colour's own gradient.
        "malvar" => Malvar,
        /// Hamilton & Adams 1997: interpolation along the smaller gradient.
        "hamilton_adams" => HamiltonAdams,
    }
}

#[derive(Clone, Debug)]
pub enum WhiteBalance {
    /// Factors on the channels.
    Factors(Vec<Placed<f64>>),
    /// The illuminant that is rendered neutral, or "grey_world".
    Named(Placed<String>),
}

impl WhiteBalance {
    /// Name of the rule that makes each image's mean grey.
    pub const GREY_WORLD: &str = "grey_world";
}

/// Matrix from the sensor's colours to linear sRGB.
#[derive(Clone, Debug)]
pub enum ColourMatrix {
    /// By rows.
    Rows(Placed<[Vec<Placed<f64>>; 3]>),
    /// Fitted under an illuminant.
    Fit(Placed<String>),
}

keyed! {
    /// A fitted colour matrix.
    pub enum ColourMatrixTable {
        /// Illuminant of the fit.
        fit => Fit(Placed<String>) = illuminants();
    }
}

pub(super) fn white_balance() -> impl Rule<Out = WhiteBalance> {
    let factors = variant!(list(number("").above(0.0), 2), WhiteBalance::Factors);
    let names = [&[WhiteBalance::GREY_WORLD, "solar"], illuminant::names()].concat();
    either(factors, variant!(known("a rule or an illuminant", &names), WhiteBalance::Named))
}

pub(super) fn colour_matrix() -> impl Rule<Out = ColourMatrix> {
    let rows = variant!(exactly(list(number(""), 2)), ColourMatrix::Rows);
    let fit = variant!(record::<ColourMatrixTable>(), ColourMatrixTable::Fit => ColourMatrix::Fit);
    either(rows, fit)
}
