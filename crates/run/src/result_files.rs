//! Names of the files that a camera can deliver, and files that the user names one by one: plots, previews, camera files.

use etendue_core::RawFormat;
use etendue_core::quantity::Quantity;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{ExistingFiles, OutputFolder};
use etendue_pipeline::plan::{Development, PictureFormat, raw_extension};
use etendue_plan_report::tone_curve::encoding;
use serde_json::{Value, json};
use std::path::Path;

/// Content of a file: its quantity and unit.
pub(crate) fn entry(quantity: &str, unit: &str) -> Value {
    json!({ "quantity": quantity, "unit": unit })
}

/// [`entry`] of a core quantity.
pub(crate) fn entry_of<Q: Quantity>() -> Value {
    entry(Q::NAME, Q::UNIT)
}

/// Names and entries of the files that a camera can deliver.
#[derive(Clone, Copy, Debug)]
pub struct ResultFiles;

impl ResultFiles {
    /// Spectral radiance.
    pub const RADIANCE: &str = "radiance.exr";
    /// Spectral irradiance on the sensor plane.
    pub const IRRADIANCE: &str = "irradiance.exr";
    /// Ghosts, as part of the irradiance.
    pub const GHOSTS: &str = "ghosts.exr";
    /// Samples of each pixel and the resulting variance.
    pub const SAMPLING: &str = "sampling.exr";
    /// Mean electrons of each pixel.
    pub const ELECTRONS: &str = "electrons.exr";
    /// Fraction of light that the air transmits.
    pub const TRANSMITTANCE: &str = "transmittance.exr";
    /// Radiance scattered into the ray by the air.
    pub const AIRLIGHT: &str = "airlight.exr";
    /// Fraction of each pixel that near drops or flakes cover.
    pub const COVER: &str = "cover.exr";
    /// Depth, normals, positions and identities.
    pub const GROUND_TRUTH: &str = "ground_truth.exr";
    /// Planar depth as an image.
    pub const DEPTH: &str = "depth.png";
    /// Optical flow, visibility, image velocity and motion in space.
    pub const MOTION: &str = "motion.exr";
    /// Optical flow to the next frame, Middlebury.
    pub const FLOW_FLO: &str = "flow_forward.flo";
    /// Optical flow to the next frame, KITTI.
    pub const FLOW_PNG: &str = "flow_forward.png";
    /// Disparity and visibility.
    pub const DISPARITY: &str = "disparity.exr";
    /// Disparity as a float map (PFM).
    pub const DISPARITY_PFM: &str = "disparity.pfm";
    /// Disparity, KITTI.
    pub const DISPARITY_PNG: &str = "disparity.png";
    /// Boxes of objects.
    pub const BOXES: &str = "boxes.json";
    /// Boxes of objects over all frames.
    pub const TRACKS: &str = "tracks.json";
    /// Coverage of objects and materials.
    pub const CRYPTOMATTE: &str = "cryptomatte.exr";
    /// The images of all frames.
    pub const VIDEO: &str = "picture.y4m";
    /// The ray of each pixel.
    pub const RAYS: &str = "rays.exr";
    /// The side-car.
    pub const SIDECAR: &str = "camera.json";
    /// Raws and processing of the images of `develop`.
    pub const DEVELOPMENT: &str = "develop.json";

    /// Facts of a frame with its own light: its times, its poses, and the state of the sensor.
    #[must_use]
    pub fn frame(frame: u32) -> String {
        format!("frame.{frame:04}.json")
    }

    /// A file of light or ground truth of one frame: `radiance.0007.exr`.
    #[must_use]
    pub fn numbered(name: &str, frame: u32) -> String {
        let (stem, extension) = name.split_once('.').unwrap_or((name, ""));
        format!("{stem}.{frame:04}.{extension}")
    }

    /// The raw image of a frame.
    #[must_use]
    pub fn raw(frame: u32, format: RawFormat) -> String {
        format!("raw.{frame:04}.{}", raw_extension(format))
    }

    /// Components of the raw image of a frame.
    #[must_use]
    pub fn signal_breakdown(frame: u32) -> String {
        format!("signal_breakdown.{frame:04}.exr")
    }

    /// The developed image of a frame.
    #[must_use]
    pub fn picture(frame: u32, format: PictureFormat) -> String {
        format!("picture.{frame:04}.{}", format.extension())
    }

    /// Content of a frame's image, and the encoding of its numbers.
    #[must_use]
    pub fn picture_entry(development: &Development) -> Value {
        let encoding = encoding(&development.processing.tone);
        let mut entry = entry(&format!("{} picture", encoding.name()), &format!("{} bits", development.format.bits()));
        entry["encoding"] = encoding.to_json();
        entry
    }

    /// A file of the rectified camera.
    #[must_use]
    pub fn undistorted(name: &str) -> String {
        format!("undistorted/{name}")
    }
}

/// Writes a file and its parent folders; a failed write leaves no partial file.
///
/// # Errors
/// The file cannot be written, or exists and must not be replaced.
pub fn write_file(path: &Path, bytes: &[u8], existing: ExistingFiles) -> Result<(), Error> {
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| {
        Error::coded(ErrorCode::InvalidArgument, format!("{}: expected the name of a file", path.display()))
    })?;
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut folder = OutputFolder::open_beside(parent, existing).map_err(Error::input)?;
    folder.write(name, bytes).map_err(Error::input)?;
    folder.commit().map_err(|error| Error::Run(error.to_string())).map(|_| ())
}
