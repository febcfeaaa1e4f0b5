//! Contract of an output folder: final names, remaining files, refusals.

use super::*;

fn listing(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .expect("folder")
        .map(|e| e.expect("entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn nothing_has_its_final_name_before_the_commit() {
    let place = tempfile::tempdir().expect("temporary folder");
    let root = place.path().join("a/b");
    let mut out = OutputFolder::open(&root, ExistingFiles::Refuse).expect("new folder");
    out.write("x.txt", b"one").expect("write");
    out.write("deep/y.txt", b"two").expect("write");
    assert!(!root.join("x.txt").exists() && !root.join("deep/y.txt").exists());
    assert_eq!(out.commit().expect("commit"), [root.join("x.txt"), root.join("deep/y.txt")]);
    assert_eq!(listing(&root), ["deep", "x.txt"]);
    assert_eq!(fs::read(root.join("deep/y.txt")).expect("file"), b"two");
}

#[test]
fn what_was_written_can_be_read_before_and_after_it_has_its_name() {
    let place = tempfile::tempdir().expect("temporary folder");
    let mut out = OutputFolder::open(place.path(), ExistingFiles::Refuse).expect("folder");
    out.write_with("a/x.txt", |file| b"onetwo".chunks(3).try_for_each(|part| file.write_all(part))).expect("write");
    let read = |out: &OutputFolder| fs::read(out.readable_path("a/x.txt").expect("a plain name")).expect("a file");
    assert_eq!(read(&out), b"onetwo");
    out.publish().expect("published");
    assert_eq!(read(&out), b"onetwo");
    assert_eq!(out.readable_path("a/x.txt").expect("a plain name"), place.path().join("a/x.txt"));
}

#[test]
fn a_dropped_folder_leaves_no_trace() {
    let place = tempfile::tempdir().expect("temporary folder");
    let mut out = OutputFolder::open(&place.path().join("a/b"), ExistingFiles::Refuse).expect("new folder");
    out.write("deep/x.txt", b"one").expect("write");
    drop(out);
    assert_eq!(listing(place.path()), Vec::<String>::new());
}

#[test]
fn an_earlier_result_is_kept_unless_replacing_is_allowed() {
    let place = tempfile::tempdir().expect("temporary folder");
    fs::write(place.path().join("x.txt"), b"old").expect("write");
    let refusing = OutputFolder::open(place.path(), ExistingFiles::Refuse).expect("open");
    let message = refusing.claim(["y.txt", "x.txt"]).expect_err("x.txt is there").to_string();
    assert!(
        message.ends_with("x.txt: already exists; choose another folder, or allow overwriting with `overwrite`"),
        "{message}"
    );
    drop(refusing);
    let mut replacing = OutputFolder::open(place.path(), ExistingFiles::Replace).expect("open");
    replacing.claim(["x.txt"]).expect("allowed");
    replacing.write("x.txt", b"new").expect("write");
    assert_eq!(fs::read(place.path().join("x.txt")).expect("file"), b"old");
    replacing.commit().expect("commit");
    assert_eq!(fs::read(place.path().join("x.txt")).expect("file"), b"new");
}

#[test]
fn a_file_that_appears_during_the_run_is_not_overwritten() {
    let place = tempfile::tempdir().expect("temporary folder");
    let mut out = OutputFolder::open(place.path(), ExistingFiles::Refuse).expect("open");
    out.write("x.txt", b"ours").expect("write");
    fs::write(place.path().join("x.txt"), b"theirs").expect("write");
    out.commit().expect_err("refused");
    assert_eq!(fs::read(place.path().join("x.txt")).expect("file"), b"theirs");
    assert_eq!(listing(place.path()), ["x.txt"]);
}

#[test]
fn one_run_at_a_time_has_a_folder() {
    let place = tempfile::tempdir().expect("temporary folder");
    let first = OutputFolder::open(place.path(), ExistingFiles::Refuse).expect("free");
    let message = OutputFolder::open(place.path(), ExistingFiles::Replace).expect_err("taken").to_string();
    assert!(message.contains("another run of this process is writing into this folder"), "{message}");
    OutputFolder::open_part(place.path(), "a", ExistingFiles::Refuse).expect_err("taken");
    let again = first.reopened(ExistingFiles::Replace).expect("the same run");
    drop(first);
    OutputFolder::open(place.path(), ExistingFiles::Refuse).expect_err("the run goes on");
    let mut sibling = OutputFolder::open_beside(place.path(), ExistingFiles::Refuse).expect("single files");
    sibling.write("x.txt", b"x").expect("write");
    sibling.commit().expect("commit");
    drop(again);
    let parts =
        ["a", "b"].map(|part| OutputFolder::open_part(place.path(), part, ExistingFiles::Refuse).expect("free"));
    OutputFolder::open_part(place.path(), "b", ExistingFiles::Refuse).expect_err("taken");
    drop(parts);
    assert_eq!(listing(place.path()), ["x.txt"], "folders without results go");
    OutputFolder::open(place.path(), ExistingFiles::Refuse).expect("free");
}

/// Runs of parts that create one folder together, and remove it, as they end without results.
#[test]
fn parts_of_a_folder_that_others_make_and_remove_are_each_had() {
    let place = tempfile::tempdir().expect("temporary folder");
    let root = &place.path().join("out/deep");
    let run = |part: usize| {
        drop(OutputFolder::open_part(root, &part.to_string(), ExistingFiles::Refuse).expect("free"));
        drop(OutputFolder::open_beside(root, ExistingFiles::Refuse).expect("free"));
    };
    std::thread::scope(|threads| {
        (0..4).for_each(|part| _ = threads.spawn(move || (0..300).for_each(|_| run(part))));
    });
}

#[cfg(unix)]
#[test]
fn links_are_not_followed() {
    use std::os::unix::fs::symlink;
    let place = tempfile::tempdir().expect("temporary folder");
    let (root, foreign) = (place.path().join("out"), place.path().join("foreign"));
    [&root, &foreign].iter().for_each(|folder| fs::create_dir(folder).expect("folder"));
    fs::write(foreign.join("x.txt"), b"theirs").expect("write");
    for (name, to) in [("x.txt", "x.txt"), ("y.txt", "none")] {
        symlink(foreign.join(to), root.join(name)).expect("link");
    }
    symlink(&foreign, root.join("deep")).expect("link");
    let refusing = OutputFolder::open(&root, ExistingFiles::Refuse).expect("open");
    for name in ["x.txt", "y.txt"] {
        let message = refusing.claim([name]).expect_err("a link is there").to_string();
        assert!(message.contains("already exists"), "{message}");
    }
    drop(refusing);
    let mut replacing = OutputFolder::open(&root, ExistingFiles::Replace).expect("open");
    for message in [replacing.claim(["deep/z.txt"]), replacing.write("deep/z.txt", b"")] {
        let message = message.expect_err("a link in the place of a folder").to_string();
        assert!(message.contains("a symbolic link is in the place of a results folder"), "{message}");
    }
    ["x.txt", "y.txt"].iter().for_each(|name| replacing.write(name, b"ours").expect("write"));
    replacing.commit().expect("commit");
    assert!(["x.txt", "y.txt"].iter().all(|name| !root.join(name).is_symlink()));
    assert_eq!(fs::read(foreign.join("x.txt")).expect("file"), b"theirs");
    assert_eq!(listing(&foreign), ["x.txt"]);
}

#[test]
fn a_name_that_is_too_long_is_refused_before_anything_is_made() {
    let place = tempfile::tempdir().expect("temporary folder");
    let out = OutputFolder::open(place.path(), ExistingFiles::Replace).expect("open");
    let message = out.claim([format!("{}/x.txt", "n".repeat(300)).as_str()]).expect_err("too long").to_string();
    assert!(message.contains("cannot be written: "), "{message}");
}

#[test]
fn names_stay_inside_and_are_used_once() {
    let place = tempfile::tempdir().expect("temporary folder");
    let mut out = OutputFolder::open(place.path(), ExistingFiles::Refuse).expect("open");
    for name in ["", "../x", "/x", "a/../x"] {
        out.write(name, b"").expect_err(name);
    }
    out.write("x", b"").expect("first");
    out.write("x", b"").expect_err("second");
}

#[test]
fn a_file_in_the_place_of_the_folder_is_named() {
    let place = tempfile::tempdir().expect("temporary folder");
    let file = place.path().join("taken");
    fs::write(&file, b"").expect("write");
    let message = OutputFolder::open(&file, ExistingFiles::Replace).expect_err("a file").to_string();
    assert!(message.contains("expected a folder for the results, but this is a file"), "{message}");
}
