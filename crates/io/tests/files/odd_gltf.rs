//! glTF files as compressors and exporters of other programs write them.

use serde_json::json;

use super::gltf::{base64, changed, png, read_bytes, square};

/// Refused with the name of the extension and the command that removes it.
#[track_caller]
fn refused(message: Result<etendue_scene::asset::MeshAsset, String>, phrases: &[&str]) {
    let message = message.expect_err("compressed");
    assert!(message.starts_with("a.gltf: ") && phrases.iter().all(|phrase| message.contains(phrase)), "{message}");
}

#[test]
fn compressed_vertices_are_refused_with_the_command_that_expands_them() {
    for name in ["EXT_meshopt_compression", "KHR_draco_mesh_compression"] {
        let read = changed(|file| {
            file["extensionsUsed"] = json!([name]);
            file["extensionsRequired"] = json!([name]);
        });
        refused(read, &[name, "`gltf-transform copy in.glb out.glb`"]);
    }
    let read = changed(|file| {
        file["extensionsUsed"] = json!(["KHR_draco_mesh_compression"]);
        file["meshes"][0]["primitives"][0]["extensions"] =
            json!({ "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": {} } });
        file["accessors"][2].as_object_mut().expect("an accessor").remove("bufferView");
    });
    refused(read, &["mesh 0", "KHR_draco_mesh_compression"]);
    // gltfpack -cf omits the fallback buffer in some versions.
    let read = changed(|file| {
        file["extensionsUsed"] = json!(["EXT_meshopt_compression"]);
        file["buffers"]
            .as_array_mut()
            .expect("buffers")
            .push(json!({ "byteLength": 86, "extensions": { "EXT_meshopt_compression": { "fallback": true } } }));
        file["bufferViews"][0]["buffer"] = json!(1);
    });
    refused(read, &["EXT_meshopt_compression", "accessor 0"]);
}

#[test]
fn positions_need_no_bounds() {
    let mesh = changed(|file| {
        let accessor = file["accessors"][0].as_object_mut().expect("an accessor");
        for bound in ["min", "max"] {
            accessor.remove(bound);
        }
    });
    assert_eq!(mesh.expect("readable").triangles.len(), 2);
}

#[test]
fn fallbacks_of_compressed_vertices_are_used() {
    let plain = square();
    let mesh = changed(|file| {
        file["extensionsUsed"] = json!(["EXT_meshopt_compression", "KHR_draco_mesh_compression"]);
        file["buffers"][0]["extensions"] = json!({ "EXT_meshopt_compression": { "fallback": true } });
        file["meshes"][0]["primitives"][0]["extensions"] =
            json!({ "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": {} } });
    })
    .expect("readable");
    let expected = read_bytes("a.gltf", plain.to_string().as_bytes(), &[]).expect("readable");
    assert_eq!((mesh.positions, mesh.triangles), (expected.positions, expected.triangles));
    for name in ["EXT_meshopt_compression", "KHR_draco_mesh_compression"] {
        let note = format!("a.gltf: {name} is not used: the uncompressed data or image beside it is");
        assert!(mesh.report.contains(&note), "{:?}", mesh.report);
    }
}

/// The square with a texture whose extension names image 1, and image 0 as its own if `has_fallback`.
fn textured(name: &str, has_fallback: bool, image: &[u8]) -> Result<etendue_scene::asset::MeshAsset, String> {
    changed(|file| {
        let uri = |bytes: &[u8]| format!("data:image/png;base64,{}", base64(bytes));
        file["extensionsUsed"] = json!([name]);
        file["images"] = json!([{ "uri": uri(&png([255, 0, 0, 255])) }, { "uri": uri(image) }]);
        let mut texture = json!({ "extensions": { name: { "source": 1 } } });
        if has_fallback {
            texture["source"] = json!(0);
        } else {
            file["extensionsRequired"] = json!([name]);
        }
        file["textures"] = json!([texture]);
        file["materials"][0]["pbrMetallicRoughness"] = json!({ "baseColorTexture": { "index": 0 } });
    })
}

#[test]
fn images_beside_compressed_ones_are_used() {
    const KTX2: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n....";
    let mesh = textured("KHR_texture_basisu", true, KTX2).expect("readable");
    assert_eq!(mesh.embedded_images.len(), 1);
    assert!(mesh.report.iter().any(|note| note.contains("KHR_texture_basisu is not used")), "{:?}", mesh.report);
    refused(
        textured("KHR_texture_basisu", false, KTX2),
        &["texture 0", "KHR_texture_basisu", "gltf-transform ktxdecompress"],
    );
    refused(textured("EXT_texture_avif", false, b"...."), &["EXT_texture_avif", "gltf-transform png"]);
}

/// A WebP image (lossless, one texel): alone it is read; beside a PNG the PNG is used.
#[test]
fn webp_images_are_read() {
    let mesh = textured("EXT_texture_webp", false, WEBP).expect("readable");
    assert_eq!(mesh.embedded_images[0].1.width, 1);
    let mesh = textured("EXT_texture_webp", true, b"no image").expect("readable");
    assert!(mesh.report.iter().any(|note| note.contains("EXT_texture_webp is not used where")), "{:?}", mesh.report);
}

/// As Pillow 13.0.0 writes `Image.new("RGB", (1, 1), (200, 100, 50))` with `lossless=True`.
const WEBP: &[u8] = &[
    82, 73, 70, 70, 30, 0, 0, 0, 87, 69, 66, 80, 86, 80, 56, 76, 17, 0, 0, 0, 47, 0, 0, 0, 0, 7, 80, 178, 34, 87, 166,
    255, 129, 136, 232, 127, 0, 0,
];
