//! What was found of a camera, number by number, and what was not; the kinds of pictures that it is found from, a folder each.

use etendue_io::failure::Error;

use crate::report::{Estimate, Report};

/// A number of the camera.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name in JSON: that of its key in the camera file, where it has one.
    pub key: String,
    /// Its name for people.
    pub label: String,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// The value with its standard uncertainty.
    pub value: Estimate,
    /// The pictures that tell it.
    pub from: Kind,
}

/// What could not be known.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// What.
    pub what: String,
    /// Why, and what would tell it.
    pub why: String,
}

/// A measurement among those that were made.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its heading.
    pub title: &'static str,
    /// The pictures that it was made of.
    pub from: Kind,
    /// What it found.
    pub report: Report,
}

/// All that is found, as it grows.
#[derive(Clone, Debug, Default)]
pub(super) struct Findings {
    pub(super) parameters: Vec<Parameter>,
    pub(super) unknown: Vec<Unknown>,
    pub(super) parts: Vec<Part>,
}

impl Findings {
    pub(super) fn found(&mut self, from: Kind, key: &str, label: &str, unit: &'static str, value: Estimate) {
        let (key, label) = (key.to_owned(), label.to_owned());
        match value.value.is_finite() && value.standard_uncertainty.is_finite() {
            true => self.parameters.push(Parameter { key, label, unit, value, from }),
            false => self.unknown(&label, format!("the pictures in {}/ do not determine it", from.folder())),
        }
    }

    pub(super) fn unknown(&mut self, what: &str, why: impl Into<String>) {
        self.unknown.push(Unknown { what: what.to_owned(), why: why.into() });
    }

    pub(super) fn part(&mut self, title: &'static str, from: Kind, report: Report) {
        self.parts.push(Part { title, from, report });
    }

    /// What is unknown because its pictures are not there.
    pub(super) fn missing(&mut self, what: &str, kind: Kind) {
        self.unknown(what, format!("there are no pictures in {}/ ({})", kind.folder(), kind.about()));
    }

    /// The result of a measurement; one that cannot be made leaves what it would have told unknown.
    pub(super) fn attempt<T>(&mut self, what: &str, made: Result<T, Error>) -> Result<Option<T>, Error> {
        match made {
            Ok(found) => Ok(Some(found)),
            Err(Error::Input(faults)) => {
                let why: Vec<String> = faults.iter().map(ToString::to_string).collect();
                self.unknown(what, why.join("; "));
                Ok(None)
            }
            Err(other) => Err(other),
        }
    }
}

/// What a folder of pictures shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// No light, two frames or more an exposure time.
    Dark,
    /// Even light on the bare sensor, two frames or more an exposure time.
    Flat,
    /// An evenly lit surface through the lens.
    Field,
    /// Views of a plane chart of points.
    Chart,
    /// Slanted edges.
    Edges,
    /// A ColorChecker.
    Checker,
}

impl Kind {
    /// All of them, in the order in which they are measured.
    pub const ALL: [Self; 6] = [Self::Dark, Self::Flat, Self::Field, Self::Chart, Self::Edges, Self::Checker];

    /// The folder's name.
    #[must_use]
    pub fn folder(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Flat => "flat",
            Self::Field => "field",
            Self::Chart => "chart",
            Self::Edges => "edges",
            Self::Checker => "checker",
        }
    }

    /// What it shows, in a few words.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::Dark => "frames without light",
            Self::Flat => "even light on the bare sensor",
            Self::Field => "an evenly lit surface through the lens",
            Self::Chart => "views of a chart of points",
            Self::Edges => "slanted edges",
            Self::Checker => "a ColorChecker",
        }
    }
}
