//! An effect of a camera's plan: whether it is modelled, what it takes, and what leaving it out would bring, by which changes of a job's keys
//! (as `--set` takes them).

use crate::plan::CameraPlan;
use etendue_core::{EffectStatus, KeyChange, KnownError};

/// The parts of a frame's making.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EffectGroup {
    /// How light is followed.
    LightTransport,
    /// What there is to see, and what shines.
    Scene,
    /// Fog, rain and snow.
    Weather,
    /// From the scene to the sensor plane.
    Lens,
    /// From light to digital numbers.
    Sensor,
    /// From digital numbers to the picture.
    Processing,
    /// What is delivered.
    Output,
}

impl EffectGroup {
    /// All groups, in their order.
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

/// An effect, whether it is modelled, and what it takes of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedEffect {
    /// Which part of the frame's making it belongs to.
    pub group: EffectGroup,
    /// Its name, alone of all.
    pub name: &'static str,
    /// The key that describes it, after the camera's name where the group is a camera's; `None` where there is none.
    pub key: Option<&'static str>,
    /// Whether it is modelled, and why.
    pub status: EffectStatus,
    /// Processor time of one frame that it is foretold to take, s; `None`: not known.
    pub cpu_s: Option<f64>,
    /// Memory that it takes while the frame is rendered, bytes; `None`: not known.
    pub memory_bytes: Option<f64>,
    /// What leaving it out would bring; `None` where it is not modelled.
    pub if_dropped: Option<IfDropped>,
}

/// What leaving an effect out would bring.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IfDropped {
    /// Changes of keys that leave it out, as `--set` takes them; `None` where no key does.
    pub set: Option<Vec<String>>,
    /// Processor time of one frame that this is foretold to save, s; below 0 where it costs; `None`: not known.
    pub cpu_saved_s: Option<f64>,
    /// The errors that have a closed form; empty: only rendering without it tells.
    pub errors: Vec<KnownError>,
}

impl PlannedEffect {
    /// An effect of this status, of which nothing else is known.
    pub(super) fn new(group: EffectGroup, name: &'static str, status: EffectStatus) -> Self {
        let if_dropped = status.is_modelled().then(IfDropped::default);
        Self { group, name, key: None, status, cpu_s: None, memory_bytes: None, if_dropped }
    }

    /// Its name in files: letters, digits and underscores.
    #[must_use]
    pub fn id(&self) -> String {
        let words = self.name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        words.collect::<Vec<_>>().join("_").to_ascii_lowercase()
    }

    /// The same, described by a key.
    pub(super) fn described_by(self, key: &'static str) -> Self {
        Self { key: Some(key), ..self }
    }

    /// The same, left out by these changes.
    pub(super) fn dropped_by(mut self, set: impl IntoIterator<Item = String>) -> Self {
        let set: Vec<String> = set.into_iter().collect();
        if let Some(if_dropped) = self.if_dropped.as_mut().filter(|_| !set.is_empty()) {
            if_dropped.set = Some(set);
        }
        self
    }

    /// The same, left out by these changes of keys of its camera.
    pub(super) fn left_out_by(self, camera: &CameraPlan, changes: &[KeyChange]) -> Self {
        self.dropped_by(changes.iter().map(|change| of_camera(camera, change.key, change.value.unwrap_or(REMOVED))))
    }

    /// The same, taking so many seconds, all of which its dropping saves.
    pub(super) fn taking(self, cpu_s: f64) -> Self {
        Self { cpu_s: self.status.is_modelled().then_some(cpu_s), ..self }.saving(cpu_s)
    }

    /// The same, whose dropping saves so many seconds.
    pub(super) fn saving(mut self, cpu_s: f64) -> Self {
        if let Some(if_dropped) = &mut self.if_dropped {
            if_dropped.cpu_saved_s = Some(cpu_s);
        }
        self
    }

    /// The same, taking so many bytes.
    pub(super) fn holding(self, bytes: f64) -> Self {
        Self { memory_bytes: self.status.is_modelled().then_some(bytes), ..self }
    }

    /// The same with an error of a closed form.
    pub(super) fn erring(mut self, quantity: &'static str, value: f64, unit: &'static str) -> Self {
        if let Some(if_dropped) = self.if_dropped.as_mut().filter(|_| value.is_finite()) {
            if_dropped.errors.push(KnownError { quantity, value, unit });
        }
        self
    }
}

/// Modelled where it is there, else left out, each with its reason.
pub(super) fn where_there(is_there: bool, reason: impl Into<String>, lack: impl Into<String>) -> EffectStatus {
    if is_there { EffectStatus::Modelled(reason.into()) } else { EffectStatus::LeftOut(lack.into()) }
}

/// The value that takes a key out.
pub(super) const REMOVED: &str = "null";

/// A change of a key of a camera: of `lens.distortion`, `render.caustics` …
pub(super) fn of_camera(camera: &CameraPlan, key: &str, value: &str) -> String {
    // A dot in a name would end it.
    let is_plain = !camera.name.contains(['.', '=']);
    let entry = if is_plain { camera.name.clone() } else { camera.index.to_string() };
    format!("cameras.{entry}.{key}={value}")
}

/// Takes a key of a camera out.
pub(super) fn without(camera: &CameraPlan, key: &str) -> String {
    of_camera(camera, key, REMOVED)
}
