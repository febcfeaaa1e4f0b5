//! The charts: the closed list, one file each.
//!
//! # Contract
//!
//! A design holds the options of its chart; omitted values follow from the camera's view. [`Chart::draw`] returns sheets that
//! partition their planes, inks, features and patches; random choices depend on the seed only.

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
use option::{BLACK, BLEED, WHITE, angle, contrast, is_measurable, reflectance_option};

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

/// The closed list of charts: description, design and name of each.
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

            /// Name on the command line and in its ground truth.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$Design(_) => $name,)*
                }
            }

            /// Draws the chart for a camera's view.
            ///
            /// # Errors
            /// If a size or number is not valid for the chart.
            pub fn draw(&self, footprint: &Footprint, seed: u64) -> Result<Drawing, ChartError> {
                match self {
                    $(Self::$Design(chart) => chart.draw(footprint, seed),)*
                }
            }
        }

        $(
            impl $Design {
                /// Name of the chart on the command line and in its ground truth.
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
    /// Circles for calibration, in a square or a staggered lattice.
    Circles "circles",
    /// A uniform white sheet in uniform light.
    FlatField "flat-field",
    /// A uniform self-luminous panel.
    Backlit "backlit",
    /// Squares with slanted edges over the field.
    SlantedEdges "slanted-edges",
    /// Stars of slanted wedges.
    SlantedStar "slanted-star",
    /// A star of many cycles.
    SiemensStar "siemens-star",
    /// Overlapping discs.
    DeadLeaves "dead-leaves",
    /// Grey steps around a ring.
    OecfSteps "oecf-steps",
    /// 24 measured colours.
    ColorChecker "colorchecker",
    /// Self-luminous greys over decades.
    ContrastPatches "contrast-patches",
    /// White with light traps.
    Flare "flare",
    /// Lamps of several frequencies and duty cycles.
    LedFlicker "led-flicker",
    /// Small lamps in the dark.
    Points "points",
    /// Panels at known distances.
    DepthWedge "depth-wedge",
}
