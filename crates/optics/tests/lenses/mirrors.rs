//! Lenses with mirrors and central obscurations, against closed forms. Comparison with other programs: tests/physics/mirrors.rs.

use core::f64::consts::PI;

use etendue_core::maths::f64::{atan, sin};
use etendue_optics::prescription::coating::Coating;
use etendue_optics::prescription::ghost::GhostPair;
use etendue_optics::prescription::surface::{Surface, SurfaceKind};
use etendue_optics::prescription::trace::{LensRay, RayLossReason};
use etendue_optics::prescription::{Focus, PrescriptionError};
use etendue_optics::{Lens, Prescription, PrescriptionLens, PrescriptionParameters};
use etendue_spectra::glass::Dispersion;
use glam::{DVec2, DVec3};

const AIR: Dispersion = Dispersion::AIR;
const GLASS: Dispersion = Dispersion::Constant { n: 1.5 };
const FAR: Focus = Focus::Sensor { distance_m: f64::INFINITY };

fn focused(surfaces: Vec<Surface>, focus: Focus) -> Result<Prescription, PrescriptionError> {
    Prescription::new(PrescriptionParameters::new(surfaces, focus))
}

fn far(surfaces: Vec<Surface>) -> Prescription {
    focused(surfaces, FAR).expect("a lens")
}

fn lens(prescription: Prescription, picture_mm: f64) -> Lens {
    Lens::prescription(PrescriptionLens::new(prescription, None, picture_mm).expect("lit"))
}

/// A paraboloid of focal length 200 mm and radius 25 mm, the stop: f/4.
fn paraboloid() -> Vec<Surface> {
    vec![Surface { conic: -1.0, stop: true, ..Surface::mirror(-400.0, 0.0, 25.0) }]
}

/// A Cassegrain of a paraboloid and a hyperboloid: 150 mm between mirrors of focal length 200 and −100 mm.
fn cassegrain(hole_mm: f64) -> Vec<Surface> {
    // The secondary images the focus 50 mm behind it to 100 mm: k = −((m + 1)/(m − 1))² with m = 2.
    let primary =
        Surface { conic: -1.0, stop: true, obscured_radius_mm: hole_mm, ..Surface::mirror(-400.0, 150.0, 25.0) };
    vec![primary, Surface { conic: -9.0, ..Surface::mirror(200.0, 0.0, 9.0) }]
}

/// A Gregorian of a paraboloid and an ellipsoid: foci 100 mm and 600 mm from the secondary.
fn gregorian() -> Vec<Surface> {
    let primary = Surface { conic: -1.0, stop: true, ..Surface::mirror(-800.0, 500.0, 100.0) };
    let secondary = Surface { conic: -25.0 / 49.0, ..Surface::mirror(-1200.0 / 7.0, 0.0, 30.0) };
    vec![primary, secondary]
}

/// A Mangin mirror of 5 mm of glass.
fn mangin() -> Vec<Surface> {
    vec![
        Surface { stop: true, ..Surface::sphere(-300.0, 5.0, GLASS, 20.0) },
        Surface::mirror(-420.0, 5.0, 20.0),
        Surface::sphere(300.0, 0.0, AIR, 20.0),
    ]
}

fn parallel(height_mm: f64) -> LensRay {
    LensRay { point: DVec3::new(height_mm, 0.0, -10.0), direction: DVec3::Z }
}

/// Point at which a ray of light meets the sensor, mm.
fn landing(lens: &Prescription, ray: LensRay) -> DVec2 {
    let (out, _) = lens.to_sensor(ray, 550.0).expect("passes");
    (out.point + out.direction * ((lens.sensor_position_mm() - out.point.z) / out.direction.z)).truncate()
}

#[test]
fn conics_that_share_a_focus_have_no_spherical_aberration() {
    for (surfaces, focal_mm, back_mm, f_number) in
        [(paraboloid(), 200.0, 200.0, 4.0), (cassegrain(0.0), 400.0, 100.0, 8.0), (gregorian(), -2400.0, 600.0, 12.0)]
    {
        let rim_mm = surfaces[0].semi_aperture_mm;
        let lens = far(surfaces);
        let p = lens.paraxial();
        // Rounding of lengths up to 2400 mm.
        assert!((p.focal_length_mm - focal_mm).abs() < 1e-9 && (p.back_focus_mm - back_mm).abs() < 1e-9, "{p:?}");
        assert!((p.f_number() - f_number).abs() < 1e-12);
        for part in [0.1, 0.5, 1.0] {
            assert!(landing(&lens, parallel(part * rim_mm)).length() < 1e-9, "{focal_mm} at {part}");
        }
    }
}

#[test]
fn rays_run_back_the_way_they_came() {
    for surfaces in [paraboloid(), cassegrain(0.0), gregorian(), mangin()] {
        let lens = far(surfaces);
        for (x, slope) in [(0.3, 0.0), (11.0, 0.01), (-17.0, -0.02)] {
            let ray = LensRay {
                point: DVec3::new(x, 2.0, -10.0),
                direction: DVec3::new(slope, 0.3 * slope, 1.0).normalize(),
            };
            let Ok((out, there)) = lens.to_sensor(ray, 550.0) else { continue };
            let (back, again) = lens.to_scene(LensRay { direction: -out.direction, ..out }, 550.0).expect("passes");
            let at = back.point + back.direction * ((ray.point.z - back.point.z) / back.direction.z);
            assert!((at - ray.point).length() < 1e-9 && (back.direction + ray.direction).length() < 1e-12, "{at}");
            assert!((there - again).abs() < 1e-14);
        }
    }
}

#[test]
fn an_obscured_pupil_collects_the_light_of_its_ring() {
    for hole_mm in [0.0, 2.0, 10.0, 20.0] {
        let mut surfaces = paraboloid();
        surfaces[0].obscured_radius_mm = hole_mm;
        let prescription = far(surfaces);
        assert!((prescription.axial_obscured_ratio() - hole_mm / 25.0).abs() < 1e-12);
        let lens = lens(prescription, 2.0);
        assert!((lens.f_number() - 4.0).abs() < 1e-12 && (lens.obscured_ratio() - hole_mm / 25.0).abs() < 1e-12);
        // A paraboloid sends the ray at the height r to its focus at the angle 2 atan(r/2f); ∫ cos θ dω is π sin² θ.
        let edge = |r: f64| sin(2.0 * atan(r / 400.0));
        let exact = PI * (edge(25.0) * edge(25.0) - edge(hole_mm) * edge(hole_mm));
        let actual = lens.projected_solid_angle_sr(DVec2::ZERO);
        assert!((actual / exact - 1.0).abs() < 1e-9, "{hole_mm}: {actual} for {exact}");
        // The mean weight of samples on a lattice of 512 × 512 points, which lie on 256 circles: each edge is uncertain by half a circle's share.
        let side = 512;
        let point = |i: usize| DVec2::new((i % side) as f64 + 0.5, (i / side) as f64 + 0.5) / side as f64;
        let weights = (0..side * side).filter_map(|i| lens.ray(DVec2::ZERO, point(i), 550.0)).map(|ray| ray.weight_sr);
        let mean = weights.sum::<f64>() / (side * side) as f64;
        let uncertain = 1.01 / (256.0 * (1.0 - hole_mm / 25.0));
        assert!((mean / exact - 1.0).abs() < uncertain, "{hole_mm}: {mean} for {exact}");
        // Off the axis the ring is the same but for the cosines, (cos 0.57°)⁴.
        let off = lens.projected_solid_angle_sr(DVec2::new(2.0, 0.0));
        assert!((off / actual - 1.0).abs() < 1e-3, "{hole_mm}: {off}");
    }
}

#[test]
fn a_blocked_chief_ray_is_still_the_principal_ray() {
    for (surfaces, focal_mm) in [(cassegrain(8.0), 400.0), (paraboloid(), 200.0), (gregorian(), 2400.0)] {
        let lens = lens(far(surfaces), 1.0);
        for at in [DVec2::ZERO, DVec2::new(0.6, 0.0), DVec2::new(-0.3, 0.5)] {
            let truth = lens.truth_ray(at).expect("a principal ray");
            assert!(!truth.off_centre && truth.ray.weight_sr > 0.0);
            // The image shows the scene upright, whatever the number of mirrors and of intermediate images. The stop is the first surface, so the
            // chief ray has the tangent r/c, with distortion of the order of its square, (1/200)².
            let tangent = truth.ray.direction.truncate() / truth.ray.direction.z;
            assert!((tangent * focal_mm - at).length() < 1e-4, "{focal_mm} at {at}: {tangent}");
            let back = lens.project(truth.ray.direction).expect("inside the field");
            assert!((back - at).length() < 1e-9, "{back} for {at}");
        }
    }
    let blocked = far(cassegrain(8.0)).to_sensor(parallel(5.0), 550.0).expect_err("inside the hole");
    assert_eq!((blocked.surface, blocked.loss), (0, RayLossReason::Obscured));
}

#[test]
fn the_focal_surface_of_a_spherical_mirror_is_concentric_with_it() {
    // The stop is at the centre of curvature, so all fields are alike: their foci lie half a radius from it, and h²/2f behind the plane.
    let stop = Surface { thickness_mm: 400.0, ..Surface::stop(0.0, 2.0) };
    let prescription = far(vec![stop, Surface::mirror(-400.0, 0.0, 60.0)]);
    assert!((prescription.paraxial().petzval_radius_mm - 200.0).abs() < 1e-9);
    let lens = PrescriptionLens::new(prescription, None, 10.0).expect("lit");
    let image = lens.report(2).fields[1].image.clone().expect("an image");
    let sagitta = 200.0 - (200.0_f64 * 200.0 - 10.0 * 10.0).sqrt();
    // The focus on the chief ray against that at the height of 10 mm: the next order, sagitta · (h/f)².
    for focus_mm in [image.tangential_mm, image.sagittal_mm] {
        assert!((focus_mm / sagitta - 1.0).abs() < 1e-2, "{focus_mm} for {sagitta}");
    }
}

#[test]
fn a_number_as_the_coating_of_a_mirror_is_its_reflectance() {
    let coated = |coating: Coating| cassegrain(4.0).into_iter().map(|s| Surface { coating, ..s }).collect();
    let aluminium = far(coated(Coating::Constant(0.88)));
    assert!((aluminium.axial_transmittance(550.0) - 0.88 * 0.88).abs() < 1e-15);
    assert_eq!(far(cassegrain(4.0)).axial_transmittance(550.0), 1.0);
    let layered = focused(coated(Coating::QuarterWave { design_nm: 550.0 }), FAR).expect_err("no layer");
    assert_eq!(layered.surface(), Some(1));
}

#[test]
fn ghosts_pass_mirrors_and_are_not_made_by_them() {
    let lens = far(mangin());
    let pair = GhostPair { front: 0, rear: 2 };
    assert_eq!(lens.ghost_pairs(false), [pair]);
    let first = lens.ghost_first_order(pair, 550.0);
    let height_mm = 1e-3;
    let ghost = lens.ghost(pair, parallel(height_mm), 550.0).expect("passes");
    let d = ghost.ray.direction;
    let at = ghost.ray.point + d * ((lens.sensor_position_mm() - ghost.ray.point.z) / d.z);
    // Third order in the height: (1e-3/300)².
    assert!((at.x / (first.spread * height_mm) - 1.0).abs() < 1e-8, "{} for {}", at.x, first.spread * height_mm);
    // Two reflections at glass against air, 0.04 each, and two crossings.
    assert!((ghost.weight - 0.04 * 0.04 * 0.96 * 0.96).abs() < 1e-9, "{}", ghost.weight);
}

#[test]
fn a_focusing_mirror_moves_both_spaces_beside_it() {
    let focus = Focus::Group { distance_m: 50.0, first: 1, last: 1 };
    let near = focused(cassegrain(0.0), focus).expect("focused");
    let moved_mm = near.surfaces()[0].thickness_mm - 150.0;
    let back_mm = near.sensor_position_mm() - near.last_vertex_mm();
    // The sensor stays behind the primary: the secondary moves away from both.
    assert!(moved_mm > 0.0 && (back_mm - 100.0 - moved_mm).abs() < 1e-9, "{moved_mm} {back_mm}");
    // The primary images 50 m to s₁ behind itself, the secondary that to the sensor.
    let first_mm = 1.0 / (1.0 / 200.0 - 1.0 / 50_000.0);
    let second_mm = 1.0 / (1.0 / (first_mm - 150.0 - moved_mm) - 1.0 / 100.0);
    assert!((second_mm - back_mm).abs() < 1e-6, "{second_mm} for {back_mm}");
}

#[test]
fn a_thin_lens_images_every_plane_without_aberrations() {
    let kind = SurfaceKind::ThinLens { focal_length_mm: 50.0 };
    let surface = Surface { kind, stop: true, ..Surface::sphere(f64::INFINITY, 0.0, AIR, 10.0) };
    let lens = far(vec![surface]);
    assert!((lens.paraxial().focal_length_mm - 50.0).abs() < 1e-12 && (lens.paraxial().f_number() - 2.5).abs() < 1e-12);
    for tangent in [0.0, 0.2, -0.6] {
        let direction = DVec3::new(tangent, 0.0, 1.0).normalize();
        for x in [-9.0, 0.0, 8.0] {
            let at = landing(&lens, LensRay { point: DVec3::new(x, 1.0, 0.0), direction });
            assert!((at - DVec2::new(50.0 * tangent, 0.0)).length() < 1e-12, "{at}");
        }
    }
    let near = focused(vec![surface], Focus::Sensor { distance_m: 0.15 }).expect("a lens");
    let point = DVec3::new(12.0, 0.0, -150.0);
    for to in [DVec3::new(9.0, 0.0, 0.0), DVec3::new(0.0, -7.0, 0.0)] {
        let at = landing(&near, LensRay { point, direction: (to - point).normalize() });
        // 1/150 + 1/75 = 1/50: half the size, inverted.
        assert!((at - DVec2::new(-6.0, 0.0)).length() < 1e-12, "{at}");
    }
}

#[test]
fn what_leaves_no_light_is_refused() {
    let mut wide = paraboloid();
    wide[0].obscured_radius_mm = 25.0;
    assert_eq!(focused(wide, FAR).expect_err("nothing open").surface(), Some(1));
    let disc =
        Surface { thickness_mm: 150.0, obscured_radius_mm: 26.0, ..Surface::sphere(f64::INFINITY, 0.0, AIR, 40.0) };
    let blocked = focused([vec![disc], paraboloid()].concat(), FAR).expect_err("dark");
    assert_eq!(blocked, PrescriptionError::Blocked { surface: 1 });
    // A lone diverging lens has a negative focal length too, but no real image.
    let diverging = vec![Surface { stop: true, ..Surface::mirror(100.0, 0.0, 5.0) }];
    assert!(matches!(focused(diverging, FAR), Err(PrescriptionError::NoImage { .. })));
}
