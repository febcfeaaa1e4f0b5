//! A table over a lens's field, as lens programs write it.

/// What a table over the field tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FieldQuantity {
    /// Irradiance over that on the axis.
    RelativeIllumination,
}

/// In what fields are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldUnit {
    /// Angles from the axis in front of the lens, degrees.
    Degrees,
    /// Distances from the axis in the picture, mm.
    Millimetres,
}

/// A quantity by the field.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldTableAsset {
    /// In what its fields are counted.
    pub unit: FieldUnit,
    /// Field, rising from 0, and value.
    pub points: Vec<(f64, f64)>,
    /// What was made of the file and what was passed over, a sentence each.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}
