//! Seeded geometric defects: distortion, centre, focal length, axes, channels.

use super::{Bench, CAMERA, COLOUR, Compared, flagged, sound};
use crate::support::{etendue, text};
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_io::photograph::Encoding;
use etendue_io::picture::read_picture;
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

fn distortion(bench: &Bench, picture: &Path) -> Compared {
    let picture = text(picture);
    bench.beside(&["distortion", &picture, "--target", "dots", "--centre-px", "197.25,143.5"], CAMERA, &[])
}

fn focal(bench: &Bench, picture: &Path, pitch: &str) -> Compared {
    let picture = text(picture);
    let chart = ["focal", &picture, "--target", "dots", "--pitch-mm", pitch, "--distance-mm", "10000"];
    let known = ["--distance-uncertainty-mm", "1", "--principal-px", "197.25,143.5", "--square-pixels"];
    let model = ["--model", "radial", "--pixel-pitch-um", "8.3"];
    bench.beside(&[&chart[..], &known, &model].concat(), CAMERA, &[])
}

#[test]
fn faults_of_distortion_centre_focal_length_and_axes_are_flagged() {
    let bench = Bench::new();
    // Many points: with few large dots, position errors of pixels are shared by rows.
    let chart = bench.chart("dots", CAMERA, &["--columns", "33"]);
    let pitch = pitch_mm(&chart);
    let render = |name: &str, fault: &[&str]| {
        let options = [&["--set", SPP, "--seed", SEED], fault].concat();
        bench.rendered(&chart, name, &options).join("picture.0000.png")
    };
    let healthy = render("healthy", &[]);
    let curve = distortion(&bench, &healthy);
    let length = focal(&bench, &healthy, &pitch);
    sound(&curve);
    sound(&length);
    let with = |name: &str, key: &str| render(name, &["--set", &format!("cameras.camera.{key}")]);

    let faulty = distortion(&bench, &with("k1", "lens.distortion.k1=-0.101"));
    flagged("k1 + 1 %", "`lens.distortion.k1` −0.101 for −0.1", "forward_k1", &faulty, &curve);
    let faulty = distortion(&bench, &with("centre", "sensor.principal_point_px=[197.75,143.5]"));
    flagged("centre + 0.5 px", "`sensor.principal_point_px` 197.75 for 197.25", "forward_centre_x_px", &faulty, &curve);
    let faulty = focal(&bench, &with("focal", "lens.focal_length_mm=2.4072"), &pitch);
    flagged("focal length + 0.3 %", "`lens.focal_length_mm` 2.4072 for 2.4", "fx_px", &faulty, &length);

    let mirrored = redrawn(&bench, &healthy, "mirrored.png", |p| p.size, |p, x, y| p.at(p.size[0] - 1 - x, y));
    refused("mirrored axis", "the image mirrored left to right", &mirrored);
    let exchanged = |p: &Picture| [p.size[1], p.size[0]];
    let transposed = redrawn(&bench, &healthy, "transposed.png", exchanged, |p, x, y| p.at(y, x));
    refused("transposed axis", "columns and rows of the image exchanged", &transposed);
    let turned =
        redrawn(&bench, &healthy, "turned.png", |p| p.size, |p, x, y| p.at(p.size[0] - 1 - x, p.size[1] - 1 - y));
    let seeded = "the image rotated by 180°";
    flagged("both axes turned", seeded, "forward_centre_x_px", &distortion(&bench, &turned), &curve);
}

/// The chart's marks reveal a mirrored axis, wherever the centre lies.
fn refused(fault: &str, seeded: &str, picture: &Path) {
    etendue(["measure", "distortion", &text(picture), "--target", "dots"])
        .refused(&["shows its chart mirrored", "dots"]);
    super::row(fault, &format!("| {fault} | {seeded} | the chart's marks: refused | – | – | – |"));
}

/// Half a pixel: each red value is the mean of its own and the next.
#[test]
fn a_channel_that_is_shifted_is_flagged() {
    let bench = Bench::new();
    let chart = bench.chart("dots", COLOUR, &["--columns", "17"]);
    let picture = bench.rendered(&chart, "render", &["--set", SPP, "--seed", SEED]).join("picture.0000.png");
    let shifted = redrawn(
        &bench,
        &picture,
        "shifted.png",
        |p| p.size,
        |p, x, y| {
            let [[r, g, b], [next, ..]] = [p.at(x, y), p.at((x + 1).min(p.size[0] - 1), y)];
            [0.5 * (r + next), g, b]
        },
    );
    let chromatic = |file: &Path| bench.beside(&["chromatic", &text(file), "--target", "dots"], COLOUR, &[]);
    let healthy = chromatic(&picture);
    sound(&healthy);
    let seeded = "red of the developed image half a pixel to the left";
    flagged("channel shifted by 0.5 px", seeded, "red_shift_x_px", &chromatic(&shifted), &healthy);
}

/// Pixels of an image.
struct Picture {
    size: [usize; 2],
    pixels: Vec<[f32; 3]>,
}

impl Picture {
    fn of(file: &Path) -> Self {
        let picture = read_picture(file).expect("a picture");
        let share = |v: u8| f32::from(v) / 255.0;
        let pixels = match &picture.pixels {
            ImagePixels::Rgb8(pixels) => pixels.iter().map(|p| p.map(share)).collect(),
            ImagePixels::Gray8(pixels) => pixels.iter().map(|p| [share(*p); 3]).collect(),
            other => panic!("{} pixels of another kind", other.len()),
        };
        Self { size: [picture.width, picture.height].map(|n| n as usize), pixels }
    }

    fn at(&self, x: usize, y: usize) -> [f32; 3] {
        self.pixels[y * self.size[0] + x]
    }
}

/// An image of a given size, each pixel from a pixel of another image.
fn redrawn(
    bench: &Bench,
    file: &Path,
    name: &str,
    size: impl Fn(&Picture) -> [usize; 2],
    of: impl Fn(&Picture, usize, usize) -> [f32; 3],
) -> PathBuf {
    let picture = Picture::of(file);
    let [w, h] = size(&picture);
    let samples = (0..w * h).map(|i| of(&picture, i % w, i / w)).collect();
    let plane = Plane::<Display>::from_samples(w, h, samples).expect("a rectangle");
    let file = bench.path(name);
    std::fs::write(&file, encode_display(&plane, &Encoding::Srgb).expect("a picture")).expect("a temporary file");
    file
}
