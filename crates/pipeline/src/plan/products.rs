//! The files that a camera delivers: images and their formats, ground truth between frames, between cameras and of objects.

use etendue_core::RawFormat;
use etendue_isp::{Mosaic, Processing};
use etendue_sensor::Sensor;

/// File format of a sensor's digital numbers unless another is requested.
#[must_use]
pub fn default_raw_format(sensor: Option<&Sensor>) -> RawFormat {
    if sensor.is_some_and(|sensor| sensor.delivered_bits() > 16) { RawFormat::Tiff } else { RawFormat::Png }
}

/// The extension of files of digital numbers.
#[must_use]
pub fn raw_extension(format: RawFormat) -> &'static str {
    match format {
        RawFormat::Png => "png",
        RawFormat::Tiff => "tif",
        RawFormat::Dng => "dng",
    }
}

/// Products of a camera; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Products {
    /// Spectral radiance.
    pub radiance: bool,
    /// Spectral irradiance on the sensor.
    pub irradiance: bool,
    /// Ghosts, as part of the irradiance.
    pub ghosts: bool,
    /// Variances of estimated quantities.
    pub variance: bool,
    /// Samples of each pixel, and the resulting variance relative to the sensor's.
    pub sampling: bool,
    /// Expected electrons.
    pub electrons: bool,
    /// Digital numbers.
    pub raw: bool,
    /// Their file format.
    pub raw_format: RawFormat,
    /// Components of each pixel's digital number.
    pub signal_breakdown: bool,
    /// The image.
    pub picture: bool,
    /// The images of all frames as a video.
    pub video: bool,
    /// Depth, normals, positions, identities.
    pub ground_truth: bool,
    /// Adds positions in the camera's frame to the ground truth.
    pub camera_space_position: bool,
    /// Effect of weather on each pixel.
    pub weather: bool,
    /// Adds the fraction of each pixel that near drops or flakes cover, if there is precipitation.
    pub cover: bool,
    /// Depth as 16-bit PNG, in digital numbers per metre.
    pub depth_png_per_m: Option<f64>,
    /// Origin and direction of each pixel's ray.
    pub rays: bool,
    /// Ground truth, rays and image of the rectified camera as well, by its focal length over the camera's.
    pub undistorted: Option<f64>,
    /// Flow, disparity and boxes.
    pub annotations: Annotations,
    /// Pose and projection in the formats of other programs.
    pub calibration_files: bool,
}

/// A product in the list of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListedProduct {
    /// Key that requests it.
    pub key: &'static str,
    /// Its name among the effects of a camera.
    pub name: &'static str,
    /// Name in the list of delivered products; `None` if it is included in another product's.
    pub text: Option<&'static str>,
    /// True if it is delivered.
    pub is_delivered: bool,
    /// True if it is a result by itself; a camera delivers at least one.
    pub is_result: bool,
    /// True if its key is boolean.
    pub is_flag: bool,
}

impl ListedProduct {
    /// A result that a boolean key requests.
    const fn flag(key: &'static str, name: &'static str, is_delivered: bool, text: &'static str) -> Self {
        Self { key, name, text: Some(text), is_delivered, is_result: true, is_flag: true }
    }

    /// A result whose key has a value other than true or false.
    const fn named(key: &'static str, name: &'static str, is_delivered: bool, text: &'static str) -> Self {
        Self { is_flag: false, ..Self::flag(key, name, is_delivered, text) }
    }

    /// Marks a product that modifies other results, or derives from them.
    const fn as_modifier(self) -> Self {
        Self { is_result: false, ..self }
    }
}

impl Products {
    /// All products, in a plan's order.
    #[must_use]
    pub fn list(&self) -> Vec<ListedProduct> {
        let (flag, named) = (ListedProduct::flag, ListedProduct::named);
        let annotations = &self.annotations;
        let raw = match self.raw_format {
            RawFormat::Png => "raw",
            RawFormat::Tiff => "raw TIFF",
            RawFormat::Dng => "raw DNG",
        };
        let ground_truth = match self.camera_space_position {
            true => "ground truth with positions in the camera's frame",
            false => "ground truth",
        };
        let silent = |product: ListedProduct| ListedProduct { text: None, ..product };
        let depth_png = self.depth_png_per_m.is_some();
        vec![
            flag("output.radiance", "spectral radiance", self.radiance, "radiance"),
            flag("output.irradiance", "spectral irradiance", self.irradiance, "irradiance"),
            flag("output.ghosts", "ghosts as a separate image", self.ghosts, "ghosts"),
            flag("output.variance", "variance", self.variance, "variance").as_modifier(),
            silent(flag("output.sampling", "samples per pixel", self.sampling, "")),
            flag("output.electrons", "electrons", self.electrons, "electrons"),
            flag("output.raw", "raw", self.raw, raw),
            flag("output.signal_breakdown", "signal breakdown", self.signal_breakdown, "signal_breakdown"),
            ListedProduct { is_flag: !self.video, ..flag("output.picture", "picture", self.picture, "picture") },
            named("output.video", "video", self.video, "video").as_modifier(),
            flag("output.ground_truth", "ground truth", self.ground_truth, ground_truth),
            silent(
                flag("output.camera_space_position", "positions in the camera's frame", self.camera_space_position, "")
                    .as_modifier(),
            ),
            flag("output.depth_png", "depth PNG", depth_png, "depth PNG"),
            flag("output.rays", "ray table", self.rays, "ray table"),
            flag("output.undistorted", "undistorted images", self.undistorted.is_some(), "undistorted copies of these")
                .as_modifier(),
            named("output.optical_flow", "optical flow", annotations.optical_flow.is_some(), "optical flow"),
            flag("output.scene_flow", "scene flow", annotations.scene_flow, "scene flow"),
            named("output.disparity_to", "disparity", annotations.disparity.is_some(), "disparity"),
            flag("output.boxes", "boxes", annotations.boxes, "boxes"),
            flag("output.tracks", "tracks", annotations.tracks, "tracks").as_modifier(),
            flag("output.cryptomatte", "Cryptomatte", annotations.cryptomatte, "Cryptomatte"),
            flag("output.weather", "weather layers", self.weather, "transmittance, airlight and cover"),
            flag("output.calibration_files", "calibration files", self.calibration_files, "calibration files")
                .as_modifier(),
        ]
    }

    /// Returns true if the spectral radiance is computed: it is delivered, or a product derives from it.
    #[must_use]
    pub fn needs_radiance(&self) -> bool {
        self.radiance
    }

    /// Returns true if nothing is delivered.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.is_empty_without("")
    }

    /// Returns true if nothing would be delivered without the result of a key.
    #[must_use]
    pub fn is_empty_without(&self, key: &str) -> bool {
        !self.list().iter().any(|product| product.is_delivered && product.is_result && product.key != key)
    }
}

/// Processing from raw to image.
#[derive(Clone, Debug)]
pub struct Development {
    /// Colour of each pixel of the filter array.
    pub mosaic: Mosaic,
    /// All steps.
    pub processing: Processing,
    /// File format of the image.
    pub format: PictureFormat,
}

/// File format of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Lossless.
    Png {
        /// Bits of a channel: 8, or 10 to 16 in a file of 16.
        bits: u32,
    },
    /// Lossy, 8 bits.
    Jpeg {
        /// 1 to 100.
        quality: u8,
    },
}

impl PictureFormat {
    /// File extension.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png { .. } => "png",
            Self::Jpeg { .. } => "jpg",
        }
    }

    /// Bits per channel.
    #[must_use]
    pub fn bits(self) -> u32 {
        match self {
            Self::Png { bits } => bits,
            Self::Jpeg { .. } => 8,
        }
    }
}

/// File of flow or disparity in addition to the EXR.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CorrespondenceFormat {
    /// None: the EXR holds it.
    Exr,
    /// `.flo` and `.pfm`, all values exact.
    Middlebury,
    /// 16-bit PNG: flow in 1/64 px, disparity in 1/256 px.
    Kitti,
}

/// Disparity to another camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DisparityProduct {
    /// Index of the right camera in the job.
    pub right: u32,
    /// File in addition to the EXR.
    pub format: CorrespondenceFormat,
}

/// Ground truth between frames, between cameras and of objects that a camera delivers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Annotations {
    /// Optical flow to the next frame and the one before, with visibility and image velocity.
    pub optical_flow: Option<CorrespondenceFormat>,
    /// Motion in space, to both frames and in the world.
    pub scene_flow: bool,
    /// Disparity to a right camera.
    pub disparity: Option<DisparityProduct>,
    /// Boxes of objects.
    pub boxes: bool,
    /// Boxes of all frames in one file.
    pub tracks: bool,
    /// The coverage of objects and materials.
    pub cryptomatte: bool,
}

impl Annotations {
    /// Returns true if nothing is delivered.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns true if other frames of the camera are needed.
    #[must_use]
    pub fn needs_neighbours(&self) -> bool {
        self.optical_flow.is_some() || self.scene_flow
    }
}
