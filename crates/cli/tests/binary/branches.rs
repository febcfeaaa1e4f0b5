//! Branched paths: messages, and settings that they exclude. `bytes.rs` shows that no division of the work changes their bytes.

use crate::support::{BALL, etendue, text};
use std::path::Path;

fn job(folder: &Path, render: &str) -> String {
    let path = folder.join("job.toml");
    let written = format!("{BALL}\n[render]\nspp = 8\nreplicates = 4\nmax_bounces = 4\nseed = 5\n{render}");
    std::fs::write(&path, written).expect("written");
    text(&path)
}

#[test]
fn the_plan_reports_branches_and_refuses_what_they_exclude() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let plan = etendue(["plan", &job(place.path(), "branches = 4\n")]).ok().out;
    assert!(plan.contains("4 lights are sampled and 4 paths continue at each sample's first surface"), "{plan}");
    let assert_refused = |render: &str, phrases: &[&str]| {
        etendue(["plan", &job(place.path(), render)]).refused(phrases);
    };
    let exclude = "\"path_reuse_px\" and \"branches\" = 4 exclude each other";
    let both = job(place.path(), "branches = 4\npath_reuse_px = 2\n");
    etendue(["plan", &both]).refused(&["job.toml", exclude, "give one of the two"]);
    assert_refused("branches = 0\n", &["job.toml", "branches: found 0"]);
    assert_refused("branches = 65\n", &["job.toml", "branches: found 65"]);
    let direct = ["job.toml", "\"branches\" has no effect here, it belongs to integrator = \"path\""];
    assert_refused("branches = 4\nintegrator = \"direct\"\n", &direct[1..]);
    // The command line overrides a file.
    let branched = job(place.path(), "branches = 4\n");
    let output = etendue(["plan", &branched, "--set", "render.path_reuse_px=2"]).ok();
    assert!(output.err.contains("overrides") && output.err.contains("branches"), "{}", output.err);
    assert!(
        output.out.contains("blocks of 4 pixels share path tails") && !output.out.contains("lights are sampled"),
        "{}",
        output.out
    );
    let sharing = job(place.path(), "path_reuse_px = 2\n");
    let output = etendue(["plan", &sharing, "--set", "render.branches=4"]).ok();
    assert!(output.err.contains("overrides") && output.err.contains("path_reuse_px"), "{}", output.err);
    assert!(!output.out.contains("share path tails") && output.out.contains("4 lights are sampled"), "{}", output.out);
    etendue(["plan", &job(place.path(), "branches = 1\npath_reuse_px = 2\n")]).ok();
    etendue(["plan", &job(place.path(), "branches = 4\npath_reuse_px = 1\n")]).ok();
}
