//! What a plot shows.

/// How an axis maps its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    Linear,
    /// By powers of ten; numbers that are not positive are left out.
    Log,
}

/// An axis.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    pub label: String,
    pub scale: Scale,
    /// The least range that it must show.
    pub shows: Vec<f64>,
}

impl Axis {
    pub(crate) fn linear(label: &str) -> Self {
        Self { label: label.to_owned(), scale: Scale::Linear, shows: Vec::new() }
    }

    pub(crate) fn log(label: &str) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }

    pub(crate) fn showing(self, values: &[f64]) -> Self {
        Self { shows: values.to_vec(), ..self }
    }
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    Line,
    /// A thin broken line: limits and models.
    Broken,
    Points,
}

/// The palette's colours for series that are about that colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Colour {
    Blue,
    Red,
}

/// A series of points with the half heights of their error bars.
#[derive(Clone, Debug)]
pub(crate) struct Series {
    pub name: String,
    pub mark: Mark,
    /// (x, y, half an error bar).
    pub points: Vec<[f64; 3]>,
    /// `None`: the next of the palette.
    pub colour: Option<Colour>,
}

impl Series {
    pub(crate) fn new(name: &str, mark: Mark, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::with_errors(name, mark, points.into_iter().map(|(x, y)| (x, y, 0.0)))
    }

    pub(crate) fn with_errors(name: &str, mark: Mark, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        Self { name: name.to_owned(), mark, points: points.into_iter().map(<[f64; 3]>::from).collect(), colour: None }
    }

    /// Drawn in this colour.
    pub(crate) fn coloured(self, colour: Colour) -> Self {
        Self { colour: Some(colour), ..self }
    }
}

/// A pair of axes with series.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub series: Vec<Series>,
}
