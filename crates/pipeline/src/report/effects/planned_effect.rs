//! An effect of a camera's plan: its status, its cost, and the result of leaving it out, with the changes of a job's keys (in the syntax of `--set`) that do
//! so.

use crate::plan::CameraPlan;
use etendue_core::{EffectStatus, KeyChange, KnownError};

/// Stages of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EffectGroup {
    LightTransport,
    /// Geometry, materials and light sources.
    Scene,
    /// Fog, rain and snow.
    Weather,
    /// From the scene to the sensor plane.
    Lens,
    /// From light to digital numbers.
    Sensor,
    /// From digital numbers to the image.
    Processing,
    /// Products.
    Output,
}

impl EffectGroup {
    /// All groups, in order.
    pub const ALL: [Self; 7] =
        [Self::LightTransport, Self::Scene, Self::Weather, Self::Lens, Self::Sensor, Self::Processing, Self::Output];

    /// The group's name in a plan.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::LightTransport => "light transport",
            Self::Scene => "scene",
            Self::Weather => "weather",
            Self::Lens => "lens",
            Self::Sensor => "sensor",
            Self::Processing => "processing",
            Self::Output => "output",
        }
    }
}

/// An effect, its status, and its cost in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedEffect {
    /// Stage of the frame to which it belongs.
    pub group: EffectGroup,
    /// Unique name.
    pub name: &'static str,
    /// Key that describes it, relative to the camera's name for groups of a camera; `None` without one.
    pub key: Option<&'static str>,
    /// Status, with the reason.
    pub status: EffectStatus,
    /// Estimated CPU time per frame, s; `None`: unknown.
    pub cpu_s: Option<f64>,
    /// Memory during rendering of the frame, bytes; `None`: unknown.
    pub memory_bytes: Option<f64>,
    /// Result of leaving it out; `None` if it is not modelled.
    pub omission: Option<OmissionResult>,
}

/// Result of leaving an effect out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OmissionResult {
    /// Changes of keys, in the syntax of `--set`, that leave it out; `None` if no key does.
    pub set: Option<Vec<String>>,
    /// Estimated CPU time saved per frame, s; below 0 if it increases; `None`: unknown.
    pub cpu_saved_s: Option<f64>,
    /// Errors with a closed form; empty: only a render without the effect shows the error.
    pub errors: Vec<KnownError>,
}

impl PlannedEffect {
    /// An effect of this status, with everything else unknown.
    pub(super) fn new(group: EffectGroup, name: &'static str, status: EffectStatus) -> Self {
        let if_dropped = status.is_modelled().then(OmissionResult::default);
        Self { group, name, key: None, status, cpu_s: None, memory_bytes: None, omission: if_dropped }
    }

    /// Identifier in files: letters, digits and underscores.
    #[must_use]
    pub fn id(&self) -> String {
        let words = self.name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        words.collect::<Vec<_>>().join("_").to_ascii_lowercase()
    }

    /// Sets the key that describes it.
    pub(super) fn described_by(self, key: &'static str) -> Self {
        Self { key: Some(key), ..self }
    }

    /// Sets the changes that leave it out.
    pub(super) fn dropped_by(mut self, set: impl IntoIterator<Item = String>) -> Self {
        let set: Vec<String> = set.into_iter().collect();
        if let Some(if_dropped) = self.omission.as_mut().filter(|_| !set.is_empty()) {
            if_dropped.set = Some(set);
        }
        self
    }

    /// Sets the changes of keys of its camera that leave it out.
    pub(super) fn left_out_by(self, camera: &CameraPlan, changes: &[KeyChange]) -> Self {
        self.dropped_by(changes.iter().map(|change| camera_change(camera, change.key, change.value.unwrap_or(REMOVED))))
    }

    /// Sets its CPU time, s, all of which is saved by leaving it out.
    pub(super) fn with_cpu_time(self, cpu_s: f64) -> Self {
        Self { cpu_s: self.status.is_modelled().then_some(cpu_s), ..self }.with_saving(cpu_s)
    }

    /// Sets the CPU time saved by leaving it out, s.
    pub(super) fn with_saving(mut self, cpu_s: f64) -> Self {
        if let Some(if_dropped) = &mut self.omission {
            if_dropped.cpu_saved_s = Some(cpu_s);
        }
        self
    }

    /// Sets its memory, bytes.
    pub(super) fn with_memory(self, bytes: f64) -> Self {
        Self { memory_bytes: self.status.is_modelled().then_some(bytes), ..self }
    }

    /// Adds an error with a closed form.
    pub(super) fn with_error(mut self, quantity: &'static str, value: f64, unit: &'static str) -> Self {
        if let Some(if_dropped) = self.omission.as_mut().filter(|_| value.is_finite()) {
            if_dropped.errors.push(KnownError { quantity, value, unit });
        }
        self
    }
}

/// Required if present, otherwise skipped, each with its reason.
pub(super) fn required_if(is_there: bool, reason: impl Into<String>, absent_reason: impl Into<String>) -> EffectStatus {
    if is_there { EffectStatus::Modelled(reason.into()) } else { EffectStatus::LeftOut(absent_reason.into()) }
}

/// Value that removes a key.
pub(super) const REMOVED: &str = "null";

/// A change of a key of a camera: of `lens.distortion`, `render.caustics` …
pub(super) fn camera_change(camera: &CameraPlan, key: &str, value: &str) -> String {
    // A dot in a name would end it.
    let is_plain = !camera.name.contains(['.', '=']);
    let entry = if is_plain { camera.name.clone() } else { camera.index.to_string() };
    format!("cameras.{entry}.{key}={value}")
}

/// Removes a key of a camera.
pub(super) fn without(camera: &CameraPlan, key: &str) -> String {
    camera_change(camera, key, REMOVED)
}
