//! `[output]`: what is written. `None` everywhere means: the plan decides.

use crate::place::Placed;
use crate::reader::{Rule, choice, either, flag, number, record, text, variant, words};
use etendue_core::RawFormat;

record! {
    /// What is written.
    pub struct Output {
        /// Spectral radiance at the entrance pupil, spectral EXR: what `etendue expose` takes, rendered with route "pupil".
        /// Default: true for a sensor without electronics, else false.
        optional radiance: Placed<bool> = flag();
        /// Spectral irradiance on the sensor plane, spectral EXR. Default: false.
        optional irradiance: Placed<bool> = flag();
        /// The part of the irradiance that is ghosts, spectral EXR; needs ghosts = true in `[effects]`. Default: false.
        optional ghosts: Placed<bool> = flag();
        /// Variance of the mean of what is estimated, EXR; needs two replicates or more. Default: false.
        optional variance: Placed<bool> = flag();
        /// How many samples each pixel got (layer "samples"), the variance of its mean by them ("monte_carlo_variance") and, where pixels sum
        /// electrons, that of the sensor's noise in one frame ("sensor_variance"), both in e⁻² of the described exposure ((W/m²)² of irradiance without
        /// electrons), EXR; of the first capture. Variances need pixels that sum electrons, or "noise_threshold". Default: false.
        optional sampling: Placed<bool> = flag();
        /// Expected electrons of each pixel, EXR. Default: false.
        optional electrons: Placed<bool> = flag();
        /// Digital numbers, in the format of "raw_format". Default: true for a sensor with electronics.
        optional raw: Placed<bool> = flag();
        /// File format of the digital numbers. Default: "png", or "tiff" where they have more than 16 bits.
        optional raw_format: Placed<RawFormat> = choice();
        /// What each pixel's digital number is made of, one layer a component, in electrons, EXR. Default: false.
        optional signal_breakdown: Placed<bool> = flag();
        /// The picture, 8-bit PNG. Default: true for a camera with `[isp]`.
        optional picture: Placed<bool> = flag();
        /// Depth, distance, normals, positions and identities of the ground truth, EXR. The depth along the camera's axis is NaN where
        /// a pixel looks sideways, back or at a mirror: "camera_space_position" has a signed z there. Default: true.
        optional ground_truth: Placed<bool> = flag();
        /// With "ground_truth": the position in the camera's frame as well (m; x right, y down, z forward, negative behind the
        /// camera; from the centre of the entrance pupil), layers "P_camera.X", ".Y" and ".Z". Default: false.
        optional camera_space_position: Placed<bool> = flag();
        /// What weather does to each pixel, of a scene with `[[media]]` or `[precipitation]`: "transmittance.exr", the share of light at 587.56 nm
        /// that comes unscattered from the first surface; "airlight.exr", the part of the spectral radiance that was scattered in before it; and where
        /// something falls "cover.exr", the share of pixel and exposure that near drops or flakes cover. In the raster of "radiance". Takes the time of
        /// the light once more. Default: false.
        optional weather: Placed<bool> = flag();
        /// Depth as 16-bit PNG. Default: false.
        optional depth_png: Placed<bool> = flag();
        /// With "depth_png": numbers per metre, above 0, or a data set's convention: "kitti" (256 per m), "ros" (1 000 per
        /// m), "tum" (5 000 per m). Default: "kitti".
        optional depth_png_scale: DepthScale = depth_scale();
        /// Origin (m) and unit direction of each pixel's principal ray in the camera's frame, EXR: with the distance of the
        /// ground truth any pixel can be put back into space. Default: false.
        optional rays: Placed<bool> = flag();
        /// The same ground truth, rays and picture once more in a folder "undistorted": those of the rectilinear twin with the same
        /// pose and pupil, whose camera matrix the side-car states. Cameras that see 85° from the axis or more have none.
        /// Default: false.
        optional undistorted: Placed<bool> = flag();
        /// With "undistorted": the twin's focal length over the camera's own, above 0; below 1 it shows more of a picture that
        /// barrels. Default: 1.
        optional undistorted_scale: Placed<f64> = number("").above(0.0);
        /// Where what each pixel sees is seen in the next frame and in the one before (px), whether it is seen there, and how fast its image
        /// moves (px/s): the layers "flow", "visibility" and "motion_vector" of "motion.exr". Needs `[sequence]`. "exr": these alone;
        /// "middlebury", "kitti": the flow to the next frame as .flo or 16-bit PNG as well. Default: none.
        optional optical_flow: Placed<CorrespondenceFormat> = choice();
        /// How what each pixel sees moves in space: to the next frame and the one before (m, cameras' frames) and in the world (m/s), the layers
        /// "scene_flow" and "velocity" of "motion.exr". Needs `[sequence]`. Default: false.
        optional scene_flow: Placed<bool> = flag();
        /// The name of a camera to the right whose view is rectified with this one's: how much farther left it sees what each pixel sees (px), and
        /// whether it does, "disparity.exr". Default: none.
        optional disparity_to: Placed<String> = text("the name of the right camera");
        /// With "disparity_to": "exr", that file alone; "middlebury", "kitti": .pfm or 16-bit PNG as well. Default: "exr".
        optional disparity_format: Placed<CorrespondenceFormat> = choice();
        /// Boxes of the objects, in the picture (what is seen, and the whole object) and in space, with the part that is seen and the part that lies
        /// within the picture, JSON. Default: false.
        optional boxes: Placed<bool> = flag();
        /// With "boxes": the boxes of all frames of the run once more in one file, object by object, "tracks.json". Default: false.
        optional tracks: Placed<bool> = flag();
        /// Which objects and materials each pixel sees and how much of it each covers, through the lens and over the exposure, by as many samples as the light has
        /// (64 at most): "cryptomatte.exr", of Psyop's specification 1.2. Default: false.
        optional cryptomatte: Placed<bool> = flag();
        /// The pictures of all frames of the run as one video, "picture.y4m"; needs `[isp]` with pictures of 8 bits as PNG, and
        /// `[sequence]`. Default: none.
        optional video: Placed<VideoFormat> = choice();
        /// Where this camera stands and how it projects, for other programs: in the folder "calibration" beside the cameras' own, files
        /// of all cameras that ask for them, as ROS, Kalibr and COLMAP know them. Default: false.
        optional calibration_files: Placed<bool> = flag();
    }
}

words! {
    /// The files of optical flow or disparity.
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
    /// A file format of videos.
    pub enum VideoFormat {
        /// YUV4MPEG2: not compressed, 8 bits, 4:4:4, the matrix of ITU-R BT.709 in limited range.
        "y4m" => Y4m,
    }
}

/// How depths become numbers.
#[derive(Clone, Debug)]
pub enum DepthScale {
    /// Numbers per metre.
    PerMetre(Placed<f64>),
    /// The convention of a data set.
    Named(Placed<DepthConvention>),
}

words! {
    /// The convention of a data set for depths.
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
