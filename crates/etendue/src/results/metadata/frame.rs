//! What is said of a frame that has a light of its own.

use super::pose_rows;
use etendue_pipeline::plan::{CameraPlan, Plan, TimeDependence};
use etendue_sensor::SensorState;
use serde_json::{Value, json};

/// The key of what the sensor remembers.
const STATE: &str = "sensor_state";

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

/// The same with what the sensor remembers afterwards, where it does.
pub(crate) fn with_state(mut facts: Value, after: &SensorState) -> Value {
    if *after != SensorState::default() {
        facts[STATE] = serde_json::to_value(after).unwrap_or(Value::Null);
    }
    facts
}

/// The same without it.
pub(crate) fn without_state(mut facts: Value) -> Value {
    if let Some(table) = facts.as_object_mut() {
        table.remove(STATE);
    }
    facts
}

/// What the sensor remembers after a frame.
pub(crate) fn state_of(facts: &Value) -> SensorState {
    facts.get(STATE).and_then(|state| serde_json::from_value(state.clone()).ok()).unwrap_or_default()
}
