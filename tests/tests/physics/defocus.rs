//! Depth of field behind stored radiance against rays through the lens: a near panel in front of a chequered wall.

use etendue_tests::Job;

const WIDTH: usize = 60;
const HEIGHT: usize = 40;

/// A fast thick lens whose front rim clips, focused between panel and wall: blurs of 9.0 px and 4.2 px.
fn job(render: &str) -> Job {
    let checkerboard_value = |i: usize| if (i % 32 + i / 32).is_multiple_of(2) { 1.0 } else { 0.2 };
    Job::new(format!(
        r#"
        [scene]
        textures = [{{ name = "chequers", file = "chequers.hdr", encoding = "linear" }}]
        materials = [
            {{ name = "wall", type = "emitter", emission = {{ luminance_cd_m2 = 1000, illuminant = "E", texture = "chequers" }} }},
            {{ name = "panel", type = "emitter", emission = {{ luminance_cd_m2 = 500, illuminant = "E" }} }},
        ]
        [[scene.objects]]
        name = "wall"
        shape = {{ type = "quad", size_m = [2, 2] }}
        material = "wall"
        position_m = [5, 0, 0]
        rotation_deg = [0, -90, 0]
        [[scene.objects]]
        name = "panel"
        shape = {{ type = "quad", size_m = [0.03, 0.03] }}
        material = "panel"
        position_m = [0.6, 0.015, 0.005]
        rotation_deg = [0, -90, 0]
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        [cameras.lens]
        type = "thick"
        focal_length_mm = 35
        f_number = 1.4
        focus_distance_m = 1.5
        constant_pupil = "exit"
        front_aperture = {{ position_mm = -30, radius_mm = 12.6 }}
        [cameras.sensor]
        width_px = {WIDTH}
        height_px = {HEIGHT}
        pixel_pitch_um = 100
        [render]
        spp = 1024
        replicates = 16
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        {render}
        [output]
        irradiance = true
        "#
    ))
    .with_image("chequers.hdr", 32, 32, (0..1024).map(|i| [checkerboard_value(i); 3]).collect())
}

/// Irradiance behind stored radiance.
fn at_pupil(method: &str) -> Vec<f32> {
    let light = job(&format!("route = \"pupil\"\ndepth_of_field = {method}")).shot().light();
    light.irradiance.expect("irradiance").plane(0).expect("in memory").samples().to_vec()
}

/// Mean difference of two pictures over the mean of the first.
fn apart(a: &[f32], b: &[f32]) -> f64 {
    let sum = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>();
    sum(&mut a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs()))) / sum(&mut a.iter().map(|a| f64::from(*a)))
}

#[test]
fn a_panel_before_a_wall_is_blurred_as_through_the_lens() {
    let through = job("route = \"lens\"").shot().irradiance();
    // Noise: standard errors of a pixel through the lens, mean over the picture, times √(2/π).
    let mean = through.mean.iter().map(|e| f64::from(*e)).sum::<f64>();
    let noise = 0.8 * through.variance.iter().map(|v| f64::from(*v).sqrt()).sum::<f64>() / mean;
    let physical = apart(&through.mean, &at_pupil("\"physical\""));
    let sharp = apart(&through.mean, &at_pupil("\"none\""));
    // Near edges pixels hold both things and one distance, and chequers blur by little more than a pixel, which is all that
    // pixels can tell: 2 % of the mean where a sharp picture is wrong by more than 6 %.
    assert!(noise < 0.02, "{noise}");
    assert!(physical < 0.02 + noise, "{physical}, noise {noise}");
    assert!(sharp > 0.06, "{sharp}");
    let light = |e: &[f32]| e.iter().map(|e| f64::from(*e)).sum::<f64>();
    let full = light(&at_pupil("\"physical\"")) / light(&through.mean);
    // Light is kept but for what blurs move over the picture's edges, where the chequers change.
    assert!((full - 1.0).abs() < 0.005, "{full}");
    let fast = apart(&through.mean, &at_pupil("{ fast = { near_m = [0.6, 1.2], blur_px = 9 } }"));
    assert!(fast < sharp && fast > physical, "{fast} between {physical} and {sharp}");
}
