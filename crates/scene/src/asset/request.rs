//! A file that a description names, and what it is read as.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::calibration::CalibrationChoice;
use super::lens_table::LensQuantity;
use crate::place::Place;

/// A file to be read, and where it is named.
#[derive(Clone, Debug, PartialEq)]
pub struct AssetRequest {
    /// The file, relative to where the job is read from: the key in [`super::Assets`].
    pub path: PathBuf,
    /// What it is read as.
    pub kind: AssetKind,
    /// Where it is named.
    pub place: Place,
    /// Of a mesh: which of its own materials nobody sees.
    pub covered: Covered,
}

/// Materials that a mesh's file gives its slots and that nobody sees, because the scene gives those slots others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Covered {
    /// All of them.
    All,
    /// Those of these names.
    Slots(BTreeSet<String>),
}

impl Covered {
    pub(super) const NONE: Self = Self::Slots(BTreeSet::new());

    /// Whether the material of a slot is covered.
    #[must_use]
    pub fn has(&self, slot: &str) -> bool {
        match self {
            Self::All => true,
            Self::Slots(slots) => slots.contains(slot),
        }
    }

    /// What both cover.
    pub(crate) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::All, covered) | (covered, Self::All) => covered,
            (Self::Slots(a), Self::Slots(b)) => Self::Slots(a.intersection(&b).cloned().collect()),
        }
    }
}

/// What a file is read as.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AssetKind {
    /// [`super::MeshAsset`].
    Mesh,
    /// [`super::MeshFrameAsset`].
    MeshFrame,
    /// [`super::ImageAsset`].
    Image,
    /// [`super::ImageAsset`] that is laid over surfaces, or [`super::LargeImage`].
    Texture,
    /// [`super::SpectrumAsset`] of such values.
    Spectrum(Values),
    /// [`super::PhotometryAsset`].
    Photometry,
    /// [`super::ComplexIndexAsset`].
    ComplexIndex,
    /// [`super::RetroTableAsset`].
    RetroTable,
    /// [`super::NumbersAsset`].
    Numbers,
    /// [`super::PrescriptionAsset`].
    Prescription,
    /// [`super::RayTransferAsset`].
    RayTransfer,
    /// [`super::TrajectoryAsset`].
    Trajectory,
    /// [`super::LensTableAsset`] of this quantity.
    LensTable(LensQuantity),
    /// [`super::PointSpreadAsset`].
    PointSpread,
    /// [`super::CalibrationAsset`] of this camera.
    Calibration(CalibrationChoice),
}

/// What the values of a tabulated spectrum can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// A share of light or of photons, 0 … 1.
    Share,
    /// Light, or a coefficient of absorption, 0 or more.
    Light,
    /// A refractive index, 1 … 4.
    Index,
}

impl Values {
    /// Whether a value is one of these.
    #[must_use]
    pub fn admit(self, value: f64) -> bool {
        match self {
            Self::Share => (0.0..=1.0).contains(&value),
            Self::Light => value >= 0.0,
            Self::Index => (1.0..=4.0).contains(&value),
        }
    }

    /// What they are, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Share => "a share between 0 and 1",
            Self::Light => "0 or more",
            Self::Index => "a refractive index from 1 to 4",
        }
    }
}
