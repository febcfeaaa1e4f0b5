//! Shapes: default parameters, and textures placed by position.

use super::{ConvertedScene, SceneFile, read};
use crate::pbrt::tests::read_text;

#[test]
fn attributes_are_default_parameters_within_their_block() {
    let converted = ConvertedScene::new(
        "AttributeBegin\nAttribute \"shape\" \"float radius\" 0.25\nShape \"sphere\"\nShape \"sphere\" \"float radius\" 0.5\nAttributeEnd\n\
         Attribute \"material\" \"float eta\" 1.25\nMaterial \"dielectric\"\nShape \"sphere\"",
    );
    for phrase in ["radius_m = 0.25", "radius_m = 0.5", "radius_m = 1", "index = 1.25"] {
        assert!(converted.scene().contains(phrase), "{phrase}: {}", converted.scene());
    }
    let message = read("Attribute \"film\" \"float radius\" 1", &[]).err().expect("refused");
    assert!(message.starts_with("a.pbrt:4: `Attribute \"film\"`: expected shape, light"), "{message}");
}

#[test]
fn an_empty_included_file_is_no_error() {
    let empty = SceneFile { name: "empty.pbrt", bytes: b"" };
    read("Include \"empty.pbrt\"\nShape \"sphere\"", &[empty]).expect("a scene");
    let ball = SceneFile { name: "Ball.pbrt", bytes: b"Shape \"sphere\" \"float radius\" 0.125" };
    let converted = read("Include \"geometry\\ball.PBRT\"", &[ball]).expect("a scene");
    converted.assert_reports("an included file does not exist: `Ball.pbrt` is used (a.pbrt:4)");
    assert!(converted.scene().contains("radius_m = 0.125"), "{}", converted.scene());
}

/// A square of 2 m under a planar mapping, whose space is moved and twice as large: s = (x − 1)/2 + 0.25.
#[test]
fn planar_mappings_give_texture_coordinates_of_positions() {
    let converted = read_text(
        "LookAt 0 0 -5  0 0 0  0 1 0\nWorldBegin\nAttributeBegin\nTranslate 1 0 0\nScale 2 2 2\n\
         Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" \"planar\" \"vector3 v2\" [ 0 1 0 ] \"float udelta\" 0.25\nAttributeEnd\n\
         Material \"diffuse\" \"texture reflectance\" \"t\"\nTranslate 0 0 3\n\
         Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ]",
        &[],
    );
    let converted = converted.expect("a scene");
    let place = tempfile::tempdir().expect("a folder");
    let file = place.path().join("a.ply");
    std::fs::write(&file, converted.file("meshes/mesh.ply")).expect("written");
    let uvs = crate::scenery::Triangles::read(&file).expect("a mesh").uvs;
    // The texture has the offset of the mapping, the mesh its dot products; the image covers a period of 2.
    assert_eq!(uvs, [[-1.0, -0.5], [0.0, -0.5], [0.0, 0.5], [-1.0, 0.5]]);
    let scene = converted.scene();
    assert!(scene.contains("uv_scale = [0.5, 0.5]") && scene.contains("uv_offset = [0.125, 0]"), "{scene}");
}

/// A saddle of four corners: its area is between that of its flat halves and 1 % more, and power counts patches.
#[test]
fn curved_patches_are_divided() {
    let patch = "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0.5  0 1 0.5  1 1 0 ]";
    let converted = ConvertedScene::new(&format!("AreaLightSource \"diffuse\" \"float power\" 7\n{patch}"));
    converted.assert_reports("curved bilinear patches become 16 by 16 squares of two triangles");
    assert!(converted.scene().contains("luminous_flux_lm = 7"), "{}", converted.scene());
    let flat = ConvertedScene::new("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]");
    flat.assert_silent_about("curved");
}
