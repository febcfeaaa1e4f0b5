//! What a camera delivers of the ground truth between frames, between cameras and of objects.

/// The file that flow or disparity is written to beside the EXR.
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
    /// The other camera's place in the job.
    pub right: u32,
    /// The file beside the EXR.
    pub format: CorrespondenceFormat,
}

/// What a camera delivers of the ground truth between frames, between cameras and of objects.
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
    /// The boxes of all frames in one file.
    pub tracks: bool,
    /// The coverage of objects and materials.
    pub cryptomatte: bool,
}

impl Annotations {
    /// Whether nothing is delivered.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Whether other frames of the camera are looked at.
    #[must_use]
    pub fn needs_neighbours(&self) -> bool {
        self.optical_flow.is_some() || self.scene_flow
    }
}
