//! From light to digital numbers: the sensor's own list of effects, with the keys that leave each out.

use super::planned_effect::{EffectGroup, PlannedEffect, of_camera, without};
use crate::plan::{CameraPlan, TimeDependence};
use etendue_core::{EffectStatus, Shutter};
use etendue_sensor::Sensor;
use glam::DVec3;

const GROUP: EffectGroup = EffectGroup::Sensor;

pub(super) fn effects(camera: &CameraPlan) -> Vec<PlannedEffect> {
    let Some(sensor) = &camera.body.sensor else {
        let lack = "no electronics are described, so that no electrons are made".to_owned();
        let none = PlannedEffect::new(GROUP, "electronics", EffectStatus::LeftOut(lack));
        return vec![rolling_shutter(camera), none.described_by("sensor.full_well_e")];
    };
    let listed = sensor.effects().into_iter().map(|(name, status)| of_list(camera, sensor, name, status));
    std::iter::once(rolling_shutter(camera)).chain(listed).collect()
}

/// When rows are exposed.
fn rolling_shutter(camera: &CameraPlan) -> PlannedEffect {
    let rows = &camera.body.exposure;
    let depends = camera.time != TimeDependence::None;
    let status = match &rows.shutter {
        Shutter::Global => EffectStatus::LeftOut("all rows are exposed together".to_owned()),
        Shutter::Rolling(_) if !depends => EffectStatus::LeftOut("nothing of the scene depends on time".to_owned()),
        Shutter::Rolling(_) => EffectStatus::Modelled("each row's samples have moments of its own exposure".to_owned()),
        Shutter::GlobalReset(_) => EffectStatus::Modelled("rows that are read later get more light".to_owned()),
    };
    let global = match &camera.body.sensor {
        Some(_) => without(camera, "sensor.shutter"),
        None => {
            let shutter = format!("{{type=\"global\",exposure_s={:?}}}", rows.exposure_s);
            of_camera(camera, "sensor.shutter", &shutter)
        }
    };
    PlannedEffect::new(GROUP, "rolling shutter", status).described_by("sensor.shutter").dropped_by([global]).erring(
        "last row earlier by",
        1e3 * rows.shutter.length_s(rows.rows, 0.0),
        "ms",
    )
}

/// An effect of the sensor's list. Each name has its keys here; a test holds that none is forgotten.
fn of_list(camera: &CameraPlan, sensor: &Sensor, name: &'static str, status: EffectStatus) -> PlannedEffect {
    let effect = PlannedEffect::new(GROUP, name, status);
    let gone = |key: &'static str| [without(camera, key)];
    match name {
        "exposure control" => effect.described_by("sensor.auto_exposure").dropped_by(gone("sensor.auto_exposure")),
        "angle response" => effect.described_by("sensor.angle_response").dropped_by(gone("sensor.angle_response")),
        "optical crosstalk" => effect.described_by("sensor.crosstalk").dropped_by(gone("sensor.crosstalk")),
        "photo-response non-uniformity" => photo_response(camera, sensor, effect),
        "smear" => effect.described_by("sensor.smear").dropped_by(gone("sensor.smear")),
        "shot noise" => shot_noise(camera, sensor, effect),
        "dark current" => dark_current(camera, sensor, effect),
        "lag" => effect.described_by("sensor.lag").dropped_by(gone("sensor.lag")),
        "brighter-fatter" => {
            effect.described_by("sensor.brighter_fatter_per_e").dropped_by(gone("sensor.brighter_fatter_per_e"))
        }
        "full well" => effect.described_by("sensor.full_well_e"),
        "dead pixels" => {
            let key = "sensor.non_uniformity.dead_fraction";
            let percent = 100.0 * sensor.parameters().charge.dead_pixels.fraction;
            effect.described_by(key).dropped_by([of_camera(camera, key, "0")]).erring("dead pixels alive", percent, "%")
        }
        "region and binning" => effect.described_by("sensor.binning"),
        "response" => effect.described_by("sensor.response").dropped_by(gone("sensor.response")),
        "inter-pixel capacitance" => {
            effect.described_by("sensor.inter_pixel_capacitance").dropped_by(gone("sensor.inter_pixel_capacitance"))
        }
        "offset non-uniformity" => offsets(camera, sensor, effect),
        "read noise" => read_noise(camera, sensor, effect),
        "RTS noise" => effect.described_by("sensor.rts_noise").dropped_by(gone("sensor.rts_noise")),
        // Rounding to whole numbers: a standard deviation of 1/√12 of a step.
        "converter" => effect.described_by("sensor.bits").erring("rounding σ", 1.0 / 12.0_f64.sqrt(), "DN"),
        "merging of captures" => {
            let companded = sensor.parameters().hdr.companding.as_ref().map(|_| without(camera, "sensor.companding"));
            effect.described_by("sensor.hdr").dropped_by(gone("sensor.hdr").into_iter().chain(companded))
        }
        "companding" => effect.described_by("sensor.companding").dropped_by(gone("sensor.companding")),
        _ => effect,
    }
}

/// Sets those keys of these to 0 that are not.
fn zeroed<'a>(camera: &CameraPlan, keys: impl IntoIterator<Item = (&'a str, f64)>) -> Vec<String> {
    keys.into_iter().filter(|(_, value)| *value != 0.0).map(|(key, _)| of_camera(camera, key, "0")).collect()
}

fn photo_response(camera: &CameraPlan, sensor: &Sensor, effect: PlannedEffect) -> PlannedEffect {
    let p = &sensor.parameters().light.photo_response;
    let keys = [
        ("sensor.non_uniformity.prnu", p.white),
        ("sensor.non_uniformity.prnu_row", p.row),
        ("sensor.non_uniformity.prnu_column", p.column),
    ];
    let percent = 100.0 * DVec3::new(p.white, p.row, p.column).length();
    let effect = effect.described_by("sensor.non_uniformity.prnu").dropped_by(zeroed(camera, keys));
    effect.erring("missing spread of responses", percent, "%")
}

fn offsets(camera: &CameraPlan, sensor: &Sensor, effect: PlannedEffect) -> PlannedEffect {
    let p = &sensor.parameters().voltage.offset;
    let keys = [
        ("sensor.non_uniformity.dsnu_e", p.white_e),
        ("sensor.non_uniformity.dsnu_row_e", p.row_e),
        ("sensor.non_uniformity.dsnu_column_e", p.column_e),
    ];
    let sigma_e = DVec3::new(p.white_e, p.row_e, p.column_e).length();
    let effect = effect.described_by("sensor.non_uniformity.dsnu_e").dropped_by(zeroed(camera, keys));
    effect.erring("missing spread of offsets", sigma_e, "e⁻")
}

/// The key that leaves out all randomness from frame to frame.
fn shot_noise(camera: &CameraPlan, sensor: &Sensor, effect: PlannedEffect) -> PlannedEffect {
    let effect = effect.described_by("sensor.noise").dropped_by([of_camera(camera, "sensor.noise", "false")]);
    let grey_e = grey_e(sensor);
    effect.erring("variance of grey lost", 100.0 * grey_e / (grey_e + dark_variance_e2(sensor)), "%")
}

fn read_noise(camera: &CameraPlan, sensor: &Sensor, effect: PlannedEffect) -> PlannedEffect {
    let p = &sensor.parameters().voltage.noise;
    let common = [("sensor.row_noise_e", p.row_e), ("sensor.column_noise_e", p.column_e)];
    let common = common.into_iter().filter(|(_, e)| *e != 0.0).map(|(key, _)| without(camera, key));
    let set = std::iter::once(of_camera(camera, "sensor.read_noise_e", "0")).chain(common);
    let variance = p.white_e * p.white_e + p.row_e * p.row_e + p.column_e * p.column_e;
    let percent = 100.0 * variance / (grey_e(sensor) + dark_variance_e2(sensor));
    let effect = effect.described_by("sensor.read_noise_e").dropped_by(set);
    effect.erring("variance of grey lost", percent, "%").erring(
        "variance of black lost",
        100.0 * variance / dark_variance_e2(sensor),
        "%",
    )
}

fn dark_current(camera: &CameraPlan, sensor: &Sensor, effect: PlannedEffect) -> PlannedEffect {
    let p = sensor.parameters();
    let dark = &p.charge.dark;
    let parts =
        [("sensor.dark.hot", dark.hot.is_some()), ("sensor.dark.dark_current_rts", dark.dark_current_rts.is_some())];
    let parts = parts.into_iter().filter(|(_, is_there)| *is_there).map(|(key, _)| without(camera, key));
    let set = std::iter::once(of_camera(camera, "sensor.dark_current_e_s", "0")).chain(parts);
    let mean_e = dark.current_e_s * dark.temperature_factor() * p.exposure.exposure_s;
    effect.described_by("sensor.dark_current_e_s").dropped_by(set).erring("dark level lower by", mean_e, "e⁻")
}

/// A grey card as a well-exposed picture has it: 18 % of the largest signal.
const GREY: f64 = 0.18;

fn grey_e(sensor: &Sensor) -> f64 {
    GREY * sensor.dynamic_range().most_e
}

/// Variance of no light, e⁻²: read noise, dark current, rounding. Of the least signal, ½ (1 + √(1 + 4 σ²)).
fn dark_variance_e2(sensor: &Sensor) -> f64 {
    let least_e = sensor.dynamic_range().least_e;
    least_e * (least_e - 1.0)
}
