//! Buffers, and other resources that a file names by URI.

use std::path::{Path, PathBuf};

use gltf::{json::Root, json::buffer::View};

use super::compression;
use crate::named_file::{NamedFile, find_named_file};
use crate::{ErrorCode, Problem, Sandbox, source::read_bytes};

/// The bytes of all buffers.
pub(super) struct Buffers {
    all: Vec<Vec<u8>>,
    /// True for those that are separate files.
    is_external: Vec<bool>,
    /// True for fallbacks of compressed data that the file omits.
    is_omitted: Vec<bool>,
    /// Differences between URIs and files.
    pub(super) notes: Vec<String>,
}

impl Buffers {
    pub(super) fn read(file: &Path, root: &Root, blob: Option<Vec<u8>>, sandbox: &Sandbox) -> Result<Self, Problem> {
        let (mut all, mut is_external, mut is_omitted) = (Vec::new(), Vec::new(), Vec::new());
        let (mut notes, mut blob) = (Vec::new(), blob);
        for (i, buffer) in root.buffers.iter().enumerate() {
            let omitted = buffer.uri.is_none() && compression::is_fallback(buffer);
            let embedded = |bytes| LinkedBytes { bytes, path: None, note: None };
            let LinkedBytes { bytes, path, note } = match &buffer.uri {
                None if omitted => embedded(Vec::new()),
                None if i == 0 => {
                    embedded(blob.take().ok_or("buffer 0 has no \"uri\", and the file has no binary chunk")?)
                }
                None => return Err(format!("buffer {i} has no \"uri\"").into()),
                Some(uri) => linked(file, uri, &format!("buffer {i}"), sandbox)?,
            };
            let stated = buffer.byte_length.0;
            if !omitted && (bytes.len() as u64) < stated {
                let has = bytes.len();
                return Err(format!(
                    "buffer {i} has {has} bytes, but {stated} are stated: it is truncated; export or copy it again"
                )
                .into());
            }
            all.push(bytes);
            is_external.push(path.is_some());
            is_omitted.push(omitted);
            notes.extend(note);
        }
        Ok(Self { all, is_external, is_omitted, notes })
    }

    /// The bytes of a view.
    pub(super) fn view(&self, view: &View) -> Result<&[u8], Problem> {
        let buffer = self.all.get(view.buffer.value()).ok_or("a view of a buffer that does not exist")?;
        if self.is_omitted.get(view.buffer.value()) == Some(&true) {
            return Err(compression::MESHOPT.refusal("a view").into());
        }
        let start = view.byte_offset.unwrap_or_default().0;
        let range = start
            .checked_add(view.byte_length.0)
            .and_then(|end| Some(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        range.and_then(|range| buffer.get(range)).ok_or_else(|| {
            format!(
                "a view that extends beyond its buffer {} of {} bytes; export the file again",
                view.buffer.value(),
                buffer.len()
            )
            .into()
        })
    }

    /// Bytes of the buffers that are separate files.
    pub(super) fn external_bytes(&self) -> impl Iterator<Item = &[u8]> {
        self.all.iter().zip(&self.is_external).filter(|(_, external)| **external).map(|(bytes, _)| bytes.as_slice())
    }
}

/// Content of a URI.
pub(super) struct LinkedBytes {
    pub(super) bytes: Vec<u8>,
    /// The file; `None` for a data URI.
    pub(super) path: Option<PathBuf>,
    /// Difference between the URI and the file.
    pub(super) note: Option<String>,
}

/// Content of a URI. A missing file is also searched for by its last name components next to the glTF file.
pub(super) fn linked(file: &Path, uri: &str, what: &str, sandbox: &Sandbox) -> Result<LinkedBytes, Problem> {
    if let Some(bytes) = data_uri(uri) {
        let bytes = bytes.map_err(|problem| format!("{what}: {problem}"))?;
        return Ok(LinkedBytes { bytes, path: None, note: None });
    }
    let NamedFile { path, note, .. } = find(file, uri, what, sandbox)?;
    let bytes = read_bytes(&path, what).map_err(|error| Problem::new(error.code(), format!("{what}: {error}")))?;
    Ok(LinkedBytes { bytes, path: Some(path), note: note.map(|note| format!("{what}: {note}")) })
}

fn find(file: &Path, uri: &str, what: &str, sandbox: &Sandbox) -> Result<NamedFile, Problem> {
    let name = unescaped(uri);
    if name.contains("://") && !name.starts_with("file://") {
        return Err(
            format!("{what} is on a network (`{uri}`), which is not supported; save it next to the file").into()
        );
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    let named_file =
        find_named_file(&[folder], &name, sandbox).map_err(|problem| problem.within(format_args!("{what} `{uri}`")))?;
    if named_file.exists {
        return Ok(named_file);
    }
    let stated_path = named_file.path.display();
    let sibling = Path::new(&name).file_name().map(|name| folder.join(name));
    let words = match sibling.filter(|sibling| *sibling != named_file.path) {
        None => format!("{what} does not exist: no {stated_path}; add this file"),
        Some(sibling) => {
            format!("{what} does not exist: neither {stated_path} nor {}; add one of these files", sibling.display())
        }
    };
    Err(Problem::new(ErrorCode::MissingFile, words))
}

/// Bytes of a data URI; `None` if it is none, an error text if it is damaged.
fn data_uri(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let (head, body) = uri.strip_prefix("data:")?.split_once(',').unwrap_or(("", ""));
    if head.ends_with(";base64") {
        return Some(decode(body).ok_or_else(|| "the data URI is not valid base64".to_owned()));
    }
    Some(Err("the data URI is not in base64; export it as base64 or as a file".to_owned()))
}

fn decode(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut bits = 0_u32;
        for character in group {
            bits = bits << 6 | value(*character)?;
        }
        match group.len() {
            4 => bytes.extend_from_slice(&bits.to_be_bytes()[1..]),
            3 => bytes.extend_from_slice(&(bits >> 2).to_be_bytes()[2..]),
            2 => bytes.push((bits >> 4) as u8),
            _ => return None,
        }
    }
    Some(bytes)
}

fn value(character: u8) -> Option<u32> {
    let value = match character {
        b'A'..=b'Z' => character - b'A',
        b'a'..=b'z' => character - b'a' + 26,
        b'0'..=b'9' => character - b'0' + 52,
        b'+' | b'-' => 62,
        b'/' | b'_' => 63,
        _ => return None,
    };
    Some(value.into())
}

/// Relative reference with `%20` and the like decoded; unchanged if they do not decode.
pub(super) fn unescaped(uri: &str) -> String {
    let (mut bytes, mut rest) = (Vec::with_capacity(uri.len()), uri.as_bytes());
    while let Some((first, tail)) = rest.split_first() {
        let hex = tail.get(..2).and_then(|h| std::str::from_utf8(h).ok()).and_then(|h| u8::from_str_radix(h, 16).ok());
        match (first, hex) {
            (b'%', Some(byte)) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            _ => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|_| uri.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vectors_of_rfc_4648() {
        let vectors =
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg==", "foob"), ("Zm9vYmFy", "foobar")];
        for (text, bytes) in vectors {
            let uri = format!("data:application/octet-stream;base64,{text}");
            assert_eq!(data_uri(&uri), Some(Ok(bytes.as_bytes().to_vec())), "{text}");
        }
        assert!(
            data_uri("data:;base64,Z").is_some_and(|r| r.is_err())
                && data_uri("data:;base64,Zg!=").is_some_and(|r| r.is_err())
        );
        assert!(data_uri("data:text/plain,abc").is_some_and(|r| r.is_err()));
        assert_eq!(data_uri("data.bin"), None);
    }

    #[test]
    fn names_are_unescaped() {
        assert_eq!(unescaped("my%20wall%C3%A9.png"), "my wallé.png");
        assert_eq!(unescaped("50%.png"), "50%.png");
    }
}
