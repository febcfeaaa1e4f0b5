//! `etendue develop`: raws of every kind developed again, and raws that contradict their camera.

use crate::support::{CommandOutput, contents, etendue, text};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const CAMERA: &str = r#"
format = 1
[lens]
type = "thin"
focal_length_mm = 6
f_number = 2
focus_distance_m = 5
[sensor]
width_px = 32
height_px = 24
pixel_pitch_um = 150
exposure_s = 1e-7
frame_period_s = 1e-3
cfa = "rggb"
quantum_efficiency = { camera = "nikon-d5100", peak = 0.5 }
full_well_e = 12_000
read_noise_e = 4
dark_current_e_s = 10
gain_dn_per_e = 0.33
black_level_dn = 64
bits = 12
[isp]
white_balance = "D65"
colour_matrix = { fit = "D65" }
exposure_gain = 1.5
[[isp.image_filters]]
type = "pulse_noise"
amplitude_dn = 40
probability = 0.1
"#;

/// Shielded rows, and an exposure that varies between frames.
const MONO: &str = r#"
[sensor.optical_black]
rows_px = 4
[sensor.auto_exposure]
percentile = 90
target = 0.5
damping = 0.7
exposure_limits_s = [1e-8, 1e-4]
gain_limits = [1, 8]
"#;

/// Numbers of 20 bits companded to 12, and 2 × 2 binning.
const HDR: &str = r#"
[sensor.hdr]
merged_bits = 20
captures = [{ exposure_ratio = 0.01 }]
[sensor.companding]
bits = 12
knees = [[512, 512], [4096, 1408], [65536, 2368], [1048575, 4095]]
[sensor.binning]
columns = 2
rows = 2
of = "numbers"
"#;

const JOB: &str = r#"
format = 1
[scene]
environment = { type = "uniform", luminance_cd_m2 = 8000, illuminant = "D65" }
[[scene.materials]]
name = "ground"
type = "diffuse"
reflectance = [0.4, 0.2, 0.1]
[[scene.objects]]
name = "ground"
shape = { type = "quad", size_m = [30, 30] }
material = "ground"
[render]
spp = 4
integrator = "direct"
[output]
raw = true
picture = true
"#;

/// A folder with the job, its cameras, and its result: two frames of each camera.
struct RenderedFrames {
    folder: TempDir,
}

impl RenderedFrames {
    fn render_frames() -> Self {
        let frames = Self { folder: tempfile::tempdir().expect("a temporary folder") };
        let colour = "white_balance = \"D65\"\ncolour_matrix = { fit = \"D65\" }\n";
        let mono = CAMERA
            .replace("cfa = \"rggb\"", "cfa = \"mono\"")
            .replace("{ camera = \"nikon-d5100\", peak = 0.5 }", "0.5")
            .replace(colour, "black_level = \"optical_black\"\n");
        frames.write("bayer.toml", CAMERA);
        frames.write("mono.toml", &format!("{mono}{MONO}"));
        frames.write("hdr.toml", &format!("{CAMERA}{HDR}"));
        let setup = |(name, format)| {
            format!(
                "[[cameras]]\nname = \"{name}\"\nfile = \"{name}.toml\"\nposition_m = [0, 0, 1.5]\n\
                 look_at_m = [6, 0, 0.9]\noutput = {{ raw_format = \"{format}\" }}\n"
            )
        };
        let cameras = [("bayer", "dng"), ("mono", "tiff"), ("hdr", "png")].map(setup).concat();
        frames.write("job.toml", &format!("{JOB}\n{cameras}"));
        etendue(["render", &frames.path("job.toml"), "-o", &frames.path("out"), "--frames", "0..2", "--seed", "9"])
            .ok();
        frames
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.folder.path().join(name), text).expect("written");
    }

    fn path(&self, name: &str) -> String {
        text(&self.folder.path().join(name))
    }

    /// Develops raws, named relative to the folder, into the folder `made`.
    fn develop(&self, raws: &[&str], camera: &str, options: &[&str]) -> CommandOutput {
        let raws: Vec<String> = raws.iter().map(|raw| self.path(raw)).collect();
        let rest = ["--camera", &self.path(camera), "-o", &self.path("made"), "--overwrite"].map(str::to_owned);
        let options = options.iter().map(|option| (*option).to_owned());
        etendue(["develop".to_owned()].into_iter().chain(raws).chain(rest).chain(options))
    }

    /// Asserts a refusal with these phrases and without output.
    #[track_caller]
    fn refused(&self, raws: &[&str], camera: &str, options: &[&str], phrases: &[&str]) {
        self.develop(raws, camera, options).refused(phrases);
        assert!(contents(Path::new(&self.path("made"))).is_empty(), "something was written");
    }
}

#[test]
fn every_kind_of_raw_gives_the_same_picture_again() {
    let frames = RenderedFrames::render_frames();
    for (camera, extension) in [("bayer", "dng"), ("mono", "tif"), ("hdr", "png")] {
        let raws = [0, 1].map(|frame| format!("out/{camera}/raw.000{frame}.{extension}"));
        frames.develop(&raws.each_ref().map(String::as_str), &format!("{camera}.toml"), &[]).ok();
        let (own, developed) = (frames.path(&format!("out/{camera}")), frames.path(&format!("made/{camera}")));
        let (own, developed) = (contents(Path::new(&own)), contents(Path::new(&developed)));
        for image in ["picture.0000.png", "picture.0001.png"] {
            assert!(own[image] == developed[image], "{camera}: {image} has other bytes");
        }
        assert_ne!(developed["picture.0000.png"], developed["picture.0001.png"], "frames have their own noise");
        let facts: serde_json::Value = serde_json::from_slice(&developed["develop.json"]).expect("JSON");
        assert_eq!((&facts["frames"][1]["frame"], &facts["frames"][1]["seed"]), (&1.into(), &9.into()));
    }
}

#[test]
fn another_processing_gives_another_picture() {
    let frames = RenderedFrames::render_frames();
    let developed = |options: &[&str]| {
        frames.develop(&["out/bayer/raw.0000.dng"], "bayer.toml", options).ok();
        let mut files = contents(Path::new(&frames.path("made/bayer")));
        fs::remove_dir_all(frames.path("made")).expect("removed");
        files.remove("develop.json");
        files
    };
    let plain = developed(&[]);
    for option in [
        "isp.demosaic=malvar",
        "isp.white_balance=grey_world",
        "isp.tone_curve=linear",
        "isp.sharpening={ amount = 1, radius_px = 1 }",
        "isp.noise_reduction={ median_px = 1 }",
        "isp.black_level=20",
        "isp.shading={ radial_gains = [1, 2] }",
        "isp.defect_outlier_threshold=0.02",
        "isp.picture_bits=16",
        "isp.picture_format=jpeg",
    ] {
        assert_ne!(developed(&["--set", option]), plain, "{option}");
    }
    assert_ne!(developed(&["--seed", "8"]), plain, "the paper's noises have the seed");
}

/// Development without a curve and a matrix is stated in the side-car, in its words, and in the file's own chunk.
#[test]
fn a_linear_picture_of_the_sensors_colours_is_called_that() {
    let frames = RenderedFrames::render_frames();
    let plain = CAMERA.replace("colour_matrix = { fit = \"D65\" }\n", "tone_curve = \"linear\"\n");
    frames.write("bayer.toml", &plain);
    frames.develop(&["out/bayer/raw.0000.dng"], "bayer.toml", &[]).ok();
    let developed = contents(Path::new(&frames.path("made/bayer")));
    let facts: serde_json::Value = serde_json::from_slice(&developed["develop.json"]).expect("JSON");
    let entry = &facts["files"]["picture.0000.png"];
    assert_eq!((&entry["encoding"], &entry["quantity"]), (&"linear".into(), &"linear picture".into()));
    let words = facts["isp"].as_str().expect("words");
    assert!(words.contains("linear tone") && !words.contains("matrix"), "{words}");
    let has = |name: &[u8]| developed["picture.0000.png"].windows(4).any(|four| four == name);
    assert!(has(b"gAMA") && !has(b"sRGB"));
}

#[test]
fn a_raw_without_a_side_car_needs_its_levels() {
    let frames = RenderedFrames::render_frames();
    let (raw, single) = ("out/bayer/raw.0000.dng", "lone.dng");
    fs::copy(frames.path(raw), frames.path(single)).expect("copied");
    frames.refused(&[single], "bayer.toml", &[], &["lone.dng", "camera.json", "--levels"]);
    frames.refused(&[raw], "bayer.toml", &["--levels", "64..4024"], &["raw.0000.dng", "omit --levels"]);
    frames.refused(&[single], "bayer.toml", &["--levels", "64..64"], &["--levels", "BLACK < WHITE"]);
    frames.refused(&[single], "hdr.toml", &["--levels", "64..4024"], &["lone.dng", "companded", "side-car"]);
    frames.develop(&[single], "bayer.toml", &["--levels", "64..4024", "--seed", "9"]).ok();
    let image = |folder: &str| fs::read(frames.path(&format!("{folder}/bayer/picture.0000.png"))).expect("a picture");
    assert!(image("made") == image("out"), "levels, seed and frame are those of the side-car");
}

#[test]
fn raws_that_contradict_their_camera_are_refused() {
    let frames = RenderedFrames::render_frames();
    let (bayer, hdr) = ("out/bayer/raw.0000.dng", "out/hdr/raw.0000.png");
    let sidecar = frames.path("out/bayer/camera.json");
    frames.refused(&[bayer], "mono.toml", &[], &[bayer, "red green green blue", "mono", "the camera that captured it"]);
    frames.refused(&[hdr], "bayer.toml", &[], &[hdr, "companding", "the camera that captured it"]);
    frames.refused(&[bayer], "bayer.toml", &["--set", "sensor.width_px=40"], &[bayer, "32 × 24", "40 × 24"]);
    frames.refused(&[bayer, bayer], "bayer.toml", &[], &[bayer, "another raw is also frame 0"]);
    frames.refused(&["out/bayer/camera.json"], "bayer.toml", &[], &["camera.json", "not an image"]);
    frames.refused(&["out/bayer/none.png"], "bayer.toml", &[], &["none.png"]);
    let colour = ["--levels", "0..255"];
    frames.refused(&["out/bayer/picture.0000.png"], "bayer.toml", &colour, &["picture.0000.png", "grey", "R, G, B"]);
    let optical = ["--set", "isp.black_level=optical_black"];
    frames.refused(&[bayer], "bayer.toml", &optical, &["isp.black_level", "optical-black"]);

    let sidecar_text = fs::read_to_string(&sidecar).expect("a side-car");
    let assert_refused = |from: &str, to: &str, phrases: &[&str]| {
        let raw = "out/bayer/raw.0001.dng";
        let text = sidecar_text.replace(from, to);
        assert_ne!(text, sidecar_text, "the side-car lacks {from}");
        fs::write(&sidecar, text).expect("written");
        frames.refused(&[raw], "bayer.toml", &[], &[&[raw], phrases].concat());
    };
    assert_refused("\"raw\": \"raw.0001.dng\"", "\"raw\": null", &["earlier version", "render again"]);
    assert_refused("\"bits\": 12", "\"bits\": 8", &["bits", "the camera that captured it"]);
    assert_refused("\"white_level_dn\": 4024.0", "\"white_level_dn\": 64.0", &["white must be above black"]);
    assert_refused(
        "        32,\n        24\n",
        "        32,\n        25\n",
        &["32 × 25 pixels at column 0", "32 × 24"],
    );
}

#[test]
fn a_camera_without_processing_makes_no_pictures() {
    let frames = RenderedFrames::render_frames();
    let at = CAMERA.find("[isp]").expect("a processing");
    frames.write("plain.toml", &CAMERA[..at]);
    frames.refused(&["out/bayer/raw.0000.dng"], "plain.toml", &[], &["plain.toml", "[isp]", "add it"]);
}
