//! Causes of an unexpected image: the plan states them, and `render` repeats them.

use crate::support::{etendue, text};
use std::fs;

const JOB: &str = "format = 1\n[scene]\nmeshes = [{ name = \"m\", file = \"m.obj\", up_axis = \"z\" }]\n\
    materials = [{ name = \"grey\", type = \"diffuse\", reflectance = 0.5 }]\n\
    objects = [{ name = \"o\", mesh = \"m\", material = \"grey\" }]\n\
    environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }\n\
    [[cameras]]\nname = \"front\"\nposition_m = [-3, 0, 0]\nlook_at_m = [0, 0, 0]\n\
    lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 8 }\n\
    sensor = { width_px = 8, height_px = 8, pixel_pitch_um = 100 }\n[render]\nspp = 1\nreplicates = 1\n";

/// Two valid triangles, two without area (a repeated corner, three corners on a line), one given three times.
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
    let has_line = |words: &[&str]| plan.lines().any(|line| words.iter().all(|word| line.contains(word)));
    assert!(has_line(&["2 triangles of zero area", "removed"]), "{plan}");
    assert!(has_line(&["2 duplicates", "removed"]), "{plan}");
}

#[test]
fn a_mesh_of_nothing_but_such_triangles_is_an_empty_one() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let job = place.path().join("job.toml");
    fs::write(&job, JOB).expect("written");
    fs::write(place.path().join("m.obj"), "v 0 0 0\nv 0 1 0\nv 0 2 0\nf 1 2 3\n").expect("written");
    let plan = etendue(["plan", &text(&job)]).ok().out;
    assert!(plan.contains("0 triangles (0 stored)") && plan.contains("m.obj: 1 triangles of zero area"), "{plan}");
}

/// Renders a job of a folder with these files; returns its output.
fn rendered(files: &[(&str, &str)]) -> crate::support::CommandOutput {
    let place = tempfile::tempdir().expect("a temporary folder");
    files.iter().for_each(|(name, text)| fs::write(place.path().join(name), text).expect("written"));
    let output = text(&place.path().join("out"));
    etendue(["render", &text(&place.path().join("job.toml")), "-o", &output])
}

#[test]
fn a_rendering_repeats_what_was_dropped() {
    let output = rendered(&[("job.toml", JOB), ("m.obj", OBJ)]).ok();
    output.says(&["warning: ", "m.obj: 2 triangles of zero area and 2 duplicates are removed"]);
}

#[test]
fn a_rendering_says_that_nothing_gives_light() {
    let dark = JOB.replace("radiance_w_m2_sr_nm = 1", "radiance_w_m2_sr_nm = 0");
    let output = rendered(&[("job.toml", &dark), ("m.obj", OBJ)]).ok();
    output.says(&["warning: camera front: there is no light"]);
}

const QUAD: &str = "v 0 -1 -1\nv 0 1 -1\nv 0 1 1\nv 0 -1 1\n";

#[test]
fn a_missing_material_library_is_a_warning_and_grey_where_the_scene_says_nothing() {
    let mesh = format!("mtllib lost.mtl\n{QUAD}usemtl red\nf 3 2 1\nusemtl blue\nf 4 3 1\n");
    let named = rendered(&[("job.toml", JOB), ("m.obj", &mesh)]).ok();
    assert_eq!(named.err, "", "an object that names its material needs no library");
    let job = JOB.replace("mesh = \"m\", material = \"grey\"", "mesh = \"m\"");
    let output = rendered(&[("job.toml", &job), ("m.obj", &mesh)]).ok();
    let warnings: Vec<&str> = output.err.lines().collect();
    assert_eq!(warnings.len(), 1, "{}", output.err);
    output.says(&[
        "warning: ",
        "\"red\"",
        "\"blue\"",
        "line 1: the material library",
        "lost.mtl` does not exist",
        "grey",
    ]);
    let no_library = mesh.replace("mtllib lost.mtl\n", "");
    let refused = rendered(&[("job.toml", &job), ("m.obj", &no_library)]);
    assert_eq!(refused.status, 2, "a file that names no library leaves the scene to say it: {}", refused.err);
}

#[test]
fn a_note_on_many_objects_is_reported_once() {
    let materials =
        "materials = [{ name = \"a\", preset = \"sign_ra1_white\" }, { name = \"b\", preset = \"sign_ra2_white\" }]";
    let job = JOB
        .replace("materials = [{ name = \"grey\", type = \"diffuse\", reflectance = 0.5 }]", materials)
        .replace("material = \"grey\" }", "material = \"a\" }, { name = \"p\", mesh = \"m\", material = \"b\" }");
    let place = tempfile::tempdir().expect("a temporary folder");
    fs::write(place.path().join("job.toml"), job).expect("written");
    fs::write(place.path().join("m.obj"), OBJ).expect("written");
    let plan = etendue(["plan", &text(&place.path().join("job.toml"))]).ok().out;
    let lines: Vec<&str> = plan.lines().filter(|line| line.contains("R_A is constant")).collect();
    assert_eq!(lines.len(), 1, "{plan}");
    assert!(lines[0].contains("materials.a, ") && lines[0].contains("materials.b: "), "{plan}");
}
