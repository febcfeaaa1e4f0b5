//! Relative illumination over the field: from a uniformly lit surface through the lens.

use etendue_io::failure::Error;

use super::parameter::{Findings, ImageKind};
use super::{electronics::Electronics, folder::Laboratory, identity::PLACEHOLDER_PITCH_UM, shot::LaboratoryImage};
use crate::measure::shading::falloff;
use crate::measure::{FlatFieldRequest, MeasurementInput, Selection, SignalLevels, VignettingRequest};

const QUANTITY: &str = "relative illumination over the field";

/// Relative illumination as a camera file states it, with the standard uncertainty at the corner.
#[derive(Clone, Debug)]
pub(super) struct FallOff {
    pub(super) radius_mm: Vec<f64>,
    pub(super) ratio: Vec<f64>,
    pub(super) corner_u: f64,
}

pub(super) fn measure(
    laboratory: &Laboratory,
    electronics: Option<&Electronics>,
    findings: &mut Findings,
) -> Result<Option<FallOff>, Error> {
    let shots = laboratory.shots(ImageKind::Field);
    let Some(shot) = brightest(&shots) else {
        findings.missing(QUANTITY, ImageKind::Field);
        return Ok(None);
    };
    let input = MeasurementInput {
        selection: Selection {
            channel: laboratory.camera.channel().filter(|_| shot.is_raw()),
            cfa: laboratory.camera.stated_cfa.clone().filter(|_| shot.is_raw()),
            ..Selection::default()
        },
        levels: SignalLevels {
            black: black_dn(shot, electronics),
            full_scale: laboratory.camera.white_level_dn.filter(|_| shot.is_raw()),
        },
        ..MeasurementInput::default()
    };
    let request = VignettingRequest::new(FlatFieldRequest { input, ..FlatFieldRequest::new(&shot.file) });
    let Some((report, shading, size)) = findings.record(QUANTITY, falloff(&request))? else { return Ok(None) };
    findings.part("Fall-off", ImageKind::Field, report);
    let corner = shading.corner.scaled(100.0);
    findings.add_parameter(
        ImageKind::Field,
        "lens.relative_illumination.corner_percent",
        "illumination at the corner",
        "%",
        corner,
    );
    let pitch_um = laboratory.camera.pixel_pitch_um.unwrap_or(PLACEHOLDER_PITCH_UM);
    let [radius_mm, mut ratio] = request.relative_illumination(&shading, size.into(), pitch_um);
    // The centre is 1 by definition.
    ratio[0] = 1.0;
    Ok(Some(FallOff { radius_mm, ratio, corner_u: shading.corner.standard_uncertainty }))
}

/// Returns the brightest unsaturated image; the first of equal ones.
pub(super) fn brightest<'a>(shots: &[&'a LaboratoryImage]) -> Option<&'a LaboratoryImage> {
    let longest_unsaturated = |best: &'a LaboratoryImage, next: &&'a LaboratoryImage| match next.exposure_s
        > best.exposure_s
        && next.saturated == 0.0
    {
        true => *next,
        false => best,
    };
    let good = *shots.iter().find(|shot| shot.saturated == 0.0).or(shots.first())?;
    Some(shots.iter().fold(good, longest_unsaturated))
}

/// Reading without light at an image's exposure, if frames without light determine it.
pub(super) fn black_dn(shot: &LaboratoryImage, electronics: Option<&Electronics>) -> Option<f64> {
    let f = electronics.filter(|_| shot.is_raw())?.figures;
    let current = f.dark_current_mean_e_per_s.map_or(0.0, |current| current.value);
    let collected_e = current * shot.exposure_s.unwrap_or(0.0);
    Some(f.dark_level_dn.value + f.gain_dn_per_e.value * collected_e)
}
