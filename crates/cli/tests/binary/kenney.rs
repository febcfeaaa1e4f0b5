//! Models from elsewhere: the city and the trucks of the shared assets.

use crate::support::{contents, etendue, root, tests, text};
use etendue_io::exr::{ExrFile, ExrSamples, read_exr};
use etendue_testkit::skip::all_here;
use std::path::Path;

/// The job, if the models are available.
fn job() -> Option<String> {
    let assets = root().join("../shared/assets");
    let folders = ["kenney-city", "kenney-vehicles", "hdri"].map(|folder| assets.join(folder));
    let needed = folders.each_ref().map(AsRef::as_ref);
    all_here("kenney", &needed).then(|| text(&tests().join("jobs/kenney.toml")))
}

/// Values of a channel of the ground truth where `instance.ID` is one of `instances`.
fn values_of_instances(file: &ExrFile, channel: &str, instances: &[u32]) -> Vec<f32> {
    let Some(ExrSamples::Uint(ids)) = file.channel("instance.ID") else { panic!("identities") };
    let values = file.channel(channel).expect("a channel of the ground truth").to_floats();
    ids.iter().zip(values).filter(|(id, _)| instances.contains(id)).map(|(_, value)| value).collect()
}

fn range(values: &[f32]) -> (f32, f32) {
    assert!(!values.is_empty(), "nothing is seen of it");
    values.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}

/// Tolerances: a pixel of the 120 across 66° covers 0.17 m at the trucks, so that an edge is found within 0.2 m.
#[test]
fn a_city_made_elsewhere_stands_upright_in_colour_and_in_scale() {
    let Some(job) = job() else { return };
    let place = tempfile::tempdir().expect("a temporary folder");
    let output = text(&place.path().join("out"));
    let small = [
        "--spp=4",
        "--set=cameras.front.sensor.width_px=120",
        "--set=cameras.front.sensor.height_px=76",
        "--set=cameras.front.sensor.pixel_pitch_um=48",
    ];
    etendue(["render", &job, "-o", &output].iter().chain(&small)).ok();
    let truth = read_exr(Path::new(&format!("{output}/front/ground_truth.exr"))).expect("the ground truth");
    let identities = identities(&contents(Path::new(&output))["front/camera.json"]);
    let values_of = |object: &str, channel: &str| range(&values_of_instances(&truth, channel, &identities(object)));

    // The red truck: 2.1 × (1.5 wide, 1.3 high, 2.8 long), its rear at 16 − 2.94 m, on the right-hand lane.
    let (rear, _) = values_of("truck-red", "P.X");
    assert!((rear - 13.06).abs() < 0.2, "rear at {rear} m");
    let (right, left) = values_of("truck-red", "P.Y");
    assert!((right + 3.375).abs() < 0.2 && (left + 0.225).abs() < 0.2, "from {right} to {left} m");
    let (ground, top) = values_of("truck-red", "P.Z");
    assert!((-0.01..0.9).contains(&ground) && (top - 2.73).abs() < 0.2, "from {ground} to {top} m");
    // The road is flat on the ground, its pavements half a metre higher, with houses on it.
    let (low, high) = values_of("road", "P.Z");
    assert!(low > -1e-4 && high < 0.501, "road from {low} to {high} m");
    let (low, high) = values_of("house-c", "P.Z");
    assert!(low > -1e-4 && high < 17.501, "house from {low} to {high} m");
    coloured(&output);
}

/// The instances of an object, from the side-car.
fn identities(sidecar: &[u8]) -> impl Fn(&str) -> Vec<u32> + use<> {
    let facts: serde_json::Value = serde_json::from_slice(sidecar).expect("JSON");
    let list = facts["ground_truth"]["instances"].as_array().expect("a list of instances").clone();
    move |object| {
        let is_of = |name: &str| name == object || name.starts_with(&format!("{object} "));
        let of_object = list.iter().enumerate().filter(|(_, i)| is_of(i["name"].as_str().expect("a name")));
        of_object.map(|(i, _)| i as u32 + 1).collect()
    }
}

/// The palette image is used: red and purple houses, a green tree, not one grey.
fn coloured(output: &str) {
    let image = etendue_io::picture::read_image(Path::new(&format!("{output}/front/picture.0000.png")));
    let etendue_scene::asset::ImagePixels::Rgb8(pixels) = image.expect("the picture").pixels else { panic!("8 bits") };
    let strong = |a: usize, b: usize| pixels.iter().filter(|p| u16::from(p[a]) > 60 + u16::from(p[b])).count();
    for (name, a, b) in [("red over blue", 0, 2), ("blue over green", 2, 1), ("green over red", 1, 0)] {
        assert!(strong(a, b) > pixels.len() / 100, "{name}: {} pixels", strong(a, b));
    }
}
