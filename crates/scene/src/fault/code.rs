//! Explanation of an error code: cause, remedy and an example.

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

/// A fragment with the error, and the corrected fragment.
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
    /// Arguments of the program; arguments by their fields in backticks.
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
