//! Profiles against closed forms.

use super::*;
use core::f64::consts::PI;
use etendue_core::maths::f64::sin_cos;

fn isotropic_flux(profile: &Profile) -> f64 {
    profile.flux_sr() / (4.0 * PI)
}

/// A unit direction of spherical angles, degrees: azimuth to the right of +x, elevation.
fn towards(azimuth_deg: f64, elevation_deg: f64) -> Vec3 {
    let ((sin_a, cos_a), (sin_e, cos_e)) = (sin_cos(azimuth_deg.to_radians()), sin_cos(elevation_deg.to_radians()));
    glam::DVec3::new(cos_e * cos_a, -cos_e * sin_a, sin_e).as_vec3()
}

fn steps(from: f32, to: f32, count: usize) -> Vec<f32> {
    (0..count).map(|i| from + (to - from) * i as f32 / (count - 1) as f32).collect()
}

fn photometric_grid(
    axes: PhotometricAxes,
    v: Vec<f32>,
    h: Vec<f32>,
    value: impl Fn(f32, f32) -> f32,
) -> PhotometricGrid {
    let values = h.iter().flat_map(|h| v.iter().map(|v| value(*v, *h)).collect::<Vec<_>>()).collect();
    PhotometricGrid::new(axes, v, h, values).expect("a grid")
}

#[test]
fn a_spot_has_its_closed_flux_and_its_edges() {
    for (inner_deg, outer_deg) in [(0.0_f64, 30.0_f64), (10.0, 10.0), (0.05, 0.1), (60.0, 180.0)] {
        let cone = Cone::new(inner_deg.to_radians(), outer_deg.to_radians()).expect("a spot");
        let summed: f64 = cone.nodes().iter().map(spread::ProfileNode::flux).sum();
        // The midpoint rule in 128 rings errs by half a ring at a sharp edge, of 128.
        let profile = Profile::Cone(cone);
        assert!((summed / profile.flux_sr() - 1.0).abs() < 5e-3, "{inner_deg}–{outer_deg}: {summed}");
        for (angle, inside) in [(0.999 * inner_deg, true), (1.001 * outer_deg, false)] {
            if angle <= 180.0 && (inside || outer_deg < 180.0) {
                assert_eq!(profile.value(towards(angle, 0.0)) > 0.5, inside, "{inner_deg}–{outer_deg} at {angle}");
            }
        }
    }
    let cone = Profile::Cone(Cone::new(0.0, PI / 2.0).expect("a spot"));
    // t = cos θ: 3 cos² − 2 cos³ at 60° is 0.5.
    assert!((cone.value(towards(60.0, 0.0)) - 0.5).abs() < 1e-6);
    assert!((cone.flux_sr() - PI).abs() < 1e-12);
}

#[test]
fn grids_of_one_value_have_the_flux_of_their_part_of_the_sphere() {
    let (full_v, full_h) = (steps(-90.0, 90.0, 19), steps(-180.0, 180.0, 37));
    let fractions = [
        (photometric_grid(PhotometricAxes::A, full_v.clone(), full_h.clone(), |_, _| 1.0), 1.0),
        (photometric_grid(PhotometricAxes::B, full_h, full_v, |_, _| 1.0), 1.0),
        (photometric_grid(PhotometricAxes::C, steps(0.0, 180.0, 5), vec![0.0], |_, _| 1.0), 1.0),
        (photometric_grid(PhotometricAxes::A, steps(-90.0, 90.0, 9), vec![0.0], |_, _| 1.0), 1.0),
        (photometric_grid(PhotometricAxes::B, steps(-90.0, 90.0, 9), vec![0.0], |_, _| 1.0), 0.5),
        (photometric_grid(PhotometricAxes::C, steps(0.0, 90.0, 5), steps(0.0, 360.0, 5), |_, _| 1.0), 0.5),
        (photometric_grid(PhotometricAxes::A, steps(0.0, 90.0, 5), steps(0.0, 90.0, 3), |_, _| 1.0), 0.125),
        (photometric_grid(PhotometricAxes::B, steps(-90.0, 90.0, 5), steps(-30.0, 30.0, 3), |_, _| 1.0), 0.25),
    ];
    for (grid, fraction) in fractions {
        let summed: f64 = grid.nodes().iter().map(spread::ProfileNode::flux).sum();
        let profile = Profile::PhotometricGrid(grid);
        assert!((isotropic_flux(&profile) - fraction).abs() < 1e-6, "{profile:?}");
        // Two nodes per interval of up to 45°: the error of Gauss' rule for a cosine is (π/4)⁵/4320.
        assert!((summed / profile.flux_sr() - 1.0).abs() < 1e-3, "{profile:?}: {summed}");
    }
}

#[test]
fn a_cosine_lamp_has_the_flux_pi() {
    let down = photometric_grid(PhotometricAxes::C, steps(0.0, 90.0, 91), vec![0.0], |v, _| {
        sin_cos(f64::from(90.0 - v).to_radians()).0 as f32
    });
    // Chords lie below the cosine by at most (1°)²/8 of it.
    assert!((Profile::PhotometricGrid(down).flux_sr() / PI - 1.0).abs() < 5e-5);
}

#[test]
fn grids_are_exact_at_their_points_in_the_directions_of_their_type() {
    let value = |v: f32, h: f32| 2.0 + v / 100.0 + h / 500.0;
    let a = photometric_grid(PhotometricAxes::A, steps(-30.0, 30.0, 13), steps(-60.0, 60.0, 25), value);
    let b = photometric_grid(PhotometricAxes::B, steps(-30.0, 30.0, 13), steps(-60.0, 60.0, 25), value);
    let c = photometric_grid(PhotometricAxes::C, steps(0.0, 180.0, 13), steps(0.0, 345.0, 24), value);
    for (v, h) in [(10.0, 20.0), (-25.0, 45.0), (5.0, -60.0), (30.0, 0.0)] {
        assert!((a.value(towards(h, v)) - value(v as f32, h as f32)).abs() < 1e-5, "A {v} {h}");
        // Type B: H leaves the plane, V turns it: (cos H cos V, −sin H, cos H sin V).
        let ((sh, ch), (sv, cv)) = (sin_cos(h.to_radians()), sin_cos(v.to_radians()));
        let direction = glam::DVec3::new(ch * cv, -sh, ch * sv).as_vec3();
        assert!((b.value(direction) - value(v as f32, h as f32)).abs() < 1e-5, "B {v} {h}");
    }
    for (gamma, plane) in [(45.0, 90.0), (90.0, 0.0), (120.0, 270.0), (15.0, 345.0)] {
        // C90 is to the left, straight down is 0.
        let intensity = c.value(towards(-plane, gamma - 90.0));
        assert!((intensity - value(gamma as f32, plane as f32)).abs() < 1e-4, "C {gamma} {plane}: {intensity}");
    }
    let seam = c.value(towards(-352.5, 0.0));
    assert!((seam - 0.5 * (value(90.0, 345.0) + value(90.0, 0.0))).abs() < 1e-4, "the last plane joins the first");
}

#[test]
fn nothing_shines_outside_a_grid() {
    let a = photometric_grid(PhotometricAxes::A, steps(-30.0, 30.0, 3), steps(-60.0, 60.0, 3), |_, _| 5.0);
    for (h, v) in [(61.0, 0.0), (0.0, 31.0), (0.0, -31.0), (180.0, 0.0), (-61.0, 10.0)] {
        assert_eq!(a.value(towards(h, v)), 0.0, "{h} {v}");
    }
    let c = photometric_grid(PhotometricAxes::C, steps(0.0, 90.0, 3), vec![0.0], |_, _| 5.0);
    assert_eq!((c.value(Vec3::Z), c.value(Vec3::NEG_Z)), (0.0, 5.0));
}

#[test]
fn a_mask_fills_its_field_the_right_way_up() {
    // Rows from the top: left and right, lower left and lower right.
    let image =
        MaskImage::new(2, 2, vec![1.0, 2.0, 3.0, 4.0], 90_f64.to_radians(), 60_f64.to_radians()).expect("a mask");
    let profile = Profile::MaskImage(image);
    for (azimuth, elevation, value) in [(-44.9, 20.0, 1.0), (44.9, 20.0, 2.0), (-40.0, -20.0, 3.0), (40.0, -20.0, 4.0)]
    {
        assert!((profile.value(towards(azimuth, elevation)) - value).abs() < 1e-5, "{azimuth} {elevation}");
    }
    assert!((profile.on_axis() - 2.5).abs() < 1e-6);
    for (azimuth, elevation) in [(45.1, 0.0), (0.0, 30.1), (0.0, -30.1), (180.0, 0.0)] {
        assert_eq!(profile.value(towards(azimuth, elevation)), 0.0);
    }
    // The solid angle of a rectangular field: 4 asin(sin(h/2)·sin(v/2) …) = 4 atan(a b / √(1 + a² + b²)).
    let white = Profile::MaskImage(
        MaskImage::new(3, 2, vec![1.0; 6], 90_f64.to_radians(), 60_f64.to_radians()).expect("white"),
    );
    let (a, b) = (1.0_f64, 1.0 / 3.0_f64.sqrt());
    let solid = 4.0 * etendue_core::maths::f64::atan(a * b / (1.0 + a * a + b * b).sqrt());
    assert!((white.flux_sr() / solid - 1.0).abs() < 1e-6, "{} {solid}", white.flux_sr());
}

#[test]
fn a_mask_cuts_what_it_covers() {
    let half = MaskImage::new(2, 1, vec![0.0, 1.0], 80_f64.to_radians(), 80_f64.to_radians()).expect("a mask");
    let spot = Cone::new(0.2, 0.3).expect("a spot");
    let total = spot.spread().flux_sr;
    let masked = Profile::masked(Profile::Cone(spot), Profile::MaskImage(half));
    // Odd about the middle: half of the spot passes the mask.
    assert!((masked.flux_sr() / total - 0.5).abs() < 2e-3, "{}", masked.flux_sr() / total);
    assert_eq!(masked.value(towards(-0.35_f64.to_degrees(), 0.0)), 0.0);
    assert!(masked.value(towards(5.0, 0.0)) > masked.value(towards(-5.0, 0.0)));
}

#[test]
fn the_reach_holds_all_light() {
    let profiles = [
        Profile::PhotometricGrid(photometric_grid(
            PhotometricAxes::A,
            steps(-30.0, 30.0, 3),
            steps(-60.0, 60.0, 3),
            |_, _| 5.0,
        )),
        Profile::PhotometricGrid(photometric_grid(PhotometricAxes::C, steps(0.0, 90.0, 4), vec![0.0], |v, _| v)),
        Profile::MaskImage(MaskImage::new(4, 4, vec![1.0; 16], 1.0, 2.0).expect("a mask")),
        Profile::Cone(Cone::new(0.1, 0.4).expect("a spot")),
    ];
    for profile in &profiles {
        let spread = profile.spread();
        for i in 0..20_000 {
            let u = glam::Vec2::new((i as f32 + 0.5) / 20_000.0, (0.618_034 * f64::from(i)).fract() as f32);
            let direction = etendue_core::warp::uniform_sphere(u);
            let inside = etendue_core::maths::f32::acos(direction.dot(spread.axis)) <= spread.reach_rad;
            assert!(inside || profile.value(direction) == 0.0, "{profile:?} at {direction}");
        }
    }
}

#[test]
fn faulty_profiles_are_refused() {
    let grid = |v: Vec<f32>, h: Vec<f32>, n: usize| PhotometricGrid::new(PhotometricAxes::C, v, h, vec![1.0; n]).err();
    assert!(matches!(grid(vec![0.0, 90.0], vec![0.0], 3), Some(PhotometricGridError::Size { .. })));
    assert!(matches!(
        grid(vec![90.0, 0.0], vec![0.0], 2),
        Some(PhotometricGridError::Angles { which: "vertical", .. })
    ));
    assert!(matches!(grid(vec![0.0, 190.0], vec![0.0], 2), Some(PhotometricGridError::Angles { .. })));
    assert!(matches!(
        grid(vec![0.0, 90.0], vec![0.0, 400.0], 4),
        Some(PhotometricGridError::Angles { which: "horizontal", .. })
    ));
    let negative = PhotometricGrid::new(PhotometricAxes::A, vec![0.0, 1.0], vec![0.0], vec![1.0, -1.0]);
    assert_eq!(negative.err(), Some(PhotometricGridError::Value { value: 1 }));
    assert!(matches!(Cone::new(0.5, 0.4), Err(ConeError::Angles { .. })));
    assert!(matches!(Cone::new(0.0, 0.0), Err(ConeError::Angles { .. })));
    assert!(matches!(MaskImage::new(1, 1, vec![1.0], 0.0, 1.0), Err(MaskImageError::Field { .. })));
    assert!(matches!(MaskImage::new(1, 1, vec![f32::NAN], 1.0, 1.0), Err(MaskImageError::Texel { texel: 0 })));
}

#[test]
fn a_mask_wider_than_its_spot_takes_no_light() {
    for field_deg in [0.05_f64, 0.3, 2.0, 20.0] {
        let cone = Profile::Cone(Cone::new(0.0, field_deg.to_radians()).expect("a spot"));
        let image = MaskImage::new(3, 2, vec![1.0; 6], 2.0, 1.5).expect("a mask");
        let masked = Profile::masked(cone.clone(), Profile::MaskImage(image));
        // The midpoint rule in 128 rings.
        assert!((masked.flux_sr() / cone.flux_sr() - 1.0).abs() < 5e-3, "{field_deg}°: {}", masked.flux_sr());
        let (reach_seen, reach) = (f64::from(masked.spread().reach_rad), field_deg.to_radians());
        assert!(reach_seen >= reach && reach_seen < 1.2 * reach, "{field_deg}°: {reach_seen}");
    }
}
