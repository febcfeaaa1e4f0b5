//! The content of a page agrees with the files.

use crate::pack::tests::unpacked;
use crate::{ViewRequest, view};
use etendue::{Error, ExistingFiles, NullObserver};
use etendue_core::quantity::{Identity, Length, Radiance, Variance};
use etendue_core::{Bands, Plane, SpectralCube};
use etendue_io::Provenance;
use etendue_io::exr::{ExrLayer, GroundTruth, encode_ground_truth, encode_layers, encode_spectral};
use etendue_io::inspect::Preview;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const SIZE: (usize, usize) = (6, 4);
const PIXELS: usize = 24;

fn radiance(gain: f32) -> SpectralCube<Radiance> {
    let bands = Bands::new(400.0, 100.0, 3).expect("three bands");
    let plane = |band: usize| (0..PIXELS).map(|i| gain * (0.001 + (i * (band + 1)) as f32)).collect();
    let planes = (0..3).map(|band| Plane::from_samples(SIZE.0, SIZE.1, plane(band)).expect("pixels")).collect();
    SpectralCube::from_planes(bands, planes).expect("one plane per band")
}

fn lengths() -> Vec<f32> {
    (0..PIXELS).map(|i| if i == 5 { f32::INFINITY } else { 1.0 + i as f32 / 7.0 }).collect()
}

/// An image with blue values 3, 6, 9 …
fn test_image((width, height): (usize, usize)) -> Vec<u8> {
    let rgb = (1..=width * height).map(|i| [1, 2, 3].map(|c| (c * i) as u8)).collect();
    Preview { width, height, rgb }.to_png().expect("encoded")
}

/// A result of one camera.
fn result(folder: &Path, gain: f32) -> PathBuf {
    let front = folder.join("front");
    fs::create_dir_all(&front).expect("made");
    let write = |name: &str, bytes: Vec<u8>| fs::write(front.join(name), bytes).expect("written");
    let facts = Provenance::default();
    let cube = radiance(gain);
    let variance = SpectralCube::<Variance>::from_planes(cube.bands(), vec![Plane::filled(SIZE.0, SIZE.1, 4.0); 3]);
    write("radiance.exr", encode_spectral(&cube, variance.as_ref(), &facts).expect("encoded"));
    let depth = Plane::<Length>::from_samples(SIZE.0, SIZE.1, lengths()).expect("pixels");
    let ids = (0..PIXELS as u32).map(|i| i % 3).collect();
    let instance = Plane::<Identity>::from_samples(SIZE.0, SIZE.1, ids).expect("pixels");
    let truth = GroundTruth { depth: Some(&depth), instance: Some(&instance), ..GroundTruth::default() };
    write("ground_truth.exr", encode_ground_truth(&truth, &facts).expect("encoded"));
    let parts = [("shot", -2.0), ("signal", 100.0), ("saturated", 0.0)].map(|(name, v)| (name, vec![v; PIXELS]));
    let parts = parts.each_ref().map(|(name, plane)| ((*name).to_owned(), ExrLayer::Float(plane)));
    write("signal_breakdown.0003.exr", encode_layers(SIZE.0, SIZE.1, &parts, &facts).expect("encoded"));
    write("picture.0003.png", test_image(SIZE));
    let boxes = r#"{"width_px":6,"height_px":4,"objects":[{"id":1,"name":"a </script> ball","visible_box_px":[1,1,3,2],"amodal_box_px":null}]}"#;
    write("boxes.0003.json", boxes.into());
    let side_car =
        r#"{"program":"etendue","ground_truth":{"instances":[{"name":"floor"},{"name":"ball"}]},"files":{}}"#;
    write("camera.json", side_car.into());
    folder.to_path_buf()
}

/// The data of a page's script.
fn facts(page: &Path) -> Value {
    let html = fs::read_to_string(page).expect("a page");
    let line = html.lines().find_map(|line| line.strip_prefix("const PAGE = ")).expect("facts");
    serde_json::from_str(line.trim_end_matches(';')).expect("JSON")
}

fn layer<'a>(facts: &'a Value, result: usize, name: &str) -> &'a Value {
    let mut layers = facts["layers"].as_array().expect("layers").iter();
    layers.find(|layer| layer["name"] == name && layer["result"] == result).unwrap_or_else(|| panic!("no layer {name}"))
}

/// The numbers of a layer: from its script, or from the page itself.
fn planes(page: &Path, layer: &Value) -> Vec<Vec<f64>> {
    let id = layer["chunk"].as_str().expect("a chunk");
    let data_file = page.with_file_name("data").join(format!("{id}.js"));
    let text = match fs::read_to_string(&data_file) {
        Ok(script) => script.split('"').nth(3).expect("a text").to_owned(),
        Err(_) => {
            let html = fs::read_to_string(page).expect("a page");
            let start = html.split(&format!("id=\"data-{id}\">")).nth(1).expect("a chunk");
            start.split('<').next().expect("its text").to_owned()
        }
    };
    let stored = layer["planes"].as_array().expect("planes");
    let types: Vec<_> =
        stored.iter().map(|p| (p["type"].as_str().expect("a type"), p["scale"].as_f64().unwrap_or(1.0))).collect();
    let pixels = ["width", "height"].map(|key| layer[key].as_u64().expect("a size") as usize);
    unpacked(&text, &types, pixels[0] * pixels[1])
}

fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        match entry.is_dir() {
            true => files.extend(contents(&entry)),
            false => drop(files.insert(entry.clone(), fs::read(&entry).expect("readable"))),
        }
    }
    files
}

fn request(folder: &Path) -> ViewRequest {
    ViewRequest::new(folder)
}

#[test]
fn the_page_has_the_numbers_of_the_files() {
    let place = tempfile::tempdir().expect("temporary folder");
    let folder = result(&place.path().join("a"), 1.0);
    let page = view(&request(&folder), None, ExistingFiles::Refuse, &NullObserver).expect("a page");
    assert_eq!(page, folder.join("view/index.html"));
    let one = place.path().join("one.html");
    view(&request(&folder), Some(&one), ExistingFiles::Refuse, &NullObserver).expect("a page");
    for page in [page, one] {
        let facts = facts(&page);
        let depth = planes(&page, layer(&facts, 0, "depth")).remove(0);
        assert_eq!(depth, lengths().iter().map(|v| f64::from(*v)).collect::<Vec<_>>());
        assert_eq!(planes(&page, layer(&facts, 0, "picture"))[2][1], 6.0, "blue of the second pixel");
        let breakdown = layer(&facts, 0, "signal_breakdown");
        assert_eq!((&breakdown["planes"][0]["name"], &breakdown["frame"]), (&Value::from("signal"), &Value::from(3)));
        assert_eq!(planes(&page, breakdown)[1][7], -2.0);
        let names = layer(&facts, 0, "instance")["names"].as_array().expect("names").clone();
        let names: Vec<_> = names.iter().map(|name| (name[0].as_u64(), name[1].as_str())).collect();
        assert_eq!(names, [(Some(0), Some("background")), (Some(1), Some("floor")), (Some(2), Some("ball"))]);
        assert_eq!(layer(&facts, 0, "boxes")["objects"][0]["name"], "a </script> ball");
        let light = layer(&facts, 0, "radiance");
        assert_eq!(light["unit"], "W·m⁻²·sr⁻¹·nm⁻¹");
        assert_eq!(light["centres_nm"], serde_json::json!([450.0, 550.0, 650.0]));
        let decoded = planes(&page, light);
        let cube = radiance(1.0);
        let written = cube.planes().iter().map(Plane::samples);
        for (decoded, written) in decoded.iter().zip(written) {
            for (decoded, written) in decoded.iter().zip(written) {
                assert!(
                    (decoded - f64::from(*written)).abs() <= f64::from(*written) / 2048.0,
                    "{decoded} for {written}"
                );
            }
        }
        assert!(
            decoded[3..] == [vec![2.0; PIXELS], vec![2.0; PIXELS], vec![2.0; PIXELS]],
            "errors are roots of variances"
        );
    }
}

#[test]
fn the_same_files_give_the_same_bytes_and_an_earlier_page_is_replaced() {
    let place = tempfile::tempdir().expect("temporary folder");
    let folder = result(&place.path().join("a"), 1.0);
    let bytes = || {
        view(&request(&folder), None, ExistingFiles::Refuse, &NullObserver).expect("a page");
        contents(&folder.join("view"))
    };
    let first = bytes();
    assert_eq!(first.len(), 6, "a page and a chunk for each layer with numbers: {:?}", first.keys());
    assert!(bytes() == first);
    fs::remove_file(folder.join("front/picture.0003.png")).expect("removed");
    assert_eq!(bytes().len(), 5, "the chunk of a layer that is gone goes");
    fs::write(folder.join("view/index.html"), "a page of mine").expect("written");
    let message = view(&request(&folder), None, ExistingFiles::Refuse, &NullObserver).expect_err("refused").to_string();
    assert!(message.contains("already exists") && message.contains("`overwrite`"), "{message}");
    assert_eq!(fs::read_to_string(folder.join("view/index.html")).expect("kept"), "a page of mine");
}

#[test]
fn layers_that_are_too_large_are_reduced_equally_in_both_results() {
    let place = tempfile::tempdir().expect("temporary folder");
    let write = |name: &str, gain: f32| {
        let folder = place.path().join(name);
        fs::create_dir_all(&folder).expect("made");
        let numbers: Vec<f32> = (0..1000 * 600).map(|i| gain * (i % 1000) as f32).collect();
        let layers = [("n".to_owned(), ExrLayer::Float(&numbers))];
        fs::write(folder.join("n.exr"), encode_layers(1000, 600, &layers, &Provenance::default()).expect("encoded"))
            .expect("written");
        folder
    };
    let (a, b) = (write("a", 1.0), write("b", 2.0));
    let request = ViewRequest { beside: Some(b), max_mb: 1, ..ViewRequest::new(a) };
    let page =
        view(&request, Some(&place.path().join("page.html")), ExistingFiles::Refuse, &NullObserver).expect("a page");
    let facts = facts(&page);
    assert_eq!(facts["results"], serde_json::json!(["a", "b"]));
    for result in [0, 1] {
        let layer = layer(&facts, result, "n");
        assert_eq!([&layer["step"], &layer["width"], &layer["height"], &layer["columns"]], [2, 500, 300, 1000]);
        // The mean of columns 2 and 3; statistics are those of the file.
        assert_eq!(planes(&page, layer)[0][1], [2.5, 5.0][result]);
        assert_eq!(layer["planes"][0]["max"], [999.0, 1998.0][result]);
    }
}

#[test]
fn what_cannot_be_shown_is_refused_and_leaves_nothing() {
    let place = tempfile::tempdir().expect("temporary folder");
    let folder = result(&place.path().join("a"), 1.0);
    let page = place.path().join("page");
    let refused = |request: &ViewRequest| {
        let message = view(request, Some(&page), ExistingFiles::Refuse, &NullObserver).expect_err("refused");
        assert!(matches!(message, Error::Input(_)), "{message}");
        assert!(!page.exists(), "nothing is left");
        message.to_string()
    };
    let other = place.path().join("b/front");
    fs::create_dir_all(&other).expect("made");
    fs::write(other.join("picture.0003.png"), test_image((2, 2))).expect("written");
    let second_request = ViewRequest { beside: Some(place.path().join("b")), ..request(&folder) };
    let message = refused(&second_request);
    assert!(
        message.contains("picture is 2 × 2 pixels") && message.contains("6 × 4; give results of the same size"),
        "{message}"
    );
    fs::rename(other.join("picture.0003.png"), other.join("picture.0009.png")).expect("renamed");
    assert!(refused(&second_request).contains("no file has the same camera, frame and name as one in"));
    let damaged = folder.join("front/radiance.exr");
    let bytes = fs::read(&damaged).expect("readable");
    fs::write(&damaged, &bytes[..bytes.len() / 2]).expect("written");
    assert!(refused(&request(&folder)).contains("radiance.exr: "));
    fs::write(&damaged, &bytes).expect("written");
    fs::write(folder.join("front/boxes.0003.json"), "{").expect("written");
    assert!(refused(&request(&folder)).contains("boxes.0003.json:1"));
    fs::write(folder.join("front/camera.json"), "[").expect("written");
    assert!(refused(&request(&folder)).contains("camera.json: not JSON"));
    assert!(refused(&request(&place.path().join("nowhere"))).contains("does not exist"));
}
