//! Equal description, seed and version give equal bytes, for any division of the work.

use crate::support::{assert_same, contents, etendue, rendered, rendered_with, small, text};
use std::collections::BTreeMap;
use std::path::Path;

const PUPIL: [&str; 4] = ["--set", "render.route=pupil", "--set", "render.overscan=0.1"];

/// All files that the job requests.
const FILES: [&str; 8] = [
    "front/camera.json",
    "front/depth.png",
    "front/electrons.exr",
    "front/ground_truth.exr",
    "front/irradiance.exr",
    "front/picture.0000.png",
    "front/radiance.exr",
    "front/raw.0000.png",
];

fn with<'a>(route: &[&'a str], further: &[&'a str]) -> Vec<&'a str> {
    [route, further].concat()
}

fn assert_same_in_parts(route: &[&str]) {
    let expected = rendered(&small(), &with(route, &["--threads", "1"]));
    assert_eq!(expected.keys().map(String::as_str).collect::<Vec<_>>(), FILES);
    for options in [
        ["--threads", "2"],
        ["--threads", "7"],
        ["--set", "render.tile_px=8"],
        ["--set", "render.tile_px=32"],
        ["--set", "render.tile_px=64"],
    ] {
        assert_same(&expected, &rendered(&small(), &with(route, &options)), &options.join(" "));
    }
    for simd in ["scalar", "auto"] {
        assert_same(&expected, &rendered_with(&small(), route, &[("ETENDUE_SIMD", simd)]), simd);
    }
    assert_same(&expected, &merged(route, 3), "three shards");
    assert_same(&expected, &merged(&with(route, &["--set", "render.tile_px=8"]), 2), "two shards of small tiles");
}

/// Renders in shards and joins them, in the wrong order.
fn merged(options: &[&str], count: u32) -> BTreeMap<String, Vec<u8>> {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = |name: &str| text(&place.path().join(name));
    let mut arguments = vec!["merge".to_owned(), "-o".to_owned(), folder("whole")];
    for index in (0..count).rev() {
        let (shard, part) = (format!("{index}/{count}"), folder(&index.to_string()));
        etendue(with(&["render", &small(), "-o", &part, "--shard", &shard], options)).ok();
        arguments.push(part);
    }
    etendue(arguments).ok();
    contents(Path::new(&folder("whole")))
}

#[test]
fn threads_tiles_shards_and_instruction_sets_do_not_change_a_byte() {
    assert_same_in_parts(&[]);
}

#[test]
fn nor_by_the_route_over_the_pupil() {
    assert_same_in_parts(&PUPIL);
}

#[test]
fn nor_where_paths_share_their_tails() {
    assert_same_in_parts(&["--set", "render.path_reuse_px=4"]);
}

#[test]
fn nor_where_paths_branch() {
    assert_same_in_parts(&["--set", "render.branches=3"]);
    let branched = rendered(&small(), &["--set", "render.branches=3"]);
    assert_ne!(
        branched["front/radiance.exr"],
        rendered(&small(), &[])["front/radiance.exr"],
        "branches find other light"
    );
}

#[test]
fn nor_where_paths_before_the_picture_guide_its_own() {
    assert_same_in_parts(&["--set", "render.guiding=true"]);
    let guided = rendered(&small(), &["--set", "render.guiding=true"]);
    assert_ne!(guided["front/radiance.exr"], rendered(&small(), &[])["front/radiance.exr"], "the guide leads paths");
}

#[test]
fn frames_share_the_light_and_have_noise_of_their_own() {
    let both = rendered(&small(), &["--frames", "0..2"]);
    assert_ne!(both["front/raw.0000.png"], both["front/raw.0001.png"]);
    let alone = rendered(&small(), &["--frames", "1..2"]);
    assert!(!alone.contains_key("front/raw.0000.png"));
    for name in ["front/raw.0001.png", "front/picture.0001.png", "front/electrons.exr", "front/radiance.exr"] {
        assert!(both[name] == alone[name], "{name}");
    }
    let first = rendered(&small(), &[]);
    for name in ["front/raw.0000.png", "front/electrons.exr"] {
        assert!(both[name] == first[name], "{name}");
    }
}

#[test]
fn another_seed_gives_other_light_and_other_noise() {
    let (a, b) = (rendered(&small(), &[]), rendered(&small(), &["--seed", "12"]));
    for name in ["front/raw.0000.png", "front/electrons.exr", "front/irradiance.exr"] {
        assert!(a[name] != b[name], "{name}");
    }
    assert_eq!(a["front/depth.png"], b["front/depth.png"], "geometry has no chance in it");
}

#[test]
fn noise_can_be_switched_off_whole() {
    let quiet = ["--set", "cameras.front.sensor.noise=false", "--frames", "0..2"];
    let files = rendered(&small(), &quiet);
    assert_eq!(files["front/raw.0000.png"], files["front/raw.0001.png"]);
}

#[test]
fn another_camera_of_the_job_changes_nothing_of_the_first() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let job = place.path().join("two.toml");
    let folder = crate::support::tests().join("jobs/small");
    let one = std::fs::read_to_string(folder.join("small.toml"))
        .expect("the job")
        .replace("file = \"", &format!("file = \"{}/", text(&folder)));
    let second = "\n[[cameras]]\nname = \"second\"\nposition_m = [0, 1, 2]\nlook_at_m = [6, 0, 0]\n\
                  lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 8 }\n\
                  sensor = { width_px = 20, height_px = 12, pixel_pitch_um = 200 }\n\
                  output = { electrons = false, raw = false, picture = false }\n";
    std::fs::write(&job, format!("{one}{second}")).expect("written");
    let both = rendered(&text(&job), &[]);
    assert!(both.contains_key("second/radiance.exr") && !both.contains_key("second/raw.0000.png"));
    let narrowed = rendered(&text(&job), &["--camera", "second"]);
    assert_eq!(narrowed.keys().filter(|name| !name.starts_with("second/")).count(), 0);
    assert!(narrowed.iter().all(|(name, bytes)| both[name] == *bytes), "a camera alone is the camera among others");
    let first = rendered(&text(&job), &["--camera", "front"]);
    assert_eq!(first["front/raw.0000.png"], both["front/raw.0000.png"]);
}

#[test]
fn exposing_stored_radiance_is_rendering_by_the_pupil() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (scene, exposed_folder) = (place.path().join("scene"), place.path().join("taken"));
    let job = small();
    etendue(with(&["render", &job, "-o", &text(&scene), "--frames", "0..2"], &PUPIL)).ok();
    let camera = place.path().join("front.toml");
    std::fs::write(&camera, camera_of(&job)).expect("written");
    let radiance = text(&scene.join("front/radiance.exr"));
    let options = ["--camera", &text(&camera), "--frames", "0..2"];
    etendue(["expose", &radiance, "-o", &text(&exposed_folder)].into_iter().chain(options)).ok();
    let (rendered, exposed) = (contents(&scene), contents(&exposed_folder));
    for name in ["raw.0000.png", "raw.0001.png", "picture.0000.png", "picture.0001.png"] {
        let name = format!("front/{name}");
        assert!(rendered[&name] == exposed[&name], "{name} has other bytes");
    }
}

/// The job's camera as a camera file.
fn camera_of(job: &str) -> String {
    let text = std::fs::read_to_string(job).expect("the job");
    let start = text.find("[cameras.lens]").expect("the camera's tables");
    let end = text.find("[render]").expect("the camera's end");
    format!("format = 1\n{}", &text[start..end].replace("[cameras.", "["))
}

#[test]
fn a_reader_of_the_results_finds_their_names_on_stdout() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let output = place.path().join("out");
    let run = etendue(["render", &small(), "-o", &text(&output)]).ok();
    let mut names: Vec<&str> = run.out.lines().collect();
    names.sort_unstable();
    let expected: Vec<String> = FILES.iter().map(|name| text(&output.join(name))).collect();
    assert_eq!(names, expected);
    // No progress bar without a terminal: only the levels of the frames.
    let levels: Vec<&str> = run.err.lines().collect();
    assert!(matches!(levels[..], [front] if front.starts_with("note: camera front: mean level")), "{}", run.err);
}
