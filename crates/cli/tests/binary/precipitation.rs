//! Rain and snow: frames, shards and ground truth, and refusals.

use crate::support::{contents, etendue, text};
use std::collections::BTreeMap;
use std::fs;
use tempfile::TempDir;

const RAIN: &str = "type = \"rain\", rate_mm_h = 100, smallest_px = 0.05";

/// A job of a wall in weather; `falls` is the precipitation, or nothing.
struct Weather {
    folder: TempDir,
}

impl Weather {
    fn new(falls: &str) -> Self {
        let place = tempfile::tempdir().expect("a temporary folder");
        let falls = if falls.is_empty() { String::new() } else { format!("precipitation = {{ {falls} }}\n") };
        let job = format!(
            "format = 1\n[sequence]\nframe_rate_hz = 10\n[scene]\n{falls}\
             environment = {{ type = \"uniform\", luminance_cd_m2 = 100, illuminant = \"D65\" }}\n\
             [[scene.materials]]\nname = \"dark\"\ntype = \"diffuse\"\nreflectance = 0.02\n\
             [[scene.objects]]\nname = \"ball\"\nshape = {{ type = \"sphere\", radius_m = 3 }}\nmaterial = \"dark\"\nposition_m = [9, 0, 1]\n\
             [[cameras]]\nname = \"c\"\nposition_m = [0, 0, 1]\nrotation_deg = [0, 0, 0]\n\
             lens = {{ type = \"pinhole\", focal_length_mm = 4, f_number = 2 }}\n\
             [cameras.sensor]\nwidth_px = 40\nheight_px = 32\npixel_pitch_um = 60\nexposure_s = 0.01\n\
             cfa = \"mono\"\nquantum_efficiency = 0.6\nfull_well_e = 20000\n\
             read_noise_e = 2\ndark_current_e_s = 5\ngain_dn_per_e = 0.2\nblack_level_dn = 64\nbits = 12\n\
             [render]\nspp = 4\nmax_bounces = 2\ntile_px = 16\n[output]\nradiance = true\ndepth_png = true\n"
        );
        fs::write(place.path().join("job.toml"), job).expect("written");
        Self { folder: place }
    }

    fn job(&self) -> String {
        text(&self.folder.path().join("job.toml"))
    }

    fn render(&self, more: &[&str]) -> BTreeMap<String, Vec<u8>> {
        let name = format!("out{}", more.concat().replace('/', "-"));
        let out = self.folder.path().join(name);
        etendue([&["render", &self.job(), "-o", &text(&out)], more].concat()).ok();
        contents(&out)
    }

    fn plan(&self) -> String {
        etendue(["plan", &self.job()]).ok().out
    }
}

#[test]
fn a_frame_alone_has_the_drops_that_it_has_in_a_sequence() {
    let weather = Weather::new(RAIN);
    let (all, alone) = (weather.render(&["--frames", "0..3"]), weather.render(&["--frames", "2..3"]));
    let light = |files: &BTreeMap<String, Vec<u8>>, frame: u32| files[&format!("c/radiance.{frame:04}.exr")].clone();
    assert!(light(&all, 2) == light(&alone, 2));
    assert!(light(&all, 0) != light(&all, 1), "the drops of a tenth of a second ago have fallen");
}

#[test]
fn shards_see_the_same_rain() {
    let weather = Weather::new(RAIN);
    let full = weather.render(&[]);
    let shards: Vec<String> = (0..2)
        .map(|i| {
            let out = text(&weather.folder.path().join(format!("shard{i}")));
            etendue(["render", &weather.job(), "-o", &out, "--shard", &format!("{i}/2")]).ok();
            out
        })
        .collect();
    let merged = text(&weather.folder.path().join("merged"));
    etendue(["merge", &shards[0], &shards[1], "-o", &merged]).ok();
    let merged = contents(&weather.folder.path().join("merged"));
    assert!(full["c/radiance.0000.exr"] == merged["c/radiance.0000.exr"]);
}

/// Depth and identities are those of the same world without weather; light is not.
#[test]
fn ground_truth_does_not_see_rain() {
    let (dry, wet) = (Weather::new("").render(&[]), Weather::new(RAIN).render(&[]));
    let of = |files: &BTreeMap<String, Vec<u8>>, start: &str, end: &str| {
        let file = files.iter().find(|(name, _)| name.starts_with(start) && name.ends_with(end));
        file.unwrap_or_else(|| panic!("{start}: {:?}", files.keys())).1.clone()
    };
    assert!(of(&dry, "c/depth", ".png") == of(&wet, "c/depth", ".png"));
    assert!(of(&dry, "c/radiance", ".exr") != of(&wet, "c/radiance", ".exr"));
}

#[test]
fn the_plan_reports_precipitation_and_its_model() {
    let plan = Weather::new("type = \"rain\", rate_mm_h = 10").plan();
    for phrase in ["rain of 10 mm/h", "11.6 mm/h", "3165 drops per m³", "1.56 1/km", "drops"] {
        assert!(plan.contains(phrase), "{phrase}: {plan}");
    }
    let plan = Weather::new("type = \"snow\", rate_mm_h = 1, most = 0").plan();
    assert!(plan.contains("no flakes are resolved"), "{plan}");
    assert!(!Weather::new("").plan().contains("weather"));
}

#[test]
fn what_does_not_fall() {
    let assert_refused = |falls: &str, phrases: &[&str]| {
        let phrases = [&["job.toml:5", "precipitation"], phrases].concat();
        etendue(["plan", &Weather::new(falls).job()]).refused(&phrases);
    };
    assert_refused("type = \"rain\", rate_mm_h = 0", &["rate_mm_h", "found 0", "above 0"]);
    assert_refused("type = \"rain\", rate_mm_h = -2", &["rate_mm_h", "found -2"]);
    assert_refused("type = \"rain\", rate_mm_h = 151", &["the rate is 151 mm/h", "0.1 to 150 mm/h"]);
    assert_refused("type = \"snow\", rate_mm_h = 4", &["the rate is 4 mm/h", "0.1 to 3 mm/h"]);
    assert_refused("type = \"hail\", rate_mm_h = 4", &["type", "\"rain\"", "\"snow\""]);
    assert_refused("type = \"rain\"", &["rate_mm_h"]);
    assert_refused("type = \"rain\", rate_mm_h = 4, crystals = \"rimed\"", &["crystals"]);
    assert_refused("type = \"snow\", rate_mm_h = 1, crystals = \"stars\"", &["crystals", "\"dendrites\""]);
    assert_refused("type = \"rain\", rate_mm_h = 4, clear_m = -1", &["clear_m", "found -1"]);
    assert_refused("type = \"rain\", rate_mm_h = 4, smallest_px = 0", &["smallest_px", "found 0"]);
    assert_refused("type = \"rain\", rate_mm_h = 4, wind_m_s = [1, 2]", &["wind_m_s"]);
}
