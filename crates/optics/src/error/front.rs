//! Why something cannot stand in front of a lens.

/// A front that cannot be, or that the camera cannot use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrontError {
    /// A number outside of its range.
    #[error("{name} is {value}; it must be {range}")]
    Number {
        /// The key.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// A fraction of light that is none.
    #[error("{name} is {value} at some wavelength; it must stay within {range}")]
    Share {
        /// The key.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// A sphere or ellipsoid that ends before its rim.
    #[error("the mirror has rim_radius_mm = {rim_mm}, but its surface reaches only {reach_mm:.6} mm from its axis")]
    RimTooLarge {
        /// The rim requested, mm.
        rim_mm: f64,
        /// How far the surface reaches, mm.
        reach_mm: f64,
    },
    /// Nothing is left of a mirror.
    #[error("the mirror's hole_radius_mm = {hole_mm} leaves nothing of it within rim_radius_mm = {rim_mm}")]
    AllHole {
        /// The hole, mm.
        hole_mm: f64,
        /// The rim, mm.
        rim_mm: f64,
    },
    /// The camera is on the wrong side of the mirror.
    #[error(
        "the mirror is seen from inside: the camera stands behind its reflecting side, which faces away from its axis and towards the camera; move it farther (distance_mm) or turn it (rotation_deg)"
    )]
    SeenFromInside,
    /// The camera does not look at the mirror.
    #[error("no pixel of the picture sees the mirror: bring it nearer, turn it, or use a wider lens")]
    NotVisible,
    /// Glass of nothing.
    #[error("the wind-screen has no layers: give at least one, or leave them out for laminated glass")]
    NoLayers,
    /// The lens reaches through the glass.
    #[error("the wind-screen cuts through the lens or stands behind it: move it farther (distance_mm) or tilt it less")]
    ThroughLens,
    /// The lens reaches beyond the dirt.
    #[error(
        "the dirt lies within the lens or behind its front: distance_mm counts from the entrance pupil, which lies behind the first \
         surface; move it farther, or tilt it less"
    )]
    DirtInLens,
    /// Faces that meet within the image.
    #[error(
        "the picture looks through the wind-screen where its faces cross, or where light cannot leave it: make the wedge (wedge_mrad) \
         smaller or the middle layer thicker, or curve it less"
    )]
    FacesCross,
    /// No ray goes through the glass.
    #[error("no pixel of the picture looks through the wind-screen: turn it towards the view (tilt_deg, yaw_deg)")]
    NotLookedThrough,
    /// Drops beyond the glass.
    #[error(
        "the drops lie where the curved wind-screen has no surface: make their size_mm smaller or their offset_mm less"
    )]
    DropsOffGlass,
    /// Drops that are not in the image.
    #[error(
        "no pixel of the picture looks through the drops' rectangle: move it (offset_mm) or make it larger (size_mm)"
    )]
    DropsNotSeen,
    /// A mask whose texels are not those of its size.
    #[error("the mask has {texels} texels, but its size is {width} × {height}")]
    MaskSize {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Texels found.
        texels: usize,
    },
    /// A mesh that is no surface.
    #[error("the mirror's mesh has {what}")]
    Mesh {
        /// What is wrong.
        what: &'static str,
    },
}

/// `value` where it is finite and above 0.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, FrontError> {
    let right = value.is_finite() && value > 0.0;
    if right { Ok(value) } else { Err(FrontError::Number { name, value, range: "finite and above 0" }) }
}
