//! The additions of `tests/additions`, a patch each: they apply one after the other, touch no more code files than their limits, and their pages in
//! `docs/how-to-add` name the same files. `just additions` builds and tests them.

use crate::root;
use crate::tidy::quoted;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// An addition: a patch and its page.
struct Addition {
    /// The patch, without its ending.
    patch: &'static str,
    /// The page, without its ending.
    page: &'static str,
    /// The largest number of code files.
    max_files: usize,
}

const ADDITIONS: &[Addition] = &[
    Addition { patch: "01-render-setting", page: "render-setting", max_files: 5 },
    Addition { patch: "02-output-product", page: "output-product", max_files: 5 },
    Addition { patch: "03-sensor-effect", page: "sensor-effect", max_files: 4 },
    Addition { patch: "04-projection", page: "projection", max_files: 4 },
    Addition { patch: "05-measurement", page: "measurement", max_files: 4 },
    Addition { patch: "06-verb", page: "verb", max_files: 2 },
    Addition { patch: "07-bsdf", page: "bsdf", max_files: 4 },
];

impl Addition {
    fn path(&self) -> PathBuf {
        root().join(format!("tests/additions/{}.patch", self.patch))
    }

    /// The files that the patch changes or makes.
    fn files(&self) -> BTreeSet<String> {
        let text = std::fs::read_to_string(self.path()).unwrap_or_else(|error| panic!("{}: {error}", self.patch));
        text.lines().filter_map(|line| line.strip_prefix("+++ b/")).map(str::to_owned).collect()
    }

    /// The files of Rust among them that are no tests.
    fn code_files(&self) -> BTreeSet<String> {
        let is_code = |name: &String| name.ends_with(".rs") && !name.starts_with("tests/") && !name.contains("/tests/");
        self.files().into_iter().filter(is_code).collect()
    }
}

/// The files that any of the patches changes or makes.
pub(crate) fn files_of_all() -> BTreeSet<String> {
    ADDITIONS.iter().flat_map(Addition::files).collect()
}

#[test]
fn every_patch_is_listed() {
    let names = std::fs::read_dir(root().join("tests/additions")).expect("the folder").filter_map(Result::ok);
    let names = names.filter_map(|entry| entry.file_name().into_string().ok());
    let listed_files: BTreeSet<String> =
        names.filter_map(|name| name.strip_suffix(".patch").map(str::to_owned)).collect();
    let listed: BTreeSet<String> = ADDITIONS.iter().map(|addition| addition.patch.to_owned()).collect();
    assert_eq!(listed_files, listed);
}

#[test]
fn additions_touch_few_files() {
    let violations: Vec<String> = ADDITIONS
        .iter()
        .filter(|addition| addition.code_files().len() > addition.max_files)
        .map(|addition| format!("{}: {:?}, more than {}", addition.patch, addition.code_files(), addition.max_files))
        .collect();
    assert!(violations.is_empty(), "{violations:#?}");
}

#[test]
fn pages_name_the_files_of_their_patches() {
    const MAX_WORDS: usize = 250;
    for addition in ADDITIONS {
        let name = format!("docs/how-to-add/{}.md", addition.page);
        let page = std::fs::read_to_string(root().join(&name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let steps = page.split_once("\n## Steps\n").map_or("", |(_, rest)| rest.split("\n## ").next().unwrap_or(rest));
        let is_code = |word: &&str| word.starts_with("crates/") && word.ends_with(".rs");
        let named: BTreeSet<String> = quoted(steps).filter(is_code).map(str::to_owned).collect();
        assert_eq!(named, addition.code_files(), "{name} and {}", addition.patch);
        let include = format!("\n```diff\n{{{{#include ../../tests/additions/{}.patch}}}}\n```\n", addition.patch);
        assert!(page.contains(&include), "{name} does not include its patch");
        let words = page.split_whitespace().count();
        assert!(words <= MAX_WORDS, "{name}: {words} words, more than {MAX_WORDS}");
    }
}

/// Applies a patch in a folder that is no part of a repository.
fn apply(patch: &Path, folder: &Path) -> Result<(), String> {
    let above = folder.parent().expect("a folder of the target");
    let output = Command::new("git")
        .args(["apply", "--whitespace=nowarn"])
        .arg(patch)
        .current_dir(folder)
        .env("GIT_CEILING_DIRECTORIES", above)
        .output()
        .map_err(|error| error.to_string())?;
    if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&output.stderr).into_owned()) }
}

#[test]
fn patches_apply_in_order() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("additions");
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("an old copy goes");
    }
    for name in files_of_all() {
        let copy = folder.join(&name);
        std::fs::create_dir_all(copy.parent().expect("a folder")).expect("folders");
        if root().join(&name).exists() {
            std::fs::copy(root().join(&name), &copy).expect("a copy");
        }
    }
    for addition in ADDITIONS {
        if let Err(reason) = apply(&addition.path(), &folder) {
            panic!("{} does not apply ({}): regenerate it, see tests/additions/run", addition.patch, reason.trim());
        }
        let missing: Vec<String> = addition.files().into_iter().filter(|name| !folder.join(name).exists()).collect();
        assert!(missing.is_empty(), "{}: {missing:?}", addition.patch);
    }
}
