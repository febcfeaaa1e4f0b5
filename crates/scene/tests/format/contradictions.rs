//! Contradictions of lights, skies, textures and materials.

use crate::files::{DescriptionFiles, load};

const JOB: &str = r#"format = 1

[[cameras]]
name = "front"
position_m = [0, 0, 1]
look_at_m = [10, 0, 1]
lens = { type = "pinhole", focal_length_mm = 6, f_number = 2.0 }
sensor = { width_px = 64, height_px = 48, pixel_pitch_um = 6.0 }

[[scene.textures]]
name = "bricks"
file = "bricks.png"
encoding = "srgb"

"#;

/// Errors of a job with `more` appended, one per line.
fn errors_of_job(more: &str) -> String {
    load(&DescriptionFiles::from_job(&format!("{JOB}{more}")), &[]).err().map_or(String::new(), |f| f.to_string())
}

/// Errors of a light with these keys.
fn light(keys: &str) -> String {
    errors_of_job(&format!("[[scene.lights]]\nname = \"l\"\n{keys}\n"))
}

/// Errors of a material with these keys.
fn material(keys: &str) -> String {
    errors_of_job(&format!("[[scene.materials]]\nname = \"m\"\n{keys}\n"))
}

const SPOT: &str = "type = \"spot\"\nintensity_cd = 100\nilluminant = \"A\"\nfield_angle_deg = 40\n";

#[test]
fn lamps_have_one_position_and_direction() {
    let spot = |keys: &str| light(&format!("{SPOT}{keys}"));
    assert_eq!(spot("position_m = [0, 0, 5]\ntarget_m = [5, 0, 0]"), "");
    assert_eq!(
        spot("instances = [{ position_m = [0, 0, 5] }, { position_m = [9, 0, 5], rotation_deg = [0, 90, 0] }]"),
        ""
    );
    assert!(spot("").contains("the light has no position"));
    let twice = spot("position_m = [0, 0, 5]\ninstances = [{ position_m = [0, 0, 5] }]");
    assert!(twice.contains("\"instances\" contradicts \"position_m\""), "{twice}");
    let aims = spot("position_m = [0, 0, 5]\ntarget_m = [5, 0, 0]\nrotation_deg = [0, 0, 0]");
    assert!(aims.contains("\"rotation_deg\", \"target_m\" contradict each other"), "{aims}");
    assert!(spot("position_m = [0, 0, 5]\ntarget_m = [0, 0, 5]").contains("points at its own position"));
    let wide = spot("position_m = [0, 0, 5]\ninner_angle_deg = 41");
    assert!(wide.contains("lights.l.inner_angle_deg: found 41, but the field ends at 40"), "{wide}");
    let point = "type = \"point\"\nposition_m = [0, 0, 5]\nluminous_flux_lm = 800\nilluminant = \"A\"\nrotation_deg = [0, 90, 0]";
    assert!(light(point).contains("rotation_deg: an isotropic light has no direction"));
    let masked = format!("{point}\nmask = {{ file = \"mask.png\", field_deg = [40, 30] }}");
    assert_eq!(light(&masked), "");
}

#[test]
fn lamps_have_one_strength_and_one_colour() {
    let strengths = light(&format!("{SPOT}position_m = [0, 0, 5]\nluminous_flux_lm = 800"));
    assert!(strengths.contains("\"luminous_flux_lm\", \"intensity_cd\" contradict each other"), "{strengths}");
    let colours = light(&format!("{SPOT}position_m = [0, 0, 5]\ntemperature_k = 3000"));
    assert!(colours.contains("\"illuminant\", \"temperature_k\" contradict each other"), "{colours}");
    let unknown = light(&format!("{}position_m = [0, 0, 5]", SPOT.replace("\"A\"", "\"d65\"")));
    assert!(
        unknown
            .contains("scene.lights.l.illuminant: found the text \"d65\"; did you mean \"D65\"? Give one of \"solar\""),
        "{unknown}"
    );
}

#[test]
fn head_lamps_keep_to_a_side_of_the_road() {
    let lamp =
        |keys: &str| light(&format!("type = \"head_lamp\"\nposition_m = [0, 0, 0.7]\nilluminant = \"LED-B3\"\n{keys}"));
    assert_eq!(lamp("beam = \"low_beam\"\ntraffic = \"right\""), "");
    assert!(
        lamp("beam = \"low_beam\"")
            .contains("the side of the road towards which the cut-off of the low beam rises is missing")
    );
    assert!(lamp("beam = \"high_beam\"\ntraffic = \"left\"").contains("belongs to beam = \"low_beam\""));
}

#[test]
fn suns_by_level_and_by_model() {
    let sun = |keys: &str| light(&format!("type = \"sun\"\nazimuth_deg = 0\n{keys}"));
    assert_eq!(sun("elevation_deg = 30\nturbidity = 3"), "");
    let twice = sun("elevation_deg = 30\nturbidity = 3\nilluminance_lx = 1e5\nilluminant = \"solar\"");
    assert!(twice.contains("\"illuminance_lx\", \"turbidity\" contradict each other"), "{twice}");
    assert!(sun("elevation_deg = 30\nturbidity = 3\ntemperature_k = 5800").contains("the colour contradicts it"));
    assert!(sun("elevation_deg = 30\nilluminance_lx = 1e5").contains("does not state the colour of the sun"));
    assert!(sun("elevation_deg = 0\nturbidity = 3").contains("no sun at or below the horizon"));
    let hazy = sun("elevation_deg = 30\nturbidity = 11");
    assert!(hazy.contains("found 11; give a number of at least 1 and at most 10"), "{hazy}");
}

#[test]
fn skies_have_one_position_of_the_sun() {
    let sky = |keys: &str| errors_of_job(&format!("[scene.environment]\ntype = \"sky\"\nturbidity = 3\n{keys}"));
    let moment = "date = 2026-06-21\ntime_utc = \"09:30:00\"\nlatitude_deg = 48\nlongitude_deg = 11\n";
    let angles = "sun_elevation_deg = 30\nsun_azimuth_deg = 10\n";
    assert_eq!(sky(moment), "");
    assert_eq!(sky(angles), "");
    let sun = "[[scene.lights]]\ntype = \"sun\"\nname = \"s\"\nelevation_deg = 30\nazimuth_deg = 0\nturbidity = 3";
    assert!(sky(&format!("{angles}{sun}")).contains("scene.lights.s: the sky has its own sun (job.toml:"));
    assert_eq!(sky(&format!("{angles}sun = false\n{sun}")), "");
    assert!(sky("").contains("the position of the sun is missing"));
    let both = sky(&format!("{moment}{angles}"));
    assert!(both.contains("scene.environment.date: \"date\" and \"sun_elevation_deg\" (job.toml:"), "{both}");
    assert!(sky("sun_elevation_deg = 30").contains("the key \"sun_azimuth_deg\" is missing"));
    let day = sky(&moment.replace("2026-06-21", "\"2026-06-31\""));
    assert!(day.contains("found the text \"2026-06-31\"; give a date from 1950 to 2099"), "{day}");
    assert!(sky(&moment.replace("09:30:00", "9:30")).contains("give a time of day"));
}

#[test]
fn textures_have_one_mapping() {
    let texture = |keys: &str| {
        errors_of_job(&format!("[[scene.textures]]\nname = \"t\"\nfile = \"t.exr\"\nencoding = \"data\"\n{keys}"))
    };
    assert_eq!(texture("uv_scale = [2, 2]"), "");
    assert_eq!(texture("mapping = \"triplanar\"\nsize_m = 2"), "");
    assert!(texture("mapping = \"triplanar\"").contains("does not state the size of the image"));
    assert!(texture("size_m = 2").contains("belongs to mapping = \"triplanar\""));
    let both = texture("mapping = \"triplanar\"\nsize_m = 2\nuv_offset = [0.5, 0]");
    assert!(both.contains("\"uv_offset\" has no effect here, it belongs to mapping = \"uv\""), "{both}");
}

#[test]
fn glass_absorbs_in_one_way() {
    let solid = |keys: &str| material(&format!("type = \"dielectric\"\nindex = 1.5\n{keys}"));
    assert_eq!(solid("internal_transmittance = 0.9\nthickness_mm = 4"), "");
    assert!(solid("internal_transmittance = 0.9").contains("does not state its path length"));
    assert!(solid("absorption_per_m = 3\nthickness_mm = 4").contains("the mesh determines the thickness of the solid"));
    let both = solid("internal_transmittance = 0.9\nthickness_mm = 4\nabsorption_per_m = 3");
    assert!(both.contains("\"absorption_per_m\", \"internal_transmittance\" contradict each other"), "{both}");
    let sheet = |keys: &str| material(&format!("type = \"thin_sheet\"\n{keys}"));
    assert_eq!(sheet("absorption_per_m = 3\nthickness_mm = 4"), "");
    assert!(sheet("absorption_per_m = 3").contains("of a thin sheet needs its thickness"));
    assert!(sheet("internal_transmittance = 0.9\nthickness_mm = 4").contains("belongs to \"absorption_per_m\""));
}

#[test]
fn lobes_and_maps() {
    let lobe = |keys: &str| {
        material(&format!("type = \"lafortune\"\nreflectance = 0.2\nlobes = [{{ exponent = 20, {keys} }}]"))
    };
    assert_eq!(lobe("kind = \"retro\", albedo = 0.1"), "");
    assert_eq!(lobe("factors = [-1, 0], weight_per_sr = 0.1"), "");
    assert!(lobe("factors = [-1, 0], albedo = 0.1").contains("reflects nothing at normal incidence"));
    assert!(lobe("kind = \"mirror\", factors = [-1, 1], albedo = 0.1").contains("contradict each other"));
    let bent = material(
        "type = \"emitter\"\nemission = { luminance_cd_m2 = 1, illuminant = \"A\" }\nnormal_map = { texture = \"bricks\" }",
    );
    assert!(bent.contains("\"normal_map\" has no effect on a surface that does not reflect by itself"), "{bent}");
    assert!(
        material("type = \"diffuse\"\nreflectance = 0.2\nopacity = { texture = \"brick\" }")
            .contains("did you mean \"bricks\"?")
    );
    assert!(material("type = \"mix\"\na = \"m\"\nb = \"n\"\nweight = 0.5").contains("there is no material \"n\""));
}

#[test]
fn levels_that_trace_no_paths() {
    let level = |job: &str, own: &str| {
        let text = JOB.replace("lens =", &format!("render = {{ {own} }}\nlens ="));
        let text = format!("{text}\n[render]\n{job}\n");
        load(&DescriptionFiles::from_job(&text), &[]).err().map_or(String::new(), |f| f.to_string())
    };
    assert_eq!(level("integrator = \"direct\"", ""), "");
    let message = level("integrator = \"direct\"\nmax_bounces = 8", "");
    assert!(
        message.contains("render.max_bounces: \"max_bounces\" has no effect here, it belongs to integrator = \"path\""),
        "{message}"
    );
    assert!(level("caustics = false", "integrator = \"flat\"").contains("\"caustics\" has no effect here"));
    let second = "\n[[cameras]]\nname = \"second\"\nposition_m = [0, 0, 1]\nlook_at_m = [9, 0, 1]\n\
                  lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 2.0 }\n\
                  sensor = { width_px = 64, height_px = 48, pixel_pitch_um = 6.0 }\n";
    let shared = format!("max_bounces = 8\n{second}");
    assert_eq!(level(&shared, "integrator = \"flat\""), "", "the other camera traces paths of eight bounces");
}

/// Errors of a camera with these keys in its [effects.psf], line 2 of the file `camera.toml`.
fn psf(keys: &str) -> String {
    let text = format!(
        "format = 1\neffects = {{ psf = {{ {keys} }} }}\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 6\n\
                        f_number = 2\n[sensor]\nwidth_px = 64\nheight_px = 48\npixel_pitch_um = 6\n"
    );
    let read = |_: &std::path::Path| Ok(text.clone());
    let camera =
        etendue_scene::load_camera(std::path::Path::new("camera.toml"), &read, &etendue_scene::Overrides::default());
    camera.err().map_or(String::new(), |errors| errors.to_string())
}

#[test]
fn a_point_spread_function_is_of_an_aperture_or_from_a_picture() {
    assert_eq!(psf("blades = 6, rotation_deg = 10, wavefront = [{ noll = 4, rms_um = 0.1 }]"), "");
    assert_eq!(psf("image = \"k.exr\", image_pitch_um = 2, image_wavelength_nm = 550"), "");
    let says = |keys: &str, words: [&str; 2]| {
        let message = psf(keys);
        assert!(
            message.starts_with("camera.toml:2:") && words.iter().all(|w| message.contains(w)),
            "{keys}: {message}"
        );
        assert_eq!(message.lines().count(), 1, "{message}");
    };
    says("image = \"k.exr\"", ["effects.psf.image:", "add \"image_pitch_um\""]);
    says("image = \"k.jpg\", image_pitch_um = 2", ["effects.psf.image:", "k.jpg"]);
    says("image = \"k.exr\", image_pitch_um = 0", ["effects.psf.image_pitch_um:", "above 0"]);
    says("image_pitch_um = 2", ["effects.psf.image_pitch_um:", "no effect without \"image\""]);
    says("image_wavelength_nm = 550", ["effects.psf.image_wavelength_nm:", "no effect without \"image\""]);
    says("image = \"k.exr\", image_pitch_um = 2, image_wavelength_nm = 200", ["psf.image_wavelength_nm:", "300"]);
    for key in ["blades = 6", "blade_curvature = 0.5", "rotation_deg = 5", "obstruction = 0.3", "reach_mm = 1"] {
        let name = key.split(' ').next().expect("a name");
        says(
            &format!("image = \"k.exr\", image_pitch_um = 2, {key}"),
            [&format!("effects.psf.{name}:"), "contradicts"],
        );
    }
    let with = |key: &str| format!("image = \"k.exr\", image_pitch_um = 2, {key}");
    says(&with("patches = [2, 2]"), ["effects.psf.patches:", "contradicts \"image\""]);
    says(&with("wavefront = [{ noll = 4, rms_um = 0.1 }]"), ["effects.psf.wavefront", "contradicts \"image\""]);
}

#[test]
fn files_over_the_field_are_the_whole_function() {
    assert_eq!(psf("files = [\"a.txt\", \"b.DAT\"], patches = [7, 5], spread_by = \"film\""), "");
    for (keys, words) in [
        ("files = []", "effects.psf.files"),
        ("files = [\"a.png\"]", "effects.psf.files"),
        ("files = [\"a.txt\"], image_pitch_um = 2", "no effect without \"image\""),
        ("files = [\"a.txt\"], image = \"k.exr\", image_pitch_um = 2", "\"files\" contradicts \"image\""),
        ("files = [\"a.txt\"], mtf = { file = \"m.txt\" }", "\"files\" contradicts \"mtf\""),
        ("files = [\"a.txt\"], blades = 6", "\"blades\" contradicts \"files\""),
        ("files = [\"a.txt\"], rotation_deg = 6", "\"rotation_deg\" contradicts \"files\""),
        ("files = [\"a.txt\"], wavefront = [{ noll = 4, rms_um = 0.1 }]", "contradicts \"files\""),
        ("files = [\"a.txt\"], patches = [0, 3]", "effects.psf.patches"),
    ] {
        let message = psf(keys);
        assert!(message.starts_with("camera.toml:2:") && message.contains(words), "{keys}: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
}

#[test]
fn an_aperture_says_what_it_means() {
    for (keys, words) in [
        ("blades = 2", "effects.psf.blades: "),
        ("blades = 33", "effects.psf.blades: "),
        ("blade_curvature = 0.5", "no effect on a circle"),
        ("rotation_deg = 10", "no effect on a circle"),
        ("blades = 5, blade_curvature = 1.5", "effects.psf.blade_curvature: "),
        ("obstruction = 0.95", "effects.psf.obstruction: "),
        ("reach_mm = 0", "effects.psf.reach_mm: "),
        ("patches = [0, 1]", "effects.psf.patches"),
        ("patches = 3", "effects.psf.patches"),
        ("bladse = 6", "effects.psf.bladse: "),
        ("wavefront = [{ noll = 92, rms_um = 0.1 }]", "noll: "),
        ("wavefront = [{ noll = 4, osa = 4, rms_um = 0.1 }]", "osa"),
        ("wavefront = [{ noll = 4 }]", "rms_um"),
        ("wavefront = [{ noll = 4, rms_waves = 0.1 }]", "add \"wavelength_nm\""),
        ("wavefront = [{ noll = 4, rms_um = 0.1, wavelength_nm = 550 }]", "no effect with \"rms_um\""),
    ] {
        let message = psf(keys);
        assert!(message.starts_with("camera.toml:2:") && message.contains(words), "{keys}: {message}");
    }
}

#[test]
fn openings_contradict_what_a_surface_cannot_be() {
    let lamp = "type = \"point\"\nposition_m = [0, 0, 3]\nintensity_cd = 10\nilluminant = \"E\"";
    let message =
        light(&format!("{lamp}\nattenuation_per_m = 0.1\nopening = {{ shape = \"sphere\", radius_m = 0.05 }}"));
    assert!(message.contains("lights.l.attenuation_per_m: \"attenuation_per_m\" contradicts \"opening\""), "{message}");
    let message = light(&format!("{lamp}\nopening = {{ shape = \"file\" }}"));
    assert!(message.contains("lights.l.opening: shape = \"file\" has no effect here"), "{message}");
    for size in ["radius_m = -0.05", "radius_m = 0", "radius_m = 51"] {
        let message = light(&format!("{lamp}\nopening = {{ shape = \"disc\", {size} }}"));
        assert!(message.contains("lights.l.opening.radius_m: "), "{message}");
    }
    let aim = "rotation_deg = [10, 0, 0]";
    let message = light(&format!("{lamp}\n{aim}\nopening = {{ shape = \"sphere\", radius_m = 0.05 }}"));
    assert!(message.contains("direction"), "{message}");
    let message = light(&format!("{lamp}\n{aim}\nopening = {{ shape = \"tube\", radius_m = 0.013, length_m = 1.2 }}"));
    assert_eq!(message, "", "a tube points somewhere");
}
