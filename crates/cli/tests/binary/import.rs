//! Scenes of other programs: the converted scene, and its light against closed forms.

use crate::support::{etendue, text};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

const SIN_20: f64 = 0.342_020_143_325_668_7;
const COS_20: f64 = 0.939_692_620_785_908_4;
const SIN_40: f64 = 0.642_787_609_686_539_4;

/// A diffuse floor of reflectance 0.5 in y = 0, a light 2 m above it, and two cameras that look straight down on the origin from 3 m.
fn floor(light: &Value, rotation: [f64; 4]) -> Value {
    let down = [-std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2];
    json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0, 1, 2, 3] }],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [light] } },
        "nodes": [
            { "mesh": 0 },
            { "name": "Key Light", "translation": [0.5, 2, 1.5], "rotation": rotation, "scale": [3, 3, 3],
              "extensions": { "KHR_lights_punctual": { "light": 0 } } },
            { "camera": 0, "translation": [0, 3, 0], "rotation": down, "scale": [2, 2, 2] },
            { "camera": 1, "name": "plan view", "translation": [0, 3, 0], "rotation": down }
        ],
        "cameras": [
            { "type": "perspective", "name": "eye", "perspective": { "yfov": 0.004, "aspectRatio": 1.5, "znear": 0.1 } },
            { "type": "orthographic", "orthographic": { "xmag": 0.006, "ymag": 0.004, "znear": 0.1, "zfar": 10 } }
        ],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0 } }],
        "buffers": [{ "byteLength": 54, "uri": "floor.bin" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 6 }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-50, 0, -50], "max": [50, 0, 50] },
            { "bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR" }
        ]
    })
}

/// Writes a file and imports it into `made` next to it; returns the output.
fn imported(folder: &Path, file: &Value) -> crate::support::CommandOutput {
    let floats: Vec<u8> =
        [-50_f32, 0., 50., 50., 0., 50., 50., 0., -50., -50., 0., -50.].iter().flat_map(|v| v.to_le_bytes()).collect();
    fs::write(folder.join("floor.bin"), [&floats[..], &[0, 1, 2, 0, 2, 3]].concat()).expect("written");
    fs::write(folder.join("floor.gltf"), file.to_string()).expect("written");
    etendue(["import", &text(&folder.join("floor.gltf")), "-o", &text(&folder.join("made"))])
}

/// Makes the cameras of a job small.
fn shrink_cameras(folder: &Path) -> PathBuf {
    let job = folder.join("made/job.toml");
    let small = fs::read_to_string(&job).expect("a job").replace(
        "width_px = 720, height_px = 480, pixel_pitch_um = 50",
        "width_px = 12, height_px = 8, pixel_pitch_um = 3000",
    );
    fs::write(&job, small).expect("written");
    job
}

/// Mean luminance of a radiance file by its preview in linear sRGB, cd/m².
fn luminance(folder: &Path, camera: &str) -> f64 {
    let report = etendue(["inspect", &text(&folder.join(format!("out/{camera}/radiance.exr")))]).ok();
    let mean = |channel: &str| -> f64 {
        let line = report.out.lines().find(|line| line.split_whitespace().next() == Some(channel)).expect("a preview");
        line.split_whitespace().nth(3).expect("a mean").parse().expect("a number")
    };
    0.2126 * mean("R") + 0.7152 * mean("G") + 0.0722 * mean("B")
}

/// Illumination of the floor at the origin, by I·cos³/h² and E·cos. The cameras see 6 mm of it, over which light varies by 0.4 % and linearly; only
/// wavelengths cause noise: 0.05 % of a mean of 96 pixels of 64 samples (measured from seed to seed); six standard deviations are allowed.
#[test]
fn lights_of_gltf_have_the_levels_of_closed_forms() {
    let (height, distance2) = (2.0_f64, 0.25 + 4.0 + 2.25_f64);
    let candela = 400.0 * height / (distance2 * distance2.sqrt());
    // Straight down by −90° about x; towards the origin from (0.5, 2, 1.5).
    let down = [-std::f64::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2];
    let slanted = [-SIN_20, 0.0, 0.0, COS_20];
    let spot = |inner: f64, outer: f64| json!({ "type": "spot", "intensity": 400, "spot": { "innerConeAngle": inner, "outerConeAngle": outer } });
    // tan of the angle between straight down and the origin: √2.5 / 2, 38.3°.
    for (light, rotation, illuminance) in [
        (json!({ "type": "point", "intensity": 400, "range": 3 }), slanted, candela),
        (json!({ "type": "point", "intensity": 100, "color": [4, 4, 4] }), slanted, candela),
        (spot(0.7, 0.8), down, candela),
        (spot(0.1, 0.6), down, 0.0),
        (json!({ "type": "directional", "intensity": 1000 }), down, 1000.0),
        (json!({ "type": "directional", "intensity": 1000 }), slanted, 1000.0 * SIN_40),
    ] {
        let place = tempfile::tempdir().expect("a temporary folder");
        imported(place.path(), &floor(&light, rotation)).ok();
        let (job, out) = (shrink_cameras(place.path()), place.path().join("out"));
        etendue(["render", &text(&job), "-o", &text(&out), "--spp", "64"]).ok();
        let expected = 0.5 * illuminance / std::f64::consts::PI;
        for camera in ["eye", "plan-view"] {
            let actual = luminance(place.path(), camera);
            assert!((actual - expected).abs() <= 0.003 * expected, "{light}: {actual} cd/m² for {expected} ({camera})");
        }
    }
}

#[test]
fn an_import_says_what_became_of_what() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let mut file = floor(&json!({ "type": "point", "intensity": 400, "range": 3 }), [0.0, 0.0, 0.0, 1.0]);
    let output = imported(place.path(), &file).ok();
    assert!(output.out.contains("made/scene.toml") && output.out.contains("made/job.toml"), "{}", output.out);
    for phrase in [
        "its meshes: object \"floor\"",
        "light \"Key-Light\", point: 400 cd; its range is not used: light is not cut off",
        "camera \"eye\": perspective, vertical field of view 0.2292°; its near and far planes are not used",
        "camera \"plan-view\": orthographic, 0.012",
    ] {
        assert!(output.err.contains(phrase), "{phrase}: {}", output.err);
    }
    let scene = fs::read_to_string(place.path().join("made/scene.toml")).expect("a scene");
    assert!(scene.contains("file = \"../floor.gltf\"") && scene.starts_with("# Converted from floor.gltf"), "{scene}");
    let job = fs::read_to_string(place.path().join("made/job.toml")).expect("a job");
    assert!(job.contains("rotation_deg = [180, 90, 0]"), "{job}");
    etendue(["import", &text(&place.path().join("floor.gltf")), "-o", &text(&place.path().join("made"))])
        .refused(&["scene.toml", "--overwrite"]);
    // Without lights and cameras the scene is still visible.
    file["nodes"] = json!([{ "mesh": 0 }]);
    file["scenes"] = json!([{ "nodes": [0] }]);
    fs::remove_dir_all(place.path().join("made")).expect("removed");
    let output = imported(place.path(), &file).ok();
    assert!(output.err.contains("it has no light") && output.err.contains("\"view\" is added"), "{}", output.err);
    etendue(["plan", &text(&place.path().join("made/job.toml"))]).ok();
}

#[test]
fn scenes_that_cannot_be_imported_are_refused_and_nothing_is_written() {
    let point = json!({ "type": "point" });
    let still = [0.0, 0.0, 0.0, 1.0];
    for (change, phrase) in [
        (
            json!({ "/extensions/KHR_lights_punctual/lights/0": { "type": "point", "intensity": -1 } }),
            "intensity and colour must be finite",
        ),
        (json!({ "/extensions/KHR_lights_punctual/lights/0/type": "spot" }), "spot"),
        (
            json!({ "/extensions/KHR_lights_punctual/lights/0":
                { "type": "spot", "spot": { "innerConeAngle": 0.9, "outerConeAngle": 0.5 } } }),
            "expected 0 ≤ inner < outer ≤ π/2",
        ),
        (json!({ "/nodes/1/extensions/KHR_lights_punctual/light": 7 }), "out of bounds"),
        (json!({ "/cameras/0/perspective/yfov": 0 }), "yfov"),
        (json!({ "/nodes/2/camera": 9 }), "out of bounds"),
        (json!({ "/nodes/1": { "children": [1] } }), "its own descendant"),
    ] {
        let place = tempfile::tempdir().expect("a temporary folder");
        let mut file = floor(&point, still);
        for (pointer, value) in change.as_object().expect("a change") {
            *file.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value.clone();
        }
        imported(place.path(), &file).refused(&["floor.gltf: ", phrase]);
        assert!(!place.path().join("made").exists(), "{phrase}: nothing is written");
    }
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("made"));
    etendue(["import", &text(&place.path().join("none.glb")), "-o", &out]).refused(&["none.glb", "no such"]);
    fs::write(place.path().join("a.blend"), "BLENDER").expect("written");
    etendue(["import", &text(&place.path().join("a.blend")), "-o", &out]).refused(&["a.blend", ".glb"]);
}

/// A scene in pbrt's format: a camera 3 m above the origin of a diffuse floor, z upwards.
fn pbrt(lights: &str) -> String {
    format!(
        "LookAt 0 0 3  0 0 0  1 0 0\nCamera \"perspective\" \"float fov\" 0.2\n\
        Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 8\nWorldBegin\n{lights}\n\
        Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n\
        Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [ -50 -50 0  50 -50 0  50 50 0  -50 50 0 ]\n"
    )
}

/// pbrt's `power` is in lm and its `illuminance` in lx; other values are in these units: 1 of white light is 1 cd, 1 lx, 1 cd/m². Noise as above; for
/// the disc, sampled at random, 0.3 % more: E = π·L·r²/(h² + r²) on the axis of a disc of radius r at height h.
#[test]
fn lights_of_pbrt_have_the_levels_of_closed_forms() {
    let pi = std::f64::consts::PI;
    let irradiance_factor = 2.0 / (6.5 * 6.5_f64.sqrt());
    let cone = 2.0 * pi * ((1.0 - SIN_40) + 0.5 * (SIN_40 - 0.5)); // cos 50° and cos 60°
    for (lights, illuminance) in [
        (
            "LightSource \"point\" \"rgb I\" [ 40 40 40 ] \"float scale\" 10 \"point3 from\" [ 1.5 0.5 2 ]",
            400.0 * irradiance_factor,
        ),
        (
            "Translate 1.5 0 2 LightSource \"point\" \"float power\" 5000 \"point3 from\" [ 0 0.5 0 ] Identity",
            5000.0 / (4.0 * pi) * irradiance_factor,
        ),
        (
            "LightSource \"spot\" \"spectrum I\" \"stdillum-A\" \"float scale\" 400 \"point3 from\" [ 1.5 0.5 2 ] \"point3 to\" [ 0 0 0 ]",
            400.0 * irradiance_factor,
        ),
        (
            "LightSource \"spot\" \"float power\" 900 \"point3 from\" [ 1.5 0.5 2 ] \"point3 to\" [ 1.5 0.5 0 ] \"float coneangle\" 60 \"float conedeltaangle\" 10",
            900.0 / cone * irradiance_factor,
        ),
        (
            "LightSource \"distant\" \"blackbody L\" [ 6500 ] \"float illuminance\" 300 \"point3 from\" [ 0 3 4 ] \"point3 to\" [ 0 0 0 ]",
            240.0,
        ),
        ("LightSource \"distant\" \"float scale\" 5 \"point3 from\" [ 0 0 1 ] \"point3 to\" [ 0 0 0 ]", 5.0),
        ("LightSource \"infinite\" \"float illuminance\" 700", 700.0),
        ("LightSource \"infinite\" \"spectrum L\" [ 400 1 700 1 ] \"float scale\" 7", 7.0 * pi),
        (
            "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] AreaLightSource \"diffuse\" \"rgb L\" [ 9 9 9 ] Translate 0 0 4 Scale 1 1 -1 Shape \"disk\" AttributeEnd",
            9.0 * pi / 17.0,
        ),
        (
            "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] AreaLightSource \"diffuse\" \"float power\" 50 Translate 0 0 4 ReverseOrientation Shape \"disk\" AttributeEnd",
            50.0 / pi / 17.0,
        ),
    ] {
        let place = tempfile::tempdir().expect("a temporary folder");
        let (file, imported, out) = ("a.pbrt", place.path().join("made"), place.path().join("out"));
        fs::write(place.path().join(file), pbrt(lights)).expect("written");
        etendue(["import", &text(&place.path().join(file)), "-o", &text(&imported)]).ok();
        etendue(["render", &text(&imported.join("job.toml")), "-o", &text(&out), "--spp", "256"]).ok();
        let (actual, expected) = (luminance(place.path(), "camera"), 0.5 * illuminance / pi);
        assert!((actual - expected).abs() <= 0.005 * expected, "{lights}: {actual} cd/m² for {expected}");
    }
}

/// A black disc of alpha 0.25 in parallel light absorbs a quarter of it; one of alpha 0 is absent, and a camera of an unknown type is replaced. Each
/// ray meets the disc or not: 24 576 of them give three quarters to 0.4 %; four standard deviations are allowed.
#[test]
fn alpha_of_pbrt_is_opacity() {
    let disc = |alpha: &str| {
        format!(
            "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] Translate 0 1.5 2 Shape \"disk\" \"float alpha\" {alpha} AttributeEnd "
        )
    };
    let sun = "LightSource \"distant\" \"float illuminance\" 300 \"point3 from\" [ 0 3 4 ] \"point3 to\" [ 0 0 0 ] ";
    for (alpha, illuminance, phrase) in
        [("0.25", 180.0, "written: objects 2"), ("0", 240.0, "a shape of alpha 0 is left out")]
    {
        let place = tempfile::tempdir().expect("a temporary folder");
        let (imported, out) = (place.path().join("made"), place.path().join("out"));
        fs::write(place.path().join("a.pbrt"), pbrt(&format!("{sun}{}", disc(alpha)))).expect("written");
        let output = etendue(["import", &text(&place.path().join("a.pbrt")), "-o", &text(&imported)]).ok();
        assert!(output.err.contains(phrase), "{}", output.err);
        etendue(["render", &text(&imported.join("job.toml")), "-o", &text(&out), "--spp", "256"]).ok();
        let (actual, expected) = (luminance(place.path(), "camera"), 0.5 * illuminance / std::f64::consts::PI);
        assert!((actual - expected).abs() <= 0.016 * expected, "{alpha}: {actual} cd/m² for {expected}");
    }
    let place = tempfile::tempdir().expect("a temporary folder");
    let scene = pbrt(sun).replace("\"perspective\" \"float fov\" 0.2", "\"spherical\"");
    fs::write(place.path().join("a.pbrt"), scene).expect("written");
    let output = etendue(["import", &text(&place.path().join("a.pbrt")), "-o", &text(&place.path().join("made"))]).ok();
    assert!(
        output.err.contains("the camera \"spherical\" is not supported: a perspective camera of 40°"),
        "{}",
        output.err
    );
}

/// The scenes of scenes/import against the same written by hand, by the Z test of `compare`; a lamp that is a tenth brighter is detected.
#[test]
fn scenes_of_pbrt_are_those_of_our_own_words() {
    for name in ["shapes", "smoke"] {
        let place = tempfile::tempdir().expect("a temporary folder");
        let folder = crate::support::root().join("scenes/import");
        let imported = place.path().join("made");
        etendue(["import", &text(&folder.join(format!("{name}.pbrt"))), "-o", &text(&imported)]).ok();
        let render = |job: &Path, out: &str, seed: &str, more: &[&str]| {
            let out = text(&place.path().join(out));
            let sampling =
                ["--set", "output.variance=true", "--set", "render.replicates=32", "--spp", "128", "--seed", seed];
            let job = text(job);
            etendue(["render", job.as_str(), "-o", out.as_str()].iter().chain(&sampling).chain(more)).ok();
            format!("{out}/camera/radiance.exr")
        };
        let own = render(&folder.join(format!("{name}.toml")), "own", "1", &[]);
        let theirs = render(&imported.join("job.toml"), "theirs", "2", &[]);
        let output = etendue(["compare", &own, &theirs]);
        assert_eq!(output.status, 0, "{name}: {}{}", output.out, output.err);
        let key = if name == "shapes" {
            "scene.environment.luminance_cd_m2=43"
        } else {
            "scene.lights.sun.illuminance_lx=1100"
        };
        let brighter = render(&folder.join(format!("{name}.toml")), "brighter", "3", &["--set", key]);
        let output = etendue(["compare", &brighter, &theirs]);
        assert_eq!(output.status, 1, "{name}: more light is found: {}", output.out);
    }
}

/// The reader needs a library that compresses PNGs differently, so it is not tested by default (`just usd`).
#[cfg(not(feature = "usd"))]
#[test]
fn stages_of_usd_need_a_program_that_is_built_for_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    etendue(["import", &text(&crate::support::root().join("scenes/import/table.usda")), "-o", &text(&out)])
        .refused(&["table.usda", "the feature \"usd\""]);
    assert!(!out.exists());
    etendue_testkit::skip::skipped("usd", "the reader of USD is not built in; just usd runs its tests");
}
