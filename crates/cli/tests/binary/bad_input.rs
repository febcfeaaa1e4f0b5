//! Unusable descriptions and assets: each is reported with file, line and key, and nothing is written.

use crate::support::{CommandOutput, etendue, tests, text};
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// A copy of the small job, to be modified by a test.
pub(crate) struct ModifiedJob {
    folder: TempDir,
}

const OBJ: &str = "tower.obj";

impl ModifiedJob {
    pub(crate) fn new() -> Self {
        let place = tempfile::tempdir().expect("a temporary folder");
        for entry in fs::read_dir(tests().join("jobs/small")).expect("the small job") {
            let path = entry.expect("a readable entry").path();
            fs::copy(&path, place.path().join(path.file_name().expect("a name"))).expect("copied");
        }
        Self { folder: place }
    }

    /// Folder of the copy.
    pub(crate) fn folder(&self) -> &std::path::Path {
        self.folder.path()
    }

    /// Path of the job.
    pub(crate) fn job(&self) -> String {
        text(&self.path("small.toml"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("a text file")
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).expect("written");
    }

    /// Replaces the first `from` in a file; returns `file:line` of the replacement.
    pub(crate) fn replace_first(&self, name: &str, from: &str, to: &str) -> String {
        let text = self.read(name);
        let at = text.find(from).unwrap_or_else(|| panic!("{name} lacks {from}"));
        self.write(name, text.replacen(from, to, 1));
        format!("{name}:{}", 1 + text[..at].matches('\n').count())
    }

    /// Renders; asserts that nothing is written.
    pub(crate) fn render(&self, options: &[&str]) -> CommandOutput {
        let output = self.path("out");
        let (job, folder) = (text(&self.path("small.toml")), text(&output));
        let run = etendue(["render", &job, "-o", &folder].iter().chain(options));
        assert!(!output.exists(), "an output folder was left: {run:?}");
        run
    }
}

/// Asserts that the job with `from` replaced by `to` is refused at that line, with all of `phrases`.
#[track_caller]
fn job_refused(from: &str, to: &str, phrases: &[&str]) {
    let job = ModifiedJob::new();
    let place = job.replace_first("small.toml", from, to);
    let phrases: Vec<&str> = [place.as_str()].into_iter().chain(phrases.iter().copied()).collect();
    job.render(&[]).refused(&phrases);
}

/// The same for the mesh, at the place in the job that names it.
#[track_caller]
fn mesh_refused(from: &str, to: &str, phrases: &[&str]) {
    let job = ModifiedJob::new();
    let place = job.replace_first(OBJ, from, to);
    let phrases: Vec<&str> =
        [place.as_str(), "small.toml:5", "file"].into_iter().chain(phrases.iter().copied()).collect();
    job.render(&[]).refused(&phrases);
}

#[test]
fn a_job_that_is_not_there() {
    etendue(["render", "no/such/job.toml", "-o", "no/such/folder"]).refused(&["no/such/job.toml", "no such file"]);
}

#[test]
fn text_that_is_not_toml() {
    job_refused("spp = 8", "spp = = 8", &["invalid TOML"]);
}

#[test]
fn a_misspelt_key() {
    job_refused("focal_length_mm = 6", "focal_lenght_mm = 6", &["focal_lenght_mm", "\"focal_length_mm\""]);
}

#[test]
fn a_misspelt_table() {
    job_refused("[render]", "[rendre]", &["rendre", "\"render\""]);
}

#[test]
fn a_wrong_type() {
    job_refused("f_number = 2", "f_number = \"two\"", &["cameras.front.lens.f_number", "number", "the text \"two\""]);
}

#[test]
fn a_negative_exposure() {
    job_refused("exposure_s = 1e-6", "exposure_s = -1e-6", &["cameras.front.sensor.exposure_s", "at least 0"]);
}

#[test]
fn a_focal_length_of_zero() {
    job_refused("focal_length_mm = 6", "focal_length_mm = 0", &["cameras.front.lens.focal_length_mm", "above 0"]);
}

#[test]
fn an_image_without_width() {
    job_refused("width_px = 46", "width_px = 0", &["cameras.front.sensor.width_px", "1"]);
}

#[test]
fn an_image_without_height() {
    job_refused("height_px = 30", "height_px = 0", &["cameras.front.sensor.height_px", "1"]);
}

#[test]
fn a_number_that_is_none() {
    job_refused("f_number = 2", "f_number = nan", &["cameras.front.lens.f_number", "found NaN"]);
    job_refused("position_m = [0, 0, 1.4]", "position_m = [0, nan, 1.4]", &["cameras.front.position_m", "found NaN"]);
    job_refused("f_number = 2", "f_number = inf", &["cameras.front.lens.f_number", "found inf"]);
}

#[test]
fn a_format_of_another_time() {
    job_refused("format = 1", "format = 2", &["format", "2", "1"]);
}

#[test]
fn a_material_that_is_not_defined() {
    job_refused("material = \"gold\"", "material = \"golt\"", &["scene.objects.ball.material", "golt", "gold"]);
}

#[test]
fn a_mesh_that_is_not_defined() {
    job_refused("mesh = \"tower\"", "mesh = \"towel\"", &["scene.objects.towers.mesh", "towel", "tower"]);
}

#[test]
fn an_object_without_extent() {
    job_refused("radius_m = 0.5", "radius_m = 0", &["radius_m", "above 0"]);
    job_refused("scale = [1, 1, 1.4]", "scale = [1, 0, 1.4]", &["scale", "above 0"]);
}

#[test]
fn a_reflectance_that_makes_energy() {
    job_refused("[0.05, 0.2, 0.6]", "[0.05, 0.2, 1.6]", &["scene.materials.paint.reflectance", "1.6"]);
}

#[test]
fn a_distortion_that_folds_the_picture() {
    job_refused("k1 = -0.1, k2 = 0.01", "k1 = -2, k2 = 0", &["cameras.front.lens.distortion", "fold"]);
}

#[test]
fn a_focus_nearer_than_the_focal_length() {
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "focus_distance_m = 5", "focus_distance_m = 0.005");
    job.render(&[]).refused(&["small.toml:", "cameras.front.lens", "focus distance of 0.005 m", "more than 0.006 m"]);
}

#[test]
fn pupils_that_contradict_each_other() {
    let thick = "type = \"thick\"\nconstant_pupil = \"exit\"\nentrance_pupil_mm = 2\nexit_pupil_mm = 5\n\
                 pupil_magnification = 1.5";
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "type = \"thin\"", thick);
    job.render(&[]).refused(&[
        "small.toml:",
        "cameras.front.lens",
        "entrance_pupil_mm = 2",
        "exit_pupil_mm = 5 contradicts",
    ]);
}

#[test]
fn a_seed_below_zero_and_a_picture_without_processing() {
    job_refused("seed = 11", "seed = -11", &["render.seed", "-11"]);
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "[cameras.isp]\nwhite_balance = \"D65\"\ncolour_matrix = { fit = \"D65\" }\n", "");
    job.render(&[]).refused(&["small.toml:126", "output.picture", "[isp]"]);
}

#[test]
fn samples_that_do_not_divide_into_replicates() {
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "spp = 8", "spp = 9");
    job.render(&[]).refused(&["small.toml:118", "render.replicates", "9 samples", "2 replicates"]);
    ModifiedJob::new().render(&["--set", "render.replicates=2", "--spp", "9"]).refused(&["9 samples", "2 replicates"]);
}

#[test]
fn a_variance_of_one_replicate() {
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "replicates = 2", "replicates = 1");
    job.render(&[]).refused(&["small.toml:", "variance", "replicates"]);
}

#[test]
fn a_picture_that_no_machine_holds() {
    let job = ModifiedJob::new();
    let options = ["--set", "cameras.front.sensor.width_px=65536", "--set", "cameras.front.sensor.height_px=65536"];
    job.render(&options).refused(&["sensor", "65536 × 65536", "GB"]);
}

#[test]
fn all_errors_are_reported_at_once_in_order() {
    let job = ModifiedJob::new();
    let first = job.replace_first("small.toml", "alpha = 0.05", "alpha = 5");
    let second = job.replace_first("small.toml", "exposure_s = 1e-6", "exposure_s = -1");
    let third = job.replace_first("small.toml", "spp = 8", "ssp = 8");
    let output = job.render(&[]).refused(&[&first, "alpha"]);
    let output =
        output.says(&[&second, "exposure_s"]).says(&[&third, "ssp", "spp"]).says(&["3 errors", "nothing was written"]);
    let order = [first, second, third].map(|place| output.err.find(&place).expect("told"));
    assert!(order.is_sorted(), "{}", output.err);
}

#[test]
fn errors_of_several_assets_are_reported_at_once() {
    let job = ModifiedJob::new();
    job.write("checker.png", b"no picture");
    job.replace_first(OBJ, "v 0 0 2.2", "v 0 nan 2.2");
    job.render(&[]).refused(&["checker.png"]).says(&["tower.obj:11"]).says(&["errors; nothing was written"]);
}

#[test]
fn keys_of_set_that_do_not_exist() {
    ModifiedJob::new().render(&["--set", "render.sp=4"]).refused(&["--set", "render.sp", "\"spp\""]);
    ModifiedJob::new().render(&["--set", "cameras.rear.sensor.exposure_s=1"]).refused(&["--set", "rear", "front"]);
    ModifiedJob::new().render(&["--set", "render.spp"]).refused(&["--set", "render.spp", "="]);
    ModifiedJob::new().render(&["--set", "render.spp=many"]).refused(&["--set", "render.spp", "many"]);
}

#[test]
fn a_camera_that_the_job_has_not() {
    ModifiedJob::new().render(&["--camera", "rear"]).refused(&["--camera rear", "small.toml", "front"]);
}

#[test]
fn a_missing_mesh() {
    let job = ModifiedJob::new();
    fs::remove_file(job.path(OBJ)).expect("removed");
    job.render(&[]).refused(&["tower.obj", "small.toml:5", "file"]);
}

#[test]
fn a_truncated_mesh() {
    let job = ModifiedJob::new();
    let text = job.read(OBJ);
    let end = text.find("6/3 5/4").expect("the first face");
    job.write(OBJ, &text[..end]);
    job.render(&[]).refused(&["tower.obj:17", "small.toml:5"]);
    job.write(OBJ, &text[..text.find("v 0 0 2.2").expect("a vertex") + 5]);
    job.render(&[]).refused(&["tower.obj:11", "small.toml:5"]);
    job.write(OBJ, "");
    job.render(&[]).refused(&["tower.obj", "small.toml:5", "empty"]);
}

#[test]
fn a_face_index_out_of_range() {
    mesh_refused("f 8 5 9", "f 8 5 90", &["90", "9"]);
    mesh_refused("f 8 5 9", "f 8 5 0", &["0"]);
    mesh_refused("f 8 5 9", "f 8 5 -10", &["-10"]);
    mesh_refused("f 1/1 2/2", "f 1/1 2/22", &["22"]);
}

#[test]
fn a_vertex_that_is_no_number() {
    mesh_refused("v 0 0 2.2", "v 0 nan 2.2", &["nan"]);
    mesh_refused("v 0 0 2.2", "v 0 inf 2.2", &["inf"]);
    mesh_refused("v 0 0 2.2", "v 0 here 2.2", &["here"]);
}

#[test]
fn a_broken_value_in_a_material_library() {
    let job = ModifiedJob::new();
    let place = job.replace_first("tower.mtl", "Kd 0.5 0.08 0.04", "Kd 0.5 red 0.04");
    job.render(&[]).refused(&[&place, "Kd", "red"]);
}

#[test]
fn an_unreadable_texture() {
    let job = ModifiedJob::new();
    job.write("checker.png", b"\x89PNG\r\n\x1a\nthis is no picture");
    job.render(&[]).refused(&["checker.png", "small.toml:6", "file"]);
    fs::remove_file(job.path("checker.png")).expect("removed");
    job.render(&[]).refused(&["checker.png", "small.toml:6", "file"]);
}

#[test]
fn a_texture_without_pixels() {
    let job = ModifiedJob::new();
    let mut bytes = fs::read(job.path("checker.png")).expect("the texture");
    bytes[16..20].fill(0);
    job.write("checker.png", &bytes);
    job.render(&[]).refused(&["checker.png", "small.toml:6"]);
}

#[test]
fn an_unreadable_sky() {
    let job = ModifiedJob::new();
    let bytes = fs::read(job.path("sky.hdr")).expect("the sky");
    job.write("sky.hdr", &bytes[..60]);
    job.render(&[]).refused(&["sky.hdr", "small.toml:", "scene.environment.file"]);
}

#[test]
fn a_spectrum_that_is_no_table() {
    let job = ModifiedJob::new();
    job.write("paint.csv", "wavelength_nm,value\n400,0.1\n500,lots\n");
    let place = job.replace_first("small.toml", "[0.05, 0.2, 0.6]", "{ spectrum = \"paint.csv\" }");
    job.render(&[]).refused(&["paint.csv", "paint.csv:3", "lots", &place]);
    job.write("paint.csv", "wavelength_nm,value\n400,0.1\n500,1.5\n");
    job.render(&[]).refused(&["small.toml:", "scene.materials.paint", "1.5", "from 0 to 1"]);
}

#[test]
fn an_output_folder_that_cannot_be() {
    let modified = ModifiedJob::new();
    let job = text(&modified.path("small.toml"));
    modified.write("taken", b"a file");
    for folder in [modified.path("taken"), modified.path("taken/out"), modified.path("taken/deep/out")] {
        etendue(["render", &job, "-o", &text(&folder)]).refused(&["taken", "folder"]);
    }
    assert_eq!(modified.read("taken"), "a file");
}

#[test]
fn results_that_are_already_there() {
    let modified = ModifiedJob::new();
    let (job, out) = (text(&modified.path("small.toml")), text(&modified.path("out")));
    let lean = ["--set", "output.radiance=false", "--set", "output.irradiance=false"];
    etendue(["render", &job, "-o", &out].into_iter().chain(lean)).ok();
    let before = crate::support::contents(&modified.path("out"));
    etendue(["render", &job, "-o", &out, "--seed", "5"]).refused(&["out/front", "already exists", "--overwrite"]);
    assert_eq!(before, crate::support::contents(&modified.path("out")), "nothing was touched");
    etendue(["render", &job, "-o", &out, "--seed", "5", "--overwrite"]).ok();
    assert_ne!(before, crate::support::contents(&modified.path("out")));
}

#[test]
fn an_instruction_set_that_is_unknown() {
    crate::support::etendue_with(["render", "x.toml", "-o", "y"], &[("ETENDUE_SIMD", "fast")]).refused(&[
        "ETENDUE_SIMD=fast",
        "auto",
        "scalar",
    ]);
}
