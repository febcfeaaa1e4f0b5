//! Which effects a path may meet: code that is made for scenes without some of them.
//!
//! A path is compiled once for each row of the table; [`super::PathTracer`] takes the first that has all that its scene needs. What a row
//! leaves out is not there: no question is asked about it at a vertex. All rows give the same bits.
//!
//! | row | scenes |
//! | --- | --- |
//! | [`Matt`] | diffuse surfaces without textures, no media |
//! | [`Clear`] | all surfaces, no media |
//! | [`Every`] | all |

use crate::ALL_EFFECTS;

/// What a path may meet.
pub(super) trait Effects: Copy {
    /// What scatters light between surfaces: fog, drops, flakes.
    const MEDIA: bool;
    /// Surfaces other than diffuse ones of one spectrum each: other models, textures, mixes, opacity, transparent solids.
    const SURFACES: bool;
}

/// Which row a scene takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SceneEffects {
    /// [`Matt`].
    Matt,
    /// [`Clear`].
    Clear,
    /// [`Every`].
    Every,
}

/// All there is.
#[derive(Clone, Copy)]
pub(super) struct Every;

/// No media.
#[derive(Clone, Copy)]
pub(super) struct Clear;

/// Neither media nor surfaces other than diffuse ones.
#[derive(Clone, Copy)]
pub(super) struct Matt;

impl Effects for Every {
    const MEDIA: bool = ALL_EFFECTS;
    const SURFACES: bool = ALL_EFFECTS;
}

impl Effects for Clear {
    const MEDIA: bool = false;
    const SURFACES: bool = ALL_EFFECTS;
}

impl Effects for Matt {
    const MEDIA: bool = false;
    const SURFACES: bool = false;
}
