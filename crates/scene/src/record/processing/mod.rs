//! `[isp]`: from raw to picture, step by step.

pub mod colour;
pub mod correction;
pub mod detail;
pub mod filter;
pub mod output;
pub mod tone;

use crate::fault::Faults;
use crate::place::Placed;
use crate::reader::{among, choice, list, number, path, record, whole};
use std::path::PathBuf;

pub use colour::{ColourMatrix, Demosaic, WhiteBalance};
pub use correction::{BlackLevel, Shading};
pub use detail::{NoiseReduction, Sharpening};
pub use filter::PaperFilter;
pub use output::PictureFormat;
pub use tone::ToneCurve;

record! {
    /// From raw to picture. The steps are those of docs/processing.md, in their order.
    pub struct Processing check(check) {
        /// What counts as no light: "sensor" (the sensor's black level), "optical_black" (from the sensor's shielded rows), or
        /// a number, DN. Default: "sensor".
        optional black_level: BlackLevel = correction::black_level();
        /// Columns and rows of pixels known to be defective, counted from 0: a table of two columns. Default: none.
        optional defect_map: Placed<PathBuf> = path(&["csv"]);
        /// Share of the range from black to white, above 0, by which a pixel must differ from the median of its neighbours
        /// of the same colour, and lie outside their range, to be corrected as defective. Default: none is looked for.
        optional defect_outlier_threshold: Placed<f64> = number("").above(0.0);
        /// Gains, 1 or more, that make an even light even. Default: none.
        optional shading: Shading = record();
        /// Factors on the channels (red, green and blue), above 0, the name of the illuminant that shall come out neutral, or
        /// "grey_world" for factors that make each picture's mean grey. Default: 1 for each.
        optional white_balance: WhiteBalance = colour::white_balance();
        /// How the colours that a pixel did not measure are found; all but "bilinear" need a Bayer filter array.
        /// Default: "bilinear".
        optional demosaic: Placed<Demosaic> = choice();
        /// Noise reduction before colour. Default: none.
        optional noise_reduction: NoiseReduction = record();
        /// From the sensor's channels (red, green and blue) to linear sRGB: three rows of one number a channel, or
        /// `{ fit = illuminant }` for the matrix that fits the colour chart best under an illuminant. Default: none, the
        /// sensor's colours are kept; a sensor of other channels than red, green and blue needs one.
        optional colour_matrix: ColourMatrix = colour::colour_matrix();
        /// Factor on the linear picture, above 0. Default: 1.
        optional exposure_gain: Placed<f64> = number("").above(0.0);
        /// From linear light to the picture's numbers: "srgb" (IEC 61966-2-1), "linear", or a table. Default: "srgb".
        optional tone_curve: ToneCurve = tone::tone_curve();
        /// Unsharp mask on the encoded picture. Default: none.
        optional sharpening: Sharpening = record();
        /// Filters of the paper, one after the other; those of linear light (glow, tone map, linear colour) come first.
        many image_filters: PaperFilter = list(record(), 1);
        /// Bits of each of the picture's channels, 8, 10, 12 or 16; more than 8 are kept in a 16-bit PNG, scaled to its range.
        /// Default: 8.
        optional picture_bits: Placed<u64> = among(&[8, 10, 12, 16]);
        /// "png", or "jpeg" with 8 bits. Default: "png".
        optional picture_format: Placed<PictureFormat> = choice();
        /// With "jpeg": quality, 1 … 100. Default: 90.
        optional jpeg_quality: Placed<u64> = whole(1, 100);
    }
}

fn check(processing: &Processing, faults: &mut Faults) {
    let (bits, quality) = (processing.picture_bits.as_ref(), processing.jpeg_quality.as_ref());
    output::check(processing.picture_format.as_ref(), bits, quality, faults);
}

impl Processing {
    /// The tables that it names.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Placed<PathBuf>> {
        let grid = self.shading.as_ref().and_then(Shading::file);
        let mapped = self.image_filters.iter().filter_map(PaperFilter::curve);
        let curves = self.tone_curve.iter().chain(mapped).filter_map(ToneCurve::file);
        self.defect_map.iter().chain(grid).chain(curves)
    }
}
