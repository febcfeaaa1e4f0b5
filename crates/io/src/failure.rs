//! Errors of the library: of inputs, each with its place, and of the run.

use std::fmt::{self, Display};
use std::{ops::RangeInclusive, path::PathBuf};

use crate::error::code_of;

pub use etendue_scene::{ErrorCode, ExampleContext, Problem};

/// Error of a call of the library. No file under a final name is incomplete.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The input or the arguments cannot be used: all errors, with file, line, key and argument if they have them. Messages name arguments by their fields in
    /// backticks. (Exit status 2 of the program.)
    Input(Vec<InputError>),
    /// The input is valid but the run failed: it was cancelled, the disk is full, light is not finite. (Exit status 1.)
    Run(String),
}

impl Error {
    /// Returns the error of one unusable input.
    pub fn input(error: impl Into<InputError>) -> Self {
        Self::Input(vec![error.into()])
    }

    /// Returns the error of an unusable argument, by the name of its field, which the message has in backticks.
    pub fn argument(field: &str, message: impl Into<String>) -> Self {
        Self::Input(vec![InputError::argument(field, message)])
    }

    /// Sets the code of all errors.
    #[must_use]
    pub fn with_code(self, code: ErrorCode) -> Self {
        match self {
            Self::Input(errors) => Self::Input(errors.into_iter().map(|error| InputError { code, ..error }).collect()),
            run => run,
        }
    }

    /// Returns the same errors as those of an argument.
    #[must_use]
    pub fn with_field(self, field: &str) -> Self {
        let of_field = |error: InputError| InputError { field: Some(field.to_owned()), ..error };
        match self {
            Self::Input(errors) => Self::Input(errors.into_iter().map(of_field).collect()),
            run => run,
        }
    }

    /// Returns the error of one unusable input: its code, and a message that states the place.
    pub fn coded(code: ErrorCode, message: impl Into<String>) -> Self {
        Self::Input(vec![InputError::new(code, message)])
    }

    /// Returns the errors of several unusable inputs of one kind.
    pub fn all_coded<M: Into<String>>(code: ErrorCode, messages: impl IntoIterator<Item = M>) -> Self {
        Self::Input(messages.into_iter().map(|message| InputError::new(code, message)).collect())
    }

    /// Returns the errors of several unusable inputs.
    pub fn inputs<E: Into<InputError>>(errors: impl IntoIterator<Item = E>) -> Self {
        Self::Input(errors.into_iter().map(Into::into).collect())
    }

    /// Returns the error of a run that failed although its input is valid.
    pub fn run(error: impl Display) -> Self {
        Self::Run(format!("error: {error}"))
    }
}

/// Maximum number of errors shown; of the rest only the number.
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
                        writeln!(f, "and {} more; {n} errors in total; nothing was written", n - MAX_SHOWN)
                    }
                    n => writeln!(f, "{n} errors; nothing was written"),
                }
            }
            Self::Run(reason) => writeln!(f, "{reason}"),
        }
    }
}

/// One error of an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError {
    /// Error code, which `explain` explains.
    pub code: ErrorCode,
    /// Place, cause, expected form and remedy, in one sentence.
    pub message: String,
    /// Problem without the place; the message if they are not separate.
    pub problem: String,
    /// Remedy; `None` if the message or the code alone states it.
    pub remedy: Option<String>,
    /// File of the error; `None` if it is an argument's, or unknown.
    pub file: Option<PathBuf>,
    /// Line of the file, from 1; `None` for the whole file or an override, or if unknown.
    pub line: Option<u32>,
    /// Column of the line, in characters from 1; `None` if unknown.
    pub column: Option<u32>,
    /// The dotted key of a description; `None` if there is none.
    pub key: Option<String>,
    /// Argument of the error, by the name of its field in the request; `None` if it is not about exactly one argument.
    pub field: Option<String>,
}

impl InputError {
    /// Returns an error without a place other than in its message.
    #[must_use]
    pub fn new(code: ErrorCode, message: impl Into<String>) -> Self {
        let message = message.into();
        let problem = message.clone();
        Self { code, message, problem, remedy: None, file: None, line: None, column: None, key: None, field: None }
    }

    /// Returns an error of an argument. Messages name arguments by their fields in backticks, `` `time_s` ``; a front end spells them as its users write them.
    #[must_use]
    pub fn argument(field: &str, message: impl Into<String>) -> Self {
        Self { field: Some(field.to_owned()), ..Self::new(ErrorCode::InvalidArgument, message) }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// Returns the error with a key of a description as its place.
fn at(code: ErrorCode, message: String, place: &etendue_scene::Place) -> InputError {
    let (line, column) = place.line_column().unzip();
    let file = Some(place.stating_file().to_path_buf()).filter(|_| place.has_source());
    let key = Some(place.key().into_owned()).filter(|key| !key.is_empty());
    InputError { file, line, column, key, ..InputError::new(code, message) }
}

impl From<&etendue_scene::DescriptionError> for InputError {
    fn from(error: &etendue_scene::DescriptionError) -> Self {
        let remedy = Some(error.remedy.clone()).filter(|remedy| !remedy.is_empty());
        Self { problem: error.problem.clone(), remedy, ..at(error.code, error.to_string(), &error.place) }
    }
}

impl From<etendue_scene::DescriptionError> for InputError {
    fn from(error: etendue_scene::DescriptionError) -> Self {
        Self::from(&error)
    }
}

/// An error of a path is placed where the path is named; one of a file's content in the file, with the key that names it.
impl From<crate::Error> for InputError {
    fn from(error: crate::Error) -> Self {
        let named = error.place().map(|place| at(error.code(), error.to_string(), place));
        let problem = error.what().to_owned();
        match named {
            Some(named) if error.is_path_error() => Self { problem, ..named },
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

/// Error of a file that the caller reads.
impl From<std::io::Error> for InputError {
    fn from(error: std::io::Error) -> Self {
        Self::new(code_of(&error), error.to_string())
    }
}

impl From<Problem> for InputError {
    fn from(problem: Problem) -> Self {
        Self::new(problem.code, problem.words)
    }
}

/// Refuses an argument that is a whole number out of its range.
///
/// # Errors
/// The number is out of the range.
pub fn check_integer<N: PartialOrd + Display>(field: &str, value: N, range: RangeInclusive<N>) -> Result<(), Error> {
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
    fn the_first_of_many_errors_are_shown_with_the_number_of_all() {
        let shown = |count: usize| {
            Error::all_coded(ErrorCode::MalformedFile, (0..count).map(|i| format!("fault {i}"))).to_string()
        };
        assert_eq!(shown(1), "error[malformed-file]: fault 0\n");
        assert!(shown(50).ends_with("error[malformed-file]: fault 49\n50 errors; nothing was written\n"));
        let many = shown(1234);
        assert_eq!(many.lines().count(), 51);
        assert!(
            many.ends_with(
                "error[malformed-file]: fault 49\nand 1184 more; 1234 errors in total; nothing was written\n"
            ),
            "{many}"
        );
    }

    #[test]
    fn an_argument_s_error_names_its_field() {
        let Error::Input(errors) = Error::argument("time_s", "`time_s` 3: a time of 10 s or more is kept") else {
            panic!()
        };
        assert_eq!((errors[0].field.as_deref(), errors[0].key.as_deref()), (Some("time_s"), None));
        let plain = Error::coded(ErrorCode::InvalidArgument, "job.toml: `time_s`");
        assert_eq!(plain.with_field("spp"), Error::argument("spp", "job.toml: `time_s`"));
        assert_eq!(InputError::new(ErrorCode::WrongCount, "`corners`: expected four of them").field, None);
    }

    #[test]
    fn numbers_out_of_their_range_are_refused_by_their_field() {
        assert_eq!(check_integer("rings", 4, 4..=1000), Ok(()));
        let message = check_integer("rings", 3, 4..=1000).map_err(|error| error.to_string());
        assert_eq!(
            message,
            Err("error[out-of-range]: `rings`: expected a whole number from 4 to 1000, not 3\n".to_owned())
        );
        assert!(check_number("wavelength_nm", f64::NAN, 300.0..=1100.0, "nm").is_err());
        assert!(check_number("photons", f64::INFINITY, 0.0..=f64::MAX, "photons").is_err());
    }
}
