//! Meshes with moving vertices, from numbered files: single frames and sequences, and refusals.

use crate::support::{contents, etendue, text};
use std::fs;
use tempfile::TempDir;

const FIRST: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl cloth\nf 1 2 3 4\n";

/// A job of a square that bends, and its files.
struct BendingSquareJob {
    folder: TempDir,
}

impl BendingSquareJob {
    fn new(animation: &str) -> Self {
        let place = tempfile::tempdir().expect("a temporary folder");
        let job = format!(
            "format = 1\n[sequence]\nframe_rate_hz = 10\n[scene]\nenvironment = {{ type = \"uniform\", luminance_cd_m2 = 100, illuminant = \"D65\" }}\n\
             [[scene.materials]]\nname = \"cloth\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
             [[scene.meshes]]\nname = \"sheet\"\nup_axis = \"z\"\nvertex_animation = {{ {animation} }}\n\
             [[scene.objects]]\nname = \"sheet\"\nmesh = \"sheet\"\nmaterial = \"cloth\"\n\
             [[cameras]]\nname = \"c\"\nposition_m = [0, -3, 2]\nlook_at_m = [0, 0, 0]\n\
             lens = {{ type = \"pinhole\", focal_length_mm = 4, f_number = 2 }}\n\
             [cameras.sensor]\nwidth_px = 24\nheight_px = 16\npixel_pitch_um = 150\nexposure_s = 0.05\n\
             shutter = {{ type = \"rolling\", row_time_us = 1000 }}\ncfa = \"mono\"\nquantum_efficiency = 0.6\nfull_well_e = 20000\n\
             read_noise_e = 2\ndark_current_e_s = 5\ngain_dn_per_e = 0.2\nblack_level_dn = 64\nbits = 12\n\
             [render]\nspp = 4\nmax_bounces = 2\n[output]\nradiance = true\noptical_flow = \"exr\"\nboxes = true\n"
        );
        let bending = Self { folder: place };
        bending.write("job.toml", &job);
        for (number, height) in [(0, "0"), (1, "0.7"), (2, "-0.5")] {
            bending.write(&format!("sheet-{number}.obj"), &FIRST.replace("v 1 1 0", &format!("v 1 1 {height}")));
        }
        bending
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.folder.path().join(name), text).expect("written");
    }

    fn job(&self) -> String {
        text(&self.folder.path().join("job.toml"))
    }

    fn render(&self, frames: &str) -> std::collections::BTreeMap<String, Vec<u8>> {
        let out = self.folder.path().join(frames);
        etendue(["render", &self.job(), "-o", &text(&out), "--frames", frames]).ok();
        contents(&out)
    }

    /// Asserts a refusal at this line of the job, with these phrases.
    #[track_caller]
    fn refused(&self, phrases: &[&str]) {
        let phrases = [&["job.toml:13", "vertex_animation"], phrases].concat();
        etendue(["plan", &self.job()]).refused(&phrases);
    }
}

const LOOP: &str = "files = \"sheet-%d.obj\", count = 3, rate_hz = 12, repeat = \"loop\"";

#[test]
fn a_frame_alone_has_the_bytes_that_it_has_in_a_sequence() {
    let bending = BendingSquareJob::new(LOOP);
    let (all, alone) = (bending.render("0..3"), bending.render("2..3"));
    let of_frame: Vec<&String> = all.keys().filter(|name| name.contains(".0002.exr")).collect();
    assert!(of_frame.len() >= 2, "{:?}", all.keys());
    of_frame.iter().for_each(|name| assert!(all[*name] == alone[*name], "{name}"));
    let light = |frame: u32| &all[&format!("c/radiance.{frame:04}.exr")];
    assert!(light(1) != light(2), "the sheet bends");
}

#[test]
fn the_plan_reports_moving_vertices_and_its_hash_covers_all_files() {
    let bending = BendingSquareJob::new(LOOP);
    let plan = || etendue(["plan", &bending.job()]).ok().out;
    let before = plan();
    assert!(before.contains("the vertices of one instance move"), "{before}");
    bending.write("sheet-2.obj", &FIRST.replace("v 1 1 0", "v 1 1 0.1"));
    let hash = |plan: &str| plan.lines().next().expect("a line").to_owned();
    assert_ne!(hash(&before), hash(&plan()));
}

#[test]
fn a_file_that_is_not_there() {
    BendingSquareJob::new("files = \"sheet-%d.obj\", count = 4, rate_hz = 12")
        .refused(&["sheet-3.obj", "no such mesh file"]);
    BendingSquareJob::new("files = \"sheet-%02d.obj\", count = 3, rate_hz = 12")
        .refused(&["sheet-00.obj", "no such mesh file"]);
}

#[test]
fn files_of_other_vertices_or_faces() {
    let assert_refused = |text: &str, phrases: &[&str]| {
        let bending = BendingSquareJob::new(LOOP);
        bending.write("sheet-1.obj", text);
        bending.refused(&[&["sheet-1.obj has", "sheet-0.obj has", "unchanged faces"], phrases].concat());
    };
    assert_refused(&FIRST.replace("v -1 1 0\n", "v -1 1 0\nv 0 0 0\n"), &["5 vertices", "4 vertices"]);
    assert_refused(&FIRST.replace("f 1 2 3 4", "f 1 2 3\nf 1 3 4"), &["2 faces", "1 faces"]);
    assert_refused(&FIRST.replace("f 1 2 3 4", "f 1 2 3"), &["face 1", "3 corners", "4 corners"]);
    assert_refused(&FIRST.replace("cloth", "silk"), &["material groups"]);
}

#[test]
fn animations_that_are_none() {
    let assert_refused = |animation: &str, phrases: &[&str]| BendingSquareJob::new(animation).refused(phrases);
    assert_refused("files = \"sheet-%d.obj\", count = 1, rate_hz = 12", &["count", "found 1", "2"]);
    assert_refused("files = \"sheet-%d.obj\", count = 3, rate_hz = 0", &["rate_hz", "found 0", "above 0"]);
    assert_refused(
        "files = \"sheet-0.obj\", count = 3, rate_hz = 5",
        &["files", "placeholder for the file number", "%03d"],
    );
    assert_refused("files = \"sheet-%d.obj\", count = 3", &["a key is missing", "\"rate_hz\", \"times_s\""]);
    assert_refused(
        "files = \"sheet-%d.obj\", count = 3, times_s = [0, 0.3, 0.2]",
        &["times_s[2]", "the time 0.2 s follows 0.3 s", "increasing"],
    );
    assert_refused(
        "files = \"sheet-%d.obj\", count = 3, times_s = [0, 0.1]",
        &["the number of times is 2; each of the 3 files needs one", "give 3 times"],
    );
    assert_refused(
        "files = \"sheet-%d.obj\", count = 3, times_s = [0, 0.1, 0.2], repeat = \"loop\"",
        &["the number of times is 3; a loop of 3 files", "give 4 times"],
    );
    assert_refused(
        "files = \"sheet-%d.obj\", count = 3, rate_hz = 5, repeat = \"bounce\"",
        &["repeat", "\"hold\"", "\"loop\""],
    );
}

#[test]
fn an_emissive_mesh_keeps_its_shape() {
    let bending = BendingSquareJob::new(LOOP);
    let job = fs::read_to_string(bending.job()).expect("a text");
    let glowing = job.replace(
        "type = \"diffuse\"\nreflectance = 0.5",
        "type = \"emitter\"\nemission = { luminance_cd_m2 = 10, illuminant = \"D65\" }",
    );
    bending.write("job.toml", &glowing);
    etendue(["plan", &bending.job()]).refused(&[
        "job.toml:",
        "scene.objects.sheet",
        "an emissive surface must have a constant shape",
    ]);
}
