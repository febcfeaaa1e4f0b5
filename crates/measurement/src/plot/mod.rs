//! Plots as SVG: one pair of axes, lines, points, error bars, a legend.
//!
//! Ranges follow from the data unless stated. The text of a plot depends on its data alone.

mod axis;
mod draw;
mod figure;
mod layout;
mod legend;

pub use draw::svg;
pub use figure::{Axis, Colour, Mark, Plot, Series};
