//! Exposure times of frames and rows: from records to a camera's timing.

use super::context::{Context, ErrorCode};
use crate::plan::{CameraBody, CameraPlan, Jitter, Route, TimeDependence, Timing};
use etendue_core::Epoch;
use etendue_scene::record::{self, Electronics, Sequence};
use etendue_scene::{CameraSetup, Place};
use etendue_tracer::accel::World;
use etendue_tracer::geometry::Mesh;
use etendue_tracer::lights::Sources;

/// Relative difference of a sequence's frame rate and a sensor's frame period that is attributed to rounding.
const RATE_TOLERANCE: f64 = 1e-6;

/// Maximum age of changing drops, s: five million steps.
const MAX_DROPS_AGE_S: f64 = 1e5;

/// Returns the epoch from which the times of a job are counted.
pub(super) fn epoch(sequence: Option<&Sequence>) -> Epoch {
    sequence.and_then(|s| s.start_s.as_ref()).map_or(Epoch::default(), |start| Epoch::near(start.value))
}

/// Timing of a camera of a job.
pub(super) fn timing(
    index: u32,
    setup: &CameraSetup,
    sequence: Option<&Sequence>,
    body: &CameraBody,
    seed: u64,
    context: &mut Context<'_>,
) -> Timing {
    let sensor = &setup.camera.sensor;
    let trigger = &setup.trigger;
    let offset_s = trigger.offset_s.as_ref().map_or(0.0, |o| o.value);
    let half_width_s = trigger.jitter_s.as_ref().map_or(0.0, |j| j.value);
    let timing = Timing {
        epoch: context.epoch,
        start_s: sequence.and_then(|s| s.start_s.as_ref()).map_or(0.0, |start| context.since_epoch_s(start)) + offset_s,
        period_s: period_s(sequence, sensor, context),
        jitter: (half_width_s > 0.0).then_some(Jitter { half_width_s, seed, camera: index }),
        exposure: body.exposure.clone(),
    };
    check(&timing, sensor, sequence, context);
    timing
}

/// Determines the time dependence of each camera's light, and whether its route supports it.
pub(super) fn set_time_dependence(
    cameras: &mut [CameraPlan],
    world: &World,
    sources: &Sources,
    is_modulated: bool,
    air_moves: bool,
    context: &mut Context<'_>,
) {
    let objects = world.instances().iter().map(|instance| &instance.to_world);
    let lamps = sources.lamps.iter().map(|lamp| lamp.to_world());
    let deforms = world.meshes().iter().filter_map(Mesh::animation).any(|animation| !animation.is_static());
    let is_moving = objects.chain(lamps).any(|motion| motion.as_constant().is_none());
    let moves = is_moving || deforms || air_moves;
    for camera in cameras {
        check_drops(camera, context);
        camera.time = match () {
            () if moves || !camera.path.is_stationary() || has_changing_front(camera) => TimeDependence::Motion,
            () if is_modulated => TimeDependence::Lights,
            () => TimeDependence::None,
        };
        let at_pupil = matches!(camera.settings.route, Route::Pupil(_));
        if camera.time != TimeDependence::None && at_pupil && !camera.timing.exposure.is_global() {
            let problem = "rows that are read in turn are exposed at different times, but route = \"pupil\" stores the \
                           light of one exposure for all of them";
            context.error(
                ErrorCode::NotModelled,
                &camera.body.place,
                problem,
                "give a \"global\" shutter, or route = \"lens\"",
            );
        }
        if camera.time == TimeDependence::Motion
            && camera.products.undistorted.is_some()
            && !camera.timing.exposure.is_global()
        {
            let problem = "rows that are read in turn are exposed at different times, but a row of the undistorted \
                           twin combines several of them";
            context.error(
                ErrorCode::NotModelled,
                &camera.body.place,
                problem,
                "give a \"global\" shutter, or remove \"undistorted\"",
            );
        }
    }
}

/// Refuses drops that start too early: they are simulated step by step from their start, in a time proportional to their age.
fn check_drops(camera: &CameraPlan, context: &mut Context<'_>) {
    let drop_motion = camera.body.front.as_ref().and_then(|front| front.course());
    let age_s = drop_motion.map_or(0.0, |drop_motion| camera.timing.frame_start_s(0) - drop_motion.start_s);
    if age_s > MAX_DROPS_AGE_S {
        let problem = format!("the drops begin {age_s:.0} s before frame 0; at most {MAX_DROPS_AGE_S} s are simulated");
        context.error(
            ErrorCode::ImpossibleTiming,
            &camera.body.place,
            problem,
            "set \"start_s\" of the drops to a time shortly before that of the sequence",
        );
    }
}

/// Returns true if drops on the glass before a camera change.
fn has_changing_front(camera: &CameraPlan) -> bool {
    camera.body.front.as_ref().is_some_and(|front| front.course().is_some())
}

/// Frame period as stated by the sequence, or by the sensor.
fn period_s(sequence: Option<&Sequence>, sensor: &record::Sensor, context: &mut Context<'_>) -> Option<f64> {
    let period = sensor.electronics.as_ref().and_then(|e| e.frame_period_s.as_ref());
    let Some(rate) = sequence.map(|s| &s.frame_rate_hz) else { return period.map(|s| s.value) };
    if let Some(period) = period.filter(|s| (s.value * rate.value - 1.0).abs() > RATE_TOLERANCE) {
        let problem = format!(
            "\"frame_period_s\" is {} s, but the job's sequence has {} frames per second, one every {} s",
            period.value,
            rate.value,
            1.0 / rate.value
        );
        context.error(
            ErrorCode::Contradiction,
            &period.place,
            problem,
            "make the two agree, or remove \"frame_period_s\" if nothing requires it",
        );
    }
    Some(1.0 / rate.value)
}

/// Checks that a row is exposed for the next frame only after it has been read, and that frames are read one after the other.
fn check(timing: &Timing, sensor: &record::Sensor, sequence: Option<&Sequence>, context: &mut Context<'_>) {
    let Some(period_s) = timing.period_s else { return };
    let jitter_s = timing.jitter.map_or(0.0, |jitter| 2.0 * jitter.half_width_s);
    let exposed_s = timing.exposure.longest_row_s() + jitter_s;
    let read_s = timing.exposure.reading_s() + jitter_s;
    let max_period_s = period_s * (1.0 + RATE_TOLERANCE);
    if exposed_s > max_period_s {
        let problem = format!(
            "a row takes {exposed_s} s from the start of its first exposure to the end of its last, including jitter, \
             but the frame period is {period_s} s"
        );
        context.error(
            ErrorCode::ImpossibleTiming,
            place(sensor, sequence),
            problem,
            "reduce the exposure or the frame rate",
        );
    } else if read_s > max_period_s {
        let problem =
            format!("reading all rows takes {read_s} s, including jitter, but the frame period is {period_s} s");
        let rows = sensor.shutter.as_ref().and_then(|shutter| shutter.row_time_us());
        context.error(
            ErrorCode::ImpossibleTiming,
            rows.map_or(&sensor.place, |time| &time.place),
            problem,
            "read rows faster, or reduce the frame rate",
        );
    }
}

fn place<'a>(sensor: &'a record::Sensor, sequence: Option<&'a Sequence>) -> &'a Place {
    let electronics = |e: &'a Electronics| &e.exposure_s.place;
    let by_shutter = sensor.shutter.as_ref().and_then(|shutter| shutter.exposure_s()).map(|e| &e.place);
    let by_sequence = sequence.map(|s| &s.frame_rate_hz.place);
    sensor.electronics.as_ref().map(electronics).or(by_shutter).or(by_sequence).unwrap_or(&sensor.place)
}
