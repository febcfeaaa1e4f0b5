//! `etendue measure distortion`, `focal`, `chromatic` and `etendue calibrate`.

use crate::support::{etendue, root, text};
use etendue_core::Plane;
use etendue_core::maths::f64::{atan, sin_cos};
use etendue_core::quantity::{DigitalNumber, Display};
use etendue_io::photograph::Encoding;
use etendue_io::png::{encode_display, encode_raw16};
use serde_json::Value;
use std::path::Path;

/// One of OpenCV's photographs: tests/oracles/checkerboard.py.
fn photograph() -> String {
    text(&root().join("tests/oracles/figures/checkerboard/left01.jpg"))
}

fn json(arguments: &[&str]) -> Value {
    let arguments = arguments.iter().copied().chain(["--json"]);
    serde_json::from_str(&etendue(arguments).ok().out).expect("JSON")
}

fn figure(report: &Value, key: &str) -> [f64; 2] {
    let number = |part: &str| report["figures"][key][part].as_f64();
    let value = number("value").unwrap_or_else(|| panic!("{key} is missing in {report}"));
    [value, number("standard_uncertainty").unwrap_or(f64::INFINITY)]
}

/// An image of brightness 0 to 1, each pixel the mean of 16 samples.
fn picture(folder: &Path, name: &str, [w, h]: [usize; 2], brightness: impl Fn(f64, f64) -> f64) -> String {
    let pixel = |i: usize| {
        let at = |k: usize| (k as f64 + 0.5) / 4.0;
        let samples = (0..16).map(|k| brightness((i % w) as f64 + at(k % 4), (i / w) as f64 + at(k / 4)));
        (60_000.0 * samples.sum::<f64>() / 16.0).round() as u32
    };
    let plane = Plane::<DigitalNumber>::from_samples(w, h, (0..w * h).map(pixel).collect()).expect("a rectangle");
    let file = folder.join(name);
    std::fs::write(&file, encode_raw16(&plane).expect("a picture")).expect("a temporary file");
    text(&file)
}

/// Discs of a quarter of the step about whole numbers.
fn dot(x: f64, y: f64) -> f64 {
    let (u, v) = (x - x.round(), y - y.round());
    if u * u + v * v < 0.0625 { 0.1 } else { 0.9 }
}

const SIZE: [usize; 2] = [400, 300];
const HALF_DIAGONAL_PX: f64 = 250.0;

#[test]
fn the_distortion_of_dots_is_the_one_they_were_drawn_with() {
    let folder = tempfile::tempdir().expect("a folder");
    let (k1, k2) = (0.12, 0.02);
    let file = picture(folder.path(), "dots.png", SIZE, |x, y| {
        let (u, v) = ((x - 200.0) / HALF_DIAGONAL_PX, (y - 150.0) / HALF_DIAGONAL_PX);
        let r2 = u * u + v * v;
        let scale = HALF_DIAGONAL_PX * (1.0 + k1 * r2 + k2 * r2 * r2) / 20.0;
        dot(u * scale + 0.3, v * scale)
    });
    let camera = text(&folder.path().join("distortion.toml"));
    let plot = text(&folder.path().join("distortion.svg"));
    let report = json(&["measure", "distortion", &file, "--target", "dots", "--camera-out", &camera, "--plot", &plot]);
    for point in report["tables"]["curve"].as_array().expect("a curve") {
        let field = point["field_percent"].as_f64().expect("a number") / 100.0;
        let ratio = point["ratio"]["value"].as_f64().expect("a number");
        let want = 1.0 / (1.0 + k1 * field * field + k2 * field * field * field * field);
        // The bench's tolerance is 0.1 % of the field, for distances that are a part of it.
        assert!((ratio - want).abs() * field < 1e-3, "{field}: {ratio} {want}");
    }
    assert!((figure(&report, "backward_k1")[0] - k1).abs() < 3e-3, "{report}");
    let [centre, uncertainty] = figure(&report, "backward_centre_x_px");
    assert!((centre - 200.0).abs() < 0.3 && uncertainty < 0.3, "{report}");
    let keys = std::fs::read_to_string(&camera).expect("written");
    let lens =
        "format = 1\n[lens]\ntype = \"thin\"\nfocal_length_mm = 6\nf_number = 2\nfocus_distance_m = \"infinity\"\n";
    let sensor = "[sensor]\nwidth_px = 400\nheight_px = 300\npixel_pitch_um = 6\n";
    let camera_file = folder.path().join("camera.toml");
    std::fs::write(&camera_file, format!("{lens}{keys}{sensor}")).expect("written");
    etendue(["measure", "lens", &text(&camera_file)]).ok();
    assert!(std::fs::read_to_string(&plot).expect("drawn").contains("half diagonal"));
}

/// A checkerboard of corners 0 … 8 by 0 … 5 through a pinhole of f = 320 px, turned by angles about x and y.
fn board(folder: &Path, name: &str, [about_x, about_y]: [f64; 2]) -> String {
    let ((sx, cx), (sy, cy)) = (sin_cos(about_x), sin_cos(about_y));
    // Columns of the rotation: the chart's axes in the camera's frame.
    let (a, b, n) = ([cy, sx * sy, -cx * sy], [0.0, cx, sx], [sy, -sx * cy, cx * cy]);
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    picture(folder, name, SIZE, |x, y| {
        let ray = [(x - 205.0) / 320.0, (y - 148.0) / 320.0, 1.0];
        // The chart's middle is 13 steps ahead.
        let t = 13.0 * n[2] / dot(n, ray);
        let hit = [t * ray[0], t * ray[1], t * ray[2] - 13.0];
        let (u, v) = ((dot(hit, a) + 4.0).floor() as i32, (dot(hit, b) + 2.5).floor() as i32);
        let inside = (-1..9).contains(&u) && (-1..6).contains(&v);
        if inside && (u + v).rem_euclid(2) == 0 { 0.1 } else { 0.9 }
    })
}

#[test]
fn a_pinhole_is_calibrated_from_its_views() {
    let folder = tempfile::tempdir().expect("a folder");
    let turns = [[0.0, 0.0], [0.5, 0.0], [-0.4, 0.3], [0.1, -0.5]];
    let views: Vec<String> =
        turns.iter().enumerate().map(|(i, t)| board(folder.path(), &format!("view{i}.png"), *t)).collect();
    let camera = text(&folder.path().join("camera.toml"));
    let mut arguments = vec!["calibrate"];
    arguments.extend(views.iter().map(String::as_str));
    arguments.extend(["--grid", "9x6", "--pitch-mm", "30", "--pixel-pitch-um", "6", "-o", &camera]);
    let report = json(&arguments);
    for (key, want) in [("fx_px", 320.0), ("fy_px", 320.0), ("cx_px", 205.0), ("cy_px", 148.0), ("k1", 0.0)] {
        let [value, uncertainty] = figure(&report, key);
        // Errors of 16 samples per pixel are not noise: wider than three standard uncertainties.
        assert!(
            (value - want).abs() < 5.0 * uncertainty && uncertainty < 1e-2 * (want + 1.0),
            "{key}: {value} {uncertainty}"
        );
    }
    let distance = report["tables"]["views"][0]["distance_mm"].as_f64().expect("a number");
    assert!((distance - 390.0).abs() < 0.5, "{distance}");
    etendue(["measure", "lens", &camera]).ok();
    let one = ["measure", "focal", &views[0], "--pitch-mm", "30"];
    etendue(one).refused(&["a single image does not distinguish", "--distance-mm"]);
    let at = |more: &[&str]| etendue(one.iter().chain(more).copied());
    let out = text(&folder.path().join("one.toml"));
    at(&["--distance-mm", "390", "--model", "pinhole", "--pixel-pitch-um", "6", "--camera-out", &out]).ok();
    assert!(
        std::fs::read_to_string(&out).expect("a file").starts_with("# Measured by etendue measure focal from 1 view;")
    );
    let one = json(&[&one[..], &["--distance-mm", "390", "--model", "pinhole"]].concat());
    assert!(one["notes"].to_string().contains("principal point is assumed at the image centre"), "{}", one["notes"]);
    // 2 atan(w/2f) and its slope w/(f² + w²/4), of the focal length alone.
    let [[f, u], [angle, of_angle]] = ["fx_px", "field_of_view_horizontal_deg"].map(|key| figure(&one, key));
    let half = SIZE[0] as f64 / 2.0;
    let want = (2.0 * half * u / (f * f + half * half)).to_degrees();
    assert!((angle - 2.0 * atan(half / f).to_degrees()).abs() < 1e-9, "{angle}");
    // Central differences of a tenth of u: 1e-4 at most.
    assert!((of_angle / want - 1.0).abs() < 1e-4 && want > 0.0, "{of_angle} {want}");
    etendue(["calibrate", &views[0], "--pitch-mm", "30"]).refused(&["do not determine", "fx_px", "fewer coefficients"]);
    etendue(["calibrate", &views[0], &views[1], &views[0], "--pitch-mm", "30"])
        .refused(&["identical view to", "view0.png"]);
    etendue(["calibrate", &views[0], &photograph(), "--pitch-mm", "30"]).refused(&["left01.jpg", "640 × 480"]);
    etendue(["measure", "distortion", &views[0], "--grid", "5x4"]).refused(&["9 × 6", "5 × 4"]);
}

/// A view without a chart gives no information on the camera.
#[test]
fn a_view_without_a_chart_is_omitted_and_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let turns = [[0.5, 0.0], [-0.4, 0.3], [0.1, -0.5]];
    let good = turns.iter().enumerate().map(|(i, t)| board(folder.path(), &format!("view{i}.png"), *t));
    let empty = ["wall0.png", "wall1.png"].map(|name| picture(folder.path(), name, SIZE, |x, _| 0.4 + 1e-4 * x));
    let views: Vec<String> = good.chain(empty).collect();
    let left_out = |which: &[usize]| -> Vec<&str> {
        let files = which.iter().map(|i| views[*i].as_str());
        ["calibrate"].into_iter().chain(files).chain(["--pitch-mm", "30"]).collect()
    };
    let report = json(&left_out(&[0, 3, 1, 2]));
    assert!(report["notes"].to_string().contains("wall0.png: omitted"), "{}", report["notes"]);
    assert_eq!(report["tables"]["views"].as_array().expect("views").len(), 3);
    // Two views are too few to omit others; with no valid view the first gives the reason.
    etendue(left_out(&[0, 1, 3])).refused(&["wall0.png: ", "no checkerboard or grid of dots"]);
    etendue(left_out(&[4, 3])).refused(&["wall1.png: ", "none of the 2 images shows the chart"]);
}

/// Four coefficients of a fisheye beyond the points of OpenCV's board: the results are valid, a camera file from them is not.
#[test]
fn a_camera_that_folds_outside_its_points_is_reported_without_a_file() {
    let views: Vec<String> = [1, 2, 3, 4, 5, 6]
        .map(|i| text(&root().join(format!("tests/oracles/figures/checkerboard/left{i:02}.jpg"))))
        .to_vec();
    let all = ["calibrate", "--pitch-mm", "30", "--model", "kannala-brandt"];
    let all: Vec<&str> = all.into_iter().chain(views.iter().map(String::as_str)).collect();
    let report = json(&all);
    // OpenCV with its own model and all views: 532.8 px (opencv.json); six views and another model differ by about 3 px.
    assert!((figure(&report, "fx_px")[0] - 533.0).abs() < 4.0, "{report}");
    assert!(report["notes"].to_string().contains("folds the image over"), "{}", report["notes"]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = text(&folder.path().join("camera.toml"));
    let with: Vec<&str> = all.into_iter().chain(["--pixel-pitch-um", "6", "-o", &file]).collect();
    etendue(with).refused(&["no camera file", "only figures", "folds"]);
    assert!(!Path::new(&file).exists());
}

#[test]
fn displaced_colours_are_reported_and_grey_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let level = |x: f64, y: f64, shift: f64| {
        let at = |k: usize| (k as f64 + 0.5) / 4.0;
        let samples = (0..16).map(|k| dot((x + at(k % 4) - shift) / 20.0 + 0.25, (y + at(k / 4)) / 20.0 + 0.25));
        etendue_spectra::colour::encode(samples.sum::<f64>() as f32 / 16.0)
    };
    let pixels = (0..400 * 300).map(|i| {
        let (x, y) = (f64::from(i % 400), f64::from(i / 400));
        [level(x, y, 0.4), level(x, y, 0.0), level(x, y, -0.2)]
    });
    let plane = Plane::<Display>::from_samples(400, 300, pixels.collect()).expect("a rectangle");
    let file = folder.path().join("colours.png");
    std::fs::write(&file, encode_display(&plane, &Encoding::Srgb).expect("a picture")).expect("written");
    let report = json(&["measure", "chromatic", &text(&file)]);
    // 16 samples and 8 bits: a few hundredths of a pixel.
    assert!((figure(&report, "red_largest_px")[0] - 0.4).abs() < 0.06, "{report}");
    assert!((figure(&report, "blue_largest_px")[0] - 0.2).abs() < 0.06, "{report}");
    // JSON lists every point in both colours; the text does so on request.
    let points = report["tables"]["points"].as_array().expect("points");
    let red = points.iter().find(|point| point["channel"] == "red").expect("a point in red");
    assert!(points.len() > 300 && (red["less_green_x_px"].as_f64().expect("a number") - 0.4).abs() < 0.1, "{red}");
    let text_of = |further: &[&str]| etendue([&["measure", "chromatic", &text(&file)][..], further].concat()).ok().out;
    let (short, long) = (text_of(&[]), text_of(&["--points"]));
    assert!(long.lines().count() > short.lines().count() + 300 && !short.contains("minus green"), "{short}");
    etendue(["measure", "chromatic", &photograph()]).refused(&["left01.jpg", "no channel R"]);
    let plain = picture(folder.path(), "plain.png", [64, 48], |_, _| 0.5);
    etendue(["measure", "distortion", &plain]).refused(&["plain.png", "was found"]);
}

#[test]
fn the_colours_of_a_mosaic_are_measured_where_their_pixels_are() {
    let folder = tempfile::tempdir().expect("a folder");
    // Dots about 20.3 (k − ¼, l − ¼) as green shows them, at all positions among the pixels; red, at even columns and rows, 0.4 px to the right;
    // blue, at odd ones, 0.2 px to the left.
    let file = picture(folder.path(), "mosaic.png", SIZE, |x, y| {
        let shift = match (x as usize % 2, y as usize % 2) {
            (0, 0) => 0.4,
            (1, 1) => -0.2,
            _ => 0.0,
        };
        dot((x - shift) / 20.3 + 0.25, y / 20.3 + 0.25)
    });
    let report = json(&["measure", "chromatic", &file, "--cfa", "RGGB"]);
    for (key, want) in
        [("red_shift_x_px", 0.4), ("red_shift_y_px", 0.0), ("blue_shift_x_px", -0.2), ("blue_shift_y_px", 0.0)]
    {
        let [shift, uncertainty] = figure(&report, key);
        assert!((shift - want).abs() < 3.0 * uncertainty && uncertainty < 0.02, "{key}: {shift} {uncertainty}");
    }
    for (channel, shift) in [("G", 0.0), ("red", 0.4), ("B", -0.2)] {
        let report = json(&["measure", "distortion", &file, "--cfa", "RGGB", "--channel", channel]);
        let points = report["tables"]["points"].as_array().expect("points");
        assert!(points.len() > 250, "{}", points.len());
        let off = |key: &str, shift: f64| {
            let at = |p: &Value| (p[key].as_f64().expect("a number") - shift) / 20.3 + 0.25;
            points.iter().map(|p| 20.3 * (at(p) - at(p).round())).sum::<f64>() / points.len() as f64
        };
        let (x, y) = (off("x_px", shift), off("y_px", 0.0));
        assert!(x.abs() < 0.02 && y.abs() < 0.02, "{channel}: {x} {y}");
    }
    // Mutually displaced colours deviate by their mean displacement, and in waves.
    let report = json(&["measure", "distortion", &file, "--cfa", "RGGB", "--channel", "balanced"]);
    let points = report["tables"]["points"].as_array().expect("points");
    let x = |p: &Value| (p["x_px"].as_f64().expect("a number") - 0.05) / 20.3 + 0.25;
    let off: Vec<f64> = points.iter().map(|p| 20.3 * (x(p) - x(p).round())).collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    assert!(points.len() > 250 && mean.abs() < 0.02 && off.iter().all(|x| x.abs() < 0.15), "{mean}: {off:?}");
    etendue(["measure", "distortion", &file, "--cfa", "RGGB"]).refused(&["mosaic of the colours", "--channel"]);
    etendue(["measure", "distortion", &file, "--cfa", "RGGB", "--channel", "Y"]).refused(&["no channel 'Y'"]);
}

#[test]
fn points_and_covariances_are_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = board(folder.path(), "board.png", [0.3, 0.2]);
    let arguments = ["measure", "distortion", &file];
    let report = json(&arguments);
    let covariances = report["covariances"].as_array().expect("covariances");
    for covariance in covariances {
        let number = |i: usize, j: usize| covariance["matrix"][i][j].as_f64().unwrap_or(f64::INFINITY);
        for (i, key) in covariance["of"].as_array().expect("names").iter().enumerate() {
            let u = figure(&report, key.as_str().expect("a name"))[1];
            assert!((number(i, i).sqrt() / u - 1.0).abs() < 1e-9 || u.is_infinite(), "{key}: {covariance}");
            // Cauchy and Schwarz, and symmetry.
            assert!((0..4).all(|j| number(i, j) == number(j, i) || (number(i, j) / number(j, i) - 1.0).abs() < 1e-9));
            assert!(
                (0..4).all(|j| number(i, j) * number(i, j) <= 1.0001 * number(i, i) * number(j, j)),
                "{covariance}"
            );
        }
    }
    let points = report["tables"]["points"].as_array().expect("points").len();
    let text = |more: &[&str]| etendue(arguments.iter().chain(more).copied()).ok().out.lines().count();
    assert!(points > 40 && text(&["--points"]) > text(&[]) + points, "{points}");
    assert!(
        report["figures"]["picture_height_percent"]["value"].as_f64().expect("two rows from side to side").abs() < 3.0
    );
    // Tilted by 20°, with another centre of distortion: the map excludes the tilt, and the curve is that of k1 and k2.
    let report = json(&["measure", "distortion", &photograph()]);
    assert!(!report["notes"].to_string().contains("the curve differs from k1 and k2"), "{}", report["notes"]);
}

#[test]
fn depths_of_stereo_are_read_from_float_maps() {
    let folder = tempfile::tempdir().expect("a folder");
    let map = |name: &str, depth: &dyn Fn(usize) -> f32| {
        let bytes: Vec<u8> = (0..32 * 32).flat_map(|i| depth(i).to_le_bytes()).collect();
        let file = folder.path().join(name);
        std::fs::write(&file, [b"Pf\n32 32\n-1\n".as_slice(), &bytes].concat()).expect("written");
        text(&file)
    };
    let truth = map("truth.pfm", &|i| if i % 32 == 31 { f32::INFINITY } else { 8.0 });
    let guess = map("guess.pfm", &|i| if i % 7 == 0 { f32::NAN } else { 10.0 });
    let report = json(&["measure", "depth", &guess, &truth, "--focal-base-px-m", "400"]);
    // 400 px m (1/8 − 1/10) = 10 px, a fifth of the disparity.
    assert!((figure(&report, "disparity_px")[0] - 10.0).abs() < 1e-4 && figure(&report, "d1_percent")[0] == 100.0);
    assert!((figure(&report, "scale")[0] - 1.0).abs() < 1e-9);
    let scaled = json(&["measure", "depth", &guess, &truth, "--align", "median"]);
    assert!(figure(&scaled, "rmse_m")[0] < 1e-5 && (figure(&scaled, "scale")[0] - 0.8).abs() < 1e-6);
    let plot_file = text(&folder.path().join("depth.svg"));
    etendue(["measure", "depth", &guess, &truth, "--ranges-m", "0,5,9,20", "--plot", &plot_file]).ok();
    let svg = std::fs::read_to_string(&plot_file).expect("a plot");
    assert!(["bias", "RMSE", "depth, m"].iter().all(|word| svg.contains(word)), "{svg}");
    let assert_refused = |more: &[&str], phrases: &[&str]| {
        etendue(["measure", "depth", &guess, &truth].iter().chain(more).copied()).refused(phrases);
    };
    assert_refused(&["--outlier-ratio", "nan"], &["outlier ratio", "not NaN"]);
    assert_refused(&["--edge-ratio", "-1"], &["edge ratio", "not -1"]);
    assert_refused(&["--focal-base-px-m", "0"], &["focal length times baseline"]);
    etendue(["measure", "depth", &truth, &truth]).refused(&["in every pixel"]);
}

#[test]
fn nonsense_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    // Another of OpenCV's images, without a chart but with rows and columns of dots; and a fully white image.
    let print = text(&root().join("tests/oracles/figures/checkerboard/pic4.png"));
    let white = picture(folder.path(), "white.png", SIZE, |_, _| 1.0);
    for file in [&print, &white] {
        for kind in ["distortion", "chromatic"] {
            etendue(["measure", kind, file]).refused(&[]);
        }
        for target in ["dots", "checkerboard"] {
            etendue(["measure", "distortion", file, "--target", target]).refused(&[]);
            etendue(["calibrate", file, "--pitch-mm", "30", "--target", target]).refused(&[]);
            let one = ["measure", "focal", file, "--pitch-mm", "30", "--distance-mm", "500", "--target", target];
            etendue(one).refused(&[]);
        }
    }
    // A pinhole of 320 px, 13 steps of 30 mm away: 390 mm, not 500.
    let turns = [[0.0, 0.0], [0.5, 0.0], [-0.4, 0.3], [0.1, -0.5]];
    let views: Vec<String> =
        turns.iter().enumerate().map(|(i, t)| board(folder.path(), &format!("view{i}.png"), *t)).collect();
    let all = ["measure", "focal", "--pitch-mm", "30", "--model", "pinhole", "--distance-mm", "500"];
    let all: Vec<&str> = all.into_iter().chain(views.iter().map(String::as_str)).collect();
    etendue(all).refused(&["stated distance 500", "contradicts the views, which give 3"]);
}
