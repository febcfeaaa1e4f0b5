//! Textures: image formats, and images that are written for textures.

use etendue_io::png::encode_grey8;

use super::{ConvertedScene, SceneFile, read};

/// Two pixels of 8 bits, red and mid-grey, as a TGA of true colour from the top.
fn tga() -> Vec<u8> {
    let header = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 24, 0x20];
    [&header[..], &[0, 0, 255], &[128, 128, 128]].concat()
}

/// The same as a PFM of linear numbers.
fn pfm() -> Vec<u8> {
    let numbers = [1.0_f32, 0.0, 0.0, 0.25, 0.25, 0.25].map(f32::to_le_bytes).concat();
    [&b"PF\n2 1\n-1\n"[..], &numbers].concat()
}

fn with_texture(texture: &str, files: &[SceneFile<'_>]) -> Result<ConvertedScene, String> {
    read(&format!("{texture}\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\""), files)
}

/// Values of a texture without files.
fn colours(texture: &str) -> (usize, Vec<[f32; 3]>) {
    with_texture(texture, &[]).expect("a scene").image("textures/t.exr")
}

/// Mid-grey 128 of sRGB is 0.2158605.
#[test]
fn images_of_other_formats_are_written_as_linear_numbers() {
    let image = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\"";
    let tga = tga();
    let converted =
        with_texture(&format!("{image} \"a.tga\""), &[SceneFile { name: "a.tga", bytes: &tga }]).expect("a scene");
    let (columns, pixels) = converted.image("textures/t.exr");
    assert_eq!((columns, pixels[0]), (2, [1.0, 0.0, 0.0]));
    assert!(pixels[1].iter().all(|v| (v - 0.215_860_5).abs() < 1e-6), "{pixels:?}");
    let pfm = pfm();
    let converted =
        with_texture(&format!("{image} \"a.pfm\""), &[SceneFile { name: "a.pfm", bytes: &pfm }]).expect("a scene");
    assert_eq!(converted.image("textures/t.exr").1, [[1.0, 0.0, 0.0], [0.25; 3]]);
    // Another machine's path and capitals.
    let name = "C:\\\\scenes\\\\A.TGA".replace("\\\\", "\\");
    let converted =
        with_texture(&format!("{image} \"{name}\""), &[SceneFile { name: "a.tga", bytes: &tga }]).expect("a scene");
    converted.assert_reports("is read from `a.tga`");
    let refused = with_texture(&format!("{image} \"a.psd\""), &[]).err().expect("refused");
    assert!(
        refused.starts_with("a.pbrt:4: Texture \"t\": the format of the image `a.psd` is not supported"),
        "{refused}"
    );
}

#[test]
fn scales_and_inversions_are_those_of_pbrt() {
    let pfm = pfm();
    let pixels = |parameters: &str| {
        let texture = format!("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.pfm\" {parameters}");
        let converted = with_texture(&texture, &[SceneFile { name: "a.pfm", bytes: &pfm }]).expect("a scene");
        converted.image("textures/t.exr").1
    };
    assert_eq!(pixels("\"bool invert\" true"), [[0.0, 1.0, 1.0], [0.75; 3]]);
    assert_eq!(pixels("\"float scale\" 2"), [[1.0, 0.0, 0.0], [0.5; 3]]);
    assert_eq!(pixels("\"float scale\" 2 \"bool invert\" true"), [[0.0, 1.0, 1.0], [0.5; 3]]);
    // A negative scale is a mirror; black borders are pixels.
    assert_eq!(pixels("\"float uscale\" -1"), [[0.25; 3], [1.0, 0.0, 0.0]]);
    let bordered = pixels("\"string wrap\" \"black\"");
    assert_eq!((bordered.len(), bordered[5], bordered[6], bordered[0]), (12, [1.0, 0.0, 0.0], [0.25; 3], [0.0; 3]));
}

/// pbrt's remapped roughness is α²: an image of 0.25 gives 0.5, at both ends of its scale.
#[test]
fn images_of_roughness_are_remapped() {
    let png = encode_grey8(2, 1, &[255, 128]).expect("a picture");
    let image = |parameters: &str| {
        let body = format!(
            "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"string encoding\" \"linear\"\n\
             Material \"coateddiffuse\" \"texture roughness\" \"t\" {parameters}\nShape \"sphere\""
        );
        read(&body, &[SceneFile { name: "a.png", bytes: &png }]).expect("a scene")
    };
    let (_, pixels) = image("").image("textures/t.exr");
    assert!(
        (pixels[0][0] - 1.0).abs() < 1e-6 && (pixels[1][0] - (128.0_f32 / 255.0).sqrt()).abs() < 1e-6,
        "{pixels:?}"
    );
    // Without remapping the linear file is used itself.
    let plain = image("\"bool remaproughness\" false");
    assert!(plain.scene().contains("a.png") && !plain.names().contains(&"textures/t.exr"), "{}", plain.scene());
}

#[test]
fn checkerboards_and_mixtures_are_evaluated() {
    // The cell at the origin, at the lower left, has the first colour.
    let board = "Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [ 1 0 0 ] \"rgb tex2\" [ 0 0 1 ]";
    let (columns, pixels) = colours(board);
    let at = |column: usize, row: usize| pixels[row * columns + column];
    assert_eq!((columns, at(0, columns - 1), at(0, 0)), (512, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    assert_eq!((at(255, 256), at(256, 256), at(256, 255)), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]));
    let scene = with_texture(&format!("{board} \"float uscale\" 4 \"float udelta\" 1"), &[]).expect("a scene");
    assert!(
        scene.scene().contains("uv_scale = [2, 0.5]") && scene.scene().contains("uv_offset = [0.5, 0]"),
        "{}",
        scene.scene()
    );
    // A mixture of a board and a constant.
    let mixture = format!(
        "{}\nTexture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"b\" \"rgb tex2\" [ 0 1 0 ] \"float amount\" 0.25",
        board.replace("\"t\"", "\"b\"")
    );
    assert_eq!(colours(&mixture).1[0], [0.0, 0.25, 0.75]);
    let scaled = format!(
        "{}\nTexture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"b\" \"float scale\" 0.5",
        board.replace("\"t\"", "\"b\"")
    );
    assert_eq!(colours(&scaled).1[0], [0.0, 0.0, 0.5]);
    let (columns, pixels) = colours(
        "Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [ 0 0 0 ] \"rgb v10\" [ 1 0 0 ] \"rgb v01\" [ 0 1 0 ] \"rgb v11\" [ 1 1 0 ]",
    );
    let upper_left = pixels[0];
    assert!(columns == 1024 && upper_left[0] < 1e-3 && upper_left[1] > 0.999, "{upper_left:?}");
}

/// Share of the dots by an evaluation of the formulas in Python at 1600 by 1600 points; the borders of 600 dots in 1024 pixels scatter by less than 1e-3.
#[test]
fn dots_cover_their_share() {
    let texture = "Texture \"t\" \"spectrum\" \"dots\" \"float uscale\" 40 \"float vscale\" 40";
    let (_, pixels) = colours(texture);
    let mean = pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / pixels.len() as f64;
    assert!((mean - 0.143_98).abs() < 1e-3, "{mean}");
}

#[test]
fn textures_of_positions_become_their_mean() {
    for (kind, expected) in [
        ("wrinkled\" \"float roughness\" 0", "reflectance = 0.218"),
        ("marble\"", "reflectance = [0.8046, 0.803, 0.8398]"),
    ] {
        let converted = with_texture(&format!("Texture \"t\" \"spectrum\" \"{kind}"), &[]).expect("a scene");
        converted.assert_reports("depends on the position in space: its mean is used instead (a.pbrt:4)");
        let rgb = expected.replace("reflectance = [", "rgb = [");
        assert!(converted.scene().contains(expected) || converted.scene().contains(&rgb), "{}", converted.scene());
    }
}
