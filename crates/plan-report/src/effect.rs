//! An effect of a camera's plan.

use etendue_core::EffectStatus;
use etendue_core::KnownError;
use etendue_pipeline::report::effects::{EffectGroup, PlannedEffect};

/// Whether an effect is modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Need {
    /// Modelled, always run.
    Required,
    /// Modelled, run where a cheap test asks for it.
    Guarded,
    /// Absent, at no cost.
    Skipped,
}

impl From<&EffectStatus> for Need {
    fn from(status: &EffectStatus) -> Self {
        match status {
            EffectStatus::Modelled(_) => Self::Required,
            EffectStatus::WhereNeeded(_) => Self::Guarded,
            EffectStatus::LeftOut(_) | EffectStatus::NotDescribed => Self::Skipped,
        }
    }
}

/// An effect, whether it is modelled, and what it takes of one frame.
#[derive(Clone, Debug, serde::Serialize)]
pub struct EffectReport {
    /// Its name in letters, digits and underscores, alone of all.
    pub id: String,
    /// Its name for people.
    pub name: &'static str,
    /// Which part of the frame's making it belongs to.
    pub group: EffectGroup,
    /// Whether it is modelled.
    pub status: Need,
    /// Why.
    pub reason: String,
    /// The key that describes it; that of a camera after `cameras.NAME.`.
    pub key: Option<&'static str>,
    /// Processor time of one frame that it is foretold to take, s.
    pub cpu_s: Option<f64>,
    /// The same over that of the whole frame. Parts of others are in the list: shares do not add up to 1.
    pub cpu_share: Option<f64>,
    /// Memory that it takes while the frame is rendered, bytes.
    pub memory_bytes: Option<f64>,
    /// What leaving it out would bring; null where it is not modelled.
    pub if_dropped: Option<IfDroppedReport>,
}

/// What leaving an effect out would bring.
#[derive(Clone, Debug, serde::Serialize)]
pub struct IfDroppedReport {
    /// Changes of keys that leave it out, as `--set` takes them; null where no key does.
    pub set: Option<Vec<String>>,
    /// Processor time of one frame that this is foretold to save, s; below 0 where it costs.
    pub cpu_saved_s: Option<f64>,
    /// The errors that have a closed form; empty: only rendering without it tells.
    pub errors: Vec<KnownError>,
}

impl EffectReport {
    /// Of an effect of a frame that is foretold to take `frame_s` seconds.
    pub(super) fn new(effect: PlannedEffect, frame_s: f64) -> Self {
        let id = effect.id();
        let PlannedEffect { group, name, key, status, cpu_s, memory_bytes, if_dropped } = effect;
        Self {
            id,
            name,
            group,
            status: Need::from(&status),
            reason: status.reason().to_owned(),
            key,
            cpu_s,
            cpu_share: cpu_s.filter(|_| frame_s > 0.0).map(|s| s / frame_s),
            memory_bytes,
            if_dropped: if_dropped.map(|dropped| IfDroppedReport {
                set: dropped.set,
                cpu_saved_s: dropped.cpu_saved_s,
                errors: dropped.errors,
            }),
        }
    }
}
