//! `[output]`: files that are written. `None` means that the plan decides.

use crate::place::Placed;
use crate::reader::{Rule, choice, either, flag, number, record, text, variant, words};
use etendue_core::RawFormat;

record! {
    /// Files that are written.
    pub struct Output {
        /// Spectral radiance at the entrance pupil, spectral EXR, rendered with route "pupil": the input of `etendue expose`. Default: true for a
        /// sensor without electronics, else false.
        optional radiance: Placed<bool> = flag();
        /// Spectral irradiance on the sensor plane, spectral EXR. Default: false.
        optional irradiance: Placed<bool> = flag();
        /// The ghosts' part of the irradiance, spectral EXR; needs ghosts = true in `[effects]`. Default: false.
        optional ghosts: Placed<bool> = flag();
        /// Variance of the mean of the estimated quantities, EXR; needs two replicates or more. Default: false.
        optional variance: Placed<bool> = flag();
        /// Number of samples per pixel (layer "samples"), variance of the pixel's mean from them ("monte_carlo_variance") and, where pixels sum
        /// electrons, variance of the sensor's noise in one frame ("sensor_variance"), EXR; of the first capture. Variances are in e⁻² of the
        /// described exposure, or (W/m²)² of irradiance without electrons. They need pixels that sum electrons, or "noise_threshold". Default: false.
        optional sampling: Placed<bool> = flag();
        /// Expected electrons of each pixel, EXR. Default: false.
        optional electrons: Placed<bool> = flag();
        /// Digital numbers, in the format of "raw_format". Default: true for a sensor with electronics.
        optional raw: Placed<bool> = flag();
        /// File format of the digital numbers. Default: "png", or "tiff" where they have more than 16 bits.
        optional raw_format: Placed<RawFormat> = choice();
        /// Components of each pixel's digital number, one layer each, in electrons, EXR. Default: false.
        optional signal_breakdown: Placed<bool> = flag();
        /// The processed image, 8-bit PNG. Default: true for a camera with `[isp]`.
        optional picture: Placed<bool> = flag();
        /// Depth, distance, normals, positions and identities of the ground truth, EXR. Depth along the camera's axis is NaN where a pixel looks
        /// sideways, back or at a mirror; "camera_space_position" has a signed z there. Default: true.
        optional ground_truth: Placed<bool> = flag();
        /// With "ground_truth": adds the position in the camera's frame (m; x right, y down, z forward, negative behind the camera; from the centre
        /// of the entrance pupil), layers "P_camera.X", ".Y" and ".Z". Default: false.
        optional camera_space_position: Placed<bool> = flag();
        /// Effect of weather on each pixel, in a scene with `[[media]]` or `[precipitation]`. "transmittance.exr": fraction of light at 587.56 nm
        /// that comes unscattered from the first surface; "airlight.exr": spectral radiance scattered in before that surface; with precipitation
        /// "cover.exr": fraction of pixel and exposure that near drops or flakes cover. In the raster of "radiance". Takes the time of the light once
        /// more. Default: false.
        optional weather: Placed<bool> = flag();
        /// Depth as 16-bit PNG. Default: false.
        optional depth_png: Placed<bool> = flag();
        /// With "depth_png": digital numbers per metre, above 0, or the convention of a data set: "kitti" (256 per m), "ros" (1 000 per m), "tum" (5
        /// 000 per m). Default: "kitti".
        optional depth_png_scale: DepthScale = depth_scale();
        /// Origin (m) and unit direction of each pixel's principal ray in the camera's frame, EXR. With the distance of the ground truth they give
        /// the position of any pixel in space. Default: false.
        optional rays: Placed<bool> = flag();
        /// Ground truth, rays and image of the rectilinear twin with the same pose and pupil, in a folder "undistorted". The side-car states its
        /// camera matrix. Not available for cameras that see 85° from the axis or more. Default: false.
        optional undistorted: Placed<bool> = flag();
        /// With "undistorted": focal length of the twin over the camera's own, above 0; below 1 it shows more of an image with barrel distortion.
        /// Default: 1.
        optional undistorted_scale: Placed<f64> = number("").above(0.0);
        /// Optical flow of each pixel to the next and to the previous frame (px), its visibility there, and the velocity of its image (px/s): layers
        /// "flow", "visibility" and "motion_vector" of "motion.exr". Needs `[sequence]`. "exr": these alone; "middlebury", "kitti": also the flow to
        /// the next frame as .flo or 16-bit PNG. Default: none.
        optional optical_flow: Placed<CorrespondenceFormat> = choice();
        /// Scene flow of each pixel to the next and to the previous frame (m, cameras' frames) and velocity in the world (m/s): layers "scene_flow"
        /// and "velocity" of "motion.exr". Needs `[sequence]`. Default: false.
        optional scene_flow: Placed<bool> = flag();
        /// Name of the right camera of a pair rectified with this one. Writes the disparity of each pixel (px; how much farther left the right camera
        /// sees its point) and its visibility there, "disparity.exr". Default: none.
        optional disparity_to: Placed<String> = text("the name of the right camera");
        /// With "disparity_to": "exr", that file alone; "middlebury", "kitti": also .pfm or 16-bit PNG. Default: "exr".
        optional disparity_format: Placed<CorrespondenceFormat> = choice();
        /// Boxes of the objects, in the image (visible part, and whole object) and in space, with the visible fraction and the fraction within the
        /// image, JSON. Default: false.
        optional boxes: Placed<bool> = flag();
        /// With "boxes": also the boxes of all frames of the run in one file, by object, "tracks.json". Default: false.
        optional tracks: Placed<bool> = flag();
        /// Coverage of each pixel by objects and materials, through the lens and over the exposure, by as many samples as the light has (64 at most):
        /// "cryptomatte.exr", Psyop's specification 1.2. Default: false.
        optional cryptomatte: Placed<bool> = flag();
        /// Images of all frames of the run as one video, "picture.y4m"; needs `[isp]` with 8-bit PNG images, and `[sequence]`. Default: none.
        optional video: Placed<VideoFormat> = choice();
        /// Pose and projection of this camera for other programs: files for ROS, Kalibr and COLMAP, of all cameras with this key, in the folder
        /// "calibration" next to the cameras' own. Default: false.
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
