//! Light that a smooth surface throws on a matt one: all of it, or, where the job leaves it out, none of that of suns
//! and lamps but the tails of the highlight, and all of that of the surroundings.
//!
//! A silver wall stands across the sun's light, so that every point of the ground sees the sun twice: directly and in
//! the wall. With at most two scatterings nothing else arrives.

use core::f64::consts::PI;
use etendue_core::maths::f64::sin;
use etendue_testkit::judge::{is_near, mean_and_error};
use etendue_tests::{Job, Shot};

const REFLECTANCE: f64 = 0.5;
const ELEVATION_DEG: f64 = 45.0;
const WITH_CAUSTICS: &str = "caustics = true";
const WITHOUT_CAUSTICS: &str = "caustics = false";

fn shot(light: &str, caustics: &str) -> Shot {
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 10]
        look_at_m = [0, 0, 0]
        up = [1, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = 10, f_number = 8 }}
        sensor = {{ width_px = 8, height_px = 8, pixel_pitch_um = 1000 }}
        [render]
        spp = 2048
        replicates = 16
        max_bounces = 2
        {caustics}
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        [[scene.materials]]
        name = "matt"
        type = "diffuse"
        reflectance = {REFLECTANCE}
        [[scene.materials]]
        name = "silver"
        type = "conductor"
        metal = "Ag"
        alpha = 0.001
        [[scene.objects]]
        name = "ground"
        shape = {{ type = "quad", size_m = [200, 200] }}
        material = "matt"
        [[scene.objects]]
        name = "wall"
        shape = {{ type = "quad", size_m = [200, 200] }}
        material = "silver"
        position_m = [-20, 0, 0]
        rotation_deg = [0, 90, 0]
        {light}
        "#
    ))
    .shot()
}

/// A sun over +x, 20° across so that chance finds it, of 1 W·m⁻²·nm⁻¹ in the mean over all legal wavelengths.
fn sunlit(caustics: &str) -> (f64, f64) {
    let sun = format!(
        "[[scene.lights]]\ntype = \"sun\"\nname = \"sun\"\nelevation_deg = {ELEVATION_DEG}\nazimuth_deg = 0\n\
         angular_diameter_deg = 20\nirradiance_w_m2 = 800\ntemperature_k = 20000\n"
    );
    mean_and_error(shot(&sun, caustics).radiance().estimate())
}

#[test]
fn left_out_the_ground_sees_the_sun_once_and_followed_twice() {
    let (without, with) = (sunlit(WITHOUT_CAUSTICS), sunlit(WITH_CAUSTICS));
    // The normal irradiance of the band: what the wall-less ground of the same job would tell.
    let bare = etendue_spectra::illuminant::blackbody(20_000.0);
    let normal = bare.band_mean(500.0, 600.0) * 800.0 / bare.integral(300.0, 1100.0);
    let once = REFLECTANCE / PI * normal * sin(ELEVATION_DEG.to_radians());
    // The tails of the wall's highlight fall below the density of 4/sr that counts as smooth and are kept: a GGX lobe of
    // small α has the density α²/4πθ⁴ at the half angle θ and the share α²/θ² beyond it, so α √(16π) = 0.71 % at most.
    let tails = 0.0071;
    // 64 pixels of 16 replicates: hundreds of degrees of freedom.
    let (middle, allowance) = (once * (1.0 + 0.5 * tails), once * (0.5 * tails + 1e-4));
    assert!(is_near(without, middle, allowance, 500.0), "{without:?} for {once}");
    // Silver reflects 0.96 to 0.99 at 45° between 500 and 600 nm (Johnson and Christy 1972).
    assert!(is_near(with, 1.975 * once, 0.015 * once, 500.0), "{with:?} for {once}");
    assert!(with.1 < 0.02 * once, "a test that could not fail would be of no use: {with:?}");
}

#[test]
fn environment_light_is_unchanged_to_the_bit() {
    let sky = "[scene.environment]\ntype = \"uniform\"\nradiance_w_m2_sr_nm = 1\n";
    assert_eq!(shot(sky, WITHOUT_CAUSTICS).radiance().mean, shot(sky, WITH_CAUSTICS).radiance().mean);
}

/// The wall's highlight widened to some tens of degrees: a part of the light lands elsewhere (the wall ends 100 m above, and the lobe reaches over the
/// horizon), most of it here, less noisy than when chance finds it.
#[test]
fn widened_lobes_bring_the_light_by_many_samples() {
    let (without, narrow, wide) = (sunlit(WITHOUT_CAUSTICS), sunlit(WITH_CAUSTICS), sunlit("regularize = true"));
    let ratio = (wide.0 - without.0) / (narrow.0 - without.0);
    assert!((0.5..1.0).contains(&ratio), "{ratio}: {without:?} {narrow:?} {wide:?}");
    assert!(wide.1 < 0.5 * narrow.1, "{wide:?} {narrow:?}");
    assert_eq!(sunlit("caustics = false\n        regularize = true"), without, "left out is left out");
}
