//! Our flow and disparity files as OpenCV reads them (tests/oracles/read_flow.py).

use std::fs;
use std::path::{Path, PathBuf};

use etendue_core::Plane;
use etendue_core::quantity::{Disparity, OpticalFlow};
use etendue_io::correspondence::{encode_flo, encode_kitti_disparity, encode_kitti_flow, encode_pfm};
use serde_json::Value;

const FLOW: [[f32; 2]; 6] =
    [[0.0, 0.0], [1.5, -2.25], [f32::NAN, f32::NAN], [-511.75, 511.5], [1e-3, 3.0e4], [100.125, -0.015_625]];
const DISPARITY: [f32; 6] = [0.0, 1.0, f32::NAN, 255.5, 37.003_906, 1e4];

fn figures(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures").join(name)
}

fn samples() -> [(&'static str, Vec<u8>); 4] {
    let flow = Plane::<OpticalFlow>::from_samples(3, 2, FLOW.to_vec()).expect("six pixels");
    let disparity = Plane::<Disparity>::from_samples(3, 2, DISPARITY.to_vec()).expect("six pixels");
    [
        ("flow.flo", encode_flo(&flow).expect("encodable")),
        ("flow_kitti.png", encode_kitti_flow(&flow).expect("encodable")),
        ("disparity_kitti.png", encode_kitti_disparity(&disparity).expect("encodable")),
        ("disparity.pfm", encode_pfm(3, &DISPARITY).expect("encodable")),
    ]
}

#[test]
fn bytes_are_those_of_the_stored_samples() {
    for (name, bytes) in samples() {
        let fresh = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        fs::write(&fresh, &bytes).expect("write");
        let stored = fs::read(figures(name)).unwrap_or_default();
        let advice = "differs from the stored sample; if it should, copy it there and run tests/oracles/read_flow.py";
        assert!(bytes == stored, "{} {advice}", fresh.display());
    }
}

/// Numbers of OpenCV, row by row; those without a JSON number are NaN or infinite, as the text states.
fn read(name: &str) -> Vec<f64> {
    let text = fs::read_to_string(figures("read_flow.json")).expect("figures");
    let figures: Value = serde_json::from_str(&text).expect("JSON");
    let number = |v: &Value| v.as_f64().or_else(|| v.as_str()?.parse().ok()).expect("a number");
    figures[name].as_array().expect("numbers").iter().map(number).collect()
}

#[test]
fn opencv_reads_the_flow_that_was_written() {
    let flo = read("flow.flo");
    assert_eq!(flo.len(), 12);
    for (read, written) in flo.chunks(2).zip(FLOW) {
        let expected = if written[0].is_nan() { [1e10; 2] } else { written.map(f64::from) };
        assert_eq!(read, expected);
    }
    // 30 000 px exceed the range of KITTI's file: unknown.
    let known = [true, true, false, true, false, true];
    for ((read, written), known) in read("flow_kitti.png").chunks(3).zip(FLOW).zip(known) {
        assert_eq!(read[2], f64::from(u8::from(known)));
        let px = |number: f64| (number - 32_768.0) / 64.0;
        let close = (0..2).all(|i| (px(read[i]) - f64::from(written[i])).abs() <= 0.5 / 64.0);
        assert!(close || !known, "{read:?} {written:?}");
    }
}

#[test]
fn opencv_reads_the_disparity_that_was_written() {
    assert_eq!(read("disparity_kitti.png"), [1.0, 256.0, 0.0, 65_408.0, 9_473.0, 0.0]);
    for (read, written) in read("disparity.pfm").iter().zip(DISPARITY) {
        assert_eq!(*read, if written.is_nan() { f64::INFINITY } else { f64::from(written) });
    }
}
