//! Windscreens in front of the lens, compared with closed forms.

use core::f64::consts::PI;
use etendue_core::maths::f64::{asin, pow, sin_cos};
use etendue_optics::front::{
    Curve, Front, FrontError, FrontRay, Layer, Optic, Placement, Tint, Windscreen, WindscreenParameters,
};
use etendue_optics::prescription::coating::Coating;
use etendue_optics::{Lens, PinholeParameters, ThinParameters};
use etendue_projection::Raster;
use glam::{DVec2, DVec3};

const INDEX: f64 = 1.52;
const THICK_MM: f64 = 5.0;

fn plate(tilt_deg: f64) -> WindscreenParameters {
    WindscreenParameters {
        placement: Placement::with_rotation_deg(DVec3::new(0.0, 0.0, 300.0), [tilt_deg, 0.0, 0.0]),
        radius_across_mm: f64::INFINITY,
        radius_upright_mm: f64::INFINITY,
        layers: vec![Layer { thickness_mm: THICK_MM, index: Curve::Constant(INDEX) }],
        wedge_rad: 0.0,
        tint: None,
        coating: Coating::Uncoated,
        double_image_fraction: Some(0.0),
    }
}

fn front(parameters: WindscreenParameters) -> Front {
    let glass = Windscreen::new(parameters).expect("legal glass");
    Front::new(None, Some(Optic::Windscreen(Box::new(glass)))).expect("glass")
}

fn pinhole() -> Lens {
    Lens::pinhole(PinholeParameters { focal_length_mm: 6.0, f_number: 4.0, transmittance: 1.0 }).expect("a lens")
}

fn axis(parameters: WindscreenParameters) -> FrontRay {
    front(parameters).ray(&pinhole(), DVec2::ZERO, DVec2::splat(0.5), 550.0).expect("a ray")
}

/// The axial ray of the double image alone.
fn doubled_axis(parameters: WindscreenParameters) -> FrontRay {
    let front = front(WindscreenParameters { double_image_fraction: Some(0.5), ..parameters });
    front.ray(&pinhole(), DVec2::ZERO, DVec2::new(0.25, 0.5), 550.0).expect("a ray")
}

/// Fraction of the light that passes on the axis.
fn weight_fraction(ray: &FrontRay) -> f64 {
    ray.ray.weight_sr / pinhole().principal_ray(DVec2::ZERO).expect("a ray").weight_sr
}

/// Fresnel: reflectance of bare glass at an angle in air, mean of both polarisations.
fn fresnel(n: f64, theta: f64) -> f64 {
    let (s, c) = sin_cos(theta);
    let beyond = (1.0 - s * s / (n * n)).sqrt();
    let (rs, rp) = ((c - n * beyond) / (c + n * beyond), (n * c - beyond) / (n * c + beyond));
    0.5 * (rs * rs + rp * rp)
}

fn radians(degrees: f64) -> f64 {
    degrees * PI / 180.0
}

#[test]
fn a_flat_plate_shifts_rays_by_the_closed_form() {
    for tilt in [0.0, 20.0, 45.0, 60.0, 75.0] {
        let ray = axis(plate(tilt));
        // t sin θ (1 − cos θ/√(n² − sin² θ)), towards the incoming light: a glass whose upper edge leans back raises the view.
        let (s, c) = sin_cos(radians(tilt));
        let shift_m = 1e-3 * THICK_MM * s * (1.0 - c / (INDEX * INDEX - s * s).sqrt());
        assert!((ray.ray.direction - DVec3::Z).length() < 1e-14, "the direction stays");
        let off = ray.truth_origin_m();
        assert!((off.length() - shift_m).abs() < 1e-15 && off.z.abs() < 1e-14, "{tilt}: {off} against {shift_m}");
        assert!(tilt == 0.0 || off.y < 0.0);
    }
}

#[test]
fn layers_of_one_index_are_one_layer() {
    let layer = |thickness_mm| Layer { thickness_mm, index: Curve::Constant(INDEX) };
    let split = WindscreenParameters { layers: vec![layer(2.1), layer(0.8), layer(2.1)], ..plate(60.0) };
    let (one, three) = (axis(plate(60.0)), axis(split.clone()));
    assert!((one.truth_origin_m() - three.truth_origin_m()).length() < 1e-15);
    assert!((weight_fraction(&one) - weight_fraction(&three)).abs() < 1e-14);
    let (one, three) = (doubled_axis(plate(60.0)), doubled_axis(split));
    assert!((weight_fraction(&one) - weight_fraction(&three)).abs() < 1e-14);
}

#[test]
fn bare_glass_lets_through_what_fresnel_says() {
    for tilt in [0.0, 30.0, 60.0, 70.0] {
        let r = fresnel(INDEX, radians(tilt));
        assert!((weight_fraction(&axis(plate(tilt))) - (1.0 - r) * (1.0 - r)).abs() < 1e-13, "{tilt}");
        // Two more reflections, at half the samples.
        let doubled = weight_fraction(&doubled_axis(plate(tilt)));
        assert!((doubled - 2.0 * (1.0 - r) * (1.0 - r) * r * r).abs() < 1e-13, "{tilt}");
    }
    // 4.26 % at each face: 91.7 % in all.
    assert!((weight_fraction(&axis(plate(0.0))) - 0.9167).abs() < 1e-4);
}

#[test]
fn a_wedge_bends_and_doubles_by_the_closed_form() {
    let wedge_rad = 4e-4;
    for tilt in [0.0, 30.0, 60.0] {
        let parameters = WindscreenParameters { wedge_rad, ..plate(tilt) };
        let (s, c) = sin_cos(radians(tilt));
        let inside = asin(s / INDEX);
        let (_, inner_cosine) = sin_cos(inside);
        // Exactly, by Snell's law at faces an angle w apart: the ray meets the outer face at θ′ − w or, after two
        // reflections, at θ′ − 3w (thicker above, its upper edge leaning back).
        let angle = |ray: &FrontRay| asin(ray.ray.direction.y);
        let leaves = |turns: f64| radians(tilt) - wedge_rad - asin(INDEX * sin_cos(inside - turns * wedge_rad).0);
        let (straight, doubled) = (angle(&axis(parameters.clone())), angle(&doubled_axis(parameters)));
        assert!((straight.abs() - leaves(1.0).abs()).abs() < 1e-13, "{tilt}: {straight} against {}", leaves(1.0));
        assert!((doubled.abs() - leaves(3.0).abs()).abs() < 1e-13, "{tilt}: {doubled} against {}", leaves(3.0));
        // To first order the images are 2 w √(n² − sin² θ)/cos θ apart (Ackermann 1940s; UN R43 annex 3, secondary image).
        let apart = 2.0 * wedge_rad * INDEX * inner_cosine / c;
        assert!(((doubled - straight).abs() / apart - 1.0).abs() < 1e-2, "{tilt}: {} {apart}", doubled - straight);
    }
}

#[test]
fn absorption_follows_the_path_in_the_glass() {
    let tint = |tau| Some(Tint { transmittance: Curve::Constant(tau), thickness_mm: None });
    let tinted = WindscreenParameters { tint: tint(0.8), ..plate(60.0) };
    let (s, _) = sin_cos(radians(60.0));
    let longer = 1.0 / (1.0 - s * s / (INDEX * INDEX)).sqrt();
    let ratio = weight_fraction(&axis(tinted.clone())) / weight_fraction(&axis(plate(60.0)));
    assert!((ratio - pow(0.8, longer)).abs() < 1e-13, "{ratio}");
    // The double image passes three times.
    let ratio = weight_fraction(&doubled_axis(tinted)) / weight_fraction(&doubled_axis(plate(60.0)));
    assert!((ratio - pow(0.8, 3.0 * longer)).abs() < 1e-13);
    let half = Some(Tint { transmittance: Curve::Constant(0.8), thickness_mm: Some(2.0 * THICK_MM) });
    let ratio =
        weight_fraction(&axis(WindscreenParameters { tint: half, ..plate(0.0) })) / weight_fraction(&axis(plate(0.0)));
    assert!((ratio - 0.8_f64.sqrt()).abs() < 1e-14);
}

/// Mean weight over stratified pupil samples.
fn mean_sr(front: &Front, lens: &Lens, s_mm: DVec2, side: u32) -> f64 {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
    let samples = (0..side * side).map(|i| DVec2::new(at(i % side), at(i / side)));
    let rays = samples.filter_map(|u| front.ray(lens, s_mm, u, 550.0));
    rays.map(|ray| ray.ray.weight_sr).sum::<f64>() / f64::from(side * side)
}

#[test]
fn under_uniform_light_a_pixel_gets_both_ways_whatever_their_shares() {
    let thin = ThinParameters { focal_length_mm: 25.0, f_number: 2.0, focus_distance_m: 10.0, transmittance: 1.0 };
    let lens = Lens::thin(thin).expect("a lens");
    let s_mm = DVec2::new(3.0, -2.0);
    let clear = |side: u32| {
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
        let samples = (0..side * side).map(|i| DVec2::new(at(i % side), at(i / side)));
        samples.filter_map(|u| lens.ray(s_mm, u, 550.0)).map(|ray| ray.weight_sr).sum::<f64>() / f64::from(side * side)
    };
    // A face that transmits everything preserves the étendue.
    let open = WindscreenParameters { coating: Coating::Constant(1.0), ..plate(55.0) };
    assert!((mean_sr(&front(open.clone()), &lens, s_mm, 32) / clear(32) - 1.0).abs() < 1e-12);
    // A constant coating of transmittance T: T² (1 + (1 − T)²).
    let t: f64 = 0.7;
    for fraction in [None, Some(0.125), Some(0.5)] {
        let coated =
            WindscreenParameters { coating: Coating::Constant(t), double_image_fraction: fraction, ..open.clone() };
        let mean = mean_sr(&front(coated), &lens, s_mm, 64) / clear(64);
        let expected = t * t * (1.0 + (1.0 - t) * (1.0 - t));
        // The strata of the rescaled sample are not exactly uniform if the fraction is not a multiple of them: 1/64 of the split.
        assert!((mean / expected - 1.0).abs() < 0.003, "{fraction:?}: {mean} against {expected}");
    }
}

#[test]
fn curved_glass_of_constant_thickness_is_a_weak_negative_lens() {
    // A concentric shell: power (n − 1)²t/(n R₁ R₂) − … = −(n − 1) t/(n R (R + t)) to all orders on the axis.
    let radius_mm = 3000.0;
    let shell = WindscreenParameters { radius_across_mm: radius_mm, radius_upright_mm: radius_mm, ..plate(0.0) };
    let front = front(shell);
    let power = -(INDEX - 1.0) * THICK_MM / (INDEX * radius_mm * (radius_mm + THICK_MM));
    let slope = 1e-3;
    let ray = front.ray(&pinhole(), DVec2::new(6.0 * slope, 0.0), DVec2::splat(0.5), 550.0).expect("a ray").ray;
    // Both principal planes go through the common centre of curvature, 2 700 mm behind the pupil: there the ray has the height −2 700 mm · slope, and
    // its slope changes by −power times that (to third order in the slope).
    let change = ray.direction.x / ray.direction.z - slope;
    let expected = power * (radius_mm - 300.0) * slope;
    assert!((change / expected - 1.0).abs() < 1e-4, "{change} against {expected}");
}

#[test]
fn rays_that_do_not_meet_the_glass_pass_it() {
    let sideways = WindscreenParameters {
        placement: Placement::with_rotation_deg(DVec3::new(0.0, 0.0, 300.0), [80.0, 0.0, 0.0]),
        double_image_fraction: Some(0.25),
        ..plate(0.0)
    };
    let (front, lens) = (front(sideways), pinhole());
    // 15° downwards is 5° from the other side of glass at 10° to the axis.
    let down = DVec2::new(0.0, 6.0 * 0.268);
    let ray_at = |u: f64| front.ray(&lens, down, DVec2::new(u, 0.5), 550.0);
    assert!(ray_at(0.1).is_none(), "no double image of what passes by");
    let weight = ray_at(0.9).expect("it passes").ray.weight_sr;
    let bare = lens.ray(down, DVec2::splat(0.5), 550.0).expect("a ray").weight_sr;
    assert!((0.75 * weight / bare - 1.0).abs() < 1e-15, "three quarters of the samples carry it all");
}

#[test]
fn glass_that_cannot_be_is_refused() {
    let raster = Raster::new(80, 80, DVec2::splat(0.1), DVec2::splat(40.0)).expect("a raster");
    let check =
        |placement: Placement| front(WindscreenParameters { placement, ..plate(0.0) }).check(&pinhole(), &raster);
    assert_eq!(check(Placement::with_rotation_deg(DVec3::new(0.0, 0.0, 300.0), [60.0, 0.0, 0.0])), Ok(()));
    assert_eq!(check(Placement::with_rotation_deg(DVec3::new(0.0, 0.0, -1.0), [0.0; 3])), Err(FrontError::ThroughLens));
    let steep = Placement::with_rotation_deg(DVec3::new(0.0, 0.0, 1.0), [60.0, 0.0, 0.0]);
    let thin = ThinParameters { focal_length_mm: 6.0, f_number: 2.0, focus_distance_m: 10.0, transmittance: 1.0 };
    let wide = Lens::thin(thin).expect("a lens");
    let close = front(WindscreenParameters { placement: steep, ..plate(0.0) });
    assert_eq!(close.check(&wide, &raster), Err(FrontError::ThroughLens), "a pupil of 1.5 mm reaches through");
    let refused = |parameters| Windscreen::new(parameters).expect_err("no glass").to_string();
    assert!(refused(WindscreenParameters { layers: vec![], ..plate(0.0) }).contains("no layers"));
    let dark = Some(Tint { transmittance: Curve::Constant(0.0), thickness_mm: None });
    assert!(refused(WindscreenParameters { tint: dark, ..plate(0.0) }).contains("internal_transmittance"));
    assert!(
        refused(WindscreenParameters { double_image_fraction: Some(1.0), ..plate(0.0) })
            .contains("double_image_sample_fraction")
    );
    assert!(refused(WindscreenParameters { wedge_rad: 1.0, ..plate(0.0) }).contains("wedge_mrad is 1000"));
}
