//! Contents of the files that a description names: inert data, filled by whoever reads files.

mod mesh;
mod mtl;
mod request;
mod store;

pub use mesh::{ImageAsset, ImagePixels, MeshAsset, SpectrumAsset};
pub use mtl::{COAT_INDICES, MtlFields, SlotMaterial, SlotReflectance, SlotSurface};
pub(crate) use request::requests;
pub use request::{AssetKind, AssetRequest, Values, of_camera};
pub use store::Assets;
