//! What can be wrong with a file.
//!
//! Decoders of other authors: where one of them panics, the file is refused.
//!
//! Sizes are checked before anything is decoded; what is left are slips of a decoder over damaged data, which a user cannot tell from a damaged file. The
//! panic ends here. A program may keep its message back ([`is_decoding`]).

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::{cell::Cell, fmt, io::ErrorKind};

use etendue_scene::{ErrorCode, Place, Problem};

/// One fault of one file: where, what is wrong, what was expected and what to do, in one sentence.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Error {
    code: ErrorCode,
    file: PathBuf,
    line: Option<usize>,
    what: String,
    named_at: Option<String>,
    /// Of a description that names the file: where.
    place: Option<Box<Place>>,
    /// Whether the path is at fault, not what is in the file.
    is_path: bool,
}

impl Error {
    /// A fault of the whole file; words alone are about its content ([`ErrorCode::MalformedFile`]).
    #[must_use]
    pub fn new(file: &Path, what: impl Into<Problem>) -> Self {
        let Problem { code, words } = what.into();
        Self { code, file: file.to_path_buf(), line: None, what: words, named_at: None, place: None, is_path: false }
    }

    /// A fault of the whole file, with its code.
    #[must_use]
    pub fn coded(code: ErrorCode, file: &Path, what: impl Into<String>) -> Self {
        Self::new(file, Problem::new(code, what))
    }

    /// A fault in line `line`, counted from 1.
    #[must_use]
    pub fn at(file: &Path, line: usize, what: impl Into<Problem>) -> Self {
        Self { line: Some(line), ..Self::new(file, what) }
    }

    /// Returns an error of a path that cannot be used.
    #[must_use]
    pub fn missing(file: &Path, what: impl Into<String>) -> Self {
        Self { is_path: true, ..Self::coded(ErrorCode::MissingFile, file, what) }
    }

    /// The same fault with another code.
    #[must_use]
    pub fn with_code(self, code: ErrorCode) -> Self {
        Self { code, ..self }
    }

    /// The kind of the fault.
    #[must_use]
    pub fn code(&self) -> ErrorCode {
        self.code
    }

    /// The same fault with the place of the reference that led to the file.
    #[must_use]
    pub fn named_at(mut self, place: impl Into<String>) -> Self {
        self.named_at = Some(place.into());
        self
    }

    /// The same fault with the place of the key that names the file.
    #[must_use]
    pub fn named_by(self, place: &Place) -> Self {
        Self { place: Some(Box::new(place.clone())), ..self.named_at(place.to_string()) }
    }

    /// The key that names the file, where a description does.
    #[must_use]
    pub fn place(&self) -> Option<&Place> {
        self.place.as_deref()
    }

    /// Whether the path is at fault, not what is in the file.
    #[must_use]
    pub fn is_of_path(&self) -> bool {
        self.is_path
    }

    /// The file at fault.
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The line at fault, counted from 1, where one is.
    #[must_use]
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// What is wrong, without the place.
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
                write!(f, " (named at {place}; a path is relative to the file that names it)")
            }
            Some(place) => write!(f, " (named at {place})"),
            None => Ok(()),
        }
    }
}

/// The code of an error of the system about a file that is read.
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

/// Whether this thread is within a decoder whose panics become errors: what a panic hook asks before it prints.
#[must_use]
pub fn is_decoding() -> bool {
    DECODING.get()
}

/// What `decode` makes of the bytes of `file`; an error where it panics.
pub fn guarded<T>(file: &Path, decode: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    let was = DECODING.replace(true);
    let decoded = catch_unwind(AssertUnwindSafe(decode));
    DECODING.set(was);
    decoded.unwrap_or_else(|_| {
        Err(Error::new(
            file,
            "damaged: its data cannot be decoded; make or fetch it again, or store it in another format",
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_within_is_an_error_of_the_file() {
        // The hook is that of all tests of the process: this one prints.
        let told = guarded::<()>(Path::new("a.exr"), || panic!("within a decoder")).expect_err("refused").to_string();
        assert!(told.starts_with("a.exr: damaged: "), "{told}");
        assert!(!is_decoding());
        assert_eq!(guarded(Path::new("a.exr"), || Ok(is_decoding())), Ok(true));
    }
}
