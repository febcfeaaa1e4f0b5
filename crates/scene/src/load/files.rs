//! Reads a job and the files that it names into one tree, and applies the overrides.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use super::base;
use super::read_text::ReadText;
use crate::document::{Node, Value, parse};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::overrides::Overrides;
use crate::place::Place;
use crate::reader::{Record as _, Rule as _, path};
use crate::record::{Camera, Job, Scene};

/// Content of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FileKind {
    Job,
    Scene,
    Camera,
}

impl FileKind {
    fn word(self) -> &'static str {
        match self {
            Self::Job => "job",
            Self::Scene => "scene",
            Self::Camera => "camera",
        }
    }

    /// Keys of this kind; derived once from the schema of everything in it.
    fn keys(self) -> &'static [&'static str] {
        static KEYS: [OnceLock<Vec<&str>>; 3] = [const { OnceLock::new() }; 3];
        KEYS[self as usize].get_or_init(|| match self {
            Self::Job => Job::keys(),
            Self::Scene => Scene::keys(),
            Self::Camera => Camera::keys(),
        })
    }

    fn has_key_of(self, tree: &Node) -> bool {
        tree.as_table().is_some_and(|table| self.keys().iter().any(|key| table.get(key).is_some()))
    }

    /// The kind of the tree, where no key of it belongs to this kind and some to another.
    fn actual_kind(self, tree: &Node) -> Option<Self> {
        let others = [Self::Job, Self::Scene, Self::Camera].into_iter().filter(|kind| kind.has_key_of(tree));
        if self.has_key_of(tree) { None } else { others.reduce(|first, _| first) }
    }
}

/// Returns the tree of a job, with the trees of its scene and cameras instead of their file names.
pub(super) fn job(
    file: &Path,
    read: &ReadText<'_>,
    overrides: &Overrides,
    errors: &mut DescriptionErrors,
) -> Option<Node> {
    let mut document = document(file, FileKind::Job, read, &Place::file_head(file), errors)?;
    overrides.apply(&mut document, true, errors);
    let table = document.as_table_mut()?;
    if let Some(scene) = table.get_mut("scene") {
        splice(scene, FileKind::Scene, read, errors);
    }
    if let Some(Node { value: Value::List(cameras), .. }) = table.get_mut("cameras") {
        for camera in cameras {
            if let Some(file) = camera.as_table_mut().and_then(|t| t.get_mut("file")) {
                splice(file, FileKind::Camera, read, errors);
            }
        }
    }
    overrides.apply(&mut document, false, errors);
    Some(document)
}

/// Replaces the name of a file by its tree.
fn splice(node: &mut Node, kind: FileKind, read: &ReadText<'_>, errors: &mut DescriptionErrors) {
    if node.as_text().is_none() {
        return;
    }
    let file = path(&["toml"]).read(node, errors);
    let tree = file.and_then(|file| document(&file, kind, read, &node.place, errors));
    *node = tree.unwrap_or(Node { place: node.place.clone(), value: Value::Unreadable });
}

/// Returns the tree of a file of one kind, named at `named`, merged over that of its base. Its format is checked and removed.
pub(super) fn document(
    file: &Path,
    kind: FileKind,
    read: &ReadText<'_>,
    named: &Place,
    errors: &mut DescriptionErrors,
) -> Option<Node> {
    open(file, kind, read, named, &[], errors)
}

/// As [`document`], for a file that extends those of `chain`.
pub(super) fn open(
    file: &Path,
    kind: FileKind,
    read: &ReadText<'_>,
    named: &Place,
    chain: &[PathBuf],
    errors: &mut DescriptionErrors,
) -> Option<Node> {
    let tree = own_tree(file, read, named, errors)?;
    let chain = [chain, &[file.to_owned()]].concat();
    let tree = base::merge_over_base(tree, kind, read, &chain, errors)?;
    if let Some(other) = kind.actual_kind(&tree) {
        note_other_kind(file, kind, other, named, errors);
        return None;
    }
    Some(tree)
}

/// Returns the tree of a file without a base or other files, such as a data sheet. Its format is checked and removed.
pub(super) fn single(file: &Path, read: &ReadText<'_>, errors: &mut DescriptionErrors) -> Option<Node> {
    own_tree(file, read, &Place::file_head(file), errors)
}

/// Returns the tree of the file itself, without its base.
fn own_tree(file: &Path, read: &ReadText<'_>, named: &Place, errors: &mut DescriptionErrors) -> Option<Node> {
    let text = match read(file) {
        Ok(text) => text,
        Err(why) => {
            let (words, remedy) = match why.words.split_once("; ") {
                Some(known) => known,
                None if named.file() == file => (why.words.as_str(), "correct the path"),
                None => (why.words.as_str(), "correct the path, which is relative to the file that names it"),
            };
            errors.add(why.code, named, format!("cannot read \"{}\": {words}", file.display()), remedy);
            return None;
        }
    };
    own_tree_of(file, &text, errors)
}

/// Returns the tree of the text of a file, without its base.
pub(super) fn own_tree_of(file: &Path, text: &str, errors: &mut DescriptionErrors) -> Option<Node> {
    let before = errors.count();
    let mut tree = parse(&Arc::from(file), text, errors);
    if errors.count() > before {
        return None;
    }
    check_format(&mut tree, errors);
    Some(tree)
}

fn note_other_kind(file: &Path, kind: FileKind, other: FileKind, named: &Place, errors: &mut DescriptionErrors) {
    let subject = if named.file() == file { "this".to_owned() } else { format!("\"{}\"", file.display()) };
    let remedy = match (kind, other) {
        (FileKind::Job, FileKind::Scene | FileKind::Camera) => "give a job file that refers to it".to_owned(),
        _ => format!("give a {} file", kind.word()),
    };
    errors.add(ErrorCode::WrongFileKind, named, format!("{subject} is a {} file", other.word()), remedy);
}

/// Checks the format, which every file states; this program reads format 1.
fn check_format(tree: &mut Node, errors: &mut DescriptionErrors) {
    let head = tree.place.clone();
    match tree.as_table_mut().and_then(|t| t.remove("format")) {
        None => errors.add(
            ErrorCode::MissingKey,
            &head,
            "the key \"format\" is missing",
            "add \"format = 1\" at the start of the file",
        ),
        Some(entry) if !matches!(entry.node.value, Value::Whole(1)) => {
            let problem = format!("found format {}; this program reads format 1", entry.node.describe());
            errors.add(
                ErrorCode::UnknownFormat,
                &entry.node.place,
                problem,
                "write the file in format 1, or use a program that reads this format",
            );
        }
        Some(_) => {}
    }
}
