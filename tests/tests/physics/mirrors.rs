//! Lens files with mirrors, from the text to real rays and light: rayoptics and optiland, which read the same texts (tests/oracles/mirrors.py), and closed
//! forms.

use etendue_io::prescription::read_prescription;
use etendue_optics::effects::PointSpread;
use etendue_optics::prescription::trace::LensRay;
use etendue_optics::{Lens, Prescription};
use etendue_scene::asset::PrescriptionAsset;
use etendue_tests::Job;
use glam::{DVec2, DVec3};
use serde_json::Value;
use std::path::Path;

const FIGURES: &str = include_str!("../../oracles/figures/mirrors.json");

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn vector(value: &Value) -> DVec3 {
    let list: Vec<f64> = value.as_array().expect("a list").iter().map(number).collect();
    DVec3::from_slice(&list)
}

fn files() -> Vec<Value> {
    let figures: Value = serde_json::from_str(FIGURES).expect("JSON");
    figures["files"].as_array().expect("files").clone()
}

fn read(name: &str, text: &str) -> PrescriptionAsset {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).expect("the folder of tests' files can be written");
    read_prescription(&path).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A camera with the lens of a file, before lights of the scene.
fn camera(name: &str, asset: PrescriptionAsset, pixel_pitch_um: f64, further: &str) -> Job {
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        lens = {{ type = "prescription", file = "{name}" }}
        sensor = {{ width_px = 33, height_px = 33, pixel_pitch_um = {pixel_pitch_um} }}
        {further}
        "#
    ))
    .with_lens_file(name, asset)
}

fn prescription(name: &str, text: &str) -> Prescription {
    let plan = camera(name, read(name, text), 1.0, "[scene]").plan();
    let Lens::Prescription(lens) = &plan.cameras[0].body.lens else { panic!("a prescription") };
    lens.prescription().clone()
}

/// Index of the programs by which a file is compared.
const PROGRAMS: [&str; 2] = ["rayoptics", "optiland"];

#[test]
fn focal_lengths_and_real_rays_agree_with_other_programs() {
    let mut compared = 0;
    for file in files() {
        let name = file["name"].as_str().expect("a name");
        let text = file["text"].as_str().expect("a text");
        let lens = prescription(name, text);
        let turned = lens.surfaces().iter().filter(|s| s.is_mirror()).count() % 2 == 1;
        // The programs keep the axes of the scene: behind an odd number of mirrors z points back.
        let sense = if turned { -1.0 } else { 1.0 };
        let p = lens.paraxial();
        for program in PROGRAMS.iter().map(|program| &file[*program]).filter(|figures| !figures.is_null()) {
            let focal_mm = sense * number(&program["efl_mm"]);
            // The programs put the object at 10¹³ mm or at infinity.
            assert!((p.focal_length_mm / focal_mm - 1.0).abs() < 1e-8, "{name}: {} for {focal_mm}", p.focal_length_mm);
            if let Some(back_mm) = program["bfl_mm"].as_f64() {
                assert!(
                    (p.back_focus_mm - sense * back_mm).abs() < 1e-7 * focal_mm.abs(),
                    "{name}: {}",
                    p.back_focus_mm
                );
            }
            for (start, end) in
                file["rays"].as_array().expect("rays").iter().zip(program["rays"].as_array().expect("rays"))
            {
                let direction = vector(&start["direction"]).normalize();
                let ray = LensRay { point: vector(&start["point_mm"]) - direction * 100.0, direction };
                // The programs ignored obscurations and clear apertures.
                let Ok((out, _)) = lens.to_sensor(ray, number(&file["nm"])) else { continue };
                let image = out.point + out.direction * ((lens.sensor_position_mm() - out.point.z) / out.direction.z);
                let [x, y] = [0, 1].map(|i| number(&end["image_mm"][i]));
                // Rounding of sums of lengths up to 3·10⁴ mm, magnified fourfold by the secondary, and of radii written with ten digits.
                let miss = image.truncate() - DVec2::new(x, y);
                assert!(miss.length() < 1e-9 * focal_mm.abs(), "{name}: {miss}");
                let expected = vector(&end["direction"]) * DVec3::new(1.0, 1.0, sense);
                assert!((out.direction - expected).length() < 1e-9, "{name}: {}", out.direction - expected);
                compared += 1;
            }
        }
    }
    // Five heights, on the axis and off it, by ten figures; holes and edges stop some.
    assert!(compared > 60, "{compared} rays");
}

#[test]
fn holes_and_discs_of_files_obscure() {
    let ratio = |name: &str| {
        let file = files().into_iter().find(|file| file["name"] == name).expect("a file");
        prescription(name, file["text"].as_str().expect("a text")).axial_obscured_ratio()
    };
    assert!((ratio("hubble.zmx") - 177.800_35 / 1200.0).abs() < 1e-9);
    assert!((ratio("gregorian.zmx") - 0.3).abs() < 1e-9);
    // The disc on the rear of the meniscus: the front (n = 1.5187 at 555 nm) spreads parallel light by (n − 1) t/(n R) up to there. The next order is the
    // square of the disc's radius over that of the surface, 0.011, times that.
    let spread = 1.0 + 0.5187 / 1.5187 * 7.218_046 / 91.376_347;
    assert!((ratio("maksutov.seq") * spread / (9.716_599 / 44.45) - 1.0).abs() < 1e-3, "{}", ratio("maksutov.seq"));
    assert_eq!(ratio("ritchey-chretien.seq"), 0.0);
}

/// A Cassegrain of 50 mm diameter, f/8, whose secondary and its holder hide a disc of radius 10 mm.
fn cassegrain(disc: &str) -> String {
    format!(
        "VERS 140124 258 36214\nMODE SEQ\nUNIT MM X W X CM MR CPMM\nENPD 50\nFTYP 0 0 1 1 0 0 0\nYFLN 0\nWAVM 1 0.55 1\nPWAV 1\n\
         SURF 0\n  TYPE STANDARD\n  CURV 0.0\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 \"\"\n\
         SURF 1\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 150\n{disc}  DIAM 10 1 0 0 1 \"\"\n\
         SURF 2\n  STOP\n  TYPE STANDARD\n  CURV -0.0025\n  CONI -1\n  GLAS MIRROR 0 0 1.5 40\n  DISZ -150\n  DIAM 25 1 0 0 1 \"\"\n\
         SURF 3\n  TYPE STANDARD\n  CURV -0.005\n  CONI -9\n  GLAS MIRROR 0 0 1.5 40\n  DISZ 100\n  DIAM 9 1 0 0 1 \"\"\n\
         SURF 4\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 0\n  DIAM 10 0 0 0 1 \"\"\n"
    )
}

const DISC: &str = "  OBSC 0 10 0\n";

#[test]
fn an_obscuration_takes_its_part_of_the_light_of_a_wall() {
    let wall = "[scene]\nmaterials = [{ name = \"wall\", type = \"emitter\", emission = { radiance_w_m2_sr_nm = 1 } }]\n\
                [[scene.objects]]\nname = \"wall\"\nshape = { type = \"quad\", size_m = [50, 50] }\nmaterial = \"wall\"\n\
                position_m = [30, 0, 0]\nrotation_deg = [0, -90, 0]\n\
                [render]\nspp = 4096\nreplicates = 16\nwavelength_range_nm = [500, 600]\nband_width_nm = 100\n[output]\nirradiance = true\n";
    let at_centre = |name: &str, disc: &str| {
        let row = camera(name, read(name, &cassegrain(disc)), 1.0, wall).shot().irradiance();
        f64::from(row.mean[33 * 16 + 16])
    };
    let (open, obscured) = (at_centre("open.zmx", ""), at_centre("disc.zmx", DISC));
    // f/8: sin θ′ of the marginal ray is 25/400 of an aplanatic lens; of a paraboloid's Cassegrain it is 2 tan/(1 + tan²) of half the angle.
    let tangent = 25.0 / 800.0;
    let edge = |part: f64| 2.0 * part * tangent / (1.0 + part * part * tangent * tangent);
    let exact = |hole: f64| core::f64::consts::PI * (edge(1.0) * edge(1.0) - edge(hole) * edge(hole));
    // 65 536 samples of a region of which 1 %, or 17 %, is dark: four standard deviations are 0.2 % and 0.7 %.
    assert!((open / exact(0.0) - 1.0).abs() < 3e-3, "{open} for {}", exact(0.0));
    assert!((obscured / exact(0.4) - 1.0).abs() < 8e-3, "{obscured} for {}", exact(0.4));
}

#[test]
fn a_point_out_of_focus_is_a_ring() {
    // A lamp of 2 mm at 30 m, with the sensor at infinity focus: the image is 5.41 mm behind the sensor, and the cone of f/8 is 0.667 mm wide there.
    let scene = "[scene]\nmaterials = [{ name = \"light\", type = \"emitter\", emission = { radiance_w_m2_sr_nm = 1 } }]\n\
                 [[scene.objects]]\nname = \"lamp\"\nshape = { type = \"sphere\", radius_m = 0.001 }\nmaterial = \"light\"\nposition_m = [30, 0, 0]\n\
                 [render]\nspp = 4096\nreplicates = 1\nwavelength_range_nm = [500, 600]\nband_width_nm = 100\n[output]\nirradiance = true\n";
    let image = camera("ring.zmx", read("ring.zmx", &cassegrain(DISC)), 30.0, scene).shot().irradiance();
    let light_within = |low_mm: f64, high_mm: f64| {
        let radius_mm = |i: usize| 0.03 * DVec2::new((i % 33) as f64 - 16.0, (i / 33) as f64 - 16.0).length();
        (0..33 * 33)
            .filter(|i| (low_mm..high_mm).contains(&radius_mm(*i)))
            .map(|i| f64::from(image.mean[i]))
            .sum::<f64>()
    };
    let total = light_within(0.0, 1.0);
    // f²/(30 m − f) behind the focus over 8, halved: 0.338 mm outside, 0.4 of it inside; pixels are 0.03 mm, the lamp's image 0.03 mm.
    assert!(total > 0.0);
    assert!(light_within(0.0, 0.10) < 1e-3 * total, "dark within: {} of {total}", light_within(0.0, 0.10));
    assert!(light_within(0.11, 0.38) > 0.99 * total, "{} of {total}", light_within(0.11, 0.38));
}

/// A camera with the Cassegrain in the words of the scene language.
fn described(primary: &str, further: &str) -> Job {
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        sensor = {{ width_px = 33, height_px = 33, pixel_pitch_um = 10 }}
        [cameras.lens]
        type = "prescription"
        focus_distance_m = "infinity"
        surfaces = [
          {{ thickness_mm = 150, semi_aperture_mm = 40, obscured_radius_mm = 10 }},
          {{ mirror = true, radius_mm = -400, conic = -1, thickness_mm = 150, semi_aperture_mm = 25, stop = true, {primary} }},
          {{ mirror = true, radius_mm = 200, conic = -9, semi_aperture_mm = 9, coating = 0.88 }},
        ]
        {further}
        [scene]
        "#
    ))
}

#[test]
fn the_scene_language_describes_the_same_telescope_along_the_light() {
    let plan = described("coating = 0.9", "").plan();
    let Lens::Prescription(lens) = &plan.cameras[0].body.lens else { panic!("a prescription") };
    let file = prescription("same.zmx", &cassegrain(DISC));
    let (own, other) = (lens.prescription().paraxial(), file.paraxial());
    // Radii of the file are inverses of its curvatures.
    assert!((own.focal_length_mm - other.focal_length_mm).abs() < 1e-9 && (own.back_focus_mm - 100.0).abs() < 1e-9);
    assert!((lens.obscured_ratio() - 0.4).abs() < 1e-9 && (file.axial_obscured_ratio() - 0.4).abs() < 1e-9);
    assert!((lens.transmittance() - 0.9 * 0.88).abs() < 1e-12);
}

#[test]
fn keys_without_an_effect_on_a_mirror_are_refused() {
    for (key, words) in [
        ("glass = \"N-BK7\"", "\"glass\" of a mirror has no effect"),
        ("coating = { quarter_wave_nm = 550 }", "the coating of a mirror is its reflectance"),
        ("obscured_radius_mm = 25", "leaves nothing open"),
    ] {
        let message = described(key, "").compiled().map(|_| ()).expect_err(key);
        assert!(message.contains(words), "{key}: {message}");
    }
}

#[test]
fn diffraction_is_that_of_the_ring_and_the_pupil_route_says_what_it_leaves_out() {
    let plan = described("", "[cameras.effects]\npsf = {}\n").plan();
    let Some(PointSpread::Aperture(psf)) = plan.cameras[0].body.effects.psf() else { panic!("diffraction") };
    assert!((psf.parameters().obstruction - 0.4).abs() < 1e-9, "{psf:?}");
    assert!(plan.warnings().iter().all(|warning| !warning.contains("obscuration")));
    let pupil =
        described("", "").replaced("[scene]", "[scene]\n[render]\nroute = \"pupil\"\ndepth_of_field = \"physical\"");
    let warnings = pupil.plan().warnings();
    assert!(warnings.iter().any(|warning| warning.contains("without its central obscuration")), "{warnings:?}");
}

/// An ideal lens as Zemax writes it: all fields are sharp, without distortion.
#[test]
fn a_paraxial_surface_of_zemax_is_a_lens_without_aberrations() {
    let text = "MODE SEQ\nUNIT MM X W X CM MR CPMM\nENPD 5\nFTYP 0 0 2 1 0 0 0\nYFLN 0 10\nWAVM 1 0.58756 1\nPWAV 1\n\
                SURF 0\n  TYPE STANDARD\n  CURV 0.0\n  DISZ INFINITY\n  DIAM 0 0 0 0 1 \"\"\n\
                SURF 1\n  STOP\n  TYPE PARAXIAL\n  CURV 0.0\n  PARM 1 50\n  PARM 2 1\n  DISZ 50\n  DIAM 6 1 0 0 1 \"\"\n\
                SURF 2\n  TYPE STANDARD\n  CURV 0.0\n  DISZ 0\n  DIAM 10 0 0 0 1 \"\"\n";
    let plan = camera("ideal.zmx", read("ideal.zmx", text), 300.0, "[scene]").plan();
    let Lens::Prescription(lens) = &plan.cameras[0].body.lens else { panic!("a prescription") };
    let report = lens.report(3);
    assert!((report.first_order.focal_length_mm - 50.0).abs() < 1e-9 && (report.f_number - 10.0).abs() < 1e-9);
    for image in report.fields.iter().map(|field| field.image.as_ref().expect("an image")) {
        assert!(image.spot.expect("a spot").radius_mm < 1e-9 && image.distortion.expect("a distortion").abs() < 1e-9);
    }
}

#[test]
fn the_spot_of_a_telescope_is_that_of_one_ring() {
    let plan = camera("spot.zmx", read("spot.zmx", &cassegrain(DISC)), 10.0, "[scene]").plan();
    let Lens::Prescription(lens) = &plan.cameras[0].body.lens else { panic!("a prescription") };
    let axis = lens.report(2).fields[0].image.clone().expect("an image");
    assert!(axis.spot.expect("a spot").radius_mm < 1e-9 && axis.other_bundles.is_empty());
}
