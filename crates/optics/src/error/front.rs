//! Errors of optics in front of a lens.

/// A front that is invalid, or that the camera cannot use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrontError {
    /// A number outside its range.
    #[error("{name} is {value}; it must be {range}")]
    Number {
        /// The key.
        name: &'static str,
        value: f64,
        /// The legal range.
        range: &'static str,
    },
    /// A fraction of light outside its range.
    #[error("{name} is {value} at some wavelength; it must stay within {range}")]
    Fraction {
        /// The key.
        name: &'static str,
        value: f64,
        /// The legal range.
        range: &'static str,
    },
    /// A sphere or ellipsoid smaller than the requested outer radius.
    #[error(
        "the mirror has rim_radius_mm = {rim_mm}, but its surface reaches only {reach_mm:.6} mm from its axis: give at most this radius"
    )]
    RimTooLarge {
        /// The requested outer radius, mm.
        rim_mm: f64,
        /// The largest radius of the surface, mm.
        reach_mm: f64,
    },
    /// A mirror consisting of its hole.
    #[error(
        "the mirror's hole_radius_mm = {hole_mm} leaves nothing of it within rim_radius_mm = {rim_mm}: make the hole smaller"
    )]
    NoSurface {
        hole_mm: f64,
        /// The outer radius, mm.
        rim_mm: f64,
    },
    /// A camera on the wrong side of the mirror.
    #[error(
        "the mirror is seen from inside: the camera is behind its reflecting side, which faces away from the mirror's axis and must face the \
         camera; move it farther (distance_mm) or turn it (rotation_deg)"
    )]
    SeenFromInside,
    /// A mirror outside the camera's view.
    #[error("no pixel of the image sees the mirror: move it nearer, turn it, or use a wider lens")]
    NotVisible,
    /// Glass without layers.
    #[error("the windscreen has no layers: give at least one, or leave them out for laminated glass")]
    NoLayers,
    /// A lens that reaches through the glass.
    #[error("the windscreen intersects the lens or is behind it: move it farther (distance_mm) or tilt it less")]
    ThroughLens,
    /// A lens that reaches beyond the dirt.
    #[error(
        "the dirt is inside the lens or behind its front: distance_mm is measured from the entrance pupil, which is behind the first surface; move \
         it farther, or tilt it less"
    )]
    DirtInLens,
    /// Faces that meet within the image.
    #[error(
        "some pixels look through the windscreen where its faces cross, or where light cannot leave it: make the wedge (wedge_mrad) smaller or the \
         middle layer thicker, or curve it less"
    )]
    FacesCross,
    /// Glass that no ray passes.
    #[error("no pixel of the image looks through the windscreen: turn it towards the view (tilt_deg, yaw_deg)")]
    NotLookedThrough,
    /// Drops beyond the glass.
    #[error(
        "the drops are where the curved windscreen has no surface: make their size_mm smaller or their offset_mm less"
    )]
    DropsOffGlass,
    /// Drops that are not in the image.
    #[error(
        "no pixel of the image looks through the drops' rectangle: move it (offset_mm) or make it larger (size_mm)"
    )]
    DropsNotSeen,
    /// A mask whose number of texels does not match its size.
    #[error("the mask has {texels} texels, but its size is {width} × {height}: correct its size")]
    MaskSize {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Texels found.
        texels: usize,
    },
    /// An invalid mesh.
    #[error("the mirror's mesh has {what}")]
    Mesh {
        /// Description of the problem.
        what: &'static str,
    },
}

/// Returns `value` if it is finite and above 0.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, FrontError> {
    let right = value.is_finite() && value > 0.0;
    if right { Ok(value) } else { Err(FrontError::Number { name, value, range: "finite and above 0" }) }
}
