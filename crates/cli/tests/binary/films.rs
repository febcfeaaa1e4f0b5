//! Films larger than their memory limit: stored in a scratch file, with equal bytes of every result.

use crate::support::{assert_same, etendue, rendered, text};
use std::fs;
use std::path::{Path, PathBuf};

/// A ball under a uniform sky; 20 bands of 150 × 101 pixels, which take 2.4 MB with their variances.
const JOB: &str = r#"format = 1
[render]
PASSES
band_width_nm = 20
[scene]
environment = { type = "uniform", luminance_cd_m2 = 100, illuminant = "D65" }
materials = [{ name = "grey", type = "diffuse", reflectance = 0.5 }]
[[scene.objects]]
name = "ball"
shape = { type = "sphere", radius_m = 1 }
position_m = [5, 0, 0]
material = "grey"
[[cameras]]
name = "front"
look_at_m = [6, 0, 0]
position_m = [0, 0, 0]
CAMERA
[output]
OUTPUT
"#;

const SENSOR: &str = "width_px = 150, height_px = 101, pixel_pitch_um = 60";
const ELECTRONICS: &str = "cfa = \"mono\", exposure_s = 0.01, quantum_efficiency = 0.5, full_well_e = 20000000, read_noise_e = 5, bits = 12, gain_dn_per_e = 0.0002, dark_current_e_s = 5, black_level_dn = 60";
const THIN: &str = "lens = { type = \"thin\", focal_length_mm = 6, f_number = 4, focus_distance_m = 5 }";
const GLARE: &str = "margin = 0.1, glare = { scatter = 0.02, core_um = 25, exponent = 2.5 }";
const SPECTRA: &str = "radiance = true\nirradiance = true\nvariance = true\nground_truth = true";

struct FilmJob {
    folder: tempfile::TempDir,
}

impl FilmJob {
    fn new(passes: &str, camera: &str, output: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let job = JOB.replace("PASSES", passes).replace("CAMERA", camera).replace("OUTPUT", output);
        fs::write(folder.path().join("job.toml"), job).expect("written");
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn job(&self) -> String {
        text(&self.path("job.toml"))
    }

    /// Asserts equal results from memory and from disk, and an empty folder for scratch files.
    fn check(&self, what: &str) {
        let (job, scratch) = (self.job(), text(&self.path("scratch")));
        let in_memory = rendered(&job, &["--scratch", &scratch]);
        assert!(!self.path("scratch").exists(), "{what}: what fits needs no folder");
        let small = ["--film-memory", "1", "--scratch", &scratch];
        assert_same(&in_memory, &rendered(&job, &small), what);
        let left = fs::read_dir(self.path("scratch")).expect("the disk was used").count();
        assert_eq!(left, 0, "{what}: scratch files that stay");
    }
}

fn camera(lens: &str, sensor: &str, effects: &str) -> String {
    let effects = if effects.is_empty() { String::new() } else { format!("effects = {{ {effects} }}") };
    format!("{lens}\nsensor = {{ {SENSOR}{sensor} }}\n{effects}")
}

#[test]
fn light_through_the_lens_does_not_depend_on_the_memory_of_films() {
    let replicates = "spp = 4\nreplicates = 2";
    FilmJob::new(replicates, &camera(THIN, "", GLARE), SPECTRA).check("effects, band by band");
    FilmJob::new("spp = 1", &camera(THIN, "", ""), "radiance = true\nground_truth = false")
        .check("one replicate, whose variance is not kept");
    FilmJob::new("passes = [2, 2]\nreplicates = 2", &camera(THIN, "", ""), SPECTRA).check("passes");
}

#[test]
fn photographs_do_not_depend_on_the_memory_of_films() {
    let electronics = format!(", {ELECTRONICS}");
    let output = "radiance = true\nelectrons = true\nraw = true\ndepth_png = true";
    FilmJob::new("spp = 4\nreplicates = 2", &camera(THIN, &electronics, GLARE), output).check("electrons of bands");
    FilmJob::new(
        "spp = 4\nreplicates = 2",
        &camera(THIN, &electronics, ""),
        "radiance = true\nelectrons = true\nraw = true",
    )
    .check("electrons summed beside bands");
}

#[test]
fn radiance_at_the_pupil_and_its_lens_do_not_depend_on_the_memory_of_films() {
    let at_pupil = |lens: &str, more: &str| {
        let render = "render = { route = \"pupil\", depth_of_field = \"none\" }";
        format!("{lens}\nsensor = {{ {SENSOR}{more} }}\n{render}\neffects = {{ {GLARE} }}")
    };
    let electronics = format!(", {ELECTRONICS}");
    FilmJob::new("spp = 2", &at_pupil(THIN, &electronics), "radiance = true\nirradiance = true\nraw = true")
        .check("a thin lens");
    FilmJob::new("spp = 2", &at_pupil(THIN, ""), "radiance = true").check("radiance alone");
    let deep = at_pupil(THIN, "").replace("\"none\"", "\"physical\"");
    FilmJob::new("spp = 2", &deep, "irradiance = true").check("depth of field");
}

/// One element, whose reflections are traced quickly; behind the filter each band has its own étendue.
#[test]
fn prescriptions_and_their_ghosts_do_not_depend_on_the_memory_of_films() {
    let element = "{ thickness_mm = 1, semi_aperture_mm = 1, stop = true }, { radius_mm = 20, thickness_mm = 4, semi_aperture_mm = 8, glass = \"N-BK7\" }, { radius_mm = -20, semi_aperture_mm = 8 }";
    let lens = format!(
        "lens = {{ type = \"prescription\", surfaces = [{element}], focus_distance_m = 5, coating = \"uncoated\", ir_cut = {{ edge_nm = 650, edge_width_nm = 30, effective_index = 1.8 }} }}"
    );
    let through = camera(&lens, &format!(", {ELECTRONICS}"), "ghosts = true");
    let output = "irradiance = true\nvariance = true\nelectrons = true\nghosts = true\nraw = true";
    FilmJob::new("spp = 2\nreplicates = 2", &through, output).check("through the lens");
    let at_pupil = format!("{through}\nrender = {{ route = \"pupil\", depth_of_field = \"none\" }}");
    let output = output.replace("variance = true\n", "");
    FilmJob::new("spp = 2", &at_pupil, &output).check("at the pupil");
    let bare = at_pupil.replace("effects = { ghosts = true }", "");
    FilmJob::new("spp = 2", &bare, "irradiance = true\nraw = true").check("at the pupil, without ghosts");
}

#[test]
fn the_plan_reports_where_a_film_is_stored() {
    let place = FilmJob::new("spp = 4\nreplicates = 2", &camera(THIN, "", ""), SPECTRA);
    let plan = |options: &[&str]| etendue(["plan", &place.job()].iter().chain(options)).ok().out;
    // 20 bands: means and variances of 4 bytes; also weights, samples and non-finite counts.
    let expected = "film 0.2 MB in memory, its bands 2.4 MB on disk";
    assert!(plan(&["--film-memory", "1"]).contains(expected), "{}", plan(&["--film-memory", "1"]));
    assert!(plan(&["--film-memory", "3"]).contains("film 2.6 MB\n"), "{}", plan(&[]));
    let json: serde_json::Value = serde_json::from_str(&plan(&["--film-memory", "1", "--json"])).expect("JSON");
    let cost = &json["cameras"][0]["cost"];
    assert_eq!(cost["film_bytes"], f64::from(3 * 4 * 150 * 101));
    assert_eq!(cost["film_disk_bytes"], f64::from(2 * 20 * 4 * 150 * 101));
    let deep = format!("{}\nrender = {{ route = \"pupil\", depth_of_field = \"physical\" }}", camera(THIN, "", ""));
    let place = FilmJob::new("spp = 1", &deep, "irradiance = true");
    let output = etendue(["plan", &place.job(), "--film-memory", "1"]).ok().out;
    let output = output.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(output.contains("MB on disk, all read into memory at once for depth of field"), "{output}");
}

#[test]
fn a_folder_for_scratch_files_that_cannot_be_is_refused_before_anything_is_rendered() {
    let place = FilmJob::new("spp = 1", &camera(THIN, "", ""), "radiance = true");
    fs::write(place.path("file"), b"").expect("written");
    let (scratch, output) = (text(&place.path("file/scratch")), text(&place.path("out")));
    let options = ["--film-memory", "1", "--scratch", &scratch];
    etendue(["render", &place.job(), "-o", &output].into_iter().chain(options)).refused(&[
        "the scratch folder ",
        "file/scratch cannot be written: ",
        "choose another one with --scratch",
    ]);
    assert!(!Path::new(&output).exists(), "nothing half-written");
    etendue(["plan", &place.job(), "--film-memory", "0"]).refused(&["--film-memory", "from 1 to"]);
}

#[test]
fn shards_and_progressive_runs_of_films_on_the_disk_give_the_same() {
    let place = FilmJob::new("passes = [2, 2]\nreplicates = 2", &camera(THIN, "", ""), SPECTRA);
    let (job, scratch) = (place.job(), text(&place.path("scratch")));
    let in_memory = rendered(&job, &[]);
    let small = ["--film-memory", "1", "--scratch", &scratch];
    let progressive = rendered(&job, &[&small[..], &["--progressive"]].concat());
    assert_same(&in_memory, &progressive, "refined after each pass");
    let shards: Vec<String> = (0..2).map(|i| text(&place.path(&format!("shard{i}")))).collect();
    for (i, shard) in shards.iter().enumerate() {
        let which = format!("{i}/2");
        etendue(["render", &job, "-o", shard, "--shard", &which].into_iter().chain(small)).ok();
    }
    let merged = text(&place.path("merged"));
    etendue(["merge", "-o", &merged].into_iter().chain(shards.iter().map(String::as_str))).ok();
    assert_same(&in_memory, &crate::support::contents(Path::new(&merged)), "shards");
}
