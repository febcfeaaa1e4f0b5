//! What a plot shows.

/// How an axis maps its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// In proportion.
    Linear,
    /// By powers of ten; numbers that are not positive are left out.
    Log,
}

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What stands beside it, with its unit.
    pub label: String,
    /// How its numbers are laid out.
    pub scale: Scale,
    /// The least range that it must show.
    pub shows: Vec<f64>,
}

impl Axis {
    /// In proportion.
    #[must_use]
    pub fn linear(label: &str) -> Self {
        Self { label: label.to_owned(), scale: Scale::Linear, shows: Vec::new() }
    }

    /// By powers of ten.
    #[must_use]
    pub fn log(label: &str) -> Self {
        Self { scale: Scale::Log, ..Self::linear(label) }
    }

    /// That shows at least these values.
    #[must_use]
    pub fn showing(self, values: &[f64]) -> Self {
        Self { shows: values.to_vec(), ..self }
    }
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Points joined by a line.
    Line,
    /// A thin broken line: limits and models.
    Broken,
    /// Dots.
    Points,
}

/// The palette's colours for series that are about that colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Of what is about blue light.
    Blue,
    /// Of what is about red light.
    Red,
}

/// A series of points with the half heights of their error bars.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// How it is drawn.
    pub mark: Mark,
    /// (x, y, half an error bar).
    pub points: Vec<[f64; 3]>,
    /// `None`: the next of the palette.
    pub colour: Option<Colour>,
}

impl Series {
    /// Points (x, y) without error bars.
    pub fn new(name: &str, mark: Mark, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::with_errors(name, mark, points.into_iter().map(|(x, y)| (x, y, 0.0)))
    }

    /// Points (x, y, half an error bar).
    pub fn with_errors(name: &str, mark: Mark, points: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        Self { name: name.to_owned(), mark, points: points.into_iter().map(<[f64; 3]>::from).collect(), colour: None }
    }

    /// Drawn in this colour.
    pub fn coloured(self, colour: Colour) -> Self {
        Self { colour: Some(colour), ..self }
    }
}

/// A pair of axes with series.
#[derive(Clone, Debug)]
pub struct Plot {
    /// What stands above it.
    pub title: String,
    /// The axis to the right.
    pub x: Axis,
    /// The axis upwards.
    pub y: Axis,
    /// What is drawn, the first below the others.
    pub series: Vec<Series>,
}
