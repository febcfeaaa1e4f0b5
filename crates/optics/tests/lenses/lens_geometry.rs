//! Ray geometry: focus, conjugates, projection.

use etendue_core::ray::PupilRay;
use etendue_optics::{
    ClippingAperture, ConstantPupil, Lens, OpticsError, PinholeParameters, PupilParameters, Thick, ThickParameters,
    ThinParameters,
};
use etendue_projection::{DistortionDirection, RadialDistortion, Raster};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

fn thin(focus_distance_m: f64) -> Lens {
    Lens::thin(ThinParameters { focal_length_mm: 16.0, f_number: 2.0, focus_distance_m, transmittance: 1.0 })
        .expect("legal")
}

fn thick_parameters() -> ThickParameters {
    ThickParameters {
        focal_length_mm: 16.0,
        f_number: 2.0,
        focus_distance_m: 0.6,
        transmittance: 0.9,
        principal_separation_mm: 5.0,
        pupils: PupilParameters { entrance_pupil_mm: Some(-3.2), ..PupilParameters::default() },
        constant_pupil: ConstantPupil::Exit,
        front_aperture: None,
        rear_aperture: None,
    }
}

fn thick() -> Thick {
    Thick::new(thick_parameters()).expect("legal")
}

fn pinhole() -> Lens {
    Lens::pinhole(PinholeParameters { focal_length_mm: 16.0, f_number: 8.0, transmittance: 1.0 }).expect("legal")
}

fn at_depth(ray: &PupilRay, z_m: f64) -> DVec3 {
    ray.origin_m + ray.direction * ((z_m - ray.origin_m.z) / ray.direction.z)
}

#[test]
fn all_rays_of_a_sensor_point_meet_in_the_plane_in_focus() {
    let distortion = RadialDistortion::new(DistortionDirection::ObservedToIdeal, 0.1, 0.0, 16.0).expect("legal");
    for lens in
        [thin(0.6), Lens::Thick(thick()), Lens::Thick(thick()).with_distortion(distortion).expect("a paraxial lens")]
    {
        for sensor in [DVec2::ZERO, DVec2::new(3.0, -2.0), DVec2::new(-6.0, 4.0)] {
            let meeting = at_depth(&lens.principal_ray(sensor).expect("open"), 0.6);
            for i in 0..64 {
                let pupil = DVec2::new(f64::from(i % 8) / 8.0, f64::from(i / 8) / 8.0);
                let ray = lens.ray(sensor, pupil, 550.0).expect("open");
                assert!((ray.direction.length() - 1.0).abs() < 1e-15 && ray.origin_m.z == 0.0);
                assert!(ray.origin_m.length() <= 1.2 * lens.entrance_pupil_radius_m());
                // A handful of roundings of lengths below a metre.
                assert!((at_depth(&ray, 0.6) - meeting).length() < 1e-14);
            }
        }
    }
}

#[test]
fn the_meeting_point_is_the_lens_equation_s() {
    let lens = thin(0.6);
    let magnification = 16.0 / (600.0 - 16.0);
    let meeting = at_depth(&lens.principal_ray(DVec2::new(2.0, 0.0)).expect("open"), 0.6);
    // The erect image: a point on its right is an object on the right.
    assert!((meeting.x - 2e-3 / magnification).abs() < 1e-14);
    assert!((lens.sensor_plane_m() + 0.016 * (1.0 + magnification)).abs() < 1e-16);
}

#[test]
fn rays_to_infinity_are_parallel() {
    let lens = thin(f64::INFINITY);
    let chief = lens.principal_ray(DVec2::new(1.0, 2.0)).expect("open").direction;
    let ray = lens.ray(DVec2::new(1.0, 2.0), DVec2::new(0.9, 0.2), 550.0).expect("open");
    assert_eq!(ray.direction, chief);
    assert_eq!(lens.principal_distance_mm(), 16.0);
}

#[test]
fn both_sides_of_a_thick_lens_meet_its_principal_planes_at_one_height() {
    // Gauss: the object-side ray at H and the image-side ray at H′ are equally far from the axis.
    let lens = thick();
    let wrapped = Lens::Thick(lens.clone());
    let exit_mm = lens.exit_pupil_position_mm();
    let exit_to_sensor_mm = lens.sensor_position_mm() - exit_mm;
    // Near the axis, where the scaling of the entrance pupil (1 + O(field²)) is below the tolerance.
    let sensor = DVec2::new(1e-3, 2e-3);
    let ray = wrapped.ray(sensor, DVec2::new(0.97, 0.3), 550.0).expect("open");
    // H lies at z = + entrance position (positive positions are towards the sensor) in the camera frame.
    let at_h_mm = at_depth(&ray, lens.entrance_pupil_position_mm() / 1000.0).truncate() * 1000.0;
    let exit_point = ray.origin_m.truncate() * 1000.0 * lens.pupil_magnification();
    let fraction = (5.0 - exit_mm) / exit_to_sensor_mm;
    let at_h2_mm = exit_point + (-sensor - exit_point) * fraction;
    assert!((at_h_mm - at_h2_mm).length() < 1e-6, "{at_h_mm} {at_h2_mm}");
    // And sensor and plane in focus are conjugate: 1/v + 1/u = 1/f from H′ and H.
    let (v, u) = (lens.sensor_position_mm() - 5.0, 600.0 - lens.entrance_pupil_position_mm());
    assert!((1.0 / v + 1.0 / u - 1.0 / 16.0).abs() < 1e-15);
}

#[test]
fn one_statement_about_the_pupils_fixes_the_others() {
    let lens = thick();
    assert!((lens.pupil_magnification() - 16.0 / 12.8).abs() < 1e-15);
    assert!((lens.exit_pupil_position_mm() - (5.0 + 16.0 * (1.0 - 1.25))).abs() < 1e-12);
    let agreeing =
        PupilParameters { entrance_pupil_mm: Some(-3.2), exit_pupil_mm: Some(1.0), pupil_magnification: Some(1.25) };
    assert!(Thick::new(ThickParameters { pupils: agreeing, ..thick_parameters() }).is_ok());
    let pupils = PupilParameters { pupil_magnification: Some(1.3), ..agreeing };
    let refused = Thick::new(ThickParameters { pupils, ..thick_parameters() }).expect_err("contradiction");
    assert!(matches!(refused, OpticsError::Pupils { second: "pupil_magnification", .. }));
    let text = refused.to_string();
    assert!(text.contains("entrance_pupil_mm = -3.2") && text.contains("1.3"), "{text}");
    for entrance in [-16.0, -20.0] {
        let pupils = PupilParameters { entrance_pupil_mm: Some(entrance), ..PupilParameters::default() };
        let refused = Thick::new(ThickParameters { pupils, ..thick_parameters() }).expect_err("telecentric");
        assert!(matches!(refused, OpticsError::PupilBeyondFocus { .. }));
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let base = ThinParameters { focal_length_mm: 16.0, f_number: 2.0, focus_distance_m: 1.0, transmittance: 1.0 };
    let refused = |p: ThinParameters| Lens::thin(p).expect_err("refused");
    let near = ThinParameters { focus_distance_m: 0.016, ..base };
    assert!(matches!(refused(near), OpticsError::FocusTooNear { least_m, .. } if (least_m - 0.016).abs() < 1e-15));
    let nan = ThinParameters { focus_distance_m: f64::NAN, ..base };
    assert!(matches!(refused(nan), OpticsError::FocusTooNear { .. }));
    let fast = ThinParameters { f_number: 0.0, ..base };
    assert!(matches!(refused(fast), OpticsError::NotPositive { name: "f_number", .. }));
    let faster = ThinParameters { f_number: 0.499, ..base };
    assert!(matches!(refused(faster), OpticsError::Faster { .. }));
    let bright = ThinParameters { transmittance: 1.1, ..base };
    assert!(matches!(refused(bright), OpticsError::Transmittance { .. }));
    let aperture = Some(ClippingAperture { position_mm: -10.0, radius_mm: 3.0 });
    let narrow = Thick::new(ThickParameters { front_aperture: aperture, ..thick_parameters() })
        .expect_err("the rim is the stop");
    assert!(matches!(narrow, OpticsError::RimIsStop { rim: "front_aperture", .. }), "{narrow}");
    let aperture = Some(ClippingAperture { position_mm: 25.0, radius_mm: 30.0 });
    let behind =
        Thick::new(ThickParameters { rear_aperture: aperture, ..thick_parameters() }).expect_err("behind the sensor");
    assert!(matches!(behind, OpticsError::RimMisplaced { plane: "sensor", .. }), "{behind}");
}

#[test]
fn a_fold_inside_the_image_is_refused() {
    let fold = RadialDistortion::new(DistortionDirection::ObservedToIdeal, -3.0, 0.0, 16.0).expect("legal");
    let raster = Raster::centred(1000, 1000, 0.01).expect("legal");
    assert!(matches!(
        thin(1.0).with_distortion(fold).expect("a paraxial lens").check(&raster),
        Err(OpticsError::Distortion(_))
    ));
    assert!(thin(1.0).check(&raster).is_ok());
    let beyond = DVec2::new(6.0, 0.0);
    let lens = thin(1.0).with_distortion(fold).expect("a paraxial lens");
    assert!(lens.ray(beyond, DVec2::splat(0.5), 550.0).is_none() && lens.projected_solid_angle_sr(beyond) == 0.0);
}

#[test]
fn blur_is_where_the_edge_rays_land() {
    for lens in [thin(0.6), Lens::Thick(thick())] {
        for depth_m in [0.3, 0.5, 0.7, 5.0] {
            // A point of the axis at this depth lights the sensor points whose ray through the pupil's edge meets it.
            let radius_mm = 0.5 * lens.circle_of_confusion_mm(depth_m);
            let edges = [DVec2::new(0.0, 0.5), DVec2::new(1.0, 0.5)];
            let near = edges.map(|pupil| {
                let ray = lens.ray(DVec2::new(radius_mm, 0.0), pupil, 550.0).expect("open");
                at_depth(&ray, depth_m).truncate().length()
            });
            // The entrance pupil's scaling off the axis is 1 + O((0.4/16)²) at most.
            assert!(near[0].min(near[1]) < 1e-3 * lens.entrance_pupil_radius_m(), "{depth_m} m: {near:?}");
        }
    }
}

#[test]
fn at_the_hyperfocal_distance_infinity_blurs_to_the_circle() {
    let focus_m = thin(1.0).hyperfocal_m(0.005);
    let lens = thin(focus_m);
    assert!((focus_m - (0.016 + 0.016 * 0.016 / (2.0 * 0.005e-3))).abs() < 1e-12);
    assert!((lens.circle_of_confusion_mm(f64::INFINITY) - 0.005).abs() < 1e-15);
    assert!((lens.circle_of_confusion_mm(focus_m / 2.0) - 0.005).abs() < 1e-15);
    assert_eq!(lens.circle_of_confusion_mm(focus_m), 0.0);
    assert_eq!((pinhole().circle_of_confusion_mm(1.0), pinhole().hyperfocal_m(0.005)), (0.0, 0.0));
}

#[test]
fn the_field_of_view_is_the_textbook_s() {
    let (left, right) = (DVec2::new(-8.0, 0.0), DVec2::new(8.0, 0.0));
    let angle = pinhole().angle_between_rad(left, right).expect("inside");
    assert!((angle - 2.0 * etendue_core::maths::f64::atan(0.5)).abs() < 1e-15);
}

#[test]
fn a_clipped_chief_ray_is_none_where_light_may_still_come() {
    let front_aperture = Some(ClippingAperture { position_mm: -40.0, radius_mm: 4.5 });
    let lens = Lens::thick(ThickParameters { front_aperture, ..thick_parameters() }).expect("legal");
    let at = DVec2::new(2.1, 0.0);
    assert!(lens.principal_ray(at).is_none());
    assert!(lens.projected_solid_angle_sr(at) > 0.0);
    // To look right through an aperture in front, a ray must start on the left.
    let truth = lens.truth_ray(at).expect("light comes");
    assert!(truth.off_centre && truth.ray.origin_m.x < 0.0 && truth.ray.weight_sr > 0.0, "{truth:?}");
    assert!(!lens.truth_ray(DVec2::ZERO).expect("open").off_centre);
    assert!(lens.project(DVec3::Z).is_some());
}

proptest! {
    #[test]
    fn project_inverts_the_principal_ray(x in -6.0..6.0f64, y in -6.0..6.0f64, k1 in -0.2..0.2f64, k2 in -0.05..0.05f64, forward: bool) {
        let sense = if forward { DistortionDirection::IdealToObserved } else { DistortionDirection::ObservedToIdeal };
        let distortion = RadialDistortion::new(sense, k1, k2, 16.0).expect("legal");
        for lens in [pinhole(), thin(0.6), Lens::Thick(thick())] {
            let lens = lens.with_distortion(distortion).expect("a paraxial lens");
            let p = DVec2::new(x, y);
            let back = lens.project(lens.principal_ray(p).expect("open").direction).expect("in view");
            // 1e-9 px of a 2 µm pixel.
            prop_assert!((back - p).length() < 2e-12);
        }
    }
}
