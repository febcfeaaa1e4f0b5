//! The plan of every shipped job, word for word.

use crate::support::{bless, etendue, is_complete_run, root, tests, text};
use std::path::PathBuf;

/// Every job below `scenes/`, `scenes/FOLDER/NAME.toml`, and its name.
fn jobs() -> Vec<(String, String)> {
    let within = |folder: PathBuf| std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("readable").path());
    let files = within(root().join("scenes")).filter(|p| p.is_dir()).flat_map(within);
    let is_job = |file: &PathBuf| {
        file.extension().is_some_and(|e| e == "toml")
            && std::fs::read_to_string(file)
                .is_ok_and(|text| ["[[cameras]]", "[render]"].iter().any(|table| text.contains(table)))
    };
    let named = |file: PathBuf| {
        let name = file.file_stem().expect("a name").to_str().expect("UTF-8").to_owned();
        (text(file.strip_prefix(root()).expect("below the repository")), name)
    };
    let mut jobs: Vec<(String, String)> = files.filter(is_job).map(named).collect();
    jobs.sort();
    jobs
}

fn check(job: &str, name: &str) -> Result<(), String> {
    let plan = etendue(["plan", job]).ok().out;
    let file: PathBuf = tests().join(format!("snapshots/{name}.txt"));
    if bless() {
        std::fs::write(&file, &plan).expect("the snapshot can be written");
        return Ok(());
    }
    let expected = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", text(&file)))?;
    let lines = expected.lines().zip(plan.lines()).enumerate().find(|(_, (a, b))| a != b);
    match lines {
        None if expected == plan => Ok(()),
        None => Err(format!("{job}: the plan has another number of lines than {}", text(&file))),
        Some((i, (a, b))) => Err(format!("{job}: line {} of the plan was\n  {a}\nand is\n  {b}", i + 1)),
    }
}

#[test]
fn the_plans_of_all_jobs_are_as_they_were() {
    let jobs = jobs();
    for expected in
        ["cornell", "front", "furnace", "lenses", "night", "signs", "sphere-on-plane", "street", "sunset", "wet-night"]
    {
        assert!(jobs.iter().any(|(_, name)| name == expected), "the job {expected} is missing");
    }
    let changed: Vec<String> = jobs.iter().filter_map(|(job, name)| check(job, name).err()).collect();
    assert!(changed.is_empty(), "{}\n(ETENDUE_BLESS=1 accepts)", changed.join("\n"));
}

/// Keys overridden by the command line are reported, one line for each of its words.
#[test]
fn every_job_takes_any_integrator_and_any_samples() {
    for (place, (job, _)) in jobs().into_iter().enumerate() {
        // Each integrator with a third of the jobs; with all of them in `just whole`.
        let settings = [("flat", "2"), ("direct", "3"), ("path", "1")];
        let chosen = if is_complete_run() { &settings[..] } else { &settings[place % 3..][..1] };
        for (integrator, spp) in chosen {
            let output = etendue(["plan", &job, "--integrator", integrator, "--spp", spp]).ok();
            let notes = output.err.lines().filter(|line| line.starts_with("note: ")).count();
            let of_flags = output.err.lines().filter(|line| line.starts_with("note: --")).count();
            assert!(notes == of_flags && notes <= 3, "{job}: {}", output.err);
        }
    }
    let street = etendue(["plan", "scenes/street/street.toml", "--set", "render.integrator=direct", "--spp", "2"]).ok();
    let street = street.says(&["note: --set render.integrator=direct overrides", "\"max_bounces\"", "\"caustics\""]);
    street.says(&["note: --spp 2 supersedes \"replicates\" (scenes/street/street.toml:"]);
}

#[test]
fn a_plan_does_not_depend_on_where_it_is_made() {
    let job = "scenes/furnace/furnace.toml";
    let here = etendue(["plan", job]).ok().out;
    let there = etendue(["plan", &text(&root().join(job))]).ok().out;
    assert_eq!(here, there);
}

#[test]
fn a_changed_texel_is_another_plan() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = tests().join("jobs/small");
    for file in ["small.toml", "tower.obj", "tower.mtl", "checker.png", "sky.hdr"] {
        std::fs::copy(folder.join(file), place.path().join(file)).expect("copied");
    }
    let job = text(&place.path().join("small.toml"));
    let head = |plan: String| plan.lines().next().expect("a first line").to_owned();
    let before = head(etendue(["plan", &job]).ok().out);
    assert_eq!(before, head(etendue(["plan", &crate::support::small()]).ok().out), "a copy is the same job");
    let sky = place.path().join("sky.hdr");
    let mut bytes = std::fs::read(&sky).expect("the sky");
    let last = bytes.len() - 2;
    bytes[last] ^= 1;
    std::fs::write(&sky, bytes).expect("written");
    assert_ne!(before, head(etendue(["plan", &job]).ok().out));
}
