//! Contents of the files that a description names: inert data, filled by whoever reads files.

mod calibration;
mod mesh;
mod mtl;
mod photometry;
mod prescription;
mod request;
mod store;
mod table;

pub use calibration::{CalibrationAsset, CalibrationChoice, CalibrationFormat};
pub use mesh::{ImageAsset, ImagePixels, MeshAsset, SpectrumAsset};
pub use mtl::{COAT_INDICES, MtlFields, SlotMaterial, SlotReflectance, SlotSurface};
pub use photometry::{Opening, OpeningShape, PhotometryAsset, PhotometryAxes, Tilt};
pub use prescription::{GlassAsset, LensFields, LensOpening, PrescriptionAsset, SurfaceAsset};
pub use request::{AssetKind, AssetRequest, Covered, Values, of_camera};
pub(crate) use request::{names_files, requests};
pub use store::Assets;
pub use table::{ComplexIndexAsset, NumbersAsset, RetroTableAsset};
