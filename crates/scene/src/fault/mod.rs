//! Errors of a description: all of them are collected before any is reported.

use std::fmt::{self, Write as _};

use crate::place::{Place, Placed};

mod catalogue;
mod code;

pub use catalogue::{ErrorCode, Problem};
pub use code::{Example, ExampleContext, Explanation};

/// One error: its place, the problem with the expected value, and the remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DescriptionError {
    /// Its kind.
    pub code: ErrorCode,
    /// Place of the error.
    pub place: Place,
    /// The problem, and the expected value.
    pub problem: String,
    /// Remedy; empty if the problem's own words give it.
    pub remedy: String,
}

impl DescriptionError {
    /// Creates an error at `place`.
    #[must_use]
    pub fn new(code: ErrorCode, place: &Place, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { code, place: place.clone(), problem: problem.into(), remedy: remedy.into() }
    }
}

impl NameKind {
    /// Description of its kind.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Mesh => "mesh",
            Self::Texture => "texture",
            Self::Material => "material",
            Self::Class => "class",
            Self::Frame => "frame",
        }
    }
}

/// Displays on one line: names and texts of a file may hold line breaks and control sequences of terminals, which are escaped.
impl fmt::Display for DescriptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let message = format!("{}: {}", self.place, self.problem);
        let remedy = if self.remedy.is_empty() { String::new() } else { format!("; {}", self.remedy) };
        message.chars().chain(remedy.chars()).try_for_each(|c| match c.is_control() {
            true => write!(f, "{}", c.escape_default()),
            false => f.write_char(c),
        })
    }
}

/// All errors of a description, by file and line. Displays one per line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct DescriptionErrors {
    list: Vec<DescriptionError>,
    /// Names that were used while reading and must be defined.
    uses: Vec<(NameKind, Placed<String>)>,
    overridden: Vec<OverriddenKey>,
}

/// The problem of a table without a key.
fn missing(key: &str) -> String {
    format!("the key \"{key}\" is missing")
}

/// A key of a file that the command line makes meaningless.
#[derive(Clone, Debug, PartialEq)]
struct OverriddenKey {
    by: Place,
    key: String,
    place: Place,
}

/// Kinds of names that are used elsewhere in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum NameKind {
    Mesh,
    Texture,
    Material,
    Class,
    Frame,
}

impl DescriptionErrors {
    /// Creates an empty list.
    #[must_use]
    pub fn none() -> Self {
        Self { list: Vec::new(), uses: Vec::new(), overridden: Vec::new() }
    }

    /// The errors, by file and line.
    #[must_use]
    pub fn as_slice(&self) -> &[DescriptionError] {
        &self.list
    }

    /// Reports that a key of the table at `place` is missing.
    pub(crate) fn add_missing(&mut self, place: &Place, key: &str, remedy: impl Into<String>) {
        self.add(ErrorCode::MissingKey, place, missing(key), remedy);
    }

    /// Removes the error of a missing key of the table at `place`, because another key is taken as its misspelling.
    pub(crate) fn remove_missing(&mut self, place: &Place, key: &str) {
        let problem = missing(key);
        self.list.retain(|error| error.place != *place || error.problem != problem);
    }

    /// Reports an error.
    pub fn add(&mut self, code: ErrorCode, place: &Place, problem: impl Into<String>, remedy: impl Into<String>) {
        self.list.push(DescriptionError::new(code, place, problem, remedy));
    }

    /// Reports that `key`, at `place`, has no effect because of `cause`. It is no error if the command line states the cause and a file the key: the
    /// command line overrides the file.
    pub(crate) fn add_without_effect(
        &mut self,
        code: ErrorCode,
        key: &str,
        place: &Place,
        cause: Option<&Place>,
        problem: String,
        remedy: &str,
    ) {
        match cause {
            Some(by) if by.is_command_line() && !place.is_command_line() => {
                let superseded = OverriddenKey { by: by.clone(), key: key.to_owned(), place: place.clone() };
                if !self.overridden.contains(&superseded) {
                    self.overridden.push(superseded);
                }
            }
            _ => self.add(code, place, problem, remedy),
        }
    }

    /// Keys overridden by the command line, one sentence for each of its words.
    pub(crate) fn notices(&self) -> Vec<String> {
        let mut causes: Vec<&Place> = Vec::new();
        for OverriddenKey { by, .. } in &self.overridden {
            if !causes.contains(&by) {
                causes.push(by);
            }
        }
        causes.into_iter().map(|by| self.overridden_keys(by)).collect()
    }

    fn overridden_keys(&self, by: &Place) -> String {
        let keys = self.overridden.iter().filter(|s| s.by == *by).map(|s| key_with_place(&s.key, &s.place));
        format!("{by} overrides {}", keys.collect::<Vec<_>>().join(", "))
    }

    /// Records the use of a name.
    pub(crate) fn record_use(&mut self, named: NameKind, name: Placed<String>) {
        self.uses.push((named, name));
    }

    /// Returns and removes the names that were used.
    pub(crate) fn take_uses(&mut self) -> Vec<(NameKind, Placed<String>)> {
        std::mem::take(&mut self.uses)
    }

    /// Number of errors.
    #[must_use]
    pub fn count(&self) -> usize {
        self.list.len()
    }

    /// Returns `value` if there are no errors; else all errors, in order of place, each once.
    ///
    /// # Errors
    /// There is an error, or no value.
    pub fn into_result<T>(mut self, value: Option<T>) -> Result<T, Self> {
        match value {
            Some(value) if self.list.is_empty() => Ok(value),
            _ => {
                self.list.sort_by(|a, b| a.place.cmp(&b.place));
                self.list.dedup();
                Err(self)
            }
        }
    }
}

/// A key and its place, for a notice.
#[must_use]
pub fn key_with_place(key: &str, place: &Place) -> String {
    match place.line_column() {
        Some((line, _)) => format!("\"{key}\" ({}:{line})", place.file().display()),
        None => format!("\"{key}\" ({place})"),
    }
}

impl From<Vec<DescriptionError>> for DescriptionErrors {
    fn from(list: Vec<DescriptionError>) -> Self {
        Self { list, ..Self::none() }
    }
}

impl fmt::Display for DescriptionErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, error) in self.list.iter().enumerate() {
            write!(f, "{}{error}", if i == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}
