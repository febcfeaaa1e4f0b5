//! Meshes from the disk: complete, damaged, and real ones with known properties.

use etendue_testkit::skip::all_here;
use std::fs;
use std::path::Path;

use etendue_io::mesh::{read_mesh, read_mesh_frame};
use etendue_scene::asset::{MeshAsset, MeshFrameAsset, SlotReflectance, SlotSurface};

const CUBE_FACE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Reads a mesh of this text, with other files next to it.
fn read(text: &str, others: &[(&str, &str)]) -> Result<MeshAsset, String> {
    let folder = tempfile::tempdir().expect("temporary folder");
    for (name, content) in others {
        fs::write(folder.path().join(name), content).expect("write");
    }
    fs::write(folder.path().join("a.obj"), text).expect("write");
    let relative_text = |e: etendue_io::Error| e.to_string().replace(&format!("{}/", folder.path().display()), "");
    read_mesh(&folder.path().join("a.obj")).map_err(relative_text)
}

#[test]
fn a_missing_mesh_says_so() {
    let message = read_mesh(Path::new("nowhere/a.obj")).expect_err("missing").to_string();
    assert_eq!(message, "nowhere/a.obj: no such mesh file; check the path");
    assert_eq!(read("", &[]), Err("a.obj: this mesh file is empty".to_owned()));
}

#[test]
fn damage_is_named_with_its_line() {
    let complete = format!("{CUBE_FACE}f 1 2 3 4\n");
    let cut_in_a_vertex = &complete[..CUBE_FACE.len() - 4];
    assert_eq!(
        read(cut_in_a_vertex, &[]),
        Err("a.obj:4: `v`: expected 3 coordinates, found 1; the line may be truncated".to_owned())
    );
    let cut_in_a_face = &complete[..complete.len() - 5];
    assert_eq!(
        read(cut_in_a_face, &[]),
        Err("a.obj:5: `f`: expected 3 or more corners, found 2; the line may be truncated".to_owned())
    );
    let before_the_faces = read(CUBE_FACE, &[]).expect_err("no faces");
    assert!(before_the_faces.contains("no faces; the file may be truncated"), "{before_the_faces}");
    let without_an_end = read(complete.trim_end(), &[]).expect("still a mesh");
    assert_eq!(without_an_end.report, ["a.obj: the last line has no line end: the file may be truncated"]);
    assert_eq!(
        read(&format!("{CUBE_FACE}f 1 2 9\n"), &[]),
        Err("a.obj:5: vertex index 9 of the face is out of range (number of vertices: 4, counted from 1); the file is damaged or truncated".to_owned())
    );
    assert_eq!(
        read("v 0 0 0\r\nv 1 NaN 0\r\n", &[]),
        Err("a.obj:2: `NaN` is not finite; expected a finite number".to_owned())
    );
    assert_eq!(
        read("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", &[]),
        Err("a.obj:5: a polygon of 4 corners intersects itself; triangulate the mesh in the modelling program"
            .to_owned())
    );
}

#[test]
fn material_libraries_are_found_or_named() {
    let text = format!("mtllib my paints.mtl\n{CUBE_FACE}usemtl red\nf 1 2 3\nusemtl lost\nf 1 3 4\n");
    let alone = read(&text, &[]).expect("a mesh whose materials nobody says");
    assert_eq!(alone.missing_libraries.len(), 1);
    assert!(alone.missing_libraries[0].starts_with("line 1: the material library `"), "{alone:?}");
    assert!(alone.missing_libraries[0].ends_with("my paints.mtl` does not exist"), "{alone:?}");
    assert!(alone.slot_materials.iter().all(|slot| slot.surface.is_none()));
    assert_eq!(
        read(&text, &[("my paints.mtl", "newmtl red\nKd 0.5 oh 0\n")]),
        Err("my paints.mtl:2: `Kd 0.5 oh 0`: `oh` is not a number; expected three numbers of 0 or more".to_owned())
    );
    let mesh = read(&text, &[("my paints.mtl", "newmtl red\nKd 0.5 0 0\nKs 1 1 1\nNs 6\nNi 1.4\nsharpness 60\n")])
        .expect("whole");
    assert_eq!(mesh.slots, [0, 1]);
    let reflectance = SlotReflectance::LinearSrgb([0.5, 0.0, 0.0]);
    assert_eq!(mesh.slot_materials[0].surface, Some(SlotSurface::Coated { reflectance, index: 1.4, alpha: 0.5 }));
    assert_eq!(mesh.slot_materials[1].surface, None);
    assert_eq!(mesh.report, ["my paints.mtl:6: material \"red\": `sharpness` is not used"]);
}

#[test]
fn the_hash_covers_the_library() {
    let text = format!("mtllib a.mtl\n{CUBE_FACE}f 1 2 3\n");
    let hash = |library: &str| read(&text, &[("a.mtl", library)]).expect("whole").hash;
    assert_eq!(hash("newmtl a\n"), hash("newmtl a\n"));
    assert_ne!(hash("newmtl a\n"), hash("newmtl b\n"));
}

#[test]
fn texture_options_lie_in_the_texture_coordinates() {
    let library = "newmtl plain\nmap_Kd a.png\nnewmtl tiled\nmap_Kd -s 2 3 1 -o 0.5 0.25 a.png\n";
    let face = "vt 1 1\nvt 0 1\nvt 0 0\n";
    let text = format!("mtllib a.mtl\n{CUBE_FACE}{face}usemtl plain\nf 1/1 2/2 3/3\nusemtl tiled\nf 1/1 2/2 3/3\n");
    let mesh = read(&text, &[("a.mtl", library)]).expect("whole");
    assert_eq!(mesh.positions.len(), 6, "no vertex is shared between layouts");
    assert_eq!(mesh.uvs[..3], [[1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]);
    assert_eq!(mesh.uvs[3..], [[2.5, 3.25], [0.5, 3.25], [0.5, 0.25]]);
}

#[test]
fn faces_without_normals_are_flat_among_faces_with_them() {
    let text = format!("{CUBE_FACE}vn 0 0.6 0.8\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n");
    let mesh = read(&text, &[]).expect("whole");
    assert_eq!(mesh.normals[..3], [[0.0, 0.6, 0.8]; 3]);
    assert_eq!(mesh.normals[3..], [[0.0, 0.0, 1.0]; 3]);
    assert_eq!(mesh.report, ["a.obj: vertices without a usable normal, which use that of their face: 3"]);
}

#[test]
fn lines_that_tobj_would_misread_are_not_faces_and_do_not_part_the_data() {
    let forms = "l 1 2 3\nf 1 2 3 \\\n 4 # square\nvt 0.25\nf 1/1 2/1 3/1\nf 1 3 4\n";
    let mesh = read(&format!("v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\n{forms}"), &[]).expect("whole");
    assert_eq!(mesh.triangles.len(), 4, "two of the square, the others as they are, none of the line");
    let uvs: Vec<[f32; 2]> = mesh.triangles.iter().map(|t| mesh.uvs[t[1] as usize]).collect();
    assert_eq!(uvs, [[0.0; 2], [0.0; 2], [0.25, 0.0], [0.0; 2]]);
}

#[test]
fn a_mesh_far_from_its_origin_keeps_its_coordinates() {
    let text = "v 451000.1 5411000 0.05\nv 451001.2 5411000 0\nv 451000.1 5411001.3 0\nf 1 2 3\n";
    let mesh = read(text, &[]).expect("whole");
    assert!(mesh.report.is_empty(), "{:?}", mesh.report);
    let place = |i: usize, axis: usize| mesh.origin[axis] + f64::from(mesh.positions[i][axis]);
    for (i, expected) in [[451_000.1, 5_411_000.0, 0.05], [451_001.2, 5_411_000.0, 0.0], [451_000.1, 5_411_001.3, 0.0]]
        .into_iter()
        .enumerate()
    {
        // Half a unit in the last place of f32 at 0.65, and of f64 at 5.4e6.
        (0..3).for_each(|axis| assert!((place(i, axis) - expected[axis]).abs() < 4e-8, "{i} {axis}"));
    }
    let near = read("v 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n", &[]).expect("whole");
    assert_eq!((near.origin, near.positions[1]), ([0.0; 3], [2.0, 0.0, 0.0]), "others are as they stand in the file");
    assert_eq!(
        read("v 0 0 0\nv 1e39 0 0\n", &[]),
        Err("a.obj:2: coordinate 1e39 is beyond the range of 32-bit floats".to_owned())
    );
}

/// Files of Kenney's city kit (CC0) with their triangles and the corners of their boxes, counted by a few lines of another language: words after `f` minus two,
/// minimum and maximum of the words after `v`.
const KENNEY: [(&str, usize, [[f32; 3]; 2]); 5] = [
    ("building-garage.obj", 196, [[-0.5, 0.0, -0.5], [0.5, 0.55, 0.5]]),
    ("building-small-b.obj", 600, [[-0.5, 0.0, -0.5], [0.5, 1.6265, 0.5]]),
    ("building-small-d.obj", 448, [[-0.5, 0.0, -0.5], [0.5, 1.0, 0.55]]),
    ("grass-trees-tall.obj", 472, [[-0.5, 0.0, -0.5], [0.571934, 0.759642, 0.506164]]),
    ("road-corner.obj", 126, [[-0.5, 0.0, -0.5], [0.5, 0.06, 0.5]]),
];

fn bounds(mesh: &MeshAsset) -> [[f32; 3]; 2] {
    let bound = |pick: fn(f32, f32) -> f32| {
        mesh.positions.iter().copied().reduce(|a, b| std::array::from_fn(|i| pick(a[i], b[i]))).expect("vertices")
    };
    [bound(f32::min), bound(f32::max)]
}

#[test]
fn real_meshes_have_the_triangles_and_bounds_of_their_text() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets/kenney-city");
    if !all_here("real_meshes_have_the_triangles_and_bounds_of_their_text", &[&folder]) {
        return;
    }
    for (name, triangles, expected) in KENNEY {
        let mesh = read_mesh(&folder.join(name)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((mesh.triangles.len(), bounds(&mesh)), (triangles, expected), "{name}");
        assert_eq!(mesh.slots.len(), mesh.triangles.len());
        assert!(mesh.normals.len() == mesh.positions.len() && mesh.uvs.len() == mesh.positions.len());
        let Some(SlotSurface::Diffuse { reflectance: SlotReflectance::Image(path) }) = &mesh.slot_materials[0].surface
        else {
            panic!("{name}: {:?}", mesh.slot_materials);
        };
        etendue_io::picture::read_image(path).unwrap_or_else(|e| panic!("{e}"));
    }
}

/// Reads a file of a mesh with moving vertices.
fn frame(text: &str) -> MeshFrameAsset {
    let folder = tempfile::tempdir().expect("temporary folder");
    fs::write(folder.path().join("a.obj"), text).expect("write");
    read_mesh_frame(&folder.path().join("a.obj")).expect("readable")
}

/// Exporters write equal normals once and may order vertices differently: the values of the faces count, not their indices.
#[test]
fn files_of_one_mesh_are_known_by_their_faces() {
    let two = "f 1//1 2//1 3//1 4//1\nf 4//1 3//1 2//1 1//1\n";
    let first = frame(&format!("{CUBE_FACE}vn 0 0 1\n{two}"));
    let bent =
        frame("v 0 0 0\nv 1 1 5\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nf 1//1 3//2 2//1 4//1\nf 4//1 2//1 3//1 1//1\n");
    assert_eq!(bent.difference(&first), None);
    assert_eq!(first.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
    let corner = |frame: &MeshFrameAsset, i: usize| {
        let part = &frame.parts[0];
        (part.positions[part.vertices[i] as usize], part.normals[part.normal_indices[i] as usize])
    };
    assert_eq!(corner(&bent, 2), ([1.0, 1.0, 5.0], [0.0, 0.0, 1.0]));
    assert_eq!(corner(&bent, 1), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    let turned = frame(&format!("{CUBE_FACE}vn 0 0 1\n{}", two.replace("f 4//1 3//1", "f 3//1 4//1")));
    let [own, other] = turned.difference(&first).expect("other faces");
    assert!(own.contains("face 2") && other.contains("different vertices"), "{own} / {other}");
    let bare = frame(&format!("{CUBE_FACE}f 1 2 3 4\nf 4 3 2 1\n"));
    assert!(bare.difference(&first).expect("no normals")[0].contains("without normals"));
}
