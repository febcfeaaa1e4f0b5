//! Text on processing: its steps, and the reasons for which others are absent.

use super::line;
use crate::plan::{CameraPlan, Development, PictureFormat};
use etendue_isp::paper::{Filter, Stage};
use etendue_isp::{
    BlackLevel, ColourMatrix, Demosaic, Mosaic, NoiseReduction, Processing, Shading, ToneCurve, WhiteBalance,
};
use std::fmt::{self, Formatter};

/// Writes the lines of a camera's processing.
pub(super) fn processing(camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let Some(development) = &camera.body.development else {
        return line(f, "processing", "none: no image is produced");
    };
    line(f, "processing", development.to_string())?;
    line(f, "left out", omitted_steps(&development.processing))
}

/// The steps, in order.
impl fmt::Display for Development {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { mosaic, processing, format } = self;
        let steps = corrections(processing)
            .into_iter()
            .chain(colour(processing, mosaic))
            .chain([format!("gain {}", processing.exposure_gain)])
            .chain(paper(processing, Stage::Linear))
            .chain([tone(&processing.tone)])
            .chain(processing.sharpening.map(|s| format!("unsharp mask of {} px, amount {}", s.radius_px, s.amount)))
            .chain(paper(processing, Stage::Display))
            .chain([format_name(*format)]);
        f.write_str(&steps.collect::<Vec<_>>().join(", "))
    }
}

fn corrections(p: &Processing) -> Vec<String> {
    let black = match p.black_level {
        BlackLevel::Stated => None,
        BlackLevel::Fixed(dn) => Some(format!("black level {dn} DN")),
        BlackLevel::OpticalBlack => Some("black level from optical-black rows".to_owned()),
    };
    let map = (!p.defects.map.is_empty()).then(|| format!("{} mapped defects", p.defects.map.len()));
    let outliers = p.defects.outlier_threshold.map(|t| format!("outliers beyond {t}"));
    let shading = p.shading.as_ref().map(|shading| match shading {
        Shading::Radial { gains, .. } => format!("shading by {} radial gains", gains.len()),
        Shading::Grid { columns, gains } => format!("shading by a grid of {columns} × {}", gains.len() / columns),
    });
    [black, map, outliers, shading].into_iter().flatten().collect()
}

fn colour(p: &Processing, mosaic: &Mosaic) -> Vec<String> {
    let Some(colour) = &p.colour else {
        return std::iter::once("monochrome".to_owned()).chain(noise_reduction(p)).collect();
    };
    let balance = match &colour.white_balance {
        WhiteBalance::GreyWorld => "white balance by grey world".to_owned(),
        WhiteBalance::Gains(gains) => {
            let gains: Vec<String> = gains.iter().map(|g| format!("{g:.4}")).collect();
            format!("white balance {}", gains.join(" "))
        }
    };
    let demosaic = match p.demosaic {
        Demosaic::Bilinear => "bilinear demosaic",
        Demosaic::MalvarHeCutler => "Malvar-He-Cutler demosaic",
        Demosaic::HamiltonAdams => "Hamilton-Adams demosaic",
    };
    let matrix = (!has_own_colours(p)).then(|| match mosaic.channels() {
        3 => "colour matrix".to_owned(),
        n => format!("colour matrix of {n} channels"),
    });
    [balance, demosaic.to_owned()].into_iter().chain(noise_reduction(p)).chain(matrix).collect()
}

/// Returns true if red, green and blue remain as the sensor has them.
fn has_own_colours(p: &Processing) -> bool {
    p.colour.as_ref().is_some_and(|colour| colour.matrix == ColourMatrix::identity())
}

fn noise_reduction(p: &Processing) -> Option<String> {
    p.noise_reduction.map(|reduction| match reduction {
        NoiseReduction::Bilateral(b) => format!("bilateral noise reduction of {} px, range {}", b.radius_px, b.range),
        NoiseReduction::Median { radius_px } => format!("median of {0} × {0} px", 2 * radius_px + 1),
    })
}

fn tone(curve: &ToneCurve) -> String {
    match curve {
        ToneCurve::Srgb => "sRGB tone curve".to_owned(),
        ToneCurve::Gamma(1.0) => "linear tone curve".to_owned(),
        ToneCurve::Gamma(gamma) => format!("tone curve of gamma {gamma}"),
        ToneCurve::SCurve(curve) => format!("S-curve of contrast {} about {}", curve.contrast(), curve.midpoint()),
        ToneCurve::Table(_) => "tabulated tone curve".to_owned(),
        ToneCurve::Oecf(_) => "measured OECF as tone curve".to_owned(),
    }
}

fn paper(p: &Processing, stage: Stage) -> Vec<String> {
    let name = |filter: &Filter| match filter {
        Filter::Glow(_) => "image filter glow",
        Filter::ToneMap(_) => "image filter tone map",
        Filter::Drops(_) => "image filter drops",
        Filter::Colour(_) => "image filter colour matrix",
        Filter::PulseNoise(_) => "image filter pulse noise",
        Filter::GaussianNoise(_) => "image filter Gaussian noise",
        Filter::UniformNoise(_) => "image filter uniform noise",
    };
    p.image_filters.iter().filter(|filter| filter.stage() == stage).map(|filter| name(filter).to_owned()).collect()
}

fn format_name(format: PictureFormat) -> String {
    match format {
        PictureFormat::Png { bits } => format!("{bits} bits"),
        PictureFormat::Jpeg { quality } => format!("8 bits, JPEG of quality {quality}"),
    }
}

fn omitted_steps(p: &Processing) -> String {
    let absent = [
        (p.defects.is_off(), "defect correction"),
        (p.shading.is_none(), "shading correction"),
        (p.noise_reduction.is_none(), "noise reduction"),
        (has_own_colours(p), "colour matrix"),
        (p.sharpening.is_none(), "sharpening"),
    ];
    let list: Vec<&str> = absent.iter().filter(|(is, _)| *is).map(|(_, name)| *name).collect();
    let not_requested = if list.is_empty() { String::new() } else { format!("{}: not requested; ", list.join(", ")) };
    format!("{not_requested}highlight recovery and local tone mapping: not modelled")
}
