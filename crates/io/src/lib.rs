//! Files of Étendue: reading assets, writing results, looking into files.
//!
//! | direction | what | where |
//! | --- | --- | --- |
//! | in | Wavefront OBJ with its MTL, glTF 2.0, PLY | [`mesh`] |
//! | in | PNG, JPEG, Radiance HDR, OpenEXR images | [`picture`] |
//! | in | PNG, JPEG, TIFF, OpenEXR and raw images to be measured | [`photograph`] |
//! | in | EXIF data of images | [`exif`] |
//! | in | measured lamps: IES LM-63, EULUMDAT | [`photometry`] |
//! | in | lens prescriptions: Zemax, CODE V | [`prescription`] |
//! | in | tables over a lens's field: Zemax | [`lens_table`] |
//! | in | ray-transfer functions of lenses: ISET | [`ray_transfer`] |
//! | in | calibrated cameras: OpenCV, ROS, Kalibr, COLMAP, OCamCalib | [`calibration`] |
//! | in | spectra, refractive indices, coefficients of retro-reflection | [`spectrum`], [`mod@table`] |
//! | out and in | tiles of textures that are too large for memory | [`tile_cache`] |
//! | in | all files that a description names, with all errors at once | [`assets`] |
//! | out and in | spectral EXR (layout of Fichet, Pacanowski and Wilkie 2021) | [`exr`] |
//! | out | ground-truth EXR, planes as EXR, raw, depth and display PNG, raw TIFF and DNG, side-car JSON | [`exr`], [`png`], [`mod@tiff`], [`sidecar`] |
//! | out | optical flow and disparity in the files of the benchmarks | [`correspondence`] |
//! | out | videos without compression | [`y4m`] |
//! | out | calibrated cameras and their poses, in the formats of ROS, Kalibr and COLMAP | [`calibration::export`] |
//! | look | two results, channel by channel | [`compare`] |
//! | look | content of a file, with an image of it | [`inspect`] |
//!
//! Encoders are pure: the same values give the same bytes, on any number of threads, without clock time. Results reach the disk through an [`OutputFolder`]
//! alone, which refuses to overwrite, writes under temporary names and renames when everything is complete.
//!
//! This crate renders nothing and holds no policy; it never prints and starts no threads.

pub mod assets;
pub mod calibration;
pub mod compare;
pub mod correspondence;
pub mod emva_descriptor;
mod encoding;
pub mod error;
pub mod escape;
pub mod exif;
pub mod exr;
pub mod failure;
mod folder_lock;
pub mod hash;
pub mod inspect;
pub mod jpeg;
pub mod lens_table;
pub mod mesh;
pub mod named_file;
pub mod output;
pub mod paths;
pub mod photograph;
pub mod photometry;
pub mod picture;
pub mod png;
pub mod prescription;
pub mod provenance;
pub mod ray_transfer;
mod run_mark;
mod sandbox;
mod scratch;
pub mod sidecar;
pub mod source;
pub mod spectrum;
pub mod table;
mod texture_memory;
pub mod tiff;
pub mod tile_cache;
pub mod trajectory;
mod tree;
pub mod y4m;

pub use etendue_scene::{ErrorCode, Problem};

pub use assets::{complete_assets, load_assets};
pub use error::{Error, is_decoding};
pub use hash::FileDigest;
pub use output::{ExistingFiles, OutputFolder};
pub use provenance::Provenance;
pub use sandbox::Sandbox;
pub use scratch::ScratchFolder;
pub use source::read_regular;
pub use texture_memory::TextureMemory;
pub use tile_cache::CacheUse;
