//! The charts: the closed list, one file each.
//!
//! # Contract
//!
//! A design holds the options of its chart; what is left open follows from what the camera sees. [`Chart::draw`] answers
//! with sheets that partition their planes, inks, features and patches; nothing is drawn at random but by the seed.

mod checkerboard;
mod circles;
mod dots;
mod flat;
mod grid;

use crate::drawing::Drawing;
use crate::error::ChartError;
use crate::eye::Footprint;

pub use checkerboard::Checkerboard;
pub use circles::Circles;
pub use dots::Dots;
pub use flat::{Backlit, FlatField};
pub use grid::GridSize;

/// A chart: the closed list.
#[derive(Clone, Debug, PartialEq)]
pub enum Chart {
    /// Black dots in a square lattice.
    Dots(Dots),
    /// A checkerboard.
    Checkerboard(Checkerboard),
    /// Circles to calibrate with, in a square or a staggered lattice.
    Circles(Circles),
    /// An even white sheet in even light.
    FlatField(FlatField),
    /// An even panel that shines by itself.
    Backlit(Backlit),
}

impl Chart {
    /// Its name on the command line.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Dots(_) => "dots",
            Self::Checkerboard(_) => "checkerboard",
            Self::Circles(_) => "circles",
            Self::FlatField(_) => "flat-field",
            Self::Backlit(_) => "backlit",
        }
    }

    /// Draws it for what a camera sees.
    ///
    /// # Errors
    /// Where a size or number is one that the chart cannot have.
    pub fn draw(&self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        match self {
            Self::Dots(chart) => chart.draw(seen),
            Self::Checkerboard(chart) => chart.draw(seen),
            Self::Circles(chart) => chart.draw(seen),
            Self::FlatField(chart) => chart.draw(seen),
            Self::Backlit(chart) => Ok(chart.draw(seen)),
        }
    }
}

/// How far sheets reach beyond what the camera sees, as a share of it: blur and glare look there too.
const BLEED: f64 = 1.15;

/// Reflectance of white paper.
const WHITE: f64 = 0.9;
/// Reflectance of black ink.
const BLACK: f64 = 0.03;

/// A reflectance between 0 and 1.
fn share(option: &'static str, value: f64) -> Result<f64, ChartError> {
    let legal = (0.0..=1.0).contains(&value);
    legal.then_some(value).ok_or_else(|| ChartError::option(option, value, "expected a share, 0 … 1"))
}
