//! What is said of a frame that has a light of its own.

use super::pose_rows;
use etendue_pipeline::plan::{CameraPlan, Plan, TimeDependence};
use etendue_sensor::SensorState;
use serde_json::{Value, json};

/// The keys of what the sensor remembers, and of the first frame that it remembers anything of.
const STATE: &str = "sensor_state";
const SINCE: &str = "sensor_since_frame";

/// A frame with its times and poses, and what is said of its `photograph`, where there is one.
pub(crate) fn own_frame(plan: &Plan, camera: &CameraPlan, frame: u32, photograph: Option<Value>) -> Value {
    let exposure = camera.timing.capture(frame, 0);
    let pose = |time_s: f64| pose_rows(&camera.path.at(time_s));
    let mut facts = photograph.unwrap_or_else(|| json!({ "frame": frame }));
    facts["plan_hash"] = plan.hash_text().into();
    facts["time_s"] = camera.timing.frame_start_s(frame).into();
    facts["exposure"] = json!({ "start_s": exposure.start_s(), "end_s": exposure.end_s() });
    facts["pose_time_s"] = exposure.middle_s().into();
    facts["camera_to_world"] = json!(pose(exposure.middle_s()));
    if camera.time == TimeDependence::Motion && camera.path.still_over(exposure).is_none() {
        facts["camera_to_world_start"] = json!(pose(exposure.start_s()));
        facts["camera_to_world_end"] = json!(pose(exposure.end_s()));
    }
    facts
}

/// The same with what the sensor remembers afterwards of the frames since the run's first.
pub(crate) fn with_state(mut facts: Value, after: &SensorState, since: u32) -> Value {
    facts[STATE] = serde_json::to_value(after).unwrap_or(Value::Null);
    facts[SINCE] = since.into();
    facts
}

/// The same without it.
pub(crate) fn without_state(mut facts: Value) -> Value {
    if let Some(table) = facts.as_object_mut() {
        table.remove(STATE);
        table.remove(SINCE);
    }
    facts
}

/// What a sensor that remembers the frames since `since` remembers after a frame; `None` where the file does not tell that.
pub(crate) fn state_of(facts: &Value, since: u32) -> Option<SensorState> {
    facts.get(SINCE).filter(|stated| **stated == since)?;
    serde_json::from_value(facts.get(STATE)?.clone()).ok()
}
