//! Ray-transfer functions off the meridian and at several wavelengths, compared with closed forms and with rotated copies of themselves.
//!
//! An ideal lens subtracts 1/f of a ray's height from its direction cosines: d′ = d − p/f across the axis, p the ray's crossing of the lens. In the
//! frame of a ray, whose y axis goes through p, that is outx = 0, outy = ρ, outdx = dx, outdy = dy − ρ/f.

use core::f64::consts::PI;
use etendue_core::maths::f64::{cos, sin};
use etendue_core::ray::PupilRay;
use etendue_optics::ray_transfer::{
    PassCircle, PassEllipse, PassRegion, Polynomial, RayPass, RayTransfer, Term, Transfer,
};
use etendue_optics::{Lens, RayTransferLens, SensorPlace};
use glam::{DMat2, DVec2, DVec3};

/// The sensor behind the lens, mm.
const SENSOR: f64 = 50.0;

fn polynomial(terms: &[(f64, [u8; 3])]) -> Polynomial {
    Polynomial::new(
        terms.iter().map(|(coefficient, powers)| Term { coefficient: *coefficient, powers: *powers }).collect(),
    )
    .expect("legal")
}

fn circle(radius_mm: f64) -> RayPass {
    RayPass::new(0.0, PassRegion::Circles(vec![PassCircle { radius_mm, sensitivity: 0.0 }])).expect("legal")
}

/// An ideal lens of a power (1/mm), `z_mm` before the front vertex.
fn ideal(wavelength_nm: f64, power: f64, z_mm: f64, pass: RayPass) -> Transfer {
    let (height, dx, dy) = ([1, 0, 0], [0, 1, 0], [0, 0, 1]);
    Transfer {
        wavelength_nm,
        pass,
        point: [polynomial(&[]), polynomial(&[(1.0, height)]), Polynomial::constant(z_mm)],
        direction: [polynomial(&[(1.0, dx)]), polynomial(&[(1.0, dy), (-power, height)])],
        forwards: None,
    }
}

fn lens(transfers: Vec<Transfer>) -> Lens {
    let transfer = RayTransfer::new(0.0, 0.0, transfers).expect("legal");
    Lens::ray_transfer(RayTransferLens::new(transfer, SensorPlace::Distance(SENSOR), 1.0, 6.0).expect("a lens"))
}

/// Points of the sensor on all sides of the axis, on it, and pupil samples.
fn samples() -> impl Iterator<Item = (DVec2, DVec2)> {
    let points = (0..12).map(|i| {
        let angle = 0.3 + 2.0 * PI * f64::from(i) / 11.0;
        DVec2::new(cos(angle), sin(angle)) * (0.5 * f64::from(i))
    });
    points.flat_map(|point| {
        (0..64).map(move |i| (point, DVec2::new(f64::from(i % 8) + 0.5, f64::from(i / 8) + 0.5) / 8.0))
    })
}

/// The crossing of the lens by a ray, and its direction, in the frame of the lens: x as in the camera's, y upwards.
fn in_the_lens(ray: &PupilRay) -> (DVec2, DVec2) {
    let flip = DVec2::new(1.0, -1.0);
    (ray.origin_m.truncate() * 1e3 * flip, ray.direction.truncate() * flip)
}

/// Direction after an ideal lens of a power, for the ray from a point of the erect image through a point of the lens.
fn ideal_direction(sensor_mm: DVec2, at_mm: DVec2, power: f64) -> DVec2 {
    // The image is upside down: an object on the right falls on the left of the sensor.
    let film = DVec2::new(-sensor_mm.x, sensor_mm.y);
    (at_mm - film).extend(SENSOR).normalize().truncate() - at_mm * power
}

#[test]
fn skew_rays_are_bent_as_by_an_ideal_lens() {
    let lens = lens(vec![ideal(550.0, 1.0 / SENSOR, 0.0, circle(8.0))]);
    let mut count = 0;
    for (sensor_mm, pupil) in samples() {
        let Some(ray) = lens.ray(sensor_mm, pupil, 550.0) else { continue };
        let (at, direction) = in_the_lens(&ray);
        let expected = ideal_direction(sensor_mm, at, 1.0 / SENSOR);
        assert!((direction - expected).length() < 1e-12, "{sensor_mm} {at}: {direction} for {expected}");
        assert!(at.length() <= 8.0 && (ray.direction.length() - 1.0).abs() < 1e-12);
        count += 1;
    }
    // All samples of a uniform disc pass, except for the margin of the sampled region.
    assert!(count > 700, "{count} of 768 rays");
}

/// All features of a file, with terms that are odd in dx.
fn asymmetric_transfers() -> Vec<Transfer> {
    let of = |wavelength_nm: f64, more: f64| {
        let ellipse = |height_mm: f64, centre: f64, x: f64, y: f64| PassEllipse {
            height_mm,
            centre_mm: DVec2::new(0.0, centre),
            radii_mm: DVec2::new(x, y),
        };
        let region = PassRegion::Ellipses(vec![ellipse(0.0, 0.0, 3.0, 3.0), ellipse(9.0, 1.2, 2.0, 1.1)]);
        Transfer {
            wavelength_nm,
            pass: RayPass::new(12.0, region).expect("legal"),
            point: [
                polynomial(&[(0.3, [1, 1, 0]), (1.5, [0, 1, 2])]),
                polynomial(&[(1.0 + more, [1, 0, 0]), (1e-3, [3, 0, 0]), (0.7, [0, 0, 1]), (0.2, [1, 2, 0])]),
                polynomial(&[(0.4, [0, 0, 0]), (0.01, [2, 0, 0])]),
            ],
            direction: [
                polynomial(&[(0.9, [0, 1, 0]), (0.002, [2, 1, 0])]),
                polynomial(&[(0.95, [0, 0, 1]), (-0.021 - more, [1, 0, 0]), (1e-5, [3, 0, 0]), (0.01, [1, 2, 0])]),
            ],
            forwards: None,
        }
    };
    vec![of(450.0, 0.0), of(650.0, 0.001)]
}

#[test]
fn rays_that_are_turned_about_the_axis_come_out_turned() {
    let lens = lens(asymmetric_transfers());
    let mut count = 0;
    for (sensor_mm, pupil) in samples().filter(|(sensor_mm, _)| sensor_mm.length() > 0.0) {
        for nm in [450.0, 520.0, 700.0] {
            for degrees in [30.0_f64, 90.0, 137.0, 245.0] {
                let turn = DMat2::from_angle(degrees.to_radians());
                let [plain, turned] = [sensor_mm, turn * sensor_mm].map(|point| lens.ray(point, pupil, nm));
                // A ray at the very edge may be in or out by rounding: none of these is.
                let (Some(plain), Some(turned)) = (plain, turned) else {
                    assert_eq!(plain.is_some(), turned.is_some(), "{sensor_mm} {pupil} by {degrees}°");
                    continue;
                };
                let about = |v: DVec3| (turn * v.truncate()).extend(v.z);
                let apart =
                    [turned.direction - about(plain.direction), (turned.origin_m - about(plain.origin_m)) * 1e3];
                assert!(apart.iter().all(|v| v.length() < 1e-11), "{sensor_mm} {pupil} by {degrees}°: {apart:?}");
                assert!((turned.weight_sr / plain.weight_sr - 1.0).abs() < 1e-11);
                count += 1;
            }
        }
    }
    assert!(count > 4000, "{count} rays pass");
    let (one, other) = (DVec2::new(3.0, 0.0), DVec2::new(0.0, 3.0));
    let [one, other] = [one, other].map(|point| lens.principal_ray(point).expect("light").direction);
    assert!((DVec2::new(one.x, one.y).perp() - other.truncate()).length() < 1e-12, "{one} {other}");
}

/// Semi-axes across the meridian of a ray and along it: the region that passes on a plane beyond the lens, for sensor points on all sides.
#[test]
fn ellipses_lie_across_the_meridian() {
    let (plane_mm, radii_mm) = (12.0, DVec2::new(0.8, 2.0));
    let at = |height_mm: f64| PassEllipse { height_mm, centre_mm: DVec2::ZERO, radii_mm };
    let pass = RayPass::new(plane_mm, PassRegion::Ellipses(vec![at(0.0), at(30.0)])).expect("legal");
    let lens = lens(vec![ideal(550.0, 1.0 / SENSOR, 0.0, pass)]);
    for sensor_mm in [DVec2::new(5.0, 0.0), DVec2::new(0.0, -5.0), DVec2::new(3.0, 4.0), DVec2::new(-4.0, 3.0)] {
        let pupils = (0..4096).map(|i| DVec2::new(f64::from(i % 64) + 0.5, f64::from(i / 64) + 0.5) / 64.0);
        let mut reach = DVec2::ZERO;
        for ray in pupils.filter_map(|pupil| lens.ray(sensor_mm, pupil, 550.0)) {
            let at = in_the_lens(&ray).0;
            let film = DVec2::new(-sensor_mm.x, sensor_mm.y);
            let beyond = at + (at - film) * (plane_mm / SENSOR);
            let along = at.normalize();
            let local = DVec2::new(beyond.perp_dot(along), beyond.dot(along));
            assert!((local / radii_mm).length() <= 1.0 + 1e-9, "{sensor_mm}: {local}");
            reach = reach.max(local.abs());
        }
        assert!(reach.x > 0.95 * radii_mm.x && reach.y > 0.9 * radii_mm.y, "{sensor_mm}: {reach} mm");
    }
}

#[test]
fn rays_between_two_wavelengths_are_linear_between_theirs_and_beyond_them_theirs() {
    let powers = [1.0 / SENSOR, 1.1 / SENSOR];
    let two = vec![ideal(450.0, powers[0], 0.0, circle(8.0)), ideal(650.0, powers[1], 0.5, circle(8.0))];
    let lens = lens(two);
    let Lens::RayTransfer(transferred) = &lens else { unreachable!("made so") };
    assert!(transferred.disperses());
    for (sensor_mm, pupil) in samples() {
        let Some(first) = lens.ray(sensor_mm, pupil, 450.0) else { continue };
        for (nm, fraction) in [(380.0, 0.0), (450.0, 0.0), (500.0, 0.25), (600.0, 0.75), (650.0, 1.0), (900.0, 1.0)] {
            let ray = lens.ray(sensor_mm, pupil, nm).expect("the same rays pass at both");
            let (at, direction) = in_the_lens(&ray);
            assert!((at - in_the_lens(&first).0).length() < 1e-12);
            let expected = ideal_direction(sensor_mm, at, powers[0] + fraction * (powers[1] - powers[0]));
            assert!((direction - expected).length() < 1e-12, "{sensor_mm} {at}, {nm} nm: {direction} for {expected}");
            let z_mm = (ray.origin_m.z - first.origin_m.z) * 1e3;
            assert!((z_mm - 0.5 * fraction).abs() < 1e-12, "{nm} nm: {z_mm} mm");
        }
    }
}

/// On the axis the light of a circle of radius R at the distance s subtends π R²/(R² + s²) sr.
#[test]
fn what_passes_is_that_of_the_nearest_wavelength() {
    let radii = [2.0, 4.0];
    let lens = lens(vec![ideal(450.0, 0.02, 0.0, circle(radii[0])), ideal(650.0, 0.02, 0.0, circle(radii[1]))]);
    let grid = 128_u32;
    for (nm, radius) in [(400.0, 2.0), (549.0, 2.0), (551.0, 4.0), (700.0, 4.0)] {
        let pupils = (0..grid * grid)
            .map(|i| DVec2::new(f64::from(i % grid) + 0.5, f64::from(i / grid) + 0.5) / f64::from(grid));
        let mean = pupils.filter_map(|pupil| lens.ray(DVec2::ZERO, pupil, nm)).map(|ray| ray.weight_sr).sum::<f64>()
            / f64::from(grid * grid);
        let expected = PI * radius * radius / (radius * radius + SENSOR * SENSOR);
        // The edge cuts through one in a hundred cells of the grid, half of each on average.
        assert!((mean / expected - 1.0).abs() < 0.01, "{nm} nm: {mean} sr for {expected}");
    }
}
