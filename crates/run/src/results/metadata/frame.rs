//! Facts of a frame with its own light.

use crate::results::levels;
use etendue_core::{CameraPose, ExactTime};
use etendue_io::{FileDigest, sidecar};
use etendue_pipeline::plan::{CameraPlan, Plan, TimeDependence, Timing};
use etendue_sensor::{ChargeAccount, Raw, SensorState};
use serde::Deserialize as _;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// Keys of the sensor's state, and of the first frame that contributed to it.
const STATE: &str = "sensor_state";
const SINCE_FRAME: &str = "sensor_since_frame";
/// Keys of the digests of the frame's files, by name, and of the hash of the rest of the file.
const FILES: &str = "files";
const SHA256: &str = "sha256";

/// Returns a raw frame's facts: file, exposure and gain, levels, destination of overflowing charge, mean level and clipped pixels.
pub(crate) fn raw_frame(number: u32, file: Option<String>, raw: &Raw) -> Value {
    let area = raw.image;
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
        (levels::LEVELS): levels::FrameLevels::new(raw),
    })
}

/// Facts of a frame with its times and poses, and of its `photograph`, if any.
pub(crate) fn own_frame(plan: &Plan, camera: &CameraPlan, frame: u32, image: Option<Value>) -> Value {
    let exposure = camera.timing.capture(frame, 0);
    let pose = |time_s: f64| pose_rows(&camera.path.at(time_s));
    let mut facts = image.unwrap_or_else(|| json!({ "frame": frame }));
    facts["plan_hash"] = plan.hash_text().into();
    let timing = &camera.timing;
    facts["exposure"] = json!({});
    add_time(&mut facts["exposure"], timing, "start", timing.epoch.time(exposure.start_s()));
    add_time(&mut facts["exposure"], timing, "end", timing.epoch.time(exposure.end_s()));
    add_time(&mut facts, timing, "time", timing.frame_start(frame));
    add_time(&mut facts, timing, "pose_time", timing.frame_middle(frame));
    facts["camera_to_world"] = json!(pose(exposure.middle_s()));
    if camera.time == TimeDependence::Motion && camera.path.constant_over(exposure).is_none() {
        facts["camera_to_world_start"] = json!(pose(exposure.start_s()));
        facts["camera_to_world_end"] = json!(pose(exposure.end_s()));
    }
    facts
}

/// Adds the state of the sensor after the frame, accumulated from the run's first frame on.
pub(crate) fn with_state(mut facts: Value, after: &SensorState, since: u32) -> Value {
    facts[STATE] = serde_json::to_value(after).unwrap_or(Value::Null);
    facts[SINCE_FRAME] = since.into();
    facts
}

/// Adds the digests of the frame's files and a hash of all facts, for [`check_seal`].
pub(crate) fn with_seal(mut facts: Value, files: &BTreeMap<String, FileDigest>) -> Value {
    facts[FILES] = json!(files);
    facts[SHA256] = seal(&facts).into();
    facts
}

/// Checks that the facts of a frame and the files in `folder` that they name are unchanged.
///
/// # Errors
/// Describes the first that differs.
pub(crate) fn check_seal(facts: &Value, frame: u32, folder: &Path) -> Result<(), String> {
    if facts["frame"] != frame {
        return Err("it is the file of another frame".to_owned());
    }
    let mut unsealed = facts.clone();
    let stated_digest = unsealed.as_object_mut().and_then(|table| table.remove(SHA256));
    if stated_digest != Some(seal(&unsealed).into()) {
        return Err("it was changed after it was written".to_owned());
    }
    let files = BTreeMap::<String, FileDigest>::deserialize(&facts[FILES]);
    let files = files.map_err(|_| "it lists no files of the frame".to_owned())?;
    match files.iter().find(|(name, digest)| !digest.matches(&folder.join(name))) {
        Some((name, _)) => Err(format!("{name} is missing or was changed")),
        None => Ok(()),
    }
}

/// Hash of facts, over their bytes in a file.
fn seal(facts: &Value) -> String {
    FileDigest::from_bytes(&sidecar::encode(facts).unwrap_or_default()).sha256
}

/// Facts without those that only a resumed run needs.
pub(crate) fn without_state(mut facts: Value) -> Value {
    if let Some(table) = facts.as_object_mut() {
        [STATE, SINCE_FRAME, FILES, SHA256].iter().for_each(|key| drop(table.remove(*key)));
    }
    facts
}

/// State of a sensor after a frame, accumulated from frame `since` on; `None` if the file does not state it.
pub(crate) fn state_of(facts: &Value, since: u32) -> Option<SensorState> {
    facts.get(SINCE_FRAME).filter(|since_frame| **since_frame == since)?;
    serde_json::from_value(facts.get(STATE)?.clone()).ok()
}

/// Returns `<name>_s`, the nearest number, and, for a job whose epoch is not zero, `<name>`, text with digits to the picosecond.
pub(crate) fn time_facts(timing: &Timing, name: &str, time: ExactTime) -> Map<String, Value> {
    let number = (format!("{name}_s"), time.seconds().into());
    let text = (!timing.epoch.is_zero()).then(|| (name.to_owned(), digits(time).into()));
    std::iter::once(number).chain(text).collect()
}

/// Returns decimal seconds, rounded to the picosecond.
fn digits(time: ExactTime) -> String {
    const PER_S: f64 = 1e12;
    let rounded = (time.fraction_s() * PER_S).round() / PER_S;
    (ExactTime::from(time.whole_s() as f64) + rounded.into()).to_string()
}

/// Adds the entries of a time to a table.
pub(crate) fn add_time(table: &mut Value, timing: &Timing, name: &str, time: ExactTime) {
    if let Some(table) = table.as_object_mut() {
        table.extend(time_facts(timing, name, time));
    }
}

/// Returns the rows of the matrix from camera to world: axes and position, m.
pub(super) fn pose_rows(pose: &CameraPose) -> [[f64; 4]; 3] {
    std::array::from_fn(|i| {
        let row = pose.rotation.row(i);
        [row.x, row.y, row.z, pose.position_m[i]]
    })
}
