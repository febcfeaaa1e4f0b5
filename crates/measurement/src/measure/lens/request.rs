//! Request of `measure lens`.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::Args;
use etendue_arguments::integer;

/// Range of the number of field heights.
pub(super) const FIELDS: RangeInclusive<u32> = 2..=1000;

/// A lens and the field heights to measure.
#[derive(Args, Clone, Debug)]
pub struct LensRequest {
    /// Camera file (TOML), lens of Zemax (.zmx) or CODE V (.seq), or name of a published lens (double-gauss, wide-angle, fisheye,
    /// telephoto)
    #[arg(value_name = "FILE")]
    pub lens: String,
    /// Change a key of the camera, e.g. --set lens.f_number=4
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// F-number at infinity focus, in place of the camera's or the lens file's
    #[arg(long, value_name = "N")]
    pub f_number: Option<f64>,
    /// Glass catalogue of Zemax (.agf), searched before those built in; may be repeated
    #[arg(long, value_name = "FILE")]
    pub glasses: Vec<PathBuf>,
    /// Number of field heights, from the axis to the edge of the image
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = integer(FIELDS))]
    pub fields: u32,
    /// For a lens without a sensor: radius of the image from the axis, mm [default: the largest field that a lens file states,
    /// otherwise where half of the axis's light arrives; at most 21.64]
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub picture_radius_mm: Option<f64>,
    /// Wavelength of the first-order figures of a prescription, nm [default: the primary wavelength of a lens file, otherwise
    /// 587.56]; fields stay at 587.56 nm
    #[arg(long, value_name = "NM", allow_negative_numbers = true)]
    pub wavelength_nm: Option<f64>,
}

impl LensRequest {
    /// Creates a request with the program's defaults.
    pub fn new(lens: impl Into<String>) -> Self {
        Self {
            lens: lens.into(),
            set: Vec::new(),
            f_number: None,
            glasses: Vec::new(),
            fields: 6,
            picture_radius_mm: None,
            wavelength_nm: None,
        }
    }
}
