//! Mirrors in front of the lens, compared with closed forms.

use core::f64::consts::PI;
use etendue_core::maths::f64::{acos, atan2, sin, sin_cos};
use etendue_optics::front::{
    Curve, Front, FrontError, FrontRay, Mirror, MirrorParameters, MirrorShape, Optic, Placement, Quadric, QuadricKind,
    Reflectance,
};
use etendue_optics::{Lens, PinholeParameters, TelecentricParameters};
use etendue_projection::Raster;
use glam::{DVec2, DVec3};

const FOCAL_MM: f64 = 10.0;
const PARABOLOID: QuadricKind = QuadricKind::Conic { radius_mm: 40.0, conic: -1.0 };
const HYPERBOLOID: QuadricKind = QuadricKind::Conic { radius_mm: 20.0, conic: -2.25 };
const SPHERE: QuadricKind = QuadricKind::Conic { radius_mm: 30.0, conic: 0.0 };

fn front(kind: QuadricKind, placement: Placement, rim_mm: f64, hole_mm: f64) -> Front {
    let shape = MirrorShape::Quadric(Quadric::new(kind, rim_mm, hole_mm).expect("a legal mirror"));
    let reflectance = Reflectance::Fraction(Curve::Constant(0.8));
    let mirror = Mirror::new(MirrorParameters { shape, placement, reflectance }).expect("a legal mirror");
    Front::new(None, Some(Optic::Mirror(Box::new(mirror)))).expect("a mirror")
}

fn on_axis(distance_mm: f64) -> Placement {
    Placement::with_rotation_deg(DVec3::new(0.0, 0.0, distance_mm), [0.0; 3])
}

fn pinhole() -> Lens {
    let parameters = PinholeParameters { focal_length_mm: FOCAL_MM, f_number: 4.0, transmittance: 1.0 };
    Lens::pinhole(parameters).expect("a lens")
}

fn telecentric() -> Lens {
    let parameters = TelecentricParameters { metres_per_mm: 0.01, f_number: 4.0, transmittance: 1.0 };
    Lens::telecentric(parameters).expect("a lens")
}

fn raster() -> Raster {
    Raster::new(80, 80, DVec2::splat(0.1), DVec2::splat(40.0)).expect("a raster")
}

/// Sensor points over a disc, mm.
fn points(radius_mm: f64) -> impl Iterator<Item = DVec2> {
    (1..=60).map(move |i| {
        let (s, c) = sin_cos(2.4 * f64::from(i));
        DVec2::new(c, s) * (radius_mm * f64::from(i) / 60.0)
    })
}

fn front_ray(front: &Front, lens: &Lens, s_mm: DVec2) -> FrontRay {
    front.ray(lens, s_mm, DVec2::splat(0.5), 550.0).expect("a ray")
}

/// Distance of a point from a ray's line, m.
fn off(ray: &FrontRay, point_m: DVec3) -> f64 {
    (point_m - ray.ray.origin_m).cross(ray.ray.direction).length()
}

#[test]
fn a_hyperboloid_whose_outer_focus_is_the_pupil_has_one_viewpoint() {
    let quadric = Quadric::new(HYPERBOLOID, 35.0, 0.0).expect("a mirror");
    // e = 1.5: the outer focus at R/(e − 1) = 40 mm before the vertex, the inner at R/(e + 1) = 8 mm behind it.
    let distance_mm = quadric.outer_focus_mm().expect("a hyperboloid");
    assert!((distance_mm - 40.0).abs() < 1e-12);
    let (front, lens) = (front(HYPERBOLOID, on_axis(distance_mm), 35.0, 0.0), pinhole());
    let viewpoint_m = DVec3::new(0.0, 0.0, 0.048);
    for s_mm in points(4.0) {
        let ray = front_ray(&front, &lens, s_mm);
        assert!(ray.mirror_m.is_some() && off(&ray, viewpoint_m) < 1e-12, "{s_mm}: {}", off(&ray, viewpoint_m));
        // It leaves away from the viewpoint, and its weight is the lens's weight times the reflectance.
        assert!((ray.ray.origin_m - viewpoint_m).dot(ray.ray.direction) > 0.0);
        let bare = lens.ray(s_mm, DVec2::splat(0.5), 550.0).expect("a ray").weight_sr;
        assert!((ray.ray.weight_sr / bare - 0.8).abs() < 1e-15);
        assert!((ray.path_m - ray.ray.origin_m.length()).abs() < 1e-15, "from the pupil to the mirror");
    }
}

#[test]
fn a_paraboloid_under_parallel_rays_has_one_viewpoint() {
    let (front, lens) = (front(PARABOLOID, on_axis(100.0), 60.0, 0.0), telecentric());
    // The focus lies half the vertex's radius behind the vertex.
    let focus_m = DVec3::new(0.0, 0.0, 0.120);
    for s_mm in points(5.0) {
        let ray = front_ray(&front, &lens, s_mm);
        assert!(ray.mirror_m.is_some() && off(&ray, focus_m) < 1e-12);
    }
}

#[test]
fn a_sphere_reflects_where_alhazen_says() {
    // From the pupil at distance D of the centre of a sphere of radius R, the point of the sphere at angle φ from the line
    // between them is seen at angle ψ with tan ψ = R sin φ/(D − R cos φ); the ray leaves at 2φ + ψ from that line.
    let (distance_mm, radius_mm) = (70.0, 30.0);
    let (front, lens) = (front(SPHERE, on_axis(distance_mm - radius_mm), 30.0, 0.0), pinhole());
    for phi in [0.05, 0.3, 0.6, 1.0] {
        let (s, c) = sin_cos(phi);
        let psi = atan2(radius_mm * s, distance_mm - radius_mm * c);
        let tangent = sin(psi) / (1.0 - sin(psi) * sin(psi)).sqrt();
        let ray = front_ray(&front, &lens, DVec2::new(FOCAL_MM * tangent, 0.0));
        let point_m = DVec3::new(radius_mm * s, 0.0, distance_mm - radius_mm * c) * 1e-3;
        assert!((ray.mirror_m.expect("met") - point_m).length() < 1e-15);
        let left = acos(-ray.ray.direction.z);
        assert!((left - (2.0 * phi + psi)).abs() < 1e-12, "{left} against {}", 2.0 * phi + psi);
    }
}

#[test]
fn a_cone_reflects_as_the_plane_that_touches_it() {
    // At 45° a ray along the axis leaves perpendicular to it.
    let (front, lens) = (front(QuadricKind::Cone { half_angle_deg: 45.0 }, on_axis(50.0), 30.0, 0.0), telecentric());
    for s_mm in points(2.9) {
        let ray = front_ray(&front, &lens, s_mm);
        let outward = s_mm.normalize().extend(0.0);
        assert!((ray.ray.direction - outward).length() < 1e-14, "{}", ray.ray.direction);
    }
}

#[test]
fn rays_beside_the_mirror_and_through_its_hole_look_past() {
    let (front, lens) = (front(PARABOLOID, on_axis(100.0), 20.0, 5.0), telecentric());
    let hits_mirror = |x_mm: f64| front_ray(&front, &lens, DVec2::new(x_mm, 0.0)).mirror_m.is_some();
    assert!(!hits_mirror(0.0) && !hits_mirror(0.49) && hits_mirror(0.51) && hits_mirror(1.99) && !hits_mirror(2.01));
    let past = front_ray(&front, &lens, DVec2::new(2.5, 0.0));
    assert_eq!(past, FrontRay::without_front(lens.ray(DVec2::new(2.5, 0.0), DVec2::splat(0.5), 550.0).expect("a ray")));
}

#[test]
fn a_turned_mirror_turns_what_is_seen_by_twice_the_angle() {
    let placement = |degrees| Placement::with_rotation_deg(DVec3::new(0.0, 0.0, 100.0), [degrees, 0.0, 0.0]);
    let lens = pinhole();
    let axis = |degrees| front_ray(&front(SPHERE, placement(degrees), 29.0, 0.0), &lens, DVec2::ZERO).ray.direction;
    assert!((axis(0.0) + DVec3::Z).length() < 1e-15);
    // About its vertex: the normal there was −z and now is (0, sin 10°, −cos 10°).
    let (s, c) = sin_cos(20.0 * PI / 180.0);
    assert!((axis(10.0) - DVec3::new(0.0, s, -c)).length() < 1e-14, "{}", axis(10.0));
}

#[test]
fn what_cannot_be_seen_is_refused() {
    let check = |front: &Front| front.check(&pinhole(), &raster());
    assert_eq!(check(&front(SPHERE, on_axis(50.0), 25.0, 0.0)), Ok(()));
    assert_eq!(
        check(&front(HYPERBOLOID, on_axis(40.0), 25.0, 0.0)),
        Ok(()),
        "the pupil within the other sheet is right"
    );
    assert_eq!(check(&front(SPHERE, on_axis(-5.0), 25.0, 0.0)), Err(FrontError::SeenFromInside));
    let turned = Placement::with_rotation_deg(DVec3::new(0.0, 0.0, 50.0), [180.0, 0.0, 0.0]);
    assert_eq!(check(&front(PARABOLOID, turned, 25.0, 0.0)), Err(FrontError::SeenFromInside));
    assert_eq!(
        check(&front(PARABOLOID, on_axis(-500.0), 5.0, 0.0)),
        Err(FrontError::SeenFromInside),
        "far within its axis"
    );
    let aside = Placement::with_rotation_deg(DVec3::new(500.0, 0.0, 50.0), [0.0; 3]);
    assert_eq!(check(&front(SPHERE, aside, 25.0, 0.0)), Err(FrontError::NotVisible));
}

#[test]
fn mirrors_that_cannot_be_are_refused() {
    let refused = |kind, outer_mm, hole| Quadric::new(kind, outer_mm, hole).expect_err("no mirror").to_string();
    assert!(refused(SPHERE, 31.0, 0.0).contains("reaches only 30.000000 mm"));
    assert!(refused(SPHERE, 10.0, 10.0).contains("leaves nothing"));
    assert!(refused(QuadricKind::Cone { half_angle_deg: 90.0 }, 10.0, 0.0).contains("half_angle_deg is 90"));
    assert!(refused(QuadricKind::Conic { radius_mm: -3.0, conic: 0.0 }, 10.0, 0.0).contains("radius_mm is -3"));
}
