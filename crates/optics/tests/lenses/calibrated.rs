//! Calibrated and telecentric cameras: the contract of all lenses.

use core::f64::consts::PI;
use etendue_core::WavelengthRange;
use etendue_core::maths::f64::{atan2, cos, sin};
use etendue_optics::{
    CalibratedParameters, Falloff, Lens, OpticsError, PinholeParameters, PupilOrientation, PupilProjection,
    TelecentricParameters,
};
use etendue_projection::model::{Ideal, KannalaBrandt, Panorama, Perspective};
use etendue_projection::{Calibration, CameraMatrix, Model, Raster};
use glam::{DVec2, DVec3};

const PITCH_MM: f64 = 0.01;
const SIZE: [usize; 2] = [640, 480];

fn parameters(model: Model, f_px: f64) -> CalibratedParameters {
    let matrix = CameraMatrix { fx: f_px, fy: f_px, skew: 0.0, cx: 320.0, cy: 240.0 };
    CalibratedParameters {
        calibration: Calibration::new(model, matrix, SIZE).expect("a calibration"),
        pixel_pitch_mm: PITCH_MM,
        f_number: 2.0,
        transmittance: 0.9,
        focus_distance_m: None,
        pupil: None,
        relative_illumination: None,
    }
}

fn ideal(projection: Ideal, f_px: f64) -> Lens {
    Lens::calibrated(parameters(Model::Ideal(projection), f_px)).expect("a camera")
}

fn fourth(x: f64) -> f64 {
    x * x * x * x
}

fn points() -> impl Iterator<Item = DVec2> {
    (0..200).map(|i| {
        let step = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
        ((step * f64::from(i) + 0.5).fract() - 0.5) * DVec2::new(6.4, 4.8)
    })
}

/// Without distortion it is equal to the pinhole: the same rays, the same light.
#[test]
fn a_calibration_without_distortion_is_the_pinhole() {
    let lens = Lens::calibrated(parameters(Model::Perspective(Perspective::pinhole()), 400.0)).expect("a camera");
    let same = Lens::pinhole(PinholeParameters { focal_length_mm: 4.0, f_number: 2.0, transmittance: 0.9 });
    let same = same.expect("a pinhole");
    assert!((lens.focal_length_mm() - 4.0).abs() < 1e-12);
    for s in points() {
        let (a, b) = (lens.principal_ray(s).expect("seen"), same.principal_ray(s).expect("seen"));
        // Rounding of a few operations.
        assert!((a.direction - b.direction).length() < 1e-14 && (a.weight_sr / b.weight_sr - 1.0).abs() < 1e-13);
        assert!((lens.project(a.direction).expect("in front") - s).length() < 1e-11);
    }
}

/// E/L over that on the axis, by the field angle θ: Ray, Applied Photographic Optics (2002), with the pupil's own factor.
#[test]
fn ideal_projections_fall_off_by_their_closed_forms() {
    type Law = fn(f64) -> f64;
    let laws: [(Ideal, Law); 5] = [
        (Ideal::Equidistant, |t| sin(t) / t),
        (Ideal::Equisolid, |_| 1.0),
        (Ideal::Stereographic, |t| fourth(cos(0.5 * t))),
        (Ideal::Orthographic, |_| 1.0),
        (Ideal::Rectilinear, |t| fourth(cos(t))),
    ];
    for (projection, law) in laws {
        let lens = ideal(projection, 500.0);
        let axis = 0.9 * PI / 16.0;
        assert!(
            (lens.projected_solid_angle_sr(DVec2::ZERO) / axis - 1.0).abs() < 1e-12,
            "{projection:?}: E = π τ L/(4 N²)"
        );
        // The first point is the axis, where the laws are 0/0.
        for s in points().skip(1) {
            let direction = lens.direction(s).expect("seen");
            let angle = atan2(direction.truncate().length(), direction.z);
            assert!(
                (lens.projected_solid_angle_sr(s) / (axis * law(angle)) - 1.0).abs() < 1e-9,
                "{projection:?} at {angle}"
            );
        }
    }
}

/// The light collected by a whole-sphere image from a uniform surround: L A_p times the sphere's 4π.
#[test]
fn a_sphere_s_worth_of_solid_angle_lands_on_a_panorama() {
    let f_px = 640.0 / (2.0 * PI);
    let lens = Lens::calibrated(parameters(Model::Panorama(Panorama::Equirectangular), f_px)).expect("a camera");
    let focal_mm = lens.focal_length_mm();
    let mut flux = 0.0;
    for i in 0..640_u32 * 320 {
        let px = DVec2::new(f64::from(i % 640) + 0.5, f64::from(i / 640) + 0.5 + 80.0);
        flux += lens.projected_solid_angle_sr((px - DVec2::new(320.0, 240.0)) * PITCH_MM) * PITCH_MM * PITCH_MM;
    }
    let exact = 0.9 * PI * (focal_mm / 4.0) * (focal_mm / 4.0) * 4.0 * PI;
    // The midpoint rule over 320 rows: (π/320)²/24 = 4e-6.
    assert!((flux / exact - 1.0).abs() < 1e-5, "{flux} {exact}");
}

#[test]
fn fisheyes_see_behind_themselves_and_a_flat_pupil_does_not() {
    let wide = ideal(Ideal::Equidistant, 150.0);
    let at = DVec2::new(3.0, 0.0);
    let ray = wide.principal_ray(at).expect("114.6° from the axis");
    assert!(ray.direction.z < 0.0 && ray.weight_sr > 0.0);
    let flat = CalibratedParameters {
        pupil: Some(PupilOrientation::Flat),
        ..parameters(Model::Ideal(Ideal::Equidistant), 150.0)
    };
    let flat = Lens::calibrated(flat).expect("a camera");
    assert!(
        flat.principal_ray(at).is_none() && flat.truth_ray(at).is_none() && flat.projected_solid_angle_sr(at) == 0.0
    );
    let angle = 1.0;
    let s = DVec2::new(1.5 * angle, 0.0);
    let ratio = flat.projected_solid_angle_sr(s) / wide.projected_solid_angle_sr(s);
    assert!((ratio - cos(angle)).abs() < 1e-12, "foreshortened");
}

#[test]
fn defocus_meets_where_it_is_sharp_and_weighs_as_the_principal_ray() {
    for (model, pupil) in
        [(Ideal::Rectilinear, PupilOrientation::Flat), (Ideal::Equidistant, PupilOrientation::Oriented)]
    {
        let sharp = CalibratedParameters { focus_distance_m: Some(3.0), ..parameters(Model::Ideal(model), 400.0) };
        let lens = Lens::calibrated(CalibratedParameters { pupil: Some(pupil), ..sharp }).expect("a camera");
        assert!((lens.entrance_pupil_radius_m() - 0.001).abs() < 1e-12, "4 mm / (2 · 2)");
        for s in points() {
            let principal = lens.principal_ray(s).expect("seen");
            let along = if pupil == PupilOrientation::Flat { 3.0 / principal.direction.z } else { 3.0 };
            let target = principal.direction * along;
            for u in [DVec2::new(0.1, 0.9), DVec2::new(0.7, 0.3)] {
                let ray = lens.ray(s, u, 550.0).expect("open");
                let miss = (target - ray.origin_m).cross(ray.direction).length();
                assert!(miss < 1e-14 && ray.weight_sr == principal.weight_sr && ray.origin_m.length() <= 0.001 + 1e-15);
                let tilt = if pupil == PupilOrientation::Flat { DVec3::Z } else { principal.direction };
                assert!(ray.origin_m.dot(tilt).abs() < 1e-15);
            }
        }
        // Infinity is legal: all rays are parallel.
        let far =
            CalibratedParameters { focus_distance_m: Some(f64::INFINITY), ..parameters(Model::Ideal(model), 400.0) };
        let far = Lens::calibrated(far).expect("a camera");
        let parallel = far.ray(DVec2::ONE, DVec2::splat(0.2), 550.0).expect("open").direction;
        assert!((parallel - far.principal_ray(DVec2::ONE).expect("seen").direction).length() < 1e-15);
    }
}

#[test]
fn a_measured_illumination_takes_the_place_of_the_projection_s() {
    let falloff = Falloff::new(vec![(0.0, 1.0), (2.0, 0.5), (4.0, 0.3)]).expect("a table");
    let measured = CalibratedParameters {
        relative_illumination: Some(falloff),
        ..parameters(Model::Ideal(Ideal::Rectilinear), 400.0)
    };
    let lens = Lens::calibrated(measured).expect("a camera");
    let ratio = lens.projected_solid_angle_sr(DVec2::new(1.0, 0.0)) / lens.projected_solid_angle_sr(DVec2::ZERO);
    assert!((ratio - 0.75).abs() < 1e-14);
    let raster = |width, height| Raster::centred(width, height, PITCH_MM).expect("a raster");
    // The corner lies at exactly 4 mm.
    assert!(lens.check(&raster(640, 480)).is_ok());
    let short = Falloff::new(vec![(0.0, 1.0), (3.9, 0.5)]).expect("a table");
    let short = CalibratedParameters {
        relative_illumination: Some(short),
        ..parameters(Model::Ideal(Ideal::Rectilinear), 400.0)
    };
    let refused = Lens::calibrated(short).expect("a camera").check(&raster(640, 480));
    assert!(matches!(refused, Err(OpticsError::FalloffEnds { .. })));
}

#[test]
fn what_cannot_be_is_refused() {
    let raster = Raster::centred(320, 240, PITCH_MM).expect("a raster");
    let lens = ideal(Ideal::Equidistant, 400.0);
    assert!(matches!(lens.check(&raster), Err(OpticsError::CalibratedSize { width: 640, .. })));
    let parallel = Lens::telecentric(TelecentricParameters { metres_per_mm: 1.0, f_number: 4.0, transmittance: 1.0 });
    assert!(matches!(
        PupilProjection::covering(&parallel.expect("legal"), &raster, [0, 0], WavelengthRange::new(400.0, 700.0)),
        Err(OpticsError::NoPupilRoute { .. })
    ));
    let folding = KannalaBrandt::new([-0.3, 0.0, 0.0, 0.0]).expect("finite");
    let folding = Lens::calibrated(parameters(Model::KannalaBrandt(folding), 300.0)).expect("a camera");
    let full = Raster::centred(640, 480, PITCH_MM).expect("a raster");
    // r = θ − 0.3 θ³ turns at θ = 1/√0.9, where r is 2/3 of it: 210.8 px.
    let text = folding.check(&full).expect_err("it folds at 211 px, the corner is at 400 px").to_string();
    assert!(text.contains("210.8"), "{text}");
    for focus_m in [0.0, -1.0, f64::NAN] {
        let near = CalibratedParameters {
            focus_distance_m: Some(focus_m),
            ..parameters(Model::Ideal(Ideal::Rectilinear), 400.0)
        };
        assert!(matches!(Lens::calibrated(near), Err(OpticsError::FocusTooNear { .. })));
    }
}

#[test]
fn parallel_rays_are_as_far_apart_as_the_field_is_wide() {
    let lens = Lens::telecentric(TelecentricParameters { metres_per_mm: 0.5, f_number: 2.0, transmittance: 0.9 });
    let lens = lens.expect("a camera");
    for s in points() {
        let ray = lens.ray(s, DVec2::splat(0.3), 550.0).expect("everywhere");
        assert_eq!((ray.origin_m, ray.direction), ((s * 0.5).extend(0.0), DVec3::Z));
        assert!((ray.weight_sr - 0.9 * PI / 16.0).abs() < 1e-15);
    }
    assert!(lens.project(DVec3::Z).is_none() && lens.angle_between_rad(DVec2::ZERO, DVec2::ONE) == Some(0.0));
    assert!(lens.focus_distance_m().is_none());
}
