//! Arrows between the folders of a crate: each folder's own files and folders as nodes, with the arrows of all files within them.

use std::collections::BTreeMap;

use super::house::ImportedNames;

/// The arrows between the direct children of every folder, by the folder: a child is a file or a folder with all that is in it (`x.rs` and `x/` are one),
/// and a name is that which a file of one child takes from a file of the other.
pub(crate) fn arrows_by_folder(arrows: &ImportedNames) -> BTreeMap<String, ImportedNames> {
    let mut folders: BTreeMap<String, ImportedNames> = BTreeMap::new();
    for (from, to) in arrows {
        for (to, names) in to {
            let Some(step) = Step::between(from, to) else { continue };
            let children = folders.entry(step.folder).or_default();
            let from = children.entry(step.from).or_default();
            from.entry(step.to).or_default().extend(names.iter().cloned());
        }
    }
    folders
}

/// The children of one folder that an arrow between two files joins.
struct Step {
    folder: String,
    from: String,
    to: String,
}

impl Step {
    /// Returns the step in the innermost folder that holds both files; `None` if both are in the same child of it.
    fn between(from: &str, to: &str) -> Option<Self> {
        let mut folder = String::new();
        let (mut from, mut to) = (from.split('/'), to.split('/'));
        loop {
            let (from, to) = (child(from.next()?), child(to.next()?));
            if from != to {
                return Some(Self { folder, from: from.to_owned(), to: to.to_owned() });
            }
            folder.push_str(from);
            folder.push('/');
        }
    }
}

/// The name of a file or folder as a child: the file beside a folder is one with it.
fn child(name: &str) -> &str {
    name.trim_end_matches(".rs")
}
