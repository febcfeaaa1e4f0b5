//! What a camera delivers.

use super::annotations::Annotations;
use etendue_sensor::Sensor;

/// File format of digital numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawFormat {
    /// 16-bit PNG.
    Png,
    /// TIFF of 16 or 32 bits.
    Tiff,
    /// Digital Negative.
    Dng,
}

impl RawFormat {
    /// The one that a sensor's numbers have unless another is asked for.
    #[must_use]
    pub fn usual(sensor: Option<&Sensor>) -> Self {
        if sensor.is_some_and(|s| s.delivered_bits() > 16) { Self::Tiff } else { Self::Png }
    }

    /// The extension of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Tiff => "tif",
            Self::Dng => "dng",
        }
    }
}

/// What a camera delivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Products {
    /// Spectral radiance.
    pub radiance: bool,
    /// Spectral irradiance on the sensor.
    pub irradiance: bool,
    /// The part of the irradiance that is ghosts.
    pub ghosts: bool,
    /// Variances of what is estimated.
    pub variance: bool,
    /// Samples of each pixel, and the variance that they leave beside the sensor's.
    pub sampling: bool,
    /// Expected electrons.
    pub electrons: bool,
    /// Digital numbers.
    pub raw: bool,
    /// Their file format.
    pub raw_format: RawFormat,
    /// What each pixel's digital number is made of.
    pub signal_breakdown: bool,
    /// The picture.
    pub picture: bool,
    /// The pictures of all frames as a video.
    pub video: bool,
    /// Depth, normals, positions, identities.
    pub ground_truth: bool,
    /// Positions in the camera's frame with it.
    pub camera_space_position: bool,
    /// Depth as 16-bit PNG, by its numbers a metre.
    pub depth_png_per_m: Option<f64>,
    /// Origin and direction of each pixel's ray.
    pub rays: bool,
    /// Ground truth, rays and picture of the undistorted twin as well, by its focal length over the camera's.
    pub undistorted: Option<f64>,
    /// Flow, disparity and boxes.
    pub annotations: Annotations,
    /// Pose and projection in the files of other programs.
    pub calibration_files: bool,
}

impl Products {
    /// Whether nothing is delivered.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let light = self.radiance || self.irradiance || self.ghosts || self.electrons || self.sampling;
        let images = light || self.raw || self.picture || self.signal_breakdown;
        !(images || self.ground_truth || self.depth_png_per_m.is_some() || self.rays || !self.annotations.is_empty())
    }
}
