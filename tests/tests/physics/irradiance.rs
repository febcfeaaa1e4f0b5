//! Light on a plane from lights of every kind, against closed forms.
//!
//! A matt plane of reflectance ρ under irradiance E has the radiance ρE/π in all directions; a pinhole above looks
//! straight down at it through nearly point-like pixels.

use core::f64::consts::PI;
use etendue_core::Bands;
use etendue_core::maths::f64::{sin, sin_cos};
use etendue_spectra::{illuminant, observer};
use etendue_stats::{ReplicateEstimate, planes};
use etendue_testkit::form_factor::{disc, polygon, sphere};
use etendue_testkit::judge::{SIGNIFICANCE, compare_with_truth, is_near};
use etendue_tests::{Job, Samples};
use glam::DVec3;

const REFLECTANCE: f64 = 0.5;
const HEIGHT_M: f64 = 10.0;
const SIDE_PX: usize = 8;
/// One band for all that is sampled: the draw of wavelengths adds no noise.
const ONE_BAND: &str = "wavelength_range_nm = [500, 600]\nband_width_nm = 100";

/// The plane z = 0 seen from above its point (0, −4), one pixel a metre; `light` is more of the scene.
fn plane(light: &str) -> Job {
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, -4, {HEIGHT_M}]
        look_at_m = [0, -4, 0]
        up = [1, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = 10, f_number = 8 }}
        sensor = {{ width_px = {SIDE_PX}, height_px = {SIDE_PX}, pixel_pitch_um = 1000, fill_factor = 1e-6 }}
        [render]
        spp = 256
        replicates = 16
        max_bounces = 1
        {ONE_BAND}
        [[scene.materials]]
        name = "matt"
        type = "diffuse"
        reflectance = {REFLECTANCE}
        [[scene.objects]]
        name = "ground"
        shape = {{ type = "quad", size_m = [100, 100] }}
        material = "matt"
        {light}
        "#
    ))
}

/// The point that a pixel sees: columns run towards −y (right of a view whose up is +x), rows towards −x.
fn point(pixel: usize) -> DVec3 {
    let from_middle = |k: usize| k as f64 + 0.5 - SIDE_PX as f64 / 2.0;
    DVec3::new(-from_middle(pixel / SIDE_PX), -4.0 - from_middle(pixel % SIDE_PX), 0.0)
}

fn assert_lit(samples: &Samples, irradiance: impl Fn(DVec3) -> f64, subject: &str) {
    let truth = |i: usize| REFLECTANCE / PI * irradiance(point(i));
    // Sums, densities and solid angles in f32.
    let comparison = compare_with_truth(samples.estimate(), truth, |i| 1e-5 * truth(i));
    assert!(comparison.is_ok(), "{subject}: {comparison:?}");
    // A test that could not fail would be of no use: the light of every pixel is known to 2 %.
    let largest = samples.variance.iter().zip(&samples.mean).map(|(v, m)| v.sqrt() / m).fold(0.0, f32::max);
    assert!(largest < 0.02, "{subject}: relative standard error {largest}");
}

const LAMP: &str = r#"
    [[scene.materials]]
    name = "lamp"
    type = "emitter"
    emission = { radiance_w_m2_sr_nm = 3 }
"#;

#[test]
fn a_sphere_over_a_plane() {
    for (height, radius) in [(1.5, 0.4), (3.0, 1.5), (6.0, 0.01)] {
        let ball = format!(
            "{LAMP}\n[[scene.objects]]\nname = \"ball\"\nmaterial = \"lamp\"\nposition_m = [0.5, 3, {height}]\n\
             shape = {{ type = \"sphere\", radius_m = {radius} }}"
        );
        let samples = plane(&ball).shot().radiance();
        let centre = DVec3::new(0.5, 3.0, height);
        assert_lit(&samples, |p| 3.0 * sphere(p, DVec3::Z, centre, radius), &format!("radius {radius} at {height}"));
    }
}

#[test]
fn a_rectangle_over_a_plane() {
    for (height, pitch_deg) in [(2.0, 180.0), (3.0, 160.0), (0.8, 180.0)] {
        let panel = format!(
            "{LAMP}\n[[scene.objects]]\nname = \"panel\"\nmaterial = \"lamp\"\nposition_m = [0.5, 2.2, {height}]\n\
             rotation_deg = [0, {pitch_deg}, 0]\nshape = {{ type = \"quad\", size_m = [1.5, 1.2] }}"
        );
        let samples = plane(&panel).shot().radiance();
        // Pitch turns x to (cos, 0, −sin); y stays.
        let (sin, cos) = sin_cos(f64::to_radians(pitch_deg));
        let (centre, x, y) = (DVec3::new(0.5, 2.2, height), DVec3::new(cos, 0.0, -sin) * 0.75, DVec3::Y * 0.6);
        let corners = [centre - x - y, centre + x - y, centre + x + y, centre - x + y];
        // The panel's front looks down and to +x: seen points behind its plane get no light.
        let lit = |p: DVec3| 3.0 * polygon(p, DVec3::Z, &corners);
        assert_lit(&samples, lit, &format!("panel at {height}, pitch {pitch_deg}"));
    }
}

#[test]
fn the_suns_disc_gives_its_irradiance_times_the_cosine() {
    for (elevation, diameter) in [(90.0, 0.5338), (40.0, 0.5338), (3.0, 0.5338), (30.0, 20.0)] {
        // 800 W/m² shared evenly by the 800 nm of the legal range: 1 W/m²/nm.
        let sun = format!(
            "[[scene.lights]]\ntype = \"sun\"\nname = \"sun\"\nelevation_deg = {elevation}\nazimuth_deg = 30\n\
             angular_diameter_deg = {diameter}\nirradiance_w_m2 = 800\nspectrum = \"flat.csv\""
        );
        let job = plane(&sun).with_spectrum("flat.csv", &[(300.0, 1.0), (1100.0, 1.0)]);
        // A uniform disc that is wholly above the horizon lights as if all came from its middle.
        assert_lit(&job.shot().radiance(), |_| sin(f64::to_radians(elevation)), &format!("sun at {elevation}"));
    }
}

/// Mean illuminance of the ground, lx, told by the luminance of what the camera sees.
fn ground_lx(job: &Job) -> f64 {
    let shot = job.shot();
    let cube = &shot.film.radiance().expect("a cube").mean;
    let mean = |samples: &[f32]| samples.iter().map(|v| f64::from(*v)).sum::<f64>() / samples.len() as f64;
    let means: Vec<f32> = cube.planes().iter().map(|plane| mean(plane.samples()) as f32).collect();
    observer::xyz_of_bands(&means, cube.bands())[1] * PI / REFLECTANCE
}

#[test]
fn a_declared_illuminance_arrives_on_the_ground() {
    const LUX: f64 = 80_000.0;
    let bands = Bands::covering(360.0, 830.0, 5.0).expect("94 bands");
    for name in ["solar", "A", "FL11"] {
        let sun = format!(
            "[[scene.lights]]\ntype = \"sun\"\nname = \"sun\"\nelevation_deg = 40\nazimuth_deg = 120\n\
             illuminance_lx = {LUX}\nilluminant = \"{name}\""
        );
        let job = plane(&sun).replacing(ONE_BAND, "wavelength_range_nm = [360, 830]\nband_width_nm = 5");
        // What bands of 5 nm cost: the band means of observer and lamp are multiplied instead of their product
        // integrated. Computed from the spectra alone; a lamp of lines pays more than the sun, all stay below 0.5 %.
        let lamp =
            if name == "solar" { &illuminant::solar().direct } else { illuminant::by_name(name).expect("known") };
        let means: Vec<f32> = lamp.band_means(bands).iter().map(|v| *v as f32).collect();
        let band_illuminance = observer::xyz_of_bands(&means, bands)[1] / observer::luminance(lamp);
        assert!((band_illuminance - 1.0).abs() < 5e-3, "{name}: {band_illuminance}");
        // Neighbouring bands share their samples, so the error of the sum is told by independent pictures.
        let illuminances: Vec<f64> = (1..=8).map(|seed| ground_lx(&job.clone().with_seed(seed))).collect();
        let ground = ReplicateEstimate::from_replicates(&illuminances).expect("eight pictures");
        let truth = LUX * sin(40_f64.to_radians()) * band_illuminance;
        let measured = (ground.mean, ground.standard_error());
        // f32 sums.
        assert!(is_near(measured, truth, 1e-5 * truth, 7.0), "{name}: {ground:?} for {truth}");
        assert!(ground.standard_error() < 3e-3 * truth, "{name}: {ground:?}");
    }
}

#[test]
fn a_constant_picture_is_a_uniform_environment() {
    let visible = "wavelength_range_nm = [400, 700]\nband_width_nm = 50";
    let rgb = [0.8_f32, 0.5, 0.3];
    let uniform_image =
        "[scene.environment]\ntype = \"image\"\nfile = \"sky.hdr\"\nluminance_cd_m2_per_unit = 1000\nrotation_deg = 33";
    let image = plane(uniform_image)
        .replacing(ONE_BAND, visible)
        .with_image("sky.hdr", 16, 8, vec![rgb; 128])
        .shot()
        .radiance();
    // The luminance of linear sRGB: Rec. 709's row of Y.
    let luminance = 1000.0 * (0.2126 * f64::from(rgb[0]) + 0.7152 * f64::from(rgb[1]) + 0.0722 * f64::from(rgb[2]));
    let uniform = format!("[scene.environment]\ntype = \"uniform\"\nluminance_cd_m2 = {luminance}\nrgb = {rgb:?}");
    let uniform = plane(&uniform).replacing(ONE_BAND, visible).with_seed(2).shot().radiance();
    let test = planes::compare(&image.estimate(), &uniform.estimate(), SIGNIFICANCE).expect("same size");
    assert_eq!(test.verdict, planes::Verdict::Agree, "{test:?}");
    let sum = |s: &Samples| s.mean.iter().map(|v| f64::from(*v)).sum::<f64>();
    // Rec. 709's row is given to four digits: 1e-4. Scatter of the mean over 64 pixels and 256 samples: 1e-3.
    assert!((sum(&image) / sum(&uniform) - 1.0).abs() < 3e-3);
}

#[test]
fn a_disc_over_a_plane() {
    // Over the corner of what is seen: the disc's back hides no pixel, as it would over the middle.
    for (height, radius) in [(1.5, 0.4), (3.0, 1.2), (6.0, 0.05)] {
        let lamp = format!(
            "{LAMP}\n[[scene.objects]]\nname = \"disc\"\nmaterial = \"lamp\"\nposition_m = [3.5, -7.5, {height}]\n\
             rotation_deg = [0, 180, 0]\nshape = {{ type = \"disc\", radius_m = {radius} }}"
        );
        // A polygon of 256 sides and the same area as the circle: their second moments differ by 2e-9.
        let samples = plane(&lamp).shot().radiance();
        let axis = DVec3::new(3.5, -7.5, 0.0);
        assert_lit(
            &samples,
            |p| 3.0 * disc(height, (p - axis).length(), radius),
            &format!("radius {radius} at {height}"),
        );
        // The pixel below the middle is on the axis: E = π L R²/(R² + h²).
        let below = (0..64).find(|i| (point(*i) - axis).length() < 1e-9).expect("a pixel below the middle");
        let on_axis = 3.0 * PI * radius * radius / (radius * radius + height * height);
        assert!((3.0 * disc(height, (point(below) - axis).length(), radius) / on_axis - 1.0).abs() < 1e-12);
    }
}

/// A lamp's glow by its strength, and an object of it over the ground.
fn flux_lamp(level: &str, object: &str) -> Job {
    plane(&format!(
        "[[scene.materials]]\nname = \"lamp\"\ntype = \"emitter\"\nemission = {{ {level} }}\n\
         [[scene.objects]]\nname = \"lamp\"\nmaterial = \"lamp\"\nposition_m = [3.5, -7.5, 3]\n{object}"
    ))
    .with_spectrum("flat.csv", &[(300.0, 1.0), (1100.0, 1.0)])
}

#[test]
fn a_flux_is_shared_by_the_area_of_each_object() {
    let sphere = (PI, "shape = { type = \"sphere\", radius_m = 0.25 }\nscale = 2", "");
    let disc = (0.25 * PI, "shape = { type = \"disc\", radius_m = 0.5 }\nrotation_deg = [0, 180, 0]", "");
    let quad = (18.0, "shape = { type = \"quad\", size_m = [1, 2] }\nscale = 3", ", sides = \"both\"");
    for ((area, object, sides), glowing) in [(sphere, 1.0), (disc, 1.0), (quad, 2.0)] {
        // The flux that leaves with 3 W·m⁻²·sr⁻¹·nm⁻¹ over the 800 nm of the legal range: Φ = π L A.
        let watts = 3.0 * 800.0 * PI * area * glowing;
        let by_flux = format!("radiant_flux_w = {watts}, spectrum = \"flat.csv\"{sides}");
        let by_radiance = format!("radiance_w_m2_sr_nm = 3{sides}");
        let (a, b) = (flux_lamp(&by_flux, object).shot(), flux_lamp(&by_radiance, object).shot());
        let radiances = |shot: &etendue_tests::Shot| shot.radiance().mean.clone();
        // The same paths; a spectrum scaled twice in f32.
        let max_difference =
            radiances(&a).iter().zip(radiances(&b)).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f32::max);
        assert!(max_difference < 1e-6 && radiances(&a)[0] > 0.0, "{object}: {max_difference}");
    }
}

#[test]
fn a_luminous_flux_lights_by_its_lumens() {
    // A sphere of Φ lm far above the ground: E = Φ / (4 π d²) · cos θ, as of a point.
    let lamp =
        flux_lamp("luminous_flux_lm = 1000, illuminant = \"A\"", "shape = { type = \"sphere\", radius_m = 0.01 }");
    let lamp = lamp.replacing(ONE_BAND, "wavelength_range_nm = [360, 830]\nband_width_nm = 5");
    let expected: f64 = (0..64)
        .map(|i| {
            let to = DVec3::new(3.5, -7.5, 3.0) - point(i);
            1000.0 / (4.0 * PI * to.length_squared()) * (to.z / to.length())
        })
        .sum::<f64>()
        / 64.0;
    let lux = ground_lx(&lamp);
    // Noise of the spectrum's sampling: 16 384 wavelengths in all.
    assert!((lux / expected - 1.0).abs() < 0.01, "{lux} lx, expected {expected}");
}
