//! Tests the keys that a plan names for disabling an effect: each is tried on the supplied jobs.

use etendue_io::{Sandbox, TextureMemory, complete_assets};
use etendue_pipeline::report::effects::PlannedEffect;
use etendue_pipeline::{Choices, Plan, compile};
use etendue_scene::asset::Assets;
use etendue_scene::{Description, Overrides};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Jobs that equal others except for time of day or weather.
const DUPLICATE_JOBS: [&str; 9] =
    ["sunset", "wet-night", "light-rain", "snow", "puddles", "night-fog", "spray", "streaks", "pupil"];

/// Jobs of the repository, one of each kind.
fn jobs() -> Vec<PathBuf> {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let within = |folder: PathBuf| std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("readable").path());
    let is_job = |file: &PathBuf| {
        file.extension().is_some_and(|e| e == "toml")
            && std::fs::read_to_string(file).is_ok_and(|text| text.contains("[[cameras]]"))
    };
    let is_other = |file: &PathBuf| file.file_stem().is_none_or(|name| DUPLICATE_JOBS.iter().all(|like| name != *like));
    let files = within(scenes).filter(|p| p.is_dir()).flat_map(within);
    let mut jobs: Vec<PathBuf> = files.filter(is_job).filter(is_other).collect();
    jobs.sort();
    jobs
}

/// Plan of a job under changes; the assets that it needs are added to the known ones.
fn plan(job: &Path, set: &[String], assets: &mut Assets) -> Result<Plan, String> {
    let joined = |errors: Vec<String>| errors.join("\n");
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string().into());
    let description = Description::load(job, &read, &Overrides::new(set))
        .map_err(|description_errors| description_errors.to_string())?;
    let complete =
        complete_assets(std::mem::take(assets), &description.assets(), &TextureMemory::default(), &Sandbox::NONE);
    *assets = complete.map_err(|errors| joined(errors.iter().map(ToString::to_string).collect()))?;
    compile(&description, assets, &Choices::default())
        .map_err(|description_errors| joined(description_errors.iter().map(ToString::to_string).collect()))
}

/// Status of an effect in the plan of a job after disabling it.
fn status(plan: &Plan, camera: usize, name: &str) -> PlannedEffect {
    let effects = plan.effects(&plan.cameras[camera]);
    effects.into_iter().find(|effect| effect.name == name).expect("every plan lists all effects")
}

/// Trial: a camera of a job and an effect of it with the changes that disable it.
struct EffectTrial<'j> {
    job: &'j Path,
    camera: usize,
    name: &'static str,
    set: Vec<String>,
    /// Stored triangles: the cost of a trial.
    weight: usize,
}

impl EffectTrial<'_> {
    /// Kind of the trial: the effect, and the keys without cameras and values.
    fn kind(&self) -> (&'static str, Vec<String>) {
        let key = |set: &String| {
            let key = set.split_once('=').map_or(set.as_str(), |(key, _)| key);
            let parts: Vec<&str> = key.split('.').collect();
            parts[if parts[0] == "cameras" { 2 } else { 0 }..].join(".")
        };
        (self.name, self.set.iter().map(key).collect())
    }

    /// Reason of a failure; `None` if the effect is skipped.
    fn failure(&self) -> Option<String> {
        let message = |why: &str| format!("{}: {} by {:?}: {why}", self.job.display(), self.name, self.set);
        match plan(self.job, &self.set, &mut Assets::default()) {
            Err(error) => Some(message(&error)),
            Ok(plan) if status(&plan, self.camera, self.name).status.is_modelled() => {
                Some(message("it is still there"))
            }
            Ok(_) => None,
        }
    }
}

fn trials(job: &Path) -> Vec<EffectTrial<'_>> {
    let full_plan = plan(job, &[], &mut Assets::default()).unwrap_or_else(|error| panic!("{}: {error}", job.display()));
    let weight = full_plan.world.meshes().iter().map(|mesh| mesh.triangles().len()).sum();
    let of = |(camera, setup)| {
        let effects = full_plan.effects(setup).into_iter();
        effects.filter_map(move |PlannedEffect { name, omission: if_dropped, .. }| {
            Some(EffectTrial { job, camera, name, set: if_dropped?.set?, weight })
        })
    };
    full_plan.cameras.iter().enumerate().flat_map(of).collect()
}

/// Each kind of change once, in the cheapest job.
#[test]
fn an_effect_that_is_dropped_by_its_keys_is_skipped() {
    let jobs = jobs();
    assert!(jobs.len() > 20, "{}", jobs.len());
    let mut all: Vec<EffectTrial<'_>> = jobs.par_iter().flat_map_iter(|job| trials(job)).collect();
    all.sort_by_key(|trial| trial.weight);
    let mut kinds = BTreeMap::new();
    all.into_iter().for_each(|trial| {
        kinds.entry(trial.kind()).or_insert(trial);
    });
    assert!(kinds.len() > 50, "{}", kinds.len());
    let failed: Vec<String> = kinds.into_values().par_bridge().filter_map(|trial| trial.failure()).collect();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
