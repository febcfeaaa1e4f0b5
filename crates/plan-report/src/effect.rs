//! An effect of a camera's plan.

use etendue_core::EffectStatus;
use etendue_core::KnownError;
use etendue_pipeline::report::effects::{EffectGroup, PlannedEffect};

/// Status of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EffectStatusReport {
    /// Modelled, always run.
    Required,
    /// Modelled, run only if a cheap test requires it.
    Guarded,
    /// Absent, at no cost.
    Skipped,
}

impl From<&EffectStatus> for EffectStatusReport {
    fn from(status: &EffectStatus) -> Self {
        match status {
            EffectStatus::Modelled(_) => Self::Required,
            EffectStatus::WhereNeeded(_) => Self::Guarded,
            EffectStatus::LeftOut(_) | EffectStatus::NotDescribed => Self::Skipped,
        }
    }
}

/// An effect, its status, and its cost in one frame.
#[derive(Clone, Debug, serde::Serialize)]
pub struct EffectReport {
    /// Unique identifier of letters, digits and underscores.
    pub id: String,
    /// Human-readable name.
    pub name: &'static str,
    /// Stage of the frame to which it belongs.
    pub group: EffectGroup,
    pub status: EffectStatusReport,
    /// Reason for the status.
    pub reason: String,
    /// Key that describes it; for cameras relative to `cameras.NAME.`.
    pub key: Option<&'static str>,
    /// Estimated CPU time per frame, s.
    pub cpu_s: Option<f64>,
    /// CPU time as a fraction of that of the whole frame. Some effects are parts of others: the fractions do not add up to 1.
    pub cpu_share: Option<f64>,
    /// Memory during rendering of the frame, bytes.
    pub memory_bytes: Option<f64>,
    /// Result of leaving it out; null if it is not modelled.
    pub if_dropped: Option<OmissionReport>,
}

/// Result of leaving an effect out.
#[derive(Clone, Debug, serde::Serialize)]
pub struct OmissionReport {
    /// Changes of keys, in the syntax of `--set`, that leave it out; null if no key does.
    pub set: Option<Vec<String>>,
    /// Estimated CPU time saved per frame, s; below 0 if it increases.
    pub cpu_saved_s: Option<f64>,
    /// Errors with a closed form; empty: only a render without the effect shows the error.
    pub errors: Vec<KnownError>,
}

impl EffectReport {
    /// Report of an effect of a frame with an estimated time of `frame_s` seconds.
    pub(super) fn new(effect: PlannedEffect, frame_s: f64) -> Self {
        let id = effect.id();
        let PlannedEffect { group, name, key, status, cpu_s, memory_bytes, omission: if_dropped } = effect;
        Self {
            id,
            name,
            group,
            status: EffectStatusReport::from(&status),
            reason: status.reason().to_owned(),
            key,
            cpu_s,
            cpu_share: cpu_s.filter(|_| frame_s > 0.0).map(|s| s / frame_s),
            memory_bytes,
            if_dropped: if_dropped.map(|omission| OmissionReport {
                set: omission.set,
                cpu_saved_s: omission.cpu_saved_s,
                errors: omission.errors,
            }),
        }
    }
}
