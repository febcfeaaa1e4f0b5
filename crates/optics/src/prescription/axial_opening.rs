//! How far the bundle on the axis opens, and what may limit it.

/// What becomes of a rim other than the stop's that clips the bundle on the axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OtherRims {
    /// The surfaces are no lens: that rim would be the stop.
    Refused,
    /// It clips, as rims and baffles of makers' files do: pupils and f-number are those of the bundle that is left, their places those of the
    /// stop's images.
    Clip,
}

/// How far the bundle on the axis opens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AxialOpening {
    /// Its radius at the entrance pupil over that of the stop's image.
    pub(super) share: f64,
    /// The surface whose rim limits it, where that is not the stop.
    pub(super) limit: Option<usize>,
}

impl AxialOpening {
    /// Limited by the stop.
    pub(super) const STOP: Self = Self { share: 1.0, limit: None };
}
