//! A file that a description names, and its kind.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::calibration::CalibrationChoice;
use super::lens_table::LensQuantity;
use crate::place::Place;

/// A file to be read, and the place where it is named.
#[derive(Clone, Debug, PartialEq)]
pub struct AssetRequest {
    /// The file, relative to the directory from which the job is read: the key in [`super::Assets`].
    pub path: PathBuf,
    /// Kind of content.
    pub kind: AssetKind,
    /// Place where it is named.
    pub place: Place,
    /// For a mesh: its own materials that are not visible.
    pub covered: ReplacedMaterials,
}

/// Materials of a mesh's file that are not visible, because the scene replaces them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReplacedMaterials {
    /// All of them.
    All,
    /// Those with these names.
    Slots(BTreeSet<String>),
}

impl ReplacedMaterials {
    pub(super) const NONE: Self = Self::Slots(BTreeSet::new());

    /// True if the material of a slot is covered.
    #[must_use]
    pub fn has(&self, slot: &str) -> bool {
        match self {
            Self::All => true,
            Self::Slots(slots) => slots.contains(slot),
        }
    }

    /// Returns the materials that both cover.
    pub(crate) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::All, covered) | (covered, Self::All) => covered,
            (Self::Slots(a), Self::Slots(b)) => Self::Slots(a.intersection(&b).cloned().collect()),
        }
    }
}

/// Kind of content of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AssetKind {
    /// [`super::MeshAsset`].
    Mesh,
    /// [`super::MeshFrameAsset`].
    MeshFrame,
    /// [`super::ImageAsset`].
    Image,
    /// [`super::ImageAsset`] of a layer, at the key [`super::layer_key`].
    ImageLayer(String),
    /// [`super::ImageAsset`] of a texture, or [`super::LargeImage`].
    Texture,
    /// [`super::SpectrumAsset`] of such values.
    Spectrum(SpectrumValues),
    /// [`super::PhotometryAsset`].
    Photometry,
    /// [`super::ComplexIndexAsset`].
    ComplexIndex,
    /// [`super::RetroTableAsset`].
    RetroTable,
    /// [`super::NumbersAsset`].
    Numbers,
    /// [`super::PrescriptionAsset`], its glasses searched first in these catalogues.
    Prescription(Vec<PathBuf>),
    /// [`super::GlassCatalogueAsset`].
    GlassCatalogue,
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

/// Range of the values of a tabulated spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpectrumValues {
    /// A fraction of light or of photons, 0 … 1.
    Share,
    /// Light, or an absorption coefficient, 0 or more.
    Light,
    /// A refractive index, 1 … 4.
    Index,
}

impl SpectrumValues {
    /// True if the value is in the range.
    #[must_use]
    pub fn admit(self, value: f64) -> bool {
        match self {
            Self::Share => (0.0..=1.0).contains(&value),
            Self::Light => value >= 0.0,
            Self::Index => (1.0..=4.0).contains(&value),
        }
    }

    /// The range, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Share => "a fraction from 0 to 1",
            Self::Light => "0 or more",
            Self::Index => "a refractive index from 1 to 4",
        }
    }
}
