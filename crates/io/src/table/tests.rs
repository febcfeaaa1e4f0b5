use super::*;

fn written<T>(text: &str, read: impl Fn(&Path) -> Result<T, Error>) -> Result<T, String> {
    let folder = tempfile::tempdir().expect("temporary folder");
    let path = folder.path().join("t.csv");
    std::fs::write(&path, text).expect("write");
    read(&path).map_err(|e| e.to_string().replace(&format!("{}/", folder.path().display()), ""))
}

fn index(text: &str) -> Result<ComplexIndexAsset, String> {
    written(text, read_complex_index)
}

fn retro(text: &str) -> Result<RetroTableAsset, String> {
    written(text, read_retro_table)
}

#[test]
fn indices_come_with_or_without_a_header_and_with_any_gap() {
    let expected = [(300.5, 1.34, 0.964), (400.0, 0.2, 2.0)];
    for text in ["wavelength_nm,n,k\n300.5,1.34,0.964\n400,0.2,2\n", "# silver\n300.5 1.34 0.964\n\n400\t0.2 2 # end\n"]
    {
        assert_eq!(index(text).expect("readable").points, expected, "{text}");
    }
}

#[test]
fn a_table_of_indices_is_refused_with_its_line() {
    for (text, message) in [
        (
            "400,1,2\n390,1,2\n",
            "t.csv:2: wavelength 390 nm follows 400 nm: sort the table by increasing wavelength, each once",
        ),
        ("nm,n,k\n400,1\n", "t.csv:2: the number of columns is 2; expected three: wavelength in nm, n, k"),
        ("400,0,1\n", "t.csv:1: found 0; expected n above 0"),
        ("400,1,-0.5\n", "t.csv:1: found -0.5; expected k of 0 or more"),
        ("nm,n,k\nnm,n,k\n", "t.csv:2: found \"nm\"; expected a number"),
        ("400,1,inf\n", "t.csv:1: found \"inf\"; expected a number"),
        ("nm n k\n", "t.csv: contains no row; expected three columns: wavelength in nm, n, k"),
    ] {
        assert_eq!(index(text).expect_err(text), message);
    }
}

#[test]
fn coefficients_lie_by_observation_and_entrance_angle() {
    let table =
        retro("# class RA2\nalpha \\ beta, 5, 30, 40\n0.2, 250, 150, 110\n0.33,180,100,95\n").expect("readable");
    assert_eq!((&table.observation_deg[..], &table.entrance_deg[..]), (&[0.2, 0.33][..], &[5.0, 30.0, 40.0][..]));
    assert_eq!((table.row(0), table.row(1)), (&[250.0, 150.0, 110.0][..], &[180.0, 100.0, 95.0][..]));
}

#[test]
fn a_table_of_coefficients_is_refused_with_its_line() {
    for (text, message) in [
        ("a,5,5\n", "t.csv:1: entrance angle 5° follows 5°: sort the table by increasing angle, each once"),
        ("a,5,95\n", "t.csv:1: the entrance angle is 95°; expected 0° to 90°"),
        ("a,5\n2,1\n1,2\n", "t.csv:3: observation angle 1° follows 2°: sort the table by increasing angle, each once"),
        (
            "a,5,30\n0.2,1\n",
            "t.csv:2: the number of coefficients is 1; expected 2, one for each entrance angle of the first row",
        ),
        ("a,5\n0.2,-1\n", "t.csv:2: the coefficient is -1; expected 0 or more"),
        ("a,5\n0.2,x\n", "t.csv:2: found \"x\"; expected a number"),
        ("a,5\n", "t.csv: contains no observation angle; expected at least one row after the entrance angles"),
        ("a\n", "t.csv: has no row of entrance angles; expected a word and at least one angle"),
    ] {
        assert_eq!(retro(text).expect_err(text), message);
    }
}
