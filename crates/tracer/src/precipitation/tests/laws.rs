//! Laws of size: tables, closed forms, and refusals.

use super::*;
use etendue_core::maths::f64::exp;

/// Rate, mm/h; Λ, 1/mm; drops/m³; meteorological extinction, 1/km; rate re-integrated, mm/h, by Marshall and Palmer's and Atlas's formulas,
/// integrated by another program.
const TABLE: [[f64; 5]; 6] = [
    [1.0, 4.100, 1951.0, 0.365, 1.18],
    [5.0, 2.924, 2736.0, 1.005, 5.90],
    [10.0, 2.528, 3165.0, 1.556, 11.6],
    [25.0, 2.086, 3836.0, 2.771, 28.2],
    [50.0, 1.803, 4437.0, 4.288, 54.6],
    [100.0, 1.559, 5132.0, 6.636, 104.7],
];

fn near(a: f64, b: f64, within: f64) -> bool {
    (a / b - 1.0).abs() < within
}

#[test]
fn rain_is_as_the_table_of_marshall_and_palmer() {
    for [rate, lambda, number, per_km, carried] in TABLE {
        let law = SizeLaw::rain(rate).expect("within the law");
        assert!(near(law.lambda_per_mm(), lambda, 1e-3) && near(law.number_per_m3(), number, 1e-3), "{rate}");
        assert!(near(1e3 * law.meteorological_extinction_per_m(), per_km, 0.01), "{rate}");
        // The law's own integral goes beyond the 6 mm at which drops end. Of the water above x = 6 Λ a fraction e⁻ˣ (1 + x + x²/2 + x³/6)
        // is left out, of speeds that are at most 9.5 m/s where the mean of the water's is more than 6.5.
        let x = 6.0 * lambda;
        let beyond = exp(-x) * (1.0 + x + x * x / 2.0 + x * x * x / 6.0) * 9.5 / 6.5;
        let ratio = law.water_rate_mm_h() / carried;
        assert!(ratio < 1.01 && ratio > 0.99 - beyond, "{rate}: {ratio}");
        assert!(near(law.visibility_m(), 3912.0 / per_km, 0.01), "{rate}");
    }
}

#[test]
fn a_rescaled_law_brings_the_rate_asked_for() {
    for rate in [0.1, 1.0, 25.0, 150.0] {
        assert!(near(SizeLaw::rain(rate).expect("legal").rescaled().water_rate_mm_h(), rate, 1e-12));
    }
    let law = SizeLaw::snow(2.0, Crystals::Rimed).expect("legal").rescaled();
    assert!(near(law.water_rate_mm_h(), 2.0, 1e-12));
}

#[test]
fn drops_fall_as_atlas_measured_and_flatten() {
    for (diameter_mm, speed) in [(0.5, 2.02), (1.0, 4.00), (2.0, 6.55), (3.0, 7.95), (5.0, 9.14)] {
        assert!((terminal_speed_mps(diameter_mm) - speed).abs() < 0.006);
    }
    assert_eq!(terminal_speed_mps(0.05), 0.0);
    assert_eq!((axis_ratio(0.9), axis_ratio(5.0)), (1.0, 1.03 - 0.31));
}

/// Half of the meteorological extinction, except that drops are slightly flatter than balls: a spheroid of the same volume has the
/// cross-section of the ball times the cube root of its axis ratio, as seen from the side.
#[test]
fn an_image_loses_half_of_the_meteorological_extinction() {
    let law = SizeLaw::rain(10.0).expect("legal");
    let field = PrecipitationField::new(law, DVec3::ZERO, 500.0, 0);
    assert!(near(1e3 * field.extinction_per_m(), 0.778, 0.03));
    assert!(2.0 * field.extinction_per_m() < law.meteorological_extinction_per_m());
}

/// Molten diameters used as flake diameters give 0.65 /km at 1 mm/h, six times too clear; Stoelinga and Warner (1999) have 3.8 /km at 1
/// m/s. A law for each kind of crystal spans the 3 to 10 times that Rasmussen and others found.
#[test]
fn flakes_are_larger_than_their_water() {
    let per_km = |crystals| 1e3 * SizeLaw::snow(1.0, crystals).expect("legal").meteorological_extinction_per_m();
    let by = [Crystals::Dendrites, Crystals::Aggregates, Crystals::Rimed, Crystals::Graupel].map(per_km);
    assert!(by.is_sorted_by(|a, b| a > b), "{by:?}");
    assert!(by[1] > 0.5 * 3.8 && by[1] < 2.0 * 3.8, "{by:?}");
    assert!(by[0] / by[3] > 3.0 && by[0] / by[3] < 10.0 && by[3] > 0.65, "{by:?}");
}

#[test]
fn rates_beyond_the_measurements_are_refused() {
    for rate in [-1.0, 0.0, 0.05, 151.0, f64::NAN] {
        assert!(SizeLaw::rain(rate).is_err(), "{rate}");
    }
    for rate in [0.0, 3.5] {
        assert!(SizeLaw::snow(rate, Crystals::Aggregates).is_err(), "{rate}");
    }
    let error = SizeLaw::rain(200.0).expect_err("too much").to_string();
    assert!(error.contains("200 mm/h") && error.contains("0.1 to 150 mm/h"), "{error}");
}
