//! Parameters of a camera, those that could not be determined, and the kinds of images that they come from, one folder each.

use etendue_io::failure::Error;

use crate::report::{Estimate, Report};

/// A parameter of the camera.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Name in JSON: that of its key in the camera file, if it has one.
    pub key: String,
    /// Human-readable name.
    pub label: String,
    /// Unit; empty if dimensionless.
    pub unit: &'static str,
    /// Value with its standard uncertainty.
    pub value: Estimate,
    /// Kind of images that determines it.
    pub from: Kind,
}

/// A quantity that could not be determined.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// Name of the quantity.
    pub what: String,
    /// Reason, and what would determine it.
    pub why: String,
}

/// One measurement of the characterisation.
#[derive(Clone, Debug)]
pub struct Part {
    /// Heading.
    pub title: &'static str,
    /// Kind of images used.
    pub from: Kind,
    /// Report of the measurement.
    pub report: Report,
}

/// Results, as they are collected.
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
            false => self.unknown(&label, format!("the images in {}/ do not determine it", from.folder())),
        }
    }

    pub(super) fn unknown(&mut self, what: &str, why: impl Into<String>) {
        self.unknown.push(Unknown { what: what.to_owned(), why: why.into() });
    }

    pub(super) fn part(&mut self, title: &'static str, from: Kind, report: Report) {
        self.parts.push(Part { title, from, report });
    }

    /// Records a quantity as unknown because its images are missing.
    pub(super) fn missing(&mut self, what: &str, kind: Kind) {
        self.unknown(what, format!("no images in {}/ ({})", kind.folder(), kind.about()));
    }

    /// Returns the result of a measurement; if it failed, records its quantity as unknown.
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

/// Subject of a folder of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// No light, two frames or more per exposure time.
    Dark,
    /// Uniform illumination on the bare sensor, two frames or more per exposure time.
    Flat,
    /// A uniformly lit surface through the lens.
    Field,
    /// Views of a plane chart of points.
    Chart,
    /// Slanted edges.
    Edges,
    /// A ColorChecker.
    Checker,
}

impl Kind {
    /// All kinds, in the order of measurement.
    pub const ALL: [Self; 6] = [Self::Dark, Self::Flat, Self::Field, Self::Chart, Self::Edges, Self::Checker];

    /// Name of the folder.
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

    /// Short description of the subject.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::Dark => "frames without light",
            Self::Flat => "uniform illumination of the bare sensor",
            Self::Field => "a uniformly lit surface through the lens",
            Self::Chart => "views of a chart of points",
            Self::Edges => "slanted edges",
            Self::Checker => "a ColorChecker",
        }
    }
}
