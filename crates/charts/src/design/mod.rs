//! The charts: the closed list, one file each.
//!
//! # Contract
//!
//! A design holds the options of its chart; what is left open follows from what the camera sees. [`Chart::draw`] answers
//! with sheets that partition their planes, inks, features and patches; nothing is drawn at random but by the seed.

mod checkerboard;
mod dead_leaves;
mod depth_wedge;
mod discs;
mod dots;
mod flat;
mod led_flicker;
mod option;
mod patches;
mod siemens_star;
mod slanted_edges;
mod slanted_star;

use crate::{drawing::Drawing, error::ChartError, ray_camera::Footprint};
use option::{BLACK, BLEED, WHITE, angle, contrast, is_measurable, share};

pub use checkerboard::{Checkerboard, GridSize};
pub use dead_leaves::DeadLeaves;
pub use depth_wedge::DepthWedge;
pub use dots::{Circles, Dots, Points};
pub use flat::{Backlit, Flare, FlatField};
pub use led_flicker::LedFlicker;
pub use patches::{ColorChecker, ContrastPatches, OecfSteps};
pub use siemens_star::SiemensStar;
pub use slanted_edges::SlantedEdges;
pub use slanted_star::SlantedStar;

/// The closed list of charts: what each shows, its design, its name.
macro_rules! charts {
    ($($(#[$about:meta])* $Design:ident $name:literal,)*) => {
        /// A chart: the closed list.
        #[derive(Clone, Debug, PartialEq)]
        pub enum Chart {
            $($(#[$about])* $Design($Design),)*
        }

        impl Chart {
            /// The names of all charts.
            pub const NAMES: &[&str] = &[$($name),*];

            /// Its name on the command line and in its truth.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$Design(_) => $name,)*
                }
            }

            /// Draws it for what a camera sees.
            ///
            /// # Errors
            /// If a size or number is one that the chart cannot have.
            pub fn draw(&self, seen: &Footprint, seed: u64) -> Result<Drawing, ChartError> {
                match self {
                    $(Self::$Design(chart) => chart.draw(seen, seed),)*
                }
            }
        }

        $(
            impl $Design {
                /// The chart's name on the command line and in its truth.
                pub const NAME: &str = $name;
            }

            impl From<$Design> for Chart {
                fn from(design: $Design) -> Self {
                    Self::$Design(design)
                }
            }
        )*
    };
}

charts! {
    /// Black dots in a square lattice.
    Dots "dots",
    /// A checkerboard.
    Checkerboard "checkerboard",
    /// Circles to calibrate with, in a square or a staggered lattice.
    Circles "circles",
    /// An even white sheet in even light.
    FlatField "flat-field",
    /// An even panel that shines by itself.
    Backlit "backlit",
    /// Squares with slanted edges over the field.
    SlantedEdges "slanted-edges",
    /// Stars of slanted wedges.
    SlantedStar "slanted-star",
    /// A star of many cycles.
    SiemensStar "siemens-star",
    /// Discs upon discs.
    DeadLeaves "dead-leaves",
    /// Grey steps around a ring.
    OecfSteps "oecf-steps",
    /// 24 measured colours.
    ColorChecker "colorchecker",
    /// Shining greys over decades.
    ContrastPatches "contrast-patches",
    /// White with light traps.
    Flare "flare",
    /// Lamps of several frequencies and duties.
    LedFlicker "led-flicker",
    /// Small lamps in the dark.
    Points "points",
    /// Panels at known distances.
    DepthWedge "depth-wedge",
}
