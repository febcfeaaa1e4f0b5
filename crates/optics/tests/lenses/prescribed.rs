//! Prescriptions as a camera lens: the contract of all lenses.

use core::f64::consts::PI;
use etendue_optics::prescription::coating::Coating;
use etendue_optics::prescription::coating::InterferenceFilter;
use etendue_optics::prescription::surface::Surface;
use etendue_optics::prescription::trace::LensRay;
use etendue_optics::prescription::{Focus, published};
use etendue_optics::{Lens, Prescription, PrescriptionLens, PrescriptionParameters};
use etendue_spectra::glass::{Dispersion, LINE_C_NM, LINE_F_NM};
use etendue_spectra::{Extrapolation, Spectrum};
use glam::{DVec2, DVec3};

/// The published lenses with the image radius of each, mm.
const LENSES: [(&str, f64); 4] = [("double-gauss", 21.6), ("wide-angle", 19.2), ("fisheye", 12.75), ("telephoto", 6.3)];

fn focused(surfaces: Vec<Surface>, focus: Focus) -> Prescription {
    let parameters = PrescriptionParameters::new(surfaces, focus);
    Prescription::new(parameters).expect("a lens")
}

const FAR: Focus = Focus::Sensor { distance_m: f64::INFINITY };

fn published(name: &str, radius_mm: f64) -> Lens {
    let surfaces = published::named(name).expect("a published lens").surfaces();
    Lens::prescription(PrescriptionLens::new(focused(surfaces, FAR), None, radius_mm).expect("lit"))
}

/// Low-discrepancy points of the unit square (the generalised golden ratio).
fn points(count: u32) -> impl Iterator<Item = DVec2> {
    let step = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
    (0..count).map(move |i| (step * f64::from(i) + 0.5).fract())
}

/// A lossless singlet, stopped down until first order is sufficient.
fn stopped_singlet(focus: Focus) -> Lens {
    let clear = |surface: Surface| Surface { coating: Coating::Constant(1.0), ..surface };
    let glass = Dispersion::Constant { n: 1.5 };
    let surfaces = vec![
        Surface::stop(1.0, 0.2),
        clear(Surface::sphere(50.0, 4.0, glass, 8.0)),
        clear(Surface::sphere(-50.0, 0.0, Dispersion::AIR, 8.0)),
    ];
    Lens::prescription(PrescriptionLens::new(focused(surfaces, focus), None, 5.0).expect("lit"))
}

#[test]
fn few_proposals_fail_and_the_mean_weight_is_the_etendue() {
    for (name, radius_mm) in LENSES {
        let lens = published(name, radius_mm);
        let (mut failed, mut all) = (0.0, 0.0);
        for ring in 0..8 {
            // Rings of equal area; the mean over rings is the mean over the image circle.
            let s_mm = radius_mm * ((f64::from(ring) + 0.5) / 8.0).sqrt();
            let sensor_mm = DVec2::new(0.6, -0.8) * s_mm;
            let mut mean_sr = 0.0;
            for (i, pupil) in points(4000).enumerate() {
                let nm = 400.0 + 300.0 * (0.618_033_988_749_895 * i as f64).fract();
                all += 1.0;
                failed += f64::from(u8::from(lens.ray(sensor_mm, pupil, nm).is_none()));
                mean_sr += lens.ray(sensor_mm, pupil, 587.56).map_or(0.0, |ray| ray.weight_sr) / 4000.0;
            }
            // Quasi-random points: the fraction of the region's edge that they miscount, about 1/√4000^(3/2) of a few.
            let projected_solid_angle_sr = lens.projected_solid_angle_sr(sensor_mm);
            assert!(
                (mean_sr / projected_solid_angle_sr - 1.0).abs() < 6e-3,
                "{name} {s_mm}: {mean_sr} {projected_solid_angle_sr}"
            );
        }
        let fraction = failed / all;
        assert!(fraction < 0.05, "{name}: {fraction} of the proposals fail");
    }
}

#[test]
fn no_light_is_lost_outside_the_region() {
    // Every passing ray of a brute-force search must be near one that the samples find: the light of all slopes equals the light of the region.
    for (name, radius_mm) in LENSES {
        let lens = published(name, radius_mm);
        let Lens::Prescription(prescribed) = &lens else { panic!("a prescription") };
        let sensor_z = prescribed.prescription().sensor_position_mm();
        for (height, nm) in [(0.03, 430.0), (0.37, 1050.0), (0.71, 320.0), (0.983, 650.0)] {
            let s_mm = height * radius_mm;
            let (mut brute_sr, mut sampled_sr) = (0.0, 0.0);
            const SIDE: u32 = 300;
            let reach = 1.6;
            for point in points(SIDE * SIDE) {
                let t = (point * 2.0 - 1.0) * reach;
                let direction = DVec3::new(t.x, t.y, -1.0).normalize();
                let ray = LensRay { point: DVec3::new(s_mm, 0.0, sensor_z), direction };
                let Ok((_, through)) = prescribed.prescription().to_scene(ray, nm) else { continue };
                let cosine2 = direction.z * direction.z;
                brute_sr += through * cosine2 * cosine2 * 4.0 * reach * reach / f64::from(SIDE * SIDE);
            }
            for pupil in points(20_000) {
                let ray = lens.ray(DVec2::new(-s_mm, 0.0), pupil, nm);
                sampled_sr += ray.map_or(0.0, |ray| ray.weight_sr) / 20_000.0;
            }
            // The brute-force search has few hits (some hundreds if the pupil is small): 3 % is three of its deviations.
            let hits = brute_sr / (4.0 * reach * reach) * f64::from(SIDE * SIDE);
            let tolerance = 0.004 + 1.5 / hits.sqrt();
            assert!(
                (sampled_sr / brute_sr - 1.0).abs() < tolerance,
                "{name} {s_mm} {nm}: {sampled_sr} {brute_sr} ({hits})"
            );
        }
    }
}

#[test]
fn principal_rays_cross_the_middle_of_the_stop_and_project_inverts_them() {
    for (name, radius_mm) in LENSES {
        let lens = published(name, radius_mm);
        let Lens::Prescription(prescribed) = &lens else { panic!("a prescription") };
        for i in 0..=20 {
            let (s, c) = etendue_core::maths::f64::sin_cos(f64::from(i));
            let sensor_mm = DVec2::new(c, s) * (radius_mm * f64::from(i) / 20.0);
            let direction = lens.direction(sensor_mm).expect("a principal ray");
            let back = lens.project(direction * 3.0).expect("seen");
            assert!((back - sensor_mm).length() < 1e-9, "{name} {sensor_mm} {back}");
            let Some(ray) = lens.principal_ray(sensor_mm) else { continue };
            assert!(ray.direction.cross(direction).length() < 1e-12 && ray.origin_m.dot(ray.direction).abs() < 1e-12);
            // Back into the lens from the scene, and on to the sensor.
            let p = prescribed.prescription();
            let z_mm = |z_m: f64| p.paraxial().entrance_pupil_position_mm - z_m * 1e3;
            let from = ray.origin_m + ray.direction * 0.5;
            let into = LensRay {
                point: DVec3::new(from.x * 1e3, from.y * 1e3, z_mm(from.z)),
                direction: DVec3::new(-ray.direction.x, -ray.direction.y, ray.direction.z),
            };
            let (out, _) = p.to_sensor(into, 587.56).expect("back through the lens");
            let at = out.point + out.direction * ((p.sensor_position_mm() - out.point.z) / out.direction.z);
            assert!((at.truncate() + sensor_mm).length() < 1e-9, "{name}: {at} {sensor_mm}");
            let stop = p.at_stop(LensRay { point: at, direction: -out.direction }, 587.56).expect("the stop");
            assert!(stop.truncate().length() < 1e-8, "{name}: {stop}");
        }
    }
}

#[test]
fn stopped_down_it_is_the_lens_of_first_order() {
    for distance_m in [f64::INFINITY, 0.4] {
        let lens = stopped_singlet(Focus::Sensor { distance_m });
        // E = π τ/4N²(1 − m/m_p)², by the working f-number; 0.2 mm of 49 mm is f/123, so the disc's own (1 + 1/4N²) is 2e-5.
        let exact = PI / (4.0 * lens.working_f_number() * lens.working_f_number());
        assert!(
            (lens.projected_solid_angle_sr(DVec2::ZERO) / exact - 1.0).abs() < 5e-5,
            "{} {exact}",
            lens.projected_solid_angle_sr(DVec2::ZERO)
        );
        // Near the axis a tangent t is imaged at c t.
        let tangent = lens.tangent(DVec2::new(0.01, -0.02)).expect("inside") * lens.principal_distance_mm();
        assert!((tangent - DVec2::new(0.01, -0.02)).length() < 1e-7, "{tangent}");
        // All rays of a point meet in the plane in focus, except for spherical aberration, which grows with the cube of the aperture.
        let plane_m = if distance_m.is_finite() { distance_m } else { 1e9 };
        let sensor_mm = DVec2::new(0.1, 0.05);
        let principal = lens.principal_ray(sensor_mm).expect("inside");
        let at =
            |ray: etendue_core::PupilRay| ray.origin_m + ray.direction * ((plane_m - ray.origin_m.z) / ray.direction.z);
        for pupil in points(50) {
            let ray = lens.ray(sensor_mm, pupil, 587.56).expect("open");
            let miss = (at(ray) - at(principal)).length() / plane_m;
            assert!(miss < 2e-7, "{distance_m}: {miss}");
        }
    }
}

#[test]
fn light_obeys_the_sine_condition_that_the_double_gauss_is_corrected_for() {
    let surfaces = published::named("double-gauss").expect("a published lens").surfaces();
    let clear = surfaces.into_iter().map(|s| Surface { coating: Coating::Constant(1.0), ..s }).collect();
    let lens = Lens::prescription(PrescriptionLens::new(focused(clear, FAR), None, 21.6).expect("lit"));
    let n = lens.f_number();
    let (sine, disc) = (PI / (4.0 * n * n), PI / (1.0 + 4.0 * n * n));
    let e = lens.projected_solid_angle_sr(DVec2::ZERO);
    // Its remaining coma and spherical aberration move the marginal ray by 1 %; the two conventions differ by 6 %.
    assert!((e / sine - 1.0).abs() < 0.015 && (e / disc - 1.0).abs() > 0.04, "{e} {sine} {disc}");
    assert!(lens.disperses() && lens.transmittance() == 1.0);
}

#[test]
fn clipped_principal_rays_give_way_to_the_middle_of_what_is_open() {
    let lens = published("telephoto", 11.0);
    let clipped = DVec2::new(0.0, 8.0);
    assert!(lens.principal_ray(clipped).is_none() && lens.projected_solid_angle_sr(clipped) > 0.0);
    let truth = lens.truth_ray(clipped).expect("light arrives");
    assert!(truth.off_centre && truth.ray.direction.y > 0.0);
    assert!(
        lens.truth_ray(DVec2::new(0.0, 11.5)).is_none() && lens.projected_solid_angle_sr(DVec2::new(11.5, 0.0)) == 0.0
    );
}

#[test]
fn a_prescription_keeps_its_own_distortion() {
    let lens = published("telephoto", 6.3);
    let own = etendue_projection::RadialDistortion::new(
        etendue_projection::DistortionDirection::IdealToObserved,
        0.1,
        0.0,
        1.0,
    );
    let message = lens.with_distortion(own.expect("legal")).expect_err("refused").to_string();
    assert!(message.contains("have their own distortion"), "{message}");
}

#[test]
fn the_report_obeys_third_order_theory() {
    let lens = stopped_singlet(FAR);
    let Lens::Prescription(prescribed) = &lens else { panic!("a prescription") };
    let report = prescribed.report(6);
    let field = report.fields[1].image.as_ref().expect("an image");
    let height_mm = report.fields[1].height_mm;
    // Third order: the tangential focus is three times as far from the Petzval surface as the sagittal focus, so p = (3 s − t)/2.
    let petzval_mm = height_mm * height_mm / (2.0 * report.first_order.petzval_radius_mm);
    let sagitta = 0.5 * (3.0 * field.sagittal_mm - field.tangential_mm);
    // At 1 mm of 49 mm the next order is some 1e-3.
    assert!((sagitta / petzval_mm - 1.0).abs() < 5e-3, "{sagitta} {petzval_mm}");
    // The spot lies about the principal ray, to 0.1 µm.
    let spot = field.spot.expect("lit");
    assert!(spot.rms_mm < spot.radius_mm && (spot.centroid_mm - height_mm).abs() < 1e-4);
    assert_eq!(report.axial_colour_f_mm, 0.0, "a glass of one index");
    assert!((report.fields[0].relative_illumination - 1.0).abs() < 1e-12);
}

#[test]
fn axial_colour_of_a_thin_lens_is_that_of_its_power() {
    let glass = Dispersion::from_abbe(1.5, 50.0).expect("a glass");
    let surfaces = vec![
        Surface::stop(0.01, 3.0),
        Surface::sphere(100.0, 0.2, glass, 4.0),
        Surface::sphere(-100.0, 0.0, Dispersion::AIR, 4.0),
    ];
    let report = PrescriptionLens::new(focused(surfaces, FAR), None, 1.0).expect("lit").report(2);
    let longitudinal_mm = report.axial_colour_c_mm - report.axial_colour_f_mm;
    // f is proportional to 1/(n − 1) for a lens of zero thickness: 0.2 mm of 100 mm change it by 1e-3.
    let power = |nm: f64| glass.index(nm) - 1.0;
    let (c, f) = (power(LINE_C_NM), power(LINE_F_NM));
    let exact = report.first_order.focal_length_mm * power(587.56) * (1.0 / c - 1.0 / f);
    assert!((longitudinal_mm / exact - 1.0).abs() < 2e-3, "{longitudinal_mm} {exact}");
}

#[test]
fn an_ir_cut_darkens_its_edge_towards_the_image_s_corner() {
    let table = [(300.0, 1.0), (640.0, 1.0), (660.0, 0.0), (1100.0, 0.0)];
    let edge = Spectrum::from_points(&table, Extrapolation::Hold).expect("a table");
    let filter = InterferenceFilter::new(edge, 1.8).expect("a filter");
    let surfaces = published::named("double-gauss").expect("a published lens").surfaces();
    let bare = Lens::prescription(PrescriptionLens::new(focused(surfaces.clone(), FAR), None, 21.6).expect("lit"));
    let cut =
        Lens::prescription(PrescriptionLens::new(focused(surfaces, FAR), Some(filter.clone()), 21.6).expect("lit"));
    for s_mm in [0.0, 12.0, 20.0] {
        for pupil in points(40) {
            let sensor_mm = DVec2::new(0.0, s_mm);
            let at = |lens: &Lens, nm: f64| lens.ray(sensor_mm, pupil, nm);
            let (Some(a), Some(b)) = (at(&bare, 645.0), at(&cut, 645.0)) else { continue };
            // The same ray; its weight is multiplied by the filter's transmittance at the angle of arrival, within the edge's 20 nm.
            let fraction = b.weight_sr / a.weight_sr;
            assert!(a.direction == b.direction && fraction <= filter.transmittance(645.0, 1.0) + 1e-6, "{fraction}");
            let open = [(500.0, 1.0), (700.0, 0.0)];
            for (nm, expected) in open {
                let (Some(a), Some(b)) = (at(&bare, nm), at(&cut, nm)) else { continue };
                assert!((b.weight_sr - expected * a.weight_sr).abs() < 1e-12 * a.weight_sr);
            }
        }
    }
    let mean = |s_mm: f64| {
        let sum = |lens: &Lens| -> f64 {
            points(500).filter_map(|u| lens.ray(DVec2::new(s_mm, 0.0), u, 635.0)).map(|ray| ray.weight_sr).sum()
        };
        sum(&cut) / sum(&bare)
    };
    assert!(mean(20.0) < 0.9 && mean(0.0) > mean(20.0) + 0.05, "{} {}", mean(0.0), mean(20.0));
}
