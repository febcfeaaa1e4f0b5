//! Materials: indices, metals, spectra in files, coats.

use etendue_spectra::{Extrapolation, Spectrum, colour::linear_srgb_from_xyz, illuminant, observer};

use super::{ConvertedScene, SceneFile, read};

/// Colour under D65 of the values of a column beside the wavelengths.
fn colour(table: &[Vec<f64>], column: usize) -> [f64; 3] {
    let points: Vec<(f64, f64)> = table.iter().map(|row| (row[0], row[column])).collect();
    let spectrum = Spectrum::from_points(&points, Extrapolation::Hold).expect("a spectrum");
    linear_srgb_from_xyz(observer::xyz_of_reflectance(&spectrum, illuminant::d65()))
}

/// pbrt's unbounded spectrum of an rgb has that colour under the white of its colour space; the table has steps of 5 nm, which keeps it to 2e-3.
#[test]
fn rgb_indices_of_metals_have_their_colours() {
    let (eta, k) = ([1.65746, 0.880_369, 0.521_229], [9.223_869, 6.269_523, 4.837_001]);
    let converted = ConvertedScene::new(
        "Material \"conductor\" \"rgb eta\" [ 1.65746 0.880369 0.521229 ] \"rgb k\" [ 9.223869 6.269523 4.837001 ]\nShape \"sphere\"",
    );
    let table = converted.table("spectra/metal.csv");
    for (column, expected) in [(1, eta), (2, k)] {
        let actual = colour(&table, column);
        let is_near = actual.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-3 * k[0]);
        assert!(is_near, "{actual:?}, expected {expected:?}");
    }
}

#[test]
fn indices_of_dielectrics_may_be_numbers_rgb_names_and_files() {
    let index = |eta: &str| {
        let glass = SceneFile { name: "glass.spd", bytes: b"# a glass\n400 1.7 # blue\n500 1.6\n700 1.6\n" };
        read(&format!("Material \"dielectric\" {eta}\nShape \"sphere\""), &[glass]).expect("a scene")
    };
    for (eta, expected) in [
        ("\"float eta\" 1.33", "index = 1.33"),
        ("\"rgb eta\" [ 1.5 1.5 1.5 ]", "index = 1.5"),
        ("\"spectrum eta\" \"glass-BK7\"", "index = 1.5168"),
        ("\"spectrum eta\" \"glass-F10\"", "index = 1.72825"),
        ("\"spectrum eta\" \"glass.spd\"", "index = 1.6"),
    ] {
        let converted = index(eta);
        assert!(
            converted.scene().contains(&format!("{expected}\n")) || converted.scene().contains(&format!("{expected} ")),
            "{eta}: {}",
            converted.scene()
        );
    }
    index("\"rgb eta\" [ 1.5 1.5 1.5 ]").assert_silent_about("not dispersive");
    index("\"spectrum eta\" \"glass.spd\"")
        .assert_reports("a spectral refractive index is replaced by its value at 587.6 nm");
}

#[test]
fn metals_are_those_of_their_names() {
    for metal in ["Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"] {
        let converted = ConvertedScene::new(&format!(
            "Material \"conductor\" \"spectrum eta\" \"metal-{metal}-eta\" \"spectrum k\" \"metal-{metal}-k\"\nShape \"sphere\""
        ));
        assert!(converted.scene().contains(&format!("metal = \"{metal}\"")), "{}", converted.scene());
    }
    // Parts of different metals become a table of both.
    let converted = ConvertedScene::new(
        "Material \"conductor\" \"spectrum eta\" \"metal-CuZn-eta\" \"float k\" 2\nShape \"sphere\"",
    );
    let table = converted.table("spectra/metal.csv");
    let row = table.iter().find(|row| row[0] == 600.0).expect("a row");
    assert!((row[1] - 0.45).abs() < 1e-6 && row[2] == 2.0, "{row:?}");
}

#[test]
fn reflectances_in_files_end_where_they_end() {
    let spd = SceneFile { name: "r.spd", bytes: b"# grey\n500 0.5\n600 0.5 # end\n" };
    let converted =
        read("Material \"diffuse\" \"spectrum reflectance\" \"r.spd\"\nShape \"sphere\"", &[spd]).expect("a scene");
    let table = converted.table("spectra/spectrum.csv");
    assert_eq!(table.iter().map(|row| row[1]).collect::<Vec<_>>(), [0.0, 0.5, 0.5, 0.0]);
    assert_eq!((table[1][0], table[2][0]), (500.0, 600.0));
}

#[test]
fn unknown_spectra_are_refused_with_their_line() {
    for (parameter, expected) in [
        ("\"spectrum reflectance\" \"none.spd\"", "the spectrum \"none.spd\" is neither a name of pbrt-v4"),
        ("\"spectrum reflectance\" \"bad.spd\"", "bad.spd:2: expected a finite number, found `x`"),
        ("\"rgb reflectance\" [ 0.5 0.5 ]", "the number of values in an rgb is 2; expected three"),
    ] {
        let bad = SceneFile { name: "bad.spd", bytes: b"400 1\n500 x\n" };
        let message = read(&format!("Material \"diffuse\" {parameter}"), &[bad]).err().expect("refused");
        assert!(message.starts_with("a.pbrt:4: Material \"diffuse\"") && message.contains(expected), "{message}");
    }
}

#[test]
fn the_absorption_of_coats_is_named_for_the_default_too() {
    let note =
        |parameters: &str| ConvertedScene::new(&format!("Material \"coateddiffuse\" {parameters}\nShape \"sphere\""));
    note("").assert_reports("a coat of \"thickness\" 0.01 absorbs light in pbrt");
    note("\"float thickness\" 0.2").assert_reports("a coat of \"thickness\" 0.2 absorbs");
    note("\"float thickness\" 0").assert_silent_about("absorbs");
}
