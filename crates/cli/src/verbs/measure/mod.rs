//! `etendue measure`: one kind of measurement a file.

mod body;
pub mod calibrate;
pub mod cdp;
mod chart_points;
pub mod chromatic;
pub mod colour;
pub mod compare;
pub mod dark_current;
pub mod depth;
pub mod distortion;
mod encoding;
pub mod flare;
pub mod focal;
mod ghosts;
mod inquiry;
mod lens;
pub mod noise;
pub mod oecf;
mod point_list;
pub mod ptc;
mod readings;
mod report;
pub mod sfr;
pub mod shading;
pub mod texture;
mod truth;
mod views;

use crate::args::{self, Measure};
use crate::failure::Failure;

pub fn run(arguments: &args::Measure) -> Result<(), Failure> {
    match arguments {
        Measure::Lens(arguments) => lens::run(arguments),
        Measure::Ptc(arguments) => ptc::run(arguments),
        Measure::Sfr(arguments) => sfr::run(arguments),
        Measure::Oecf(arguments) => oecf::run(arguments),
        Measure::Vignetting(arguments) => shading::vignetting(arguments),
        Measure::Shading(arguments) => shading::shading(arguments),
        Measure::Noise(arguments) => noise::run(arguments),
        Measure::Flare(arguments) => flare::run(arguments),
        Measure::Colour(arguments) => colour::run(arguments),
        Measure::Cdp(arguments) => cdp::run(arguments),
        Measure::Depth(arguments) => depth::run(arguments),
        Measure::DarkCurrent(arguments) => dark_current::run(arguments),
        Measure::Star(arguments) => texture::star(arguments),
        Measure::Texture(arguments) => texture::texture(arguments),
        Measure::Distortion(arguments) => distortion::run(arguments),
        Measure::Focal(arguments) => focal::run(arguments),
        Measure::Chromatic(arguments) => chromatic::run(arguments),
        Measure::Compare(arguments) => compare::run(arguments),
    }
}

/// A number to some decimals; what rounds to nothing has no sign.
fn fixed(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_owned(),
        _ => text,
    }
}
