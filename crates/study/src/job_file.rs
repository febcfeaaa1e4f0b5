//! A recommendation as a job file based on the user's.

use crate::configuration::{is_of, studied_keys};
use crate::front::Recommendation;
use crate::report::{error_text, time_text};
use etendue::{Error, JobRenderSettings, JobRequest, Word as _, relative_path};
use std::path::{Component, Path, PathBuf};

/// Text of a job file in `folder` that renders `camera` of a job as recommended.
///
/// # Errors
/// The job cannot be read.
pub fn job_file(
    recommendation: &Recommendation,
    job: &JobRequest,
    camera: &str,
    folder: &Path,
) -> Result<String, Error> {
    let JobRenderSettings { keys: stated_keys, cameras, .. } = job.stated_render(camera)?;
    let superseded = studied_keys();
    // Values that the job states for all cameras remain for the other cameras.
    let is_free = |key: &str| cameras == 1 || !key.starts_with("render.");
    let removed = stated_keys.iter().filter(|key| is_of(key, camera, &superseded) && is_free(key));
    let removed: Vec<_> = removed.map(|key| format!("{key:?}")).collect();
    let Recommendation { target, point, is_reached, .. } = recommendation;
    let keys = point.configuration.keys();
    let keys = keys.iter().map(|(key, value)| format!("{key} = {value}"));
    let samples = [format!("spp = {}", point.spp), format!("replicates = {}", point.replicates)];
    let render: Vec<_> = samples.into_iter().chain(keys).collect();
    let left_out = match point.configuration.left_out() {
        none if none.is_empty() => "nothing".to_owned(),
        what => what,
    };
    let mut text = format!(
        "# A {} of camera {camera}: {} in {}{}.\n# Omitted relative to the exact form: {left_out}.\n",
        target.name,
        error_text(&point.error),
        time_text(point.seconds.value),
        if *is_reached { "" } else { "; the target is not reached" },
    );
    let changes = changes(job, camera);
    if !changes.is_empty() {
        text += &format!("# The study had changes that this file does not contain: {}.\n", changes.join(", "));
    }
    text += &format!("format = 1\nbase = {:?}\n", path_from(folder, &job.job)?.to_string_lossy());
    if !removed.is_empty() {
        text += &format!("remove = [{}]\n", removed.join(", "));
    }
    text += &format!("\n[[cameras]]\nname = {camera:?}\n\n[cameras.render]\n{}\n", render.join("\n"));
    Ok(text)
}

/// Changes of the command line that a job file does not contain.
fn changes(job: &JobRequest, camera: &str) -> Vec<String> {
    let keys = studied_keys();
    let set = job.set.iter().filter(|change| !is_of(change, camera, &keys)).map(|change| format!("set {change}"));
    let quality = job.quality.map(|quality| format!("quality {}", quality.word()));
    set.chain(quality).chain(job.seed.map(|seed| format!("seed {seed}"))).collect()
}

/// Path of a file relative to a folder.
fn path_from(folder: &Path, file: &Path) -> Result<PathBuf, Error> {
    let absolute =
        |path: &Path| std::path::absolute(path).map_err(|error| Error::Run(format!("{}: {error}", path.display())));
    Ok(relative_path(&normalised(&absolute(folder)?), &normalised(&absolute(file)?)))
}

/// Path without "." and "a/..".
fn normalised(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                out.pop();
            }
            other => out.push(other),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_base_is_named_relative_to_the_file() {
        let from = |folder: &str, file: &str| path_from(Path::new(folder), Path::new(file)).expect("a path");
        assert_eq!(from("/a/out/study", "/a/scenes/job.toml"), Path::new("../../scenes/job.toml"));
        assert_eq!(from("/a", "/a/b/../job.toml"), Path::new("job.toml"));
        assert_eq!(from("/x/y", "/job.toml"), Path::new("../../job.toml"));
    }
}
