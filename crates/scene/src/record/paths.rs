//! The keys of `[render]` that belong to integrator = "path".

use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{among, flag, record, whole};

record! {
    /// Settings of the path integrator.
    pub struct PathKeys {
        /// Maximum number of surfaces along a path, 1 … 1 024. Belongs to integrator = "path". Default: 16, or that of the quality preset.
        optional max_bounces: Placed<u64> = whole(1, 1024);
        /// Includes caustics: light of suns and glowing surfaces that smooth surfaces focus onto diffuse ones, and mirrors onto much less glossy
        /// ones. Without them the image lacks that light and the rare bright samples (fireflies) that find it, and rain or snow deflects only light
        /// on its way to the camera, not between diffuse surfaces. Belongs to integrator = "path". Default: true.
        optional caustics: Placed<bool> = flag();
        /// Path-space regularisation: metals, coats, glass and paint that a path meets after a glossy surface (and after a diffuse one where caustics
        /// are included) are treated as rougher, so that lights in them are found without fireflies. The image is biased: reflections within
        /// reflections and caustics are blurred. Surfaces seen directly or in mirrors do not change. Belongs to integrator = "path". Default: false.
        optional regularize: Placed<bool> = flag();
        /// Path guiding: diffuse surfaces scatter paths towards directions in which light was found. Before each pass one sixteenth of its number of
        /// paths (with "noise_threshold": of those of "min_spp"), at most 524 288, is traced to learn them. It affects the noise of indirect light,
        /// never a mean. Belongs to integrator = "path". Default: false.
        optional guiding: Placed<bool> = flag();
        /// Branched path tracing: number of paths that continue and of lights that are sampled at the first surface that is no mirror, per sample, 1
        /// … 64. The path to that surface is traced once, so light has the noise of that many more samples in less time where that path is long.
        /// Edges, depth of field and motion keep the noise of "spp". No mean changes. Excludes "path_reuse_px" above 1. Belongs to integrator =
        /// "path". Default: 1.
        optional branches: Placed<u64> = whole(1, 64);
        /// Path reuse: side of the blocks of pixels of one colour whose paths share their tails, px: 1 (no reuse), 2, 4 or 8. The same error takes
        /// much less time where light is scattered between surfaces, but errors within a block are correlated. Belongs to integrator = "path".
        /// Default: 1.
        optional path_reuse_px: Placed<u64> = among(&[1, 2, 4, 8]);
    }
}

impl PathKeys {
    /// Number of paths that continue from a first surface, per sample.
    #[must_use]
    pub fn branches_in_force(&self) -> u64 {
        match above_one(&self.branches) {
            Some(branches) if !self.reuse_counts() => branches.value,
            _ => 1,
        }
    }

    /// Side of the squares of pixels whose paths share their tails, px.
    #[must_use]
    pub fn path_reuse_in_force(&self) -> u64 {
        let counts = self.reuse_counts() || above_one(&self.branches).is_none();
        match above_one(&self.path_reuse_px) {
            Some(side) if counts => side.value,
            _ => 1,
        }
    }

    /// True if "path_reuse_px" of the command line overrides "branches" of a file.
    fn reuse_counts(&self) -> bool {
        let is_of_command = |key: &Option<Placed<u64>>| above_one(key).is_some_and(|key| key.place.is_command_line());
        is_of_command(&self.path_reuse_px) && !is_of_command(&self.branches)
    }

    /// Reports branched paths with path reuse, which exclude each other. The key of the command line counts.
    pub(super) fn check_branches(&self, faults: &mut Faults) {
        let (Some(branches), Some(reuse)) = (above_one(&self.branches), above_one(&self.path_reuse_px)) else { return };
        let (key, of, other, cause) = match self.reuse_counts() {
            true => ("branches", branches, "path_reuse_px", reuse),
            false => ("path_reuse_px", reuse, "branches", branches),
        };
        let problem =
            format!("\"{key}\" and \"{other}\" = {} exclude each other: branched paths cannot be reused", cause.value);
        faults.add_idle(
            ErrorCode::Contradiction,
            key,
            &of.place,
            Some(&cause.place),
            problem,
            "give one of the two, or 1 for the other",
        );
    }
}

fn above_one(key: &Option<Placed<u64>>) -> Option<&Placed<u64>> {
    key.as_ref().filter(|key| key.value > 1)
}
