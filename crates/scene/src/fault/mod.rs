//! Faults of a description: all of them are collected before any is reported.

use std::fmt::{self, Write as _};

use crate::place::{Place, Placed};

mod catalogue;
mod code;

pub use catalogue::{ErrorCode, Problem};
pub use code::{Example, ExampleContext, Explanation};

/// One fault: where it stands, what is wrong with what was expected, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Its kind.
    pub code: ErrorCode,
    /// Where it stands.
    pub place: Place,
    /// What is wrong, and what was expected.
    pub problem: String,
    /// What to do; empty where the problem's own words say it.
    pub remedy: String,
}

impl Fault {
    /// A fault at `place`.
    #[must_use]
    pub fn new(code: ErrorCode, place: &Place, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { code, place: place.clone(), problem: problem.into(), remedy: remedy.into() }
    }
}

impl Named {
    /// What it is.
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

/// On one line: names and texts of a file may hold line breaks and what moves a terminal's cursor, which are told as escapes.
impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let told = format!("{}: {}", self.place, self.problem);
        let remedy = if self.remedy.is_empty() { String::new() } else { format!("; {}", self.remedy) };
        told.chars().chain(remedy.chars()).try_for_each(|c| match c.is_control() {
            true => write!(f, "{}", c.escape_default()),
            false => f.write_char(c),
        })
    }
}

/// All faults of a description, by file and line. Displays one a line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct Faults {
    list: Vec<Fault>,
    /// Names that were used while reading and must turn out to be defined.
    uses: Vec<(Named, Placed<String>)>,
    superseded: Vec<Superseded>,
}

/// The problem of a table without a key.
fn missing(key: &str) -> String {
    format!("the key \"{key}\" is missing")
}

/// A key of a file that the command line makes meaningless.
#[derive(Clone, Debug, PartialEq)]
struct Superseded {
    by: Place,
    key: String,
    place: Place,
}

/// What can be called by name from elsewhere in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Named {
    Mesh,
    Texture,
    Material,
    Class,
    Frame,
}

impl Faults {
    /// No faults yet.
    #[must_use]
    pub fn none() -> Self {
        Self { list: Vec::new(), uses: Vec::new(), superseded: Vec::new() }
    }

    /// The faults, by file and line.
    #[must_use]
    pub fn list(&self) -> &[Fault] {
        &self.list
    }

    /// Notes that a key of the table at `place` is missing.
    pub(crate) fn add_missing(&mut self, place: &Place, key: &str, remedy: impl Into<String>) {
        self.add(ErrorCode::MissingKey, place, missing(key), remedy);
    }

    /// Takes back that a key of the table at `place` is missing: another is taken for it.
    pub(crate) fn take_back_missing(&mut self, place: &Place, key: &str) {
        let problem = missing(key);
        self.list.retain(|fault| fault.place != *place || fault.problem != problem);
    }

    /// Notes a fault.
    pub fn add(&mut self, code: ErrorCode, place: &Place, problem: impl Into<String>, remedy: impl Into<String>) {
        self.list.push(Fault::new(code, place, problem, remedy));
    }

    /// Notes that `key`, which stands at `place`, has no effect for what stands at `cause`: a fault, but not where the
    /// command line says the cause and a file the key. What the command line says supersedes what it makes meaningless.
    pub(crate) fn add_idle(
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
                let superseded = Superseded { by: by.clone(), key: key.to_owned(), place: place.clone() };
                if !self.superseded.contains(&superseded) {
                    self.superseded.push(superseded);
                }
            }
            _ => self.add(code, place, problem, remedy),
        }
    }

    /// What the command line supersedes, a sentence for each of its words.
    pub(crate) fn notices(&self) -> Vec<String> {
        let mut causes: Vec<&Place> = Vec::new();
        for Superseded { by, .. } in &self.superseded {
            if !causes.contains(&by) {
                causes.push(by);
            }
        }
        causes.into_iter().map(|by| self.notice(by)).collect()
    }

    fn notice(&self, by: &Place) -> String {
        let stated = self.superseded.iter().filter(|s| s.by == *by).map(|s| stated(&s.key, &s.place));
        format!("{by} supersedes {}", stated.collect::<Vec<_>>().join(", "))
    }

    /// Remembers that a name is used.
    pub(crate) fn note_use(&mut self, named: Named, name: Placed<String>) {
        self.uses.push((named, name));
    }

    /// Hands over the names that were used.
    pub(crate) fn take_uses(&mut self) -> Vec<(Named, Placed<String>)> {
        std::mem::take(&mut self.uses)
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.list.len()
    }

    /// `value` if there are no faults; else all of them, in order of place, each once.
    ///
    /// # Errors
    /// Where there is a fault, or no value.
    pub fn or<T>(mut self, value: Option<T>) -> Result<T, Self> {
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

/// A key and where it is said, for a notice.
#[must_use]
pub fn stated(key: &str, place: &Place) -> String {
    match place.line_column() {
        Some((line, _)) => format!("\"{key}\" ({}:{line})", place.file().display()),
        None => format!("\"{key}\" ({place})"),
    }
}

impl From<Vec<Fault>> for Faults {
    fn from(list: Vec<Fault>) -> Self {
        Self { list, ..Self::none() }
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, fault) in self.list.iter().enumerate() {
            write!(f, "{}{fault}", if i == 0 { "" } else { "\n" })?;
        }
        Ok(())
    }
}
