//! LM-63 files.

use etendue_scene::asset::{OpeningShape, PhotometryAxes, Tilt};
use proptest::prelude::*;

use super::support::{Ies, assert_same_light, read_asset, read_bytes, steps};

/// Whole numbers without any symmetry, so that a wrong place is detected.
fn odd(h: f64, v: f64) -> f64 {
    1000.0 + 7.0 * h + 0.25 * v
}

/// About the C0 plane.
fn about_c0(h: f64, v: f64) -> f64 {
    odd(h.min(360.0 - h), v)
}

/// About the C90 plane.
fn about_c90(h: f64, v: f64) -> f64 {
    let turned = (h + 90.0) % 360.0;
    odd(turned.min(360.0 - turned), v)
}

fn quadrants(h: f64, v: f64) -> f64 {
    let half = h.min(360.0 - h);
    odd(half.min(180.0 - half), v)
}

#[test]
fn every_symmetry_of_type_c_is_the_lamp_written_out() {
    let (full, vertical) = (steps(0.0, 360.0, 15.0), steps(0.0, 180.0, 10.0));
    let complete = |candela: fn(f64, f64) -> f64| Ies::new(1, &full, &vertical, candela).read();
    let part = |horizontal: &[f64], candela: fn(f64, f64) -> f64| Ies::new(1, horizontal, &vertical, candela).read();
    assert_same_light(&part(&steps(0.0, 180.0, 15.0), about_c0), &complete(about_c0));
    assert_same_light(&part(&steps(90.0, 270.0, 15.0), about_c90), &complete(about_c90));
    assert_same_light(&part(&steps(0.0, 90.0, 15.0), quadrants), &complete(quadrants));
    assert_same_light(&part(&steps(0.0, 345.0, 15.0), about_c0), &complete(about_c0));
    let round = part(&[0.0], odd);
    assert_eq!((&round.horizontal_deg[..], round.column(0)), (&[0.0, 360.0][..], round.column(1)));
    assert_eq!(round.candela_at(200.0, 40.0), odd(0.0, 40.0));
}

#[test]
fn planes_that_begin_off_0_meet_at_a_seam_between_them() {
    let lamp = Ies::new(1, &steps(5.0, 355.0, 10.0), &[0.0, 90.0], |h, _| h).read();
    assert_eq!((lamp.horizontal_deg[0], *lamp.horizontal_deg.last().expect("planes")), (0.0, 360.0));
    assert_eq!(lamp.candela_at(0.0, 45.0), 180.0, "half way between 355 and 5");
    assert_eq!(lamp.candela_at(360.0, 45.0), 180.0);
}

#[test]
fn headlamps_have_a_right_side_that_is_mirrored_or_both() {
    for (kind, axes) in [(2, PhotometryAxes::B), (3, PhotometryAxes::A)] {
        let vertical = steps(-20.0, 10.0, 2.0);
        let both = Ies::new(kind, &steps(-40.0, 40.0, 5.0), &vertical, |h, v| odd(h.abs(), v)).read();
        let right = Ies::new(kind, &steps(0.0, 40.0, 5.0), &vertical, odd).read();
        assert_eq!(both.axes, axes);
        assert_same_light(&right, &both);
        assert_eq!(right.report.len(), 2, "dark beyond the grid, both ways: {:?}", right.report);
        let skew = Ies::new(kind, &steps(-40.0, 20.0, 5.0), &vertical, odd).read();
        assert_eq!(skew.candela_at(-35.0, 4.0), odd(-35.0, 4.0));
    }
}

#[test]
fn factors_and_units_are_applied_once() {
    let mut lamp = Ies::new(1, &[0.0], &[0.0, 90.0], |_, _| 100.0);
    (lamp.lamps, lamp.lumens, lamp.multiplier, lamp.ballast) = (2, 600.0, 2.5, [0.5, 0.8]);
    (lamp.units, lamp.size) = (1, [-1.0, -1.0, 0.0]);
    let read_with = |first, lamp: &Ies| Ies { first, ..lamp.clone() }.read();
    for (edition, further) in [
        ("IESNA:LM-63-1995", 0.8),
        ("IESNA91", 0.8),
        ("a lamp of 1986", 0.8),
        ("IESNA:LM-63-2002", 1.0),
        ("IES:LM-63-2019", 1.0),
    ] {
        let read = read_with(edition, &lamp);
        let factor = 2.5 * 0.5 * further;
        assert_eq!((read.factor, read.candela[0]), (factor, 100.0 * factor), "{edition}");
        assert_eq!((read.lamps, read.rated_lumens, read.watts), (2, Some(1200.0), 42.5), "{edition}");
        assert_eq!((read.opening.shape, read.opening.width_m), (OpeningShape::Round, 0.3048), "{edition}");
    }
    let texts = read_with("IESNA:LM-63-2002", &lamp).texts;
    assert_eq!(texts[1], ("MANUFAC".to_owned(), "Lamps & Co of Town".to_owned()));
}

#[test]
fn an_identification_that_is_spelt_otherwise_is_read_and_noted() {
    let mut lamp = Ies::new(1, &[0.0], &[0.0, 90.0], |_, _| 100.0);
    lamp.ballast = [1.0, 1.1];
    let read = |first: &'static str| read_bytes("lamp.ies", Ies { first, ..lamp.clone() }.text().as_bytes());
    for (first, factor, edition) in [
        ("IESNA:LM-63-2019", 1.0, "2019"),
        ("IESNA: LM-63-2002", 1.0, "2002"),
        ("iesna:lm-63-2002", 1.0, "2002"),
        ("IES LM-63-02", 1.0, "2002"),
        ("ANSI/IES LM-63-19", 1.0, "2019"),
        ("\nIESNA:LM-63-2002", 1.0, "2002"),
        ("a lamp\nIESNA:LM-63-2002", 1.0, "2002"),
        ("IESNA:LM63-1995", 1.1, "1995"),
        ("IESNA 91", 1.1, "1991"),
        ("LM-63-2002", 1.0, "2002"),
    ] {
        let asset = read(first).unwrap_or_else(|error| panic!("{first}: {error}"));
        assert!((asset.factor - factor).abs() < 1e-12, "{first}: {}", asset.factor);
        assert_eq!(asset.format, format!("IES LM-63, edition of {edition}"), "{first}");
        assert!(
            asset.report.iter().any(|note| note.contains("is not the standard's identification")),
            "{:?}",
            asset.report
        );
    }
    for first in ["IESNA:LM-63-1995", "IES:LM-63-2019", "a lamp of the IES", "IES lamp 7"] {
        let asset = read(first).expect("a lamp");
        assert!(!asset.report.iter().any(|note| note.contains("identification")), "{first}: {:?}", asset.report);
    }
    let message = read("IESNA:LM-63").expect_err("no year");
    assert!(message.contains("lamp.ies:1: `IESNA:LM-63` states no edition, and the number 1.1"), "{message}");
    lamp.ballast = [1.0, 1.0];
    let same = read_bytes("lamp.ies", Ies { first: "IESNA:LM-63", ..lamp }.text().as_bytes()).expect("no difference");
    assert!(same.report[0].contains("states no edition"), "{:?}", same.report);
}

#[test]
fn numbers_may_stand_in_any_lines_and_text_in_any_old_encoding() {
    let lamp = Ies::new(1, &steps(0.0, 90.0, 30.0), &steps(0.0, 90.0, 5.0), quadrants);
    let plain = lamp.read();
    let text = lamp.text();
    let (top, numbers) = text.split_at(text.find("TILT=NONE").expect("a line") + "TILT=NONE\n".len());
    let one_line = format!("{top}{}", numbers.replace('\n', " "));
    let commas = format!("{top}{}", numbers.replace(' ', ", ").replace('\n', ",\r\n"));
    let each = format!("{top}{}", numbers.replace(' ', "\n"));
    let dos = format!("\u{feff}{}\u{1a}", lamp.text().replace('\n', "\r\n"));
    let mac = lamp.text().replace('\n', "\r");
    let spaced = lamp.text().replace("TILT=NONE", " tilt = none ");
    for text in [one_line, commas, each, dos, mac, spaced] {
        assert_same_light(
            &read_bytes("l.IES", text.as_bytes()).unwrap_or_else(|error| panic!("{error}\n{text}")),
            &plain,
        );
    }
    let latin: Vec<u8> = lamp.text().replace("Town", "K\u{f6}ln").chars().map(|c| c as u8).collect();
    assert_eq!(read_bytes("l.ies", &latin).expect("Latin-1").texts[1].1, "Lamps & Co of Köln");
}

#[test]
fn factors_of_tilts_are_stored_and_reported() {
    let table = "1\n3\n0 45 90\n1 0.95 0.9";
    let expected = Tilt::Table { geometry: 1, factors: vec![(0.0, 1.0), (45.0, 0.95), (90.0, 0.9)] };
    let mut lamp = Ies::new(1, &[0.0], &[0.0, 90.0], |_, _| 1.0);
    lamp.tilt = format!("TILT=INCLUDE\n{table}");
    let included = lamp.read();
    assert_eq!(included.tilt, expected);
    assert!(
        included.report[0].starts_with("lamp.ies: the tilt factors (0.9 to 1) are not applied"),
        "{:?}",
        included.report
    );

    let folder = tempfile::tempdir().expect("temporary folder");
    std::fs::create_dir(folder.path().join("tilts")).expect("folder");
    lamp.tilt = r"TILT=tilts\a.tlt".to_owned();
    let path = folder.path().join("lamp.ies");
    std::fs::write(&path, lamp.text()).expect("write");
    let message = read_asset(folder.path(), &path).expect_err("no such file");
    assert!(
        message.starts_with("tilts/a.tlt: no such tilt file; check the path (referenced at lamp.ies:5: TILT;"),
        "{message}"
    );
    std::fs::write(folder.path().join("tilts/a.tlt"), table).expect("write");
    let named = read_asset(folder.path(), &path).expect("readable");
    assert_eq!((named.tilt, named.candela), (expected, included.candela));
    std::fs::write(folder.path().join("tilts/a.tlt"), table.replace("0.95", "0.96")).expect("write");
    assert_ne!(read_asset(folder.path(), &path).expect("readable").hash, named.hash, "the table is a part of the lamp");
}

#[test]
fn a_flux_other_than_the_rated_one_is_reported() {
    // 100 cd all around: 400 π lm.
    let with_lumens = |lumens: f64| {
        let mut lamp = Ies::new(1, &[0.0], &steps(0.0, 180.0, 10.0), |_, _| 100.0);
        lamp.lumens = lumens;
        read_bytes("lamp.ies", lamp.text().as_bytes())
    };
    for lumens in [1240.0, 1256.6, 1280.0, -1.0] {
        assert_eq!(with_lumens(lumens).expect("readable").report, [""; 0], "{lumens}");
    }
    let notes = with_lumens(1600.0).expect("readable").report;
    assert_eq!(
        notes,
        [
            "lamp.ies: the flux from the intensities is 1256.6 lm, 0.785 times the 1600.0 lm from the lumens of the lamps: the luminaire absorbs the rest, or directions are missing; the intensities are used"
        ]
    );
    assert!(
        with_lumens(1000.0).expect("readable").report[0]
            .contains("a luminaire cannot emit more than its lamps: check lumens and multiplier")
    );
    let absurd = with_lumens(400.0).expect_err("more than three times");
    assert!(
        absurd.starts_with(
            "lamp.ies: the flux from the intensities is 1256.6371 lm, that from the lumens of the lamps 400.0000 lm"
        ),
        "{absurd}"
    );
    assert!(
        absurd.ends_with(
            "correct the lumens or the multiplier; lumens of -1 denote absolute photometry of the luminaire"
        )
    );
    assert!(with_lumens(0.0).expect("readable").report[0].contains("cannot be checked"));
}

proptest! {
    /// A written lamp of any type reads back to the same bits.
    #[test]
    fn a_luminaire_is_read_as_it_was_written(
        kind in 1_u8..=3,
        values in prop::collection::vec(0.0_f64..1e6, 5 * 7),
        offset in 0.0_f64..5.0,
    ) {
        let vertical: Vec<f64> = steps(if kind == 1 { 30.0 } else { -30.0 }, if kind == 1 { 70.0 } else { 10.0 }, 10.0);
        let horizontal: Vec<f64> = match kind {
            1 => steps(offset, offset + 330.0, 55.0),
            _ => steps(-30.0 - offset, 30.0 - offset, 10.0),
        };
        let mut lamp = Ies::new(kind, &horizontal, &vertical, |_, _| 0.0);
        lamp.candela = values.clone();
        lamp.candela[0] += 1.0;
        let read = lamp.read();
        for (h, angle) in horizontal.iter().enumerate() {
            let index = read.horizontal_deg.iter().position(|a| a == angle).expect("the plane");
            prop_assert_eq!(read.column(index), &lamp.candela[5 * h..][..5]);
        }
    }
}
