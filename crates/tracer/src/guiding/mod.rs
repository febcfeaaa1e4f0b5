//! Path guiding: matt surfaces scatter paths to where light was found to come from.
//!
//! A spatial-directional histogram. Before a picture is rendered some paths are followed as they would be without a guide, and what they find behind their first
//! matt surfaces is kept by place and direction ([`Training`]). Of that a [`Guide`] is made, which no longer changes. A matt surface then draws directions
//! by a density that follows it. As the density is known for every direction and nowhere less than a fifth of the cosine's, no mean
//! changes, and light that is drawn is weighed beside it by multiple importance sampling as ever.
//!
//! - **Places** are cubes whose side grows with the distance from the camera, in steps of two, and ranges of normals
//!   (`place.rs`): where few paths came, those of cubes four times as wide count.
//! - **Directions** fall into 128 bins of equal cosine-weighted solid angle about the normal (`distribution.rs`). So an even
//!   density is the one without a guide, and points that are stratified on the square stay so.
//! - **What is learnt** is the root of the mean square of what a direction brings, as estimated by one path with all that follows behind: of all
//!   densities in such bins the one of least variance (Rath et al. 2020, "Variance-aware path guiding", eq. 6), in the place of the mean
//!   (Müller, Gross and Novák 2017).
//! - **The same bits on any number of threads**: sums are of whole numbers, whose order does not matter.
//!
//! Left out: surfaces other than matt ones, whose lobes would have to be joined with it; scattering in media; vertices behind the
//! second scattering; and refinement by guided paths.

mod distribution;
mod guide;

pub use guide::{Guide, Training};

pub(crate) use distribution::{DirectionDistribution, bin_of};
pub(crate) use guide::Place;

/// Scattering events before which surfaces guide.
pub(crate) const GUIDED_BOUNCES: u32 = 2;
