//! Prescriptions compared with closed forms.

use etendue_optics::lens::PrescriptionLens;
use etendue_optics::prescription::surface::Surface;
use etendue_optics::prescription::trace::{LensRay, RayLossReason};
use etendue_optics::prescription::{Focus, published};
use etendue_optics::{Lens, Prescription, PrescriptionError, PrescriptionParameters};
use etendue_spectra::glass::Dispersion;
use glam::DVec3;

const GLASS: Dispersion = Dispersion::Constant { n: 1.5 };
const AIR: Dispersion = Dispersion::AIR;

fn parameters(surfaces: Vec<Surface>) -> PrescriptionParameters {
    let focus = Focus::Sensor { distance_m: f64::INFINITY };
    PrescriptionParameters::new(surfaces, focus)
}

fn lens(surfaces: Vec<Surface>) -> Prescription {
    Prescription::new(parameters(surfaces)).expect("a lens")
}

fn refusal(surfaces: Vec<Surface>) -> String {
    Prescription::new(parameters(surfaces)).expect_err("no lens").to_string()
}

/// A biconvex lens of 50 mm radii, 6 mm thick, its stop 2 mm in front.
fn biconvex() -> Vec<Surface> {
    vec![Surface::stop(2.0, 4.0), Surface::sphere(50.0, 6.0, GLASS, 10.0), Surface::sphere(-50.0, 0.0, AIR, 10.0)]
}

#[test]
fn the_lensmakers_equation() {
    let p = *lens(biconvex()).paraxial();
    // 1/f = (n − 1)(1/R₁ − 1/R₂ + (n − 1) d/(n R₁ R₂)); back focus f (1 − (n − 1) d/(n R₁)). Rounding.
    let f = 1.0 / (0.5 * (2.0 / 50.0 - 0.5 * 6.0 / (1.5 * 2500.0)));
    assert!((p.focal_length_mm / f - 1.0).abs() < 1e-14);
    assert!((p.back_focus_mm - f * (1.0 - 0.5 * 6.0 / (1.5 * 50.0))).abs() < 1e-12);
    assert_eq!(
        [p.entrance_pupil_position_mm, p.entrance_radius_mm],
        [0.0, 4.0],
        "a stop in front is the entrance pupil"
    );
    // The Petzval sum of two surfaces: 2 (n − 1)/(n R).
    assert!((p.petzval_radius_mm + 1.5 * 50.0 / (2.0 * 0.5)).abs() < 1e-12);
    // The exit pupil is the stop's image: 1/s′ = 1/f − 1/s from the principal planes, both 2.04… mm inside.
    let s = 2.0 + p.front_principal_mm - 2.0;
    let image = 1.0 / (1.0 / f - 1.0 / s);
    assert!((p.exit_pupil_position_mm - (p.rear_principal_mm + image)).abs() < 1e-10);
    assert!((p.exit_radius_mm - 4.0 * (image / s).abs()).abs() < 1e-12);
}

/// The edge of the exit pupil, seen from the sensor, is the f-number: N = d′/(2 a′) at infinity focus.
#[test]
fn the_exit_pupil_lies_where_the_f_number_says() {
    for name in ["double-gauss", "wide-angle", "telephoto"] {
        let surfaces = published::named(name).expect("published").surfaces();
        let prescription = lens(surfaces);
        let radius_mm = prescription.paraxial().exit_radius_mm;
        let lens = Lens::prescription(PrescriptionLens::new(prescription, None, 1.0).expect("lit"));
        let ratio = lens.exit_pupil_distance_mm() / (2.0 * radius_mm) / lens.working_f_number();
        // The published back focus is rounded to 1e-4 of the focal length or so, and focusing is by the sensor.
        assert!((ratio - 1.0).abs() < 1e-6, "{name}: {ratio}");
    }
}

#[test]
fn a_plano_hyperbolic_lens_is_stigmatic() {
    // From glass of index n into air, a hyperboloid of k = −n² brings parallel light to a point R/(n − 1) behind it
    // (Descartes 1637), at every height.
    let hyperbola = Surface { conic: -2.25, ..Surface::sphere(-20.0, 0.0, AIR, 15.0) };
    let lens = lens(vec![Surface::stop(1.0, 14.0), Surface::sphere(f64::INFINITY, 9.0, GLASS, 15.0), hyperbola]);
    assert!((lens.sensor_position_mm() - (10.0 + 40.0)).abs() < 1e-12);
    for height in [0.1, 3.0, 9.0, 13.9] {
        let ray = LensRay { point: DVec3::new(0.0, height, -5.0), direction: DVec3::Z };
        let (out, transmittance) = lens.to_sensor(ray, 550.0).expect("through");
        let t = (lens.sensor_position_mm() - out.point.z) / out.direction.z;
        let at = out.point + out.direction * t;
        assert!(at.truncate().length() < 1e-12, "{height}: {at}");
        assert!(transmittance < 0.9217 && transmittance > 0.85, "two bare faces: at most 0.96² and less at an angle");
    }
}

#[test]
fn light_comes_back_the_way_it_went() {
    for published in published::LENSES {
        let lens = lens(published.surfaces());
        let start = LensRay {
            point: DVec3::new(0.3, 0.2, lens.sensor_position_mm()),
            direction: DVec3::new(0.02, -0.03, -1.0).normalize(),
        };
        let (out, t) = lens.to_scene(start, 480.0).expect("through");
        let back = LensRay { point: out.point + out.direction * 7.0, direction: -out.direction };
        let (again, t2) = lens.to_sensor(back, 480.0).expect("back");
        // Rounding through two dozen surfaces.
        assert!((again.direction + start.direction).length() < 1e-12, "{}", published.name);
        assert!((again.point - start.point).cross(start.direction).length() < 1e-11);
        assert!((t - t2).abs() < 1e-12 && t > 0.2, "{t}");
    }
}

#[test]
fn close_focus_follows_the_lens_equation_and_a_group_may_bring_it() {
    let f = lens(biconvex()).paraxial().focal_length_mm;
    let near = |focus| {
        let surfaces = biconvex();
        Prescription::new(PrescriptionParameters { focus, ..parameters(surfaces) }).expect("in focus")
    };
    let by_sensor = near(Focus::Sensor { distance_m: 0.5 });
    let object = 500.0 + by_sensor.paraxial().front_principal_mm;
    let image = 1.0 / (1.0 / f - 1.0 / object);
    let behind = by_sensor.sensor_position_mm() - by_sensor.last_vertex_mm() - by_sensor.paraxial().rear_principal_mm;
    assert!((behind - image).abs() < 1e-10 && (by_sensor.magnification() - image / object).abs() < 1e-12);
    // Moving all surfaces is equivalent to moving the sensor.
    let by_all = near(Focus::Group { distance_m: 0.5, first: 0, last: 2 });
    assert!(
        (by_all.sensor_position_mm() - by_sensor.sensor_position_mm()).abs() < 1e-9,
        "{} {}",
        by_all.sensor_position_mm(),
        by_sensor.sensor_position_mm()
    );
    // A sensor fixed at that position has the same distance in focus.
    let fixed = near(Focus::Fixed { back_focus_mm: by_sensor.sensor_position_mm() - by_sensor.last_vertex_mm() });
    assert!((fixed.focus_distance_m() - 0.5).abs() < 1e-12, "{}", fixed.focus_distance_m());
}

#[test]
fn what_is_no_lens_is_refused_with_its_reason() {
    let with = |change: &dyn Fn(&mut Vec<Surface>)| {
        let mut surfaces = biconvex();
        change(&mut surfaces);
        refusal(surfaces)
    };
    assert!(with(&|s| s.clear()).starts_with("the prescription has no surface"));
    assert!(with(&|s| s[0].stop = false).starts_with("0 surfaces are the stop"));
    assert!(with(&|s| s[1].stop = true).starts_with("2 surfaces are the stop"));
    assert!(with(&|s| s[1].radius_mm = 0.0).starts_with("surface 2: radius_mm is 0"));
    assert!(with(&|s| s[1].thickness_mm = -1.0).starts_with("surface 2: thickness_mm is -1"));
    assert!(with(&|s| s[1].semi_aperture_mm = 51.0).starts_with("surface 2: semi_aperture_mm is 51"));
    assert!(with(&|s| s[1].thickness_mm = 1.0).starts_with("surfaces 2 and 3 overlap"));
    assert!(with(&|s| s[2].glass = GLASS).starts_with("the medium behind the last surface is glass"));
    assert!(with(&|s| s[1].radius_mm = -30.0).starts_with("the prescription has a focal length of -"));
    assert!(with(&|s| s[1].semi_aperture_mm = 3.0).starts_with("surface 2 clips the axial bundle"));
    // A rear surface so strong that the edge of the axial bundle meets it beyond the critical angle.
    let strong = refusal(vec![
        Surface::stop(0.1, 9.0),
        Surface::sphere(f64::INFINITY, 12.0, Dispersion::Constant { n: 1.9 }, 10.0),
        Surface::sphere(-11.0, 0.0, AIR, 10.5),
    ]);
    assert!(strong.starts_with("surface 3 totally reflects rays of the axial bundle"), "{strong}");
}

#[test]
fn focusing_refuses_what_cannot_be() {
    let focused = |focus| Prescription::new(PrescriptionParameters { focus, ..parameters(biconvex()) });
    let zero = focused(Focus::Sensor { distance_m: 0.0 });
    assert_eq!(zero, Err(PrescriptionError::FocusDistance { focus_m: 0.0 }));
    assert!(matches!(focused(Focus::Sensor { distance_m: 0.03 }), Err(PrescriptionError::ImageInside { .. })));
    assert!(matches!(
        focused(Focus::Group { distance_m: 1.0, first: 1, last: 1 }),
        Err(PrescriptionError::Group { .. })
    ));
    let fast = Prescription::new(PrescriptionParameters { f_number: Some(2.0), ..parameters(biconvex()) });
    assert!(fast.expect_err("too fast").to_string().starts_with("f_number 2 needs a stop of"));
    let slow = Prescription::new(PrescriptionParameters { f_number: Some(11.0), ..parameters(biconvex()) });
    assert!((slow.expect("stopped down").paraxial().f_number() - 11.0).abs() < 1e-12);
}

#[test]
fn lost_rays_say_where() {
    let lens = lens(biconvex());
    let outside = LensRay { point: DVec3::new(0.0, 11.0, lens.sensor_position_mm()), direction: DVec3::NEG_Z };
    let lost = lens.to_scene(outside, 550.0).expect_err("beside the lens");
    assert_eq!((lost.surface, lost.loss), (2, RayLossReason::Clipped));
    let away = LensRay {
        point: DVec3::new(0.0, 0.0, lens.sensor_position_mm()),
        direction: DVec3::new(0.95, 0.0, -0.1).normalize(),
    };
    assert_eq!(lens.to_scene(away, 550.0).expect_err("beside the sphere").loss, RayLossReason::Missed);
}

#[test]
fn a_group_inside_the_lens_focuses_and_breathes() {
    let surfaces = published::named("double-gauss").expect("a published lens").surfaces();
    let far = lens(surfaces.clone());
    let focus = Focus::Group { distance_m: 3.0, first: 6, last: 10 };
    let near = Prescription::new(PrescriptionParameters { focus, ..parameters(surfaces) }).expect("in focus");
    // The sensor has not moved, the group has, and the image of 3 m lies on the sensor.
    assert!((near.sensor_position_mm() - far.sensor_position_mm()).abs() < 1e-12);
    let moved_mm = near.surfaces()[5].thickness_mm - far.surfaces()[5].thickness_mm;
    assert!(moved_mm.abs() > 0.1 && (near.surfaces()[10].thickness_mm).abs() < 1e-12, "{moved_mm}");
    let miss_mm = near.image_mm(587.56) - (near.sensor_position_mm() - near.last_vertex_mm());
    assert!(miss_mm.abs() < 1e-9, "{miss_mm}");
    assert!((near.paraxial().focal_length_mm - far.paraxial().focal_length_mm).abs() > 1e-3, "it breathes");
    assert!((near.magnification() / (near.paraxial().focal_length_mm / 3000.0) - 1.0).abs() < 0.1);
}
