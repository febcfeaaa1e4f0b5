//! The charts: the closed list, one file each.
//!
//! # Contract
//!
//! A design holds the options of its chart; what is left open follows from what the camera sees. [`Chart::draw`] answers
//! with sheets that partition their planes, inks, features and patches; nothing is drawn at random but by the seed.

mod checkerboard;
mod circles;
mod dead_leaves;
mod depth_wedge;
mod discs;
mod dots;
mod flare;
mod flat;
mod grid;
mod oecf_steps;
mod option;
mod patches;
mod points;
mod siemens_star;
mod slanted_edges;
mod slanted_star;

use crate::drawing::Drawing;
use crate::error::ChartError;
use crate::eye::Footprint;
use option::{BLACK, BLEED, WHITE, angle, contrast, is_measurable, share};

pub use checkerboard::Checkerboard;
pub use circles::Circles;
pub use dead_leaves::DeadLeaves;
pub use depth_wedge::DepthWedge;
pub use dots::Dots;
pub use flare::Flare;
pub use flat::{Backlit, FlatField};
pub use grid::GridSize;
pub use oecf_steps::OecfSteps;
pub use patches::{ColorChecker, ContrastPatches};
pub use points::Points;
pub use siemens_star::SiemensStar;
pub use slanted_edges::SlantedEdges;
pub use slanted_star::SlantedStar;

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
    /// Squares with slanted edges over the field.
    SlantedEdges(SlantedEdges),
    /// Stars of slanted wedges.
    SlantedStar(SlantedStar),
    /// A star of many cycles.
    SiemensStar(SiemensStar),
    /// Discs upon discs.
    DeadLeaves(DeadLeaves),
    /// Grey steps around a ring.
    OecfSteps(OecfSteps),
    /// 24 measured colours.
    ColorChecker(ColorChecker),
    /// Shining greys over decades.
    ContrastPatches(ContrastPatches),
    /// White with light traps.
    Flare(Flare),
    /// Small lamps in the dark.
    Points(Points),
    /// Panels at known distances.
    DepthWedge(DepthWedge),
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
            Self::SlantedEdges(_) => "slanted-edges",
            Self::SlantedStar(_) => "slanted-star",
            Self::SiemensStar(_) => "siemens-star",
            Self::DeadLeaves(_) => "dead-leaves",
            Self::OecfSteps(_) => "oecf-steps",
            Self::ColorChecker(_) => "colorchecker",
            Self::ContrastPatches(_) => "contrast-patches",
            Self::Flare(_) => "flare",
            Self::Points(_) => "points",
            Self::DepthWedge(_) => "depth-wedge",
        }
    }

    /// Draws it for what a camera sees.
    ///
    /// # Errors
    /// Where a size or number is one that the chart cannot have.
    pub fn draw(&self, seen: &Footprint, seed: u64) -> Result<Drawing, ChartError> {
        match self {
            Self::Dots(chart) => chart.draw(seen),
            Self::Checkerboard(chart) => chart.draw(seen),
            Self::Circles(chart) => chart.draw(seen),
            Self::FlatField(chart) => chart.draw(seen),
            Self::Backlit(chart) => Ok(chart.draw(seen)),
            Self::SlantedEdges(chart) => chart.draw(seen),
            Self::SlantedStar(chart) => chart.draw(seen),
            Self::SiemensStar(chart) => chart.draw(seen),
            Self::DeadLeaves(chart) => chart.draw(seen, seed),
            Self::OecfSteps(chart) => chart.draw(seen),
            Self::ColorChecker(chart) => chart.draw(seen),
            Self::ContrastPatches(chart) => chart.draw(seen),
            Self::Flare(chart) => chart.draw(seen),
            Self::Points(chart) => chart.draw(seen),
            Self::DepthWedge(chart) => chart.draw(seen, seed),
        }
    }
}
