//! Errors between a file and its results: of inputs, each with its place, and of the run.

use std::fmt::{self, Display};
use std::path::PathBuf;

/// An error of a call of the library. No file under a final name is half-written.
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

/// One fault of an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where it is, what is wrong, what was expected and what to do, in one sentence.
    pub message: String,
    /// The file at fault; `None` where it is an argument's, or not known.
    pub file: Option<PathBuf>,
    /// The line of the file, from 1; `None` where it is of the whole file or of an override, or is not known.
    pub line: Option<u32>,
    /// The column of the line, in characters from 1; `None` where it is not known.
    pub column: Option<u32>,
    /// The dotted key of a description, or an argument as the command line spells it (`--spp`); `None` where there is none.
    pub key: Option<String>,
}

impl Fault {
    /// A fault that only its message places. One that begins with an argument's name is that argument's.
    #[must_use]
    pub fn new(message: impl Into<String>) -> Self {
        let message = message.into();
        let argument = message.split([' ', ':', ',']).next().filter(|word| word.starts_with("--") && word.len() > 2);
        let key = argument.map(str::to_owned);
        Self { message, file: None, line: None, column: None, key }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// The same at a key of a description.
fn at(message: String, place: &etendue_scene::Place) -> Fault {
    let (line, column) = place.line_column().unzip();
    let file = Some(place.stating_file().to_path_buf()).filter(|_| place.is_stated());
    let key = Some(place.key().into_owned()).filter(|key| !key.is_empty());
    Fault { message, file, line, column, key }
}

impl From<&etendue_scene::Fault> for Fault {
    fn from(fault: &etendue_scene::Fault) -> Self {
        at(fault.to_string(), &fault.place)
    }
}

impl From<etendue_scene::Fault> for Fault {
    fn from(fault: etendue_scene::Fault) -> Self {
        Self::from(&fault)
    }
}

/// A path at fault is where it is named; what is wrong in a file is there, with the key that names it.
impl From<crate::Error> for Fault {
    fn from(error: crate::Error) -> Self {
        let named = error.place().map(|place| at(error.to_string(), place));
        match named {
            Some(named) if error.is_of_path() => named,
            named => Self {
                message: error.to_string(),
                file: Some(error.file().to_path_buf()),
                line: error.line().and_then(|line| u32::try_from(line).ok()),
                column: None,
                key: named.and_then(|named| named.key),
            },
        }
    }
}

impl From<String> for Fault {
    fn from(message: String) -> Self {
        Self::new(message)
    }
}

impl From<&str> for Fault {
    fn from(message: &str) -> Self {
        Self::new(message)
    }
}

impl From<std::io::Error> for Fault {
    fn from(error: std::io::Error) -> Self {
        Self::new(error.to_string())
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

    #[test]
    fn an_argument_s_fault_is_told_by_its_name() {
        let key = |message: &str| Fault::new(message).key;
        assert_eq!(key("--time 3: a time of 10 s or more is kept"), Some("--time".to_owned()));
        assert_eq!(key("--corners: expected four of them"), Some("--corners".to_owned()));
        assert_eq!((key("job.toml: --"), key("-- "), key("")), (None, None, None));
    }
}
