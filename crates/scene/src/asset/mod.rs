//! Contents of the files that a description names: inert data, filled by the reader of the files.

mod calibration;
pub(crate) mod file_list;
mod large_image;
mod lens_table;
mod mesh;
mod mesh_frame;
mod mtl;
mod mtl_layers;
mod photometry;
mod point_spread;
mod prescription;
mod ray_transfer;
pub(crate) mod request;
mod slot_layers;
mod store;
mod table;
mod trajectory;

pub use calibration::{CalibrationAsset, CalibrationChoice, CalibrationFormat};
pub use large_image::{LargeImage, PixelFormat, PixelRows, RowReceiver, TexelStore};
pub use lens_table::{LensNumbers, LensQuantity, LensTableAsset, UndistortedProjection};
pub use mesh::{ColourMatrix, ImageAsset, ImagePixels, MeshAsset, SpectrumAsset};
pub use mesh_frame::{MeshFrameAsset, MeshFramePart};
pub use mtl::{COAT_INDICES, MtlFields, SlotMaterial, SlotReflectance, SlotSurface};
pub use mtl_layers::MtlPictures;
pub use photometry::{Opening, OpeningShape, PhotometryAsset, PhotometryAxes, Tilt};
pub use point_spread::{FieldPoint, PointSpreadAsset};
pub use prescription::{
    ASPHERE_TERMS, GlassAsset, GlassCatalogueAsset, LensFields, LensOpening, NamedGlass, PrescriptionAsset,
    SurfaceAsset,
};
pub use ray_transfer::{PassAsset, RayTransferAsset, TermAsset, TransferAsset};
pub use request::{AssetKind, AssetRequest, ReplacedMaterials, SpectrumValues};
pub use slot_layers::{
    SlotColour, SlotEmission, SlotLayers, SlotNumber, SlotPicture, SlotSolid, SlotTopLayer, SlotTransmission, SlotWrap,
    is_gltf,
};
pub use store::{Assets, layer_key};
pub use table::{ComplexIndexAsset, NumbersAsset, RetroTableAsset};
pub use trajectory::{TrajectoryAsset, TrajectoryRow};
