//! Time against error: files of a study, validity of its job files, and refusals.

use crate::support::{BALL, contents, etendue, text};
use std::path::Path;

/// Tables of the job in addition to scene and camera.
const RENDER: &str = "[render]\nspp = 32\nmax_bounces = 6\n[output]\nground_truth = false\n";

fn job(folder: &Path) -> String {
    let job = folder.join("job.toml");
    // A white floor and ball, in 64 × 48 px.
    let changes = [
        ("reflectance = 0.5", "reflectance = 0.8"),
        ("width_px = 40", "width_px = 64"),
        ("height_px = 28", "height_px = 48"),
    ];
    let changes = changes
        .into_iter()
        .chain([("pixel_pitch_um = 150", "pixel_pitch_um = 100"), ("exposure_s = 2e-6", "exposure_s = 1e-5")]);
    let scene = changes.fold(BALL.to_owned(), |text, (from, to)| text.replace(from, to));
    std::fs::write(&job, scene + RENDER).expect("a file");
    text(&job)
}

#[test]
fn a_study_reports_times_and_errors_and_writes_jobs() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (job(place.path()), text(&place.path().join("out")));
    let output = etendue(["tradeoff", &job, "-o", &out, "--time", "10"]).ok().out;
    for phrase in ["as in the job: 32 samples", "bias, named:", "Pareto front", "draft: ", "standard: ", "reference: "]
    {
        assert!(output.contains(phrase), "{phrase} is missing in:\n{output}");
    }
    let files = contents(Path::new(&out));
    let names: Vec<_> = files.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        ["draft.toml", "reference.toml", "standard.toml", "tradeoff.json", "tradeoff.svg", "tradeoff.txt"],
        "and nothing of the frame that was tried"
    );
    let study: serde_json::Value = serde_json::from_slice(&files["tradeoff.json"]).expect("JSON");
    assert_eq!(study["signal"], "electrons");
    let configurations = study["ways"].as_array().expect("ways");
    assert_eq!(
        (&configurations[0]["way"]["integrator"], &configurations[0]["way"]["max_bounces"]),
        (&"path".into(), &6.into())
    );
    let of =
        |integrator: &str| configurations.iter().find(|w| w["way"]["integrator"] == integrator).expect("looked at");
    // A white floor and ball without shadows or mutual illumination: about 8 % of the light, most of it in two or three of twelve tiles around the
    // ball (all tiles are examined, so that it is the same every time).
    let bias = &of("flat")["bias"]["squares"]["relative"];
    let (value, uncertainty) = (bias["value"].as_f64().expect("known"), bias["uncertainty"].as_f64().expect("known"));
    assert!(value > 1e-4 && value > 2.0 * uncertainty, "{bias}");
    // The replacement of all bounces is a small part of that, and there are no caustics to lose.
    let caustics = configurations.iter().find(|w| w["way"]["caustics"] == false && w["way"]["max_bounces"] == 64);
    assert_eq!(caustics.expect("looked at")["bias"]["squares"]["relative"]["value"], 0.0);
    for (name, samples) in [("draft", 4), ("standard", 4), ("reference", 64)] {
        let file = text(&place.path().join(format!("out/{name}.toml")));
        let plan = etendue(["plan", &file]).ok().out;
        let recommendation =
            study["recommendations"].as_array().expect("a list").iter().find(|r| r["target"]["name"] == name);
        let spp = recommendation.expect("recommended")["point"]["spp"].as_u64().expect("a number");
        assert!(spp >= samples, "{name}: {spp}");
        assert!(plan.contains(&format!("{spp} samples per pixel")), "{name}: {spp} in {plan}");
    }
    assert!(etendue(["tradeoff", &job, "-o", &out, "--time", "10"]).status == 2, "there is a study already");
}

#[test]
fn effects_are_left_out_one_after_the_other() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (job(place.path()), text(&place.path().join("out")));
    let output = etendue(["tradeoff", &job, "-o", &out, "--time", "10", "--ablate", "--json"]).ok().out;
    let study: serde_json::Value = serde_json::from_str(&output).expect("JSON");
    let dropped = study["dropped"].as_array().expect("a list");
    let of = |name: &str| dropped.iter().find(|d| d["effect"] == name).unwrap_or_else(|| panic!("{name} in {output}"));
    // A white floor lights a white ball from below: without it a large part of the image is darker, and no ray takes another path.
    let indirect = of("indirect light");
    let light = indirect["light"]["value"].as_f64().expect("known");
    assert!((0.02..1.0).contains(&light) && light > 3.0 * indirect["light"]["uncertainty"].as_f64().expect("known"));
    assert_eq!((&indirect["instances"], &indirect["direction_px"]), (&0.0.into(), &0.0.into()));
    let read = of("read noise");
    assert_eq!(read["light"]["value"], 0.0);
    // 4 e⁻ at 0.05 DN/e⁻ are 0.2 DN: some numbers are rounded differently.
    assert!((0.05..1.0).contains(&read["raw_dn"].as_f64().expect("known")), "{read}");
    let files = contents(Path::new(&out));
    assert!(files.contains_key("ablation.txt") && !files.contains_key("tradeoff.json"));
}

#[test]
fn keys_are_varied_one_after_the_other() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (job(place.path()), text(&place.path().join("out")));
    let vary = [
        "--vary",
        "render.wavelengths_per_path=1; render.max_bounces=5",
        "--vary",
        "render.max_bounces=1",
        "--vary",
        "render.route=\"pupil\"",
    ];
    let arguments = ["tradeoff", &job, "-o", &out, "--time", "10", "--json"];
    let output = etendue(arguments.into_iter().chain(vary)).ok().out;
    let study: serde_json::Value = serde_json::from_str(&output).expect("JSON");
    let varied = study["varied"].as_array().expect("a list");
    let light = |i: usize| {
        let light = &varied[i]["light"];
        (light["value"].as_f64().expect("known"), light["uncertainty"].as_f64().expect("known"))
    };
    assert_eq!(varied[0]["set"], serde_json::json!(["render.wavelengths_per_path=1", "render.max_bounces=5"]));
    // One bounce less than the job's six has little effect; five less remove the light from the floor on the ball.
    let (one_bounce, none) = (light(0), light(1));
    assert!(
        one_bounce.0 < 0.02 + 3.0 * one_bounce.1 && none.0 > 0.02 && none.0 > 3.0 * none.1,
        "{one_bounce:?} {none:?}"
    );
    // The ball is lit equally, however its light is stored; sharp edges are distributed differently between their pixels.
    assert!(light(2).0 < 0.5, "{:?}", light(2));
    // The route at the pupil stores a spectrum for every pixel.
    let memory = |value: &serde_json::Value| value["memory_bytes"].as_f64().expect("known");
    assert!(memory(&varied[2]) > memory(&study), "{output}");
    let files = contents(Path::new(&out));
    assert!(files.contains_key("variations.txt") && !files.contains_key("draft.toml"));
}

/// In focus only the pixel's aperture of width a blurs an edge, by sin(πaf)/(πaf), which is one half at af = 0.6034; a longer exposure changes no
/// edge, corner or contrast.
#[test]
fn edges_and_corners_show_a_change() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (job(place.path()), text(&place.path().join("out")));
    let large = [
        ("width_px = 64", "width_px = 360"),
        ("height_px = 48", "height_px = 240"),
        ("pixel_pitch_um = 100", "pixel_pitch_um = 15"),
        ("exposure_s = 1e-5", "exposure_s = 2e-4"),
        ("\"rggb\"", "\"mono\""),
        ("{ camera = \"nikon-d5100\", peak = 0.5 }", "0.5"),
    ];
    let small = std::fs::read_to_string(&job).expect("the job");
    std::fs::write(&job, large.into_iter().fold(small, |text, (from, to)| text.replace(from, to))).expect("a file");
    let vary = ["--vary", "cameras.front.sensor.fill_factor=0.49", "--vary", "cameras.front.sensor.exposure_s=1e-4"];
    let arguments = ["tradeoff", &job, "-o", &out, "--time", "10", "--mtf50", "--json"];
    let output = etendue(arguments.into_iter().chain(vary)).ok().out;
    let study: serde_json::Value = serde_json::from_str(&output).expect("JSON");
    let of = |change: usize, pointer: &str| {
        let estimate = study["varied"][change].pointer(pointer).unwrap_or_else(|| panic!("{pointer} in {output}"));
        (estimate["value"].as_f64().expect("known"), estimate["uncertainty"].as_f64().expect("known"))
    };
    // 3 % for the measurement itself: edges of about twenty pixels.
    let agrees = |(value, uncertainty): (f64, f64), expected: f64| {
        assert!((value - expected).abs() < 0.03 * expected + 3.0 * uncertainty, "{value} ± {uncertainty}, {expected}");
        assert!(uncertainty < 0.1 * expected, "{value} ± {uncertainty}");
    };
    for change in [0, 1] {
        agrees(of(change, "/mtf50/0/middle"), 0.6034);
        let aperture = if change == 0 { 0.7 } else { 1.0 };
        agrees(of(change, "/mtf50/1/middle"), 0.6034 / aperture);
        let (corners, contrast) = (of(change, "/corners"), of(change, "/contrast"));
        assert!((corners.0 - 1.0).abs() < 0.01 && contrast.0.abs() < 0.01, "{corners:?} {contrast:?}");
    }
    assert!(of(0, "/mtf50/1/middle").0 > 1.2 * of(0, "/mtf50/0/middle").0);
    let files = contents(Path::new(&out));
    assert!(files.keys().all(|name| !name.starts_with("edges")), "the chart is gone");
    etendue(["tradeoff", &job, "-o", &out, "--overwrite", "--mtf50"]).refused(&["--mtf50", "--ablate or --vary"]);
}

#[test]
fn what_cannot_be_studied_is_refused() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (job(place.path()), text(&place.path().join("out")));
    etendue(["tradeoff", &job, "-o", &out, "--time", "5"]).refused(&["--time", "expected seconds from 10"]);
    etendue(["tradeoff", &job, "-o", &out, "--camera", "rear"]).refused(&["--camera rear", "front"]);
    etendue(["tradeoff", &job, "-o", &out, "--set", "render.sp=3"]).refused(&["render.sp"]);
    let vary = |change: &str, phrases: &[&str]| {
        drop(etendue(["tradeoff", &job, "-o", &out, "--vary", change]).refused(phrases));
    };
    vary("render.max_bounces", &["--vary", "expected KEY=VALUE"]);
    vary("render.bounces=3", &["render.bounces"]);
    vary("render.spp=4", &["--vary render.spp=4", "samples are chosen by --time here"]);
    assert!(!Path::new(&out).exists(), "nothing is written");
}
