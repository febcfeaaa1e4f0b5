//! From light to digital numbers: the sensor's own list of effects.

use super::planned_effect::{EffectGroup, PlannedEffect, camera_change, without};
use crate::plan::{CameraPlan, TimeDependence};
use etendue_core::{EffectStatus, KnownError, Shutter};
use etendue_sensor::SensorEffect;

const GROUP: EffectGroup = EffectGroup::Sensor;

pub(super) fn effects(camera: &CameraPlan) -> Vec<PlannedEffect> {
    let Some(sensor) = &camera.body.sensor else {
        let absent_reason = "no electronics are described, so no electrons are computed".to_owned();
        let none = PlannedEffect::new(GROUP, "electronics", EffectStatus::LeftOut(absent_reason));
        return vec![rolling_shutter(camera), none.described_by("sensor.full_well_e")];
    };
    let listed = sensor.effects().into_iter().map(|effect| listed_effect(camera, effect));
    std::iter::once(rolling_shutter(camera)).chain(listed).collect()
}

/// Exposure of the rows.
fn rolling_shutter(camera: &CameraPlan) -> PlannedEffect {
    let rows = &camera.body.exposure;
    let depends = camera.time != TimeDependence::None;
    let status = match &rows.shutter {
        Shutter::Global => EffectStatus::LeftOut("all rows are exposed simultaneously".to_owned()),
        Shutter::Rolling(_) if !depends => EffectStatus::LeftOut("nothing in the scene depends on time".to_owned()),
        Shutter::Rolling(_) => {
            EffectStatus::Modelled("each row's samples have times within its own exposure".to_owned())
        }
        Shutter::GlobalReset(_) => EffectStatus::Modelled("rows that are read later receive more light".to_owned()),
    };
    let global = match &camera.body.sensor {
        Some(_) => without(camera, "sensor.shutter"),
        None => {
            let shutter = format!("{{type=\"global\",exposure_s={:?}}}", rows.exposure_s);
            camera_change(camera, "sensor.shutter", &shutter)
        }
    };
    PlannedEffect::new(GROUP, "rolling shutter", status).described_by("sensor.shutter").dropped_by([global]).with_error(
        "last row exposed early by",
        1e3 * rows.shutter.length_s(rows.rows, 0.0),
        "ms",
    )
}

/// An effect of the sensor's list, with the changes of keys that leave it out.
fn listed_effect(camera: &CameraPlan, effect: SensorEffect) -> PlannedEffect {
    let SensorEffect { name, key, status, left_out_by, errors } = effect;
    let planned = PlannedEffect::new(GROUP, name, status).described_by(key).left_out_by(camera, &left_out_by);
    errors
        .into_iter()
        .fold(planned, |planned, KnownError { quantity, value, unit }| planned.with_error(quantity, value, unit))
}
