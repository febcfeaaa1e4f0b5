//! Animations of glTF files as frames with keys: the written files, and images against those of the same file without motion.

use crate::support::{CommandOutput, etendue, text};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// Numbers of the buffer, in the order of its accessors: a square, its indices, times, and values.
const CORNERS: [f32; 12] = [-0.5, 0.0, 0.5, 0.5, 0.0, 0.5, 0.5, 0.0, -0.5, -0.5, 0.0, -0.5];
const TIMES: [f32; 3] = [0.0, 0.5, 1.0];
const PLACES: [f32; 9] = [0.3, 0.2, 0.1, 0.3, 0.2, 0.1, 1.3, 0.2, 0.1];
const HALF: f32 = std::f32::consts::FRAC_1_SQRT_2;
/// 30° about x, twice, then 90°.
const TURNS: [f32; 12] =
    [0.258_819_04, 0.0, 0.0, 0.965_925_8, 0.258_819_04, 0.0, 0.0, 0.965_925_8, HALF, 0.0, 0.0, HALF];
const SIZES: [f32; 9] = [1.0, 1.0, 2.0, 1.0, 1.0, 2.0, 1.0, 1.0, 1.0];
/// In-tangent, value and out-tangent of each position: those of PLACES, at rest at every key.
const CURVE: [f32; 27] = [
    0.0, 0.0, 0.0, 0.3, 0.2, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.3, 0.2, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.3, 0.2,
    0.1, 0.0, 0.0, 0.0,
];

/// A floor, and on a rotated base of twice the size an arm that moves with a camera, a lamp and a moving hand. `is_still`: the same at its initial
/// positions, without motion.
fn scene(interpolation: &str, is_still: bool) -> Value {
    let mut arm = json!({ "name": "arm", "mesh": 0, "children": [2, 3, 4] });
    let mut hand = json!({ "name": "hand", "mesh": 0, "translation": [1.1, 0.4, 0.1], "rotation": [0, 0, HALF, HALF] });
    if is_still {
        arm["translation"] = json!(PLACES[..3]);
        arm["rotation"] = json!(TURNS[..4]);
        hand["scale"] = json!(SIZES[..3]);
        hand["rotation"] = json!(TURNS[..4]);
    } else {
        arm["translation"] = json!([7, 7, 7]);
    }
    let place = if interpolation == "CUBICSPLINE" { 6 } else { 3 };
    let sampler =
        |output: usize, interpolation: &str| json!({ "input": 2, "output": output, "interpolation": interpolation });
    let channel = |sampler: usize, node: usize, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    let animations = json!([{
        "samplers": [sampler(place, interpolation), sampler(4, "LINEAR"), sampler(4, "STEP"), sampler(5, "LINEAR")],
        "channels": [channel(0, 1, "translation"), channel(1, 1, "rotation"), channel(2, 2, "rotation"), channel(3, 2, "scale")],
    }]);
    let numbers = [
        ("VEC3", CORNERS.len()),
        ("SCALAR", 6),
        ("SCALAR", TIMES.len()),
        ("VEC3", PLACES.len()),
        ("VEC4", TURNS.len()),
        ("VEC3", SIZES.len()),
        ("VEC3", CURVE.len()),
    ];
    let (mut views, mut accessors, mut at) = (Vec::new(), Vec::new(), 0);
    for (i, (kind, count)) in numbers.into_iter().enumerate() {
        let (size, each) = (
            if i == 1 { 1 } else { 4 },
            match kind {
                "VEC3" => 3,
                "VEC4" => 4,
                _ => 1,
            },
        );
        views.push(json!({ "buffer": 0, "byteOffset": at, "byteLength": count * size }));
        accessors.push(json!({ "bufferView": i, "componentType": if i == 1 { 5121 } else { 5126 }, "count": count / each, "type": kind,
            "min": vec![-1; each], "max": vec![1; each] }));
        at += (count * size).next_multiple_of(4);
    }
    let mut file = json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0, 5] }],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "point", "intensity": 400 }] } },
        "nodes": [
            { "name": "base", "translation": [0, 1, 0], "rotation": [0, 0.258_819_04, 0, 0.965_925_8], "scale": [2, 2, 2], "children": [1] },
            arm, hand,
            { "camera": 0, "name": "eye", "translation": [0.4, 1.5, 2.5], "rotation": [-0.258_819_04, 0, 0, 0.965_925_8] },
            { "name": "lamp", "translation": [-0.5, 1, 1], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
            { "mesh": 0, "scale": [20, 1, 20] },
        ],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.9, "aspectRatio": 1.5, "znear": 0.1 } }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.4, 0.3, 1], "metallicFactor": 0 }, "doubleSided": true }],
        "buffers": [{ "byteLength": at, "uri": "all numbers.bin" }],
        "bufferViews": views, "accessors": accessors,
    });
    if !is_still {
        file["animations"] = animations;
    }
    file
}

fn imported(folder: &Path, file: &Value, name: &str) -> (CommandOutput, PathBuf) {
    let floats = |numbers: &[f32]| -> Vec<u8> { numbers.iter().flat_map(|v| v.to_le_bytes()).collect() };
    let bytes = [
        floats(&CORNERS),
        vec![0, 1, 2, 0, 2, 3, 0, 0],
        floats(&TIMES),
        floats(&PLACES),
        floats(&TURNS),
        floats(&SIZES),
        floats(&CURVE),
    ];
    fs::write(folder.join("all numbers.bin"), bytes.concat()).expect("written");
    fs::write(folder.join(format!("{name}.gltf")), file.to_string()).expect("written");
    let imported_folder = folder.join(format!("{name} made"));
    (
        etendue(["import", &text(&folder.join(format!("{name}.gltf"))), "-o", &text(&imported_folder)]),
        imported_folder.join("job.toml"),
    )
}

fn rendered(folder: &Path, job: &Path, name: &str, seed: &str) -> String {
    let small = fs::read_to_string(job).expect("a job").replace(
        "width_px = 720, height_px = 480, pixel_pitch_um = 50",
        "width_px = 48, height_px = 32, pixel_pitch_um = 750",
    );
    fs::write(job, small).expect("written");
    let out = text(&folder.join(name));
    // Few bands: a difference shows most clearly in them.
    let sampling = [
        "--set=output.variance=true",
        "--set=render.replicates=32",
        "--set=render.wavelength_range_nm=[400,700]",
        "--set=render.band_width_nm=100",
        "--spp=128",
        "--seed",
        seed,
    ];
    etendue(["render", &text(job), "-o", &out].iter().copied().chain(sampling)).ok();
    // Images of a moving scene have a number.
    let still = format!("{out}/eye/radiance.exr");
    if Path::new(&still).exists() { still } else { format!("{out}/eye/radiance.0000.exr") }
}

/// At the start everything is positioned as in a file without motion: meshes, the camera, the lamp, by every interpolation; a displaced arm is
/// detected.
#[test]
fn what_moves_begins_where_its_first_keys_say() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let still = imported(place.path(), &scene("LINEAR", true), "still");
    still.0.ok();
    let still = rendered(place.path(), &still.1, "still-out", "1");
    for (i, interpolation) in ["LINEAR", "CUBICSPLINE"].into_iter().enumerate() {
        let (output, job) = imported(place.path(), &scene(interpolation, false), &format!("moving-{i}"));
        output.ok();
        let moving = rendered(place.path(), &job, &format!("moving-out-{i}"), "2");
        let run = etendue(["compare", &still, &moving]);
        assert_eq!(run.status, 0, "{interpolation}: {}{}", run.out, run.err);
    }
    let mut other = scene("LINEAR", true);
    other["nodes"][2]["scale"] = json!([1, 1, 1.5]);
    let (output, job) = imported(place.path(), &other, "other");
    output.ok();
    let run = etendue(["compare", &still, &rendered(place.path(), &job, "other-out", "3")]);
    assert_eq!(run.status, 1, "a smaller hand is found: {}", run.out);
}

#[test]
fn keys_are_those_of_the_file() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (output, job) = imported(place.path(), &scene("CUBICSPLINE", false), "a");
    let output = output.ok();
    for phrase in [
        "node \"arm\" moves: a frame with 33 keys; its cubic curves are sampled with 16 keys per interval",
        "node \"hand\" moves: a frame with 5 keys; each of its steps takes 1 µs",
        "its meshes: object \"a\"",
    ] {
        assert!(output.err.contains(phrase), "{phrase}: {}", output.err);
    }
    let scene = fs::read_to_string(job.with_file_name("scene.toml")).expect("a scene");
    for phrase in
        ["parent = \"arm\"", "file = \"meshes/still.gltf\"", "file = \"meshes/arm.gltf\"", "time_s = 0.499999"]
    {
        assert!(scene.contains(phrase), "{phrase}: {scene}");
    }
    etendue(["plan", &text(&job)]).ok();
}

#[test]
fn unsupported_motion_is_reported_and_damage_is_refused() {
    let change = |pointer: &str, value: Value| {
        let mut file = scene("LINEAR", false);
        *file.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value;
        file
    };
    for (file, phrase) in [
        (
            change("/nodes/0/scale", json!([2, 1, 2])),
            "node \"arm\" is not used: nodes above it are mirrored or scaled non-uniformly",
        ),
        (
            change("/animations/0/channels/3/target/node", json!(1)),
            "node \"hand\" is not used: its parent changes size",
        ),
    ] {
        let place = tempfile::tempdir().expect("a temporary folder");
        let (output, job) = imported(place.path(), &file, "a");
        let output = output.ok();
        assert!(output.err.contains(phrase), "{phrase}: {}", output.err);
        etendue(["plan", &text(&job)]).ok();
    }
    for (file, phrase) in [
        (change("/animations/0/channels/0/sampler", json!(9)), "a.gltf"),
        (change("/animations/0/samplers/0/output", json!(2)), "translations"),
        (change("/animations/0/samplers/0/input", json!(0)), "times"),
        (change("/accessors/2/count", json!(2_000_000)), "more than 1000000 keys"),
        // Zero tangents of the curve.
        (
            change(
                "/accessors/4",
                json!({ "bufferView": 6, "byteOffset": 24, "componentType": 5126, "count": 3, "type": "VEC4" }),
            ),
            "key 0 of its rotations is a quaternion of length 0",
        ),
    ] {
        let place = tempfile::tempdir().expect("a temporary folder");
        imported(place.path(), &file, "a").0.refused(&["a.gltf", phrase]);
        assert!(!place.path().join("a made").exists(), "{phrase}: nothing is written");
    }
}

/// A moving part may have the name of the file, or of a stationary part.
#[test]
fn what_moves_and_what_stands_have_names_apart() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let mut file = scene("LINEAR", false);
    file["nodes"][1]["name"] = json!("still");
    file["nodes"][2]["name"] = json!("A");
    let (output, job) = imported(place.path(), &file, "a");
    output.ok();
    let scene_text = fs::read_to_string(job.with_file_name("scene.toml")).expect("a scene");
    for part in ["still", "still-2", "A-2"] {
        assert!(scene_text.contains(&format!("file = \"meshes/{part}.gltf\"")), "{part}: {scene_text}");
    }
    etendue(["plan", &text(&job)]).ok();
}
