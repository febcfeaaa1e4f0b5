//! Retro-reflection: light that signs and markings reflect to a viewer near the lamp.

use super::chi_square::{DirectionGrid, check_p_values, lobe, p_of_samples};
use super::*;

fn sheeting(class: &str, colour: &str) -> MaterialTable {
    let preset = SheetingPreset::named(class, colour).expect("a preset");
    material_table(Surface::Sheeting(Box::new(preset.sheeting().expect("a sheeting"))))
}

fn marking(r_l: f64, day: DaytimeBrightness) -> MaterialTable {
    let white = Spectrum::constant(1.0);
    material_table(Surface::Marking(Box::new(RoadMarking::new(r_l, day, &white).expect("a marking"))))
}

/// Unit directions to lamp and viewer.
#[derive(Clone, Copy)]
struct RetroGeometry {
    lamp: Vec3,
    viewer: Vec3,
}

/// Unit directions at an elevation angle from the normal, one in the plane of the other or across it.
fn lamp_and_viewer(entrance_deg: f64, observation_deg: f64, turn_deg: f64) -> RetroGeometry {
    let [b, a, t] = [entrance_deg, observation_deg, turn_deg].map(f64::to_radians);
    let (sin, cos) = (etendue_core::maths::f64::sin, etendue_core::maths::f64::cos);
    let lamp = glam::DVec3::new(sin(b), 0.0, cos(b));
    let (up, side) = (glam::DVec3::new(-cos(b), 0.0, sin(b)), glam::DVec3::Y);
    let viewer = lamp * cos(a) + (up * cos(t) + side * sin(t)) * sin(a);
    RetroGeometry { lamp: lamp.as_vec3(), viewer: viewer.as_vec3() }
}

/// Luminance over the illuminance across the beam, in the light of illuminant A.
fn luminance(material_table: &MaterialTable, directions: RetroGeometry) -> f64 {
    let RetroGeometry { lamp, viewer } = directions;
    let a = etendue_spectra::illuminant::by_name("A").expect("A");
    let actual = Spectrum::from_fn(|nm| {
        let wavelengths = Wavelengths { nm: [nm as f32; 4], pdf: [1.0; 4] };
        f64::from(material_table.bsdf(MaterialId(0), &LOOKUP, true, &wavelengths).evaluate(viewer, lamp).value_cos[0])
    });
    etendue_spectra::observer::xyz_of_reflectance(&actual, a)[1]
}

#[test]
fn a_sign_has_the_luminance_of_its_coefficient() {
    for (class, colour) in [("ra1", "white"), ("ra2", "white"), ("ra2", "red"), ("d4956-ix", "yellow")] {
        let preset = SheetingPreset::named(class, colour).expect("a preset");
        let sign = sheeting(class, colour);
        for entrance_deg in [5.0, 30.0, 40.0] {
            for observation_deg in [0.2, 0.33, 1.0, 2.0] {
                for turn in [0.0, 90.0, 200.0] {
                    let geometry = lamp_and_viewer(entrance_deg, observation_deg, turn);
                    let r_a = preset.table.at(observation_deg.to_radians() as f32, entrance_deg.to_radians() as f32);
                    // L = R_A E⊥/cos ν, the base's light included. The angle between directions in f32: 3e-5 at 0.2°,
                    // and R_A falls with a power of up to 3 of it.
                    let expected = f64::from(r_a / geometry.viewer.z);
                    let actual = luminance(&sign, geometry);
                    let place = format!("{class} {colour} {entrance_deg} {observation_deg} {turn}");
                    assert!((actual / expected - 1.0).abs() < 1e-3, "{place}: {actual} {expected}");
                }
            }
        }
    }
}

#[test]
fn a_sign_is_never_darker_than_its_base() {
    let table = RetroTable::new(&[0.2, 2.0], &[5.0], &[70.0, 0.01]).expect("a table");
    let white = Spectrum::constant(1.0);
    let sheet = Sheeting::new(white.scaled(0.4), &white, table).expect("a sheeting");
    let sign = material_table(Surface::Sheeting(Box::new(sheet)));
    let geometry = lamp_and_viewer(5.0, 2.0, 0.0);
    let base = f64::from(0.4 * core::f32::consts::FRAC_1_PI * geometry.lamp.z);
    assert!((luminance(&sign, geometry) / base - 1.0).abs() < 1e-5);
}

#[test]
fn a_marking_returns_its_coefficient_at_the_30_m_geometry() {
    for (r_l, day) in [
        (100.0, DaytimeBrightness::Qd(100.0)),
        (300.0, DaytimeBrightness::Qd(160.0)),
        (150.0, DaytimeBrightness::LuminanceFactor(0.6)),
    ] {
        let material_table = marking(r_l, day);
        let actual = luminance(&material_table, lamp_and_viewer(88.76, 1.05, 0.0));
        assert!((actual / (r_l * 1e-3) - 1.0).abs() < 1e-3, "{r_l}: {actual}");
    }
}

#[test]
fn a_lamp_farther_from_the_viewer_is_sent_back_weaker() {
    let sign = sheeting("ra2", "white");
    let at = |degrees| luminance(&sign, lamp_and_viewer(5.0, degrees, 0.0));
    // The lamp of a lorry at 1.8 m under the viewer, 100 m away, compared with a car's at 0.6 m.
    assert!(at(0.34) > 8.0 * at(1.03), "{} {}", at(0.34), at(1.03));
    let stripe = marking(300.0, DaytimeBrightness::Qd(130.0));
    let at = |degrees| luminance(&stripe, lamp_and_viewer(88.0, degrees, 0.0));
    assert!(at(0.5) > 1.5 * at(1.9), "{} {}", at(0.5), at(1.9));
}

#[test]
fn directions_are_sampled_by_the_density_stated() {
    // The density ends abruptly at the cut-off: cells that end there too, at the 14th ring of 20.
    let scale_of = |class, colour| {
        let preset = SheetingPreset::named(class, colour).expect("a preset");
        let cut_off_deg = preset.sheeting().expect("a sheeting").cut_off_deg() as f32;
        etendue_core::maths::f32::tan(0.5 * cut_off_deg.to_radians()) * 6.0 / 14.0
    };
    let sheet = |class, colour| (sheeting(class, colour), scale_of(class, colour));
    let cases = [
        sheet("ra2", "white"),
        sheet("ra1", "red"),
        sheet("d4956-ix", "blue"),
        (marking(300.0, DaytimeBrightness::Qd(130.0)), 0.03),
    ];
    let mut p_values = vec![];
    for (k, (material_table, scale)) in cases.iter().enumerate() {
        for (i, degrees) in [0.0, 30.0, 70.0, 86.0].into_iter().enumerate() {
            let wo = at_degrees(degrees);
            let grid = DirectionGrid::new(lobe(wo, *scale), lobe(Vec3::NEG_Z, 1.0));
            let p = p_of_samples(&bsdf(material_table), wo, &grid, 2000 + (k * 4 + i) as u32);
            p_values.push((p, format!("case {k} at {degrees}°")));
        }
    }
    check_p_values(&p_values);
}

#[test]
fn lamp_and_viewer_may_nearly_be_exchanged() {
    // Tables use the lamp's angle to the normal as if it were the viewer's; within the lobe they differ by α at most. Measured: the
    // difference of the sheeting's values when both are exchanged, at 0.33° and 2°.
    let sign = sheeting("ra2", "white");
    let bsdf = bsdf(&sign);
    for (observation_deg, maximum) in [(0.33, 0.01), (2.0, 0.12)] {
        let mut worst = 0.0_f32;
        for entrance_deg in [0.0, 10.0, 25.0, 35.0, 60.0, 85.0] {
            let RetroGeometry { lamp, viewer } = lamp_and_viewer(entrance_deg, observation_deg, 0.0);
            let there = bsdf.evaluate(viewer, lamp).value_cos[1] / lamp.z;
            let back = bsdf.evaluate(lamp, viewer).value_cos[1] / viewer.z;
            worst = worst.max((there / back - 1.0).abs());
        }
        assert!(worst < maximum && worst > 0.0, "{observation_deg}: {worst}");
    }
}

#[test]
fn no_sign_sends_back_more_than_arrives() {
    for class in SHEETING_CLASSES {
        for colour in ["white", "red"] {
            let material_table = sheeting(class, colour);
            for degrees in [0.0, 5.0, 30.0, 60.0, 75.0, 80.0, 85.0, 89.0, 89.9] {
                let albedo = albedo(&bsdf(&material_table), at_degrees(degrees));
                assert!(albedo.max_value() < 1.002, "{class} {colour} at {degrees}: {albedo:?}");
            }
        }
    }
}

#[test]
fn limits_are_reported_in_words() {
    let preset = SheetingPreset::named("ra1", "white").expect("a preset");
    let words = preset.sheeting().expect("a sheeting").limits();
    assert!(words.contains("below an observation angle of 0.2° and from 2° to"), "{words}");
    // A table so bright that its lobe must end early.
    let bright = RetroTable::new(&[0.2, 2.0], &[5.0], &[250.0, 40.0]).expect("a table");
    let white = Spectrum::constant(1.0);
    let sheeting = Sheeting::new(white.scaled(0.3), &white, bright.clone()).expect("a sheeting");
    assert!(sheeting.cut_off_deg() < 9.0 && sheeting.limits().contains("limited by energy conservation"));
    let error = Sheeting::new(white.scaled(0.3), &white, bright.scaled(20.0)).expect_err("it gains");
    assert!(matches!(error, SheetingError::Energy(gain) if gain.albedo > 1.0), "{error}");
}

#[test]
fn faulty_sheets_and_markings_are_refused() {
    let white = Spectrum::constant(1.0);
    let table = SheetingPreset::named("ra1", "white").expect("a preset").table;
    let black = Spectrum::constant(0.0);
    assert_eq!(Sheeting::new(black.clone(), &black, table.clone()), Err(SheetingError::Colour));
    assert_eq!(Sheeting::new(white.scaled(-0.1), &white, table), Err(SheetingError::Base));
    let of = |r_l, day| RoadMarking::new(r_l, day, &white).expect_err("faulty");
    assert!(matches!(of(2.0, DaytimeBrightness::Qd(130.0)), MarkingError::Coefficient { .. }));
    assert!(matches!(of(100.0, DaytimeBrightness::Qd(400.0)), MarkingError::Day { .. }));
    assert!(matches!(of(1e6, DaytimeBrightness::Qd(130.0)), MarkingError::Energy(_)));
    assert_eq!(RoadMarking::new(100.0, DaytimeBrightness::Qd(130.0), &black), Err(MarkingError::Colour));
    let spread = RoadMarking::with_spread(100.0, DaytimeBrightness::Qd(130.0), &white, 60.0);
    assert_eq!(spread, Err(MarkingError::Spread { spread_deg: 60.0 }));
    assert_eq!((marking_class("r3"), marking_class("r9")), (Some(150.0), None));
}
