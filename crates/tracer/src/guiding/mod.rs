//! Path guiding: diffuse surfaces scatter paths towards the directions from which light was found.
//!
//! A spatial-directional histogram. Before an image is rendered some paths are traced without a guide, and the radiance they find behind their first
//! diffuse surfaces is stored by place and direction ([`Training`]). From this a [`Guide`] is built, which no longer changes. A diffuse surface then
//! samples directions by a density that follows it. The density is known for every direction and is nowhere less than a fifth of the cosine's, so no
//! mean changes, and sampled lights are weighted against it by multiple importance sampling as before.
//!
//! - **Places** are cubes whose side grows with the distance from the camera, in steps of two, and ranges of normals
//!   (`place.rs`). If there were few paths, cubes four times as wide are used.
//! - **Directions** fall into 128 bins of equal cosine-weighted solid angle about the normal (`distribution.rs`). A uniform
//!   density is thus the one without a guide, and points that are stratified on the square stay so.
//! - **The learnt value** is the root of the mean square of the radiance of a direction, as estimated by one path with its whole tail. Of all
//!   densities in such bins it is the one of least variance (Rath et al. 2020, "Variance-aware path guiding", eq. 6), used instead of the mean
//!   (Müller, Gross and Novák 2017).
//! - **The same bits on any number of threads**: sums are of integers, whose order does not matter.
//!
//! Left out: surfaces other than diffuse ones, whose lobes would have to be combined with it; scattering in media; vertices behind the second
//! scattering; and refinement by guided paths.

mod distribution;
mod guide;

pub use guide::{Guide, Training};

pub(crate) use distribution::{DirectionDistribution, bin_of};
pub(crate) use guide::GuideCell;

/// Scattering events up to which surfaces guide.
pub(crate) const GUIDED_BOUNCES: u32 = 2;
