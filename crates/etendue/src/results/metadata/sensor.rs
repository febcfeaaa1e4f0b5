//! What a side-car says of the sensor and of its frames.

use crate::results::levels;
use etendue_core::Shutter;
use etendue_pipeline::plan::{CameraBody, RowExposure, RowSkipping};
use etendue_sensor::dynamic_range::Switch;
use etendue_sensor::{ChargeAccount, DynamicRange, Raw, Sensor};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The sensor's geometry and, where it has electronics, their figures.
pub(crate) fn sensor(body: &CameraBody) -> Value {
    let raster = &body.raster;
    let electronics = body.sensor.as_ref().map(|sensor| {
        let p = sensor.parameters();
        json!({
            "exposure_s": p.exposure.exposure_s,
            "gain_dn_per_e": p.read_out.gain_dn_e,
            "black_level_dn": sensor.black_level_dn(),
            "white_level_dn": sensor.white_level_dn(),
            "full_well_e": p.charge.full_well.capacity_e,
            "read_noise_e": p.voltage.noise.white_e,
            "dark_current_e_s": p.charge.dark.current_e_s,
            "bits": sensor.delivered_bits(),
            "noise": p.noise,
            "effects": sensor_effects(sensor),
            "dynamic_range": dynamic_range(&sensor.dynamic_range()),
            "cfa": {
                "columns": p.cfa.width(),
                "channels": p.cfa.channels().iter().map(|c| p.channels[*c].name.clone()).collect::<Vec<_>>(),
            },
        })
    });
    json!({
        "width_px": raster.width(),
        "height_px": raster.height(),
        "pixel_pitch_um": 1000.0 * raster.pitch_mm().x,
        "principal_point_px": raster.principal_px().to_array(),
        "shutter": shutter(&body.exposure),
        "electronics": electronics,
    })
}

/// When rows are exposed.
fn shutter(rows: &RowExposure) -> Value {
    let (word, timing) = match &rows.shutter {
        Shutter::Global => return json!({ "type": "global" }),
        Shutter::Rolling(timing) => ("rolling", timing),
        Shutter::GlobalReset(timing) => ("global_reset", timing),
    };
    let RowSkipping { together, pitch } = rows.skipping;
    let mut said = json!({
        "type": word,
        "row_time_s": timing.row_time_s,
        "direction": if timing.upwards { "up" } else { "down" },
        "fields": timing.fields,
        "first_row": rows.first_row,
        "rows": rows.rows,
    });
    if rows.skipping.skips() {
        said["rows_read"] = json!({ "together": together, "of": pitch });
    }
    said
}

/// What range of light a frame holds, in photo-electrons of the first capture, and the signal-to-noise ratios at switches of
/// capture.
fn dynamic_range(range: &DynamicRange) -> Value {
    let switch = |s: &Switch| json!({ "at_e": s.at_e, "snr_before": s.before, "snr_after": s.after });
    json!({
        "db": range.db(),
        "least_e": range.least_e,
        "most_e": range.most_e,
        "switches": range.switches.iter().map(switch).collect::<Vec<_>>(),
    })
}

/// What is modelled, in the words of the plan.
fn sensor_effects(sensor: &Sensor) -> BTreeMap<&'static str, String> {
    let modelled = sensor.effects().into_iter().filter(|(_, status)| status.is_modelled());
    modelled.map(|(name, status)| (name, status.reason().to_owned())).collect()
}

/// What a frame says of itself: the file of its raw, exposure and gain, levels, where overflowing charge went, and mean level and clipped pixels.
pub(crate) fn frame(number: u32, file: Option<String>, raw: &Raw) -> Value {
    let area = raw.picture;
    let account = |(capture, a): &(usize, ChargeAccount)| {
        json!({
            "capture": capture,
            "generated": a.generated_e,
            "collected": a.collected_e,
            "drained": a.drained_e,
            "spilt_off_the_edge": a.spilt_e,
            "clipped": a.clipped_e,
        })
    };
    json!({
        "frame": number,
        "raw": file,
        "exposure_s": raw.operating_point.exposure_s,
        "analogue_gain": raw.operating_point.analogue_gain,
        "black_level_dn": raw.black_level_dn,
        "white_level_dn": raw.white_level_dn,
        "picture_in_raw_px": [area.x, area.y, area.width, area.height],
        "companding_knees_dn": raw.companding.as_ref().map(|c| c.knees.clone()),
        "charge_e": raw.accounts.iter().map(account).collect::<Vec<_>>(),
        (levels::LEVELS): levels::Levels::new(raw),
    })
}
