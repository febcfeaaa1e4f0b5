//! Images on shapes of other programs, and inline spectra: the levels of those programs.

use crate::support::{etendue, text};
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_io::photograph::Encoding;
use etendue_io::png::encode_display;
use std::fs;
use std::path::Path;

/// Red, green; blue, white: rows from the top.
fn write_image(folder: &Path) {
    const SIDE: usize = 64;
    let colour = |i: usize| match (i % SIDE < SIDE / 2, i / SIDE < SIDE / 2) {
        (true, true) => [1.0, 0.0, 0.0],
        (false, true) => [0.0, 1.0, 0.0],
        (true, false) => [0.0, 0.0, 1.0],
        (false, false) => [1.0; 3],
    };
    let plane = Plane::<Display>::from_samples(SIDE, SIDE, (0..SIDE * SIDE).map(colour).collect()).expect("a square");
    let bytes = encode_display(&plane, &Encoding::Srgb).expect("a picture");
    fs::write(folder.join("four.png"), bytes).expect("written");
}

/// Returns the mean of the preview in linear sRGB in the middle of a scene, in uniform light of 1, and the messages of the import.
fn mean(scene: &str) -> ([f64; 3], String) {
    let place = tempfile::tempdir().expect("a folder");
    write_image(place.path());
    let (file, imported, out) = (place.path().join("a.pbrt"), place.path().join("made"), place.path().join("out"));
    let scene_text = format!(
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12\nLookAt 0 0 -5  0 0 0  0 1 0\n\
         Camera \"perspective\" \"float fov\" 4.56\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n{scene}\n"
    );
    fs::write(&file, scene_text).expect("written");
    let notes = etendue(["import", &text(&file), "-o", &text(&imported)]).ok().err.clone();
    etendue(["render", &text(&imported.join("job.toml")), "-o", &text(&out), "--spp", "64"]).ok();
    let inspected = etendue(["inspect", &text(&out.join("camera/radiance.exr"))]).ok();
    let channel = |name: &str| -> f64 {
        let line = inspected.out.lines().find(|line| line.split_whitespace().next() == Some(name)).expect("a preview");
        line.split_whitespace().nth(3).expect("a mean").parse().expect("a number")
    };
    (["R", "G", "B"].map(channel), notes)
}

const PICTURE: &str = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"four.png\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n";

/// Values of pbrt-v4 where no derivation is given. Spectra of saturated reflectances differ between the programs by up to 1 %, and the noise of
/// wavelengths at 64 samples of 144 pixels is 0.3 %: 0.02 is allowed.
fn assert_mean(scene: &str, expected: [f64; 3]) {
    let (actual, _) = mean(scene);
    let is_near = actual.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.02);
    assert!(is_near, "{actual:?}, expected {expected:?}: {scene}");
}

#[test]
fn pictures_lie_on_round_shapes_of_pbrt_as_there() {
    let sphere = |turn: &str, part: &str| format!("{PICTURE}{turn} Shape \"sphere\" \"float radius\" 1 {part}");
    assert_mean(&sphere("", ""), [0.5, 0.5, 0.992]);
    assert_mean(&sphere("Rotate -90 1 0 0\nRotate 30 0 0 1", ""), [0.5, 0.0, 0.501]);
    // For a cap about the pole the lower half of the image covers the inner half of the angle.
    assert_mean(&sphere("", "\"float zmax\" -0.9"), [0.5, 0.5, 0.992]);
    // A disc has v = 1 in its middle: red and green.
    assert_mean(&format!("{PICTURE}Shape \"disk\" \"float radius\" 1"), [0.5, 0.5, 0.0]);
    // A cylinder about y from the side: a quarter of a turn, where the image is red above blue.
    let tube = format!("{PICTURE}Rotate -90 1 0 0\nShape \"cylinder\" \"float zmin\" -1 \"float zmax\" 1");
    assert_mean(&tube, [0.5, 0.0, 0.5]);
}

/// pbrt gives triangles the corners (0, 0), (1, 0), (1, 1) and patches those of the square.
#[test]
fn pictures_lie_on_meshes_of_pbrt_without_uv() {
    let points = "\"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ]";
    assert_mean(
        &format!("{PICTURE}Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] {points}"),
        [0.625, 0.75, 0.864],
    );
}

#[test]
fn spectra_given_inline_end_where_they_end() {
    let scene =
        "Material \"diffuse\" \"spectrum reflectance\" [ 500 0.5 600 0.5 ]\nShape \"sphere\" \"float radius\" 1";
    assert_mean(scene, [0.103, 0.513, -0.043]);
}

#[test]
fn a_medium_inside_glass_is_named() {
    let scene = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 0.1 0.3 0.6 ] \"rgb sigma_s\" [ 1.2 0.8 0.4 ]\n\
                 MediumInterface \"m\" \"\"\nMaterial \"dielectric\" \"float eta\" 1.33\nShape \"sphere\" \"float radius\" 1";
    let (_, notes) = mean(scene);
    assert!(notes.contains("the medium \"m\" in a dielectric is left out"), "{notes}");
}

/// Formulas of pbrt: an inverted image, planar coordinates, a checkerboard of whole cells.
#[test]
fn textures_of_pbrt_have_their_values() {
    let square = |uv: &str| {
        format!(
            "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] {uv}"
        )
    };
    let image = |parameters: &str| PICTURE.replacen('\n', &format!(" {parameters}\n"), 1);
    let corners = "\"point2 uv\" [ 0 0  1 0  1 1  0 1 ]";
    // The upper left quarter is red; inverted it is cyan.
    let quarter = "\"float uscale\" 0.5 \"float vscale\" 0.5 \"float vdelta\" 0.5";
    assert_mean(&format!("{}{}", image(&format!("{quarter} \"bool invert\" true")), square(corners)), [0.0, 1.0, 1.0]);
    // The square of 2 m covers the same quarter of an image of 4 m.
    let planar =
        format!("Translate -1 -3 0\nScale 4 4 4\n{}Identity\n{}", image("\"string mapping\" \"planar\""), square(""));
    assert_mean(&planar, [1.0, 0.0, 0.0]);
    let board = "Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 8 \"rgb tex1\" [ 0.8 0.2 0.2 ] \"rgb tex2\" [ 0.2 0.2 0.6 ]\n\
                 Material \"diffuse\" \"texture reflectance\" \"t\"\n";
    assert_mean(&format!("{board}{}", square(corners)), [0.5, 0.2, 0.4]);
}

#[test]
fn rgb_indices_are_spectra() {
    let metal = "Material \"conductor\" \"rgb eta\" [ 1.65746 0.880369 0.521229 ] \"rgb k\" [ 9.223869 6.269523 4.837001 ]\nShape \"sphere\"";
    assert_mean(metal, [0.927, 0.918, 0.918]);
    assert_mean("Material \"dielectric\" \"rgb eta\" [ 1.5 1.5 1.5 ]\nShape \"sphere\"", [1.0, 1.0, 1.0]);
}

/// Uniform light of 1 and two more on a grey of 0.5.
#[test]
fn environment_lights_of_pbrt_add() {
    let lights = "LightSource \"infinite\" \"rgb L\" [ 1 0 0 ]\nLightSource \"infinite\" \"rgb L\" [ 0 0 0.25 ] \"float scale\" 2\n";
    assert_mean(&format!("{lights}Material \"diffuse\"\nShape \"sphere\""), [1.0, 0.5, 0.75]);
}
