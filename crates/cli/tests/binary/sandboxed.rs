//! Untrusted jobs: no file outside their folder is read, whichever file names it and by any path.

use crate::bad_input::ModifiedJob;
use crate::support::{CommandOutput, contents, etendue, text};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use tempfile::TempDir;

const OUTSIDE_MESSAGE: &str = "this path is outside the job's folder";

/// A job in a folder next to files of others.
struct ForeignFiles {
    /// Files that do not belong to the job.
    secrets: TempDir,
    job: ModifiedJob,
}

impl ForeignFiles {
    fn new() -> Self {
        let secrets = tempfile::tempdir().expect("a temporary folder");
        let job = ModifiedJob::new();
        for entry in fs::read_dir(job.folder()).expect("the job") {
            let path = entry.expect("a readable entry").path();
            fs::copy(&path, secrets.path().join(path.file_name().expect("a name"))).expect("copied");
        }
        Self { secrets, job }
    }

    fn secret(&self, name: &str) -> String {
        text(&self.secrets.path().join(name))
    }

    /// Path to a secret through the parents of the job's folder.
    fn path_through_parents(&self, name: &str) -> String {
        let up = "../".repeat(self.job.folder().components().count());
        format!("{up}{}", self.secret(name).trim_start_matches('/'))
    }

    fn plan(&self, options: &[&str]) -> CommandOutput {
        etendue(["plan", &self.job.job(), "--sandboxed"].iter().chain(options))
    }

    /// Asserts a refusal in the sandbox at that file, and success without the sandbox or with its folder allowed.
    #[track_caller]
    fn refused(&self, options: &[&str], place: &str) {
        self.plan(options).refused(&[place, OUTSIDE_MESSAGE, "--allow-outside"]);
        let folder = text(self.secrets.path());
        self.plan(&[options, &["--allow-outside", &folder]].concat()).ok();
        etendue(["plan", &self.job.job()].iter().chain(options)).ok();
    }
}

#[test]
fn a_job_within_its_folder_is_rendered_and_nothing_changes() {
    let job = ModifiedJob::new();
    let run = |folder: &str, options: &[&str]| {
        let out = text(&job.folder().join(folder));
        etendue(["render", &job.job(), "-o", &out, "--spp", "2"].iter().chain(options)).ok();
        contents(Path::new(&out))
    };
    assert_eq!(run("a", &[]), run("b", &["--sandboxed"]));
    let inside = format!("scene.textures.checker.file={}", text(&job.folder().join("checker.png")));
    etendue(["plan", &job.job(), "--sandboxed", "--set", &inside]).ok();
}

#[test]
fn absolute_paths_and_parents_lead_out() {
    for escape in [ForeignFiles::secret, ForeignFiles::path_through_parents] {
        let files = ForeignFiles::new();
        let path = escape(&files, "checker.png");
        files.job.replace_first("small.toml", "file = \"checker.png\"", &format!("file = \"{path}\""));
        files.refused(&[], "checker.png");
        let files = ForeignFiles::new();
        let path = escape(&files, "tower.obj");
        files.job.replace_first("small.toml", "file = \"tower.obj\"", &format!("file = \"{path}\""));
        files.refused(&[], "tower.obj");
    }
}

#[test]
fn links_lead_out() {
    for name in ["checker.png", "tower.obj", "sky.hdr"] {
        let files = ForeignFiles::new();
        let link = files.job.folder().join(name);
        fs::remove_file(&link).expect("removed");
        symlink(files.secret(name), &link).expect("link");
        files.refused(&[], name);
    }
    let files = ForeignFiles::new();
    symlink(files.secrets.path(), files.job.folder().join("meshes")).expect("link");
    files.job.replace_first("small.toml", "file = \"tower.obj\"", "file = \"meshes/tower.obj\"");
    files.refused(&[], "meshes/tower.obj");
    // The job itself.
    let files = ForeignFiles::new();
    let link = files.job.folder().join("link.toml");
    symlink(files.secret("small.toml"), &link).expect("link");
    etendue(["plan", &text(&link), "--sandboxed"]).refused(&["link.toml", OUTSIDE_MESSAGE]);
}

#[test]
fn material_libraries_and_their_pictures_lead_out() {
    let files = ForeignFiles::new();
    let library = files.path_through_parents("tower.mtl");
    files.job.replace_first("tower.obj", "mtllib tower.mtl", &format!("mtllib {library}"));
    files.refused(&[], "tower.obj:2");
    // A missing file is reported like an existing one.
    files.job.replace_first("tower.obj", "tower.mtl", "none.mtl");
    files.plan(&[]).refused(&["tower.obj:2", OUTSIDE_MESSAGE]);
    let files = ForeignFiles::new();
    let image = files.secret("checker.png");
    files.job.replace_first("tower.mtl", "map_Kd checker.png", &format!("map_Kd {image}"));
    files.refused(&[], "checker.png");
}

#[test]
fn changes_scenes_cameras_and_bases_lead_out() {
    let files = ForeignFiles::new();
    let set = format!("scene.textures.checker.file={}", files.secret("checker.png"));
    files.refused(&["--set", &set], "checker.png");
    files.plan(&["--set", &format!("scene={}", files.secret("scene.toml"))]).refused(&["scene.toml", OUTSIDE_MESSAGE]);
    let files = ForeignFiles::new();
    files.job.write("job.toml", format!("format = 1\nbase = \"{}\"\n", files.secret("small.toml")));
    let job = text(&files.job.folder().join("job.toml"));
    etendue(["plan", &job, "--sandboxed"]).refused(&["job.toml:2:8", "small.toml", OUTSIDE_MESSAGE]);
    etendue(["plan", &job]).ok();
    files.job.write(
        "job.toml",
        "format = 1\nscene = \"/no/scene.toml\"\n[[cameras]]\nname = \"a\"\nfile = \"../../x.toml\"\n",
    );
    etendue(["plan", &job, "--sandboxed"]).refused(&["job.toml:2:9", "/no/scene.toml", OUTSIDE_MESSAGE]).says(&[
        "job.toml:5:8",
        "../x.toml",
        OUTSIDE_MESSAGE,
    ]);
}

#[test]
fn tables_of_lamps_lead_out() {
    let files = ForeignFiles::new();
    let lamp = |tilt: &str| {
        format!("IESNA:LM-63-1995\n[TEST] 7\nTILT={tilt}\n1 1000 1 2 1 1 2 0 0 0\n1 1 42\n0 90\n0\n100 0\n")
    };
    files.job.replace_first(
        "small.toml",
        "[[scene.lights]]",
        "[[scene.lights]]\ntype = \"measured\"\nname = \"lamp\"\nfile = \"lamp.ies\"\nilluminant = \"A\"\nposition_m = [5, 0, 4]\n\n[[scene.lights]]",
    );
    files.job.write("lamp.ies", lamp("NONE"));
    files.plan(&[]).ok();
    fs::write(files.secret("tilt.txt"), "1\n2\n0 90\n1 1\n").expect("written");
    files.job.write("lamp.ies", lamp(&files.path_through_parents("tilt.txt")));
    files.refused(&[], "tilt.txt");
}

#[test]
fn a_shard_stays_in_its_sandbox_when_it_is_merged() {
    let files = ForeignFiles::new();
    let shard = text(&files.job.folder().join("shard"));
    let out = text(&files.job.folder().join("out"));
    etendue(["render", &files.job.job(), "--sandboxed", "--spp", "2", "--shard", "0/1", "-o", &shard]).ok();
    let manifest = fs::read_to_string(Path::new(&shard).join("shard.json")).expect("the manifest");
    assert!(manifest.contains("\"sandbox\""), "{manifest}");
    etendue(["merge", &shard, "-o", &out]).ok();
    let set = format!("scene.textures.checker.file={}", files.secret("checker.png"));
    let (before, after) = manifest.split_once("\"set\": []").expect("no change");
    fs::write(Path::new(&shard).join("shard.json"), format!("{before}\"set\": [\"{set}\"]{after}")).expect("written");
    etendue(["merge", &shard, "-o", &out, "--overwrite"]).refused(&["checker.png", OUTSIDE_MESSAGE]);
}

#[test]
fn results_go_nowhere_else_and_options_belong_together() {
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "name = \"front\"", "name = \"../front\"");
    let output = job.render(&["--sandboxed", "--spp", "2"]);
    assert_ne!(output.status, 0, "{output:?}");
    etendue(["plan", &job.job(), "--allow-outside", "x"]).refused(&["--sandboxed"]);
    etendue(["plan", &job.job(), "--sandboxed", "--allow-outside", "no/such"]).refused(&["--allow-outside no/such"]);
    for verb in ["plan", "render", "rig", "tradeoff"] {
        assert!(etendue(["help", verb]).ok().out.contains("--sandboxed"), "{verb}");
    }
}
