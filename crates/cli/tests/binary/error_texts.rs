//! Texts of errors: the erroneous inputs of tests/freeze/errors.json, with exit status and all that is printed, against one stored file. Other tests
//! assert codes and places.
//!
//! `ETENDUE_BLESS=1 cargo test -p etendue-cli --test binary error_texts::` stores the texts.

use crate::support::{bless, etendue_in, root, tests};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Files that match a path with at most one `*` in its file name.
fn matches(pattern: &str) -> Vec<PathBuf> {
    let path = root().join(pattern);
    let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
    let Some((head, tail)) = name.split_once('*') else { return vec![path] };
    let entries = fs::read_dir(path.parent().expect("a folder")).expect("a folder");
    let files = entries.map(|entry| entry.expect("an entry").path()).filter(|path| path.is_file());
    let fits = |path: &PathBuf| {
        path.file_name()
            .and_then(|name| name.to_str())
            .is_some_and(|name| name.starts_with(head) && name.ends_with(tail))
    };
    files.filter(fits).collect()
}

/// Texts of a list of the table.
fn texts(list: &Value) -> Vec<&str> {
    list.as_array().into_iter().flatten().map(|text| text.as_str().expect("a text")).collect()
}

/// Entries of an object of the table; none if it is absent.
fn entries<'a>(case: &'a Value, key: &str) -> impl Iterator<Item = (&'a String, &'a Value)> {
    case[key].as_object().into_iter().flatten()
}

/// Prepares the folder of a case (tests/freeze/errors.py, `prepare`).
fn prepare(table: &Value, case: &Value, folder: &Path) {
    let base = case["base"].as_str().unwrap_or("small");
    for file in texts(&table["bases"][base]).into_iter().flat_map(matches) {
        fs::copy(&file, folder.join(file.file_name().expect("a name"))).expect("copied");
    }
    for edit in case["edit"].as_array().into_iter().flatten() {
        let [file, from, to] = texts(edit)[..] else { panic!("{case}: an edit has a file and two texts") };
        let path = folder.join(file);
        let text = fs::read_to_string(&path).expect("a text");
        assert!(text.contains(from), "{file} lacks {from:?}");
        fs::write(&path, text.replacen(from, to, 1)).expect("written");
    }
    for (file, text) in entries(case, "write") {
        fs::write(folder.join(file), text.as_str().expect("a text")).expect("written");
    }
    for (file, fraction) in entries(case, "cut") {
        let bytes = fs::read(folder.join(file)).expect("a file");
        let length = (bytes.len() as f64 * fraction.as_f64().expect("a number")) as usize;
        fs::write(folder.join(file), &bytes[..length]).expect("written");
    }
    for file in texts(&case["remove"]) {
        fs::remove_file(folder.join(file)).expect("removed");
    }
}

#[test]
fn every_error_has_its_stored_text() {
    let table = fs::read_to_string(root().join("tests/freeze/errors.json")).expect("the table");
    let table: Value = serde_json::from_str(&table).expect("JSON");
    let cases = table["cases"].as_array().expect("a list");
    assert!(cases.len() > 140, "{}", cases.len());
    let mut current = String::new();
    for case in cases {
        let folder = tempfile::tempdir().expect("a temporary folder");
        prepare(&table, case, folder.path());
        let words = if case["run"].is_null() { vec!["plan", "small.toml"] } else { texts(&case["run"]) };
        let ran = etendue_in(folder.path(), words);
        let name = case["name"].as_str().expect("a name");
        let place = folder.path().to_str().expect("UTF-8");
        writeln!(current, "## {name} (exit status {})\n{}", ran.status, ran.err.replace(place, "FOLDER"))
            .expect("a string");
    }
    let path = tests().join("binary/error_texts.txt");
    if bless() {
        fs::write(&path, &current).expect("written");
    }
    let stored = fs::read_to_string(&path).expect("the stored texts");
    let differing = stored.split("## ").zip(current.split("## ")).filter(|(stored, current)| stored != current);
    let differing: Vec<String> = differing.map(|(stored, current)| format!("stored: {stored}now: {current}")).collect();
    assert!(stored == current, "{}\nstore them with ETENDUE_BLESS=1", differing.join("\n"));
}
