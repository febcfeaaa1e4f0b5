//! Compiled descriptions: presets, lamps, skies, and errors that only compilation finds.

mod modulation;

use super::{Choices, compile};
use crate::Plan;
use crate::plan::note::{Note, Severity};
use etendue_optics::effects::PointSpread;
use etendue_scene::asset::{Assets, ImageAsset, ImagePixels};
use etendue_scene::{Description, Overrides, preset};
use etendue_spectra::observer::luminance;
use std::path::Path;

const CAMERA: &str = r#"format = 1
[[cameras]]
name = "front"
position_m = [0, 0, 1]
look_at_m = [10, 0, 1]
lens = { type = "pinhole", focal_length_mm = 6, f_number = 2.0 }
sensor = { width_px = 8, height_px = 6, pixel_pitch_um = 6.0 }
"#;

/// Plan of a scene without assets, or its errors, one per line.
fn plan(scene: &str) -> Result<Plan, String> {
    plan_with(scene, |_| ())
}

/// Plan of a scene with assets.
fn plan_with(scene: &str, fill: impl FnOnce(&mut Assets)) -> Result<Plan, String> {
    let text = format!("{CAMERA}{scene}");
    let read = |_: &Path| Ok(text.clone());
    let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).map_err(|f| f.to_string())?;
    let errors = |list: Vec<etendue_scene::DescriptionError>| list.iter().map(|f| format!("{f}\n")).collect::<String>();
    let mut assets = Assets::default();
    fill(&mut assets);
    compile(&job, &assets, &Choices::default()).map_err(errors)
}

#[test]
fn every_preset_becomes_a_material() {
    let material = |name: &&str| format!("[[scene.materials]]\nname = \"{name}\"\npreset = \"{name}\"\n");
    let plan = plan(&preset::names().iter().map(material).collect::<String>()).expect("no fault");
    assert_eq!(plan.materials, preset::names());
}

#[test]
fn a_camera_in_water_is_reported() {
    let water = "[[scene.materials]]\nname = \"water\"\ntype = \"dielectric\"\nindex = 1.33\nabsorption_per_m = 0.2\n";
    let ball = |x: f64| {
        let body = "name = \"ball\"\nmaterial = \"water\"\nshape = { type = \"sphere\", radius_m = 2 }\n";
        let scene = format!("{water}[[scene.objects]]\n{body}position_m = [{x}, 0, 1]\n");
        plan(&scene).expect("no fault").notes
    };
    assert!(ball(0.0).iter().any(|r| r.text.starts_with("is inside \"water\"")), "{:?}", ball(0.0));
    assert!(!ball(5.0).iter().any(|r| r.text.contains("is inside")));
}

/// Solids displace media: without a warning milk in a glass would be rendered as clear glass.
#[test]
fn a_medium_inside_glass_gives_a_warning_and_one_outside_does_not() {
    let glass = "[[scene.materials]]\nname = \"glass\"\ntype = \"dielectric\"\nindex = 1.5\n\
                 [[scene.objects]]\nname = \"ball\"\nmaterial = \"glass\"\nshape = { type = \"sphere\", radius_m = 1 }\nposition_m = [5, 0, 1]\n";
    let warned = |medium: &str| {
        let medium = format!("[[scene.media]]\nname = \"milk\"\nextinction_per_m = 2\n{medium}");
        let notes = plan(&format!("{glass}{medium}")).expect("no fault").notes;
        let is_of_milk = |note: &&Note| note.subject.as_deref() == Some("medium \"milk\"");
        notes.iter().filter(is_of_milk).map(|note| note.weight == Severity::Warning).collect::<Vec<_>>()
    };
    assert_eq!(warned("shape = { type = \"sphere\", radius_m = 1 }\nposition_m = [5, 0, 1]\n"), [true]);
    assert_eq!(warned("shape = { type = \"box\", size_m = [0.5, 0.5, 0.5] }\nposition_m = [5, 0.2, 1]\n"), [true]);
    for outside in [
        "",
        "shape = { type = \"sphere\", radius_m = 3 }\nposition_m = [5, 0, 1]\n",
        "shape = { type = \"box\", size_m = [1, 1, 1] }\n",
    ] {
        assert!(warned(outside).is_empty(), "{outside}");
    }
}

fn light(keys: &str) -> Result<Plan, String> {
    plan(&format!("[[scene.lights]]\nname = \"l\"\n{keys}\n"))
}

#[test]
fn lamps_have_the_flux_and_intensity_that_is_asked_for() {
    let lamp = |keys: &str| {
        let plan = light(keys).expect("no fault");
        let lamp = &plan.sources.lamps[0];
        (luminance(lamp.intensity()), lamp.profile().flux_sr())
    };
    let at = "position_m = [0, 0, 5]\nilluminant = \"LED-B3\"\n";
    let (cd, sr) = lamp(&format!("type = \"point\"\nluminous_flux_lm = 1000\n{at}"));
    // Spectra are f32; the flux is a sum of several hundred values.
    assert!((cd * sr / 1000.0 - 1.0).abs() < 1e-5 && (sr / (4.0 * core::f64::consts::PI) - 1.0).abs() < 1e-12);
    let spot = format!("type = \"spot\"\nfield_angle_deg = 60\n{at}");
    let (cd, sr) = lamp(&format!("{spot}luminous_flux_lm = 1000"));
    // A sharp cone of 30° half angle: 2π (1 − cos 30°) sr.
    assert!((cd * sr / 1000.0 - 1.0).abs() < 1e-5 && (sr - 0.841_787).abs() < 1e-5, "{sr}");
    assert!((lamp(&format!("{spot}intensity_cd = 70")).0 / 70.0 - 1.0).abs() < 1e-5);
    let plan = light(&format!("{spot}radiant_flux_w = 3")).expect("no fault");
    let lamp = &plan.sources.lamps[0];
    assert!((lamp.intensity().integral(300.0, 1100.0) * lamp.profile().flux_sr() / 3.0 - 1.0).abs() < 1e-5);
}

#[test]
fn a_lamp_stands_wherever_it_is_placed() {
    let keys = "type = \"head_lamp\"\nbeam = \"low_beam\"\ntraffic = \"right\"\nilluminant = \"LED-B3\"\n\
                instances = [{ position_m = [0, 0.6, 0.7] }, { position_m = [0, -0.6, 0.7], rotation_deg = [180, 0, 0] }]";
    let plan = light(keys).expect("no fault");
    let at: Vec<_> = plan.sources.lamps.iter().map(|l| l.to_world().at(0.0).translation.y).collect();
    assert_eq!(at, [0.6, -0.6]);
    assert!((luminance(plan.sources.lamps[0].intensity()) - 1.0).abs() < 1e-5, "candela as the beam says");
}

#[test]
fn a_sky_brings_its_sun_by_time_and_place() {
    let sky = |keys: &str| plan(&format!("[scene.environment]\ntype = \"sky\"\nturbidity = 2\n{keys}"));
    let plan = sky("sun_elevation_deg = 60\nsun_azimuth_deg = 90").expect("no fault");
    let facts = plan.sky.expect("a sky");
    // Expected range of a clear day: 85 to 110 klx.
    assert!((85e3..110e3).contains(&(facts.sky_lx + facts.sun_lx)), "{facts:?}");
    assert!((plan.sources.suns[0].direction().y - 0.5).abs() < 1e-6, "an azimuth of 90° is to the left");
    // Noon of midsummer in Greenwich: the sun is in the south at 90° − 51.48° + 23.44°, less the equation of time.
    let noon = "date = 2026-06-21\ntime_utc = 12:02:00\nlatitude_deg = 51.48\nlongitude_deg = 0\n";
    let facts = sky(noon).expect("no fault").sky.expect("a sky");
    assert!((facts.sun_elevation_deg - 61.96).abs() < 0.05 && (facts.sun_azimuth_deg - 180.0).abs() < 1.0, "{facts:?}");
    // North to the left: south is to the right.
    let facts = sky(&format!("{noon}north_azimuth_deg = 90")).expect("no fault").sky.expect("a sky");
    assert!((facts.sun_azimuth_deg - 270.0).abs() < 1.0, "{facts:?}");
    let without = sky("sun_elevation_deg = 60\nsun_azimuth_deg = 90\nsun = false").expect("no fault");
    assert!(without.sources.suns.is_empty() && without.sky.is_some_and(|s| s.sun_lx == 0.0));
    let night = sky("sun_elevation_deg = -12\nsun_azimuth_deg = 90").expect("no fault");
    assert!(night.sources.suns.is_empty() && night.sky.is_some_and(|s| s.sky_lx < 1.0 && s.sky_lx > 0.0));
}

#[test]
fn suns_by_the_model_and_by_level() {
    let keys = "type = \"sun\"\nelevation_deg = 30\nazimuth_deg = 0\n";
    let by_model = light(&format!("{keys}turbidity = 2")).expect("no fault");
    let level = "illuminance_lx = 90000\nilluminant = \"solar\"";
    let plain = light(&format!("{keys}{level}")).expect("no fault");
    let darkened = light(&format!("{keys}{level}\nlimb_darkening = true")).expect("no fault");
    let centre = |plan: &Plan| luminance(plan.sources.suns[0].radiance());
    assert!((1.2e9..2.0e9).contains(&centre(&by_model)), "{}", centre(&by_model));
    assert!(centre(&darkened) > 1.1 * centre(&plain), "a dark limb makes the centre brighter");
}

#[test]
fn what_gains_energy_is_refused() {
    let material = |keys: &str| plan(&format!("[[scene.materials]]\nname = \"m\"\n{keys}")).expect_err("gains energy");
    let lobes = material(
        "type = \"lafortune\"\nreflectance = 0.6\nlobes = [{ kind = \"mirror\", exponent = 20, albedo = 0.6 }]",
    );
    assert!(lobes.starts_with("job.toml:8:1: scene.materials.m: "), "{lobes}");
    let gloss = material("type = \"blinn_phong\"\nreflectance = 0.6\nspecular = 0.6\nexponent = 30");
    assert!(gloss.starts_with("job.toml:8:1: scene.materials.m: "), "{gloss}");
    let leaf = material("type = \"leaf\"\nreflectance = 0.6\ntransmittance = 0.5");
    assert!(leaf.contains("scene.materials.m: "), "{leaf}");
}

#[test]
fn mixes_name_materials_in_any_order_and_not_themselves() {
    let parts = "[[scene.materials]]\nname = \"mix\"\ntype = \"mix\"\na = \"grey\"\nb = \"gold\"\nweight = 0.3\n\
                 [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.2\n\
                 [[scene.materials]]\nname = \"gold\"\npreset = \"gold\"\n";
    assert!(plan(parts).is_ok());
    let circle = plan(&parts.replace("a = \"grey\"", "a = \"mix\"")).expect_err("a circle");
    assert!(circle.contains("job.toml:8:1: scene.materials.mix: ") && circle.contains("contains itself"), "{circle}");
}

/// A camera with scattered light, with further keys of the effects and a render section.
fn scattering(effects: &str, render: &str) -> Result<Plan, String> {
    const THIN: &str = "type = \"thin\", focal_length_mm = 6, f_number = 2.0, focus_distance_m = \"infinity\", distortion = \
                        { k1 = -0.5, direction = \"ideal_to_observed\", radius_unit = \"focal_lengths\" }";
    behind(THIN, effects, render)
}

/// A camera with a lens and effects, with a render section.
fn behind(lens: &str, effects: &str, render: &str) -> Result<Plan, String> {
    behind_with(lens, effects, render, &Assets::default())
}

fn behind_with(lens: &str, effects: &str, render: &str, assets: &Assets) -> Result<Plan, String> {
    let text = format!(
        r#"format = 1
[[cameras]]
name = "front"
position_m = [0, 0, 1]
look_at_m = [10, 0, 1]
lens = {{ {lens} }}
effects = {{ {effects} }}
[cameras.sensor]
width_px = 80
height_px = 60
pixel_pitch_um = 50
exposure_s = 0.01
cfa = "mono"
quantum_efficiency = 0.5
full_well_e = 1e4
read_noise_e = 2
dark_current_e_s = 0
gain_dn_per_e = 0.5
black_level_dn = 0
bits = 12
[render]
{render}
[scene]
"#
    );
    let read = |_: &Path| Ok(text.clone());
    let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).map_err(|f| f.to_string())?;
    let errors = |list: Vec<etendue_scene::DescriptionError>| list.iter().map(|f| format!("{f}\n")).collect::<String>();
    compile(&job, assets, &Choices::default()).map_err(errors)
}

const GLARE: &str = "glare = { scatter = 0.02, core_um = 10, exponent = 2.5 }";

#[test]
fn effects_keep_a_spectrum_and_a_margin() {
    let plan = scattering(GLARE, "").expect("no fault");
    let camera = &plan.cameras[0];
    assert!(camera.settings.bands.is_some() && !camera.settings.accumulates_electrons);
    assert_eq!(camera.film_size(), (120, 90), "a quarter of 80 × 60 on every side");
    let clean = scattering("glare = { scatter = 0, core_um = 10, exponent = 2.5 }", "").expect("no fault");
    assert!(clean.cameras[0].settings.bands.is_none() && clean.cameras[0].film_size() == (80, 60));
}

#[test]
fn effects_that_cannot_be_are_refused_where_they_stand() {
    let error = |effects: &str, render: &str| scattering(effects, render).expect_err("a fault");
    let message = error(GLARE, "accumulate = \"electrons\"");
    assert!(
        message.starts_with("job.toml:22:14: render.accumulate") && message.contains("[effects] require one"),
        "{message}"
    );
    let message = error("glare = { scatter = 0.02, core_um = 10, exponent = 2 }", "");
    assert!(message.contains("effects.glare") && message.contains("no finite integral"), "{message}");
    let message = error("margin = 0.5, glare = { scatter = 0, core_um = 10, exponent = 3 }", "");
    assert!(message.contains("effects.margin") && message.contains("no effect"), "{message}");
    let message = error("glare = { scatter = 0.7, core_um = 10, exponent = 3 }", "");
    assert!(message.contains("scatter") && message.contains("at most 0.5"), "{message}");
    assert!(error("", "").contains("contains no effect"));
    // The distortion folds outside the image, within a margin of its own width.
    let plan = scattering(&format!("margin = 1, {GLARE}"), "").expect("it is dark there");
    assert!(plan.notes.iter().any(|r| r.text.contains("which the lens effects use, is missing")), "{:?}", plan.notes);
}

const PINHOLE: &str = "type = \"pinhole\", focal_length_mm = 6, f_number = 2";

#[test]
fn a_point_spread_function_from_a_picture() {
    let pixels = |pixels: ImagePixels| {
        let image = ImageAsset { width: 3, height: pixels.len() as u32 / 3, pixels, to_rec_709: None, hash: [0; 32] };
        Assets { images: [("k.png".into(), image)].into(), ..Assets::default() }
    };
    let of = |keys: &str, assets: &Assets| {
        behind_with(PINHOLE, &format!("psf = {{ image = \"k.png\", image_pitch_um = {keys} }}"), "", assets)
    };
    let dot = pixels(ImagePixels::Gray8(vec![0, 51, 0, 51, 255, 51]));
    let plan = of("40, image_wavelength_nm = 650", &dot).expect("no fault");
    let camera = &plan.cameras[0];
    let Some(PointSpread::Image(image)) = camera.body.effects.psf() else { panic!("a picture") };
    // Bytes are linear numbers: 51 of 255 is a fifth.
    assert_eq!(image.parameters().light, [0.0, 0.2, 0.0, 0.2, 1.0, 0.2]);
    assert!(camera.settings.bands.is_some() && camera.film_size() == (82, 62), "{:?}", camera.film_size());
    let message = of("20", &Assets::default()).expect_err("no file");
    assert!(
        message.starts_with("job.toml:7:") && message.contains("effects.psf.image: the image k.png was not"),
        "{message}"
    );
    let message = of("20", &pixels(ImagePixels::Gray16(vec![0; 6]))).expect_err("dark");
    assert!(
        message.starts_with("job.toml:7:")
            && message.contains("effects.psf.image: ")
            && message.contains("0 everywhere"),
        "{message}"
    );
    let message = of("20", &pixels(ImagePixels::Rgb32F(vec![[0.5, -2.0, 0.5]; 3]))).expect_err("negative");
    assert!(message.contains("effects.psf.image: column 0 of row 0 of the point-spread image is -0.33"), "{message}");
    let message = of("60", &dot).expect_err("coarse");
    assert!(message.contains("effects.psf.image_pitch_um: ") && message.contains("separate dots"), "{message}");
    let message = behind(PINHOLE, "psf = { wavefront = [{ noll = 4, rms_um = 900 }] }", "").expect_err("steep");
    assert!(message.starts_with("job.toml:7:") && message.contains("effects.psf: the wavefront's slope"), "{message}");
}

const DOUBLE_GAUSS: &str = "type = \"prescription\", published = \"double-gauss\", focus_distance_m = \"infinity\"";

#[test]
fn ghosts_are_of_a_lens_of_surfaces() {
    let plan = behind(DOUBLE_GAUSS, "ghosts = true", "[output]\nghosts = true").expect("no fault");
    let camera = &plan.cameras[0];
    assert!(camera.settings.bands.is_some() && !camera.settings.accumulates_electrons && camera.products.ghosts);
    assert_eq!(camera.film_size(), (120, 90), "with light from a quarter of the picture beyond each edge");
    // The lens is traced to the edge of the film.
    let lit_sr = camera.body.lens.projected_solid_angle_sr(glam::DVec2::new(2.9, 2.2));
    assert!(lit_sr > 0.0, "lit beyond the picture's corner");
    let error = |lens: &str, effects: &str, output: &str| behind(lens, effects, output).expect_err("a fault");
    let message = error("type = \"pinhole\", focal_length_mm = 6, f_number = 2", "ghosts = true", "");
    assert!(message.contains("effects.ghosts") && message.contains("the lens is a pinhole"), "{message}");
    let message = error(DOUBLE_GAUSS, GLARE, "[output]\nghosts = true");
    assert!(message.contains("output.ghosts") && message.contains("models none"), "{message}");
    let message = error(DOUBLE_GAUSS, &format!("{GLARE}, sensor_reflectance = 0.1"), "");
    assert!(
        message.contains("effects.sensor_reflectance") && message.contains("no effect without ghosts"),
        "{message}"
    );
}

#[test]
fn a_lenss_coating_is_that_of_its_surfaces_against_air() {
    let of = |coating: &str| {
        let plan = behind(&format!("{DOUBLE_GAUSS}{coating}"), GLARE, "").expect("no fault");
        plan.cameras[0].body.lens.transmittance()
    };
    let (bare, coated, constant) = (of(""), of(", coating = { quarter_wave_nm = 550 }"), of(", coating = 0.99"));
    // Eight surfaces against air; the cemented two keep their reflectance, which is nearly zero.
    assert!(bare < 0.65 && coated > 0.9, "{bare} {coated}");
    assert!((constant / [0.99_f64; 8].iter().product::<f64>() - 1.0).abs() < 1e-3, "{constant}");
}

/// The angle response of micro-lenses needs the exit pupil, which the lens provides.
#[test]
fn chief_rays_come_from_the_lens() {
    let exit_mm = |lens: &str, more: &str| {
        let sensor = format!(
            "width_px = 8, height_px = 6, pixel_pitch_um = 6.0, cfa = \"mono\", quantum_efficiency = 0.5, exposure_s = 1, \
             full_well_e = 1e4, read_noise_e = 1, dark_current_e_s = 0, gain_dn_per_e = 0.1, black_level_dn = 0, bits = 12, \
             angle_response = {{ table = [[0, 1], [30, 0.5]]{more} }}"
        );
        let camera = CAMERA.replace("type = \"pinhole\", focal_length_mm = 6, f_number = 2.0", lens);
        let text = camera.replace("width_px = 8, height_px = 6, pixel_pitch_um = 6.0", &sensor) + "[scene]\n";
        let read = |_: &Path| Ok(text.clone());
        let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).expect("a job");
        let plan = compile(&job, &Assets::default(), &Choices::default()).expect("a plan");
        let body = &plan.cameras[0].body;
        let response = body.sensor.as_ref().expect("a sensor").parameters().light.angle_response.as_ref();
        (response.map(|r| r.exit_pupil_mm), body.lens.exit_pupil_distance_mm())
    };
    let gauss = "type = \"prescription\", published = \"double-gauss\", focus_distance_m = 2";
    let (used, of_lens) = exit_mm(gauss, "");
    assert_eq!(used, Some(of_lens));
    assert_eq!(exit_mm(gauss, ", exit_pupil_mm = 40").0, Some(40.0));
    assert_eq!(exit_mm("type = \"pinhole\", focal_length_mm = 6, f_number = 2.0", "").0, Some(6.0));
    assert_eq!(exit_mm("type = \"telecentric\", field_width_m = 1, f_number = 4.0", "").0, None, "all light at 0°");
}
