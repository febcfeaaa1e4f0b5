//! PLY: files of another program compared with that program's own results, the same mesh as OBJ, and damaged files.

use etendue_io::mesh::read_mesh;
use etendue_scene::asset::MeshAsset;
use glam::DVec3;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn oracle(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/oracles/figures/ply").join(name)
}

fn read_bytes(name: &str, bytes: &[u8]) -> Result<MeshAsset, String> {
    let folder = tempfile::tempdir().expect("temporary folder");
    fs::write(folder.path().join(name), bytes).expect("written");
    let relative_text = |e: etendue_io::Error| e.to_string().replace(&format!("{}/", folder.path().display()), "");
    read_mesh(&folder.path().join(name)).map_err(relative_text)
}

fn corners(mesh: &MeshAsset) -> Vec<[DVec3; 3]> {
    let place = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from)) + DVec3::from_array(mesh.origin);
    mesh.triangles.iter().map(|t| t.map(place)).collect()
}

/// The files have 32 bits, or eight digits, of coordinates up to 300 m: 1.5e-5 m of rounding, over areas of 14.6 m² and volumes of 4.6 m³.
#[test]
fn files_of_another_program_stand_as_that_program_has_them() {
    let figures: Value = serde_json::from_slice(&fs::read(oracle("figures.json")).expect("figures")).expect("JSON");
    for name in ["little", "big", "text"] {
        let mesh = read_mesh(&oracle(&format!("{name}.ply"))).unwrap_or_else(|e| panic!("{e}"));
        let number = |key: &str| figures[name][key].as_f64().expect("a figure");
        assert_eq!(mesh.positions.len() as f64, number("vertices"), "{name}");
        assert_eq!(mesh.triangles.len() as f64, number("triangles"), "{name}");
        let actual = corners(&mesh);
        let area: f64 = actual.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum();
        assert!((area - number("area")).abs() < 1e-3, "{name}: {area}");
        let middle = DVec3::from_array(mesh.origin);
        let volume: f64 = actual.iter().map(|t| t.map(|p| p - middle)).map(|[a, b, c]| a.cross(b).dot(c) / 6.0).sum();
        assert!((volume - number("volume")).abs() < 1e-3, "{name}: {volume}, which tells the winding");
        for (i, pick) in [DVec3::min as fn(DVec3, DVec3) -> DVec3, DVec3::max].into_iter().enumerate() {
            let bound = actual.iter().flatten().copied().reduce(pick).expect("corners").to_array();
            for (axis, coordinate) in bound.into_iter().enumerate() {
                let expected = figures[name]["bounds"][i][axis].as_f64().expect("a bound");
                assert!((coordinate - expected).abs() < 2e-5, "{name}: {coordinate} for {expected}");
            }
        }
        for (axis, component) in mesh.normals[0].into_iter().enumerate() {
            let expected = figures[name]["first normal"][axis].as_f64().expect("a normal");
            assert!((f64::from(component) - expected).abs() < 1e-6, "{name}: {component} for {expected}");
        }
        let colours = format!("{name}.ply: vertex and face colours are not used: give the object a material");
        assert_eq!(mesh.report, [colours]);
    }
    let [little, big] = ["little.ply", "big.ply"].map(|name| read_mesh(&oracle(name)).expect("read"));
    assert_eq!(
        (little.positions, little.normals, little.triangles, little.origin),
        (big.positions, big.normals, big.triangles, big.origin),
        "the order of bytes is all that parts them"
    );
}

const STAR: &str = "ply\r\nformat ascii 1.0\r\ncomment TextureFile star.png\r\nelement vertex 5\r\nproperty float x\r\nproperty double y\r\n\
    property int z\r\nproperty float s\r\nproperty float t\r\nproperty float confidence\r\nelement face 1\r\nproperty uchar flags\r\n\
    property list uchar uint vertex_index\r\nelement edge 1\r\nproperty int vertex1\r\nproperty int vertex2\r\nend_header\r\n\
    0 0 0 0 0 1\r\n2 0 0 1 0 1\r\n2 2 0 1 1 1\r\n1 0.5 0 .5 .25 1\r\n0 2 0 0 1 1\r\n7 5 0 1 2 3 4\r\n0 1\r\n";

#[test]
fn a_concave_polygon_is_that_of_an_obj_file() {
    let actual = read_bytes("a.ply", STAR.as_bytes()).expect("read");
    let obj = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt .5 .25\nvt 0 1\nf 1/1 2/2 3/3 4/4 5/5\n";
    let other = read_bytes("a.obj", obj.as_bytes()).expect("read");
    assert_eq!(
        (&actual.positions, &actual.uvs, &actual.triangles, &actual.slots),
        (&other.positions, &other.uvs, &other.triangles, &other.slots)
    );
    assert_eq!(
        actual.report,
        [
            "a.ply: properties that are not used: confidence, flags",
            "a.ply: the image `star.png` is not used: give it as a texture of the object's material",
            "a.ply: elements `edge`, which are not used: 1",
        ]
    );
}

#[test]
fn corners_have_texture_coordinates_of_their_own() {
    let file = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n\
        property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n3 0 2 1 0\n";
    let mesh = read_bytes("a.ply", file.as_bytes()).expect("read");
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(mesh.uvs, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0; 2], [0.0; 2], [0.0; 2]]);
    assert_eq!(mesh.positions[4], [0.0, 1.0, 0.0]);
}

#[test]
fn strips_turn_every_other_triangle_round() {
    let mut file =
        b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty short x\nproperty short y\nproperty char z\n\
        element tristrips 1\nproperty list int short vertex_indices\nend_header\n"
            .to_vec();
    for [x, y] in [[0_i16, 0], [1, 0], [0, 1], [1, 1]] {
        file.extend([x.to_be_bytes(), y.to_be_bytes()].concat());
        file.push(0);
    }
    file.extend(9_i32.to_be_bytes());
    file.extend([0_i16, 1, 2, 3, -1, 1, 3, 0, 2].into_iter().flat_map(i16::to_be_bytes));
    let mesh = read_bytes("a.ply", &file).expect("read");
    assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [1, 3, 0], [0, 3, 2]]);
    let turned = corners(&mesh).iter().filter(|[a, b, c]| (*b - *a).cross(*c - *a).z < 0.0).count();
    assert_eq!(turned, 0, "all face upwards");
}

#[test]
fn zero_normals_are_those_of_a_face() {
    let file = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
        property float nz\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 0\n1 0 0 0 3 4\n0 1 0 0 0 1\n3 0 1 2";
    let mesh = read_bytes("a.ply", file.as_bytes()).expect("read, though the last line has no end");
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0], [0.0, 0.6, 0.8], [0.0, 0.0, 1.0]]);
    assert_eq!(mesh.report, ["a.ply: vertices without a usable normal, which use that of a face: 1"]);
}

#[track_caller]
fn refused(bytes: &[u8], expected: &str) {
    assert_eq!(read_bytes("a.ply", bytes).expect_err("damaged"), expected);
}

/// The star after a change.
#[track_caller]
fn refused_star(from: &str, to: &str, expected: &str) {
    assert!(STAR.contains(from));
    refused(STAR.replace(from, to).as_bytes(), expected);
}

#[test]
fn damaged_heads_are_refused_with_their_line() {
    refused(b"v 0 0 0\n", "a.ply:1: not a PLY file: the first line is not `ply`");
    refused(
        b"ply\nformat ascii 1.0\n",
        "a.ply:3: the header has no `end_header` within 21 bytes: the file may be truncated",
    );
    refused_star(
        "ascii 1.0",
        "binary 1.0",
        "a.ply:2: found `format binary 1.0`; expected `format ascii 1.0`, `format binary_little_endian 1.0` or `format binary_big_endian 1.0`",
    );
    refused_star(
        "element vertex 5",
        "element vertex -5",
        "a.ply:4: the element count is `-5`; expected a whole number of 0 or more",
    );
    refused_star(
        "property double y",
        "property real y",
        "a.ply:6: unknown type `real`; expected char, uchar, short, ushort, int, uint, float, double, or int8 … float64",
    );
    refused_star("double y", "double x", "a.ply:6: the property `x` is declared twice in one element");
    refused_star(
        "list uchar",
        "list float",
        "a.ply:13: the count type of a list is not an integer type; expected a type such as uchar",
    );
}

#[test]
fn damaged_rows_are_refused_with_their_line() {
    refused_star(
        "2 2 0",
        "2 nan 0",
        "a.ply:20: vertex 2: a number is not finite (NaN or infinity): correct the mesh in the modelling program",
    );
    refused_star("2 2 0", "2 1e39 0", "a.ply:20: vertex 2: coordinate 1e39 is beyond the range of 32-bit floats");
    refused_star("2 2 0", "2 2 .5", "a.ply:20: vertex 2: `.5` is not a whole number, which the header states");
    refused_star("2 2 0", "2 two 0", "a.ply:20: vertex 2: `two` is not a number");
    refused_star(
        "7 5 0 1 2 3 4",
        "7 5 0 1 2 3 5",
        "a.ply:23: face 0: index 5 is out of range: there are 5 vertices, counted from 0; the file is damaged; export or copy it again",
    );
    refused_star("7 5 0 1 2 3 4", "7 2 0 1", "a.ply:23: face 0: has 2 corners; expected three or more");
    refused_star(
        "7 5 0 1 2 3 4",
        "7 4 0 2 1 4",
        "a.ply:23: face 0: a polygon of 4 corners intersects itself; triangulate the mesh in the modelling program",
    );
    let length = STAR.len();
    let message = read_bytes("a.ply", &STAR.as_bytes()[..length - 5]).expect_err("truncated");
    assert_eq!(
        message,
        "a.ply:23: the header states 1 × element `edge`, for which the file is too short: it is truncated, or its header is wrong; export or copy it again"
    );
    refused_star(
        "element face 1\r\n",
        "element face 0\r\n",
        "a.ply:23: 17 bytes follow the last element: the header does not describe the whole file; export or copy it again",
    );
    refused_star(
        "7 5 0 1 2 3 4\r\n",
        "",
        "a.ply:24: face 0: the file ends within its elements: it is truncated; export or copy it again",
    );
}

/// Sizes stated in a header are compared with the file before memory is allocated.
#[test]
fn huge_counts_are_refused_at_once() {
    for (from, to, element) in [
        ("element vertex 5", "element vertex 4294967295", "4294967295 × element `vertex`"),
        ("element face 1", "element face 18446744073709551615", "18446744073709551615 × element `face`"),
        ("element edge 1", "element edge 99999999999", "99999999999 × element `edge`"),
    ] {
        let message = read_bytes("a.ply", STAR.replace(from, to).as_bytes()).expect_err("too many");
        assert!(message.contains(element) && message.contains("too short"), "{message}");
    }
    refused_star(
        "7 5 0 1 2 3 4",
        "7 250 0 1 2 3 4",
        "a.ply:23: face 0: the list `vertex_index` has 250 numbers, for which the file is too short: it is truncated; export or copy it again",
    );
}

/// Numbers of another byte order than the header states: a face with an index beyond the vertices reveals it.
#[test]
fn the_wrong_byte_order_is_reported() {
    let little = fs::read(oracle("little.ply")).expect("a file");
    let head = little.windows(11).position(|w| w == b"end_header\n").expect("a head");
    let text = String::from_utf8(little[..head].to_vec()).expect("text").replace("little_endian", "big_endian");
    let bytes = [text.as_bytes(), &little[head..]].concat();
    let message = read_bytes("a.ply", &bytes).expect_err("the wrong order");
    assert!(
        message.starts_with("a.ply: ")
            && message
                .ends_with("or its numbers are little-endian although the header states big-endian; export it again"),
        "{message}"
    );
    for end in [little.len() - 1, little.len() / 2, head + 20] {
        let message = read_bytes("a.ply", &little[..end]).expect_err("truncated");
        assert!(message.contains("truncated"), "{message}");
    }
}
