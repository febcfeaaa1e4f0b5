//! White balance and colour matrix: from a ColorChecker and a uniformly lit white in the same light.

use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::colour::{ColourProcessing, colour_processing, white_balance};
use etendue_metrology::patch_statistics::patch_statistics;
use etendue_spectra::colour::D65_WHITE;
use glam::DVec2;

use super::fall_off::{black_dn, brightest};
use super::parameter::{Findings, Kind};
use super::{electronics::Electronics, folder::Laboratory, shot::Shot};
use crate::measure::colour::{Seen, measured};
use crate::measure::{ColourRequest, PictureInput, Selection, SignalLevels, TruthInput};
use crate::report::Estimate;

const WHAT: &str = "colour matrix";
/// Fraction of the flat-field image, along each side, that is used as its centre.
const MIDDLE: f64 = 0.2;
/// Maximum chromaticity difference from D65; a light farther away is treated as another light.
const OTHER_LIGHT: f64 = 0.005;

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
    let (field, checker) = (laboratory.shots(Kind::Field), laboratory.shots(Kind::Checker));
    let white = match brightest(&field) {
        Some(shot) => findings.attempt("white balance", white(laboratory, electronics, shot))?,
        None => None,
    };
    if field.is_empty() {
        findings.missing("white balance", Kind::Field);
    }
    let seen = match checker.first() {
        Some(shot) => findings.attempt(WHAT, patches(laboratory, electronics, shot))?,
        None => None,
    };
    if checker.is_empty() {
        findings.missing(WHAT, Kind::Checker);
    }
    if let Some((report, _)) = &seen {
        findings.part("Colour", Kind::Checker, report.clone());
    }
    let Some(white) = white else {
        if seen.is_some() {
            findings.unknown(WHAT, "field/ contains no image of a uniform white surface in the same light");
        }
        return Ok(None);
    };
    let processing = match seen {
        Some((_, seen)) => findings.attempt(WHAT, processing(&seen, &white))?,
        None => None,
    };
    let colour = Colour { white_balance: white_balance(&white), matrix: processing.map(|p| p.matrix) };
    colour.tell(findings);
    Ok(Some(colour))
}

fn processing(seen: &Seen, white: &[Estimate; 3]) -> Result<ColourProcessing, Error> {
    let chromaticity = |[x, y, z]: [f64; 3]| [x / (x + y + z), y / (x + y + z)];
    let (light, daylight) = (chromaticity(seen.white_xyz), chromaticity(D65_WHITE));
    if light.iter().zip(daylight).any(|(a, b)| (a - b).abs() > OTHER_LIGHT) {
        let told = "the ColorChecker's light is not daylight D65, for which its sRGB colours are defined";
        return Err(Error::coded(ErrorCode::NotMeasurable, told));
    }
    let found = colour_processing(&seen.patches, white, seen.black, seen.full_scale, seen.shared_px);
    found.map_err(|fault| Error::coded(ErrorCode::NotMeasurable, fault.to_string()))
}

fn levels(laboratory: &Laboratory, electronics: Option<&Electronics>, shot: &Shot) -> SignalLevels {
    SignalLevels {
        black: black_dn(shot, electronics),
        full_scale: laboratory.camera.white_level_dn.filter(|_| shot.is_raw()),
    }
}

fn selection(laboratory: &Laboratory, shot: &Shot) -> Selection {
    Selection { cfa: laboratory.camera.told_cfa.clone().filter(|_| shot.is_raw()), ..Selection::default() }
}

/// Red, green and blue in the centre of the flat field, less the black level.
fn white(laboratory: &Laboratory, electronics: Option<&Electronics>, shot: &Shot) -> Result<[Estimate; 3], Error> {
    if !shot.is_raw() {
        let told = "is a developed image, so its white balance is that of the development; give the raw image";
        return Err(Error::coded(ErrorCode::NotMeasurable, format!("{}: {told}", shot.name())));
    }
    let colours = selection(laboratory, shot).colours(&shot.file)?;
    let colours = colours
        .ok_or_else(|| Error::coded(ErrorCode::NotMeasurable, format!("{}: not a colour image", shot.name())))?;
    let black = levels(laboratory, electronics, shot).black(&colours[1]);
    let [width, height] = shot.size_px.map(|n| n as f64);
    let [half_width, half_height] = [0.5 * MIDDLE * width, 0.5 * MIDDLE * height];
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
    shot: &Shot,
) -> Result<(crate::report::Report, Seen), Error> {
    let corners = laboratory.stated.checker.as_ref().map(|checker| checker.corners_px.value.clone());
    let corners: Vec<DVec2> = corners.into_iter().flatten().map(|corner| corner.value.into()).collect();
    let truth = laboratory.truth(Kind::Checker).filter(|_| corners.is_empty());
    if corners.is_empty() && truth.is_none() {
        return Err(Error::coded(
            ErrorCode::NotStated,
            "the position of the ColorChecker is not stated; add [checker] corners_px to laboratory.toml, or a truth.json next to the image",
        ));
    }
    let input = PictureInput {
        selection: selection(laboratory, shot),
        levels: levels(laboratory, electronics, shot),
        truth: TruthInput { truth, camera: None },
    };
    measured(&ColourRequest { corners, input, ..ColourRequest::new(&shot.file) })
}

const NAMES: [&str; 3] = ["red", "green", "blue"];

impl Colour {
    fn tell(&self, findings: &mut Findings) {
        for (name, value) in NAMES.iter().zip(self.white_balance) {
            let label = format!("white balance, {name}");
            findings.found(Kind::Field, &format!("isp.white_balance.{name}"), &label, "", value);
        }
        for (to, row) in NAMES.iter().zip(self.matrix.into_iter().flatten()) {
            for (of, value) in NAMES.iter().zip(row) {
                let (key, label) =
                    (format!("isp.colour_matrix.{to}.{of}"), format!("colour matrix, {to} of sRGB by {of}"));
                findings.found(Kind::Checker, &key, &label, "", value);
            }
        }
    }
}
