//! What went wrong, and the exit status it means.

use std::fmt::Display;

/// Why a verb did not succeed.
#[derive(Debug)]
pub enum Failure {
    /// The input or the arguments cannot be used: exit status 2. One message an error.
    Input(Vec<String>),
    /// A comparison found a difference, or a run was stopped: exit status 1.
    Run(String),
}

impl Failure {
    /// One unusable input.
    pub fn input(error: impl Display) -> Self {
        Self::Input(vec![error.to_string()])
    }

    /// Several unusable inputs.
    pub fn inputs<E: Display>(errors: impl IntoIterator<Item = E>) -> Self {
        Self::Input(errors.into_iter().map(|e| e.to_string()).collect())
    }

    /// A run that did not succeed although its input is good.
    pub fn run(error: impl Display) -> Self {
        Self::Run(format!("error: {error}"))
    }

    /// The process's exit status.
    pub fn status(&self) -> u8 {
        match self {
            Self::Input(_) => 2,
            Self::Run(_) => 1,
        }
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Input(errors) => {
                errors.iter().try_for_each(|error| writeln!(f, "error: {error}"))?;
                match errors.len() {
                    0 | 1 => Ok(()),
                    n => writeln!(f, "{n} errors; nothing was written"),
                }
            }
            Self::Run(reason) => writeln!(f, "{reason}"),
        }
    }
}
