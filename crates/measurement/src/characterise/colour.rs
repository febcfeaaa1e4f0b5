//! White balance and colour matrix: from a ColorChecker and a uniformly lit white in the same light.

use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::colour::{ColourProcessing, colour_processing, white_balance};
use etendue_metrology::patch_statistics::patch_statistics;
use etendue_spectra::colour::D65_WHITE;
use glam::DVec2;

use super::fall_off::{black_dn, brightest};
use super::parameter::{Findings, ImageKind};
use super::{electronics::Electronics, folder::Laboratory, shot::LaboratoryImage};
use crate::measure::colour::{MeasuredPatches, measured};
use crate::measure::{ColourRequest, MeasurementInput, Selection, SignalLevels, TruthInput};
use crate::report::Estimate;

const QUANTITY: &str = "colour matrix";
/// Fraction of the flat-field image, along each side, that is used as its centre.
const CENTRE_FRACTION: f64 = 0.2;
/// Maximum chromaticity difference from D65; a light farther away is treated as another light.
const MAX_D65_DIFFERENCE: f64 = 0.005;

/// Colour results.
#[derive(Clone, Copy, Debug)]
pub(super) struct Colour {
    pub(super) white_balance: [Estimate; 3],
    pub(super) matrix: Option<[[Estimate; 3]; 3]>,
}

pub(super) fn measure(
    laboratory: &Laboratory,
    electronics: Option<&Electronics>,
    findings: &mut Findings,
) -> Result<Option<Colour>, Error> {
    if laboratory.camera.cfa.as_deref() == Some("mono") {
        return Ok(None);
    }
    let (field, checker) = (laboratory.shots(ImageKind::Field), laboratory.shots(ImageKind::Checker));
    let white = match brightest(&field) {
        Some(shot) => findings.record("white balance", white(laboratory, electronics, shot))?,
        None => None,
    };
    if field.is_empty() {
        findings.missing("white balance", ImageKind::Field);
    }
    let chart_patches = match checker.first() {
        Some(shot) => findings.record(QUANTITY, patches(laboratory, electronics, shot))?,
        None => None,
    };
    if checker.is_empty() {
        findings.missing(QUANTITY, ImageKind::Checker);
    }
    if let Some((report, _)) = &chart_patches {
        findings.part("Colour", ImageKind::Checker, report.clone());
    }
    let Some(white) = white else {
        if chart_patches.is_some() {
            findings.unknown(QUANTITY, "field/ contains no image of a uniform white surface in the same light");
        }
        return Ok(None);
    };
    let processing = match chart_patches {
        Some((_, chart_patches)) => findings.record(QUANTITY, processing(&chart_patches, &white))?,
        None => None,
    };
    let colour = Colour { white_balance: white_balance(&white), matrix: processing.map(|p| p.matrix) };
    colour.report_results(findings);
    Ok(Some(colour))
}

fn processing(measured: &MeasuredPatches, white: &[Estimate; 3]) -> Result<ColourProcessing, Error> {
    let chromaticity = |[x, y, z]: [f64; 3]| [x / (x + y + z), y / (x + y + z)];
    let (light, daylight) = (chromaticity(measured.white_xyz), chromaticity(D65_WHITE));
    if light.iter().zip(daylight).any(|(a, b)| (a - b).abs() > MAX_D65_DIFFERENCE) {
        let problem = "the ColorChecker's light is not daylight D65, for which its sRGB colours are defined";
        return Err(Error::coded(ErrorCode::NotMeasurable, problem));
    }
    let fitted = colour_processing(&measured.patches, white, measured.black, measured.full_scale, measured.shared_px);
    fitted.map_err(|error| Error::coded(ErrorCode::NotMeasurable, error.to_string()))
}

fn levels(laboratory: &Laboratory, electronics: Option<&Electronics>, shot: &LaboratoryImage) -> SignalLevels {
    SignalLevels {
        black: black_dn(shot, electronics),
        full_scale: laboratory.camera.white_level_dn.filter(|_| shot.is_raw()),
    }
}

fn selection(laboratory: &Laboratory, shot: &LaboratoryImage) -> Selection {
    Selection { cfa: laboratory.camera.stated_cfa.clone().filter(|_| shot.is_raw()), ..Selection::default() }
}

/// Red, green and blue in the centre of the flat field, less the black level.
fn white(
    laboratory: &Laboratory,
    electronics: Option<&Electronics>,
    shot: &LaboratoryImage,
) -> Result<[Estimate; 3], Error> {
    if !shot.is_raw() {
        let problem = "is a developed image, so its white balance is that of the development; give the raw image";
        return Err(Error::coded(ErrorCode::NotMeasurable, format!("{}: {problem}", shot.name())));
    }
    let colours = selection(laboratory, shot).colours(&shot.file)?;
    let colours = colours
        .ok_or_else(|| Error::coded(ErrorCode::NotMeasurable, format!("{}: not a colour image", shot.name())))?;
    let black = levels(laboratory, electronics, shot).black(&colours[1]);
    let [width, height] = shot.size_px.map(|n| n as f64);
    let [half_width, half_height] = [0.5 * CENTRE_FRACTION * width, 0.5 * CENTRE_FRACTION * height];
    let region = [0.5 * width - half_width, 0.5 * height - half_height, 2.0 * half_width, 2.0 * half_height];
    let [red, green, blue] = colours.each_ref().map(|c| -> Result<Estimate, Error> {
        let mean = patch_statistics(&c.part(region.map(|n| n as usize), "the middle of the field")?, c.shared_px).mean;
        Ok(Estimate::new(mean.value - black, mean.standard_uncertainty))
    });
    Ok([red?, green?, blue?])
}

fn patches(
    laboratory: &Laboratory,
    electronics: Option<&Electronics>,
    shot: &LaboratoryImage,
) -> Result<(crate::report::Report, MeasuredPatches), Error> {
    let corners = laboratory.stated.checker.as_ref().map(|checker| checker.corners_px.value.clone());
    let corners: Vec<DVec2> = corners.into_iter().flatten().map(|corner| corner.value.into()).collect();
    let truth = laboratory.truth(ImageKind::Checker).filter(|_| corners.is_empty());
    if corners.is_empty() && truth.is_none() {
        return Err(Error::coded(
            ErrorCode::NotStated,
            "the position of the ColorChecker is not stated; add [checker] corners_px to laboratory.toml, or a truth.json next to the image",
        ));
    }
    let input = MeasurementInput {
        selection: selection(laboratory, shot),
        levels: levels(laboratory, electronics, shot),
        truth: TruthInput { truth, camera: None },
    };
    measured(&ColourRequest { corners, input, ..ColourRequest::new(&shot.file) })
}

const NAMES: [&str; 3] = ["red", "green", "blue"];

impl Colour {
    fn report_results(&self, findings: &mut Findings) {
        for (name, value) in NAMES.iter().zip(self.white_balance) {
            let label = format!("white balance, {name}");
            findings.add_parameter(ImageKind::Field, &format!("isp.white_balance.{name}"), &label, "", value);
        }
        for (to, row) in NAMES.iter().zip(self.matrix.into_iter().flatten()) {
            for (input_name, value) in NAMES.iter().zip(row) {
                let (key, label) = (
                    format!("isp.colour_matrix.{to}.{input_name}"),
                    format!("colour matrix, {to} of sRGB by {input_name}"),
                );
                findings.add_parameter(ImageKind::Checker, &key, &label, "", value);
            }
        }
    }
}
