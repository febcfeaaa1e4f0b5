//! glTF files with our own keys: the plan, images against those of the same objects in other formats, damaged files.

use crate::support::{etendue, root, text};
use etendue_testkit::skip::all_here;
use std::fs;
use std::path::Path;

/// A camera 3 m in front of the origin, under a uniform sky.
const JOB: &str = r#"format = 1
[scene]
MESHES
[[scene.objects]]
name = "thing"
BODY
[scene.environment]
type = "uniform"
luminance_cd_m2 = 100
illuminant = "D65"
[[cameras]]
name = "front"
position_m = [3, 1, 1.5]
look_at_m = [0, 0, 0.4]
lens = { type = "pinhole", focal_length_mm = 6, f_number = 8 }
sensor = { width_px = 64, height_px = 48, pixel_pitch_um = 80 }
[render]
spp = 128
replicates = 32
[output]
radiance = true
variance = true
"#;

/// The job of a mesh file.
fn job(file: &Path, axes: &str) -> String {
    let meshes = format!("[[scene.meshes]]\nname = \"m\"\nfile = {:?}\n{axes}", text(file));
    JOB.replace("MESHES", &meshes).replace("BODY", "mesh = \"m\"")
}

/// Renders two jobs and compares their results.
fn compared(one: &str, other: &str, options: &[&str]) -> (crate::support::CommandOutput, tempfile::TempDir) {
    let place = tempfile::tempdir().expect("a temporary folder");
    let rendered = [("one", one), ("other", other)].map(|(name, job)| {
        let file = place.path().join(format!("{name}.toml"));
        fs::write(&file, job).expect("written");
        let out = text(&place.path().join(name));
        etendue(
            ["render", &text(&file), "-o", &out, "--seed", if name == "one" { "1" } else { "2" }].iter().chain(options),
        )
        .ok();
        out
    });
    (
        etendue(
            ["compare", &rendered[0], &rendered[1]]
                .map(|out| if out == "compare" { out.to_owned() } else { format!("{out}/front/radiance.exr") }),
        ),
        place,
    )
}

#[test]
fn models_of_both_formats_give_the_same_picture() {
    let assets = root().join("../shared/assets");
    let needed = [assets.join("kenney-city"), assets.join("kenney-vehicles")];
    if !all_here("models_of_both_formats_give_the_same_picture", &needed.each_ref().map(AsRef::as_ref)) {
        return;
    }
    for model in ["kenney-city/building-small-a", "kenney-vehicles/vehicle-truck-red"] {
        let of = |extension: &str, axes: &str| job(&assets.join(format!("{model}.{extension}")), axes);
        let (output, _place) = compared(&of("glb", ""), &of("obj", "up_axis = \"y\""), &[]);
        assert_eq!(output.status, 0, "{model}: {}{}", output.out, output.err);
        let (output, _place) = compared(&of("glb", ""), &of("obj", "up_axis = \"y\"\nscale = 1.2"), &[]);
        assert_eq!(output.status, 1, "{model}: a model a fifth larger is found: {}", output.out);
    }
}

/// The file of trimesh: a gold box, diffuse balls, a coated print.
fn scene_glb() -> std::path::PathBuf {
    root().join("tests/oracles/figures/gltf/scene.glb")
}

#[test]
fn the_plan_says_what_became_of_what() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("job.toml");
    fs::write(&file, job(&scene_glb(), "")).expect("written");
    let plan = etendue(["plan", &text(&file)]).ok().out.split_whitespace().collect::<Vec<_>>().join(" ");
    for phrase in [
        "scene.glb: material \"gold\": conductor of the base colour, alpha 0.0900",
        "material \"matt\": diffuse",
        "material \"print\": coated, index 1.500, alpha 0.2500, colour from an image",
        "174 triangles",
    ] {
        assert!(plan.contains(phrase), "{phrase}: {plan}");
    }
}

/// A diffuse square from glTF against the same in our format.
#[test]
fn a_square_is_the_one_of_our_own_words() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let floats: Vec<u8> =
        [-0.5_f32, 0., 0.5, 0.5, 0., 0.5, 0.5, 0., -0.5, -0.5, 0., -0.5].iter().flat_map(|v| v.to_le_bytes()).collect();
    fs::write(place.path().join("m.bin"), [&floats[..], &[0, 1, 2, 0, 2, 3]].concat()).expect("written");
    let gltf = r#"{ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 0.75, 1], "metallicFactor": 0 },
            "emissiveFactor": [1, 1, 1], "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 40 } } }],
        "buffers": [{ "byteLength": 54, "uri": "m.bin" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 6 }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-0.5, 0, -0.5], "max": [0.5, 0, 0.5] },
            { "bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR" }] }"#;
    fs::write(place.path().join("m.gltf"), gltf).expect("written");
    let own = JOB
        .replace("MESHES", "[[scene.materials]]\nname = \"own\"\ntype = \"diffuse\"\nreflectance = [0.5, 0.25, 0.75]\nemission = { luminance_cd_m2 = 40, rgb = [1, 1, 1] }")
        .replace("BODY", "shape = { type = \"quad\", size_m = [1, 1] }\nmaterial = \"own\"");
    let (output, _place) = compared(&job(&place.path().join("m.gltf"), ""), &own, &[]);
    assert_eq!(output.status, 0, "{}{}", output.out, output.err);
    let (output, _place) =
        compared(&job(&place.path().join("m.gltf"), ""), &own.replace("cd_m2 = 40", "cd_m2 = 400"), &[]);
    assert_eq!(output.status, 1, "more light is found: {}", output.out);
}

#[test]
fn damaged_files_are_refused_with_their_place_in_the_job() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (file, mesh) = (place.path().join("job.toml"), place.path().join("m.glb"));
    let bytes = fs::read(scene_glb()).expect("the file");
    fs::write(&mesh, &bytes[..bytes.len() / 2]).expect("written");
    fs::write(&file, job(&mesh, "")).expect("written");
    let out = text(&place.path().join("out"));
    etendue(["render", &text(&file), "-o", &out]).refused(&["m.glb: ", "truncated", "job.toml:5:8", "file"]);
    assert!(!Path::new(&out).exists(), "nothing is written");
    fs::write(&mesh, bytes).expect("written");
    fs::write(&file, job(&mesh, "up_axis = \"z\"")).expect("written");
    etendue(["plan", &text(&file)]).refused(&["job.toml:6:", "up_axis", "+y points upwards"]);
    fs::write(&file, job(&place.path().join("m.obj"), "")).expect("written");
    etendue(["plan", &text(&file)]).refused(&["job.toml:3:", "\"up_axis\" is missing"]);
}

/// A PLY file against a square in our format; its colours and unread content are reported; a truncated file is refused.
#[test]
fn a_ply_file_is_a_mesh_without_materials() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (file, mesh) = (place.path().join("job.toml"), place.path().join("m.ply"));
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n-50 0 50 9\n50 0 50 9\n50 0 -50 9\n-50 0 -50 9\n4 0 1 2 3\n";
    fs::write(&mesh, ply).expect("written");
    let material = "[[scene.materials]]\nname = \"own\"\ntype = \"diffuse\"\nreflectance = 0.4\n";
    let of_ply = job(&mesh, &format!("up_axis = \"y\"\nscale = 0.01\n{material}"))
        .replace("mesh = \"m\"", "mesh = \"m\"\nmaterial = \"own\"");
    let own = |size: &str| {
        let body = format!("shape = {{ type = \"quad\", size_m = [{size}] }}\nmaterial = \"own\"");
        JOB.replace("MESHES", material).replace("BODY", &body)
    };
    let (output, _place) = compared(&of_ply, &own("1, 1"), &[]);
    assert_eq!(output.status, 0, "{}{}", output.out, output.err);
    let (output, _place) = compared(&of_ply, &own("2, 2"), &[]);
    assert_eq!(output.status, 1, "a larger square is found: {}", output.out);
    fs::write(&file, &of_ply).expect("written");
    let plan = etendue(["plan", &text(&file)]).ok().out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(plan.contains("m.ply: vertex and face colours are not used: give the object a material"), "{plan}");
    let inspected = etendue(["inspect", &text(&mesh)]).ok().out;
    assert!(inspected.contains("mesh, PLY") && inspected.contains("none (faceted)"), "{inspected}");
    fs::write(&mesh, &ply[..ply.len() - 12]).expect("written");
    let out = text(&place.path().join("out"));
    etendue(["render", &text(&file), "-o", &out]).refused(&["m.ply:14: ", "truncated", "job.toml:5:8", "file"]);
    assert!(!Path::new(&out).exists(), "nothing is written");
}
