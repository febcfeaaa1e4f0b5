//! Ablation: the frame with and without each effect.

use crate::Clock;
use crate::change::{FrameChange, header};
use crate::configuration::{SAMPLE_KEYS, is_of};
use crate::edge::EdgeChart;
use crate::frame_render::{FrameRenderer, SECOND_SAMPLES_RATIO};
use crate::study::StudyRequest;
use etendue::{EffectGroup, Error, Observer, Progress, ProgressUnit};
use serde::Serialize;

/// Result of leaving an effect out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DroppedEffect {
    /// The effect, as named by `etendue plan`.
    pub effect: &'static str,
    /// Its identifier in files.
    pub id: String,
    /// Changes of keys that leave it out.
    pub set: Vec<String>,
    /// Change of the frame.
    #[serde(flatten)]
    pub change: FrameChange,
}

/// An effect that no key leaves out, or whose change of keys the job rejects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RetainedEffect {
    pub effect: &'static str,
    pub reason: String,
}

/// A frame with and without each of its effects.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ablation {
    pub camera: String,
    /// Samples per pixel for the errors.
    pub spp: u32,
    /// CPU time of loading the job and rendering one unchanged frame, s.
    pub cpu_s: f64,
    /// Effects that were left out, in the order of the light.
    pub dropped: Vec<DroppedEffect>,
    /// Effects that were not left out.
    #[serde(rename = "kept")]
    pub retained: Vec<RetainedEffect>,
}

/// Renders a frame of a job without each effect that a key leaves out according to its plan. Runs on the caller's thread pool.
///
/// # Errors
/// The job is invalid or has no such camera, the observer cancels, or light is not finite.
pub fn ablation(request: &StudyRequest, clock: &dyn Clock, observer: &dyn Observer) -> Result<Ablation, Error> {
    let renderer = FrameRenderer::open(request, clock, observer)?;
    let mut trials = Vec::new();
    let mut retained = Vec::new();
    for effect in renderer.effects() {
        match effect.omission.as_ref().map(|omission| omission.set.clone()) {
            // Output files do not change the frame.
            _ if effect.group == EffectGroup::Output => {}
            Some(Some(set)) if set.iter().any(|change| is_of(change, &renderer.camera, &SAMPLE_KEYS)) => {
                retained.push(RetainedEffect {
                    effect: effect.name,
                    reason: "the number of samples is chosen by `time_s` here".to_owned(),
                });
            }
            Some(Some(set)) => trials.push((effect.name, effect.id(), set)),
            Some(None) => {
                retained.push(RetainedEffect { effect: effect.name, reason: "no key disables it".to_owned() });
            }
            None => {}
        }
    }
    let spp = renderer.affordable_spp(trials.len() + 1)?;
    let edges = EdgeChart::open(&renderer)?;
    let with = renderer.render_pair(&renderer.own, spp)?;
    let mut dropped_effects = Vec::new();
    let total = trials.len();
    for (done, (effect, id, set)) in trials.into_iter().enumerate() {
        observer.progress(Progress { heading: effect, frame: None, unit: ProgressUnit::Pilots, done, total });
        let mut changed = renderer.own.clone();
        changed.set.extend(set.iter().cloned());
        match renderer.render_pair(&changed, spp) {
            Ok(without) => {
                let change = FrameChange::new(&with, &without, renderer.job_spp)?.with_edges(edges.as_ref(), &set)?;
                dropped_effects.push(DroppedEffect { effect, id, set, change });
            }
            Err(Error::Input(reason)) => {
                retained.push(RetainedEffect { effect, reason: Error::Input(reason).to_string().trim().to_owned() });
            }
            Err(other) => return Err(other),
        }
    }
    observer.progress(Progress { heading: "done", frame: None, unit: ProgressUnit::Pilots, done: total, total });
    drop(edges);
    let cpu_s = with.seconds(renderer.job_spp);
    Ok(Ablation {
        spp: spp * (1 + SECOND_SAMPLES_RATIO),
        cpu_s,
        camera: renderer.camera,
        dropped: dropped_effects,
        retained,
    })
}

/// The table of an ablation.
#[must_use]
pub fn ablation_table(ablation: &Ablation) -> String {
    use std::fmt::Write as _;
    let mut out = format!(
        "camera {}: one frame takes {:.1} s of CPU time; measured with {} samples per pixel\n\n{:<30} {}\n",
        ablation.camera,
        ablation.cpu_s,
        ablation.spp,
        "without",
        header()
    );
    for effect in &ablation.dropped {
        let _ = writeln!(out, "{:<30} {}", effect.effect, effect.change.row());
    }
    if !ablation.retained.is_empty() {
        let names: Vec<_> = ablation.retained.iter().map(|effect| effect.effect).collect();
        let _ =
            writeln!(out, "\nnot left out (always on, or the job does not accept the change): {}", names.join(", "));
    }
    out
}
