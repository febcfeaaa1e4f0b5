//! `[isp]`: steps from raw to image.

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
    /// Processing from raw to image. The steps are those of docs/processing.md, in their order.
    pub struct Processing check(check) {
        /// Black level: "sensor" (the sensor's black level), "optical_black" (from the sensor's shielded rows), or a number, DN. Default: "sensor".
        optional black_level: BlackLevel = correction::black_level();
        /// Columns and rows of pixels known to be defective, counted from 0: a table of two columns. Default: none.
        optional defect_map: Placed<PathBuf> = path(&["csv"]);
        /// Threshold above which a pixel is corrected as defective: difference from the median of its neighbours of the same colour, as a fraction of
        /// the range from black to white, above 0. The pixel must also lie outside their range. Default: no search for defects.
        optional defect_outlier_threshold: Placed<f64> = number("").above(0.0);
        /// Shading correction: gains, 1 or more, that make uniform illumination uniform in the image. Default: none.
        optional shading: Shading = record();
        /// White balance: factors on the channels (red, green and blue), above 0, the name of the illuminant that is rendered neutral, or
        /// "grey_world" for factors that make each image's mean grey. Default: 1 for each.
        optional white_balance: WhiteBalance = colour::white_balance();
        /// Demosaicing method; all except "bilinear" need a Bayer filter array. Default: "bilinear".
        optional demosaic: Placed<Demosaic> = choice();
        /// Noise reduction before colour. Default: none.
        optional noise_reduction: NoiseReduction = record();
        /// Matrix from the sensor's channels (red, green and blue) to linear sRGB: three rows of one number per channel, or `{ fit = illuminant }`
        /// for the best fit to the colour chart under an illuminant. Required for a sensor of other channels than red, green and blue. Default: none,
        /// the sensor's colours are used.
        optional colour_matrix: ColourMatrix = colour::colour_matrix();
        /// Factor on the linear image, above 0. Default: 1.
        optional exposure_gain: Placed<f64> = number("").above(0.0);
        /// Tone curve from linear light to image values: "srgb" (IEC 61966-2-1), "linear", or a table. Default: "srgb".
        optional tone_curve: ToneCurve = tone::tone_curve();
        /// Unsharp mask on the encoded image. Default: none.
        optional sharpening: Sharpening = record();
        /// Filters of Gruyer, Grapinet, De Souza (2012), applied in order; those on linear light (glow, tone map, linear colour) come first.
        many image_filters: PaperFilter = list(record(), 1);
        /// Bits of each image channel, 8, 10, 12 or 16; more than 8 are stored in a 16-bit PNG, scaled to its range. Default: 8.
        optional picture_bits: Placed<u64> = among(&[8, 10, 12, 16]);
        /// File format of the image: "png", or "jpeg" with 8 bits. Default: "png".
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
    /// Files that the record names.
    pub(crate) fn files(&self) -> impl Iterator<Item = &Placed<PathBuf>> {
        let grid = self.shading.as_ref().and_then(Shading::file);
        let mapped = self.image_filters.iter().filter_map(PaperFilter::curve);
        let curves = self.tone_curve.iter().chain(mapped).filter_map(ToneCurve::file);
        self.defect_map.iter().chain(grid).chain(curves)
    }
}
