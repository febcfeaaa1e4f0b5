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
    pub image_kind: ImageKind,
}

/// A quantity that could not be determined.
#[derive(Clone, Debug)]
pub struct UndeterminedQuantity {
    /// Name of the quantity.
    pub quantity: String,
    /// Reason, and what would determine it.
    pub reason: String,
}

/// One measurement of the characterisation.
#[derive(Clone, Debug)]
pub struct PartialReport {
    /// Heading.
    pub title: &'static str,
    /// Kind of images used.
    pub image_kind: ImageKind,
    /// Report of the measurement.
    pub report: Report,
}

/// Results, as they are collected.
#[derive(Clone, Debug, Default)]
pub(super) struct Findings {
    pub(super) parameters: Vec<Parameter>,
    pub(super) unknown: Vec<UndeterminedQuantity>,
    pub(super) parts: Vec<PartialReport>,
}

impl Findings {
    pub(super) fn add_parameter(
        &mut self,
        from: ImageKind,
        key: &str,
        label: &str,
        unit: &'static str,
        value: Estimate,
    ) {
        let (key, label) = (key.to_owned(), label.to_owned());
        match value.value.is_finite() && value.standard_uncertainty.is_finite() {
            true => self.parameters.push(Parameter { key, label, unit, value, image_kind: from }),
            false => self.unknown(&label, format!("the images in {}/ do not determine it", from.folder())),
        }
    }

    pub(super) fn unknown(&mut self, quantity: &str, reason: impl Into<String>) {
        self.unknown.push(UndeterminedQuantity { quantity: quantity.to_owned(), reason: reason.into() });
    }

    pub(super) fn part(&mut self, title: &'static str, from: ImageKind, report: Report) {
        self.parts.push(PartialReport { title, image_kind: from, report });
    }

    /// Records a quantity as unknown because its images are missing.
    pub(super) fn missing(&mut self, quantity: &str, kind: ImageKind) {
        self.unknown(quantity, format!("no images in {}/ ({})", kind.folder(), kind.about()));
    }

    /// Returns the result of a measurement; if it failed, records its quantity as unknown.
    pub(super) fn record<T>(&mut self, quantity: &str, result: Result<T, Error>) -> Result<Option<T>, Error> {
        match result {
            Ok(value) => Ok(Some(value)),
            Err(Error::Input(errors)) => {
                let reasons: Vec<String> = errors.iter().map(ToString::to_string).collect();
                self.unknown(quantity, reasons.join("; "));
                Ok(None)
            }
            Err(other) => Err(other),
        }
    }
}

/// Subject of a folder of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ImageKind {
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

impl ImageKind {
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
