//! `[isp]`: steps from raw to image.

pub mod colour;
pub mod correction;
pub mod detail;
pub mod filter;
pub mod output;
pub mod tone;

use crate::fault::DescriptionErrors;
use crate::place::Placed;
use crate::reader::{among, choice, integer, list, number, path, record};
use std::path::PathBuf;

pub use colour::{ColourMatrix, Demosaic, WhiteBalance};
pub use correction::{BlackLevel, Shading};
pub use detail::{NoiseReduction, Sharpening};
pub use filter::GruyerFilter;
pub use output::PictureFormat;
pub use tone::ToneCurve;

record! {
    /// Processing from raw to image. The steps are those of docs/processing.md, in their order.
    pub struct Processing check(check) {
        /// Black level: the sensor's, that of its shielded rows, or a number. Default: "sensor".
        optional black_level: BlackLevel = correction::black_level();
        /// Two columns: column and row of defective pixels, from 0.
        optional defect_map: Placed<PathBuf> = path(&["csv"]);
        /// Difference from the same-colour median above which a pixel outside its neighbours' range is corrected, over white minus black. Default: no search.
        optional defect_outlier_threshold: Placed<f64> = number("").above(0.0);
        /// Shading correction.
        optional shading: Shading = record();
        /// Factors on red, green and blue, an illuminant rendered neutral, or "grey_world" (mean grey). Default: 1.
        optional white_balance: WhiteBalance = colour::white_balance();
        /// Demosaicing; all except "bilinear" need a Bayer array. Default: "bilinear".
        optional demosaic: Placed<Demosaic> = choice();
        /// Noise reduction.
        optional noise_reduction: NoiseReduction = record();
        /// Matrix to linear sRGB, three rows of one number per channel, or `{ fit = illuminant }`. Required unless channels are red, green and blue.
        optional colour_matrix: ColourMatrix = colour::colour_matrix();
        /// Factor on the linear image. Default: 1.
        optional exposure_gain: Placed<f64> = number("").above(0.0);
        /// Tone curve: sRGB (IEC 61966-2-1), linear or a table. Default: "srgb".
        optional tone_curve: ToneCurve = tone::tone_curve();
        /// Unsharp mask.
        optional sharpening: Sharpening = record();
        /// Filters of Gruyer, Grapinet, De Souza (2012), in order, those on linear light first.
        many image_filters: GruyerFilter = list(record(), 1);
        /// Bits per channel; above 8 in 16-bit PNG, scaled to its range. Default: 8.
        optional picture_bits: Placed<u64> = among(&[8, 10, 12, 16]);
        /// Image format; "jpeg" with 8 bits. Default: "png".
        optional picture_format: Placed<PictureFormat> = choice();
        /// JPEG quality. Default: 90.
        optional jpeg_quality: Placed<u64> = integer(1, 100);
    }
}

fn check(processing: &Processing, errors: &mut DescriptionErrors) {
    let (bits, quality) = (processing.picture_bits.as_ref(), processing.jpeg_quality.as_ref());
    output::check(processing.picture_format.as_ref(), bits, quality, errors);
}

impl Processing {
    /// Files that the record names.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Placed<PathBuf>> {
        let grid = self.shading.as_ref().and_then(Shading::file);
        let mapped = self.image_filters.iter().filter_map(GruyerFilter::curve);
        let curves = self.tone_curve.iter().chain(mapped).filter_map(ToneCurve::file);
        self.defect_map.iter().chain(grid).chain(curves)
    }
}
