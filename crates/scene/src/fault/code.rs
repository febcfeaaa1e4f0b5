//! Codes of errors: the kind of an error, one word each, with its explanation in [`catalogue`](super::catalogue).

use std::fmt;
use std::str::FromStr;

use super::catalogue::ErrorCode;
use crate::suggest::nearest;

/// Explanation of a code, which `etendue explain` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// Cause, in one or two sentences.
    pub cause: &'static str,
    /// Remedy, in one sentence.
    pub remedy: &'static str,
    /// An input with the error, and the same without it.
    pub example: Example,
}

/// A fragment that has the error, and the fragment in its place that has not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// Context of the fragments.
    pub context: ExampleContext,
    /// The fragment with the error.
    pub wrong: &'static str,
    /// The fragment without it.
    pub right: &'static str,
}

/// Context of the fragments of an example.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExampleContext {
    /// Keys of a job, scene or camera, as TOML.
    Keys,
    /// Lines of a file of this name.
    File(&'static str),
    /// Words behind the program's name; arguments by their fields in backticks.
    Command,
}

impl Example {
    /// An example of keys.
    #[must_use]
    pub const fn keys(wrong: &'static str, right: &'static str) -> Self {
        Self { context: ExampleContext::Keys, wrong, right }
    }

    /// An example of lines of a file.
    #[must_use]
    pub const fn file(name: &'static str, wrong: &'static str, right: &'static str) -> Self {
        Self { context: ExampleContext::File(name), wrong, right }
    }

    /// An example of a command.
    #[must_use]
    pub const fn command(wrong: &'static str, right: &'static str) -> Self {
        Self { context: ExampleContext::Command, wrong, right }
    }
}

/// An error whose place the caller knows: its kind, and what is wrong in words.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{words}")]
pub struct Problem {
    /// Its kind.
    pub code: ErrorCode,
    /// Problem and remedy, in words.
    pub words: String,
}

impl Problem {
    /// A problem of this kind.
    pub fn new(code: ErrorCode, words: impl Into<String>) -> Self {
        Self { code, words: words.into() }
    }
}

impl Problem {
    /// The same, with words before it: "WORDS: …".
    #[must_use]
    pub fn within(self, words: impl fmt::Display) -> Self {
        Self { words: format!("{words}: {}", self.words), ..self }
    }
}

/// Words about the content of a file.
impl From<String> for Problem {
    fn from(words: String) -> Self {
        Self::new(ErrorCode::MalformedFile, words)
    }
}

/// Words about the content of a file.
impl From<&str> for Problem {
    fn from(words: &str) -> Self {
        Self::new(ErrorCode::MalformedFile, words)
    }
}

impl fmt::Display for ErrorCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

/// A word that is no code.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no error code \"{word}\"{}", .nearest.map_or_else(|| "; explain without a code lists all".to_owned(), |code| format!("; did you mean \"{code}\"?")))]
pub struct UnknownCode {
    word: String,
    nearest: Option<ErrorCode>,
}

impl FromStr for ErrorCode {
    type Err = UnknownCode;

    fn from_str(word: &str) -> Result<Self, UnknownCode> {
        let code_of = |word: &str| Self::ALL.iter().copied().find(|code| code.word() == word);
        code_of(word).ok_or_else(|| {
            let words: Vec<&str> = Self::ALL.iter().map(|code| code.word()).collect();
            UnknownCode { word: word.to_owned(), nearest: nearest(word, &words).and_then(code_of) }
        })
    }
}
