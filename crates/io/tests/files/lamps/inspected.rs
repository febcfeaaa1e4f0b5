//! Report of `inspect` on a lamp.

use etendue_core::maths::f64::exp;
use etendue_io::inspect::{FileReport, inspect};

use super::support::{Ies, Ldt, steps};

fn report(name: &str, text: &str) -> FileReport {
    let folder = tempfile::tempdir().expect("temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("write");
    inspect(&path).unwrap_or_else(|error| panic!("{error}"))
}

fn fact<'a>(report: &'a FileReport, name: &str) -> &'a str {
    let entry = report.facts.iter().find(|(n, _)| n == name);
    entry.map_or_else(|| panic!("no {name}: {:#?}", report.facts), |(_, value)| value)
}

/// A passing beam for right-hand traffic, roughly: bright below a cut-off that rises to the right.
fn passing_beam(h: f64, v: f64) -> f64 {
    let cut_off = -0.57 + (h + 1.0).clamp(0.0, 4.0) * 0.3;
    let shape = exp(-(h / 12.0) * (h / 12.0)) * exp(-(v + 1.0) * (v + 1.0) / 4.0);
    if v <= cut_off { 13_000.0 * shape } else { 200.0 * shape }
}

#[test]
fn a_passing_beam_is_held_against_the_test_points() {
    let (h, v) = (steps(-30.0, 30.0, 0.25), steps(-8.0, 5.0, 0.125));
    for kind in [2, 3] {
        let right = report("low.ies", &Ies::new(kind, &h, &v, passing_beam).text());
        let count = fact(&right, "passing beam, UN R112/R149 class B");
        assert_eq!(count, "9 of 9 points pass for right-hand, 6 of 9 for left-hand traffic", "{:#?}", right.facts);
        assert!(fact(&right, "passing beam B50L, 3.43° L 0.57° U").ends_with("cd, at most 350 cd: pass"));
        let left = report("low.ies", &Ies::new(kind, &h, &v, |h, v| passing_beam(-h, v)).text());
        let count = fact(&left, "passing beam, UN R112/R149 class B");
        assert_eq!(count, "6 of 9 points pass for right-hand, 9 of 9 for left-hand traffic", "{:#?}", left.facts);
        assert!(fact(&left, "passing beam B50L, 3.43° L 0.57° U").ends_with(": FAIL"));
        let preview = right.preview.expect("a picture");
        assert_eq!((preview.width, preview.height), (512, 111), "60° × 13°");
    }
}

#[test]
fn a_street_light_is_reported_with_units() {
    let lamp = Ldt::new(1, &[0.0], &[0.0], &steps(0.0, 90.0, 1.0), |_, v| 318.31 * (1.0 - v / 90.0));
    let street_light = report("street.ldt", &lamp.text());
    assert_eq!(street_light.kind, "photometric file, EULUMDAT");
    assert_eq!(fact(&street_light, "maximum intensity"), "318.3 cd at H 0°, V 0°");
    assert_eq!(fact(&street_light, "vertical angles"), "91 from 0° to 90°");
    // ∫ (1 − γ/½π) sin γ dγ over ½π is 1 − 2/π: 318.31 × 2π × 0.36338 = 726.8 lm.
    assert_eq!(fact(&street_light, "flux from the intensities"), "726.8 lm");
    assert_eq!(
        fact(&street_light, "stated flux"),
        "1000.0 lm (1000 lm of the lamps × light output ratio 1); ratio 0.7268"
    );
    assert_eq!(fact(&street_light, "beam angle, C0–C180"), "90.0° at 50 %, field angle 162.0° at 10 %");
    assert!(street_light.facts.iter().all(|(name, _)| !name.contains("passing beam")), "no direction ahead");
    assert_eq!(street_light.notes.len(), 1, "{:?}", street_light.notes);
    // Straight down, at half of the radius, the beam is white inside, and outlined at its end, at 95 % of the radius.
    let image = street_light.preview.expect("a picture");
    let pixel = |x: usize, y: usize| image.rgb[y * image.width + x];
    let below = (256..512).filter(|y| pixel(256, *y) == [200, 30, 30]).collect::<Vec<_>>();
    assert!(below.iter().any(|y| (497..=501).contains(y)), "the red curve ends at 256 + 0.95 × 256 = 499: {below:?}");
}

#[test]
fn tables_are_distinguished_by_their_columns() {
    let kinds = [
        ("wavelength_nm,value\n400,1\n500,1\n", "spectrum, CSV"),
        ("wavelength_nm,n,k\n400,1,2\n500,1,3\n", "complex refractive index, CSV"),
        ("a,5,30\n0.2,70,30\n", "coefficients of retroreflection, CSV"),
    ];
    for (text, kind) in kinds {
        assert_eq!(report("t.csv", text).kind, kind);
    }
}
