//! Text on the time dependence of a plan, and on the exposure of its frames and rows.

use super::words::figure;
use crate::plan::{CameraPlan, Plan, RowExposure, RowSkipping, TimeDependence};
use etendue_core::{RowTiming, Shutter};
use etendue_tracer::geometry::{Instance, Shape};

/// Moving parts; `None` without any.
pub(super) fn motion(plan: &Plan) -> Option<String> {
    let instances = plan.world.instances().iter().filter(|i| i.to_world.as_constant().is_none()).count();
    let cameras = plan.cameras.iter().filter(|camera| !camera.path.is_stationary()).count();
    let phrase = |count: usize, one: &str, many: &str| match count {
        0 => None,
        1 => Some(format!("one {one} moves")),
        n => Some(format!("{n} {many} move")),
    };
    let lamps = plan.sources.lamps.iter().filter(|lamp| lamp.to_world().as_constant().is_none()).count();
    let deforms = |instance: &&Instance| match instance.shape {
        Shape::Mesh(id) => plan.world.mesh(id).animation().is_some_and(|animation| !animation.is_static()),
        Shape::Sphere { .. } => false,
    };
    let deforming = plan.world.instances().iter().filter(deforms).count();
    let moving = [
        phrase(instances, "instance", "instances"),
        phrase(lamps, "lamp", "lamps"),
        phrase(cameras, "camera", "cameras"),
    ];
    let deforming = match deforming {
        0 => None,
        1 => Some("the vertices of one instance move".to_owned()),
        n => Some(format!("the vertices of {n} instances move")),
    };
    let moving: Vec<String> = moving.into_iter().chain([deforming]).flatten().collect();
    (!moving.is_empty()).then(|| moving.join(", "))
}

/// Times of a camera's frames; `None` if nothing depends on them.
pub(super) fn frames(camera: &CameraPlan) -> Option<String> {
    let why = match camera.time {
        TimeDependence::None => return None,
        TimeDependence::Lights => "nothing moves, lights change: each row receives their mean over its exposure",
        TimeDependence::Motion => "each sample has a time within the exposure of its row",
    };
    let timing = &camera.timing;
    let rate = match timing.period_s {
        None => "only frame 0, as no [sequence] is described".to_owned(),
        Some(period_s) => format!("{} per second", figure(1.0 / period_s)),
    };
    let jitter = timing.jitter.map_or_else(String::new, |j| format!(" ± {} s of jitter", j.half_width_s));
    Some(format!("{rate}, from {} s on{jitter}; {why}", timing.epoch.time(timing.start_s)))
}

/// The shutter as text; `None` if none is described and nothing depends on it.
pub(super) fn shutter(camera: &CameraPlan) -> Option<String> {
    let rows = &camera.body.exposure;
    if rows.shutter == Shutter::Global && camera.time == TimeDependence::None {
        return None;
    }
    let effect = match (camera.time, rows.is_even()) {
        (TimeDependence::None, true) => "; no effect, as nothing depends on time",
        (TimeDependence::None, false) => "; no effect except on the exposure of each row",
        _ => "",
    };
    let captures = match rows.captures.len() {
        1 => String::new(),
        n => format!("; {n} captures, the last one from {} s on", figure(rows.captures[n - 1].start_s)),
    };
    let s = rows.exposure_s;
    Some(match &rows.shutter {
        Shutter::Global => format!("global, {s} s{captures}{effect}"),
        Shutter::Rolling(timing) => format!("rolling, {s} s per row, {}{captures}{effect}", order(rows, timing)),
        Shutter::GlobalReset(timing) => {
            format!("global reset, {s} s in the first row, {}{captures}{effect}", order(rows, timing))
        }
    })
}

fn order(rows: &RowExposure, timing: &RowTiming) -> String {
    let RowTiming { row_time_s, upwards, fields } = timing;
    let from = if *upwards { "from the bottom" } else { "from the top" };
    let fields = if *fields > 1 { format!(" in {fields} fields") } else { String::new() };
    let last_ms = figure(1e3 * rows.shutter.length_s(rows.rows, 0.0));
    let RowSkipping { together, pitch } = rows.skipping;
    let skipped = if rows.skipping.skips() {
        format!(" of {} rows, {together} of every {pitch},", rows.rows)
    } else {
        String::new()
    };
    format!(
        "{} µs from row to row{skipped} {from}{fields}, the last one {last_ms} ms after the first",
        figure(1e6 * row_time_s)
    )
}
