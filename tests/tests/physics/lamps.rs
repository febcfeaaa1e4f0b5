//! Lamps without extent on a wall, against the law of the inverse square and their own files.
//!
//! The wall stands 25 m before the lamp, as in the regulations for head lamps. The lamp is at the origin and points along
//! +x. The intensity in a direction is told by the wall's luminance there: I = E d²/cos θ = (π L/ρ) · 625/cos³ θ. All
//! lights have a flat spectrum, so nothing scatters but a pixel's place on the wall (2.5 mm).

use core::f64::consts::PI;
use etendue_core::maths::f64::{cos, sin_cos, tan};
use etendue_io::inspect::passing_beam;
use etendue_io::photometry::read_photometry;
use etendue_scene::asset::PhotometryAsset;
use etendue_tests::{FLAT, Job, ONE_BAND, eye, flat_per_lux};
use glam::DVec3;
use std::path::Path;

const REFLECTANCE: f64 = 0.5;
const WALL_M: f64 = 25.0;

/// Where intensities change linearly with the angle, f32 places and angles cost a few 1e-5; 2.5 mm at 25 m are 0.006°, over
/// which the intensities here change by less than 1e-3, and their mean is that of the middle.
const SMOOTH: f64 = 2e-4;

/// A wall, the lamp, and eyes that look at the wall where the directions meet it.
fn wall(lamp: &str, directions: &[DVec3]) -> Job {
    let place = |d: &DVec3| *d * (WALL_M / d.x);
    let eyes = directions.iter().enumerate();
    let eyes: String = eyes.map(|(i, d)| eye(&format!("eye{i}"), DVec3::new(5.0, 1.0, -3.0), place(d))).collect();
    Job::new(format!(
        r#"
        {eyes}
        [render]
        spp = 16
        replicates = 1
        integrator = "direct"
        {ONE_BAND}
        [[scene.materials]]
        name = "matt"
        type = "diffuse"
        reflectance = {REFLECTANCE}
        [[scene.objects]]
        name = "wall"
        shape = {{ type = "quad", size_m = [400, 400] }}
        material = "matt"
        position_m = [{WALL_M}, 0, 0]
        rotation_deg = [0, -90, 0]
        [[scene.lights]]
        name = "lamp"
        {FLAT}
        {lamp}
        "#
    ))
}

/// Illuminance on the wall, lx, where each eye looks.
fn illuminances(job: &Job) -> Vec<f64> {
    let lux = |radiance: f32| PI * f64::from(radiance) / (REFLECTANCE * flat_per_lux());
    job.shots().iter().map(|shot| lux(shot.radiance().mean[0])).collect()
}

/// Intensities, cd, as seen on the wall.
fn intensities(job: &Job, directions: &[DVec3]) -> Vec<f64> {
    let candela = |(lux, d): (f64, &DVec3)| lux * WALL_M * WALL_M / (d.x * d.x * d.x);
    illuminances(job).into_iter().zip(directions).map(candela).collect()
}

/// The direction at angles to the left and up from +x: a longitude and a latitude.
fn ahead(left_deg: f64, up_deg: f64) -> DVec3 {
    let ((sin_left, cos_left), (sin_up, cos_up)) = (sin_cos(left_deg.to_radians()), sin_cos(up_deg.to_radians()));
    DVec3::new(cos_up * cos_left, cos_up * sin_left, sin_up)
}

fn fan() -> Vec<DVec3> {
    [(0.0, 0.0), (8.0, 3.0), (-20.0, -10.0), (35.0, 20.0), (-50.0, 5.0)].map(|(left, up)| ahead(left, up)).to_vec()
}

fn assert_near(actual: f64, expected: f64, tolerance: f64, subject: &str) {
    assert!((actual - expected).abs() <= tolerance * expected, "{subject}: {actual} for {expected}");
}

#[test]
fn an_isotropic_lamp_is_stated_in_lumens_candelas_or_watts() {
    // 1 000 cd of a flat spectrum over all directions and the 800 nm from 300 to 1 100 nm.
    let watts = 4.0 * PI * 800.0 * flat_per_lux() * 1000.0;
    for (strength, at_m) in [
        ("intensity_cd = 1000".to_owned(), 0.0),
        (format!("luminous_flux_lm = {}", 4000.0 * PI), 0.0),
        ("intensity_cd = 1000".to_owned(), -30.0),
        (format!("radiant_flux_w = {watts}"), 0.0),
    ] {
        let by_watts = strength.contains("_w");
        let lamp = format!("type = \"point\"\nposition_m = [{at_m}, 0, 0]\n{strength}");
        let mut job = wall(&lamp, &fan());
        if by_watts {
            // Illuminant E is tabulated from 360 to 830 nm only: a flat spectrum of the whole range.
            let flat = [(300.0, 1.0), (1100.0, 1.0)];
            job = job.replacing(FLAT, "spectrum = \"flat.csv\"").with_spectrum("flat.csv", &flat);
        }
        for (lux, d) in illuminances(&job).iter().zip(fan()) {
            let offset = d * (WALL_M / d.x) - DVec3::X * at_m;
            let expected = 1000.0 * offset.x / (offset.length() * offset.length_squared());
            assert_near(*lux, expected, SMOOTH, &format!("{strength} at {at_m} m towards {d}"));
        }
    }
}

#[test]
fn the_paper_s_attenuation_comes_on_top() {
    let lamp = |more: &str| format!("type = \"point\"\nposition_m = [0, 0, 0]\nintensity_cd = 1000\n{more}");
    let clear = illuminances(&wall(&lamp(""), &fan()));
    let dimmed = illuminances(&wall(&lamp("attenuation_per_m = 0.2"), &fan()));
    for ((clear, dimmed), d) in clear.iter().zip(&dimmed).zip(fan()) {
        assert_near(*dimmed, clear / (1.0 + 0.2 * WALL_M / d.x), SMOOTH, "a = 0.2/m");
    }
}

#[test]
fn a_spot_is_full_within_its_inner_angle_soft_to_its_field_angle_and_dark_beyond() {
    let spot = "type = \"spot\"\nposition_m = [0, 0, 0]\ntarget_m = [3, 0, 0]\nfield_angle_deg = 60\n\
                inner_angle_deg = 30\nintensity_cd = 1000";
    let off_deg = [0.0, 5.0, 14.9, 18.0, 22.0, 27.0, 30.1, 45.0];
    let directions = off_deg.map(off_axis);
    let actual = intensities(&wall(spot, &directions), &directions);
    for (actual, deg) in actual.into_iter().zip(off_deg) {
        let [at, inner, outer] = [deg, 15.0, 30.0].map(|deg: f64| cos(deg.to_radians()));
        let t = ((at - outer) / (inner - outer)).clamp(0.0, 1.0);
        let expected = 1000.0 * t * t * (3.0 - 2.0 * t);
        // The soft edge falls by 11 % of the full intensity a degree at most: 0.006° are 6e-4 of it.
        assert!((actual - expected).abs() < 0.6, "{deg}°: {actual} for {expected}");
        assert!(deg < 30.0 || actual == 0.0, "{deg}°: {actual} beyond the field");
    }
    // The same by its flux: Φ = I · 2π ((1 − c_i) + (c_i − c_o)/2).
    let [inner, outer] = [15.0, 30.0].map(|deg: f64| cos(deg.to_radians()));
    let flux = 1000.0 * 2.0 * PI * (1.0 - 0.5 * (inner + outer));
    let spot = spot.replace("intensity_cd = 1000", &format!("luminous_flux_lm = {flux}"));
    assert_near(intensities(&wall(&spot, &directions), &directions)[0], 1000.0, SMOOTH, "by flux");
}

/// A direction at an angle from +x, to the left and up.
fn off_axis(deg: f64) -> DVec3 {
    let (sin, cos) = sin_cos(deg.to_radians());
    DVec3::new(cos, 0.6 * sin, 0.8 * sin)
}

#[test]
fn a_mask_shapes_a_lamp_as_a_slide_does() {
    // Quarters of a picture: upper left 1, upper right 0.5, lower left 0.25, lower right black.
    let texel = |row: u32, column: u32| [[1.0, 0.5], [0.25, 0.0]][(row / 8) as usize][(column / 8) as usize];
    let image = (0..256).map(|i| [texel(i / 16, i % 16); 3]).collect();
    let lamp = "type = \"point\"\nposition_m = [0, 0, 0]\nrotation_deg = [0, 0, 0]\nintensity_cd = 800\n\
                mask = { file = \"mask.exr\", field_deg = [40, 30] }";
    // Middles of the quarters, then beyond the picture's right and upper edge.
    let half = |full_deg: f64, fraction: f64| fraction * tan((0.5 * full_deg).to_radians());
    let at = |left: f64, up: f64| DVec3::new(1.0, half(40.0, left), half(30.0, up)).normalize();
    let directions = [at(0.5, 0.5), at(-0.5, 0.5), at(0.5, -0.5), at(-0.5, -0.5), at(-1.02, 0.5), at(0.5, 1.02)];
    let job = wall(lamp, &directions).with_image("mask.exr", 16, 16, image);
    for (actual, fraction) in intensities(&job, &directions).into_iter().zip([1.0, 0.5, 0.25, 0.0, 0.0, 0.0]) {
        assert_near(actual, 800.0 * fraction, SMOOTH, "a quarter of the slide");
    }
}

/// Numbers from `low` to `high` at steps.
fn steps(low: f64, high: f64, step: f64) -> Vec<f64> {
    (0..=((high - low) / step).round() as u32).map(|i| low + f64::from(i) * step).collect()
}

fn joined(numbers: &[f64], between: &str) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(between)
}

/// A file of LM-63-2002, absolute photometry, of type 1 C, 2 B or 3 A.
fn lm63(kind: u8, vertical: &[f64], horizontal: &[f64], candela: fn(f64, f64) -> f64) -> String {
    let (rows, columns) = (vertical.len(), horizontal.len());
    let plane = |h: &f64| joined(&vertical.iter().map(|v| candela(*h, *v)).collect::<Vec<_>>(), " ");
    let planes: Vec<String> = horizontal.iter().map(plane).collect();
    format!(
        "IESNA:LM-63-2002\n[TEST] 1\n[MANUFAC] None\nTILT=NONE\n1 -1 1 {rows} {columns} {kind} 2 0 0 0\n1 1 20\n{}\n{}\n{}\n",
        joined(vertical, " "),
        joined(horizontal, " "),
        planes.join("\n")
    )
}

/// A file of EULUMDAT without symmetry; intensities in cd for 2 000 lm.
fn eulumdat(gamma: &[f64], planes: &[f64], candela: fn(f64, f64) -> f64) -> String {
    let (rows, columns) = (gamma.len(), planes.len());
    let per_klm = planes.iter().flat_map(|c| gamma.iter().map(|g| 0.5 * candela(*c, *g)).collect::<Vec<_>>());
    let numbers: Vec<f64> = planes.iter().chain(gamma).copied().chain(per_klm).collect();
    let step = |angles: &[f64]| angles[1] - angles[0];
    format!(
        "None\n1\n0\n{columns}\n{}\n{rows}\n{}\nreport\nlamp\n1\nlamp\n2024\n300\n200\n50\n250\n150\n0\n0\n0\n0\n\
         100\n100\n1\n0\n1\n1\nLED\n2000\n4000\n80\n20\n{}\n{}\n",
        step(planes),
        step(gamma),
        joined(&[0.5; 10], "\n"),
        joined(&numbers, "\n")
    )
}

/// What is read of a file of these contents.
fn read(name: &str, text: &str) -> PhotometryAsset {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).expect("the folder of tests' files can be written");
    read_photometry(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// A measured lamp on the wall gives the file's candelas at (horizontal, vertical) angles, degrees, whose directions are
/// `direction`'s; multiples of 10° are in the file as `candela` says.
fn assert_measured(
    lamp: &PhotometryAsset,
    name: &str,
    candela: fn(f64, f64) -> f64,
    angles: &[(f64, f64)],
    direction: impl Fn(f64, f64) -> DVec3,
) {
    let text = format!("type = \"measured\"\nfile = \"{name}\"\nposition_m = [0, 0, 0]\ntarget_m = [10, 0, 0]");
    let directions: Vec<DVec3> = angles.iter().map(|(h, v)| direction(*h, *v)).collect();
    let job = wall(&text, &directions).with_lamp(name, lamp.clone());
    for (actual, (h, v)) in intensities(&job, &directions).into_iter().zip(angles) {
        let expected = lamp.candela_at(*h, *v);
        assert_near(actual, expected, SMOOTH, &format!("{name} at {h}°, {v}°"));
        if h % 10.0 == 0.0 && v % 10.0 == 0.0 {
            assert_near(expected, candela(*h, *v), 1e-9, &format!("{name} at {h}°, {v}° as in the file"));
        }
    }
    // The issue's own words: straight ahead, illuminance × 625 is the file's candela, within 1 %.
    let ahead = illuminances(&wall(&text, &[DVec3::X]).with_lamp(name, lamp.clone()))[0] * 625.0;
    assert_near(ahead, lamp.candela_at(0.0, 0.0), SMOOTH, "straight ahead");
}

/// Type C: 0° is the direction that points at the wall. C0 then points up and C90 to the left.
fn c_direction(c_deg: f64, gamma_deg: f64) -> DVec3 {
    let ((sin_c, cos_c), (sin_g, cos_g)) = (sin_cos(c_deg.to_radians()), sin_cos(gamma_deg.to_radians()));
    DVec3::new(cos_g, sin_g * sin_c, sin_g * cos_c)
}

const C_ANGLES: [(f64, f64); 7] =
    [(0.0, 10.0), (90.0, 30.0), (180.0, 20.0), (270.0, 40.0), (45.0, 25.0), (305.0, 55.0), (130.0, 5.0)];

/// No symmetry, but one value straight down and closed over 360°.
fn c_candela(c: f64, gamma: f64) -> f64 {
    let around = if c <= 250.0 { c / 250.0 } else { (360.0 - c) / 110.0 };
    500.0 + 8.0 * gamma * (0.2 + around) - 2.0 * gamma
}

#[test]
fn a_measured_lamp_of_type_c_lights_the_wall_as_its_file_says() {
    let text = lm63(1, &steps(0.0, 90.0, 10.0), &steps(0.0, 360.0, 10.0), c_candela);
    assert_measured(&read("wall_c.ies", &text), "wall_c.ies", c_candela, &C_ANGLES, c_direction);
}

#[test]
fn a_eulumdat_lamp_lights_the_wall_as_its_file_says() {
    let text = eulumdat(&steps(0.0, 90.0, 10.0), &steps(0.0, 350.0, 10.0), c_candela);
    assert_measured(&read("wall.ldt", &text), "wall.ldt", c_candela, &C_ANGLES, c_direction);
}

const H_V_ANGLES: [(f64, f64); 6] =
    [(10.0, 0.0), (-20.0, 10.0), (30.0, -20.0), (-5.0, -15.0), (24.0, 8.0), (0.0, 20.0)];

/// Brighter to the right and below.
fn h_v_candela(h: f64, v: f64) -> f64 {
    9000.0 + 60.0 * h - 110.0 * v - 2.0 * h.abs() * v.abs() / 10.0
}

#[test]
fn a_measured_lamp_of_type_a_lights_the_wall_as_its_file_says() {
    let text = lm63(3, &steps(-30.0, 30.0, 5.0), &steps(-40.0, 40.0, 5.0), h_v_candela);
    let lamp = read("wall_a.ies", &text);
    // A longitude, positive to the right, and a latitude.
    assert_measured(&lamp, "wall_a.ies", h_v_candela, &H_V_ANGLES, |h, v| ahead(-h, v));
}

#[test]
fn a_measured_lamp_of_type_b_lights_the_wall_as_its_file_says() {
    let text = lm63(2, &steps(-30.0, 30.0, 5.0), &steps(-40.0, 40.0, 5.0), h_v_candela);
    let lamp = read("wall_b.ies", &text);
    // A latitude to the right of the vertical plane, and a turn about the horizontal axis.
    let direction = |h: f64, v: f64| {
        let ((sin_h, cos_h), (sin_v, cos_v)) = (sin_cos(h.to_radians()), sin_cos(v.to_radians()));
        DVec3::new(cos_h * cos_v, -sin_h, cos_h * sin_v)
    };
    assert_measured(&lamp, "wall_b.ies", h_v_candela, &H_V_ANGLES, direction);
}

#[test]
fn a_low_beam_on_the_wall_passes_the_regulation_s_points() {
    for (traffic, mirror) in [("right", 1.0), ("left", -1.0)] {
        let lamp =
            format!("type = \"head_lamp\"\nbeam = \"low_beam\"\ntraffic = \"{traffic}\"\nposition_m = [0, 0, 0]");
        let fulfilled = |mirror: f64| {
            let directions = passing_beam::POINTS.map(|point| ahead(-mirror * point.right_deg, point.up_deg));
            let actual = intensities(&wall(&lamp, &directions), &directions);
            actual.iter().zip(passing_beam::POINTS).filter(|(candela, point)| point.limit.is_met(**candela)).count()
        };
        assert_eq!(fulfilled(mirror), passing_beam::POINTS.len(), "traffic on the {traffic}");
        assert!(fulfilled(-mirror) < passing_beam::POINTS.len(), "the cut-off is not symmetric");
    }
    // A high beam is none.
    let lamp = "type = \"head_lamp\"\nbeam = \"high_beam\"\nposition_m = [0, 0, 0]";
    let glare_directions = [ahead(3.43, 0.57)];
    assert!(intensities(&wall(lamp, &glare_directions), &glare_directions)[0] > 10_000.0);
}

#[test]
fn a_lamp_turned_down_lights_lower() {
    let lamp = "type = \"head_lamp\"\nbeam = \"high_beam\"\nposition_m = [0, 0, 0]";
    let (level, down) = ([ahead(0.0, 1.0), ahead(2.0, -1.0)], [ahead(0.0, 0.0), ahead(2.0, -2.0)]);
    let before = intensities(&wall(lamp, &level), &level);
    let after = intensities(&wall(&format!("{lamp}\naim_down_deg = 1"), &down), &down);
    for (a, b) in after.iter().zip(&before) {
        // Turned about the horizontal axis, 2° aside: the latitude changes by 6e-4°, the light by less than 1e-3.
        assert_near(*a, *b, 1e-3, "1° down");
    }
}
