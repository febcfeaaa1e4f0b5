//! Scenes as bright as the world is: daylight and a lit road at night.

use core::f64::consts::PI;
use etendue_core::maths::f64::{sin, sin_cos};
use etendue_io::photometry::read_photometry;
use etendue_scene::asset::PhotometryAsset;
use etendue_spectra::sky::sun;
use etendue_tests::Job;
use glam::DVec3;
use std::path::Path;

/// Bands of 10 nm, as the luminance needs them: of daylight and white LEDs it is right to some 1e-3.
const VISIBLE: &str = "wavelength_range_nm = [380, 780]\nband_width_nm = 10";

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Turbidity 2, the sun at 60°.
const CLEAR_DAY: &str =
    "[scene.environment]\ntype = \"sky\"\nturbidity = 2\nsun_elevation_deg = 60\nsun_azimuth_deg = 30";

/// Illuminance, lx, of level ground under a clear sky, from the luminance of what is white and matt.
fn on_the_ground(sun: bool) -> f64 {
    let shot = Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 5]
        look_at_m = [0, 0, 0]
        up = [1, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = 10, f_number = 8 }}
        sensor = {{ width_px = 8, height_px = 8, pixel_pitch_um = 100 }}
        [render]
        spp = 512
        replicates = 16
        {VISIBLE}
        [[scene.materials]]
        name = "white"
        type = "diffuse"
        reflectance = 1
        [[scene.objects]]
        name = "ground"
        shape = {{ type = "quad", size_m = [50, 50] }}
        material = "white"
        {CLEAR_DAY}
        sun = {sun}
        "#
    ))
    .shot();
    PI * mean(&shot.luminance())
}

#[test]
fn a_clear_sun_at_60_degrees_gives_85_to_110_klx() {
    let (both, sky) = (on_the_ground(true), on_the_ground(false));
    assert!((85e3..=110e3).contains(&both), "{both} lx");
    // The sky's part alone: 8 to 20 klx in clear air.
    assert!((8e3..=20e3).contains(&sky), "{sky} lx");
    // Together they are the model's: scatter of 64 × 512 samples of the sky and of 4 wavelengths each, 0.3 %.
    let direct =
        etendue_spectra::observer::luminance(&sun::normal_irradiance(2.0, 60f64.to_radians()).expect("in range"));
    let expected = direct * sin(60f64.to_radians()) + sky;
    assert!((both / expected - 1.0).abs() < 0.01, "{both} lx for {expected}");
}

#[test]
fn the_sun_s_disc_is_as_bright_as_the_sun() {
    const SIDE: usize = 24;
    let at = |azimuth_deg: f64, elevation_deg: f64| {
        let ((sa, ca), (se, ce)) = (sin_cos(azimuth_deg.to_radians()), sin_cos(elevation_deg.to_radians()));
        DVec3::new(ce * ca, ce * sa, se) * 1000.0
    };
    // 1 m of focal length and 24 × 0.4 mm: 0.55°, a little more than the disc.
    let shot = Job::new(format!(
        r#"
        [[cameras]]
        name = "tele"
        position_m = [0, 0, 0]
        look_at_m = {:?}
        lens = {{ type = "pinhole", focal_length_mm = 1000, f_number = 8 }}
        sensor = {{ width_px = {SIDE}, height_px = {SIDE}, pixel_pitch_um = 400 }}
        [render]
        spp = 256
        replicates = 16
        {VISIBLE}
        [scene]
        {CLEAR_DAY}
        "#,
        at(30.0, 60.0).to_array()
    ))
    .shot();
    let luminance = shot.luminance();
    // The four pixels about the centre, within 6 % of the radius of it.
    let middle = [(11, 11), (11, 12), (12, 11), (12, 12)].map(|(x, y)| luminance[x + SIDE * y]);
    let centre = mean(&middle);
    assert!((centre / 1.6e9 - 1.0).abs() < 0.03, "centre: {centre} cd/m²");
    // All of the disc's light, over the disc: pixels are 1.6e-7 sr.
    let light: f64 = luminance.iter().sum::<f64>() * 0.4e-3 * 0.4e-3;
    let disc =
        PI * sin((0.5 * sun::ANGULAR_DIAMETER_DEG).to_radians()) * sin((0.5 * sun::ANGULAR_DIAMETER_DEG).to_radians());
    let mean_luminance = light / disc;
    assert!((mean_luminance / 1.3e9 - 1.0).abs() < 0.03, "mean of the disc: {mean_luminance} cd/m²");
}

/// The street lamp of the scenes: 6 000 lm, LM-63, type C.
fn street_lamp() -> PhotometryAsset {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the workspace");
    read_photometry(&root.join("scenes/street/street-lamp.ies")).unwrap_or_else(|error| panic!("{error}"))
}

/// Mean luminance of a field of the road between two lamps, cd/m²: lamps of 6 klm 7.06 m high, every 25 m beside a road of dry
/// asphalt 7 m wide.
fn road_at_night() -> f64 {
    let lamps: Vec<String> =
        (-4..=4).map(|i| format!("{{ position_m = [{}, -4.65, 7.06] }}", 25.0 * f64::from(i) + 12.5)).collect();
    // From 50 m above, pixels are 1 m on the road: 25 × 7 of them.
    let shot = Job::new(format!(
        r#"
        [[cameras]]
        name = "above"
        position_m = [0, 0, 50]
        look_at_m = [0, 0, 0]
        up = [0, 1, 0]
        lens = {{ type = "pinhole", focal_length_mm = 10, f_number = 8 }}
        sensor = {{ width_px = 25, height_px = 7, pixel_pitch_um = 200 }}
        [render]
        spp = 64
        replicates = 4
        {VISIBLE}
        [[scene.materials]]
        name = "asphalt"
        preset = "asphalt_dry"
        [[scene.objects]]
        name = "road"
        shape = {{ type = "quad", size_m = [400, 7] }}
        material = "asphalt"
        [[scene.lights]]
        name = "street lamps"
        type = "measured"
        file = "street_lamp.ies"
        illuminant = "LED-B3"
        instances = [{}]
        "#,
        lamps.join(", ")
    ))
    .with_lamp("street_lamp.ies", street_lamp())
    .shot();
    mean(&shot.luminance())
}

#[test]
fn a_lit_road_at_night_has_0_3_to_2_cd_m2() {
    let road = road_at_night();
    assert!((0.3..=2.0).contains(&road), "{road} cd/m²");
}
