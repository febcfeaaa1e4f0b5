//! The text of old files: UTF-8 where it is, else Latin-1 (ISO 8859-1), which every byte is.

use std::borrow::Cow;
use std::path::Path;

use crate::Error;

/// The end-of-file character of DOS.
const DOS_END: char = '\u{1a}';

/// Decodes `bytes`.
pub(super) fn decode<'a>(file: &Path, bytes: &'a [u8]) -> Result<Cow<'a, str>, Error> {
    if let Some(at) = bytes.iter().position(|b| *b == 0) {
        let line = 1 + bytes[..at].iter().filter(|b| **b == b'\n').count();
        return Err(Error::at(file, line, "no text; expected a lamp file in ASCII, Latin-1 or UTF-8: save it as such"));
    }
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text.trim_end().trim_end_matches(DOS_END)),
        Err(_) => {
            Cow::Owned(bytes.iter().map(|b| char::from(*b)).collect::<String>().trim_end_matches(DOS_END).to_owned())
        }
    };
    // Carriage returns alone end the lines of old Macintosh files.
    Ok(if text.contains('\n') { text } else { Cow::Owned(text.replace('\r', "\n")) })
}
