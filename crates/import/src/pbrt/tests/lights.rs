//! Lights of infinity and their sums, and cameras of lens tables.

use super::{ConvertedScene, SceneFile, read, read_text};

/// Sky of four pixels of this grey.
fn sky(value: f32) -> Vec<u8> {
    [&b"PF\n2 2\n1\n"[..], &[value; 12].map(f32::to_be_bytes).concat()].concat()
}

#[test]
fn uniform_lights_add() {
    // Equal energy from 400 to 700 nm, of 3 and 2 cd/m² by its luminance.
    let table = "\"spectrum L\" [ 400 1 700 1 ]";
    let converted = ConvertedScene::new(&format!(
        "LightSource \"infinite\" {table} \"float scale\" 3\nLightSource \"infinite\" {table} \"float scale\" 2\nShape \"sphere\""
    ));
    converted.assert_reports("2 environment lights become one, their sum");
    let sum = converted.names().into_iter().rfind(|name| name.starts_with("spectra/")).expect("a table");
    let rows = converted.table(sum);
    let value = |nm: f64| rows.iter().find(|row| row[0] == nm).expect("a row")[1];
    // 683 lm/W · L · ∫ȳ dλ = 5 cd/m², with ∫ȳ dλ = 106.857 nm (CIE 1931), of which 0.01 % lies outside 400 to 700 nm.
    let expected = 5.0 / (683.0 * 106.857);
    assert!((value(550.0) / expected - 1.0).abs() < 1e-3 && value(390.0) == 0.0, "{} for {expected}", value(550.0));
}

#[test]
fn images_and_uniform_lights_add() {
    let (one, two) = (sky(1.0), sky(0.5));
    let files = [SceneFile { name: "a.pfm", bytes: &one }, SceneFile { name: "b.pfm", bytes: &two }];
    let converted = read(
        "LightSource \"infinite\" \"string filename\" \"a.pfm\" \"float scale\" 2\nLightSource \"infinite\" \"string filename\" \"b.pfm\"\n\
         LightSource \"infinite\" \"rgb L\" [ 1 2 3 ]\nShape \"sphere\"",
        &files,
    );
    let converted = converted.expect("a scene");
    let (columns, pixels) = converted.image("environment.exr");
    // The colour of the uniform light passes through spectra of 1 nm: 1e-3 of its largest value.
    let is_near = |p: &[f32; 3]| p.iter().zip([3.5, 4.5, 5.5]).all(|(v, expected)| (v - expected).abs() < 5e-3);
    assert!(columns == 4 && pixels.iter().all(is_near), "{pixels:?}");
    assert!(
        converted.scene().contains("luminance_cd_m2_per_unit = 1\n")
            || converted.scene().contains("luminance_cd_m2_per_unit = 1 "),
        "{}",
        converted.scene()
    );
}

#[test]
fn an_environment_is_of_one_kind() {
    let message =
        read("LightSource \"infinite\" \"string filename\" \"a.pfm\" \"rgb L\" [ 1 1 1 ]", &[]).err().expect("refused");
    assert!(message.contains("a.pbrt:4: LightSource \"infinite\": \"L\" contradicts \"filename\""), "{message}");
}

#[test]
fn lights_in_files_have_their_spectrum() {
    let spd = SceneFile { name: "red.spd", bytes: b"380 0.05\n580 0.1\n600 0.7\n780 0.7\n" };
    let body = "AreaLightSource \"diffuse\" \"spectrum L\" \"red.spd\" \"float scale\" 5\nShape \"disk\"";
    let converted = read(body, &[spd]).expect("a scene");
    let rows = converted.table("spectra/spectrum.csv");
    assert_eq!(
        rows[1..5].iter().map(|row| (row[0], row[1])).collect::<Vec<_>>(),
        [(380.0, 0.05), (580.0, 0.1), (600.0, 0.7), (780.0, 0.7)]
    );
    assert!(converted.scene().contains("luminance_cd_m2 = 5"), "{}", converted.scene());
}

/// EFL 49.55655 mm by the lensmaker's formula of the thick lens (`lens_table`); film of 35 mm diagonal, 4 : 3.
#[test]
fn lens_tables_become_surfaces() {
    let lens = SceneFile { name: "lens.dat", bytes: b"# thick singlet\n50 4 1.5168 12\n0 3 0 10\n-50 47 1 12\n" };
    let text = "LookAt 0 -5 1  0 0 1  0 0 1\nCamera \"realistic\" \"string lensfile\" \"lens.dat\" \"float aperturediameter\" 30 \"float focusdistance\" 5\n\
        Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 48\nWorldBegin\nShape \"sphere\"\n";
    let converted = read_text(text, &[lens]).expect("a scene");
    converted.assert_reports(
        "camera: lens of 3 surfaces, focal length 49.5565 mm, stop of 10 mm, focused 5 m before the film",
    );
    converted.assert_reports("\"aperturediameter\" of 30 mm is limited to the table's 10 mm (a.pbrt:2)");
    let job = std::str::from_utf8(converted.file("job.toml")).expect("a text");
    for phrase in [
        "type = \"prescription\"",
        "radius_mm = 50",
        "radius_mm = -50",
        "semi_aperture_mm = 5",
        "stop = true",
        "index = 1.5168",
        "pixel_pitch_um = 437.5",
    ] {
        assert!(job.contains(phrase), "{phrase}: {job}");
    }
}
