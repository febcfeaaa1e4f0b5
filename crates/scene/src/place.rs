//! Place of a value: file, line, column and key, or the override that set it.

use std::borrow::Cow;
use std::fmt;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

/// Place of a value or an error.
///
/// Displays as `file:line:column: key`, and as `--set key=value` or the flag as typed for a value given on the command line. A value set by a file of
/// changes has the line in that file and the key that it changes.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    file: Arc<Path>,
    spot: SourcePosition,
    key: Arc<str>,
    /// Index of a value in the list `key`, from 0. This allows the values of a long list to share one text.
    element: Option<u32>,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum SourcePosition {
    At {
        line: u32,
        column: u32,
    },
    Set(Arc<str>),
    Flag(Arc<str>),
    /// A change that another file states, with its place.
    Change(Arc<Place>),
    Unstated,
}

impl Place {
    /// Place of a value in no file: of a record that a program made.
    #[must_use]
    pub fn unstated() -> Self {
        static WITHOUT_SOURCE: LazyLock<Place> = LazyLock::new(|| Place {
            file: Arc::from(Path::new("")),
            spot: SourcePosition::Unstated,
            key: "".into(),
            element: None,
        });
        WITHOUT_SOURCE.clone()
    }

    /// True if a file or the command line states the value.
    #[must_use]
    pub fn has_source(&self) -> bool {
        self.spot != SourcePosition::Unstated
    }

    /// The first character of `file`.
    #[must_use]
    pub fn file_head(file: impl Into<Arc<Path>>) -> Self {
        Self { file: file.into(), spot: SourcePosition::At { line: 1, column: 1 }, key: "".into(), element: None }
    }

    /// Line and column (from 1, columns in characters) of `file`, at the dotted `key`.
    pub(crate) fn at(file: Arc<Path>, line: u32, column: u32, key: Arc<str>) -> Self {
        Self { file, spot: SourcePosition::At { line, column }, key, element: None }
    }

    /// The override `--set text`, which changes `key` of `file`.
    pub(crate) fn set(file: Arc<Path>, text: Arc<str>, key: Arc<str>) -> Self {
        Self { file, spot: SourcePosition::Set(text), key, element: None }
    }

    /// The flag of the command line, as typed, that changes `key` of `file`.
    pub(crate) fn flag(file: Arc<Path>, text: Arc<str>, key: Arc<str>) -> Self {
        Self { file, spot: SourcePosition::Flag(text), key, element: None }
    }

    /// A change of `key` of `file` that another file states at `by`.
    pub(crate) fn change(file: Arc<Path>, by: Arc<Place>, key: Arc<str>) -> Self {
        Self { file, spot: SourcePosition::Change(by), key, element: None }
    }

    /// The place of a value of the list at the key.
    pub(crate) fn with_element(self, index: u32) -> Self {
        Self { element: Some(index), ..self }
    }

    /// True if the command line states it, by an override, a flag or a file of changes.
    #[must_use]
    pub fn is_command_line(&self) -> bool {
        matches!(self.spot, SourcePosition::Set(_) | SourcePosition::Flag(_) | SourcePosition::Change(_))
    }

    /// The file the value belongs to (for an override: the file it changes).
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The file to which [`line_column`](Self::line_column) refers: the one that states the value.
    #[must_use]
    pub fn stating_file(&self) -> &Path {
        match &self.spot {
            SourcePosition::Change(by) => by.stating_file(),
            _ => &self.file,
        }
    }

    /// The dotted key; empty for the file as a whole. Named entries appear by name: `cameras.front.lens`.
    #[must_use]
    pub fn key(&self) -> Cow<'_, str> {
        match self.element {
            Some(element) => Cow::Owned(format!("{}[{element}]", self.key)),
            None => Cow::Borrowed(&self.key),
        }
    }

    /// Line and column, both from 1; `None` for an override and for values in no file.
    #[must_use]
    pub fn line_column(&self) -> Option<(u32, u32)> {
        match self.spot {
            SourcePosition::At { line, column } => Some((line, column)),
            SourcePosition::Change(ref by) => by.line_column(),
            SourcePosition::Set(_) | SourcePosition::Flag(_) | SourcePosition::Unstated => None,
        }
    }

    /// Resolves `path` at this place: relative to the file.
    #[must_use]
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(path)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.spot {
            SourcePosition::At { line, column } => write!(f, "{}:{line}:{column}", self.file.display())?,
            SourcePosition::Set(text) => return write_set(f, text),
            SourcePosition::Flag(text) => return f.write_str(text),
            SourcePosition::Change(by) => match by.line_column() {
                Some((line, column)) => write!(f, "{}:{line}:{column}", by.file().display())?,
                None => by.fmt(f)?,
            },
            SourcePosition::Unstated => return f.write_str("a value not stated by any file"),
        }
        let key = self.key();
        if key.is_empty() { Ok(()) } else { write!(f, ": {key}") }
    }
}

/// Writes the override as typed; of a long one the first 160 characters.
fn write_set(f: &mut fmt::Formatter<'_>, text: &str) -> fmt::Result {
    const MAX_SHOWN_LENGTH: usize = 160;
    match text.char_indices().nth(MAX_SHOWN_LENGTH) {
        None => write!(f, "`set` {text}"),
        Some((end, _)) => write!(f, "`set` {}…", &text[..end]),
    }
}

/// A value and its place. Equality ignores the place.
#[derive(Clone, Debug)]
pub struct Placed<T> {
    pub value: T,
    /// Place of the value.
    pub place: Place,
}

impl<T> Placed<T> {
    /// Creates `value` at `place`.
    #[must_use]
    pub fn new(value: T, place: Place) -> Self {
        Self { value, place }
    }

    /// Converts the value and keeps the place.
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Placed<U> {
        Placed { value: f(self.value), place: self.place }
    }
}

impl<T> From<T> for Placed<T> {
    /// A value in no file.
    fn from(value: T) -> Self {
        Self::new(value, Place::unstated())
    }
}

impl From<&str> for Placed<String> {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl From<&str> for Placed<PathBuf> {
    fn from(path: &str) -> Self {
        PathBuf::from(path).into()
    }
}

impl<T> Deref for Placed<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T: PartialEq> PartialEq for Placed<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<T: PartialEq> PartialEq<T> for Placed<T> {
    fn eq(&self, other: &T) -> bool {
        self.value == *other
    }
}
