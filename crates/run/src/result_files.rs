//! The names of the files that a camera can deliver.
//! Also files that the user names one by one: plots, previews, camera files.

use etendue_core::RawFormat;
use etendue_core::quantity::Quantity;
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{Existing, OutputFolder};
use etendue_pipeline::plan::{Development, PictureFormat, raw_extension};
use etendue_plan_report::tone_curve::encoding;
use serde_json::{Value, json};
use std::path::Path;

/// What a file holds: its quantity and unit.
pub(crate) fn entry(quantity: &str, unit: &str) -> Value {
    json!({ "quantity": quantity, "unit": unit })
}

/// [`entry`] of a quantity of the core.
pub(crate) fn entry_of<Q: Quantity>() -> Value {
    entry(Q::NAME, Q::UNIT)
}

/// Names and entries of the files that a camera can deliver.
#[derive(Clone, Copy, Debug)]
pub struct Files;

impl Files {
    /// Spectral radiance.
    pub const RADIANCE: &str = "radiance.exr";
    /// Spectral irradiance on the sensor plane.
    pub const IRRADIANCE: &str = "irradiance.exr";
    /// The part of the irradiance that is ghosts.
    pub const GHOSTS: &str = "ghosts.exr";
    /// Samples of each pixel and the variance that they leave.
    pub const SAMPLING: &str = "sampling.exr";
    /// Mean electrons of each pixel.
    pub const ELECTRONS: &str = "electrons.exr";
    /// The share of light that comes through the air.
    pub const TRANSMITTANCE: &str = "transmittance.exr";
    /// The part of the radiance that the air scattered in.
    pub const AIRLIGHT: &str = "airlight.exr";
    /// The share of each pixel that near drops or flakes cover.
    pub const COVER: &str = "cover.exr";
    /// Depth, normals, positions and identities.
    pub const GROUND_TRUTH: &str = "ground_truth.exr";
    /// Planar depth as a picture.
    pub const DEPTH: &str = "depth.png";
    /// Optical flow, visibility, image velocity and motion in space.
    pub const MOTION: &str = "motion.exr";
    /// Optical flow to the next frame, Middlebury.
    pub const FLOW_FLO: &str = "flow_forward.flo";
    /// Optical flow to the next frame, KITTI.
    pub const FLOW_PNG: &str = "flow_forward.png";
    /// Disparity and visibility.
    pub const DISPARITY: &str = "disparity.exr";
    /// Disparity as a float map.
    pub const DISPARITY_PFM: &str = "disparity.pfm";
    /// Disparity, KITTI.
    pub const DISPARITY_PNG: &str = "disparity.png";
    /// Boxes of objects.
    pub const BOXES: &str = "boxes.json";
    /// Boxes of objects over all frames.
    pub const TRACKS: &str = "tracks.json";
    /// Coverage of objects and materials.
    pub const CRYPTOMATTE: &str = "cryptomatte.exr";
    /// The pictures of all frames.
    pub const VIDEO: &str = "picture.y4m";
    /// The ray of each pixel.
    pub const RAYS: &str = "rays.exr";
    /// The side-car.
    pub const SIDECAR: &str = "camera.json";
    /// What `develop` made of which raw.
    pub const DEVELOPMENT: &str = "develop.json";

    /// What a frame is, where each has a light of its own: its times, its poses, and what the sensor remembers.
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

    /// The raw picture of a frame.
    #[must_use]
    pub fn raw(frame: u32, format: RawFormat) -> String {
        format!("raw.{frame:04}.{}", raw_extension(format))
    }

    /// What the raw picture of a frame is made of.
    #[must_use]
    pub fn signal_breakdown(frame: u32) -> String {
        format!("signal_breakdown.{frame:04}.exr")
    }

    /// The picture of a frame.
    #[must_use]
    pub fn picture(frame: u32, format: PictureFormat) -> String {
        format!("picture.{frame:04}.{}", format.extension())
    }

    /// What the picture of a frame holds, and how its numbers are encoded.
    #[must_use]
    pub fn picture_entry(development: &Development) -> Value {
        let encoding = encoding(&development.processing.tone);
        let mut entry = entry(&format!("{} picture", encoding.name()), &format!("{} bits", development.format.bits()));
        entry["encoding"] = encoding.to_json();
        entry
    }

    /// A file of the undistorted twin.
    #[must_use]
    pub fn undistorted(name: &str) -> String {
        format!("undistorted/{name}")
    }
}

/// Writes a file and the folders that lead to it; never half of it.
///
/// # Errors
/// Where it cannot be written, or is there and must not be replaced.
pub fn write_file(path: &Path, bytes: &[u8], existing: Existing) -> Result<(), Error> {
    let name = path.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| {
        Error::coded(ErrorCode::InvalidArgument, format!("{}: expected the name of a file", path.display()))
    })?;
    let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut folder = OutputFolder::open_beside(parent, existing).map_err(Error::input)?;
    folder.write(name, bytes).map_err(Error::input)?;
    folder.commit().map_err(|error| Error::Run(error.to_string())).map(|_| ())
}
