//! glTF: a file of another program compared with that program's own results, small files with known answers, and damaged ones.

use etendue_io::mesh::read_mesh;
use etendue_scene::asset::{ImagePixels, MeshAsset, SlotColour, SlotLayers, SlotNumber, SlotSurface, SlotTopLayer};
use glam::DVec3;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

fn oracle(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/gltf").join(name)
}

/// Corners of the triangles of a slot, in f64.
fn corners(mesh: &MeshAsset, slot: usize) -> Vec<[DVec3; 3]> {
    let place = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from)) + DVec3::from_array(mesh.origin);
    let of_slot = mesh.triangles.iter().zip(&mesh.slots).filter(|(_, s)| usize::from(**s) == slot);
    of_slot.map(|(t, _)| t.map(place)).collect()
}

fn layers(mesh: &MeshAsset, slot: usize) -> &SlotLayers {
    match &mesh.slot_materials[slot].surface {
        Some(SlotSurface::Layers(layers)) => layers,
        other => panic!("{other:?}"),
    }
}

/// trimesh keeps 64 bits of the file's 32, as we do: the difference is our last rounding to 32 bits, 6e-8 of 10 m.
#[test]
fn a_file_of_another_program_stands_as_that_program_has_it() {
    let mesh = read_mesh(&oracle("scene.glb")).unwrap_or_else(|e| panic!("{e}"));
    let figures: Value = serde_json::from_slice(&fs::read(oracle("scene.json")).expect("figures")).expect("JSON");
    assert_eq!(mesh.slot_materials.len(), 3);
    for (slot, material) in mesh.slot_materials.iter().enumerate() {
        let (expected, actual) = (&figures[&material.name], corners(&mesh, slot));
        let number = |key: &str| expected[key].as_f64().expect("a figure");
        assert_eq!(actual.len() as f64, number("triangles"), "{}", material.name);
        let area: f64 = actual.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum();
        assert!((area - number("area")).abs() < 1e-5 * area, "{}: {area}", material.name);
        let volume: f64 = actual.iter().map(|[a, b, c]| a.cross(*b).dot(*c) / 6.0).sum();
        let is_closed = material.name != "print";
        assert!(
            !is_closed || (volume - number("volume")).abs() < 1e-4,
            "{}: {volume}, which tells the winding",
            material.name
        );
        for (i, pick) in [DVec3::min as fn(DVec3, DVec3) -> DVec3, DVec3::max].into_iter().enumerate() {
            let bound = actual.iter().flatten().copied().reduce(pick).expect("corners").to_array();
            for (axis, coordinate) in bound.into_iter().enumerate() {
                let expected = expected["bounds"][i][axis].as_f64().expect("a bound");
                assert!((coordinate - expected).abs() < 2e-6, "{}: {coordinate} for {expected}", material.name);
            }
        }
    }
    let slot = |name: &str| mesh.slot_materials.iter().position(|m| m.name == name).expect("a material");
    let gold = layers(&mesh, slot("gold"));
    assert_eq!(gold.metal, SlotNumber::Number(1.0));
    let roughness = f64::from(0.3_f32);
    assert_eq!(gold.alpha, SlotNumber::Number(roughness * roughness));
    let SlotColour::LinearSrgb([_, green, blue]) = gold.base else { panic!("{gold:?}") };
    assert!((green - 196.0 / 255.0).abs() < 1e-6 && (blue - 86.0 / 255.0).abs() < 1e-6);
    assert_eq!(layers(&mesh, slot("matt")).top_layer, SlotTopLayer::Nothing);
    let print = layers(&mesh, slot("print"));
    assert_eq!(print.top_layer, SlotTopLayer::Coat { index: 1.5 });
    let SlotColour::Picture(picture) = &print.base else { panic!("{print:?}") };
    let (_, image) =
        mesh.embedded_images.iter().find(|(name, _)| *name == picture.file).expect("the picture came along");
    assert_eq!((image.width, image.height), (4, 2));
    let ImagePixels::Rgb8(pixels) = &image.pixels else { panic!("{:?}", image.pixels) };
    assert_eq!(pixels[..4], [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]]);
}

/// File of two triangles (corners 0 0 0, 1 0 0, 1 1 0, 0 1 0) with texture coordinates equal to their x and y, to be changed.
pub(super) fn square() -> Value {
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let mut bytes = floats(&[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    bytes.extend(floats(&[0., 0., 1., 0., 1., 1., 0., 1.]));
    bytes.extend([0_u8, 1, 2, 0, 2, 3]);
    json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
        "materials": [{ "name": "m" }],
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{}", base64(&bytes)) }],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 6 }
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR" }
        ]
    })
}

pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |group: &[u8]| {
        let bits = group.iter().fold(0_u32, |bits, b| bits << 8 | u32::from(*b)) << (8 * (3 - group.len()));
        let letter =
            |i: usize| if i <= group.len() { LETTERS[(bits >> (18 - 6 * i)) as usize & 63] as char } else { '=' };
        (0..4).map(letter).collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}

pub(super) fn read_bytes(name: &str, bytes: &[u8], others: &[(&str, &[u8])]) -> Result<MeshAsset, String> {
    let folder = tempfile::tempdir().expect("temporary folder");
    others.iter().for_each(|(name, bytes)| fs::write(folder.path().join(name), bytes).expect("written"));
    fs::write(folder.path().join(name), bytes).expect("written");
    let relative_text = |e: etendue_io::Error| e.to_string().replace(&format!("{}/", folder.path().display()), "");
    read_mesh(&folder.path().join(name)).map_err(relative_text)
}

/// Reads the square after a change.
pub(super) fn changed(change: impl FnOnce(&mut Value)) -> Result<MeshAsset, String> {
    let mut file = square();
    change(&mut file);
    read_bytes("a.gltf", file.to_string().as_bytes(), &[])
}

#[track_caller]
fn refused(phrases: &[&str], change: impl FnOnce(&mut Value)) {
    let message = changed(change).expect_err("damaged");
    assert!(message.starts_with("a.gltf: ") && phrases.iter().all(|p| message.contains(p)), "{message}");
}

/// A tiny PNG of one colour.
pub(super) fn png(rgba: [u8; 4]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().and_then(|mut w| w.write_image_data(&rgba)).expect("encoded");
    bytes
}

fn with_image(file: &mut Value, rgba: [u8; 4]) {
    file["images"] = json!([{ "uri": format!("data:image/png;base64,{}", base64(&png(rgba))) }]);
    file["textures"] = json!([{ "source": 0 }]);
}

#[test]
fn coordinates_are_turned_over_and_transforms_applied() {
    let mesh = changed(|_| {}).expect("whole");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.uvs, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]], "v runs downwards in glTF");
    // A quarter turn, twice as often along u, and 0.25 along v: (u, v) becomes (v, 0.25 − 2u).
    let mesh = changed(|file| {
        with_image(file, [255; 4]);
        let transform = json!({ "offset": [0, 0.25], "rotation": std::f64::consts::FRAC_PI_2, "scale": [2, 1] });
        file["materials"][0]["pbrMetallicRoughness"] =
            json!({ "baseColorTexture": { "index": 0, "extensions": { "KHR_texture_transform": transform } } });
    })
    .expect("whole");
    for ([u, v], actual) in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0_f32]].into_iter().zip(mesh.uvs) {
        let expected = [v, 1.0 - (0.25 - 2.0 * u)];
        // Sine and cosine of a quarter turn in 32 bits.
        assert!(actual.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-6), "{actual:?} for {expected:?}");
    }
}

#[test]
fn mirrored_nodes_keep_their_fronts_and_repeated_meshes_their_places() {
    let mesh = changed(|file| {
        file["nodes"] = json!([{ "children": [1, 2] }, { "mesh": 0, "scale": [-1, 1, 1] }, { "mesh": 0, "translation": [5, 0, 0] }]);
    })
    .expect("whole");
    let facing: Vec<DVec3> = corners(&mesh, 0).iter().map(|[a, b, c]| (*b - *a).cross(*c - *a)).collect();
    assert_eq!(facing, [DVec3::Z; 4], "all face +z");
    assert_eq!((mesh.positions[1][0], mesh.positions[5][0]), (-1.0, 6.0));
}

#[test]
fn a_skin_stands_as_its_joints_do_at_rest() {
    let mesh = changed(|file| {
        // One joint for all corners, 3 m up: the transform of the mesh's node is ignored.
        let bytes: Vec<u8> = (0..4).flat_map(|_| [0, 0, 0, 0, 255, 0, 0, 0]).collect();
        file["buffers"].as_array_mut().expect("a list").push(json!({ "byteLength": 32, "uri": format!("data:;base64,{}", base64(&bytes)) }));
        file["bufferViews"].as_array_mut().expect("a list").push(json!({ "buffer": 1, "byteLength": 32, "byteStride": 8 }));
        let accessors = file["accessors"].as_array_mut().expect("a list");
        accessors.push(json!({ "bufferView": 3, "componentType": 5121, "count": 4, "type": "VEC4" }));
        accessors.push(json!({ "bufferView": 3, "byteOffset": 4, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4" }));
        let attributes = &mut file["meshes"][0]["primitives"][0]["attributes"];
        attributes["JOINTS_0"] = json!(3);
        attributes["WEIGHTS_0"] = json!(4);
        file["scenes"][0]["nodes"] = json!([0, 1]);
        file["nodes"] = json!([{ "mesh": 0, "skin": 0, "translation": [100, 0, 0] }, { "translation": [0, 3, 0] }]);
        file["skins"] = json!([{ "joints": [1] }]);
    })
    .expect("whole");
    assert_eq!(corners(&mesh, 0)[0][2], DVec3::new(1.0, 4.0, 0.0));
    assert!(mesh.report.iter().any(|note| note.contains("1 skins: used in their rest pose")), "{:?}", mesh.report);
}

#[test]
fn what_has_no_place_is_reported() {
    let mesh = changed(|file| {
        file["cameras"] = json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1 } }]);
        file["extensionsUsed"] = json!(["KHR_lights_punctual", "EXT_of_someone"]);
        file["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
        file["meshes"][0]["primitives"]
            .as_array_mut()
            .expect("a list")
            .push(json!({ "attributes": { "POSITION": 0 }, "mode": 1 }));
    })
    .expect("whole");
    for phrase in [
        "1 lights",
        "1 cameras",
        "primitives of points or lines, which are not used: 1",
        "not used: EXT_of_someone",
        "material \"m\": conductor",
    ] {
        assert!(
            mesh.report.iter().any(|note| note.starts_with("a.gltf: ") && note.contains(phrase)),
            "{phrase}: {:?}",
            mesh.report
        );
    }
}

fn material(keys: Value) -> SlotLayers {
    let mesh = changed(|file| {
        with_image(file, [128, 64, 255, 51]);
        file["materials"][0] = keys;
    });
    layers(&mesh.unwrap_or_else(|e| panic!("{e}")), 0).clone()
}

#[test]
fn pictures_that_are_the_same_everywhere_are_numbers() {
    let converted = material(
        json!({ "pbrMetallicRoughness": { "metallicRoughnessTexture": { "index": 0 }, "roughnessFactor": 0.5 } }),
    );
    // Metal is blue, 255; roughness is green, 64 / 255, times 0.5; α its square, in steps of 1/65 535.
    assert_eq!(converted.metal, SlotNumber::Number(1.0));
    let SlotNumber::Number(alpha) = converted.alpha else { panic!("{converted:?}") };
    let roughness = 0.5 * 64.0 / 255.0;
    assert!((alpha - roughness * roughness).abs() < 1.0 / 65_535.0, "{alpha}");
}

#[test]
fn opacity_is_masked_or_blended() {
    let with_alpha = |mode: &str, cutoff: f64| {
        let mut keys = json!({ "alphaMode": mode, "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } });
        if mode == "MASK" {
            keys["alphaCutoff"] = json!(cutoff);
        }
        material(keys).opacity
    };
    assert_eq!(with_alpha("OPAQUE", 0.5), None);
    assert_eq!(
        (with_alpha("MASK", 0.5), with_alpha("MASK", 0.1)),
        (Some(SlotNumber::Number(0.0)), None),
        "51 / 255 is 0.2"
    );
    let Some(SlotNumber::Number(opacity)) = with_alpha("BLEND", 0.5) else { panic!("a number") };
    assert!((opacity - 0.2).abs() < 1.0 / 65_535.0, "{opacity}");
}

#[test]
fn extensions_become_coats_glass_cloth_and_light() {
    let plain = json!({ "metallicFactor": 0, "roughnessFactor": 0.5 });
    let with =
        |name: &str, value: Value| material(json!({ "pbrMetallicRoughness": plain, "extensions": { name: value } }));
    let SlotTopLayer::Coat { index } = with("KHR_materials_ior", json!({ "ior": 1.75 })).top_layer else {
        panic!("a coat")
    };
    assert!((index - 1.75).abs() < 1e-6);
    // A quarter of the reflectance of 1.5: (n − 1)/(n + 1) = 0.1.
    let SlotTopLayer::Coat { index } = with("KHR_materials_specular", json!({ "specularFactor": 0.25 })).top_layer
    else {
        panic!("a coat")
    };
    assert!((index - 1.1 / 0.9).abs() < 1e-6, "{index}");
    let coated =
        with("KHR_materials_clearcoat", json!({ "clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.1 })).top_layer;
    assert!(
        matches!(coated, SlotTopLayer::TwoCoats { fraction: 0.75, alpha, .. } if (alpha - 0.01).abs() < 1e-9),
        "{coated:?}"
    );
    let cloth = with("KHR_materials_sheen", json!({ "sheenColorFactor": [0.5, 0.25, 0], "sheenRoughnessFactor": 0.5 }))
        .top_layer;
    assert_eq!(cloth, SlotTopLayer::Sheen { colour: [0.5, 0.25, 0.0], alpha: 0.25 });
    let pane = with("KHR_materials_transmission", json!({ "transmissionFactor": 1 })).transmission.expect("clear");
    assert_eq!((pane.fraction, pane.solid), (SlotNumber::Number(1.0), None));
    assert_eq!(with("KHR_materials_unlit", json!({})).top_layer, SlotTopLayer::Nothing);
    let lamp = material(json!({
        "emissiveFactor": [1, 0.5, 0], "doubleSided": true,
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 200 } }
    }));
    let emission = lamp.emission.expect("it glows");
    assert_eq!((emission.rgb_cd_m2, emission.both_sides), ([200.0, 100.0, 0.0], true));
}

#[test]
fn buffers_and_images_are_found_next_to_the_file() {
    let mut file = square();
    let bytes: Vec<u8> = [0_f32, 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0., 1.]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .chain([0, 1, 2, 0, 2, 3])
        .collect();
    file["buffers"][0]["uri"] = json!("far%20away/my%20data.bin");
    let mesh =
        read_bytes("a.gltf", file.to_string().as_bytes(), &[("my data.bin", &bytes)]).expect("found by its name");
    assert_eq!(mesh.positions, changed(|_| {}).expect("whole").positions);
    let message = read_bytes("a.gltf", file.to_string().as_bytes(), &[]).expect_err("missing");
    assert!(
        message.contains("buffer 0 does not exist")
            && message.contains("far away/my data.bin")
            && message.contains("nor "),
        "{message}"
    );
}

#[test]
fn damage_is_reported() {
    let glb = fs::read(oracle("scene.glb")).expect("the file");
    for cut in [4, 11, 20, 100, glb.len() - 1] {
        let message = read_bytes("a.glb", &glb[..cut], &[]).expect_err("truncated");
        assert!(message.starts_with("a.glb: ") && message.contains("truncated"), "{cut}: {message}");
    }
    refused(&["EXT_unheard", "not supported"], |file| {
        file["extensionsUsed"] = json!(["EXT_unheard"]);
        file["extensionsRequired"] = json!(["EXT_unheard"]);
    });
    refused(&["node 1", "its own descendant"], |file| {
        file["nodes"] = json!([{ "mesh": 0 }, { "children": [2] }, { "children": [1] }]);
    });
    refused(&["child of both"], |file| {
        file["nodes"] = json!([{ "children": [2] }, { "children": [2] }, { "mesh": 0 }]);
    });
    refused(&["accessor 9", "does not exist"], |file| {
        file["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(9);
    });
    refused(&["extends beyond"], |file| file["accessors"][0]["count"] = json!(5));
    refused(&["buffer 0", "truncated"], |file| file["buffers"][0]["byteLength"] = json!(1000));
    refused(&["index 5", "4 vertices"], |file| {
        file["buffers"][0]["uri"] =
            json!(format!("data:;base64,{}{}", "A".repeat(104), base64(&[0, 0, 0, 1, 5, 0, 2, 3])));
        file["bufferViews"][2] = json!({ "buffer": 0, "byteOffset": 80, "byteLength": 6 });
    });
    refused(&["vertex 1", "e60 is beyond the range of 32-bit floats"], |file| {
        let large = json!([1e30, 1, 1]);
        file["nodes"] = json!([{ "children": [1], "scale": large }, { "mesh": 0, "scale": large }]);
    });
    refused(&["position", "finite"], |file| {
        file["buffers"][0]["uri"] =
            json!(format!("data:;base64,{}", base64(&[&f32::NAN.to_le_bytes()[..], &[0; 82]].concat())));
    });
    refused(&["image 0"], |file| {
        file["images"] = json!([{ "uri": "data:image/png;base64,AAAA" }]);
        file["textures"] = json!([{ "source": 0 }]);
        file["materials"][0]["pbrMetallicRoughness"] = json!({ "baseColorTexture": { "index": 0 } });
    });
    refused(&["image 0", "does not exist"], |file| {
        file["images"] = json!([{ "uri": "lost.png" }]);
        file["textures"] = json!([{ "source": 0 }]);
        file["materials"][0]["pbrMetallicRoughness"] = json!({ "baseColorTexture": { "index": 0 } });
    });
    refused(&["version is 1.0"], |file| file["asset"]["version"] = json!("1.0"));
    refused(&["no triangles"], |file| file["scenes"][0]["nodes"] = json!([]));
    let message = read_bytes("a.gltf", b"{ \"asset\": ", &[]).expect_err("cut off");
    assert!(message.contains("JSON") && message.contains("line 1"), "{message}");
}

/// A small file must not fill the memory through nodes that show a mesh repeatedly.
#[test]
fn nodes_that_multiply_a_mesh_are_limited() {
    for (nodes, phrases) in
        [(40_000_u32, ["corners", "make the mesh smaller"]), (1_400, ["mesh-mib", "make it smaller"])]
    {
        refused(&phrases, |file| {
            file["scenes"][0]["nodes"] = (0..nodes).collect();
            file["nodes"] = (0..nodes).map(|_| json!({ "mesh": 0 })).collect();
            file["accessors"][2]["count"] = json!(180_000);
        });
    }
}

/// Two bytes of JSON may expand to a thousand in memory.
#[test]
fn lists_of_empty_objects_are_limited() {
    let json = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"materials\":[{}{{}}]}}", "{},".repeat(5_000_000));
    let message = read_bytes("a.gltf", json.as_bytes(), &[]).expect_err("too many");
    assert!(message.contains("5000003 objects") && message.contains("mesh-mib"), "{message}");
}
