//! Normal maps against the closed form of a tilted surface, on images in normal orientation, mirrored and upside down.
//!
//! A diffuse card under parallel light of E lx from l has the luminance ρ E n·l/π cd/m², where n is its normal. A map of one colour (x, y, z) tilts
//! it to n = x·T + y·B + z·N, normalised: T points to the right of the image, B to its top (glTF: the bitangent cross(N, T)·w, w = −1 where the image
//! is mirrored), N is the card's own. In Mitsuba B is N × T for any orientation of the image, as rendered by version 3.9.1.

use crate::mitsuba::pixels;
use crate::support::{etendue, text};
use etendue_core::maths::f64::{asin, atan2};
use etendue_io::inspect::Preview;
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

/// Direction to the light, in the card's right, up and normal.
const LIGHT: [f64; 3] = [0.36, 0.48, 0.8];
const ILLUMINANCE: f64 = 1000.0;
const REFLECTANCE: f64 = 0.5;

/// Maps of one colour: tilted to the right of the image, and to its top.
const MAPS: [(&str, [u8; 3]); 2] = [("right.png", [204, 128, 230]), ("top.png", [128, 204, 230])];

/// The corners of the card, seen from its front: bottom left, bottom right, top right, top left.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Orientation of an image on the card: positions of the corners in it (to the right, upwards), and directions of its right and its top on the card.
struct ImageOrientation {
    name: &'static str,
    corners: [[f64; 2]; 4],
    right: [f64; 2],
    top: [f64; 2],
}

const ORIENTATIONS: [ImageOrientation; 4] = [
    ImageOrientation {
        name: "as it is",
        corners: [[0., 0.], [1., 0.], [1., 1.], [0., 1.]],
        right: [1., 0.],
        top: [0., 1.],
    },
    ImageOrientation {
        name: "mirrored",
        corners: [[1., 0.], [0., 0.], [0., 1.], [1., 1.]],
        right: [-1., 0.],
        top: [0., 1.],
    },
    ImageOrientation {
        name: "upside down",
        corners: [[0., 1.], [1., 1.], [1., 0.], [0., 0.]],
        right: [1., 0.],
        top: [0., -1.],
    },
    ImageOrientation {
        name: "turned by 90°",
        corners: [[0., 1.], [0., 0.], [1., 0.], [1., 1.]],
        right: [0., 1.],
        top: [-1., 0.],
    },
];

fn maps_in(folder: &Path) {
    for (name, colour) in MAPS {
        let png = Preview { width: 4, height: 4, rgb: vec![colour; 16] }.to_png().expect("a PNG");
        fs::write(folder.join(name), png).expect("written");
    }
}

/// Luminance of the card with a normal tilted by a map, cd/m².
fn expected(colour: [u8; 3], right: [f64; 2], top: [f64; 2]) -> f64 {
    // Bytes of 127 and 128 both represent 0.
    let [x, y, z] = colour.map(|c| if c == 128 { 0.0 } else { f64::from(c) / 127.5 - 1.0 });
    let normal = [x * right[0] + y * top[0], x * right[1] + y * top[1], z];
    let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
    let cosine = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum::<f64>() / length;
    REFLECTANCE * ILLUMINANCE * cosine / PI
}

/// Mean luminance of the only camera of a job that sees nothing except the card.
fn luminance(job: &Path, camera: &str) -> f64 {
    let out = job.with_file_name("out");
    etendue(["render", &text(job), "-o", &text(&out), "--overwrite", "--spp", "64"]).ok();
    let (_, pixels) = pixels(&out.join(camera).join("radiance.exr"));
    let bright = pixels.iter().map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b).sum::<f64>();
    bright / pixels.len() as f64
}

/// Only wavelengths cause noise: 0.05 % of a mean of 96 pixels of 64 samples; six standard deviations are allowed.
#[track_caller]
fn assert_same(actual: f64, expected: f64, what: &str) {
    assert!((actual - expected).abs() <= 0.003 * expected, "{what}: {actual} cd/m² for {expected}");
}

/// Makes the cameras of an imported job small.
fn shrink_cameras(folder: &Path) -> std::path::PathBuf {
    let job = folder.join("made/job.toml");
    let job_text = fs::read_to_string(&job).expect("a job");
    let changed = job_text.replace(
        "width_px = 720, height_px = 480, pixel_pitch_um = 50",
        "width_px = 12, height_px = 8, pixel_pitch_um = 3000",
    );
    fs::write(&job, changed).expect("written");
    job
}

#[test]
fn our_own_maps_tilt_the_card() {
    for ImageOrientation { name, corners: places, right, top } in ORIENTATIONS {
        let place = tempfile::tempdir().expect("a temporary folder");
        maps_in(place.path());
        let mut card: String = CORNERS.iter().map(|[x, y]| format!("v 0 {x} {y}\n")).collect();
        card.extend(places.iter().map(|[u, v]| format!("vt {u} {v}\n")));
        fs::write(place.path().join("card.obj"), card + "f 1/1 2/2 3/3 4/4\n").expect("written");
        let [x, y, z] = LIGHT;
        let (azimuth, elevation) = (atan2(x, z).to_degrees(), asin(y).to_degrees());
        for (map, colour) in MAPS {
            for (green, sign) in [("up", 1.0), ("down", -1.0)] {
                let job = place.path().join("job.toml");
                let message = format!(
                    "format = 1\n[scene]\n[[scene.meshes]]\nname = \"card\"\nfile = \"card.obj\"\nup_axis = \"z\"\n\
                     [[scene.textures]]\nname = \"map\"\nfile = \"{map}\"\nencoding = \"data\"\n\
                     [[scene.materials]]\nname = \"matt\"\ntype = \"diffuse\"\nreflectance = {REFLECTANCE}\n\
                     normal_map = {{ texture = \"map\", y = \"{green}\" }}\n\
                     [[scene.objects]]\nname = \"card\"\nmesh = \"card\"\nmaterial = \"matt\"\n\
                     [[scene.lights]]\nname = \"sun\"\ntype = \"sun\"\nazimuth_deg = {azimuth}\nelevation_deg = {elevation}\n\
                     illuminance_lx = {ILLUMINANCE:.1}\nangular_diameter_deg = 0.01\nilluminant = \"D65\"\n\
                     [[cameras]]\nname = \"eye\"\nposition_m = [3, 0, 0]\nlook_at_m = [0, 0, 0]\n\
                     lens = {{ type = \"pinhole\", focal_length_mm = 50, f_number = 8 }}\n\
                     sensor = {{ width_px = 12, height_px = 8, pixel_pitch_um = 100 }}\n[output]\nradiance = true\n"
                );
                fs::write(&job, message).expect("written");
                let expected = expected(colour, right, top.map(|c| c * sign));
                assert_same(luminance(&job, "eye"), expected, &format!("{name}, {map}, green {green}"));
            }
        }
    }
}

/// A card in glTF's frame, y up and facing +z; v points down there.
fn gltf(places: &[[f64; 2]; 4], map: &str, mirrored: bool) -> (Value, Vec<u8>) {
    let positions = CORNERS.iter().flat_map(|[x, y]| [*x, *y, 0.0]);
    let floats = positions.chain(places.iter().flat_map(|[u, v]| [*u, 1.0 - v])).map(|c| c as f32);
    let mut bytes: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
    bytes.extend([0, 1, 2, 0, 2, 3]);
    let [x, y, z] = LIGHT;
    // From +z to the light: a light emits along its −z.
    let long = (2.0 * (1.0 + z)).sqrt();
    let file = json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0, 1, 2] }],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "directional", "intensity": ILLUMINANCE }] } },
        "nodes": [
            { "mesh": 0, "scale": [if mirrored { -1 } else { 1 }, 1, 1] },
            { "rotation": [-y / long, x / long, 0.0, (1.0 + z) / long], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
            { "camera": 0, "translation": [0, 0, 3] }
        ],
        "cameras": [{ "type": "perspective", "name": "eye", "perspective": { "yfov": 0.2, "aspectRatio": 1.5, "znear": 0.1 } }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
        "materials": [{ "pbrMetallicRoughness": { "baseColorFactor": [REFLECTANCE, REFLECTANCE, REFLECTANCE, 1], "metallicFactor": 0 },
                        "normalTexture": { "index": 0 } }],
        "textures": [{ "source": 0 }],
        "images": [{ "uri": map }],
        "buffers": [{ "byteLength": 86, "uri": "card.bin" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
                        { "buffer": 0, "byteOffset": 80, "byteLength": 6 }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR" }
        ]
    });
    (file, bytes)
}

/// For the last orientation a mirrored node replaces the mirrored image.
#[test]
fn maps_of_gltf_tilt_the_card() {
    for ImageOrientation { name, corners: places, right, top } in ORIENTATIONS {
        for (map, colour) in MAPS {
            for mirrored in [false, true] {
                let place = tempfile::tempdir().expect("a temporary folder");
                maps_in(place.path());
                let (file, bytes) = gltf(&places, map, mirrored);
                fs::write(place.path().join("card.gltf"), file.to_string()).expect("written");
                fs::write(place.path().join("card.bin"), bytes).expect("written");
                etendue(["import", &text(&place.path().join("card.gltf")), "-o", &text(&place.path().join("made"))])
                    .ok();
                let in_image = |[x, y]: [f64; 2]| if mirrored { [-x, y] } else { [x, y] };
                let expected = expected(colour, in_image(right), in_image(top));
                assert_same(
                    luminance(&shrink_cameras(place.path()), "eye"),
                    expected,
                    &format!("{name}, {map}, mirrored {mirrored}"),
                );
            }
        }
    }
}

/// A Mitsuba shape under a map, seen from the front; the camera looks along −z, x to the right, y up.
fn mitsuba(shape: &str, map: &str) -> String {
    let [x, y, z] = LIGHT.map(|c| -c);
    format!(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\" id=\"eye\"><float name=\"fov\" value=\"10\"/>\
         <transform name=\"to_world\"><lookat origin=\"0, 0, 3\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform>\
         <film type=\"hdrfilm\"><integer name=\"width\" value=\"12\"/><integer name=\"height\" value=\"8\"/></film></sensor>\
         <emitter type=\"directional\"><vector name=\"direction\" value=\"{x}, {y}, {z}\"/><rgb name=\"irradiance\" value=\"{ILLUMINANCE}\"/></emitter>\
         <bsdf type=\"normalmap\" id=\"bumps\"><texture name=\"normalmap\" type=\"bitmap\"><string name=\"filename\" value=\"{map}\"/>\
         <boolean name=\"raw\" value=\"true\"/></texture><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"{REFLECTANCE}\"/></bsdf></bsdf>\
         {shape}</scene>"
    )
}

#[test]
fn maps_of_mitsuba_tilt_the_card() {
    let across = |[x, y]: [f64; 2]| [-y, x];
    let rectangle = ("<shape type=\"rectangle\"><ref id=\"bumps\"/></shape>".to_owned(), [1.0, 0.0]);
    let mesh = "<shape type=\"obj\"><string name=\"filename\" value=\"card.obj\"/><ref id=\"bumps\"/>TURN</shape>";
    let mirror = "<transform name=\"to_world\"><scale x=\"-1\"/></transform>";
    for ImageOrientation { name, corners: places, right, .. } in ORIENTATIONS {
        let place = tempfile::tempdir().expect("a temporary folder");
        maps_in(place.path());
        let mut card: String = CORNERS.iter().map(|[x, y]| format!("v {x} {y} 0\n")).collect();
        card.extend(places.iter().map(|[u, v]| format!("vt {u} {v}\n")));
        card.push_str("vn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n");
        fs::write(place.path().join("card.obj"), card).expect("written");
        let shapes = [
            rectangle.clone(),
            (mesh.replace("TURN", ""), right),
            (mesh.replace("TURN", mirror), [-right[0], right[1]]),
        ];
        for ((shape, right), (map, colour)) in shapes.iter().flat_map(|shape| MAPS.map(|map| (shape, map))) {
            fs::write(place.path().join("card.xml"), mitsuba(shape, map)).expect("written");
            let imported = text(&place.path().join("made"));
            etendue(["import", &text(&place.path().join("card.xml")), "-o", &imported, "--overwrite"]).ok();
            let expected = expected(colour, *right, across(*right));
            assert_same(
                luminance(&place.path().join("made/job.toml"), "eye"),
                expected,
                &format!("{name}, {map}, {shape}"),
            );
        }
    }
}
