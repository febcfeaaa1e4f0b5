//! Raw files in other programs (tests/oracles/raw_files.py): their results, and equality of the files.

use crate::support::{contents, etendue, root, text};
use serde_json::{Value, json};
use std::collections::BTreeMap;

const CHART: &str = "tests/oracles/figures/raw_files/chart.toml";
const PHASES: [&str; 4] = ["rggb", "bggr", "grbg", "gbrg"];

fn figures() -> Value {
    let path = root().join("tests/oracles/figures/raw_files.json");
    serde_json::from_str(&std::fs::read_to_string(path).expect("the figures")).expect("JSON")
}

/// The files of one camera of the chart.
fn captured_files(camera: &str, settings: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    let settings = settings.iter().flat_map(|s| ["--set", s]);
    etendue(["render", CHART, "--camera", camera, "-o", &out].into_iter().chain(settings)).ok();
    contents(&place.path().join("out").join(camera))
}

/// The tags of a little-endian TIFF: type, count and the bytes of the value.
fn tags(file: &[u8]) -> BTreeMap<u16, (u16, Vec<u8>)> {
    let word = |i: usize| u16::from_le_bytes([file[i], file[i + 1]]);
    let long = |i: usize| u32::from_le_bytes(file[i..i + 4].try_into().expect("four bytes")) as usize;
    let start = long(4);
    let entry = |k: usize| {
        let at = start + 2 + 12 * k;
        let size = [0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8][usize::from(word(at + 2))];
        let length = size * long(at + 4);
        let from = if length <= 4 { at + 8 } else { long(at + 8) };
        (word(at), (word(at + 2), file[from..from + length].to_vec()))
    };
    (0..usize::from(word(start))).map(entry).collect()
}

fn longs(value: &(u16, Vec<u8>)) -> Vec<u64> {
    let width = if value.0 == 3 { 2 } else { 4 };
    let number = |bytes: &[u8]| bytes.iter().rev().fold(0, |n, b| n * 256 + u64::from(*b));
    value.1.chunks(width).map(number).collect()
}

/// The digital numbers of a file of 16 bits.
fn numbers(file: &[u8]) -> Vec<u64> {
    let tags = tags(file);
    let (from, length) = (longs(&tags[&273])[0] as usize, longs(&tags[&279])[0] as usize);
    file[from..from + length].chunks(2).map(|b| u64::from(u16::from_le_bytes([b[0], b[1]]))).collect()
}

/// LibRaw's phase, levels, area and numbers; and its own development next to ours.
#[test]
fn a_raw_reader_shows_the_right_picture() {
    let figures = figures();
    for phase in PHASES {
        let actual = &figures["bayer"][phase];
        assert_eq!(actual["pattern"], phase);
        assert_eq!(actual["black"], json!([256, 256, 256, 256]), "{phase}");
        // 30 000 e⁻ at 0.5 DN/e⁻ above black.
        assert_eq!((&actual["white"], &actual["visible"]), (&json!(15_256), &json!([4, 6, 144, 96])), "{phase}");
        assert_eq!(actual["raw_is_tiff"], true, "{phase}");
        let number = |key: &str| actual[key].as_f64().expect("a number");
        // Two demosaicing methods and roundings of a noisy 8-bit image: a third of the visibility threshold.
        assert!(number("delta_e_mean") < 0.25 && number("delta_e_worst") < 0.5, "{phase}: {actual}");
        // Means of 144 pixels with 1 % of noise, of a quarter of them for red and blue; no factor of brightness.
        assert!(number("neutral_off") < 0.015 && (number("scale") - 1.0).abs() < 0.002, "{phase}: {actual}");
    }
    let mono = &figures["mono"];
    assert_eq!((&mono["visible"], &mono["raw_is_tiff"]), (&json!([5, 3, 144, 96]), &json!(true)));
    assert!((mono["mean_over_ours"].as_f64().expect("a number") - 1.0).abs() < 1e-3, "{mono}");
    let deep = &figures["tiff_32"];
    assert_eq!((&deep["bits"], &deep["pillow"], &deep["opencv"]), (&json!(32), &json!(true), &json!(true)));
    assert!(deep["largest"].as_u64() > Some(65_535), "{deep}");
    let exr = &figures["exr"];
    assert_eq!(exr["signal_breakdown"].as_array().map(Vec::len), Some(10));
    assert_eq!((&exr["signal_is_electrons"], &exr["raw_without_breakdown_is_the_same"]), (&json!(true), &json!(true)));
    // Layers are f32, of up to 30 000 electrons.
    assert!(exr["largest_difference_of_the_sum_e"].as_f64() < Some(0.01), "{exr}");
}

#[test]
fn the_files_that_it_read_are_still_those() {
    let figures = figures();
    let colour = |c: char| "rgb".find(c).expect("a colour") as u64;
    for phase in PHASES {
        let files =
            captured_files("camera", &[&format!("cameras.camera.sensor.cfa=\"{phase}\""), "output.picture=false"]);
        let dng = &files["raw.0000.dng"];
        let (tags, numbers) = (tags(dng), numbers(dng));
        let sums = [numbers.iter().sum::<u64>(), numbers.iter().map(|n| n * n).sum()];
        assert_eq!(json!(sums), figures["bayer"][phase]["sum_and_sum_of_squares"], "{phase}");
        // Size and colours of the tile; from the first pixel of the active area, which holds complete tiles.
        assert_eq!(longs(&tags[&33_421]), [2, 2]);
        assert_eq!(
            tags[&33_422].1.iter().map(|b| u64::from(*b)).collect::<Vec<_>>(),
            phase.chars().map(colour).collect::<Vec<_>>()
        );
        assert_eq!(longs(&tags[&50_829]), [6, 4, 102, 148]);
        assert_eq!((longs(&tags[&50_714]), longs(&tags[&50_717])), (vec![2_560_000, 10_000], vec![15_256]));
    }
}

#[test]
fn odd_rows_and_columns_of_optical_black_stand_before_a_mono_picture() {
    let dng = &captured_files("mono", &[])["raw.0000.dng"];
    let tags = tags(dng);
    assert_eq!((longs(&tags[&256]), longs(&tags[&257])), (vec![149], vec![99]));
    assert_eq!(longs(&tags[&50_829]), [3, 5, 99, 149]);
    let numbers = numbers(dng);
    let mean = |part: &dyn Fn(usize, usize) -> bool| {
        let chosen: Vec<u64> = (0..numbers.len()).filter(|i| part(i % 149, i / 149)).map(|i| numbers[i]).collect();
        chosen.iter().sum::<u64>() as f64 / chosen.len() as f64
    };
    // Outside the area there is the black level, read noise 1.5 DN and DSNU 1 DN over 912 pixels; within it even the darkest patch is lit.
    assert!((mean(&|x, y| x < 5 || y < 3) - 256.0).abs() < 0.3);
    assert!(mean(&|x, y| x == 5 && y >= 3) > 300.0 && mean(&|x, y| x >= 5 && y == 3) > 300.0);
}

/// With a mosaic, optical black that would shift its tile is refused.
#[test]
fn odd_rows_of_optical_black_before_a_mosaic_are_refused() {
    etendue(["plan", CHART, "--camera", "camera", "--set", "cameras.camera.sensor.optical_black.rows_px=3"])
        .refused(&["chart.toml", "optical_black", "multiples of 2"]);
}
