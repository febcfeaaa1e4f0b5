//! The keys of `[render]` that belong to integrator = "path".

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{among, flag, integer, record};

record! {
    /// Settings of the path integrator.
    pub struct PathKeys {
        /// Maximum number of surfaces along a path. Default: 16, or the quality preset's.
        optional max_bounces: Placed<u64> = integer(1, 1024);
        /// Includes caustics of suns and glowing surfaces; without them that light is missing. Default: true.
        optional caustics: Placed<bool> = flag();
        /// Path-space regularisation: fewer fireflies, but indirect reflections and caustics are blurred. Default: false.
        optional regularize: Placed<bool> = flag();
        /// Path guiding at diffuse surfaces; affects noise only. Default: false.
        optional guiding: Placed<bool> = flag();
        /// Paths and sampled lights at the first surface that is no mirror; affects noise only. Excludes "path_reuse_px" above 1. Default: 1.
        optional branches: Placed<u64> = integer(1, 64);
        /// Side of pixel blocks whose paths share tails; their errors are correlated. Default: 1.
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
    pub(super) fn check_branches(&self, errors: &mut DescriptionErrors) {
        let (Some(branches), Some(reuse)) = (above_one(&self.branches), above_one(&self.path_reuse_px)) else { return };
        let (key, of, other, cause) = match self.reuse_counts() {
            true => ("branches", branches, "path_reuse_px", reuse),
            false => ("path_reuse_px", reuse, "branches", branches),
        };
        let problem =
            format!("\"{key}\" and \"{other}\" = {} exclude each other: branched paths cannot be reused", cause.value);
        errors.add_without_effect(
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
