//! `[output]`: files that are written. `None` means that the plan decides.

use crate::place::Placed;
use crate::reader::{Rule, choice, either, flag, number, record, text, variant, words};
use etendue_core::RawFormat;

record! {
    /// Files that are written.
    pub struct Output {
        /// Spectral radiance at the entrance pupil (route "pupil"), EXR, for `etendue expose`. Default: true without electronics.
        optional radiance: Placed<bool> = flag();
        /// Spectral irradiance on the sensor plane, EXR. Default: false.
        optional irradiance: Placed<bool> = flag();
        /// Irradiance of the ghosts, EXR; needs ghosts = true in `[effects]`. Default: false.
        optional ghosts: Placed<bool> = flag();
        /// Variance of the means, EXR; needs two replicates or more. Default: false.
        optional variance: Placed<bool> = flag();
        /// Samples per pixel, Monte Carlo and sensor-noise variance, EXR; needs electrons or "noise_threshold". Default: false.
        optional sampling: Placed<bool> = flag();
        /// Expected electrons, EXR. Default: false.
        optional electrons: Placed<bool> = flag();
        /// Digital numbers. Default: true with electronics.
        optional raw: Placed<bool> = flag();
        /// Format of the digital numbers. Default: "png", or "tiff" above 16 bits.
        optional raw_format: Placed<RawFormat> = choice();
        /// Components of each digital number in electrons, EXR. Default: false.
        optional signal_breakdown: Placed<bool> = flag();
        /// The processed image. Default: true with `[isp]`.
        optional picture: Placed<bool> = flag();
        /// Depth, distance, normals, positions and identities, EXR. Default: true.
        optional ground_truth: Placed<bool> = flag();
        /// With "ground_truth": position in the camera's frame (m; x right, y down, z forward). Default: false.
        optional camera_space_position: Placed<bool> = flag();
        /// Transmittance, airlight and cover by weather, EXR; renders the light once more. Default: false.
        optional weather: Placed<bool> = flag();
        /// Depth as 16-bit PNG. Default: false.
        optional depth_png: Placed<bool> = flag();
        /// With "depth_png": digital numbers per metre; "kitti" 256, "ros" 1 000, "tum" 5 000. Default: "kitti".
        optional depth_png_scale: DepthScale = depth_scale();
        /// Origin (m) and direction of each pixel's principal ray in the camera's frame, EXR. Default: false.
        optional rays: Placed<bool> = flag();
        /// Ground truth, rays and image of the rectilinear twin, for cameras below 85° from the axis. Default: false.
        optional undistorted: Placed<bool> = flag();
        /// With "undistorted": focal length of the twin over the camera's. Default: 1.
        optional undistorted_scale: Placed<f64> = number("").above(0.0);
        /// Optical flow to the next and previous frame (px), visibility and image velocity (px/s), "motion.exr"; "middlebury" and "kitti" add .flo or PNG.
        /// Needs `[sequence]`.
        optional optical_flow: Placed<CorrespondenceFormat> = choice();
        /// Scene flow to the next and previous frame (m) and world velocity (m/s), "motion.exr". Needs `[sequence]`. Default: false.
        optional scene_flow: Placed<bool> = flag();
        /// Right camera of a rectified pair: writes disparity (px) and visibility, "disparity.exr".
        optional disparity_to: Placed<String> = text("the name of the right camera");
        /// With "disparity_to": "middlebury" and "kitti" add .pfm or PNG. Default: "exr".
        optional disparity_format: Placed<CorrespondenceFormat> = choice();
        /// Boxes of objects in image and space, with visible fractions, JSON. Default: false.
        optional boxes: Placed<bool> = flag();
        /// With "boxes": boxes of all frames by object, "tracks.json". Default: false.
        optional tracks: Placed<bool> = flag();
        /// Coverage by objects and materials, at most 64 samples, "cryptomatte.exr" (Psyop 1.2). Default: false.
        optional cryptomatte: Placed<bool> = flag();
        /// All images as "picture.y4m"; needs `[sequence]` and 8-bit PNG images.
        optional video: Placed<VideoFormat> = choice();
        /// Files for ROS, Kalibr and COLMAP in the folder "calibration". Default: false.
        optional calibration_files: Placed<bool> = flag();
    }
}

words! {
    /// File formats of optical flow or disparity.
    pub enum CorrespondenceFormat {
        /// EXR.
        "exr" => Exr,
        /// EXR, and .flo (flow) or .pfm (disparity) of 32-bit floats.
        "middlebury" => Middlebury,
        /// EXR, and 16-bit PNG: flow in 1/64 px up to ±512 px, disparity in 1/256 px up to 256 px.
        "kitti" => Kitti,
    }
}

words! {
    /// A video file format.
    pub enum VideoFormat {
        /// YUV4MPEG2: uncompressed, 8 bits, 4:4:4, the matrix of ITU-R BT.709 in limited range.
        "y4m" => Y4m,
    }
}

/// Scale of depth in a PNG.
#[derive(Clone, Debug)]
pub enum DepthScale {
    /// Numbers per metre.
    PerMetre(Placed<f64>),
    /// The convention of a data set.
    Named(Placed<DepthConvention>),
}

words! {
    /// The depth convention of a data set.
    pub enum DepthConvention {
        /// 256 per metre.
        "kitti" => Kitti,
        /// 1 000 per metre.
        "ros" => Ros,
        /// 5 000 per metre.
        "tum" => Tum,
    }
}

impl DepthScale {
    /// Numbers per metre.
    #[must_use]
    pub fn per_metre(&self) -> f64 {
        match self {
            Self::PerMetre(v) => v.value,
            Self::Named(name) => match name.value {
                DepthConvention::Kitti => 256.0,
                DepthConvention::Ros => 1000.0,
                DepthConvention::Tum => 5000.0,
            },
        }
    }
}

fn depth_scale() -> impl Rule<Out = DepthScale> {
    either(variant!(number("1/m").above(0.0), DepthScale::PerMetre), variant!(choice(), DepthScale::Named))
}
