//! Fog in scenes and over stored radiance.

use crate::bad_input::ModifiedJob;
use crate::support::{contents, etendue, small};
use etendue_core::SpectralCube;
use etendue_core::maths::f64::{exp, ln};
use etendue_core::quantity::Radiance;
use etendue_io::exr::{SpectralImage, read_spectral};

const FOG: &str = "[[scene.media]]\nname = \"fog\"\nvisibility = { distance_m = 80, contrast = 0.05 }\nshape = { type = \"layer\", top_m = 60 }\n\
                   phase = { type = \"isotropic\" }\n\n[[scene.lights]]\ntype = \"sun\"";
const SUN: &str = "[[scene.lights]]\ntype = \"sun\"";

/// Asserts that the job with this change of its fog is refused, at the place of its key.
#[track_caller]
fn refused(from: &str, to: &str, phrases: &[&str]) {
    assert!(FOG.contains(from));
    let job = ModifiedJob::new();
    job.replace_first("small.toml", SUN, &FOG.replacen(from, to, 1));
    job.render(&[]).refused(&[&["small.toml:", "scene.media.fog"], phrases].concat());
}

#[test]
fn unusable_fog() {
    let visibility = "visibility = { distance_m = 80, contrast = 0.05 }";
    refused("distance_m = 80", "distance_m = 0", &["visibility.distance_m", "found 0", "above 0"]);
    refused("contrast = 0.05", "contrast = 1.5", &["visibility.contrast", "1.5"]);
    refused(visibility, "extinction_per_m = -0.1", &["extinction_per_m", "-0.1", "at least 0"]);
    refused(visibility, &format!("{visibility}\nextinction_per_m = 0.1"), &["visibility", "extinction_per_m"]);
    refused("name = \"fog\"", "name = \"fog\"\nalbedo = 1.2", &["albedo", "1.2", "at most 1"]);
    refused("\"isotropic\"", "\"henyey_greenstein\", g = 1.0", &["phase.g", "0.99"]);
    refused("\"layer\", top_m = 60", "\"box\", size_m = [1, 0, 1]", &["shape.size_m", "above 0"]);
}

#[test]
fn a_place_of_what_is_everywhere() {
    refused(
        "shape = { type = \"layer\", top_m = 60 }",
        "position_m = [0, 0, 1]",
        &["position_m", "the medium is unbounded", "give a \"shape\" with bounds"],
    );
}

const WEATHER: &str = "format = 1\n[airlight]\ntype = \"uniform\"\nradiance_w_m2_sr_nm = 0.01\n\n[[fog]]\nname = \"fog\"\n\
                       visibility = { distance_m = 80, contrast = 0.05 }\n";

/// Radiance through fog is the scene's times the transmittance, plus the airlight; it can be exposed; nothing is overwritten.
#[test]
fn fog_over_stored_radiance() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (job, rendered) = (small(), path("clear"));
    let arguments = ["--set", "render.route=pupil", "--set", "output.radiance=true"];
    etendue(["render", &job, "-o", &rendered].into_iter().chain(arguments)).ok();
    let clear = contents(&folder.path().join("clear"));
    let name = clear.keys().find(|name| name.ends_with("/radiance.exr")).expect("radiance");
    std::fs::write(path("fog.toml"), WEATHER).expect("written");
    let stored = path(&format!("clear/{name}"));
    let (file, fog) = (path("fog.toml"), path("fog"));
    let weather = ["weather", &stored, "--weather", &file, "-o", &fog];
    let output = etendue(weather).ok();
    assert!(
        ["radiance.exr", "transmittance.exr", "airlight.exr"].iter().all(|file| output.out.contains(file)),
        "{output:?}"
    );
    let read = |file: &str| read_spectral(folder.path().join(file).as_path()).expect("readable");
    let (before, after, added) = (read(&format!("clear/{name}")), read("fog/radiance.exr"), read("fog/airlight.exr"));
    let cube = |image| match image {
        SpectralImage::Radiance(of) => of.cube,
        SpectralImage::Irradiance(_) => panic!("radiance"),
    };
    let distance = after.distance.expect("distances");
    let (before, after, added) = (cube(before.image), cube(after.image), cube(added.image));
    let beta = -ln(0.05) / 80.0;
    for (i, far) in distance.samples().iter().enumerate() {
        let of = |cube: &SpectralCube<Radiance>| f64::from(cube.planes()[3].samples()[i]);
        let through = if far.is_nan() { 1.0 } else { exp(-beta * f64::from(*far)) };
        let expected = of(&before) * through + 0.01 * (1.0 - through);
        assert!((of(&after) - expected).abs() < 1e-5 * expected.max(0.01), "{i}: {} {expected}", of(&after));
        assert!((of(&added) - 0.01 * (1.0 - through)).abs() < 1e-7);
    }
    etendue(weather).refused(&["radiance.exr", "--overwrite"]);
    std::fs::write(path("none.toml"), WEATHER.replace("0.01", "-1")).expect("written");
    etendue(["weather", &stored, "--weather", &path("none.toml"), "-o", &path("none")]).refused(&[
        "none.toml:4",
        "airlight.radiance_w_m2_sr_nm",
        "-1",
    ]);
    assert!(!folder.path().join("none").exists());
}

const RAIN: &str = "format = 1\nexposure_s = 0.01\n[airlight]\ntype = \"uniform\"\nradiance_w_m2_sr_nm = 0.01\n\n[precipitation]\ntype = \"rain\"\n\
                    rate_mm_h = 100\nsmallest_px = 0.05\n";

/// Streaks change light and not distances, equally in every run; ineffective or missing keys are refused at their place.
#[test]
fn streaks_over_stored_radiance() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (job, clear) = (small(), path("clear"));
    let arguments = ["--set", "render.route=pupil", "--set", "output.radiance=true"];
    etendue(["render", &job, "-o", &clear].into_iter().chain(arguments)).ok();
    let files = contents(&folder.path().join("clear"));
    let name = files.keys().find(|name| name.ends_with("/radiance.exr")).expect("radiance");
    let stored = path(&format!("clear/{name}"));
    let run = |text: &str, out: &str| {
        std::fs::write(path("weather.toml"), text).expect("written");
        etendue(["weather", &stored, "--weather", &path("weather.toml"), "-o", &path(out)])
    };
    run(RAIN, "one").ok();
    run(RAIN, "two").ok();
    let [one, two] = ["one", "two"].map(|out| contents(&folder.path().join(out)));
    assert!(one == two && one.contains_key("cover.exr"), "{:?}", one.keys());
    run(&RAIN.replace("rate_mm_h", "seed = 1\nrate_mm_h"), "three").ok();
    assert!(one["radiance.exr"] != contents(&folder.path().join("three"))["radiance.exr"], "other drops");
    let distance = |file: &std::path::Path| read_spectral(file).expect("readable").distance.expect("distances");
    let far = |of: &std::path::Path| distance(of).samples().iter().map(|m| m.to_bits()).collect::<Vec<_>>();
    assert_eq!(far(&folder.path().join("one/radiance.exr")), far(&folder.path().join(format!("clear/{name}"))));
    let assert_refused = |text: &str, phrases: &[&str]| run(text, "none").refused(phrases);
    assert_refused(&RAIN.replace("exposure_s = 0.01\n", ""), &["weather.toml:6", "precipitation", "exposure_s"]);
    assert_refused(&RAIN.replace("0.01\n[a", "-1\n[a"), &["weather.toml:2", "exposure_s", "-1"]);
    assert_refused(&RAIN.replace("= 100", "= 400"), &["weather.toml:9", "400 mm/h", "0.1 to 150"]);
    assert_refused(&RAIN.replace("smallest_px = 0.05", "crystals = \"rimed\""), &["weather.toml:10", "crystals"]);
    let (head, _) = RAIN.split_once("[precipitation]").expect("it has one");
    assert_refused(head, &["weather.toml:2", "\"exposure_s\" has no effect", "precipitation"]);
    assert_refused(&head.replace("exposure_s = 0.01\n", ""), &["weather.toml", "no weather", "fog"]);
    assert!(!folder.path().join("none").exists());
}

/// A mesh with a hole has no inside, and a scene without weather has no layers of it.
#[test]
fn open_meshes_and_layers_of_nothing() {
    let shape = "shape = { type = \"layer\", top_m = 60 }";
    let job = ModifiedJob::new();
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n";
    job.write("open.obj", mesh);
    job.replace_first("small.toml", SUN, &FOG.replacen(shape, "shape = { type = \"mesh\", file = \"open.obj\" }", 1));
    job.render(&[]).refused(&["small.toml:", "shape.file", "not closed", "3 of its 6 edges", "close its holes"]);
    let clear = ModifiedJob::new();
    clear
        .render(&["--set", "output.weather=true"])
        .refused(&["output.weather", "neither [[media]] nor [precipitation]"]);
}
