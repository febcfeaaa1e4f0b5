//! Adaptive sampling: from the command line and the job, with its messages and stored data.

use crate::support::{BALL, assert_same, contents, etendue, rendered, text};
use etendue_io::exr::{ExrFile, ExrSamples, read_exr};
use std::path::Path;

/// A wall next to the ball that glows.
const WALL: &str = r#"
[[scene.materials]]
name = "light"
type = "emitter"
emission = { luminance_cd_m2 = 3000, illuminant = "A" }
[[scene.objects]]
name = "wall"
shape = { type = "quad", size_m = [1, 1] }
position_m = [6, 3, 1]
rotation_deg = [0, 90, 0]
material = "light"
[render]
max_bounces = 4
seed = 5
[output]
sampling = true
ground_truth = false
"#;

fn job(folder: &Path, render: &str) -> String {
    let path = folder.join("job.toml");
    std::fs::write(&path, format!("{BALL}{}", WALL.replace("[render]\n", &format!("[render]\n{render}"))))
        .expect("written");
    text(&path)
}

fn place() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn floats(file: &ExrFile, name: &str) -> Vec<f64> {
    match file.channel(name) {
        Some(ExrSamples::Float(values)) => values.iter().map(|v| f64::from(*v)).collect(),
        other => panic!("{name}: {other:?}"),
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn the_limit_is_reached_and_reported() {
    let place = place();
    let job = job(place.path(), "spp = 64\n");
    let output = text(&place.path().join("out"));
    let run = etendue(["render", &job, "-o", &output, "--noise", "0.2"]).ok();
    assert!(run.err.contains("--noise 0.2 overrides") && run.err.contains("spp"), "{}", run.err);
    assert!(run.err.contains("samples per pixel (") && run.err.contains("of the sensor's noise"), "{}", run.err);
    assert!(!run.err.contains("still noisier"), "{}", run.err);
    let file = read_exr(&Path::new(&output).join("front/sampling.exr")).expect("layers");
    let (light, sensor) = (floats(&file, "monte_carlo_variance"), floats(&file, "sensor_variance"));
    let Some(ExrSamples::Uint(samples)) = file.channel("samples") else { panic!("samples") };
    let (least, max) = (samples.iter().min(), samples.iter().max());
    assert!(least >= Some(&16) && least < Some(&64) && max > Some(&640), "{least:?} {max:?}");
    let ratio: Vec<f64> = light.iter().zip(&sensor).map(|(a, b)| a / b).collect();
    // The limit is 0.04; stratified samples do better, and no pixel receives fewer than 16.
    assert!((0.003..0.044).contains(&mean(&ratio)), "{}", mean(&ratio));
    // 4 e⁻ of read noise, 12 bits of 20 e⁻, and the photons' own.
    assert!(sensor.iter().all(|v| *v > 16.0 + 33.0), "{:?}", sensor.iter().copied().fold(f64::MAX, f64::min));
}

#[test]
fn pixels_beyond_the_limit_are_reported() {
    let place = place();
    let job = job(place.path(), "noise_threshold = 0.01\nmax_spp = 32\n");
    let output = text(&place.path().join("out"));
    let run = etendue(["render", &job, "-o", &output]).ok();
    assert!(
        run.err.contains("% of the pixels are still noisier than 0.01 of the sensor's noise with at most 32 samples"),
        "{}",
        run.err
    );
}

#[test]
fn shards_and_threads_do_not_change_what_noise_decides() {
    let place = place();
    let job = job(place.path(), "noise_threshold = 0.3\npath_reuse_px = 2\n");
    let full = rendered(&job, &["--threads", "1"]);
    assert_same(&full, &rendered(&job, &["--set", "render.tile_px=8"]), "small tiles");
    let folder = |name: &str| text(&place.path().join(name));
    for index in ["0/2", "1/2"] {
        etendue(["render", &job, "-o", &folder(&index[..1]), "--shard", index]).ok();
    }
    etendue(["merge", &folder("0"), &folder("1"), "-o", &folder("all")]).ok();
    assert_same(&full, &contents(Path::new(&folder("all"))), "two shards");
}

#[test]
fn samples_are_even_or_as_noise_says_but_not_both() {
    let place = place();
    let limited = job(place.path(), "noise_threshold = 0.5\n");
    let plan = etendue(["plan", &limited]).ok().out;
    assert!(
        plan.contains("16 to 4096 samples per pixel in 8 replicates, until its error is 0.5 of the sensor's noise"),
        "{plan}"
    );
    let uniform = etendue(["plan", &limited, "--spp", "32"]).ok();
    assert!(uniform.out.contains("32 samples per pixel in 4 replicates"), "{}", uniform.out);
    assert!(uniform.err.contains("--spp 32 overrides") && uniform.err.contains("noise_threshold"), "{}", uniform.err);
    let assert_refused = |render: &str, phrases: &[&str]| {
        let job = job(place.path(), render);
        etendue(["plan", &job]).refused(phrases);
    };
    assert_refused(
        "noise_threshold = 0.5\nspp = 64\n",
        &["job.toml", "\"spp\" and \"noise_threshold\" exclude each other"],
    );
    assert_refused("noise_threshold = 0\n", &["noise_threshold: found 0"]);
    assert_refused("min_spp = 16\n", &["\"min_spp\" has no effect without \"noise_threshold\""]);
    assert_refused(
        "noise_threshold = 0.5\nreplicates = 4\n",
        &["replicates that determine each other's samples", "give 5 or more"],
    );
    assert_refused(
        "noise_threshold = 0.5\nmin_spp = 20\n",
        &["20 samples cannot be divided equally among 8 replicates"],
    );
    assert_refused("noise_threshold = 0.5\nmax_spp = 8\n", &["below the minimum of 16"]);
}
