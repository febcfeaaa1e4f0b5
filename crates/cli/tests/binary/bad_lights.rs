//! Unusable lamps, skies and materials: each is reported with file, line and key, and nothing is written.

use crate::bad_input::ModifiedJob;

const LAMP: &str = "[[scene.lights]]\ntype = \"measured\"\nname = \"street\"\nfile = \"street.ies\"\nilluminant = \"LED-B3\"\n\
                    position_m = [5, 0, 6]\n\n[[scene.lights]]\ntype = \"sun\"";
const IES: &str = "IESNA:LM-63-2002\n[TEST] a lamp\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 80 0\n";

/// Asserts that the job with a lamp from such a file is refused: at a line of the file, at the job's reference to it, and with `phrases`.
#[track_caller]
fn assert_lamp_refused(ies: &str, line: &str, phrases: &[&str]) {
    let job = ModifiedJob::new();
    let place = job.replace_first("small.toml", "[[scene.lights]]\ntype = \"sun\"", LAMP);
    let (file, first) = place.split_once(':').expect("a line");
    let named = format!("{file}:{}", first.parse::<usize>().expect("a number") + 3);
    job.write("street.ies", ies);
    let phrases: Vec<&str> = [line, &named, "file"].into_iter().chain(phrases.iter().copied()).collect();
    job.render(&[]).refused(&phrases);
}

#[test]
fn a_photometric_file_with_a_wrong_count_of_angles() {
    assert_lamp_refused(&IES.replace("1 1000 1 3 1", "1 1000 1 4 1"), "street.ies:", &["4"]);
    assert_lamp_refused(&IES.replace("100 80 0\n", "100 80\n"), "street.ies:", &["3"]);
}

#[test]
fn a_photometric_file_with_unsorted_angles() {
    assert_lamp_refused(&IES.replace("0 45 90", "0 90 45"), "street.ies:6", &["45"]);
}

#[test]
fn a_lamp_of_an_unknown_spectrum() {
    let job = ModifiedJob::new();
    let lamp = LAMP.replace("LED-B3", "LED-B4").replace("\"measured\"", "\"point\"");
    let lamp = lamp.replace("file = \"street.ies\"", "luminous_flux_lm = 100");
    job.replace_first("small.toml", "[[scene.lights]]\ntype = \"sun\"", &lamp);
    job.render(&[]).refused(&["small.toml:", "scene.lights.street.illuminant", "\"LED-B4\"", "did you mean \"LED-B"]);
}

#[test]
fn a_turbidity_out_of_range() {
    let job = ModifiedJob::new();
    let sky = "type = \"sky\"\nturbidity = 0.5\nsun = false\nsun_elevation_deg = 30\nsun_azimuth_deg = 0\n#";
    job.replace_first("small.toml", "type = \"image\"", sky);
    job.render(&[]).refused(&[
        "small.toml:",
        "scene.environment.turbidity",
        "found 0.5",
        "of at least 1 and at most 10",
    ]);
}

#[test]
fn a_flux_of_what_has_no_area() {
    let job = ModifiedJob::new();
    job.replace_first(
        "small.toml",
        "type = \"image\"",
        "type = \"uniform\"\nluminous_flux_lm = 100\nilluminant = \"D65\"",
    );
    job.replace_first("small.toml", "file = \"sky.hdr\"\n", "");
    job.replace_first("small.toml", "luminance_cd_m2_per_unit = 2000\n", "");
    job.render(&[]).refused(&["small.toml:", "scene.environment.luminous_flux_lm", "the sky has no area"]);
}

#[test]
fn materials_that_gain_energy() {
    for gains in [
        "type = \"blinn_phong\"\nreflectance = 0.7\nspecular = 0.5\nexponent = 40",
        "type = \"lafortune\"\nreflectance = 0.5\nlobes = [{ kind = \"retro\", exponent = 10, albedo = 0.7 }]",
    ] {
        let job = ModifiedJob::new();
        let place =
            job.replace_first("small.toml", "type = \"coated\"\nreflectance = [0.05, 0.2, 0.6]\nalpha = 0.05", gains);
        assert!(place.starts_with("small.toml:"));
        job.render(&[]).refused(&["small.toml:", "scene.materials.paint", "more"]);
    }
}

#[test]
fn light_that_no_number_holds() {
    let uniform = |level: &str| {
        let job = ModifiedJob::new();
        job.replace_first("small.toml", "type = \"image\"", &format!("type = \"uniform\"\n{level}"));
        job.replace_first("small.toml", "file = \"sky.hdr\"\n", "");
        job.replace_first("small.toml", "luminance_cd_m2_per_unit = 2000\n", "");
        job.render(&[]).refused(&["small.toml:", "radiance", "1e30"]);
    };
    uniform("radiance_w_m2_sr_nm = 1e300");
    uniform("luminance_cd_m2 = 1e300\nilluminant = \"D65\"");
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "luminance_cd_m2_per_unit = 2000", "luminance_cd_m2_per_unit = 1e300");
    job.render(&[]).refused(&["small.toml:", "exceeds the maximum of 1e30"]);
}

/// A lamp so near to a wall that 32 bits do not hold the irradiance under it: detected only during rendering.
const NEAR: &str = r#"format = 1
[[cameras]]
name = "eye"
position_m = [-1e-4, 0, 0]
look_at_m = [1, 0, 0]
lens = { type = "pinhole", focal_length_mm = 6, f_number = 8 }
sensor = { width_px = 8, height_px = 6, pixel_pitch_um = 6 }
[render]
spp = 4
[[scene.materials]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[scene.objects]]
name = "wall"
material = "grey"
rotation_deg = [0, -90, 0]
shape = { type = "quad", size_m = [0.01, 0.01] }
[[scene.lights]]
type = "point"
name = "near"
position_m = [-1e-7, 0, 0]
illuminant = "D65"
radiant_flux_w = 1e30
"#;

#[test]
fn light_that_turns_out_not_to_be_finite_is_not_delivered() {
    let job = ModifiedJob::new();
    job.write("small.toml", NEAR);
    let output = job.render(&[]);
    assert_eq!(output.status, 1, "{output:?}");
    output.says(&["camera eye", "not finite", "no results are written"]);
}
