//! From a chart to a result: generated, rendered, measured at the positions of its reference data, against the known answer.

use crate::extremes;
use crate::support::{CommandOutput, etendue, text};
use etendue_testkit::page::check;
use serde_json::Value;
use std::path::PathBuf;

/// A small camera whose response is only the pixel's aperture: its readings are 500 + 1.5 electrons.
const CAMERA: &str = "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 16\nf_number = 4\n[sensor]\nwidth_px = \
                      160\nheight_px = 120\npixel_pitch_um = 8\nexposure_s = 0.01\nfull_well_e = 40000\nread_noise_e = \
                      5\ndark_current_e_s = 0\ngain_dn_per_e = 1.5\nblack_level_dn = 500\nbits = 16\n";
const MONO: &str = "cfa = \"mono\"\nquantum_efficiency = 0.5\n";
const BAYER: &str = "cfa = \"rggb\"\nquantum_efficiency = { camera = \"nikon-d5100\", peak = 0.35 }\n[isp]\nwhite_balance = \
                     \"D65\"\ncolour_matrix = { fit = \"D65\" }\n";

/// A chart with its images.
struct RenderedChart {
    folder: tempfile::TempDir,
    output: String,
}

impl RenderedChart {
    fn new(chart: &str, sensor: &str, options: &[&str], rendering: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| text(&folder.path().join(name));
        std::fs::write(at("camera.toml"), format!("{CAMERA}{sensor}")).expect("written");
        let arguments = ["chart", chart, "--camera", &at("camera.toml"), "-o", &at("chart")];
        etendue(arguments.iter().chain(options)).ok();
        let output = at("out");
        let job = at("chart/job.toml");
        etendue(["render", &job, "-o", &output, "--set", "output.ground_truth=false"].iter().chain(rendering)).ok();
        Self { folder, output }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn truth(&self) -> String {
        text(&self.path("chart/truth.json"))
    }

    fn picture(&self, name: &str) -> String {
        format!("{}/{name}", self.output)
    }

    /// Measures images with the chart's reference data.
    fn measure(&self, kind: &str, images: &[&str], options: &[&str]) -> CommandOutput {
        let images: Vec<String> = images.iter().map(|name| self.picture(name)).collect();
        let (truth, plot) = (self.truth(), text(&self.path("plot.svg")));
        let truth_options = ["--truth", &truth, "--plot", &plot, "--json"];
        let images = images.iter().map(String::as_str);
        etendue(["measure", kind].into_iter().chain(images).chain(truth_options).chain(options.iter().copied()))
    }

    /// Measures the first image.
    fn json(&self, kind: &str, options: &[&str]) -> Value {
        self.series(kind, &["camera/raw.0000.png"], options)
    }

    fn series(&self, kind: &str, images: &[&str], options: &[&str]) -> Value {
        serde_json::from_str(&self.measure(kind, images, options).ok().out).expect("JSON")
    }
}

fn figure(report: &Value, key: &str) -> f64 {
    report["figures"][key]["value"].as_f64().unwrap_or_else(|| panic!("{key} is missing in {report}"))
}

fn rows<'a>(report: &'a Value, table: &str) -> &'a Vec<Value> {
    report["tables"][table].as_array().unwrap_or_else(|| panic!("{table} is missing in {report}"))
}

fn value(cell: &Value) -> f64 {
    cell["value"].as_f64().or(cell.as_f64()).expect("a number")
}

/// Electrons of an ink in the middle of the image, from the reference data.
fn electrons(shot: &RenderedChart, ink: usize) -> f64 {
    let truth: Value = serde_json::from_str(&std::fs::read_to_string(shot.truth()).expect("a truth")).expect("JSON");
    truth["inks"][ink]["electrons"]["mono"].as_f64().expect("electrons")
}

#[test]
fn steps_and_exposures_give_the_line_of_the_sensor() {
    let shot = RenderedChart::new("oecf-steps", MONO, &["--steps", "8", "--density", "1.5"], &["--spp", "64"]);
    let report = shot.json("oecf", &[]);
    assert_eq!(rows(&report, "points").len(), 8);
    // 500 + 1.5 electrons per reading; the ring is 40 px from the middle, cos⁴ of 1.1°: 0.07 % less. 64 samples leave half a per cent of noise in a
    // pixel, of about 100 per step.
    let truth: Value = serde_json::from_str(&std::fs::read_to_string(shot.truth()).expect("a truth")).expect("JSON");
    let ink = &truth["inks"][1];
    let slope = 1.5 * ink["electrons"]["mono"].as_f64().expect("electrons") / value(&ink["luminance_cd_m2"]);
    assert!((figure(&report, "slope") / slope - 1.0).abs() < 3e-3, "{slope} {report}");
    assert!(
        (figure(&report, "offset") - 500.0).abs() < 12.0 && figure(&report, "linearity_error_percent") < 0.5,
        "{report}"
    );
    shot.measure("noise", &["camera/raw.0000.png"], &[]).refused(&["at least 8 frames"]);
    let series = RenderedChart::new("backlit", MONO, &["--levels", "0.1,0.2,0.4,0.7,1.2"], &["--spp", "64"]);
    let names: Vec<String> = (1..=5).map(|i| format!("exposure-0{i}/raw.0000.png")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let report = series.series("oecf", &names, &[]);
    let truth: Value = serde_json::from_str(&std::fs::read_to_string(series.truth()).expect("a truth")).expect("JSON");
    let slope = 1.5 * electrons(&series, 0) / 0.01 / value(&truth["light"]["luminance_cd_m2"]);
    assert!((figure(&report, "slope") / slope - 1.0).abs() < 3e-3, "{slope} {report}");
    // The last is saturated.
    assert!(
        (figure(&report, "saturation_exposure") / value(&rows(&report, "points")[4]["exposure"]) - 1.0).abs() < 1e-9
    );
    series.measure("oecf", &["exposure-01/camera.json"], &[]).refused(&["camera.json"]);
    let elsewhere = series.path("copy.png");
    std::fs::copy(series.picture(names[0]), &elsewhere).expect("copied");
    let run = etendue(["measure", "oecf", &text(&elsewhere), "--truth", &series.truth()]);
    run.refused(&["copy.png", "not one of the cameras exposure-01"]);
}

#[test]
fn patches_in_their_light_give_noise_and_contrast() {
    let options = ["--columns", "4", "--decades", "1.5"];
    let shot = RenderedChart::new("contrast-patches", MONO, &options, &["--spp", "64", "--frames", "0..8"]);
    let report = shot.json("cdp", &[]);
    let pairs = rows(&report, "pairs");
    assert_eq!(pairs.len(), 11);
    for pair in pairs {
        // Twelve patches over 1.5 decades: 10^(1.5/11) − 1 = 0.3689.
        assert!((value(&pair["scene_contrast"]) - 0.368_9).abs() < 1e-4, "{pair}");
        // Shot noise of 1 700 electrons or more: the contrast is rarely off by more than 50 %.
        assert!(value(&pair["cdp"]) > 0.98 && (value(&pair["cta"]) - 1.0).abs() < 0.03, "{pair}");
    }
    let frames: Vec<String> = (0..8).map(|i| format!("camera/raw.{i:04}.png")).collect();
    let frames: Vec<&str> = frames.iter().map(String::as_str).collect();
    let noise = shot.series("noise", &frames, &[]);
    assert_eq!(rows(&noise, "patches").len(), 12);
    for patch in rows(&noise, "patches") {
        let electrons = value(&patch["signal"]) / 1.5;
        // Shot noise, 5 electrons of read noise and quantisation by one count.
        let expected = (1.5 * 1.5 * (electrons + 25.0) + 1.0 / 12.0).sqrt();
        let (actual, u) = (value(&patch["temporal_noise"]), &patch["temporal_noise"]["standard_uncertainty"]);
        assert!((actual - expected).abs() < 4.0 * value(u), "{actual} {expected} {patch}");
    }
}

#[test]
fn traps_and_stars_give_what_the_chart_sends() {
    let shot = RenderedChart::new("flare", MONO, &["--columns", "3"], &["--spp", "64"]);
    let report = shot.json("flare", &[]);
    assert_eq!(rows(&report, "traps").len(), 6);
    // A pinhole has no flare: the remaining light comes from the inside of the traps, 0.01/(1 + 36)/0.9 = 0.03 % of the white from the bottom and
    // once or twice as much from the walls.
    assert!((0.0..0.15).contains(&figure(&report, "flare_percent")), "{report}");
    let shot = RenderedChart::new("siemens-star", MONO, &["--cycles", "24"], &["--spp", "256"]);
    let report = shot.json("star", &[]);
    assert!(
        (figure(&report, "centre_x_px") - 80.0).abs() < 0.05 && (figure(&report, "centre_y_px") - 60.0).abs() < 0.05
    );
    let sinc = |x: f64| etendue_core::maths::f64::sin(x) / x;
    // The square pixel along the tangent, over that at the edge.
    let aperture = |f: f64| {
        let part = |k: i32| {
            let (sine, cosine) = etendue_core::maths::f64::sin_cos(0.1 * f64::from(k) + 0.05);
            sinc(std::f64::consts::PI * f * sine) * sinc(std::f64::consts::PI * f * cosine)
        };
        (0..63).map(part).sum::<f64>() / 63.0
    };
    let circles = rows(&report, "circles");
    let outermost = aperture(value(&circles[0]["cycles_per_px"]));
    let last = value(&circles[circles.len() - 1]["cycles_per_px"]);
    assert!((0.4..=0.5).contains(&last), "{last}");
    for circle in circles {
        let (f, actual) = (value(&circle["cycles_per_px"]), value(&circle["response"]));
        let u = value(&circle["response"]["standard_uncertainty"]);
        assert!(
            (actual - aperture(f) / outermost).abs() < 0.005 + 4.0 * u,
            "{f}: {actual} ± {u}, {}",
            aperture(f) / outermost
        );
    }
}

/// With the matrix that fits the patches best: raw and developed image, in the light of the chart, not only in daylight.
#[test]
fn a_colour_chart_is_seen_in_its_own_light() {
    let shot = RenderedChart::new("colorchecker", BAYER, &["--illuminant", "A", "--white", "0.3"], &["--spp", "64"]);
    for image in ["camera/raw.0000.png", "camera/picture.0000.png"] {
        let report = shot.series("colour", &[image], &[]);
        assert_eq!(rows(&report, "patches").len(), 24);
        // A camera that does not satisfy the Luther condition: the least-squares matrix of the D5100's curves leaves about 1 (measured here, and 0.9
        // to 1.5 in the literature for such cameras).
        let mean = figure(&report, "mean_delta_e00");
        assert!((0.3..2.0).contains(&mean), "{image}: {mean}");
        // Reference colours are those in the chart's light: L* of white is 95 to 97 in any.
        let white = &rows(&report, "patches")[18];
        assert!(
            (value(&white["reference_l"]) - 96.0).abs() < 1.5 && value(&white["reference_b"]).abs() < 4.0,
            "{white}"
        );
    }
    let green = ["--channel", "G"];
    shot.measure("colour", &["camera/raw.0000.png"], &green).refused(&["a colour image"]);
    shot.measure("sfr", &["camera/picture.0000.png"], &[]).refused(&["the chart colorchecker", "slanted-edges"]);
    let small = RenderedChart::new("flat-field", MONO, &["--png", "10"], &["--spp", "4"]);
    let cut = text(&small.path("chart/chart.png"));
    etendue(["measure", "vignetting", &cut, "--truth", &small.truth()]).refused(&[
        "chart.png",
        "160 × 120",
        "not cropped or scaled",
    ]);
    etendue(["measure", "vignetting", &cut, "--truth", &shot.truth()])
        .refused(&["the chart colorchecker", "flat-field, backlit"]);
    small.json("vignetting", &[]);
    small.json("shading", &[]);
    small.measure("star", &["camera/raw.0000.png"], &[]).refused(&["the chart flat-field", "siemens-star"]);
}

/// Squares, by raw mosaic and developed image, and a star: only the pixel's aperture.
#[test]
fn slanted_edges_and_stars_give_the_pixels_aperture() {
    let pi = std::f64::consts::PI;
    let sinc = |x: f64| etendue_core::maths::f64::sin(x) / x;
    let aperture = |f: f64, angle_deg: f64| {
        let (sine, cosine) = etendue_core::maths::f64::sin_cos(angle_deg.to_radians());
        sinc(pi * f * sine) * sinc(pi * f * cosine)
    };
    let checked = |edge: &Value| {
        let (half, angle) = (&edge["response_at_half"], value(&edge["angle_deg"]));
        let (actual, u) = (value(half), value(&half["standard_uncertainty"]));
        assert!((actual - aperture(0.5, angle)).abs() < 0.01 + 4.0 * u, "{edge} {}", aperture(0.5, angle));
        // lp/mm of pixels of 8 µm.
        let (px, mm) = (value(&edge["mtf50_cycles_per_px"]), value(&edge["mtf50_lp_per_mm"]));
        assert!((mm / px / 125.0 - 1.0).abs() < 1e-9, "{edge}");
        // Of the eye's 0.987 at 60 pixels per degree the aperture leaves 0.95 (by Simpson's rule on sinc).
        assert!((value(&edge["acutance"]) - 0.945).abs() < 0.04, "{edge}");
    };
    let pitch = ["--pixel-pitch-um", "8"];
    let shot = RenderedChart::new("slanted-edges", MONO, &["--columns", "2", "--rows", "1"], &["--spp", "256"]);
    let report = shot.json("sfr", &pitch);
    let edges = rows(&report, "edges");
    assert_eq!(edges.len(), 8);
    edges.iter().for_each(checked);
    let plot = std::fs::read_to_string(shot.path("plot.svg")).expect("a plot");
    assert_eq!(plot.matches("<polyline").count(), 16);
    let star = RenderedChart::new("slanted-star", MONO, &["--columns", "1", "--rows", "1"], &["--spp", "256"]);
    let report = star.json("sfr", &pitch);
    assert!(rows(&report, "edges").len() >= 12, "{report}");
    rows(&report, "edges").iter().for_each(checked);
    assert_eq!(rows(&report, "planes")[0]["plane"], "every direction");
}

/// A raw image from a shot, each pixel from another position: its file, in a folder of its own.
fn redrawn(
    shot: &RenderedChart,
    name: &str,
    size: [usize; 2],
    of: impl Fn([usize; 2], usize, usize) -> [usize; 2],
) -> String {
    redrawn_into(shot, shot, name, size, of)
}

/// The same from another shot's image.
fn redrawn_into(
    to: &RenderedChart,
    shot: &RenderedChart,
    name: &str,
    size: [usize; 2],
    of: impl Fn([usize; 2], usize, usize) -> [usize; 2],
) -> String {
    let image =
        etendue_io::picture::read_image(&PathBuf::from(shot.picture("camera/raw.0000.png"))).expect("a picture");
    let size_px = [image.width, image.height].map(|n| n as usize);
    let etendue_scene::asset::ImagePixels::Gray16(readings) = &image.pixels else { panic!("16 bits of grey") };
    let at = |i: usize| {
        let [x, y] = of(size_px, i % size[0], i / size[0]);
        u32::from(readings[y * size_px[0] + x])
    };
    let samples = (0..size[0] * size[1]).map(at).collect();
    let plane = etendue_core::Plane::<etendue_core::quantity::DigitalNumber>::from_samples(size[0], size[1], samples);
    let file = to.path(name);
    std::fs::write(&file, etendue_io::png::encode_raw16(&plane.expect("a rectangle")).expect("a picture"))
        .expect("written");
    text(&file)
}

#[test]
fn pictures_that_are_mirrored_turned_or_of_another_chart_are_named_as_such() {
    let options = ["--columns", "4", "--decades", "1.5"];
    let shot = RenderedChart::new("contrast-patches", MONO, &options, &["--spp", "64"]);
    let cdp = |image: &str| etendue(["measure", "cdp", image, "--truth", &shot.truth()]);
    let size = [160, 120];
    cdp(&redrawn(&shot, "same.png", size, |_, x, y| [x, y])).ok();
    let (mut rows, folder) = (Vec::new(), shot.folder.path().to_path_buf());
    let mut assert_refused = |extreme: &str, output: CommandOutput, phrases: &[&str]| {
        rows.push(extremes::refused(extreme, "named as such", &output, &[&folder]));
        output.refused(phrases);
    };
    let mirrored = redrawn(&shot, "mirrored.png", size, |[w, _], x, y| [w - 1 - x, y]);
    let expected = ["mirrored.png: is mirrored left to right", "truth.json"];
    assert_refused("contrast patches, mirrored left to right", cdp(&mirrored), &expected);
    let flipped = redrawn(&shot, "flipped.png", size, |[_, h], x, y| [x, h - 1 - y]);
    assert_refused("mirrored top to bottom", cdp(&flipped), &["flipped.png: is mirrored top to bottom"]);
    let turned = redrawn(&shot, "turned.png", size, |[w, h], x, y| [w - 1 - x, h - 1 - y]);
    assert_refused("turned by 180°", cdp(&turned), &["turned.png: is rotated by 180°"]);
    let quarter = redrawn(&shot, "quarter.png", [120, 160], |_, x, y| [y, x]);
    assert_refused("turned by 90°", cdp(&quarter), &["quarter.png: 120 × 160 pixels", "or rotated by 90°"]);
    let other = RenderedChart::new("siemens-star", MONO, &[], &["--spp", "16"]);
    let other = redrawn_into(&shot, &other, "other.png", size, |_, x, y| [x, y]);
    assert_refused("another chart, a star", cdp(&other), &["does not show this chart"]);
    let frames: Vec<&str> = [mirrored.as_str(); 8].to_vec();
    let noise = ["measure", "noise"].into_iter().chain(frames).chain(["--truth"]);
    let noise = etendue(noise.map(str::to_owned).chain([shot.truth()]));
    assert_refused("eight mirrored frames, noise", noise, &["mirrored left to right"]);
    let caption = "A rendered chart of contrast patches with rearranged pixels, measured by `cdp`. Dots and mirrored axes are in docs/evidence/faults.md.";
    check("Images of charts", caption, &rows);
}

#[test]
fn a_colour_chart_that_is_turned_is_named_as_such() {
    let shot = RenderedChart::new("colorchecker", BAYER, &[], &["--spp", "64"]);
    let turned = redrawn(&shot, "turned.png", [160, 120], |[w, h], x, y| [w - 1 - x, h - 1 - y]);
    // For a turned mosaic the tile is also turned.
    let run = ["measure", "colour", &turned, "--cfa", "BGGR", "--truth", &shot.truth()];
    etendue(run).refused(&["turned.png: is rotated by 180°"]);
    let steps = RenderedChart::new("oecf-steps", MONO, &["--steps", "8", "--density", "1.5"], &["--spp", "64"]);
    let mirrored = redrawn(&steps, "mirrored.png", [160, 120], |[w, _], x, y| [w - 1 - x, y]);
    etendue(["measure", "oecf", &mirrored, "--truth", &steps.truth()]).refused(&["mirrored left to right"]);
}
