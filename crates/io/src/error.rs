//! Errors of files.
//!
//! Third-party decoders: if one panics, the file is refused. Sizes are checked before decoding; what remains are decoder bugs on damaged data, which a user
//! cannot distinguish from a damaged file. The panic is caught here. A program may suppress its message ([`is_decoding`]).

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::{cell::Cell, fmt, io::ErrorKind};

use etendue_scene::{ErrorCode, Place, Problem};

/// Error of one file: place, cause, expected form and remedy, in one sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Error {
    code: ErrorCode,
    file: PathBuf,
    line: Option<usize>,
    what: String,
    named_at: Option<String>,
    /// Place in the description that names the file.
    place: Option<Box<Place>>,
    /// True if the path is at fault, not the content of the file.
    is_path: bool,
}

impl Error {
    /// Returns an error of the whole file; plain text is about its content ([`ErrorCode::MalformedFile`]).
    #[must_use]
    pub fn new(file: &Path, what: impl Into<Problem>) -> Self {
        let Problem { code, words } = what.into();
        Self { code, file: file.to_path_buf(), line: None, what: words, named_at: None, place: None, is_path: false }
    }

    /// Returns an error of the whole file, with its code.
    #[must_use]
    pub fn coded(code: ErrorCode, file: &Path, what: impl Into<String>) -> Self {
        Self::new(file, Problem::new(code, what))
    }

    /// Returns an error in line `line`, counted from 1.
    #[must_use]
    pub fn at(file: &Path, line: usize, what: impl Into<Problem>) -> Self {
        Self { line: Some(line), ..Self::new(file, what) }
    }

    /// Returns an error of a path that cannot be used.
    #[must_use]
    pub fn missing(file: &Path, what: impl Into<String>) -> Self {
        Self { is_path: true, ..Self::coded(ErrorCode::MissingFile, file, what) }
    }

    /// Returns the same error with another code.
    #[must_use]
    pub fn with_code(self, code: ErrorCode) -> Self {
        Self { code, ..self }
    }

    /// Error code.
    #[must_use]
    pub fn code(&self) -> ErrorCode {
        self.code
    }

    /// Returns the same error with the place of the reference to the file.
    #[must_use]
    pub fn named_at(mut self, place: impl Into<String>) -> Self {
        self.named_at = Some(place.into());
        self
    }

    /// Returns the same error with the place of the key that names the file.
    #[must_use]
    pub fn named_by(self, place: &Place) -> Self {
        Self { place: Some(Box::new(place.clone())), ..self.named_at(place.to_string()) }
    }

    /// Key that names the file, if a description does.
    #[must_use]
    pub fn place(&self) -> Option<&Place> {
        self.place.as_deref()
    }

    /// Returns true if the path is at fault, not the content of the file.
    #[must_use]
    pub fn is_path_error(&self) -> bool {
        self.is_path
    }

    /// File of the error.
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Line of the error, counted from 1, if there is one.
    #[must_use]
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// Problem, without the place.
    #[must_use]
    pub fn what(&self) -> &str {
        &self.what
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.what)?;
        match &self.named_at {
            Some(place) if self.is_path => {
                write!(f, " (referenced at {place}; a path is relative to the file that names it)")
            }
            Some(place) => write!(f, " (referenced at {place})"),
            None => Ok(()),
        }
    }
}

/// Code of a system error while a file is read.
pub(crate) fn code_of(cause: &std::io::Error) -> ErrorCode {
    match cause.kind() {
        ErrorKind::NotFound => ErrorCode::MissingFile,
        ErrorKind::FileTooLarge => ErrorCode::TooLarge,
        _ => ErrorCode::UnreadableFile,
    }
}

thread_local! {
    static DECODING: Cell<bool> = const { Cell::new(false) };
}

/// Returns true if this thread is within a decoder whose panics become errors. A panic hook checks it before it prints.
#[must_use]
pub fn is_decoding() -> bool {
    DECODING.get()
}

/// Result of `decode` on the bytes of `file`; an error if it panics.
pub fn guarded<T>(file: &Path, decode: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    let was = DECODING.replace(true);
    let decoded = catch_unwind(AssertUnwindSafe(decode));
    DECODING.set(was);
    decoded.unwrap_or_else(|_| {
        Err(Error::new(
            file,
            "damaged: its data cannot be decoded; create or download it again, or store it in another format",
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_within_is_an_error_of_the_file() {
        // The hook is shared by all tests of the process: this one prints.
        let message =
            guarded::<()>(Path::new("a.exr"), || panic!("within a decoder")).expect_err("refused").to_string();
        assert!(message.starts_with("a.exr: damaged: "), "{message}");
        assert!(!is_decoding());
        assert_eq!(guarded(Path::new("a.exr"), || Ok(is_decoding())), Ok(true));
    }
}
