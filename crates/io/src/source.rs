//! Reading of whole files, with errors that state a remedy.

use std::io::{ErrorKind, Read as _};
use std::{borrow::Cow, fs::File, path::Path};

use etendue_scene::limits::{self, DESCRIPTION, Limit};

use crate::{Error, ErrorCode, Problem, error::code_of, failure};

/// Reads the bytes of `file`; `what` is its expected kind in words ("mesh", "texture").
pub fn read_bytes(file: &Path, what: &str) -> Result<Vec<u8>, Error> {
    read_bytes_within(file, what, &limits::FILE)
}

/// Reads the bytes of a description file. Such a file (value tree, lens, lamp) may take much more memory than its length, so its limit is lower.
pub fn read_description_bytes(file: &Path, what: &str) -> Result<Vec<u8>, Error> {
    read_bytes_within(file, what, &limits::DESCRIPTION)
}

/// Reads the bytes of a file of our own with at most `most` bytes, whatever the general limit.
pub(crate) fn read_expected_bytes(file: &Path, what: &str, max: u64) -> Result<Vec<u8>, Error> {
    let check = |bytes: u64| match bytes <= max {
        true => Ok(()),
        false => Err(format!("the file has {bytes} bytes; expected at most {max}: render it again").into()),
    };
    explained(file, what, read_checked(file, max, check))
}

/// Error of a pointer of Git LFS.
const LFS_POINTER: &str =
    "a pointer of Git LFS, not the file itself; fetch the file in its repository with `git lfs pull`";

/// Returns true for the text that Git LFS stores in place of a large file (git-lfs specification, version 1).
fn is_lfs_pointer(bytes: &[u8]) -> bool {
    const MAX_BYTES: usize = 1024;
    bytes.len() <= MAX_BYTES
        && [&b"version https://git-lfs.github.com/spec/"[..], b"version https://hawser.github.com/spec/"]
            .iter()
            .any(|begin| bytes.starts_with(begin))
}

fn read_bytes_within(file: &Path, what: &str, limit: &Limit) -> Result<Vec<u8>, Error> {
    explained(file, what, read_regular(file, limit))
}

fn explained(file: &Path, what: &str, read: std::io::Result<Vec<u8>>) -> Result<Vec<u8>, Error> {
    let bytes = read.map_err(|cause| match cause.kind() {
        ErrorKind::NotFound => Error::missing(file, format!("no such {what} file; check the path")),
        ErrorKind::IsADirectory => {
            Error::missing(file, "this is a folder; give a file in it").with_code(ErrorCode::UnreadableFile)
        }
        ErrorKind::InvalidInput | ErrorKind::FileTooLarge => Error::coded(code_of(&cause), file, cause.to_string()),
        ErrorKind::PermissionDenied => {
            Error::coded(ErrorCode::UnreadableFile, file, format!("this {what} file cannot be read: permission denied"))
        }
        _ => Error::coded(ErrorCode::UnreadableFile, file, format!("this {what} file cannot be read: {cause}")),
    })?;
    if bytes.is_empty() {
        return Err(Error::coded(ErrorCode::Empty, file, format!("this {what} file is empty")));
    }
    if is_lfs_pointer(&bytes) {
        return Err(Error::coded(ErrorCode::UnsupportedFile, file, LFS_POINTER));
    }
    Ok(bytes)
}

/// Reads all bytes of a regular file. Pipes, devices and sockets may never end, or block for ever, and cannot be read twice: they are refused before they are
/// opened, `/dev/stdin` too unless a regular file is redirected to it.
///
/// # Errors
/// As reading a file. If it is no regular file: kind [`ErrorKind::InvalidInput`] with a text for the user. If it is larger than its limit: kind
/// [`ErrorKind::FileTooLarge`] with a text for the user.
pub fn read_regular(file: &Path, limit: &Limit) -> std::io::Result<Vec<u8>> {
    read_checked(file, limit.max_bytes(), |bytes| limit.check_size(bytes))
}

fn read_checked(file: &Path, max: u64, check_size: impl Fn(u64) -> Result<(), Problem>) -> std::io::Result<Vec<u8>> {
    let metadata = std::fs::metadata(file)?;
    let kind = metadata.file_type();
    if !kind.is_file() && !kind.is_dir() {
        let message = format!("this is {}, not a regular file; save its content as a file and give that", word(kind));
        return Err(std::io::Error::new(ErrorKind::InvalidInput, message));
    }
    let too_large = |message: Problem| std::io::Error::new(ErrorKind::FileTooLarge, message.words);
    check_size(metadata.len()).map_err(too_large)?;
    // A file of /proc has no size, and a file may grow.
    let mut bytes = Vec::with_capacity(metadata.len() as usize + 1);
    File::open(file)?.take(max.saturating_add(1)).read_to_end(&mut bytes)?;
    check_size(bytes.len() as u64).map_err(too_large)?;
    Ok(bytes)
}

#[cfg(unix)]
fn word(kind: std::fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    match kind {
        k if k.is_fifo() => "a pipe",
        k if k.is_socket() => "a socket",
        _ => "a device",
    }
}

#[cfg(not(unix))]
fn word(_: std::fs::FileType) -> &'static str {
    "a device"
}

/// Text of `file`, UTF-8 (a byte-order mark is ignored).
pub fn decode_text<'a>(file: &Path, bytes: &'a [u8]) -> Result<&'a str, Error> {
    let text = std::str::from_utf8(bytes).map_err(|cause| {
        let line = 1 + bytes[..cause.valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        Error::at(file, line, "not UTF-8 text; save the file as UTF-8")
    })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// Text of a lens program's file: UTF-16 with a byte-order mark (either order), UTF-8, or Latin-1 otherwise.
pub(crate) fn decode_lens_text<'a>(file: &Path, bytes: &'a [u8]) -> Result<Cow<'a, str>, Error> {
    let wide = |unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]])).collect();
        let text = String::from_utf16(&units);
        text.map(Cow::Owned)
            .map_err(|_| Error::new(file, "begins as UTF-16 text, but is not valid UTF-16; save the file as UTF-8"))
    };
    match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => Ok(match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text.trim_start_matches('\u{feff}')),
            Err(_) => Cow::Owned(bytes.iter().map(|&byte| char::from(byte)).collect()),
        }),
    }
}

/// Prefixes notes on a file with its name.
pub(crate) fn name_notes<'n>(file: &Path, notes: impl IntoIterator<Item = &'n mut String>) {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    notes.into_iter().for_each(|note| note.insert_str(0, &format!("{name}: ")));
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// Reading either would never end.
    #[test]
    fn what_is_no_regular_file_is_refused_unopened() {
        let place = tempfile::tempdir().expect("temporary folder");
        let pipe = place.path().join("pipe.obj");
        let created = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
        assert!(created.success());
        let message = read_bytes(&pipe, "mesh").expect_err("a pipe").to_string();
        assert!(
            message.ends_with("pipe.obj: this is a pipe, not a regular file; save its content as a file and give that"),
            "{message}"
        );
        let message = read_bytes(Path::new("/dev/zero"), "mesh").expect_err("a device").to_string();
        assert!(message.starts_with("/dev/zero: this is a device, not a regular file"), "{message}");
        let link = place.path().join("link.obj");
        std::os::unix::fs::symlink(&pipe, &link).expect("link");
        assert!(read_bytes(&link, "mesh").is_err(), "a link to one is one");
        std::fs::write(place.path().join("a.obj"), b"x").expect("write");
        assert_eq!(read_bytes(&place.path().join("a.obj"), "mesh").expect("a file"), b"x");
    }
}

/// Reads a description as text; the error states the reason in a few words.
///
/// # Errors
/// There is no such file, it is a folder, it is longer than a description may be, or it is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, Problem> {
    let words = |error: &std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        std::io::ErrorKind::IsADirectory => "it is a folder; name a file in it".to_owned(),
        _ => error.to_string(),
    };
    let bytes = read_regular(path, &DESCRIPTION).map_err(|error| Problem::new(code_of(&error), words(&error)))?;
    if is_lfs_pointer(&bytes) {
        return Err(Problem::new(ErrorCode::UnsupportedFile, LFS_POINTER));
    }
    String::from_utf8(bytes).map_err(|_| "it is no text (UTF-8)".into())
}

/// Reads a description that the caller names; the error begins with its path.
///
/// # Errors
/// As [`read_text`].
pub fn text_of(path: &Path) -> Result<String, failure::Error> {
    read_text(path).map_err(|why| failure::Error::input(why.within(path.display())))
}
