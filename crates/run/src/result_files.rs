//! The files that a camera can deliver: their names, and what they hold.
//! Also files that the user names one by one: plots, previews, camera files.

use crate::results::{FileEntries, PRODUCT_FILES};
use etendue_core::RawFormat;
use etendue_core::quantity::{DigitalNumber, Quantity};
use etendue_io::failure::{Error, ErrorCode};
use etendue_io::{Existing, OutputFolder};
use etendue_pipeline::plan::{
    CameraBody, CameraPlan, Development, PictureFormat, Products, TimeDependence, raw_extension,
};
use etendue_plan_report::tone_curve::encoding;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::ops::Range;
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

    /// All files of a camera whose frames have one light, with what they hold.
    #[must_use]
    pub fn of(p: &Products, body: &CameraBody, frames: &Range<u32>) -> BTreeMap<String, Value> {
        let mut files = Self::of_light(p);
        files.extend(Self::of_frames(p, body, frames));
        files
    }

    /// All files of a camera of a plan over frames, with what they hold.
    #[must_use]
    pub fn of_camera(camera: &CameraPlan, frames: &Range<u32>) -> BTreeMap<String, Value> {
        let (p, body) = (&camera.products, &camera.body);
        if camera.time == TimeDependence::None {
            return Self::of(p, body, frames);
        }
        let mut files = Self::of_frames(p, body, frames);
        for (name, entry) in Self::of_light(p) {
            if Self::is_of_camera(&name) {
                files.insert(name, entry);
                continue;
            }
            files.extend(frames.clone().map(|frame| (Self::numbered(&name, frame), entry.clone())));
        }
        let facts = entry("times, poses and sensor of a frame", "");
        files.extend(frames.clone().map(|frame| (Self::frame(frame), facts.clone())));
        files
    }

    /// Whether a file tells of the camera or of all frames, and has no frame's number.
    pub(crate) fn is_of_camera(name: &str) -> bool {
        [Self::RAYS, Self::TRACKS].contains(&name) || name == Self::undistorted(Self::RAYS)
    }

    /// The files of light and ground truth.
    fn of_light(p: &Products) -> BTreeMap<String, Value> {
        let mut files = FileEntries::default();
        PRODUCT_FILES.iter().for_each(|product| (product.entries)(p, &mut files));
        files.add(
            p.annotations.tracks,
            Self::TRACKS,
            entry("boxes of objects over all frames, object by object", "px, m, s"),
        );
        files.add(p.rays, Self::RAYS, entry("origin and direction of each pixel's ray, camera frame", "m, 1"));
        let twin = p.undistorted.is_some();
        let planes = entry("depth, distance, normal, position, ids of the undistorted twin", "m, m, 1, m, 1");
        files.add(twin && p.ground_truth, &Self::undistorted(Self::GROUND_TRUTH), planes);
        let rays = entry("origin and direction of each pixel's ray of the undistorted twin, camera frame", "m, 1");
        files.add(twin && p.rays, &Self::undistorted(Self::RAYS), rays);
        files.0.into_iter().collect()
    }

    /// The files of photographs.
    fn of_frames(p: &Products, body: &CameraBody, frames: &Range<u32>) -> BTreeMap<String, Value> {
        let mut files = BTreeMap::new();
        let mut add = |wanted: bool, name: &str, entry: Value| {
            if wanted {
                files.insert(name.to_owned(), entry);
            }
        };
        let twin = p.undistorted.is_some();
        let format = body.picture_format();
        let picture = body.development.as_ref().map_or(Value::Null, Self::picture_entry);
        let video = entry("pictures of all frames, Y'CbCr of BT.709 in limited range, 4:4:4", "8 bits");
        add(p.video, Self::VIDEO, video);
        let mut undistorted = picture.clone();
        undistorted["quantity"] = format!("undistorted {}", picture["quantity"].as_str().unwrap_or_default()).into();
        for frame in frames.clone() {
            add(twin && p.picture, &Self::undistorted(&Self::picture(frame, format)), undistorted.clone());
            add(p.raw, &Self::raw(frame, p.raw_format), entry_of::<DigitalNumber>());
            add(
                p.signal_breakdown,
                &Self::signal_breakdown(frame),
                entry("causes of the digital number, one layer each", "e"),
            );
            add(p.picture, &Self::picture(frame, format), picture.clone());
        }
        files
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
