//! Processing steps from digital numbers to the image.

use super::planned_effect::{EffectGroup, PlannedEffect, camera_change, required_if, without};
use crate::plan::{CameraPlan, PictureFormat};
use etendue_core::EffectStatus;
use etendue_isp::{BlackLevel, ColourMatrix, Processing, ToneCurve, WhiteBalance};

const GROUP: EffectGroup = EffectGroup::Processing;

pub(super) fn effects(camera: &CameraPlan) -> Vec<PlannedEffect> {
    let Some(development) = &camera.body.development else {
        let status = EffectStatus::LeftOut("no [isp] is described, so no image is produced".to_owned());
        return vec![PlannedEffect::new(GROUP, "development", status).described_by("isp")];
    };
    let p = &development.processing;
    vec![
        black_level(camera, p),
        defects(camera, p),
        step(
            camera,
            "shading correction",
            "isp.shading",
            p.shading.is_some(),
            "gains that depend on the position in the image",
        ),
        white_balance(camera, p),
        demosaic(p),
        step(camera, "noise reduction", "isp.noise_reduction", p.noise_reduction.is_some(), "smooths similar colours"),
        colour_matrix(camera, p, development.mosaic.channels()),
        step(camera, "digital gain", "isp.exposure_gain", p.exposure_gain != 1.0, "a factor on the linear image"),
        step(
            camera,
            "image filters",
            "isp.image_filters",
            !p.image_filters.is_empty(),
            "filters of Gruyer et al. (2012)",
        ),
        tone(camera, p),
        step(camera, "sharpening", "isp.sharpening", p.sharpening.is_some(), "an unsharp mask"),
        quantisation(development.format),
        never("highlight recovery"),
        never("local tone mapping"),
    ]
}

/// A step that is present only if its key requests it.
fn step(camera: &CameraPlan, name: &'static str, key: &'static str, is_there: bool, text: &str) -> PlannedEffect {
    let status = required_if(is_there, text, "not requested");
    PlannedEffect::new(GROUP, name, status).described_by(key).dropped_by([without(camera, key)])
}

fn black_level(camera: &CameraPlan, p: &Processing) -> PlannedEffect {
    let is_own = p.black_level != BlackLevel::Stated;
    let text = "a black level other than the sensor's is subtracted";
    let status = required_if(is_own, text, "the sensor's black level is subtracted");
    let key = "isp.black_level";
    PlannedEffect::new(GROUP, "black level correction", status).described_by(key).dropped_by([without(camera, key)])
}

fn defects(camera: &CameraPlan, p: &Processing) -> PlannedEffect {
    let status = required_if(!p.defects.is_off(), "mapped pixels and outliers are corrected", "not requested");
    let keys = [
        ("isp.defect_map", !p.defects.map.is_empty()),
        ("isp.defect_outlier_threshold", p.defects.outlier_threshold.is_some()),
    ];
    let set = keys.into_iter().filter(|(_, is_there)| *is_there).map(|(key, _)| without(camera, key));
    PlannedEffect::new(GROUP, "defect correction", status).described_by("isp.defect_map").dropped_by(set)
}

fn white_balance(camera: &CameraPlan, p: &Processing) -> PlannedEffect {
    let balance = p.colour.as_ref().map(|colour| &colour.white_balance);
    let is_there = match balance {
        None => false,
        Some(WhiteBalance::GreyWorld) => true,
        Some(WhiteBalance::Gains(gains)) => gains.iter().any(|gain| *gain != 1.0),
    };
    let text = if matches!(balance, Some(WhiteBalance::GreyWorld)) {
        "grey world: the mean of each image becomes neutral"
    } else {
        "one gain per channel"
    };
    step(camera, "white balance", "isp.white_balance", is_there, text)
}

fn demosaic(p: &Processing) -> PlannedEffect {
    let status = required_if(p.colour.is_some(), "the missing colours of each pixel are interpolated", "monochrome");
    PlannedEffect::new(GROUP, "demosaic", status).described_by("isp.demosaic")
}

/// Three channels can be interpreted as red, green and blue; other numbers need a matrix.
fn colour_matrix(camera: &CameraPlan, p: &Processing, channels: usize) -> PlannedEffect {
    let is_there = p.colour.as_ref().is_some_and(|colour| colour.matrix != ColourMatrix::identity());
    let status = required_if(
        is_there,
        "converts the sensor's colours to sRGB",
        "red, green and blue remain those of the sensor",
    );
    let key = "isp.colour_matrix";
    let effect = PlannedEffect::new(GROUP, "colour matrix", status).described_by(key);
    effect.dropped_by((channels == 3).then(|| without(camera, key)))
}

fn tone(camera: &CameraPlan, p: &Processing) -> PlannedEffect {
    let is_there = p.tone != ToneCurve::Gamma(1.0);
    let status = required_if(is_there, "linear light is encoded by a curve", "values are proportional to light");
    let key = "isp.tone_curve";
    PlannedEffect::new(GROUP, "tone curve", status).described_by(key).dropped_by([camera_change(camera, key, "linear")])
}

fn quantisation(format: PictureFormat) -> PlannedEffect {
    let text = match format {
        PictureFormat::Png { bits } => format!("{bits} bits"),
        PictureFormat::Jpeg { quality } => format!("8 bits, JPEG of quality {quality}"),
    };
    let effect = PlannedEffect::new(GROUP, "image bit depth", EffectStatus::Modelled(text));
    effect.described_by("isp.picture_bits").with_error("missing quantisation noise", 1.0 / 12.0_f64.sqrt(), "DN")
}

fn never(name: &'static str) -> PlannedEffect {
    PlannedEffect::new(GROUP, name, EffectStatus::LeftOut("not modelled by this program".to_owned()))
}
