//! Charts: every one makes a job that compiles, its reference data equal the render, and invalid options are refused.

use crate::support::{etendue, text};
use etendue_io::exr::read_exr;
use serde_json::Value;
use std::path::{Path, PathBuf};

const CHARTS: [&str; 16] = [
    "dots",
    "checkerboard",
    "circles",
    "flat-field",
    "backlit",
    "slanted-edges",
    "slanted-star",
    "siemens-star",
    "dead-leaves",
    "oecf-steps",
    "colorchecker",
    "contrast-patches",
    "flare",
    "led-flicker",
    "points",
    "depth-wedge",
];

/// A small camera with barrel distortion, its axis off the image's middle.
const CAMERA: &str = "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 2\nf_number = 4\n[lens.distortion]\nk1 = -0.6\ndirection \
                      = \"ideal_to_observed\"\nradius_unit = \"focal_lengths\"\n[sensor]\nwidth_px = 96\nheight_px = \
                      72\npixel_pitch_um = 8\nprincipal_point_px = [50, 34]\nexposure_s = 0.01\ncfa = \
                      \"mono\"\nquantum_efficiency = 0.5\nfull_well_e = 20000\nread_noise_e = 5\ndark_current_e_s = \
                      0\ngain_dn_per_e = 0.2\nblack_level_dn = 50\nbits = 12\n[sensor.auto_exposure]\npercentile = 90\ntarget = \
                      0.5\nexposure_limits_s = [1e-4, 0.1]\ngain_limits = [1, 2]\n";

struct ChartFolder(tempfile::TempDir);

impl ChartFolder {
    fn new() -> Self {
        let place = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(place.path().join("small.toml"), CAMERA).expect("written");
        Self(place)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Makes a chart for the small camera in a folder of its name.
    #[track_caller]
    fn chart(&self, name: &str, options: &[&str]) -> PathBuf {
        let (camera, folder) = (text(&self.path("small.toml")), text(&self.path(name)));
        let common = ["chart", name, "--camera", &camera, "-o", &folder];
        etendue(common.iter().chain(options)).ok();
        self.path(name)
    }
}

fn truth(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("truth.json")).expect("a truth");
    serde_json::from_str(&text).expect("JSON")
}

fn point(value: &Value) -> Option<[f64; 2]> {
    Some([value.get(0)?.as_f64()?, value.get(1)?.as_f64()?])
}

fn point3(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|i| value[i].as_f64().expect("a number"))
}

#[test]
fn every_chart_is_a_job_that_compiles() {
    let place = ChartFolder::new();
    for name in CHARTS {
        let folder = place.chart(name, &["--png", "5"][..if name == "depth-wedge" { 0 } else { 2 }]);
        etendue(["plan", &text(&folder.join("job.toml"))]).ok();
        let truth = truth(&folder);
        assert_eq!(truth["chart"], name);
        assert_eq!(truth["seen"]["fills_the_field"], true);
        let cameras = truth["cameras"].as_array().expect("cameras").len();
        assert_eq!(cameras, if name == "backlit" { 15 } else { 1 }, "{name}");
    }
}

#[test]
fn the_same_seed_makes_the_same_files_and_another_other_leaves() {
    let place = ChartFolder::new();
    let folder = place.chart("dead-leaves", &[]);
    let camera = text(&place.path("small.toml"));
    for (seed, same) in [("0", true), ("1", false)] {
        let repeated = place.path(seed);
        etendue(["chart", "dead-leaves", "--camera", &camera, "--seed", seed, "-o", &text(&repeated)]).ok();
        let read = |folder: &Path, file| std::fs::read(folder.join(file)).expect("a file");
        for file in ["truth.json", "leaves.png"] {
            assert_eq!(read(&folder, file) == read(&repeated, file), same, "{file}");
        }
    }
}

#[test]
fn reference_cameras_bring_their_file_and_views_their_poses() {
    let place = ChartFolder::new();
    let folder = text(&place.path("views"));
    etendue(["chart", "checkerboard", "--camera", "ccd-mono", "--views", "5", "-o", &folder]).ok();
    etendue(["plan", &format!("{folder}/job.toml")]).ok();
    let truth = truth(Path::new(&folder));
    assert_eq!(truth["cameras"].as_array().map(Vec::len), Some(5));
    for camera in truth["cameras"].as_array().expect("cameras") {
        let corners = camera["features_px"].as_array().expect("features");
        assert!(corners.iter().all(|c| point(&c[0]).is_some()), "{}: a corner is out of the picture", camera["name"]);
    }
}

/// Ground-truth positions, rendered by the tracer, agree with the features of the reference data; and the dots' centroids agree with it.
#[test]
fn dots_are_rendered_where_the_truth_says() {
    let place = ChartFolder::new();
    let folder = place.chart("dots", &["--columns", "8", "--distance-m", "2"]);
    let out = text(&place.path("out"));
    let job = text(&folder.join("job.toml"));
    let output = "output={ electrons = true, ground_truth = true, raw = false, picture = false }";
    etendue(["render", &job, "-o", &out, "--spp", "256", "--set", output]).ok();
    let truth = truth(&folder);
    let positions = read_exr(Path::new(&format!("{out}/camera/ground_truth.exr"))).expect("an EXR");
    let planes = ["P.X", "P.Y", "P.Z"].map(|name| positions.channel(name).expect("a position").to_floats());
    let light = read_exr(Path::new(&format!("{out}/camera/electrons.exr"))).expect("an EXR");
    let electrons = light.channels[0].samples.to_floats();
    let features_px = truth["cameras"][0]["features_px"].as_array().expect("features");
    let centroids = truth["cameras"][0]["image_centroids_px"].as_array().expect("centroids");
    let features = truth["features"].as_array().expect("features");
    let pixel_m = truth["seen"]["pixel_mm"].as_f64().expect("a size") / 1e3;
    let half = truth["sizes"]["pitch_mm"].as_f64().expect("a pitch") / 2e3 / pixel_m * 0.85;
    let mut checked = 0;
    for ((feature, at), centroid) in features.iter().zip(features_px).zip(centroids) {
        let (Some([x, y]), Some(centre)) = (point(&at[0]), point(centroid)) else { continue };
        let is_inside = x > half + 1.0 && x < 95.0 - half && y > half + 1.0 && y < 71.0 - half;
        if !is_inside {
            continue;
        }
        let world = point3(&feature["world_m"][0]);
        let there = [0, 1, 2].map(|c| between(&planes[c], 96, x, y));
        let off: f64 = (0..3).map(|c| (there[c] - world[c]).abs()).fold(0.0, f64::max);
        // Positions between pixels bend by an eighth of the second derivative, 6 k₁ r/f ≈ 0.004 a pixel; they are stored in 32 bits.
        assert!(off < 1.5e-3 * pixel_m, "({x}, {y}): {off} m");
        let [u, v] = grey_centroid(&electrons, centre, half);
        // 256 samples: a pixel on the edge errs by at most 0.03 of it, and about 30 share that.
        assert!((u - centre[0]).abs() < 0.02 && (v - centre[1]).abs() < 0.02, "{centre:?}: {u} {v}");
        checked += 1;
    }
    assert!(checked >= 20, "{checked} dots were seen");
}

/// A plane of samples at pixels' centres, linear between them.
fn between(plane: &[f32], width: usize, x: f64, y: f64) -> f64 {
    let (x, y) = (x - 0.5, y - 0.5);
    let (column, row) = (x.floor() as usize, y.floor() as usize);
    let at = |dx: usize, dy: usize| f64::from(plane[(row + dy) * width + column + dx]);
    let (s, t) = (x - x.floor(), y - y.floor());
    (at(0, 0) * (1.0 - s) + at(1, 0) * s) * (1.0 - t) + (at(0, 1) * (1.0 - s) + at(1, 1) * s) * t
}

/// Centroid of darkness relative to the brightest value about a position; fractions below a tenth are the ground's fall-off.
fn grey_centroid(plane: &[f32], [x, y]: [f64; 2], half: f64) -> [f64; 2] {
    let range = |c: f64| (c - half).floor() as usize..(c + half).ceil() as usize;
    let pixels: Vec<(f64, f64, f64)> = range(y)
        .flat_map(|row| range(x).map(move |column| (column, row)))
        .map(|(column, row)| (column as f64 + 0.5, row as f64 + 0.5, f64::from(plane[row * 96 + column])))
        .collect();
    let brightest = pixels.iter().map(|p| p.2).fold(0.0, f64::max);
    let darkest = pixels.iter().map(|p| p.2).fold(f64::INFINITY, f64::min);
    let weight = |v: f64| Some((brightest - v) / (brightest - darkest)).filter(|w| *w > 0.1).unwrap_or(0.0);
    let sum: f64 = pixels.iter().map(|p| weight(p.2)).sum();
    [
        pixels.iter().map(|p| p.0 * weight(p.2)).sum::<f64>() / sum,
        pixels.iter().map(|p| p.1 * weight(p.2)).sum::<f64>() / sum,
    ]
}

/// The light that reaches the middle of a flat field in the reference data equals the render.
#[test]
fn electrons_are_those_of_the_truth() {
    let place = ChartFolder::new();
    for name in ["flat-field", "oecf-steps", "backlit"] {
        let more: &[&str] = if name == "backlit" { &["--levels", "0.25,0.5"] } else { &[] };
        let folder = place.chart(name, more);
        let truth = truth(&folder);
        let out = text(&place.path(&format!("{name}-out")));
        let output = "output={ electrons = true, raw = false, picture = false }";
        etendue(["render", &text(&folder.join("job.toml")), "-o", &out, "--spp", "64", "--set", output]).ok();
        for camera in truth["cameras"].as_array().expect("cameras") {
            let folder = camera["name"].as_str().expect("a name");
            let light = read_exr(Path::new(&format!("{out}/{folder}/electrons.exr"))).expect("an EXR");
            let plane = light.channels[0].samples.to_floats();
            let middle = (34..39).flat_map(|y| (46..51).map(move |x| y * 96 + x));
            let rendered = middle.map(|i| f64::from(plane[i])).sum::<f64>() / 25.0;
            let electrons = truth["inks"][0]["electrons"]["mono"].as_f64().expect("electrons");
            let expected = electrons * camera["exposure_s"].as_f64().expect("an exposure") / 0.01;
            // 64 samples over the spectrum leave half a per cent of noise in a pixel; the mean of 25 is off by a tenth of a per cent.
            assert!((rendered / expected - 1.0).abs() < 3e-3, "{name} {folder}: {rendered} {expected}");
        }
    }
}

#[test]
fn nonsense_is_refused_and_leaves_nothing() {
    let place = ChartFolder::new();
    let camera = text(&place.path("small.toml"));
    let out = text(&place.path("new/out"));
    let cases: &[(&[&str], &[&str])] = &[
        (&["nonsense"], &["nonsense"]),
        (&["dots", "--cycles", "5"], &["--cycles"]),
        (&["dots", "--pitch-mm", "-3"], &["--pitch-mm", "above 0"]),
        (&["dots", "--pitch-mm", "1e9"], &["--pitch-mm", "columns"]),
        (&["dots", "--columns", "501"], &["--columns 501", "500"]),
        (&["dots", "--dot-ratio", "1"], &["--dot-ratio"]),
        (&["dots", "--distance-m", "0"], &["--distance-m", "above 0"]),
        (&["dots", "--width-mm", "nan"], &["--width-mm", "above 0"]),
        (&["dots", "--distance-m", "1", "--width-mm", "5"], &["--width-mm"]),
        (&["dots", "--luminance-cd-m2", "-1"], &["--luminance-cd-m2", "above 0"]),
        (&["dots", "--white", "0"], &["--white", "saturation"]),
        (&["dots", "--illuminant", "D66"], &["--illuminant", "D66", "D65"]),
        (&["dots", "--png", "0"], &["--png", "pixels"]),
        (&["flat-field", "--reflectance", "1.5"], &["--reflectance"]),
        (&["flat-field", "--lowest", "0.1"], &["--lowest", "--exposures"]),
        (&["flat-field", "--exposures", "1"], &["--exposures 1"]),
        (&["flat-field", "--exposures", "3", "--lowest", "2"], &["--lowest", "--highest"]),
        (&["backlit", "--levels", "0.1,0"], &["--levels"]),
        (&["slanted-edges", "--angle-deg", "50"], &["--angle-deg"]),
        (&["slanted-edges", "--angle-deg", "0"], &["--angle-deg", "2 … 43", "measure sfr"]),
        (&["slanted-edges", "--angle-deg", "-44"], &["--angle-deg", "2 … 43"]),
        (&["slanted-star", "--spokes", "2", "--angle-deg", "0"], &["--angle-deg", "2° to 43°"]),
        (&["slanted-edges", "--contrast", "1"], &["--contrast"]),
        (&["slanted-star", "--spokes", "1"], &["--spokes"]),
        (&["siemens-star", "--cycles", "1"], &["--cycles"]),
        (&["dead-leaves", "--smallest-px", "0"], &["--smallest-px"]),
        (&["dead-leaves", "--smallest-px", "0.001"], &["--smallest-px", "half a texel", "0.1250 px"]),
        (&["dead-leaves", "--largest-ratio", "0.7"], &["--largest-ratio"]),
        (&["oecf-steps", "--steps", "1"], &["--steps"]),
        (&["oecf-steps", "--density", "9"], &["--density"]),
        (&["contrast-patches", "--decades", "0"], &["--decades"]),
        (&["flare", "--trap-ratio", "0.9"], &["--trap-ratio"]),
        (&["led-flicker", "--frequencies-hz", "90,0"], &["--frequencies-hz 0", "above 0"]),
        (&["led-flicker", "--duty-cycles", "0.1,1"], &["--duty-cycles 1"]),
        (&["points", "--diameter-px", "0"], &["--diameter-px"]),
        (&["depth-wedge", "--far-ratio", "1"], &["--far-ratio"]),
        (&["depth-wedge", "--steps", "1"], &["--steps"]),
        (&["depth-wedge", "--png", "10"], &["--png", "print"]),
    ];
    for (options, phrases) in cases {
        let common: [&str; 4] = ["--camera", &camera, "-o", &out];
        let arguments = ["chart"].iter().chain(*options).chain(&common);
        etendue(arguments).refused(phrases);
        assert!(!place.path("new").exists(), "{options:?} left something");
    }
    etendue(["chart", "dots", "--camera", "webb", "-o", &out]).refused(&["webb", "ccd-mono"]);
    etendue(["chart", "dots", "--camera", "scenes/cameras/catadioptric.toml", "-o", &out])
        .refused(&["does not face forward"]);
    etendue(["chart", "flat-field", "--exposures", "3", "--camera", "laboratory", "-o", &out])
        .refused(&["no electronics"]);
    let refused_folder = place.chart("flat-field", &[]);
    etendue(["chart", "flat-field", "--camera", &camera, "-o", &text(&refused_folder)])
        .refused(&["already exists", "--overwrite"]);
}

/// A change of the camera also changes the chart: with half the focal length twice the width is in view at the same distance.
#[test]
fn set_changes_the_written_job_and_its_camera() {
    let place = ChartFolder::new();
    let usual = place.chart("dots", &["--distance-m", "2"]);
    let usual = truth(&usual)["seen"]["field_mm"][0].as_f64().expect("a width");
    let options = [
        "--distance-m",
        "2",
        "--overwrite",
        "--set",
        "cameras.camera.lens.focal_length_mm=1",
        "--set",
        "cameras.camera.lens.distortion=null",
        "--set",
        "render.spp=7",
        "--set",
        "cameras.camera.output.raw=true",
        "--set",
        "scene.environment.luminance_cd_m2=42",
    ];
    let changed = place.chart("dots", &options);
    let facts = truth(&changed);
    let width = facts["seen"]["field_mm"][0].as_f64().expect("a width");
    // The axis is 50 of 96 px from the left: twice 50 px of 8 µm at 1 mm and 2 m.
    assert!((width - 1600.0).abs() < 1e-3 && width > 1.5 * usual, "{width} mm, before {usual} mm");
    let set: Vec<&str> = options.iter().copied().skip(8).filter(|option| *option != "--set").collect();
    assert_eq!(facts["changed_keys"], serde_json::json!(set));
    let read = |name: &str| std::fs::read_to_string(changed.join(name)).expect("a file");
    let [job, scene, camera] = ["job.toml", "scene.toml", "camera.toml"].map(read);
    assert!(job.contains("spp = 7") && job.contains("raw = true"), "{job}");
    assert!(scene.contains("luminance_cd_m2 = 42"), "{scene}");
    assert!(camera.contains("focal_length_mm = 1") && camera.contains("\"lens.distortion\""), "{camera}");
    let plan = etendue(["plan", &text(&changed.join("job.toml"))]).ok().out;
    assert!(plan.contains("7 samples per pixel") && plan.contains("pinhole, 1 mm"), "{plan}");
}

/// A wrong key gives the same error as `render` of the same job.
#[test]
fn a_wrong_key_of_a_chart_gives_the_error_of_its_job() {
    let place = ChartFolder::new();
    let folder = place.chart("dots", &[]);
    let (job, camera) = (text(&folder.join("job.toml")), text(&place.path("small.toml")));
    let [out, render] = ["new", "render"].map(|name| text(&place.path(name)));
    for change in [
        "render.sp=16",
        "render.spp=0",
        "cameras.front.lens.f_number=4",
        "cameras.camera.sensor.widht_px=32",
        "scene.environment.luminance=1",
        "spp",
        "scene.objects.nothing=null",
    ] {
        let expected = etendue(["render", &job, "-o", &render, "--set", change]);
        let chart_run = etendue(["chart", "dots", "--camera", &camera, "-o", &out, "--set", change]);
        let folder = text(&folder);
        let lines = |lines: &str| lines.replace(&folder, "").replace(&out, "");
        assert_eq!((chart_run.status, lines(&chart_run.err)), (2, lines(&expected.err)), "{change}");
        assert!(!place.path("new").exists(), "{change} left something");
    }
    // The chart sets the exposures of a series.
    let series = ["chart", "flat-field", "--exposures", "3", "--camera", "ccd-mono", "-o", &out];
    etendue(series.iter().chain(&["--set", "cameras.exposure-01.sensor.exposure_s=0.005"]))
        .refused(&["cameras.exposure-01.sensor.exposure_s=0.005", "the chart sets the exposures of a series"]);
}
