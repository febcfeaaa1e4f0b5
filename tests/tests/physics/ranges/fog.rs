//! Lamps inside fog, seen along a ray that passes them closely: light that is scattered once, against integrals along the ray.

use etendue_core::Bands;
use etendue_core::maths::f64::{cos, exp, hypot, sin};
use etendue_spectra::observer;
use etendue_testkit::page::Row;
use etendue_tests::Job;

/// Extinction of the fog, 1/m; nothing is absorbed.
const BETA: f64 = 0.3;
/// Radius of the lamp that has a size, m.
const RADIUS_M: f64 = 0.25;

/// A camera that looks along x through fog without end, 4 × 4 pixels of 0.05 mrad; paths are scattered once.
fn foggy(lamp: &str) -> Job {
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = 20, f_number = 8 }}
        sensor = {{ width_px = 4, height_px = 4, pixel_pitch_um = 1 }}
        [render]
        spp = 2048
        max_bounces = 1
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        [output]
        irradiance = true
        [scene]
        materials = [{{ name = "lamp", type = "emitter", emission = {{ radiance_w_m2_sr_nm = 1 }} }}]
        media = [{{ name = "fog", extinction_per_m = {BETA}, albedo = 1, phase = {{ type = "isotropic" }} }}]
        {lamp}
        "#
    ))
}

/// Mean radiance of all pixels, W·m⁻²·sr⁻¹·nm⁻¹.
fn radiance(job: &Job) -> f64 {
    let samples = job.shot().radiance().mean;
    samples.iter().map(|value| f64::from(*value)).sum::<f64>() / samples.len() as f64
}

/// The integral of a function by Simpson's rule in 2 n steps.
fn integral(function: impl Fn(f64) -> f64, from: f64, to: f64, n: u32) -> f64 {
    let h = (to - from) / f64::from(2 * n);
    let at = |i: u32| function(from + f64::from(i) * h);
    let pair = |i: u32| at(2 * i) + 4.0 * at(2 * i + 1) + at(2 * i + 2);
    (0..n).map(pair).sum::<f64>() * h / 3.0
}

/// ∫ β exp(−β t) S(t) dt, where S(t), of the distance m from the lamp, is what arrives at t on the ray, over 4π. Near the lamp the steps are fine.
fn scattered_once(arriving: impl Fn(f64) -> f64, [ahead_m, aside_m]: [f64; 2]) -> f64 {
    let at = |t: f64| BETA * exp(-BETA * t) * arriving(hypot(t - ahead_m, aside_m)) / (4.0 * core::f64::consts::PI);
    let near = (20.0 * aside_m).min(ahead_m);
    integral(at, 0.0, ahead_m - near, 4000)
        + integral(at, ahead_m - near, ahead_m + near, 4000)
        + integral(at, ahead_m + near, 100.0, 4000)
}

/// A sphere of radiance 1: ∫ exp(−β s) over the solid angle in which it is seen, s as far as its surface there.
fn sphere_light(distance_m: f64) -> f64 {
    // sin α = (a/d) sin u, u from 0 to 90°: the surface is d cos α − a cos u away, which is smooth to the rim.
    let by_place = |u: f64| {
        let sine = RADIUS_M * sin(u) / distance_m;
        let cosine = (1.0 - sine * sine).sqrt();
        let to_surface = distance_m * cosine - RADIUS_M * cos(u);
        exp(-BETA * to_surface) * sine * RADIUS_M * cos(u) / (distance_m * cosine)
    };
    2.0 * core::f64::consts::PI * integral(by_place, 0.0, core::f64::consts::FRAC_PI_2, 200)
}

pub(crate) fn lamps_in_fog() -> Vec<Row> {
    let scattered = "single scattering by the integral along the ray (relative error)";
    let ball = |aside_m: f64| {
        let lamp = format!(
            "[[scene.objects]]\nname = \"lamp\"\nmaterial = \"lamp\"\nposition_m = [3, {aside_m}, 0]\nshape = {{ type = \"sphere\", radius_m = {RADIUS_M} }}"
        );
        radiance(&foggy(&lamp)) / scattered_once(sphere_light, [3.0, aside_m]) - 1.0
    };
    let point = "[[scene.lights]]\nname = \"lamp\"\ntype = \"point\"\nposition_m = [3, 0.01, 0]\nilluminant = \"E\"\nintensity_cd = 100\n";
    // Of illuminant E a candela is so many W/sr in each nanometre.
    let bands = Bands::covering(300.0, 1100.0, 5.0).expect("legal bands");
    let lumens_per_watt = observer::xyz_of_bands(&vec![1.0; bands.count()], bands)[1];
    let point_lamp = |distance_m: f64| 100.0 / lumens_per_watt * exp(-BETA * distance_m) / (distance_m * distance_m);
    let point = radiance(&foggy(point)) / scattered_once(point_lamp, [3.0, 0.01]) - 1.0;
    let within = "a ray past a light of 0.5 m in fog";
    vec![
        Row::at_most("a ray 1 cm past a point light in fog", scattered, point.abs(), 1e-2),
        Row::at_most(&format!("{within}, 25 cm from its surface"), scattered, ball(0.5).abs(), 2e-2),
        Row::at_most(&format!("{within}, 1 mm from its surface"), scattered, ball(0.251).abs(), 2e-2),
    ]
}
