//! `[sensor]`: from the record to the sensor's model.

mod channels;
mod charge;
mod light;
mod read_out;

use crate::compile::context::{Context, ErrorCode};
use channels::{cfa, channels};
use etendue_scene::record::sensor::read_out::OpticalBlack;
use etendue_scene::{Placed, record};
use etendue_sensor::{Pixel, Sensor, SensorError, SensorParameters};

/// Sensor with its electronics, `exit_pupil_mm` behind its lens's exit pupil; `None` if the record has none or they are invalid.
pub(in super::super) fn sensor(
    record: &record::Sensor,
    exit_pupil_mm: f64,
    context: &mut Context<'_>,
) -> Option<Sensor> {
    let electronics = record.electronics.as_ref()?;
    refuse_no_shield(electronics.optical_black.as_ref(), context);
    let channels = channels(electronics, context)?;
    let unit_seed = electronics.non_uniformity.as_ref().and_then(|n| n.seed.as_ref());
    let parameters = SensorParameters {
        pixel: Pixel { pitch_um: record.pixel_pitch_um.value, fill_factor: fill_factor(record) },
        cfa: cfa(&electronics.cfa, context)?,
        channels,
        exposure: light::exposure(electronics),
        unit: unit_seed.map(|seed| seed.value),
        light: light::light(record, electronics, exit_pupil_mm),
        charge: charge::charge(electronics),
        voltage: read_out::voltage(electronics),
        read_out: read_out::read_out(electronics),
        hdr: read_out::hdr(electronics),
        noise: electronics.noise.as_ref().is_none_or(|n| n.value),
    };
    let sensor = Sensor::new(parameters).map_err(|errors| refuse(record, &errors, context)).ok()?;
    let misfits = sensor.image_size_errors(record.width_px.value as usize, record.height_px.value as usize);
    refuse(record, &misfits, context);
    misfits.is_empty().then_some(sensor)
}

/// Refuses optical black of no pixels.
fn refuse_no_shield(record: Option<&OpticalBlack>, context: &mut Context<'_>) {
    let none = |key: Option<&Placed<u64>>| key.is_none_or(|k| k.value == 0);
    if let Some(dark) = record.filter(|d| none(d.rows_px.as_ref()) && none(d.columns_px.as_ref())) {
        let problem = "\"optical_black\" has neither rows nor columns";
        context.error(ErrorCode::Empty, &dark.place, problem, "give \"rows_px\" or \"columns_px\", or remove it");
    }
}

/// Reports each error at its key, or at the innermost stated table around it.
fn refuse(record: &record::Sensor, errors: &[SensorError], context: &mut Context<'_>) {
    let table = record.to_table();
    for error in errors {
        context.error(
            ErrorCode::OutOfRange,
            table.place_of(error.key()).unwrap_or(&record.place),
            error.to_string(),
            "",
        );
    }
}

/// Fraction of a pixel's area that is sensitive.
pub(in super::super) fn fill_factor(record: &record::Sensor) -> f64 {
    record.fill_factor.as_ref().map_or(1.0, |f| f.value)
}
