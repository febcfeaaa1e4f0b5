//! Buffers, and what else a file names by URI.

use crate::{ErrorCode, Problem};
use std::path::{Path, PathBuf};

use gltf::json::Root;
use gltf::json::buffer::View;

use super::base64::{data_uri, unescaped};
use crate::Sandbox;
use crate::source::read_bytes;

/// The bytes of all buffers.
pub(super) struct Buffers {
    all: Vec<Vec<u8>>,
    /// Which of them are files of their own.
    is_external: Vec<bool>,
}

impl Buffers {
    pub(super) fn read(file: &Path, root: &Root, blob: Option<Vec<u8>>, sandbox: &Sandbox) -> Result<Self, Problem> {
        let (mut all, mut is_external, mut blob) = (Vec::new(), Vec::new(), blob);
        for (i, buffer) in root.buffers.iter().enumerate() {
            let (bytes, external) = match &buffer.uri {
                None if i == 0 => {
                    (blob.take().ok_or("its buffer 0 has no \"uri\" and there is no binary chunk")?, false)
                }
                None => return Err(format!("its buffer {i} has no \"uri\"").into()),
                Some(uri) => linked(file, uri, &format!("buffer {i}"), sandbox)?,
            };
            let stated = buffer.byte_length.0;
            if (bytes.len() as u64) < stated {
                let has = bytes.len();
                return Err(format!(
                    "its buffer {i} has {has} bytes, where {stated} are stated: it is truncated; export or copy it again"
                ).into());
            }
            all.push(bytes);
            is_external.push(external);
        }
        Ok(Self { all, is_external })
    }

    /// The bytes of a view.
    pub(super) fn view(&self, view: &View) -> Result<&[u8], Problem> {
        let buffer = self.all.get(view.buffer.value()).ok_or("a view of a buffer that is not there")?;
        let start = view.byte_offset.unwrap_or_default().0;
        let range = start
            .checked_add(view.byte_length.0)
            .and_then(|end| Some(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        range.and_then(|range| buffer.get(range)).ok_or_else(|| {
            format!(
                "a view reaches beyond its buffer {} of {} bytes; export it again",
                view.buffer.value(),
                buffer.len()
            )
            .into()
        })
    }

    /// Those that are files of their own.
    pub(super) fn external_bytes(&self) -> impl Iterator<Item = &[u8]> {
        self.all.iter().zip(&self.is_external).filter(|(_, external)| **external).map(|(bytes, _)| bytes.as_slice())
    }
}

/// The bytes of a URI, and whether it is a file. A file that is not where it is said to be is looked for by its last name beside the glTF file.
pub(super) fn linked(file: &Path, uri: &str, what: &str, sandbox: &Sandbox) -> Result<(Vec<u8>, bool), Problem> {
    if let Some(bytes) = data_uri(uri) {
        return bytes.map(|bytes| (bytes, false)).map_err(|told| format!("its {what}: {told}").into());
    }
    let path = find(file, uri, what, sandbox)?;
    read_bytes(&path, what)
        .map(|bytes| (bytes, true))
        .map_err(|error| Problem::new(error.code(), format!("its {what}: {error}")))
}

fn find(file: &Path, uri: &str, what: &str, sandbox: &Sandbox) -> Result<PathBuf, Problem> {
    let name = unescaped(uri);
    if name.contains("://") {
        return Err(
            format!("its {what} is on a network (`{uri}`), where nothing is read; save it beside the file").into()
        );
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    let stated = folder.join(&name);
    let beside = Path::new(&name).file_name().map(|name| folder.join(name));
    for path in [Some(&stated), beside.as_ref()].into_iter().flatten() {
        sandbox.check(path).map_err(|problem| problem.within(format_args!("its {what} `{uri}`")))?;
        if path.exists() {
            return Ok(path.clone());
        }
    }
    let stated_path = stated.display();
    let words = match beside.filter(|b| *b != stated) {
        None => format!("its {what} is not there: no {stated_path}; put it there"),
        Some(beside) => {
            format!("its {what} is not there: neither {stated_path}, nor {}; put it there", beside.display())
        }
    };
    Err(Problem::new(ErrorCode::MissingFile, words))
}
