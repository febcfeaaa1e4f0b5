//! The plan's hash identifies a result, and headers state their origin.

use crate::support::{etendue, rendered, small, text};
use std::fs;

/// The first line of a job's plan: its hash.
fn hash(job: &str, options: &[&str]) -> String {
    let plan = etendue(["plan", job].into_iter().chain(options.iter().copied())).ok().out;
    plan.lines().next().expect("a plan has lines").to_owned()
}

/// A job whose reflectance is tabulated in `paint.csv` next to it.
const TABULATED_JOB: &str = "format = 1\n[scene]\nmaterials = [{ name = \"m\", type = \"diffuse\", reflectance = { spectrum = \
                      \"paint.csv\" } }]\n[[scene.objects]]\nname = \"o\"\nshape = { type = \"sphere\", radius_m = 1 }\n\
                      material = \"m\"\n[[cameras]]\nname = \"c\"\nposition_m = [-4, 0, 0]\nlook_at_m = [0, 0, 0]\n\
                      lens = { type = \"pinhole\", focal_length_mm = 2, f_number = 8 }\n\
                      sensor = { width_px = 4, height_px = 4, pixel_pitch_um = 100 }\n";

#[test]
fn one_value_of_one_spectrum_changes_the_hash_and_a_path_does_not() {
    let hash_of = |middle: &str| {
        let place = tempfile::tempdir().expect("a temporary folder");
        fs::write(place.path().join("job.toml"), TABULATED_JOB).expect("written");
        let table = format!("wavelength_nm,value\n400,0.2\n600,{middle}\n700,0.9\n");
        fs::write(place.path().join("paint.csv"), table).expect("written");
        hash(&text(&place.path().join("job.toml")), &[])
    };
    let (low, high, repeated) = (hash_of("0.3"), hash_of("0.8"), hash_of("0.3"));
    assert_ne!(low, high, "the hash must see inside a table");
    assert_eq!(low, repeated, "another folder is the same plan");
}

#[test]
fn what_decides_the_result_changes_the_hash_and_what_does_not_leaves_it() {
    let plain = hash(&small(), &[]);
    let changes =
        ["render.seed=5", "render.max_bounces=3", "cameras.front.lens.f_number=3", "cameras.front.sensor.bits=11"];
    for change in changes {
        assert_ne!(plain, hash(&small(), &["--set", change]), "{change}");
    }
    assert_eq!(plain, hash(&small(), &["--set", "render.tile_px=8"]));
}

/// Text of a fact in a header, from its bytes.
fn fact(exr: &[u8], name: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.exr");
    fs::write(&file, exr).expect("written");
    let report = etendue(["inspect", &text(&file)]).ok().out;
    let line = report.lines().find(|line| line.trim_start().starts_with(name)).unwrap_or("");
    line.trim_start().trim_start_matches(name).trim().to_owned()
}

#[test]
fn an_exposed_image_states_its_own_camera_and_geometry() {
    let files = rendered(&small(), &["--set", "render.route=pupil"]);
    let place = tempfile::tempdir().expect("a temporary folder");
    let radiance = place.path().join("radiance.exr");
    fs::write(&radiance, &files["front/radiance.exr"]).expect("written");
    let camera = place.path().join("other.toml");
    let narrow = "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 12\nf_number = 8\n\
                  [sensor]\nwidth_px = 9\nheight_px = 6\npixel_pitch_um = 100\n";
    fs::write(&camera, narrow).expect("written");
    let output = text(&place.path().join("out"));
    etendue(["expose", &text(&radiance), "--camera", &text(&camera), "-o", &output, "--seed", "9"]).ok();
    let exposed = fs::read(place.path().join("out/other/irradiance.exr")).expect("irradiance");
    assert_eq!((fact(&exposed, "camera "), fact(&exposed, "seed ")), ("other".to_owned(), "9".to_owned()));
    assert!(fact(&exposed, "geometry").starts_with("through the lens"));
    assert_eq!(fact(&exposed, "pupil_pitch_tan"), "", "the geometry of the radiance image is not its own");
    assert_eq!(fact(&exposed, "radiance_camera"), "front");
}

#[test]
fn a_width_of_bands_that_nobody_keeps_is_remarked_and_moves_no_wavelength() {
    let accumulates_electrons = ["--set", "output.radiance=false", "--set", "output.irradiance=false"];
    let wide = ["--set", "render.band_width_nm=97"].into_iter().chain(accumulates_electrons);
    let plan = etendue(["plan", &small()].into_iter().chain(wide)).ok().out;
    assert!(plan.contains("no spectrum is stored, so the width of bands has no effect"), "{plan}");
    let (a, b) = (
        rendered(&small(), &accumulates_electrons),
        rendered(&small(), &[&accumulates_electrons[..], &["--set", "render.band_width_nm=97"]].concat()),
    );
    assert!(a["front/raw.0000.png"] == b["front/raw.0000.png"]);
}
