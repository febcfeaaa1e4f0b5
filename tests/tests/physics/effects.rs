//! Irradiance effects behind both routes.

use etendue_optics::effects::{Glare, GlareParameters};
use etendue_tests::Job;
use glam::DVec2;

const WIDTH: usize = 16;
const HEIGHT: usize = 12;
const PITCH_MM: f64 = 0.25;

/// A pinhole before a dark room with a lamp on the left, in a picture of this size and with these effects.
fn job(width: usize, height: usize, route: &str, effects: &str) -> Job {
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        lens = {{ focal_length_mm = 6, type = "pinhole", f_number = 4 }}
        sensor = {{ width_px = {width}, height_px = {height}, pixel_pitch_um = 250 }}
        {effects}
        [render]
        spp = 64
        replicates = 2
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        route = "{route}"
        [output]
        irradiance = true
        variance = true
        [scene]
        materials = [{{ name = "lamp", type = "emitter", emission = {{ luminance_cd_m2 = 1000, illuminant = "E" }} }}]
        [[scene.objects]]
        name = "lamp"
        shape = {{ type = "quad", size_m = [0.2, 0.2] }}
        material = "lamp"
        position_m = [2, 0.9, 0.1]
        rotation_deg = [0, -90, 0]
        "#
    ))
}

/// Irradiance of the only band.
fn irradiance(job: &Job) -> Vec<f32> {
    let cube = job.shot().light().irradiance.expect("kept");
    cube.plane(0).expect("in memory").samples().to_vec()
}

const GLARE: &str =
    "effects = { margin = 0.5, glare = { scatter = 0.1, core_um = 500, exponent = 2.5, reach_mm = 6 } }";

#[test]
fn a_lamp_beyond_the_picture_veils_it_by_the_kernel_on_both_routes() {
    let wide = irradiance(&job(2 * WIDTH, 2 * HEIGHT, "lens", ""));
    let parameters = GlareParameters { scatter: 0.1, core_um: 500.0, exponent: 2.5, reach_mm: Some(6.0) };
    let glare = Glare::new(parameters).expect("legal");
    let margin = DVec2::new(WIDTH as f64, HEIGHT as f64) / 2.0;
    let veil = |x: usize, y: usize| {
        let position = DVec2::new(x as f64, y as f64) + margin;
        let from = |i: usize| DVec2::new((i % (2 * WIDTH)) as f64, (i / (2 * WIDTH)) as f64);
        let density = |i: usize| glare.density_per_mm2(PITCH_MM * (position - from(i)).length());
        (0..wide.len()).map(|i| f64::from(wide[i]) * 0.1 * density(i) * PITCH_MM * PITCH_MM).sum::<f64>()
    };
    for route in ["lens", "pupil"] {
        let dark = irradiance(&job(WIDTH, HEIGHT, route, ""));
        assert!(dark.iter().all(|e| *e == 0.0), "the lamp is seen");
        let veiled = irradiance(&job(WIDTH, HEIGHT, route, GLARE));
        for (x, y) in [(1, 5), (8, 2), (15, 11)] {
            let (actual, expected) = (f64::from(veiled[y * WIDTH + x]), veil(x, y));
            // The lamp's border is sampled: 64 samples a pixel, a dozen border pixels; the kernel's mean over a pixel differs
            // from its middle by less than 1 %.
            assert!((actual / expected - 1.0).abs() < 0.03, "{route} ({x}, {y}): {actual} for {expected}");
        }
    }
}

#[test]
fn an_effect_that_is_switched_off_changes_no_bit() {
    let off = "effects = { glare = { scatter = 0, core_um = 10, exponent = 3 } }";
    let (with, without) = (job(WIDTH, HEIGHT, "lens", off), job(WIDTH, HEIGHT, "lens", ""));
    assert_eq!(irradiance(&with), irradiance(&without));
}

/// Coma, whose function is half a pixel wide and to one side, by displaced samples and by the film.
#[test]
fn displaced_samples_put_light_where_the_film_puts_it() {
    let small = |effects: &str| {
        let job = job(WIDTH, HEIGHT, "lens", effects).replaced("pixel_pitch_um = 250", "pixel_pitch_um = 4");
        let job = job.replaced("focal_length_mm = 6", "focal_length_mm = 0.096").replaced("spp = 64", "spp = 256");
        irradiance(&job.replaced("position_m = [2, 0.9, 0.1]", "position_m = [2, 0.3, 0.1]"))
    };
    let coma = "wavefront = [{ noll = 8, rms_um = 0.08 }], patches = [1, 1], reach_mm = 0.02";
    let job_with = |by: &str| small(&format!("effects = {{ margin = 0.5, psf = {{ {coma}, spread_by = \"{by}\" }} }}"));
    let moments = |light: &[f32]| {
        let sum: f64 = light.iter().map(|e| f64::from(*e)).sum();
        let at = |i: usize| DVec2::new((i % WIDTH) as f64, (i / WIDTH) as f64);
        let first: DVec2 = light.iter().enumerate().map(|(i, e)| f64::from(*e) * at(i)).sum();
        (sum, first / sum)
    };
    let (samples, film, without_effects) = (job_with("samples"), job_with("film"), small(""));
    let ((sum, at), (film_sum, film_at), (plain_sum, plain_at)) =
        (moments(&samples), moments(&film), moments(&without_effects));
    // All light but what leaves the picture; 256 samples of a lamp that fills few pixels.
    assert!(
        (sum / film_sum - 1.0).abs() < 0.01 && (sum / plain_sum - 1.0).abs() < 0.02,
        "{sum} {film_sum} {plain_sum}"
    );
    assert!((film_at - plain_at).length() > 0.15, "coma is to one side: {film_at} {plain_at}");
    assert!((at - film_at).length() < 0.05, "{at} for {film_at}, without {plain_at}");
}
