//! Exposure of rows: from records to a camera's shutter.

use super::context::{Context, ErrorCode};
use crate::plan::{CaptureTiming, RowExposure, RowSkipping};
use etendue_core::{RowTiming, Shutter};
use etendue_projection::Raster;
use etendue_scene::Placed;
use etendue_scene::record;
use etendue_scene::record::sensor::hdr::Capture;
use etendue_scene::record::sensor::shutter::{Direction, Rows};
use etendue_sensor::Sensor;

/// Exposures of a camera's rows.
pub(super) fn row_exposure(
    record: &record::Sensor,
    sensor: Option<&Sensor>,
    raster: &Raster,
    context: &mut Context<'_>,
) -> RowExposure {
    let region = sensor.and_then(|sensor| sensor.parameters().read_out.layout.region);
    let (first_row, rows) = region.map_or((0, raster.height()), |region| (region.y, region.height));
    let skipping = sensor.map_or(RowSkipping::NONE, row_skipping);
    let rows = rows / skipping.pitch * skipping.together;
    let exposure_s = exposure_s(record);
    let hdr = record.electronics.as_ref().and_then(|e| e.hdr.as_ref());
    let further = hdr.map_or(&[][..], |hdr| &hdr.captures);
    refuse_idle_starts(further, context);
    let shutter = record.shutter.as_ref().map_or(Shutter::Global, shutter);
    let rows = rows.max(1);
    // Time from the start of a row's exposure to its end, for the last row.
    let length_s = |exposure_s: f64| match shutter {
        Shutter::GlobalReset(_) => shutter.length_s(rows, exposure_s),
        Shutter::Global | Shutter::Rolling(_) => exposure_s,
    };
    let captures = captures(further, exposure_s, length_s, context);
    RowExposure { shutter, first_row, rows, skipping, exposure_s, captures }
}

/// Skipped rows of tiles; a sensor's layout fits its image, so that the division is exact.
fn row_skipping(sensor: &Sensor) -> RowSkipping {
    let p = sensor.parameters();
    p.read_out.layout.skipping.filter(|skipping| skipping.rows > 1).map_or(RowSkipping::NONE, |skipping| {
        let together = p.cfa.height();
        RowSkipping { together, pitch: together * skipping.rows }
    })
}

fn shutter(record: &record::sensor::Shutter) -> Shutter {
    match record {
        record::sensor::Shutter::Global(_) => Shutter::Global,
        record::sensor::Shutter::Rolling(rows) => Shutter::Rolling(row_timing(rows)),
        record::sensor::Shutter::GlobalReset(rows) => Shutter::GlobalReset(row_timing(rows)),
    }
}

fn row_timing(rows: &Rows) -> RowTiming {
    RowTiming {
        row_time_s: 1e-6 * rows.row_time_us.value,
        upwards: rows.direction.as_ref().is_some_and(|d| d.value == Direction::Up),
        fields: rows.fields.as_ref().map_or(1, |f| f.value as u32),
    }
}

fn exposure_s(sensor: &record::Sensor) -> f64 {
    let electronics = sensor.electronics.as_ref().map(|e| e.exposure_s.value);
    let shutter = || sensor.shutter.as_ref().and_then(|s| s.exposure_s()).map(|e| e.value);
    electronics.or_else(shutter).unwrap_or(0.0)
}

/// Captures of a frame. Those of one photodiode follow each other, because it can collect only one charge at a time.
fn captures(
    further: &[Capture],
    exposure_s: f64,
    length_s: impl Fn(f64) -> f64,
    context: &mut Context<'_>,
) -> Vec<CaptureTiming> {
    let or_1 = |ratio: &Option<Placed<f64>>| ratio.as_ref().map_or(1.0, |r| r.value);
    let mut captures = vec![CaptureTiming { start_s: 0.0, exposure_ratio: 1.0 }];
    // End of the last exposure of each photodiode, identified by its sensitivity.
    let mut ends = vec![(1.0, length_s(exposure_s))];
    for capture in further {
        if capture.dual_conversion_gain.as_ref().is_some_and(|d| d.value) {
            captures.push(captures[captures.len() - 1]);
            continue;
        }
        let (sensitivity, exposure_ratio) = (or_1(&capture.sensitivity_ratio), or_1(&capture.exposure_ratio));
        let end = ends.iter().rev().find(|(s, _)| *s == sensitivity).map_or(0.0, |(_, end)| *end);
        if let Some(start) = capture.start_s.as_ref().filter(|start| start.value < end * (1.0 - 1e-9)) {
            let problem = format!(
                "the exposure begins {} s after the first, but the previous one of the same photodiode ends {end} s \
                 after it",
                start.value
            );
            context.error(ErrorCode::ImpossibleTiming, &start.place, problem, "increase \"start_s\", or remove it");
        }
        let start_s = capture.start_s.as_ref().map_or(end, |start| start.value);
        ends.push((sensitivity, start_s + length_s(exposure_s * exposure_ratio)));
        captures.push(CaptureTiming { start_s, exposure_ratio });
    }
    captures
}

/// Refuses a start time for charge that is read again.
fn refuse_idle_starts(further: &[Capture], context: &mut Context<'_>) {
    let has_dual_gain = |capture: &&Capture| capture.dual_conversion_gain.as_ref().is_some_and(|d| d.value);
    for start in further.iter().filter(has_dual_gain).filter_map(|capture| capture.start_s.as_ref()) {
        let problem = "\"start_s\" has no effect on charge that is read again: it is already collected";
        context.error(ErrorCode::NoEffect, &start.place, problem, "remove it");
    }
}
