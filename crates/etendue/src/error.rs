//! What can go wrong between a file and its results.

use crate::fault::Fault;
use std::fmt::{self, Display};

/// Why a call of this library did not succeed. Nothing that was written under a final name is half-written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The input or the arguments cannot be used: all faults, with file, line and key where they have them. Arguments are
    /// named as the command line spells them. (Exit status 2 of the program.)
    Input(Vec<Fault>),
    /// The input is good and the run did not succeed: it was cancelled, the disk is full, light is not finite. (Exit status 1.)
    Run(String),
}

impl Error {
    /// One unusable input.
    pub fn input(error: impl Into<Fault>) -> Self {
        Self::Input(vec![error.into()])
    }

    /// Several unusable inputs.
    pub fn inputs<E: Into<Fault>>(errors: impl IntoIterator<Item = E>) -> Self {
        Self::Input(errors.into_iter().map(Into::into).collect())
    }

    /// A run that did not succeed although its input is good.
    pub fn run(error: impl Display) -> Self {
        Self::Run(format!("error: {error}"))
    }
}

/// Errors that are shown; of more the number.
const MAX_SHOWN: usize = 50;

impl std::error::Error for Error {}

impl Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(errors) => {
                errors.iter().take(MAX_SHOWN).try_for_each(|error| writeln!(f, "error: {error}"))?;
                match errors.len() {
                    0 | 1 => Ok(()),
                    n if n > MAX_SHOWN => {
                        writeln!(f, "and {} more; {n} errors in all; nothing was written", n - MAX_SHOWN)
                    }
                    n => writeln!(f, "{n} errors; nothing was written"),
                }
            }
            Self::Run(reason) => writeln!(f, "{reason}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_errors_the_first_are_shown_and_the_number_of_all() {
        let shown = |count: usize| Error::inputs((0..count).map(|i| format!("fault {i}"))).to_string();
        assert_eq!(shown(1), "error: fault 0\n");
        assert!(shown(50).ends_with("error: fault 49\n50 errors; nothing was written\n"));
        let many = shown(1234);
        assert_eq!(many.lines().count(), 51);
        assert!(many.ends_with("error: fault 49\nand 1184 more; 1234 errors in all; nothing was written\n"), "{many}");
    }
}
