//! Light through a lens: pupil sampling compared with closed forms.

use core::f64::consts::PI;
use etendue_core::maths::f64::{acos, cos, tan};
use etendue_optics::{
    ClippingAperture, ConstantPupil, Lens, PinholeParameters, PupilParameters, ThickParameters, ThinParameters,
};
use etendue_projection::{DistortionDirection, RadialDistortion};
use glam::DVec2;

const FOCAL_MM: f64 = 25.0;

fn degrees(angle: f64) -> f64 {
    angle * PI / 180.0
}

fn thin(f_number: f64, focus_distance_m: f64) -> Lens {
    Lens::thin(ThinParameters { focal_length_mm: FOCAL_MM, f_number, focus_distance_m, transmittance: 1.0 })
        .expect("a legal lens")
}

fn thick_parameters(f_number: f64) -> ThickParameters {
    ThickParameters {
        focal_length_mm: FOCAL_MM,
        f_number,
        focus_distance_m: f64::INFINITY,
        transmittance: 1.0,
        principal_separation_mm: 0.0,
        pupils: PupilParameters::default(),
        constant_pupil: ConstantPupil::Exit,
        front_aperture: None,
        rear_aperture: None,
    }
}

fn magnified(f_number: f64, pupil_magnification: f64) -> ThickParameters {
    let pupils = PupilParameters { pupil_magnification: Some(pupil_magnification), ..PupilParameters::default() };
    ThickParameters { pupils, ..thick_parameters(f_number) }
}

fn thick(parameters: ThickParameters) -> Lens {
    Lens::thick(parameters).expect("a legal lens")
}

/// Mean weight over `side`² stratified pupil samples: irradiance under unit radiance.
fn sampled_sr(lens: &Lens, sensor_mm: DVec2, side: u32) -> f64 {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
    let samples = (0..side * side).map(|i| DVec2::new(at(i % side), at(i / side)));
    samples.filter_map(|u| lens.ray(sensor_mm, u, 550.0)).map(|ray| ray.weight_sr).sum::<f64>() / f64::from(side * side)
}

/// π times Foote's form factor of a disc of half-aperture `a` at field tangent `t`.
fn foote_sr(a: f64, t: f64) -> f64 {
    let s = 1.0 + t * t + a * a;
    PI * 0.5 * (1.0 - (1.0 + t * t - a * a) / (s * s - 4.0 * t * t * a * a).sqrt())
}

fn cos4(theta: f64) -> f64 {
    let c = cos(theta);
    c * c * c * c
}

#[test]
fn a_thin_lens_s_samples_have_foote_s_mean() {
    for f_number in [1.4, 2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 16.0] {
        let lens = thin(f_number, f64::INFINITY);
        for field in [0.0, 5.0, 10.0, 20.0, 30.0, 40.0] {
            let t = tan(degrees(field));
            let sensor_mm = DVec2::new(0.6, -0.8) * t * FOCAL_MM;
            let exact = foote_sr(0.5 / f_number, t);
            // Midpoint rule on 64 × 64 strata: its error falls as 1/64², times the integrand's relative curvature (< 0.5).
            assert!((sampled_sr(&lens, sensor_mm, 64) / exact - 1.0).abs() < 1e-4, "f/{f_number} at {field}°");
            // The formula as printed loses ε/a² by cancellation: 2e-13 at f/16.
            assert!((lens.projected_solid_angle_sr(sensor_mm) / exact - 1.0).abs() < 1e-12, "f/{f_number} at {field}°");
        }
    }
}

#[test]
fn a_wide_pupil_exceeds_cos4_by_the_known_share() {
    // + 2.5 % at f/2 and 20°, + 1.3 % at f/4 and 30°; the last digit given is 0.1 %.
    for (f_number, field, excess) in [(2.0, 20.0, 0.025), (4.0, 30.0, 0.013)] {
        let lens = thin(f_number, f64::INFINITY);
        let off = lens.projected_solid_angle_sr(DVec2::new(FOCAL_MM * tan(degrees(field)), 0.0));
        let ratio = off / (lens.projected_solid_angle_sr(DVec2::ZERO) * cos4(degrees(field)));
        assert!((ratio - 1.0 - excess).abs() < 5e-4, "f/{f_number} at {field}°: {ratio}");
    }
}

#[test]
fn a_slow_lens_and_a_pinhole_fall_by_cos4() {
    let parameters = PinholeParameters { focal_length_mm: FOCAL_MM, f_number: 16.0, transmittance: 0.8 };
    let pinhole = Lens::pinhole(parameters).expect("legal");
    let slow = thin(16.0, f64::INFINITY);
    for (field, expected) in [(10.0, 0.94060), (20.0, 0.77973), (30.0, 0.56250), (40.0, 0.34436), (60.0, 0.06250)] {
        let at = DVec2::new(0.0, FOCAL_MM * tan(degrees(field)));
        // Five digits are given.
        let falls = pinhole.projected_solid_angle_sr(at) / (0.8 * PI / (4.0 * 256.0));
        assert!((falls - expected).abs() < 6e-6, "{field}°: {falls}");
        // The disc's excess is of the order of a² = 1/1024.
        let ratio = slow.projected_solid_angle_sr(at) / slow.projected_solid_angle_sr(DVec2::ZERO);
        assert!((ratio / expected - 1.0).abs() < 2e-3, "{field}°: {ratio}");
        assert_eq!(sampled_sr(&pinhole, at, 2), pinhole.projected_solid_angle_sr(at));
    }
}

#[test]
fn the_pinhole_is_the_limit_of_small_pupils() {
    let at = DVec2::new(9.0, 4.0);
    let parameters = PinholeParameters { focal_length_mm: FOCAL_MM, f_number: 1e4, transmittance: 1.0 };
    let pinhole = Lens::pinhole(parameters).expect("legal");
    // Next term: a² = 1/(4·1e8).
    assert!(
        (thin(1e4, f64::INFINITY).projected_solid_angle_sr(at) / pinhole.projected_solid_angle_sr(at) - 1.0).abs()
            < 1e-8
    );
}

#[test]
fn close_focus_costs_light() {
    for (magnification, pupil_magnification) in [(0.02, 1.0), (0.1, 1.0), (0.1, 2.0), (1.0, 0.5)] {
        let focus_mm = FOCAL_MM * (1.0 / magnification + 1.0 / pupil_magnification);
        let parameters = ThickParameters { focus_distance_m: focus_mm / 1000.0, ..magnified(2.0, pupil_magnification) };
        let lens = thick(parameters);
        assert!((lens.magnification() / magnification - 1.0).abs() < 1e-12);
        // E/L = π / (1 + 4N² (1 − m/m_p)²), m < 0: the flat disc.
        let bellows = 1.0 + magnification / pupil_magnification;
        let expected = PI / (1.0 + 16.0 * bellows * bellows);
        assert!((lens.projected_solid_angle_sr(DVec2::ZERO) / expected - 1.0).abs() < 1e-12);
        assert!((lens.working_f_number() / (2.0 * bellows) - 1.0).abs() < 1e-12);
    }
    // m = −0.02 loses 3.9 %, m = −0.1 loses 17 % (small pupils).
    let slow = |m: f64| thin(100.0, FOCAL_MM * (1.0 + 1.0 / m) / 1000.0).projected_solid_angle_sr(DVec2::ZERO);
    let far = thin(100.0, f64::INFINITY).projected_solid_angle_sr(DVec2::ZERO);
    assert!((1.0 - slow(0.02) / far - 0.039).abs() < 5e-4);
    assert!((1.0 - slow(0.1) / far - 0.17).abs() < 5e-3);
}

#[test]
fn transmittance_scales_all() {
    let parameters =
        ThinParameters { focal_length_mm: FOCAL_MM, f_number: 2.0, focus_distance_m: 3.0, transmittance: 0.25 };
    let lens = Lens::thin(parameters).expect("legal");
    let at = DVec2::new(3.0, 1.0);
    assert!((lens.projected_solid_angle_sr(at) / thin(2.0, 3.0).projected_solid_angle_sr(at) - 0.25).abs() < 1e-15);
    assert!((sampled_sr(&lens, at, 8) / sampled_sr(&thin(2.0, 3.0), at, 8) - 0.25).abs() < 1e-15);
    assert!((lens.t_number() - 4.0).abs() < 1e-15);
}

#[test]
fn a_thick_lens_with_all_planes_together_is_a_thin_one() {
    for constant_pupil in [ConstantPupil::Entrance, ConstantPupil::Exit] {
        let lens = thick(ThickParameters { focus_distance_m: 0.7, constant_pupil, ..thick_parameters(1.8) });
        let thin = thin(1.8, 0.7);
        for (sensor, pupil) in [((0.0, 0.0), (0.1, 0.9)), ((7.0, -3.0), (0.5, 0.5)), ((-20.0, 11.0), (0.99, 0.4))] {
            let (sensor, pupil) = (DVec2::from(sensor), DVec2::from(pupil));
            let (a, b) = (lens.ray(sensor, pupil, 550.0).expect("open"), thin.ray(sensor, pupil, 550.0).expect("open"));
            assert!((a.origin_m - b.origin_m).length() < 1e-17 && (a.direction - b.direction).length() < 1e-15);
            assert!((a.weight_sr / b.weight_sr - 1.0).abs() < 1e-14);
            assert!(
                (lens.projected_solid_angle_sr(sensor) / thin.projected_solid_angle_sr(sensor) - 1.0).abs() < 1e-14
            );
        }
        assert!((lens.sensor_plane_m() - thin.sensor_plane_m()).abs() < 1e-17);
        assert_eq!(lens.circle_of_confusion_mm(2.0), thin.circle_of_confusion_mm(2.0));
    }
}

#[test]
fn the_constant_pupil_rules_the_fall_off() {
    let at = DVec2::new(FOCAL_MM * tan(degrees(30.0)), 0.0);
    let ratio = |constant_pupil| {
        let lens = thick(ThickParameters { constant_pupil, ..magnified(16.0, 2.0) });
        lens.projected_solid_angle_sr(at) / lens.projected_solid_angle_sr(DVec2::ZERO)
    };
    let (entrance, exit) = (ratio(ConstantPupil::Entrance), ratio(ConstantPupil::Exit));
    // Small-pupil laws; the disc's excess is of the order of a² = 1/1024.
    assert!((entrance / cos4(degrees(30.0)) - 1.0).abs() < 2e-3, "{entrance}");
    let t = tan(degrees(30.0)) / 2.0;
    assert!((exit * (1.0 + t * t) * (1.0 + t * t) - 1.0).abs() < 2e-3, "{exit}");
    // They differ by a factor of 1.52 at 30° for a pupil magnification of 2; (16/13)² = 1.5148, and the disc's excess.
    assert!((exit / entrance / (256.0 / 169.0) - 1.0).abs() < 1e-3, "{}", exit / entrance);
}

#[test]
fn a_constant_entrance_pupil_conserves_etendue_through_distortion() {
    let distortion = RadialDistortion::new(DistortionDirection::IdealToObserved, -0.2, 0.03, FOCAL_MM).expect("legal");
    let parameters = ThickParameters { constant_pupil: ConstantPupil::Entrance, ..magnified(200.0, 1.6) };
    let lens = thick(parameters).with_distortion(distortion).expect("a paraxial lens");
    let (at, h) = (DVec2::new(8.0, -5.0), 1e-4);
    let direction = |p: DVec2| lens.principal_ray(p).expect("open").direction;
    let dx = (direction(at + DVec2::X * h) - direction(at - DVec2::X * h)) / (2.0 * h);
    let dy = (direction(at + DVec2::Y * h) - direction(at - DVec2::Y * h)) / (2.0 * h);
    let solid_angle_per_mm2 = dx.cross(dy).length();
    let area_mm2 = PI * (FOCAL_MM / 400.0) * (FOCAL_MM / 400.0);
    let expected = area_mm2 * direction(at).z * solid_angle_per_mm2;
    // The finite pupil: a² = 6e-6; the differences: h² and ε/h.
    assert!((lens.projected_solid_angle_sr(at) / expected - 1.0).abs() < 2e-5);
}

/// Common area of two circles.
fn two_circles(r1: f64, r2: f64, d: f64) -> f64 {
    let a1 = acos((d * d + r1 * r1 - r2 * r2) / (2.0 * d * r1));
    let a2 = acos((d * d + r2 * r2 - r1 * r1) / (2.0 * d * r2));
    let kite = (-d + r1 + r2) * (d + r1 - r2) * (d - r1 + r2) * (d + r1 + r2);
    r1 * r1 * a1 + r2 * r2 * a2 - 0.5 * kite.sqrt()
}

#[test]
fn an_aperture_cuts_the_area_of_two_circles() {
    let pupil_mm = FOCAL_MM / 128.0;
    let aperture = ClippingAperture { position_mm: -10.0, radius_mm: 0.15 };
    let open = thick(thick_parameters(64.0));
    let lens = thick(ThickParameters {
        front_aperture: Some(ClippingAperture { radius_mm: 0.3, ..aperture }),
        ..thick_parameters(64.0)
    });
    for tangent in [0.012, 0.02, 0.03, 0.045] {
        let at = DVec2::new(-0.6, 0.8) * FOCAL_MM * tangent;
        let fraction = lens.projected_solid_angle_sr(at) / open.projected_solid_angle_sr(at);
        let expected = two_circles(pupil_mm, 0.3, 10.0 * tangent) / (PI * pupil_mm * pupil_mm);
        // The integrand varies over the pupil by 4 T a = 4 · 0.045/128.
        assert!((fraction - expected).abs() < 1.5e-3, "{tangent}: {fraction} against {expected}");
    }
    assert_eq!(lens.projected_solid_angle_sr(DVec2::new(FOCAL_MM * 0.05, 0.0)), 0.0, "the circles no longer meet");
}

#[test]
fn a_rear_aperture_cuts_from_the_other_side() {
    // Small pupil, telescope-like: the rear aperture's projection from the sensor point, by similar triangles.
    let aperture = ClippingAperture { position_mm: 10.0, radius_mm: 0.2 };
    let lens = thick(ThickParameters { rear_aperture: Some(aperture), ..thick_parameters(64.0) });
    let open = thick(thick_parameters(64.0));
    let (pupil_mm, at) = (FOCAL_MM / 128.0, DVec2::new(0.5, 0.0));
    let left = 1.0 - 10.0 / FOCAL_MM;
    let (radius, centre) = (0.2 / left, 0.5 * (10.0 / FOCAL_MM) / left);
    let expected = two_circles(pupil_mm, radius, centre) / (PI * pupil_mm * pupil_mm);
    let fraction = lens.projected_solid_angle_sr(at) / open.projected_solid_angle_sr(at);
    // The integrand varies over the pupil by 4 T a = 4 · 0.02/128.
    assert!((fraction - expected).abs() < 7e-4, "{fraction} against {expected}");
}

#[test]
fn samples_of_a_clipped_pupil_have_the_quadrature_s_mean() {
    let parameters = ThickParameters {
        focus_distance_m: 0.8,
        principal_separation_mm: 4.0,
        front_aperture: Some(ClippingAperture { position_mm: -18.0, radius_mm: 9.5 }),
        rear_aperture: Some(ClippingAperture { position_mm: 19.0, radius_mm: 5.0 }),
        ..magnified(2.0, 0.8)
    };
    let lens = thick(parameters);
    let mut fractions = Vec::new();
    for field_mm in [0.5, 2.0, 4.0, 6.0, 8.0, 10.0] {
        let at = DVec2::new(0.28, 0.96) * field_mm;
        let exact = lens.projected_solid_angle_sr(at);
        // 512² cells, about 4 · 512 of them on an edge, half inside: √2048/512² · ½ of the disc, times ten for patterns.
        let scale = thick(ThickParameters { front_aperture: None, rear_aperture: None, ..parameters })
            .projected_solid_angle_sr(at);
        assert!((sampled_sr(&lens, at, 512) - exact).abs() < 1e-3 * scale, "{field_mm} mm");
        fractions.push(exact / scale);
    }
    assert!(fractions[0] == 1.0 && fractions[5] < 0.8, "the rims are there: {fractions:?}");
    assert!(fractions.windows(2).all(|pair| pair[1] <= pair[0]));
}
