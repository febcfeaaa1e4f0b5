//! Effects on light before detection, and its timing.

use crate::compile::stated::value_or;
use etendue_scene::record;
use etendue_scene::record::sensor::charge as description;
use etendue_scene::record::sensor::exposure::{self, AutoExposure, Exchange};
use etendue_sensor::effects::angle_response::AngleResponse;
use etendue_sensor::effects::neighbours::Crosstalk;
use etendue_sensor::effects::neighbours::Neighbours;
use etendue_sensor::effects::photo_response::PhotoResponse;
use etendue_sensor::effects::smear::Smear;
use etendue_sensor::exposure_control::ExposureControl;
use etendue_sensor::{Exposure, LightEffects};

pub(super) fn exposure(e: &record::Electronics) -> Exposure {
    Exposure {
        exposure_s: e.exposure_s.value,
        frame_period_s: e.frame_period_s.as_ref().map(|k| k.value),
        control: e.auto_exposure.as_ref().map(control),
    }
}

fn control(record: &AutoExposure) -> ExposureControl {
    ExposureControl {
        percentile: record.percentile.value,
        target: record.target.value,
        damping: value_or(record.damping.as_ref(), 1.0),
        exposure_s: record.exposure_limits_s.value,
        analogue_gain: record.gain_limits.value,
    }
}

/// `exit_pupil_mm` is that of the lens.
pub(super) fn light(sensor: &record::Sensor, e: &record::Electronics, exit_pupil_mm: f64) -> LightEffects {
    let middle = [0.5 * sensor.width_px.value as f64, 0.5 * sensor.height_px.value as f64];
    let principal_px = sensor.principal_point_px.as_ref().map_or(middle, |p| p.value);
    let response = |record: &exposure::AngleResponse| AngleResponse {
        table: record.table.iter().map(|row| row.value).collect(),
        exit_pupil_mm: value_or(record.exit_pupil_mm.as_ref(), exit_pupil_mm),
        principal_px,
    };
    // From infinity all light is incident at 0°, where the response is 1.
    let angle_response = e.angle_response.as_ref().map(response).filter(|r| r.exit_pupil_mm.is_finite());
    LightEffects {
        angle_response,
        crosstalk: e.crosstalk.as_ref().map(|value| Crosstalk(neighbours(value))),
        photo_response: e.non_uniformity.as_ref().map(photo_response).unwrap_or_default(),
        smear: e.smear.as_ref().map(smear),
    }
}

fn photo_response(n: &description::NonUniformity) -> PhotoResponse {
    PhotoResponse {
        white: value_or(n.prnu.as_ref(), 0.0),
        row: value_or(n.prnu_row.as_ref(), 0.0),
        column: value_or(n.prnu_column.as_ref(), 0.0),
    }
}

fn smear(record: &description::Smear) -> Smear {
    match record {
        description::Smear::Interline(smear) => Smear::Interline {
            smear_db: smear.smear_db.value,
            measured_exposure_ratio: value_or(smear.measured_exposure_ratio.as_ref(), 1.0),
        },
        description::Smear::FrameTransfer(smear) => Smear::FrameTransfer { line_shift_s: smear.line_shift_s.value },
    }
}

pub(super) fn neighbours(record: &Exchange) -> Neighbours {
    Neighbours {
        horizontal: record.horizontal.value,
        vertical: record.vertical.value,
        corner: value_or(record.corner.as_ref(), 0.0),
    }
}
