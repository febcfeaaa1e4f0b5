//! What light meets before it is counted, and its time.

use super::or;
use etendue_scene::record;
use etendue_scene::record::sensor::exposure::{self, AutoExposure, Exchange};
use etendue_sensor::effects::angle_response::AngleResponse;
use etendue_sensor::effects::crosstalk::Crosstalk;
use etendue_sensor::effects::neighbours::Neighbours;
use etendue_sensor::exposure_control::ExposureControl;
use etendue_sensor::{Exposure, Optics};

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
        damping: or(record.damping.as_ref(), 1.0),
        exposure_s: record.exposure_limits_s.value,
        analogue_gain: record.gain_limits.value,
    }
}

/// `exit_pupil_mm` is the lens's own.
pub(super) fn optics(sensor: &record::Sensor, e: &record::Electronics, exit_pupil_mm: f64) -> Optics {
    let middle = [0.5 * sensor.width_px.value as f64, 0.5 * sensor.height_px.value as f64];
    let principal_px = sensor.principal_point_px.as_ref().map_or(middle, |p| p.value);
    let response = |record: &exposure::AngleResponse| AngleResponse {
        table: record.table.iter().map(|row| row.value).collect(),
        exit_pupil_mm: or(record.exit_pupil_mm.as_ref(), exit_pupil_mm),
        principal_px,
    };
    // From infinitely far all light comes at 0°, where the response is 1.
    let angle_response = e.angle_response.as_ref().map(response).filter(|r| r.exit_pupil_mm.is_finite());
    Optics { angle_response, crosstalk: e.crosstalk.as_ref().map(|shares| Crosstalk(neighbours(shares))) }
}

pub(super) fn neighbours(record: &Exchange) -> Neighbours {
    Neighbours {
        horizontal: record.horizontal.value,
        vertical: record.vertical.value,
        corner: or(record.corner.as_ref(), 0.0),
    }
}
