//! Errors between a file and its results: of inputs, each with its place, and of the run.

use std::fmt::{self, Display};
use std::{ops::RangeInclusive, path::PathBuf};

use crate::error::code_of;

pub use etendue_scene::{ErrorCode, ExampleContext, Problem};

/// An error of a call of the library. No file under a final name is half-written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The input or the arguments cannot be used: all faults, with file, line, key and argument where they have them. Messages name arguments
    /// by their fields in backticks. (Exit status 2 of the program.)
    Input(Vec<Fault>),
    /// The input is good and the run did not succeed: it was cancelled, the disk is full, light is not finite. (Exit status 1.)
    Run(String),
}

impl Error {
    /// One unusable input.
    pub fn input(error: impl Into<Fault>) -> Self {
        Self::Input(vec![error.into()])
    }

    /// An argument that cannot be used, by the name of its field, which the message has in backticks.
    pub fn argument(field: &str, message: impl Into<String>) -> Self {
        Self::Input(vec![Fault::argument(field, message)])
    }

    /// Another code for all faults.
    #[must_use]
    pub fn with_code(self, code: ErrorCode) -> Self {
        match self {
            Self::Input(faults) => Self::Input(faults.into_iter().map(|fault| Fault { code, ..fault }).collect()),
            run => run,
        }
    }

    /// The same faults as those of an argument.
    #[must_use]
    pub fn with_field(self, field: &str) -> Self {
        let of_field = |fault: Fault| Fault { field: Some(field.to_owned()), ..fault };
        match self {
            Self::Input(faults) => Self::Input(faults.into_iter().map(of_field).collect()),
            run => run,
        }
    }

    /// One unusable input: its kind, and a message that says where it is.
    pub fn coded(code: ErrorCode, message: impl Into<String>) -> Self {
        Self::Input(vec![Fault::new(code, message)])
    }

    /// Several unusable inputs of one kind.
    pub fn all_coded<M: Into<String>>(code: ErrorCode, messages: impl IntoIterator<Item = M>) -> Self {
        Self::Input(messages.into_iter().map(|message| Fault::new(code, message)).collect())
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
                errors.iter().take(MAX_SHOWN).try_for_each(|error| writeln!(f, "error[{}]: {error}", error.code))?;
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
    /// Its kind, which `explain` explains.
    pub code: ErrorCode,
    /// Where it is, what is wrong, what was expected and what to do, in one sentence.
    pub message: String,
    /// What is wrong, without the place; the message where they are not apart.
    pub problem: String,
    /// What to do; `None` where the message says it in its own words, or the code alone.
    pub remedy: Option<String>,
    /// The file at fault; `None` where it is an argument's, or not known.
    pub file: Option<PathBuf>,
    /// The line of the file, from 1; `None` where it is of the whole file or of an override, or is not known.
    pub line: Option<u32>,
    /// The column of the line, in characters from 1; `None` where it is not known.
    pub column: Option<u32>,
    /// The dotted key of a description; `None` where there is none.
    pub key: Option<String>,
    /// The argument at fault, by the name of its field in the request; `None` where it is not one, or not of one alone.
    pub field: Option<String>,
}

impl Fault {
    /// A fault that only its message places.
    #[must_use]
    pub fn new(code: ErrorCode, message: impl Into<String>) -> Self {
        let message = message.into();
        let problem = message.clone();
        Self { code, message, problem, remedy: None, file: None, line: None, column: None, key: None, field: None }
    }

    /// A fault of an argument. Messages name arguments by their fields in backticks, `` `time_s` ``; a front end spells them as its users write them.
    #[must_use]
    pub fn argument(field: &str, message: impl Into<String>) -> Self {
        Self { field: Some(field.to_owned()), ..Self::new(ErrorCode::InvalidArgument, message) }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// The same at a key of a description.
fn at(code: ErrorCode, message: String, place: &etendue_scene::Place) -> Fault {
    let (line, column) = place.line_column().unzip();
    let file = Some(place.stating_file().to_path_buf()).filter(|_| place.is_stated());
    let key = Some(place.key().into_owned()).filter(|key| !key.is_empty());
    Fault { file, line, column, key, ..Fault::new(code, message) }
}

impl From<&etendue_scene::Fault> for Fault {
    fn from(fault: &etendue_scene::Fault) -> Self {
        let remedy = Some(fault.remedy.clone()).filter(|remedy| !remedy.is_empty());
        Self { problem: fault.problem.clone(), remedy, ..at(fault.code, fault.to_string(), &fault.place) }
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
        let named = error.place().map(|place| at(error.code(), error.to_string(), place));
        let problem = error.what().to_owned();
        match named {
            Some(named) if error.is_of_path() => Self { problem, ..named },
            named => Self {
                file: Some(error.file().to_path_buf()),
                line: error.line().and_then(|line| u32::try_from(line).ok()),
                key: named.and_then(|named| named.key),
                problem,
                ..Self::new(error.code(), error.to_string())
            },
        }
    }
}

/// A file that the caller reads.
impl From<std::io::Error> for Fault {
    fn from(error: std::io::Error) -> Self {
        Self::new(code_of(&error), error.to_string())
    }
}

impl From<Problem> for Fault {
    fn from(problem: Problem) -> Self {
        Self::new(problem.code, problem.words)
    }
}

/// Refuses an argument that is a whole number out of its range.
///
/// # Errors
/// The number is out of the range.
pub fn check_whole<N: PartialOrd + Display>(field: &str, value: N, range: RangeInclusive<N>) -> Result<(), Error> {
    if range.contains(&value) {
        return Ok(());
    }
    let (low, high) = (range.start(), range.end());
    let message = format!("`{field}`: expected a whole number from {low} to {high}, not {value}");
    Err(Error::argument(field, message).with_code(ErrorCode::OutOfRange))
}

/// Refuses an argument that is a number out of its range, or not finite.
///
/// # Errors
/// The number is out of the range.
pub fn check_number(field: &str, value: f64, range: RangeInclusive<f64>, unit: &str) -> Result<(), Error> {
    if value.is_finite() && range.contains(&value) {
        return Ok(());
    }
    let (low, high) = (range.start(), range.end());
    let message = format!("`{field}`: expected {low} to {high} {unit}, not {value}");
    Err(Error::argument(field, message).with_code(ErrorCode::OutOfRange))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_errors_the_first_are_shown_and_the_number_of_all() {
        let shown = |count: usize| {
            Error::all_coded(ErrorCode::MalformedFile, (0..count).map(|i| format!("fault {i}"))).to_string()
        };
        assert_eq!(shown(1), "error[malformed-file]: fault 0\n");
        assert!(shown(50).ends_with("error[malformed-file]: fault 49\n50 errors; nothing was written\n"));
        let many = shown(1234);
        assert_eq!(many.lines().count(), 51);
        assert!(
            many.ends_with("error[malformed-file]: fault 49\nand 1184 more; 1234 errors in all; nothing was written\n"),
            "{many}"
        );
    }

    #[test]
    fn an_argument_s_fault_is_told_by_its_field() {
        let Error::Input(faults) = Error::argument("time_s", "`time_s` 3: a time of 10 s or more is kept") else {
            panic!()
        };
        assert_eq!((faults[0].field.as_deref(), faults[0].key.as_deref()), (Some("time_s"), None));
        let plain = Error::coded(ErrorCode::InvalidArgument, "job.toml: `time_s`");
        assert_eq!(plain.with_field("spp"), Error::argument("spp", "job.toml: `time_s`"));
        assert_eq!(Fault::new(ErrorCode::WrongCount, "`corners`: expected four of them").field, None);
    }

    #[test]
    fn numbers_out_of_their_range_are_refused_by_their_field() {
        assert_eq!(check_whole("rings", 4, 4..=1000), Ok(()));
        let message = check_whole("rings", 3, 4..=1000).map_err(|error| error.to_string());
        assert_eq!(
            message,
            Err("error[out-of-range]: `rings`: expected a whole number from 4 to 1000, not 3\n".to_owned())
        );
        assert!(check_number("wavelength_nm", f64::NAN, 300.0..=1100.0, "nm").is_err());
        assert!(check_number("photons", f64::INFINITY, 0.0..=f64::MAX, "photons").is_err());
    }
}
