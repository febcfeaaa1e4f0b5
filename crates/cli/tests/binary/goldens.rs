//! Stored results with mean and variance, compared by `etendue compare` with renders of another seed.
//!
//! The level of the Z test is the program's default, 0.001 for a whole file over all its pixels and bands. The seeds are fixed: a test that passes
//! always passes, and one in a thousand new seeds would fail.

use crate::support::{bless, etendue, root, tests, text};
use std::path::{Path, PathBuf};

/// A stored result and its settings.
struct Golden {
    name: &'static str,
    job: &'static str,
    options: &'static [&'static str],
    /// A change of the scene that must be detected.
    change: &'static str,
}

/// Sixteen replicates, coarse bands; 30 pixels per row hold little more than a test needs.
const COMMON: [&str; 10] = [
    "--set",
    "render.replicates=16",
    "--set",
    "render.band_width_nm=75",
    "--set",
    "render.wavelength_range_nm=[400, 700]",
    "--set",
    "output={ radiance = true, variance = true }",
    "--camera",
    "front",
];

const GOLDENS: [Golden; 4] = [
    Golden {
        name: "furnace",
        job: "scenes/furnace/furnace.toml",
        options: &[
            "--spp",
            "32",
            "--set",
            "cameras.front.sensor.width_px=24",
            "--set",
            "cameras.front.sensor.height_px=24",
            "--set",
            "cameras.front.sensor.pixel_pitch_um=100",
        ],
        change: "scene.materials.white.reflectance=0.98",
    },
    Golden {
        name: "cornell",
        job: "scenes/cornell/cornell.toml",
        options: &[
            "--spp",
            "256",
            "--set",
            "cameras.front.sensor.width_px=32",
            "--set",
            "cameras.front.sensor.height_px=32",
            "--set",
            "cameras.front.sensor.pixel_pitch_um=781.25",
        ],
        change: "scene.materials.lamp.emission.luminance_cd_m2=22000",
    },
    Golden {
        name: "sphere-on-plane",
        job: "scenes/sphere-on-plane/sphere-on-plane.toml",
        options: &[
            "--spp",
            "128",
            "--set",
            "cameras.front.sensor.width_px=32",
            "--set",
            "cameras.front.sensor.height_px=32",
            "--set",
            "cameras.front.sensor.pixel_pitch_um=80",
        ],
        change: "scene.materials.grey.reflectance=0.525",
    },
    Golden {
        name: "street",
        job: "scenes/street/street.toml",
        options: &[
            "--spp",
            "64",
            "--set",
            "cameras.front.sensor.width_px=48",
            "--set",
            "cameras.front.sensor.height_px=30",
            "--set",
            "cameras.front.sensor.pixel_pitch_um=120",
        ],
        change: "scene.environment.sun_elevation_deg=42",
    },
];

impl Golden {
    fn file(&self) -> PathBuf {
        tests().join(format!("goldens/{}.exr", self.name))
    }

    /// Renders into a folder; returns the path of the radiance image.
    fn render(&self, folder: &Path, further: &[&str]) -> String {
        let start = ["render", self.job, "-o"].map(str::to_owned);
        let options = COMMON.iter().chain(self.options).chain(further).map(|s| (*s).to_owned());
        etendue(start.into_iter().chain([text(folder)]).chain(options)).ok();
        text(&folder.join("front/radiance.exr"))
    }

    fn check(&self) {
        let place = tempfile::tempdir().expect("a temporary folder");
        if bless() {
            let rendered = self.render(&place.path().join("golden"), &["--seed", "1000"]);
            std::fs::copy(rendered, self.file()).expect("the golden result can be written");
        }
        let golden = text(&self.file());
        let same = self.render(&place.path().join("same"), &["--seed", "1"]);
        let output = etendue(["compare", &golden, &same, "--difference", &text(&place.path().join("none"))]);
        assert_eq!(output.status, 0, "{}{}", output.out, write_comparison(self.name, &golden, &same));
        assert!(output.out.contains("no significant difference"), "{}", output.out);
        assert!(!place.path().join("none").exists(), "no pictures of no difference");

        let changed = self.render(&place.path().join("changed"), &["--seed", "1", "--set", self.change]);
        let image_folder = place.path().join("difference");
        let output = etendue(["compare", &golden, &changed, "--difference", &text(&image_folder)]);
        assert_eq!(output.status, 1, "{} is not found:\n{}", self.change, output.out);
        assert!(output.out.contains("they differ") && output.err.contains("differ"), "{}{}", output.out, output.err);
        for name in ["a.png", "b.png", "difference.png"] {
            etendue(["inspect", &text(&image_folder.join(name))]).ok();
        }
    }
}

/// Writes image, reference and difference for a developer; returns their paths.
fn write_comparison(name: &str, golden: &str, actual: &str) -> String {
    let folder = root().join("target/golden-differences").join(name);
    etendue(["compare", golden, actual, "--difference", &text(&folder)]);
    format!("image, reference and difference are in {}", folder.display())
}

#[test]
fn furnace() {
    GOLDENS[0].check();
}

#[test]
fn cornell() {
    GOLDENS[1].check();
}

#[test]
fn sphere_on_plane() {
    GOLDENS[2].check();
}

#[test]
fn street() {
    GOLDENS[3].check();
}

#[test]
fn the_stored_results_are_small() {
    let size: u64 = GOLDENS.iter().map(|g| std::fs::metadata(g.file()).map_or(0, |m| m.len())).sum();
    assert!(size > 0 && size < 300_000, "{size} bytes");
}

#[test]
fn comparing_a_result_with_itself_finds_nothing_and_says_so_in_json() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let rendered = GOLDENS[0].render(place.path(), &["--seed", "4"]);
    let output = etendue(["compare", &rendered, &rendered, "--json"]).ok();
    let comparison: serde_json::Value = serde_json::from_str(&output.out).expect("JSON");
    assert_eq!(comparison["differ"], false);
    let channels = comparison["channels"].as_array().expect("a list of channels");
    assert!(channels.len() == 4 && channels.iter().all(|c| c["unequal"] == 0), "{}", output.out);
}

/// The difference of a darker scene and a brighter one is negative; exchanged it has the opposite sign and the same magnitude.
#[test]
fn a_comparison_states_which_result_is_subtracted() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let lamp = |name: &str, luminance: &str| {
        let change = format!("scene.materials.lamp.emission.luminance_cd_m2={luminance}");
        GOLDENS[1].render(&place.path().join(name), &["--seed", "4", "--set", &change])
    };
    let (dark, bright) = (lamp("dark", "10000"), lamp("bright", "20000"));
    let output = etendue(["compare", &dark, &bright]);
    assert!(output.out.starts_with(&format!("difference = A − B = {dark} − {bright}\n")), "{}", output.out);
    let bias = |a: &str, b: &str| {
        let report: serde_json::Value = serde_json::from_str(&etendue(["compare", a, b, "--json"]).out).expect("JSON");
        assert_eq!((&report["difference"], &report["a"], &report["b"]), (&"a - b".into(), &a.into(), &b.into()));
        report["channels"][0]["errors"]["bias"].as_f64().expect("a number")
    };
    assert!(bias(&dark, &bright) < 0.0);
    assert_eq!(bias(&dark, &bright), -bias(&bright, &dark));
}

#[test]
fn electrons_folded_and_beside_a_cube_agree() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str, further: &[&str]| {
        let output = text(&place.path().join(name));
        let common = ["--spp", "64", "--set", "render.replicates=16"];
        etendue(["render", &crate::support::small(), "-o", &output].iter().chain(&common).chain(further)).ok();
        format!("{output}/front/electrons.exr")
    };
    let cube = file("cube", &[]);
    let accumulates_electrons =
        file("folded", &["--seed", "2", "--set", "output.radiance=false", "--set", "output.irradiance=false"]);
    assert_eq!(etendue(["compare", &cube, &accumulates_electrons]).status, 0);
}
