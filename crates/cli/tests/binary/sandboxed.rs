//! Untrusted jobs: no file outside their folder is read, whichever file names it and by any path.

use crate::bad_input::Spoilt;
use crate::support::{Ran, contents, etendue, text};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use tempfile::TempDir;

const OUT: &str = "this path is outside the job's folder";

/// A job in a folder next to files of others.
struct Foreign {
    /// Files that do not belong to the job.
    secrets: TempDir,
    job: Spoilt,
}

impl Foreign {
    fn new() -> Self {
        let secrets = tempfile::tempdir().expect("a temporary folder");
        let job = Spoilt::new();
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
    fn climbing(&self, name: &str) -> String {
        let up = "../".repeat(self.job.folder().components().count());
        format!("{up}{}", self.secret(name).trim_start_matches('/'))
    }

    fn plan(&self, options: &[&str]) -> Ran {
        etendue(["plan", &self.job.job(), "--sandboxed"].iter().chain(options))
    }

    /// Asserts a refusal in the sandbox at that file, and success without the sandbox or with its folder allowed.
    #[track_caller]
    fn refused(&self, options: &[&str], place: &str) {
        self.plan(options).refused(&[place, OUT, "--allow-outside"]);
        let folder = text(self.secrets.path());
        self.plan(&[options, &["--allow-outside", &folder]].concat()).ok();
        etendue(["plan", &self.job.job()].iter().chain(options)).ok();
    }
}

#[test]
fn a_job_within_its_folder_is_rendered_and_nothing_changes() {
    let spoilt = Spoilt::new();
    let run = |folder: &str, options: &[&str]| {
        let out = text(&spoilt.folder().join(folder));
        etendue(["render", &spoilt.job(), "-o", &out, "--spp", "2"].iter().chain(options)).ok();
        contents(Path::new(&out))
    };
    assert_eq!(run("a", &[]), run("b", &["--sandboxed"]));
    let inside = format!("scene.textures.checker.file={}", text(&spoilt.folder().join("checker.png")));
    etendue(["plan", &spoilt.job(), "--sandboxed", "--set", &inside]).ok();
}

#[test]
fn absolute_paths_and_parents_lead_out() {
    for way in [Foreign::secret, Foreign::climbing] {
        let foreign = Foreign::new();
        let path = way(&foreign, "checker.png");
        foreign.job.spoil("small.toml", "file = \"checker.png\"", &format!("file = \"{path}\""));
        foreign.refused(&[], "checker.png");
        let foreign = Foreign::new();
        let path = way(&foreign, "tower.obj");
        foreign.job.spoil("small.toml", "file = \"tower.obj\"", &format!("file = \"{path}\""));
        foreign.refused(&[], "tower.obj");
    }
}

#[test]
fn links_lead_out() {
    for name in ["checker.png", "tower.obj", "sky.hdr"] {
        let foreign = Foreign::new();
        let link = foreign.job.folder().join(name);
        fs::remove_file(&link).expect("removed");
        symlink(foreign.secret(name), &link).expect("link");
        foreign.refused(&[], name);
    }
    let foreign = Foreign::new();
    symlink(foreign.secrets.path(), foreign.job.folder().join("meshes")).expect("link");
    foreign.job.spoil("small.toml", "file = \"tower.obj\"", "file = \"meshes/tower.obj\"");
    foreign.refused(&[], "meshes/tower.obj");
    // The job itself.
    let foreign = Foreign::new();
    let link = foreign.job.folder().join("link.toml");
    symlink(foreign.secret("small.toml"), &link).expect("link");
    etendue(["plan", &text(&link), "--sandboxed"]).refused(&["link.toml", OUT]);
}

#[test]
fn material_libraries_and_their_pictures_lead_out() {
    let foreign = Foreign::new();
    let library = foreign.climbing("tower.mtl");
    foreign.job.spoil("tower.obj", "mtllib tower.mtl", &format!("mtllib {library}"));
    foreign.refused(&[], "tower.obj:2");
    // A missing file is reported like an existing one.
    foreign.job.spoil("tower.obj", "tower.mtl", "none.mtl");
    foreign.plan(&[]).refused(&["tower.obj:2", OUT]);
    let foreign = Foreign::new();
    let picture = foreign.secret("checker.png");
    foreign.job.spoil("tower.mtl", "map_Kd checker.png", &format!("map_Kd {picture}"));
    foreign.refused(&[], "checker.png");
}

#[test]
fn changes_scenes_cameras_and_bases_lead_out() {
    let foreign = Foreign::new();
    let set = format!("scene.textures.checker.file={}", foreign.secret("checker.png"));
    foreign.refused(&["--set", &set], "checker.png");
    foreign.plan(&["--set", &format!("scene={}", foreign.secret("scene.toml"))]).refused(&["scene.toml", OUT]);
    let foreign = Foreign::new();
    foreign.job.write("job.toml", format!("format = 1\nbase = \"{}\"\n", foreign.secret("small.toml")));
    let job = text(&foreign.job.folder().join("job.toml"));
    etendue(["plan", &job, "--sandboxed"]).refused(&["job.toml:2:8", "small.toml", OUT]);
    etendue(["plan", &job]).ok();
    foreign.job.write(
        "job.toml",
        "format = 1\nscene = \"/no/scene.toml\"\n[[cameras]]\nname = \"a\"\nfile = \"../../x.toml\"\n",
    );
    etendue(["plan", &job, "--sandboxed"]).refused(&["job.toml:2:9", "/no/scene.toml", OUT]).says(&[
        "job.toml:5:8",
        "../x.toml",
        OUT,
    ]);
}

#[test]
fn tables_of_lamps_lead_out() {
    let foreign = Foreign::new();
    let lamp = |tilt: &str| {
        format!("IESNA:LM-63-1995\n[TEST] 7\nTILT={tilt}\n1 1000 1 2 1 1 2 0 0 0\n1 1 42\n0 90\n0\n100 0\n")
    };
    foreign.job.spoil(
        "small.toml",
        "[[scene.lights]]",
        "[[scene.lights]]\ntype = \"measured\"\nname = \"lamp\"\nfile = \"lamp.ies\"\nilluminant = \"A\"\nposition_m = [5, 0, 4]\n\n[[scene.lights]]",
    );
    foreign.job.write("lamp.ies", lamp("NONE"));
    foreign.plan(&[]).ok();
    fs::write(foreign.secret("tilt.txt"), "1\n2\n0 90\n1 1\n").expect("written");
    foreign.job.write("lamp.ies", lamp(&foreign.climbing("tilt.txt")));
    foreign.refused(&[], "tilt.txt");
}

#[test]
fn a_shard_stays_in_its_sandbox_when_it_is_merged() {
    let foreign = Foreign::new();
    let shard = text(&foreign.job.folder().join("shard"));
    let out = text(&foreign.job.folder().join("out"));
    etendue(["render", &foreign.job.job(), "--sandboxed", "--spp", "2", "--shard", "0/1", "-o", &shard]).ok();
    let manifest = fs::read_to_string(Path::new(&shard).join("shard.json")).expect("the manifest");
    assert!(manifest.contains("\"sandbox\""), "{manifest}");
    etendue(["merge", &shard, "-o", &out]).ok();
    let set = format!("scene.textures.checker.file={}", foreign.secret("checker.png"));
    let (before, after) = manifest.split_once("\"set\": []").expect("no change");
    fs::write(Path::new(&shard).join("shard.json"), format!("{before}\"set\": [\"{set}\"]{after}")).expect("written");
    etendue(["merge", &shard, "-o", &out, "--overwrite"]).refused(&["checker.png", OUT]);
}

#[test]
fn results_go_nowhere_else_and_options_belong_together() {
    let spoilt = Spoilt::new();
    spoilt.spoil("small.toml", "name = \"front\"", "name = \"../front\"");
    let ran = spoilt.render(&["--sandboxed", "--spp", "2"]);
    assert_ne!(ran.status, 0, "{ran:?}");
    etendue(["plan", &spoilt.job(), "--allow-outside", "x"]).refused(&["--sandboxed"]);
    etendue(["plan", &spoilt.job(), "--sandboxed", "--allow-outside", "no/such"]).refused(&["--allow-outside no/such"]);
    for verb in ["plan", "render", "rig", "tradeoff"] {
        assert!(etendue(["help", verb]).ok().out.contains("--sandboxed"), "{verb}");
    }
}
