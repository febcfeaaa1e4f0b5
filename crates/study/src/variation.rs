//! The frame with other values of keys: models and precisions, compared with the unchanged job.

use crate::Clock;
use crate::change::{FrameChange, header};
use crate::configuration::{SAMPLE_KEYS, is_of};
use crate::edge::EdgeChart;
use crate::frame_render::{FrameRenderer, SECOND_SAMPLES_RATIO};
use crate::study::StudyRequest;
use etendue::{Error, ErrorCode, Job, JobRequest, Observer, Progress, ProgressUnit};
use serde::Serialize;
use std::fmt::Write as _;

/// Result of other values of keys.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VariationResult {
    /// Changes of keys, in the syntax of `--set`.
    pub set: Vec<String>,
    /// Estimated memory of all effects for which the plan has an estimate, bytes: cubes of light, maps, textures in tiles.
    pub memory_bytes: f64,
    /// Change of the frame.
    #[serde(flatten)]
    pub change: FrameChange,
}

/// A frame with each of the variations.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VariationStudy {
    pub camera: String,
    /// Samples per pixel for the errors.
    pub spp: u32,
    /// CPU time of loading the job and rendering one unchanged frame, s.
    pub cpu_s: f64,
    /// Estimated memory of that frame in the plan, bytes.
    pub memory_bytes: f64,
    /// The variations, in the requested order.
    pub varied: Vec<VariationResult>,
}

/// Renders a frame of a job with each of `variations`, which are changes of keys. Runs on the caller's thread pool.
///
/// # Errors
/// The job is invalid, unchanged or with a variation, or has no such camera; a variation changes the number of samples; the observer cancels, or light is not
/// finite.
pub fn variations(
    request: &StudyRequest,
    variations: &[Vec<String>],
    clock: &dyn Clock,
    observer: &dyn Observer,
) -> Result<VariationStudy, Error> {
    let renderer = FrameRenderer::open(request, clock, observer)?;
    let camera = &renderer.camera;
    let requests = variations.iter().map(|set| varied_request(&renderer.own, set, camera));
    let requests = requests.collect::<Result<Vec<_>, _>>()?;
    // Reports all errors before rendering starts.
    let memory = requests.iter().map(|request| Ok(memory_bytes(&request.clone().open()?, camera)));
    let memory = memory.collect::<Result<Vec<_>, Error>>()?;
    let spp = renderer.affordable_spp(requests.len() + 1)?;
    let edges = EdgeChart::open(&renderer)?;
    let unchanged = renderer.render_pair(&renderer.own, spp)?;
    let (mut varied, total) = (Vec::new(), requests.len());
    for (done, ((request, set), memory_bytes)) in requests.iter().zip(variations).zip(memory).enumerate() {
        observer.progress(Progress { heading: &set.join("; "), frame: None, unit: ProgressUnit::Pilots, done, total });
        let change = FrameChange::new(&unchanged, &renderer.render_pair(request, spp)?, renderer.job_spp)?;
        let change = change.with_edges(edges.as_ref(), set)?;
        varied.push(VariationResult { set: set.clone(), memory_bytes, change });
    }
    observer.progress(Progress { heading: "done", frame: None, unit: ProgressUnit::Pilots, done: total, total });
    drop(edges);
    let (cpu_s, memory_bytes) = (unchanged.seconds(renderer.job_spp), memory_bytes(&renderer.job, camera));
    Ok(VariationStudy { spp: spp * (1 + SECOND_SAMPLES_RATIO), cpu_s, memory_bytes, camera: renderer.camera, varied })
}

fn varied_request(own: &JobRequest, set: &[String], camera: &str) -> Result<JobRequest, Error> {
    if let Some(change) = set.iter().find(|change| is_of(change, camera, &SAMPLE_KEYS)) {
        let problem =
            "samples are chosen by `time_s` here; without `vary` a study reports the effect of more or fewer samples";
        return Err(Error::argument("vary", format!("`vary` {change}: {problem}")).with_code(ErrorCode::InvalidChange));
    }
    let mut request = own.clone();
    request.set.extend(set.iter().cloned());
    Ok(request)
}

/// Estimated memory of all effects of a camera, bytes.
fn memory_bytes(job: &Job, camera: &str) -> f64 {
    let effects = job.effects().into_iter().find(|(plan, _)| plan.name == camera);
    effects.map_or(0.0, |(_, effects)| effects.iter().filter_map(|effect| effect.memory_bytes).fold(0.0, |a, b| a + b))
}

/// The table of variations.
#[must_use]
pub fn variation_table(variations: &VariationStudy) -> String {
    let megabytes = |bytes: f64| format!("{:.0} MB", bytes / 1e6);
    let labels: Vec<_> = variations.varied.iter().map(|varied| varied.set.join("; ")).collect();
    let width = labels.iter().map(|label| label.chars().count()).fold("with".len(), usize::max);
    let mut out = format!(
        "camera {}: one frame takes {:.1} s of CPU time and, by its plan, {} of memory; measured with {} samples per pixel\n\n{:<width$} {:>9} {}\n",
        variations.camera,
        variations.cpu_s,
        megabytes(variations.memory_bytes),
        variations.spp,
        "with",
        "memory",
        header()
    );
    for (varied, label) in variations.varied.iter().zip(labels) {
        let _ = writeln!(out, "{label:<width$} {:>9} {}", megabytes(varied.memory_bytes), varied.change.row());
    }
    out
}
