//! Reading a whole file, with an error that says what to do.

use std::io::ErrorKind;
use std::path::Path;

use crate::Error;

/// The bytes of `file`; `what` names in words what it should be ("mesh", "texture").
pub(crate) fn read_bytes(file: &Path, what: &str) -> Result<Vec<u8>, Error> {
    let bytes = std::fs::read(file).map_err(|cause| match cause.kind() {
        ErrorKind::NotFound => Error::missing(file, format!("no such {what} file; check the path")),
        ErrorKind::IsADirectory => Error::missing(file, "this is a folder; name a file in it"),
        ErrorKind::PermissionDenied => Error::new(file, format!("this {what} file may not be read: permission denied")),
        _ => Error::new(file, format!("this {what} file cannot be read: {cause}")),
    })?;
    if bytes.is_empty() {
        return Err(Error::new(file, format!("this {what} file is empty")));
    }
    Ok(bytes)
}

/// The text of `file`, UTF-8 (a byte-order mark is passed over).
pub(crate) fn decode_text<'a>(file: &Path, bytes: &'a [u8]) -> Result<&'a str, Error> {
    let text = std::str::from_utf8(bytes).map_err(|cause| {
        let line = 1 + bytes[..cause.valid_up_to()].iter().filter(|&&b| b == b'\n').count();
        Error::at(file, line, "not UTF-8 text; save the file as UTF-8")
    })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}
