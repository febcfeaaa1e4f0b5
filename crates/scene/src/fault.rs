//! Faults of a description: all of them are collected before any is reported.

use std::fmt;

use crate::place::{Place, Placed};

/// One fault: where it stands, what is wrong with what was expected, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
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
    pub fn new(place: &Place, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { place: place.clone(), problem: problem.into(), remedy: remedy.into() }
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
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)?;
        if self.remedy.is_empty() { Ok(()) } else { write!(f, "; {}", self.remedy) }
    }
}

/// All faults of a description, by file and line. Displays one a line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub struct Faults {
    list: Vec<Fault>,
    /// Names that were used while reading and must turn out to be defined.
    uses: Vec<(Named, Placed<String>)>,
}

/// What can be called by name from elsewhere in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Named {
    Mesh,
    Texture,
    Material,
    Class,
}

impl Faults {
    /// No faults yet.
    #[must_use]
    pub fn none() -> Self {
        Self { list: Vec::new(), uses: Vec::new() }
    }

    /// The faults, by file and line.
    #[must_use]
    pub fn list(&self) -> &[Fault] {
        &self.list
    }

    /// Notes a fault.
    pub fn add(&mut self, place: &Place, problem: impl Into<String>, remedy: impl Into<String>) {
        self.list.push(Fault::new(place, problem, remedy));
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
