//! Seeded geometric defects: distortion, centre, focal length, axes, channels.

use super::{CAMERA, COLOUR, ComparedQuantities, TestFolder, assert_flagged, assert_none_flagged};
use crate::support::{etendue, text};
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_io::photograph::Encoding;
use etendue_io::picture::read_image;
use etendue_io::png::encode_display;
use etendue_scene::asset::ImagePixels;
use serde_json::Value;
use std::path::{Path, PathBuf};

const SPP: &str = "render.spp=32";
const SEED: &str = "2";

/// The pitch of a chart of dots, mm.
fn pitch_mm(chart: &Path) -> String {
    let truth = std::fs::read_to_string(chart.join("truth.json")).expect("truth");
    let truth: Value = serde_json::from_str(&truth).expect("JSON");
    truth["sizes"]["pitch_mm"].as_f64().expect("a pitch").to_string()
}

fn distortion(folder: &TestFolder, image: &Path) -> ComparedQuantities {
    let image = text(image);
    folder.compare_with_declaration(
        &["distortion", &image, "--target", "dots", "--centre-px", "197.25,143.5"],
        CAMERA,
        &[],
    )
}

fn focal(folder: &TestFolder, image: &Path, pitch: &str) -> ComparedQuantities {
    let image = text(image);
    let chart = ["focal", &image, "--target", "dots", "--pitch-mm", pitch, "--distance-mm", "10000"];
    let known = ["--distance-uncertainty-mm", "1", "--principal-px", "197.25,143.5", "--square-pixels"];
    let model = ["--model", "radial", "--pixel-pitch-um", "8.3"];
    folder.compare_with_declaration(&[&chart[..], &known, &model].concat(), CAMERA, &[])
}

#[test]
fn faults_of_distortion_centre_focal_length_and_axes_are_flagged() {
    let folder = TestFolder::new();
    // Many points: with few large dots, position errors of pixels are shared by rows.
    let chart = folder.chart("dots", CAMERA, &["--columns", "33"]);
    let pitch = pitch_mm(&chart);
    let render = |name: &str, changes: &[&str]| {
        let options = [&["--set", SPP, "--seed", SEED], changes].concat();
        folder.rendered(&chart, name, &options).join("picture.0000.png")
    };
    let healthy = render("healthy", &[]);
    let curve = distortion(&folder, &healthy);
    let length = focal(&folder, &healthy, &pitch);
    assert_none_flagged(&curve);
    assert_none_flagged(&length);
    let with = |name: &str, key: &str| render(name, &["--set", &format!("cameras.camera.{key}")]);

    let defective = distortion(&folder, &with("k1", "lens.distortion.k1=-0.101"));
    assert_flagged("k1 + 1 %", "`lens.distortion.k1` −0.101 for −0.1", "forward_k1", &defective, &curve);
    let defective = distortion(&folder, &with("centre", "sensor.principal_point_px=[197.75,143.5]"));
    assert_flagged(
        "centre + 0.5 px",
        "`sensor.principal_point_px` 197.75 for 197.25",
        "forward_centre_x_px",
        &defective,
        &curve,
    );
    let defective = focal(&folder, &with("focal", "lens.focal_length_mm=2.4072"), &pitch);
    assert_flagged("focal length + 0.3 %", "`lens.focal_length_mm` 2.4072 for 2.4", "fx_px", &defective, &length);

    let mirrored = redrawn(&folder, &healthy, "mirrored.png", |p| p.size, |p, x, y| p.at(p.size[0] - 1 - x, y));
    refused("mirrored axis", "the image mirrored left to right", &mirrored);
    let exchanged = |p: &TestImage| [p.size[1], p.size[0]];
    let transposed = redrawn(&folder, &healthy, "transposed.png", exchanged, |p, x, y| p.at(y, x));
    refused("transposed axis", "columns and rows of the image exchanged", &transposed);
    let turned =
        redrawn(&folder, &healthy, "turned.png", |p| p.size, |p, x, y| p.at(p.size[0] - 1 - x, p.size[1] - 1 - y));
    let seeded = "the image rotated by 180°";
    assert_flagged("both axes turned", seeded, "forward_centre_x_px", &distortion(&folder, &turned), &curve);
}

/// The chart's marks reveal a mirrored axis, wherever the centre lies.
fn refused(defect: &str, seeded: &str, image: &Path) {
    etendue(["measure", "distortion", &text(image), "--target", "dots"]).refused(&["shows its chart mirrored", "dots"]);
    super::assert_in_page(defect, &format!("| {defect} | {seeded} | the chart's marks: refused | – | – | – |"));
}

/// Half a pixel: each red value is the mean of its own and the next.
#[test]
fn a_channel_that_is_shifted_is_flagged() {
    let folder = TestFolder::new();
    let chart = folder.chart("dots", COLOUR, &["--columns", "17"]);
    let image = folder.rendered(&chart, "render", &["--set", SPP, "--seed", SEED]).join("picture.0000.png");
    let shifted = redrawn(
        &folder,
        &image,
        "shifted.png",
        |p| p.size,
        |p, x, y| {
            let [[r, g, b], [next, ..]] = [p.at(x, y), p.at((x + 1).min(p.size[0] - 1), y)];
            [0.5 * (r + next), g, b]
        },
    );
    let chromatic =
        |file: &Path| folder.compare_with_declaration(&["chromatic", &text(file), "--target", "dots"], COLOUR, &[]);
    let healthy = chromatic(&image);
    assert_none_flagged(&healthy);
    let seeded = "red of the developed image half a pixel to the left";
    assert_flagged("channel shifted by 0.5 px", seeded, "red_shift_x_px", &chromatic(&shifted), &healthy);
}

/// Pixels of an image.
struct TestImage {
    size: [usize; 2],
    pixels: Vec<[f32; 3]>,
}

impl TestImage {
    fn read(file: &Path) -> Self {
        let image = read_image(file).expect("a picture");
        let fraction = |v: u8| f32::from(v) / 255.0;
        let pixels = match &image.pixels {
            ImagePixels::Rgb8(pixels) => pixels.iter().map(|p| p.map(fraction)).collect(),
            ImagePixels::Gray8(pixels) => pixels.iter().map(|p| [fraction(*p); 3]).collect(),
            other => panic!("{} pixels of another kind", other.len()),
        };
        Self { size: [image.width, image.height].map(|n| n as usize), pixels }
    }

    fn at(&self, x: usize, y: usize) -> [f32; 3] {
        self.pixels[y * self.size[0] + x]
    }
}

/// An image of a given size, each pixel from a pixel of another image.
fn redrawn(
    folder: &TestFolder,
    file: &Path,
    name: &str,
    size: impl Fn(&TestImage) -> [usize; 2],
    of: impl Fn(&TestImage, usize, usize) -> [f32; 3],
) -> PathBuf {
    let image = TestImage::read(file);
    let [w, h] = size(&image);
    let samples = (0..w * h).map(|i| of(&image, i % w, i / w)).collect();
    let plane = Plane::<Display>::from_samples(w, h, samples).expect("a rectangle");
    let file = folder.path(name);
    std::fs::write(&file, encode_display(&plane, &Encoding::Srgb).expect("a picture")).expect("a temporary file");
    file
}
