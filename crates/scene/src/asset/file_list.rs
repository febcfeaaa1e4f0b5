//! The files that a description names, gathered record by record.

use std::path::PathBuf;

use super::request::{AssetKind, AssetRequest, Covered};
use crate::place::Placed;

/// Requests for files, each once.
#[derive(Default)]
pub(crate) struct FileList(Vec<AssetRequest>);

/// What may name files of its own.
pub(crate) trait NamesFiles {
    /// Requests every file that it names. Implementations take records apart without `..`, so that a key that is added is either
    /// asked for its files or said to have none.
    fn name_files(&self, files: &mut FileList);
}

/// Whether a record names files itself.
pub(crate) fn names_files(record: &impl NamesFiles) -> bool {
    let mut files = FileList::default();
    record.name_files(&mut files);
    !files.0.is_empty()
}

impl<T: NamesFiles> NamesFiles for Option<T> {
    fn name_files(&self, files: &mut FileList) {
        self.iter().for_each(|given| given.name_files(files));
    }
}

impl FileList {
    pub(crate) fn into_requests(self) -> Vec<AssetRequest> {
        self.0
    }

    /// A file to be read as a `kind`.
    pub(crate) fn add(&mut self, kind: AssetKind, path: &Placed<PathBuf>) {
        if !self.0.iter().any(|r| r.kind == kind && r.path == path.value) {
            let (path, place) = (path.value.clone(), path.place.clone());
            self.0.push(AssetRequest { path, kind, place, covered: Covered::NONE });
        }
    }

    /// A mesh; of a file that several meshes name, what all cover.
    pub(crate) fn mesh(&mut self, path: &Placed<PathBuf>, covered: Covered) {
        let known = self.0.iter_mut().find(|r| r.kind == AssetKind::Mesh && r.path == path.value);
        if let Some(known) = known {
            known.covered = std::mem::replace(&mut known.covered, Covered::All).and(covered);
            return;
        }
        let (path, place) = (path.value.clone(), path.place.clone());
        self.0.push(AssetRequest { path, kind: AssetKind::Mesh, place, covered });
    }
}
