//! The files that a description names, collected record by record.

use std::path::PathBuf;

use super::request::{AssetKind, AssetRequest, ReplacedMaterials};
use crate::place::Placed;

/// Requests for files, each once.
#[derive(Default)]
pub(crate) struct FileList(Vec<AssetRequest>);

/// A record that may name files.
pub(crate) trait NamesFiles {
    /// Requests every file that it names. Implementations destructure records without `..`, so that every new key is either requested or explicitly
    /// without files.
    fn name_files(&self, files: &mut FileList);
}

/// True if a record names files itself.
pub(crate) fn names_files(record: &impl NamesFiles) -> bool {
    let mut files = FileList::default();
    record.name_files(&mut files);
    !files.0.is_empty()
}

impl<T: NamesFiles> NamesFiles for Option<T> {
    fn name_files(&self, files: &mut FileList) {
        self.iter().for_each(|item| item.name_files(files));
    }
}

impl FileList {
    pub(crate) fn into_requests(self) -> Vec<AssetRequest> {
        self.0
    }

    /// Requests a file as a `kind`.
    pub(crate) fn add(&mut self, kind: AssetKind, path: &Placed<PathBuf>) {
        if !self.0.iter().any(|r| r.kind == kind && r.path == path.value) {
            let (path, place) = (path.value.clone(), path.place.clone());
            self.0.push(AssetRequest { path, kind, place, covered: ReplacedMaterials::NONE });
        }
    }

    /// Requests a mesh; materials count as covered only if all meshes of the file cover them.
    pub(crate) fn mesh(&mut self, path: &Placed<PathBuf>, covered: ReplacedMaterials) {
        let known = self.0.iter_mut().find(|r| r.kind == AssetKind::Mesh && r.path == path.value);
        if let Some(known) = known {
            known.covered = std::mem::replace(&mut known.covered, ReplacedMaterials::All).and(covered);
            return;
        }
        let (path, place) = (path.value.clone(), path.place.clone());
        self.0.push(AssetRequest { path, kind: AssetKind::Mesh, place, covered });
    }
}
