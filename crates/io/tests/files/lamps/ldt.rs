//! EULUMDAT files.

use etendue_scene::asset::{OpeningShape, PhotometryAxes, Tilt};

use super::support::{Ldt, assert_same_light, read_bytes, steps};

/// Without any symmetry. Scaled so that the stated lumens agree within the accepted factor.
fn odd(c: f64, v: f64) -> f64 {
    50.0 + 0.25 * c + 0.125 * v
}

fn about_c0(c: f64, v: f64) -> f64 {
    odd(c.min(360.0 - c), v)
}

fn about_c90(c: f64, v: f64) -> f64 {
    let turned = (c + 90.0) % 360.0;
    odd(turned.min(360.0 - turned), v)
}

fn quadrants(c: f64, v: f64) -> f64 {
    let half = c.min(360.0 - c);
    odd(half.min(180.0 - half), v)
}

#[test]
fn every_symmetry_is_the_lamp_written_out() {
    let (all, vertical) = (steps(0.0, 345.0, 15.0), steps(0.0, 180.0, 10.0));
    let complete = |value: fn(f64, f64) -> f64| Ldt::new(0, &all, &all, &vertical, value).read();
    let part = |symmetry, stored: &[f64], value: fn(f64, f64) -> f64| {
        Ldt::new(symmetry, &all, stored, &vertical, value).read()
    };
    assert_same_light(&part(2, &steps(0.0, 180.0, 15.0), about_c0), &complete(about_c0));
    let from_behind: Vec<f64> = steps(270.0, 450.0, 15.0).into_iter().map(|c| c % 360.0).collect();
    assert_same_light(&part(3, &from_behind, about_c90), &complete(about_c90));
    assert_same_light(&part(4, &steps(0.0, 90.0, 15.0), quadrants), &complete(quadrants));
    let round = part(1, &[0.0], odd);
    assert_eq!((&round.horizontal_deg[..], round.column(0)), (&[0.0, 360.0][..], round.column(1)));
    assert_eq!(complete(odd).candela_at(352.5, 90.0), 0.5 * (odd(345.0, 90.0) + odd(0.0, 90.0)), "closed over 360°");
}

#[test]
fn numbers_are_per_1000_lumens_of_the_lamps_and_converted() {
    let mut lamp = Ldt::new(1, &[0.0], &[0.0], &steps(0.0, 180.0, 10.0), |_, _| 100.0);
    lamp.sets = vec![(2, 4000.0, 90.5), (1, 9000.0, 200.0)];
    lamp.factors = [125.0, 0.75, 0.0];
    let read = lamp.read();
    assert_eq!((read.factor, read.candela[0]), (3.0, 300.0));
    assert_eq!((read.axes, read.lamps, read.rated_lumens, read.watts), (PhotometryAxes::C, 2, Some(4000.0), 90.5));
    assert_eq!(read.stated_flux_lm(), Some(5000.0));
    // 300 cd all around: 1200 π = 3770 lm of 5000.
    assert_eq!(read.report.len(), 2, "{:?}", read.report);
    assert_eq!(read.report[0], "lamp.ldt: 2 sets of lamps are listed; the first is used (4000 lm)");
    assert!(
        read.report[1].starts_with("lamp.ldt: the flux from the intensities is 3769.9 lm, 0.754 times the 5000.0 lm"),
        "{:?}",
        read.report
    );
    assert_eq!((read.opening.shape, read.opening.length_m), (OpeningShape::Rectangular, 0.15), "width along C0");
    assert_eq!((read.opening.width_m, read.opening.height_m), (0.5, 0.01));
    assert_eq!(read.texts[2], ("luminaire".to_owned(), "Street light".to_owned()));
}

#[test]
fn commas_may_be_decimal_signs_and_negative_lamps_absolute() {
    let mut lamp = Ldt::new(1, &[0.0], &[0.0], &[0.0, 22.5, 180.0], |_, v| 79.5 + v / 4.0);
    lamp.sets = vec![(-1, 1562.5, 12.25)];
    let read = lamp.read();
    let comma = read_bytes("l.ldt", lamp.text().replace('.', ",").as_bytes()).expect("readable");
    assert_same_light(&comma, &read);
    assert_eq!((comma.lamps, comma.rated_lumens, comma.watts), (1, Some(1562.5), 12.25));
    assert_eq!(comma.format, "EULUMDAT, absolute photometry");
}

#[test]
fn the_tilt_of_the_measurement_is_reported() {
    let mut lamp = Ldt::new(1, &[0.0], &[0.0], &[0.0, 90.0], |_, _| 160.0);
    lamp.factors[2] = 5.0;
    let read = lamp.read();
    assert_eq!(read.tilt, Tilt::Measured(5.0));
    assert!(read.report[0].starts_with("lamp.ldt: measured at a tilt of 5°"), "{:?}", read.report);
}

#[test]
fn a_fraction_in_place_of_per_cent_is_detected_by_the_flux() {
    let mut lamp = Ldt::new(1, &[0.0], &[0.0], &[0.0, 90.0], |_, _| 160.0);
    lamp.factors[0] = 0.8;
    let message = read_bytes("l.ldt", lamp.text().as_bytes()).expect_err("more than a hundred times");
    assert!(
        message.ends_with("correct the lumens, the conversion factor or the light output ratio (in per cent)"),
        "{message}"
    );
}
