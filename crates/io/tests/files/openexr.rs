//! Our EXR files as read by OpenEXR (tests/oracles/read_exr.py), and a file of OpenEXR as we read it.

use std::fs;
use std::path::{Path, PathBuf};

use etendue_core::quantity::{Identity, Length, Quantity, Radiance, Vector};
use etendue_core::{Bands, Plane, SpectralCube};
use etendue_io::Provenance;
use etendue_io::exr::{GroundTruth, SpectralImage, encode_ground_truth, encode_spectral, read_spectral};
use serde_json::{Value, json};

fn figures(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures").join(name)
}

fn provenance() -> Provenance {
    Provenance {
        plan_hash: "00ff".to_owned(),
        seed: u64::MAX,
        version: "0.1.0".to_owned(),
        camera: "front".to_owned(),
        time_s: 0.04,
        geometry: "rectilinear, pixel centres at + 0.5".to_owned(),
        camera_to_world: Some([[0.0, 0.0, 1.0, 2.5], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 1.6]]),
        ..Provenance::default()
    }
}

const VALUES: [f32; 6] = [0.0, 1.0, 0.5, 1e-9, 1e6, 1.0 / 3.0];
const LENGTHS: [f32; 6] = [0.25, 1e-3, 3.0, f32::INFINITY, 1e5, 7.0];
const IDS: [u32; 6] = [0, 1, 26_003, 16_777_217, 5, u32::MAX];

fn cube<Q: Quantity<Sample = f32>>(scale: f32) -> SpectralCube<Q> {
    let bands = Bands::covering(500.0, 515.0, 5.0).expect("three bands");
    let plane =
        |i: usize| Plane::from_samples(3, 2, VALUES.map(|v| scale * v + i as f32).to_vec()).expect("six pixels");
    SpectralCube::from_planes(bands, (0..3).map(plane).collect()).expect("one plane per band")
}

fn spectral() -> Vec<u8> {
    encode_spectral(&cube::<Radiance>(1.0), Some(&cube(0.125)), &provenance()).expect("encodable")
}

fn ground_truth() -> Vec<u8> {
    let lengths = Plane::<Length>::from_samples(3, 2, LENGTHS.to_vec()).expect("six pixels");
    let vectors = Plane::<Vector>::filled(3, 2, [0.0, 0.6, -0.8]);
    let ids = Plane::<Identity>::from_samples(3, 2, IDS.to_vec()).expect("six pixels");
    let truth = GroundTruth {
        depth: Some(&lengths),
        distance: Some(&lengths),
        normal: Some(&vectors),
        position: Some(&vectors),
        position_low: None,
        camera_space_position: None,
        instance: Some(&ids),
        semantic: Some(&ids),
        material: Some(&ids),
        ray: None,
        mirror: None,
    };
    encode_ground_truth(&truth, &provenance()).expect("encodable")
}

/// The encoder orders headers at random, differently in each thread and process: equality with a stored file detects both.
fn equals_stored(bytes: &[u8], name: &str) {
    let fresh = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&fresh, bytes).expect("write");
    let stored = fs::read(figures(name)).unwrap_or_default();
    let advice = "differs from the stored sample; if it should, copy it there and run tests/oracles/read_exr.py";
    assert!(bytes == stored, "{} {advice}", fresh.display());
}

#[test]
fn spectral_bytes_are_those_of_the_stored_sample() {
    equals_stored(&spectral(), "spectral.exr");
    assert_eq!(std::thread::spawn(spectral).join().expect("no panic"), spectral());
}

#[test]
fn ground_truth_bytes_are_those_of_the_stored_sample() {
    equals_stored(&ground_truth(), "ground_truth.exr");
}

fn stored_figures(file: &str) -> Value {
    let text = fs::read_to_string(figures("exr.json")).expect("stored figures");
    serde_json::from_str::<Value>(&text).expect("JSON")[file].clone()
}

/// The figures' numbers as the 32-bit floats that they are (serde_json may miss the last of 64 bits).
fn floats(figures: &Value) -> Vec<f32> {
    let float = |v: &Value| v.as_f64().map_or_else(|| v.as_str().and_then(|t| t.parse().ok()), |v| Some(v as f32));
    figures.as_array().expect("values").iter().map(|v| float(v).expect("a number")).collect()
}

#[test]
fn openexr_reads_our_spectral_image() {
    let expected = stored_figures("spectral");
    for (scale, layer) in [(1.0, "S0"), (0.125, "variance.S0")] {
        for (plane, nm) in cube::<Radiance>(scale).planes().iter().zip(["502,500000", "507,500000", "512,500000"]) {
            let channel = &expected["channels"][format!("{layer}.{nm}nm")];
            assert_eq!(channel["type"], "float32");
            assert_eq!(floats(&channel["values"]), plane.samples(), "{layer} {nm}");
        }
    }
    let names: Vec<&str> = expected["channels"].as_object().expect("channels").keys().map(String::as_str).collect();
    assert_eq!(names.len(), 9, "three bands, their variances, a preview: {names:?}");
    let header = &expected["header"];
    assert_eq!(header["spectralLayoutVersion"], "1.0");
    assert_eq!(header["emissiveUnits"], "W.m^-2.sr^-1");
    assert_eq!(header["etendue:units"], "W.m^-2.sr^-1.nm^-1");
    assert_eq!(header["etendue:quantity"], "spectral radiance");
    assert_eq!(header["etendue:band_width_nm"], "5");
    assert_eq!(header["etendue:seed"], "18446744073709551615");
    assert_eq!(header["etendue:camera_to_world"], "0 0 1 2.5; -1 0 0 0; 0 -1 0 1.6");
    assert!(header["compression"].as_str().is_some_and(|c| c.contains("ZIP_COMPRESSION")));
    assert_eq!(expected["height_width"], json!([2, 3]));
}

#[test]
fn openexr_reads_our_ground_truth() {
    let channels = &stored_figures("ground_truth")["channels"];
    for name in ["depth.Z", "distance.Z"] {
        assert_eq!(channels[name]["type"], "float32", "{name}");
        assert_eq!(floats(&channels[name]["values"]), LENGTHS, "{name}");
    }
    for name in ["instance.ID", "semantic.ID", "material.ID"] {
        assert_eq!(channels[name], json!({ "type": "uint32", "values": IDS }), "{name}");
    }
    for (axis, value) in [("X", 0.0), ("Y", 0.6), ("Z", -0.8)] {
        assert_eq!(floats(&channels[format!("N.{axis}")]["values"]), [value; 6]);
        assert_eq!(floats(&channels[format!("P.{axis}")]["values"]), [value; 6]);
    }
}

#[test]
fn we_read_a_spectral_image_of_openexr() {
    let file = read_spectral(&figures("other_writer.exr")).unwrap_or_else(|e| panic!("{e}"));
    let SpectralImage::Radiance(image) = file.image else { panic!("radiance") };
    assert_eq!(image.cube.bands(), Bands::new(425.0, 50.0, 4).expect("four bands"));
    for (band, plane) in image.cube.planes().iter().enumerate() {
        assert_eq!(plane.samples(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|v| v + band as f32));
    }
    assert_eq!((image.variance, file.provenance), (None, None));
    assert_eq!(file.notes.len(), 2, "{:?}", file.notes);
    assert!(file.notes[0].contains("another program") && file.notes[1].contains("polarisation"));
}
