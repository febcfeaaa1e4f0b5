//! Unusable output folders, links in them, and names unsuitable for files.

use crate::bad_input::ModifiedJob;
use crate::support::{contents, etendue, rendered, small, text};
use serde_json::Value;
use std::fs;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;

const LIGHT: [&str; 2] = ["--spp", "2"];

/// Unwritable paths are refused before anything is rendered, and are named.
#[test]
fn folders_that_cannot_be_are_refused_before_the_work() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("file");
    fs::write(&file, b"theirs").expect("written");
    let endless = ["--spp", "1000000"];
    let assert_refused = |out: &Path, why: &str| {
        let out = text(out);
        etendue(["render", &small(), "-o", &out].iter().chain(&endless)).refused(&[&out, why]);
    };
    assert_refused(&file, "expected a folder for the results, but this is a file");
    etendue(["render", &small(), "-o", &text(&file.join("deep"))].iter().chain(&endless)).refused(&[&text(&file)]);
    assert_eq!(fs::read(&file).expect("a file"), b"theirs");
    // The kernel's own folder accepts no files, even from root.
    if cfg!(target_os = "linux") {
        assert_refused(Path::new("/proc/etendue"), "this output folder cannot be created");
        assert_refused(Path::new("/proc"), "this output folder cannot be written to");
    }
    assert_refused(&place.path().join("n".repeat(300)), "this output folder cannot be created: File name too long");
    // A file in place of a camera's folder, and a folder in place of a file.
    let out = place.path().join("out");
    fs::create_dir_all(out.join("front/radiance.exr")).expect("made");
    etendue(["render", &small(), "-o", &text(&out), "--overwrite"].iter().chain(&endless))
        .refused(&["radiance.exr", "a folder has the name of a result"]);
    fs::remove_dir_all(out.join("front")).expect("removed");
    fs::write(out.join("front"), b"").expect("written");
    etendue(["render", &small(), "-o", &text(&out), "--overwrite"].iter().chain(&endless))
        .refused(&["front", "expected a folder for the results, but this is a file"]);
}

/// Permission bits do not apply to root: this is only tested under another user.
#[test]
fn a_read_only_folder_is_refused_before_the_work() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    fs::create_dir(&out).expect("made");
    fs::set_permissions(&out, fs::Permissions::from_mode(0o555)).expect("set");
    if fs::write(out.join("probe"), b"").is_ok() {
        etendue_testkit::skip::skipped("a read-only folder", "the tests run as root, whom permissions do not stop");
        return;
    }
    etendue(["render", &small(), "-o", &text(&out), "--spp", "1000000"])
        .refused(&[&text(&out), "this output folder cannot be written to"]);
    fs::set_permissions(&out, fs::Permissions::from_mode(0o755)).expect("set");
}

#[test]
fn links_are_replaced_and_never_written_through() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let others = place.path().join("foreign");
    fs::create_dir(&others).expect("made");
    fs::write(others.join("theirs.exr"), b"theirs").expect("written");
    let (out, real) = (place.path().join("out"), place.path().join("real"));
    fs::create_dir_all(real.join("front")).expect("made");
    // The output folder itself may be a link.
    symlink(&real, &out).expect("link");
    symlink(others.join("theirs.exr"), real.join("front/radiance.exr")).expect("link");
    symlink(others.join("none.png"), real.join("front/picture.0000.png")).expect("link");
    let render =
        |options: &[&str]| etendue(["render", &small(), "-o", &text(&out)].iter().chain(&LIGHT).chain(options));
    render(&[]).refused(&["front/", "already exists"]);
    render(&["--overwrite"]).ok();
    assert!(contents(&real) == rendered(&small(), &LIGHT), "the files of a folder without links");
    assert!(!real.join("front/radiance.exr").is_symlink());
    assert_eq!(contents(&others).keys().collect::<Vec<_>>(), ["theirs.exr"]);
    assert_eq!(fs::read(others.join("theirs.exr")).expect("a file"), b"theirs");
    fs::remove_dir_all(real.join("front")).expect("removed");
    symlink(&others, real.join("front")).expect("link");
    render(&["--overwrite"]).refused(&["front", "a symbolic link is in the place of a results folder"]);
    assert_eq!(contents(&others).len(), 1);
}

/// The state of a progressive run is in a subfolder: a link in its place is never followed.
#[test]
fn a_link_in_the_place_of_the_state_is_refused_and_nothing_is_deleted_behind_it() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (out, others) = (place.path().join("out"), place.path().join("foreign"));
    [&out, &others].iter().for_each(|folder| fs::create_dir(folder).expect("made"));
    fs::write(others.join("front.film.exr"), b"precious").expect("written");
    symlink(&others, out.join(".progress")).expect("link");
    for options in [&["--overwrite"][..], &["--resume"], &[], &["--progressive"], &["--progressive", "--overwrite"]] {
        etendue(["render", &small(), "-o", &text(&out)].iter().chain(&LIGHT).chain(options))
            .refused(&[".progress", "a symbolic link is in the place of a results folder"]);
        assert_eq!(fs::read(others.join("front.film.exr")).expect("a file"), b"precious", "{options:?}");
    }
    assert_eq!(contents(&others).len(), 1);
}

#[test]
fn names_of_cameras_are_names_of_files_on_every_system() {
    let long = "n".repeat(101);
    let names = [
        "",
        ".",
        "..",
        "../x",
        "/x",
        "a/b",
        "a\\\\b",
        "a b",
        "a\\nb",
        "a\\u001b[2Jb",
        "a\\u0000b",
        "straße",
        "CON",
        "com1",
        "nul",
        &long,
    ];
    for name in names {
        let job = ModifiedJob::new();
        job.replace_first("small.toml", "name = \"front\"", &format!("name = \"{name}\""));
        job.render(&LIGHT).refused(&["small.toml:", "name", "letters, digits, - and _"]);
    }
    let job = ModifiedJob::new();
    let long = "n".repeat(100);
    job.replace_first("small.toml", "name = \"front\"", &format!("name = \"{long}\""));
    let out = job.folder().join("results");
    etendue(["render", &job.job(), "-o", &text(&out)].iter().chain(&LIGHT)).ok();
    assert!(out.join(&long).join("radiance.exr").exists());
}

/// Names of objects are in no file name; the side-car states them unchanged.
#[test]
fn names_of_objects_may_be_anything() {
    let unusual = ["../../x", ".", "-rf", "two\nlines \"and\" quotes", "nul\0", "\u{202e}straße 🚗", &"n".repeat(5000)];
    let objects: String = unusual
        .iter()
        .map(|name| {
            let name = serde_json::to_string(name).expect("text");
            format!(
                "[[scene.objects]]\nname = {name}\nshape = {{ type = \"sphere\", radius_m = 0.1 }}\nposition_m = [4, 0, 1]\nmaterial = \"grey\"\n"
            )
        })
        .collect();
    let place = tempfile::tempdir().expect("a temporary folder");
    let job = place.path().join("job.toml");
    fs::write(&job, format!("{}{objects}", crate::support::BALL)).expect("written");
    let set = ["--set", "cameras.front.output.boxes=true"];
    let files = rendered(&text(&job), &[&LIGHT[..], &set].concat());
    let facts: Value = serde_json::from_slice(&files["front/camera.json"]).expect("JSON");
    let message = facts.to_string();
    for name in unusual {
        assert!(message.contains(&Value::from(name).to_string()), "{name:?}");
    }
    assert!(files.keys().all(|name| name.starts_with("front/")), "{:?}", files.keys());
}

#[test]
fn names_of_folders_may_be_anything_that_the_system_takes() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let expected = rendered(&small(), &LIGHT);
    let name = std::ffi::OsString::from_vec;
    for unusual in
        [b"two\nlines".to_vec(), "straße 🚗".into(), b"-rf".to_vec(), b"not \xff UTF-8".to_vec(), b". ".to_vec()]
    {
        let out = place.path().join(name(unusual));
        let arguments = ["render".into(), small().into(), "-o".into(), out.clone().into_os_string()];
        etendue(arguments.into_iter().chain(LIGHT.map(std::ffi::OsString::from))).ok();
        assert!(contents(&out) == expected, "{out:?}");
    }
}

/// The manifest of a shard is text.
#[test]
fn a_shard_of_a_job_whose_path_is_no_text_is_refused_before_the_work() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = place.path().join(std::ffi::OsString::from_vec(b"not \xff UTF-8".to_vec()));
    fs::create_dir(&folder).expect("made");
    let job = folder.join("job.toml");
    fs::write(&job, crate::support::BALL).expect("written");
    let out = place.path().join("out");
    let run = |options: &[&str]| {
        let arguments = ["render".into(), job.clone().into_os_string(), "-o".into(), out.clone().into_os_string()];
        etendue(arguments.into_iter().chain(options.iter().map(std::ffi::OsString::from)))
    };
    run(&["--spp", "1000000", "--shard", "0/2"]).refused(&["job.toml", "UTF-8"]);
    run(&LIGHT).ok();
}
