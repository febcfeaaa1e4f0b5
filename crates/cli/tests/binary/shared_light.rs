//! Cameras of a job with the same light: rendered once, each with the result that it has alone.

use crate::support::{BALL, assert_same, contents, etendue, rendered, text};
use etendue_io::exr::{ExrSamples, read_exr};
use std::collections::BTreeMap;
use std::path::Path;

/// Sampling of the light of all cameras.
const RENDER: &str = r#"
[render]
spp = 8
replicates = 2
integrator = "direct"
seed = 5
band_width_nm = 50
[output]
electrons = true
variance = true
"#;

/// Returns the scene of [`BALL`], and its camera.
fn parts() -> (&'static str, &'static str) {
    BALL.split_at(BALL.find("[[cameras]]").expect("a camera"))
}

/// A camera of the job: its name, replacements of `KEY = VALUE`, and further tables.
fn camera(name: &str, changes: &[(&str, &str)], further: &str) -> String {
    let own = parts().1.replace("\"front\"", &format!("\"{name}\"")).replace("exposure_s = 2e-6", "exposure_s = 1e-5");
    let mut text = format!("{own}[cameras.isp]\nwhite_balance = \"D65\"\n{further}");
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    text
}

/// Writes the job of all cameras into a folder.
fn job(folder: &Path) -> String {
    let cameras = [
        camera("first", &[], ""),
        camera("twin", &[], ""),
        camera("long", &[("1e-5", "2e-5")], ""),
        camera("other-look", &[("\"D65\"", "\"grey_world\"")], "tone_curve = \"linear\"\n"),
        camera("half", &[("peak = 0.5", "peak = 0.25")], ""),
        camera("spectral", &[], "[cameras.output]\nradiance = true\n"),
        camera("wide", &[("focal_length_mm = 6", "focal_length_mm = 5")], ""),
        camera("longer", &[("1e-5", "3e-5")], "[cameras.output]\nground_truth = false\n"),
    ];
    let path = folder.join("job.toml");
    std::fs::write(&path, format!("{}{}{RENDER}", parts().0, cameras.concat())).expect("written");
    text(&path)
}

fn all() -> (tempfile::TempDir, String) {
    let place = tempfile::tempdir().expect("a temporary folder");
    let job = job(place.path());
    (place, job)
}

/// Returns the part of the plan about a camera.
fn block<'a>(plan: &'a str, name: &str) -> &'a str {
    let start = plan.find(&format!("camera {name}\n")).expect("the camera");
    let rest = &plan[start..];
    &rest[..rest.find("\n\n").unwrap_or(rest.len())]
}

#[test]
fn the_plan_says_whose_light_a_camera_sees_and_why_not() {
    let (_place, job) = all();
    let plan = etendue(["plan", &job]).ok().out;
    assert!(block(&plan, "first").contains("shared with twin, long, other-look and longer"), "{plan}");
    for name in ["twin", "long", "other-look", "longer"] {
        let camera_block = block(&plan, name);
        assert!(camera_block.contains("light          that of camera first"), "{camera_block}");
        assert!(
            camera_block.contains("cost           no separate paths: shares those of camera first"),
            "{camera_block}"
        );
    }
    let apart = |name: &str, why: &str| {
        let camera_block = block(&plan, name);
        assert!(
            camera_block.contains("separate: camera")
                && camera_block.contains(why)
                && camera_block.contains("million paths"),
            "{camera_block}"
        );
    };
    apart("half", "differs in the spectral response of the pixels");
    apart("spectral", "differs in the stored spectrum");
    assert!(!block(&plan, "wide").contains("light      "), "another lens is another light, which nobody wonders at");
    let alone = etendue(["plan", &job, "--camera", "long"]).ok().out;
    let camera_block = block(&alone, "long");
    assert!(
        camera_block.contains("equal to that of camera first of the job") && camera_block.contains("million paths"),
        "{camera_block}"
    );
}

#[test]
fn a_camera_alone_is_the_camera_among_those_of_equal_light() {
    let (_place, job) = all();
    let together = rendered(&job, &[]);
    for name in ["first", "twin", "long", "other-look", "half", "spectral", "longer"] {
        let alone = rendered(&job, &["--camera", name]);
        let same: BTreeMap<_, _> = together
            .iter()
            .filter(|(file, _)| file.starts_with(&format!("{name}/")))
            .map(|(k, v)| (k.clone(), v.clone()))
            .collect();
        assert_same(&same, &alone, name);
    }
    assert_same(&together, &merged(&job, &[], 3), "three shards");
    let pupil = ["--set", "render.route=pupil"];
    assert_same(&rendered(&job, &pupil), &merged(&job, &pupil, 2), "two shards at the pupil");
}

/// Renders in shards and joins them; each film is stored once.
fn merged(job: &str, options: &[&str], count: u32) -> BTreeMap<String, Vec<u8>> {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = |name: &str| text(&place.path().join(name));
    let mut arguments = vec!["merge".to_owned(), "-o".to_owned(), folder("whole")];
    for index in 0..count {
        let (shard, part) = (format!("{index}/{count}"), folder(&index.to_string()));
        etendue(["render", job, "-o", &part, "--shard", &shard].iter().chain(options)).ok();
        assert!(!Path::new(&part).join("twin.film.exr").exists() && Path::new(&part).join("first.film.exr").exists());
        arguments.push(part);
    }
    etendue(arguments).ok();
    contents(Path::new(&folder("whole")))
}

#[test]
fn shared_light_has_one_error_and_each_sensor_its_own_noise() {
    let (place, job) = all();
    let output = text(&place.path().join("out"));
    etendue(["render", &job, "-o", &output]).ok();
    let files = contents(Path::new(&output));
    let mean = |name: &str| {
        let file = read_exr(Path::new(&format!("{output}/{name}/electrons.exr"))).expect("electrons");
        ["electrons", "variance.electrons"].map(|channel| {
            let Some(ExrSamples::Float(values)) = file.channel(channel) else { panic!("{channel}") };
            values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64
        })
    };
    let ([e, v], [e2, v2]) = (mean("first"), mean("long"));
    assert!(e > 100.0 && (e2 / e - 2.0).abs() < 1e-6 && (v2 / v - 4.0).abs() < 1e-6, "{e} {e2} {v} {v2}");
    assert_eq!(mean("twin"), [e, v], "the same light, errors included");
    assert_ne!(files["first/raw.0000.png"], files["twin/raw.0000.png"], "noise is each sensor's own");
    let sidecar = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&files[&format!("{name}/camera.json")]).expect("JSON")
    };
    assert_eq!(sidecar("long")["light"]["camera"], "first");
    assert_eq!(sidecar("half")["light"]["camera"], "half");
}

#[test]
fn one_stored_radiance_serves_the_cameras_of_equal_views() {
    let (_place, job) = all();
    let plan = etendue(["plan", &job, "--set", "render.route=pupil"]).ok().out;
    for name in ["twin", "long", "other-look", "half", "spectral", "longer"] {
        assert!(block(&plan, name).contains("that of camera first"), "{}", block(&plan, name));
    }
}
