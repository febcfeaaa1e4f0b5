//! Triangles that cannot be lit are dropped and counted, and the plan says so.

use crate::support::{etendue, text};
use std::fs;

const JOB: &str = "format = 1\n[scene]\nmeshes = [{ name = \"m\", file = \"m.obj\", up_axis = \"z\" }]\n\
    materials = [{ name = \"grey\", type = \"diffuse\", reflectance = 0.5 }]\n\
    objects = [{ name = \"o\", mesh = \"m\", material = \"grey\" }]\n\
    environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }\n\
    [[cameras]]\nname = \"front\"\nposition_m = [-3, 0, 0]\nlook_at_m = [0, 0, 0]\n\
    lens = { model = \"pinhole\", focal_length_mm = 6, f_number = 8 }\n\
    sensor = { width_px = 8, height_px = 8, pixel_pitch_um = 100 }\n[render]\nspp = 1\nreplicates = 1\n";

/// Two good triangles, two without area (a repeated corner, three corners on a line), one given three times.
const OBJ: &str = "v 0 0 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nv 0 2 0\n\
    f 1 2 3\nf 2 4 3\nf 1 1 2\nf 1 2 5\nf 2 3 1\nf 1 2 3\n";

#[test]
fn triangles_without_area_and_duplicates_are_counted_in_the_plan() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let job = place.path().join("job.toml");
    fs::write(&job, JOB).expect("written");
    fs::write(place.path().join("m.obj"), OBJ).expect("written");
    let plan = etendue(["plan", &text(&job)]).ok().out;
    assert!(plan.contains("1 instance, 2 triangles (2 stored)"), "{plan}");
    let told = |words: &[&str]| plan.lines().any(|line| words.iter().all(|word| line.contains(word)));
    assert!(told(&["2 ", "area", "dropped"]), "{plan}");
    assert!(told(&["2 ", "duplicate", "dropped"]), "{plan}");
}

#[test]
fn a_mesh_of_nothing_but_such_triangles_is_an_empty_one() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let job = place.path().join("job.toml");
    fs::write(&job, JOB).expect("written");
    fs::write(place.path().join("m.obj"), "v 0 0 0\nv 0 1 0\nv 0 2 0\nf 1 2 3\n").expect("written");
    let plan = etendue(["plan", &text(&job)]).ok().out;
    assert!(plan.contains("0 triangles (0 stored)") && plan.contains("m.obj: 1 triangles of no area"), "{plan}");
}
