//! Sun and sky as seen by a camera, against the model of Hosek and Wilkie.

use etendue_core::maths::f64::{sin, sin_cos, tan};
use etendue_spectra::sky::{SkyModel, sun};
use etendue_tests::{Job, eye};
use glam::DVec3;

const TURBIDITY: f64 = 2.5;
const ALBEDO: f64 = 0.3;
const ELEVATION_DEG: f64 = 35.0;
const AZIMUTH_DEG: f64 = 50.0;

/// A world with nothing in it but this sky, seen in one band of 2 nm about a wavelength.
fn job(cameras: &str, with_sun: bool, nm: u32) -> Job {
    Job::new(format!(
        r#"
        {cameras}
        [render]
        spp = 16
        replicates = 1
        wavelength_range_nm = [{}, {}]
        band_width_nm = 2
        [scene.environment]
        type = "sky"
        turbidity = {TURBIDITY}
        ground_albedo = {ALBEDO}
        sun_elevation_deg = {ELEVATION_DEG}
        sun_azimuth_deg = {AZIMUTH_DEG}
        sun = {with_sun}
        "#,
        nm - 1,
        nm + 1
    ))
}

/// The unit direction at an azimuth from +x towards +y and an elevation.
fn towards(azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    let ((sin_a, cos_a), (sin_e, cos_e)) = (sin_cos(azimuth_deg.to_radians()), sin_cos(elevation_deg.to_radians()));
    DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e)
}

fn band_mean(nm: u32, radiance_at: impl Fn(f64) -> f64) -> f64 {
    (0..20).map(|i| radiance_at(f64::from(nm) - 0.95 + 0.1 * f64::from(i))).sum::<f64>() / 20.0
}

fn assert_near(actual: f32, expected: f64, tolerance: f64, subject: &str) {
    assert!((f64::from(actual) / expected - 1.0).abs() < tolerance, "{subject}: {actual} for {expected}");
}

#[test]
fn the_sun_s_radiance_is_the_model_s_at_its_centre_and_towards_its_limb() {
    // A telephoto lens of 1 m: the disc is 9.3 mm across. Nine pixels of 1.1 mm, from limb to limb.
    const PITCH_MM: f64 = 1.1;
    let camera = format!(
        "[[cameras]]\nname = \"tele\"\nposition_m = [0, 0, 0]\nlook_at_m = {:?}\n\
         lens = {{ type = \"pinhole\", focal_length_mm = 1000, f_number = 8 }}\n\
         sensor = {{ width_px = 9, height_px = 1, pixel_pitch_um = 1100, fill_factor = 1e-6, principal_point_px = [4.5, 0.5] }}\n",
        (towards(AZIMUTH_DEG, ELEVATION_DEG) * 1000.0).to_array()
    );
    let elevation = ELEVATION_DEG.to_radians();
    let centre = sun::radiance(TURBIDITY, elevation).expect("in range");
    let sky = SkyModel::new(TURBIDITY, ALBEDO, elevation).expect("in range");
    let edge = tan((0.5 * sun::ANGULAR_DIAMETER_DEG).to_radians());
    for nm in [450, 550, 680] {
        let radiances = job(&camera, true, nm).shot().radiance().mean;
        let sky = f64::from(sky.radiance(sin(elevation), 1.0).at(nm as f32));
        for (i, actual) in radiances.iter().enumerate() {
            // Sine over sine and tangent over tangent differ by 1e-5 in so small a disc.
            let lateral = PITCH_MM * 1e-3 * (i as f64 - 4.0) / edge;
            let mu = (1.0 - lateral * lateral).max(0.0).sqrt();
            let disc = band_mean(nm, |nm| f64::from(centre.at(nm as f32)) * sun::limb_darkening(nm, mu));
            // Directions in f32, 6e-8 of 4.7e-3, move the limb by 1e-5, which its slope at µ = 0.33 makes 5e-5;
            // 16 wavelengths in strata of 2 nm on a spectrum that changes by up to 1 % a nm: 5e-4.
            assert_near(*actual, disc + sky, 1e-3, &format!("{nm} nm, pixel {i}, µ = {mu:.3}"));
        }
        assert!(
            radiances[4] > 1.25 * radiances[0] && radiances[4] > 1.25 * radiances[8],
            "{nm} nm: the limb is darker"
        );
    }
}

#[test]
fn the_sky_s_radiance_is_the_model_s() {
    let directions =
        [(50.0, 90.0), (50.0, 36.0), (60.0, 30.0), (170.0, 60.0), (230.0, 5.0), (-40.0, 1.0), (48.0, 12.0)];
    let eyes: String = (0..)
        .zip(directions)
        .map(|(i, (azimuth, elevation))| eye(&format!("eye{i}"), DVec3::ZERO, towards(azimuth, elevation) * 100.0))
        .collect();
    let sunward = towards(AZIMUTH_DEG, ELEVATION_DEG);
    let model = SkyModel::new(TURBIDITY, ALBEDO, ELEVATION_DEG.to_radians()).expect("in range");
    for nm in [360, 450, 550, 680, 900] {
        for (shot, (azimuth, elevation)) in job(&eyes, false, nm).shots().iter().zip(directions) {
            let direction = towards(azimuth, elevation);
            let spectrum = model.radiance(direction.z, direction.dot(sunward));
            let expected = band_mean(nm, |nm| f64::from(spectrum.at(nm as f32)));
            // The tables of the sky as surroundings: 1e-3. Wavelengths as above; continued beyond 720 nm by ASTM G-173,
            // whose water bands change faster.
            let label = format!("{nm} nm at {azimuth}°, {elevation}°");
            assert_near(shot.radiance().mean[0], expected, if nm > 720 { 5e-3 } else { 2e-3 }, &label);
        }
    }
}
