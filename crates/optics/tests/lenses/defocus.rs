//! Depth of field in image space: uniform light, points, edges, compared with formulas and with rays through the lens.

use etendue_core::quantity::{Length, Radiance};
use etendue_core::{Bands, Plane, SpectralCube};
use etendue_optics::defocus::{PhysicalDefocus, PinholeView};
use etendue_optics::{
    ClippingAperture, ConstantPupil, DepthOfField, FastBlend, FastParameters, Lens, OpticsError, PinholeParameters,
    PupilParameters, ThickParameters, ThinParameters,
};
use etendue_projection::Raster;
use glam::{DVec2, DVec3};

fn bands(count: usize) -> Bands {
    Bands::covering(500.0, 500.0 + 10.0 * count as f64, 10.0).expect("legal")
}

/// 50 mm f/2 at 3 m: 0.42 mm at infinity.
fn thin() -> Lens {
    let parameters = ThinParameters { focal_length_mm: 50.0, f_number: 2.0, focus_distance_m: 3.0, transmittance: 1.0 };
    Lens::thin(parameters).expect("legal")
}

/// The same as a thick lens whose apertures clip off the axis.
fn clipped() -> Lens {
    Lens::thick(ThickParameters {
        focal_length_mm: 50.0,
        f_number: 2.0,
        focus_distance_m: 3.0,
        transmittance: 1.0,
        principal_separation_mm: 0.0,
        pupils: PupilParameters::default(),
        constant_pupil: ConstantPupil::Exit,
        front_aperture: Some(ClippingAperture { position_mm: -30.0, radius_mm: 14.0 }),
        rear_aperture: None,
    })
    .expect("legal")
}

/// An image seen along principal rays: the scene by the tangents of the direction.
fn visible(
    lens: &Lens,
    raster: &Raster,
    margin: usize,
    scene: impl Fn(DVec2) -> (f64, f64),
) -> (SpectralCube<Radiance>, Plane<Length>) {
    let (width, height) = (raster.width() + 2 * margin, raster.height() + 2 * margin);
    let mut radiance = SpectralCube::new(width, height, bands(1));
    let mut distance = Plane::new(width, height);
    for y in 0..height {
        for x in 0..width {
            let px = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - margin as f64;
            let tangent = lens.tangent(raster.sensor_mm(px)).expect("a picture");
            let (depth, light) = scene(tangent);
            distance.set(x, y, (depth * tangent.extend(1.0).length()) as f32);
            radiance.planes_mut()[0].set(x, y, light as f32);
        }
    }
    (radiance, distance)
}

fn physical(
    lens: &Lens,
    raster: &Raster,
    margin: usize,
    scene: impl Fn(DVec2) -> (f64, f64),
) -> SpectralCube<Radiance> {
    let (radiance, distance) = visible(lens, raster, margin, scene);
    let view = PinholeView::new(lens, raster, margin, &radiance, &distance).expect("sizes");
    DepthOfField::Physical.apply(&view)
}

/// Sum, mean and root of the mean variance along both axes, px, of the light of an image.
fn spot(cube: &SpectralCube<Radiance>) -> (f64, DVec2, f64) {
    let at = |i: usize| DVec2::new((i % cube.width()) as f64 + 0.5, (i / cube.width()) as f64 + 0.5);
    let light: Vec<f64> = cube.planes()[0].samples().iter().map(|l| f64::from(*l)).collect();
    let sum: f64 = light.iter().sum();
    let mean = light.iter().enumerate().map(|(i, l)| at(i) * *l).sum::<DVec2>() / sum;
    let square: f64 = light.iter().enumerate().map(|(i, l)| at(i).distance_squared(mean) * l).sum();
    (sum, mean, (0.5 * square / sum).sqrt())
}

/// The fraction of a pixel's pupil that sees past a half plane x < edge in front, by the lens's own rays.
fn covered(lens: &Lens, sensor_mm: DVec2, near_m: f64, edge_m: f64) -> f64 {
    const SIDE: usize = 48;
    let sample = |i: usize| DVec2::new((i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5) / SIDE as f64;
    let rays = (0..SIDE * SIDE).filter_map(|i| lens.ray(sensor_mm, sample(i), 587.56));
    let (mut all, mut front) = (0.0, 0.0);
    for ray in rays {
        let point: DVec3 = ray.origin_m + ray.direction * ((near_m - ray.origin_m.z) / ray.direction.z);
        all += 1.0;
        front += if point.x < edge_m { 1.0 } else { 0.0 };
    }
    front / all
}

#[test]
fn a_uniform_radiance_stays_uniform_whatever_the_distances() {
    let raster = Raster::centred(40, 30, 0.03).expect("legal");
    let steps = |t: DVec2| (if t.x > 0.05 { 0.8 } else { 3.0 + 40.0 * (t.y + 0.2) }, 0.37);
    let sky = |t: DVec2| (if t.y < 0.0 { f64::INFINITY } else { 1.2 }, 0.37);
    for lens in [thin(), clipped()] {
        for image in [physical(&lens, &raster, 6, steps), physical(&lens, &raster, 0, sky)] {
            for l in image.planes()[0].samples() {
                assert!((l / 0.37 - 1.0).abs() < 1e-6, "{l}");
            }
        }
    }
    let blend =
        FastParameters { sharp_near_m: 2.0, sharp_far_m: 4.0, blurred_near_m: 1.0, blurred_far_m: 9.0, blur_px: 7.0 };
    let (radiance, distance) = visible(&thin(), &raster, 4, steps);
    let lens = thin();
    let view = PinholeView::new(&lens, &raster, 4, &radiance, &distance).expect("sizes");
    let image = DepthOfField::Fast(FastBlend::new(blend).expect("legal")).apply(&view);
    assert!(image.planes()[0].samples().iter().all(|l| (l / 0.37 - 1.0).abs() < 1e-6));
}

#[test]
fn what_is_in_focus_and_what_blurs_below_a_pixel_stays_as_it_is() {
    let raster = Raster::centred(24, 16, 0.05).expect("legal");
    let texture = |t: DVec2| ((t.x * 731.0).sin_like() + 2.0) * ((t.y * 577.0).sin_like() + 3.0);
    for depth_m in [3.0, 2.9, 3.2] {
        let scene = |t: DVec2| (depth_m, texture(t));
        assert!(thin().circle_of_confusion_mm(depth_m) < 0.9 * 0.05);
        let (radiance, _) = visible(&thin(), &raster, 0, scene);
        assert_eq!(physical(&thin(), &raster, 0, scene), radiance);
    }
    let sharp = Lens::pinhole(PinholeParameters { focal_length_mm: 50.0, f_number: 2.0, transmittance: 1.0 });
    let scene = |t: DVec2| (0.2, texture(t));
    let sharp = sharp.expect("legal");
    assert_eq!(physical(&sharp, &raster, 3, scene), visible(&sharp, &raster, 0, scene).0);
}

/// Anything that wiggles.
trait SinLike {
    fn sin_like(self) -> f64;
}

impl SinLike for f64 {
    fn sin_like(self) -> f64 {
        etendue_core::maths::f64::sin(self)
    }
}

#[test]
fn a_point_s_blur_has_the_diameter_of_the_formula() {
    // A single bright pixel among dark ones at its distance. A disc's standard deviation is a quarter of its diameter; the pixel's square adds a
    // twelfth to the variance, 48 vertices and lines leave a hundredth of the diameter.
    let raster = Raster::centred(81, 81, 0.02).expect("legal");
    for depth_m in [1.2, 1.5, 2.0, 6.0, 20.0, 1e6] {
        let point = |t: DVec2| (depth_m, if t.length() < 1e-6 { 1.0 } else { 0.0 });
        let (sum, mean, deviation) = spot(&physical(&thin(), &raster, 0, point));
        let diameter_px = 4.0 * (deviation * deviation - 1.0 / 12.0).sqrt();
        let expected_px = thin().circle_of_confusion_mm(depth_m) / 0.02;
        assert!((diameter_px / expected_px - 1.0).abs() < 0.015, "{depth_m} m: {diameter_px} of {expected_px}");
        assert!((sum - 1.0).abs() < 1e-3, "{sum}");
        assert!((mean - 40.5).length() < 0.02, "{mean}");
    }
}

#[test]
fn the_cat_s_eye_of_the_rims_points_the_other_way_behind_the_focus() {
    // A point off the axis, in front of and behind the plane in focus, compared with the mean and spread of its own rays.
    let raster = Raster::new(61, 61, DVec2::splat(0.02), DVec2::new(-300.0, 30.5)).expect("legal");
    let lens = clipped();
    let at = lens.tangent(raster.sensor_mm(DVec2::splat(30.5))).expect("a picture");
    let mut sides = Vec::new();
    for depth_m in [2.0, 6.0] {
        let point = |t: DVec2| (depth_m, if (t - at).length() < 1e-6 { 1.0 } else { 0.0 });
        let (_, mean, deviation) = spot(&physical(&lens, &raster, 0, point));
        // A sensor point that sees the scene point through p has its chief ray's tangent at - p (1/z - 1/F).
        let u = 1.0 / depth_m - 1.0 / 3.0;
        let landings: Vec<DVec2> = (0..64_u32 * 64)
            .filter_map(|i| {
                let sample = DVec2::new(f64::from(i % 64) + 0.5, f64::from(i / 64) + 0.5) / 64.0;
                let ray = lens.ray(raster.sensor_mm(DVec2::splat(30.5)), sample, 587.56)?;
                Some(-ray.origin_m.truncate() * u * lens.principal_distance_mm() / 0.02 + 30.5)
            })
            .collect();
        let middle = landings.iter().copied().sum::<DVec2>() / landings.len() as f64;
        let spread = landings.iter().map(|p| p.distance_squared(middle)).sum::<f64>() / landings.len() as f64;
        assert!((mean - middle).length() < 0.1, "{mean} {middle}");
        assert!((deviation * deviation - 1.0 / 12.0 - 0.5 * spread).abs() < 0.03 * spread, "{deviation} {spread}");
        sides.push(mean.x - 30.5);
    }
    assert!(sides[0] * sides[1] < 0.0, "{sides:?}");
    assert!(sides[0].abs() > 0.3, "{sides:?}");
}

/// Largest and mean difference between the filter and rays through the lens at an edge at x = 0 of a black object at `near_m` in front of a white one
/// at `far_m`.
fn edge_errors(near_m: f64, far_m: f64) -> (f64, f64) {
    let raster = Raster::centred(80, 9, 0.02).expect("legal");
    let lens = thin();
    let margin = 30;
    let image = physical(&lens, &raster, margin, |t| if t.x < 0.0 { (near_m, 0.0) } else { (far_m, 1.0) });
    let errors: Vec<f64> = (0..80)
        .map(|x| {
            let sensor_mm = raster.sensor_mm(DVec2::new(x as f64 + 0.5, 4.5));
            let through_lens = 1.0 - covered(&lens, sensor_mm, near_m, 0.0);
            (f64::from(image.planes()[0].at(x, 4)) - through_lens).abs()
        })
        .collect();
    (errors.iter().copied().fold(0.0, f64::max), errors.iter().sum::<f64>() / 80.0)
}

#[test]
fn an_edge_in_front_of_a_wall_is_as_through_the_lens() {
    // A blurred edge in front of a sharp wall and of blurred ones, and a sharp edge in front of a blurred wall. The tolerance is a quarter of a pixel
    // of the ramp, which is as wide as the blur (20 to 60 px).
    for (near_m, far_m, maximum) in [(1.2, 3.0, 0.01), (1.2, 20.0, 0.03), (2.0, 6.0, 0.03)] {
        let (largest, mean) = edge_errors(near_m, far_m);
        assert!(largest < maximum && mean < 0.003, "{near_m} m before {far_m} m: {largest}, mean {mean}");
    }
    let (largest, mean) = edge_errors(3.0, 20.0);
    assert!(largest < 1e-3 && mean < 1e-4, "a sharp edge: {largest}, mean {mean}");
}

#[test]
fn a_bright_blur_behind_does_not_light_a_sharp_thing_in_front() {
    let raster = Raster::centred(60, 20, 0.02).expect("legal");
    let scene = |t: DVec2| if t.x < 0.0 { (3.0, 0.25) } else { (f64::INFINITY, 1000.0) };
    let image = physical(&thin(), &raster, 20, scene);
    for y in 0..20 {
        for x in 0..30 {
            assert_eq!(image.planes()[0].at(x, y), 0.25, "{x} {y}");
        }
    }
}

#[test]
fn all_bands_have_the_same_weights_and_strips_join_to_the_same_bits() {
    let raster = Raster::centred(50, 70, 0.02).expect("legal");
    let lens = thin();
    let scene = |t: DVec2| if t.x + 0.3 * t.y < 0.0 { (1.5, t.y.abs() + 0.1) } else { (30.0, 1.0 + t.x) };
    let (one, distance) = visible(&lens, &raster, 10, scene);
    let plane = &one.planes()[0];
    let three = vec![plane.clone(), plane.map(|l| 2.0 * l), plane.clone()];
    let three = SpectralCube::from_planes(bands(3), three).expect("sizes");
    let view = PinholeView::new(&lens, &raster, 10, &three, &distance).expect("sizes");
    let image = PhysicalDefocus::new(view).image();
    let [a, b, c] = image.planes() else { panic!("three bands") };
    assert_eq!(a, c);
    for (a, b) in a.samples().iter().zip(b.samples()) {
        assert!((b / a - 2.0).abs() < 1e-6);
    }
    let prepared = PhysicalDefocus::new(view);
    let rows: Vec<_> = (0..70).rev().map(|y| prepared.rows(y..y + 1)).collect();
    let rows: Vec<_> = rows.into_iter().rev().collect();
    assert_eq!(prepared.join(&rows), image);
}

#[test]
fn pixels_without_a_ray_are_no_light_and_radiance_must_be_numbers() {
    let raster = Raster::centred(30, 30, 0.02).expect("legal");
    let lens = thin();
    let (mut radiance, mut distance) = visible(&lens, &raster, 0, |_| (1.2, 1.0));
    for y in 0..30 {
        distance.set(29, y, f32::NAN);
        radiance.planes_mut()[0].set(29, y, f32::NAN);
    }
    let view = PinholeView::new(&lens, &raster, 0, &radiance, &distance).expect("no ray, no light");
    let image = DepthOfField::Physical.apply(&view);
    assert!((0..29).all(|x| (image.planes()[0].at(x, 15) - 1.0).abs() < 1e-6));
    radiance.planes_mut()[0].set(3, 4, f32::INFINITY);
    let refused = PinholeView::new(&lens, &raster, 0, &radiance, &distance);
    assert!(matches!(refused, Err(OpticsError::RadianceNotFinite { x: 3, y: 4 })));
    assert!(matches!(PinholeView::new(&lens, &raster, 1, &radiance, &distance), Err(OpticsError::Size { .. })));
}

#[test]
fn the_fast_blend_has_its_diameter_where_it_is_whole_and_none_where_it_is_sharp() {
    let raster = Raster::centred(61, 61, 0.02).expect("legal");
    let lens = thin();
    let blend = FastBlend::new(FastParameters {
        sharp_near_m: 2.0,
        sharp_far_m: 4.0,
        blurred_near_m: 1.5,
        blurred_far_m: 9.0,
        blur_px: 9.0,
    })
    .expect("legal");
    let margin = DepthOfField::Fast(blend).reach_px(&lens, &raster, 1.0);
    for (depth_m, diameter_px) in [(1.2, 9.0), (3.0, 0.0), (50.0, 9.0)] {
        let point = |t: DVec2| (depth_m, if t.length() < 1e-6 { 1.0 } else { 0.0 });
        let (radiance, distance) = visible(&lens, &raster, margin, point);
        let view = PinholeView::new(&lens, &raster, margin, &radiance, &distance).expect("sizes");
        let (_, _, deviation) = spot(&DepthOfField::Fast(blend).apply(&view));
        assert!((4.0 * deviation - diameter_px).abs() < 1e-3, "{depth_m} m: {deviation}");
    }
}
