//! The keys of `[render]` that only integrator = "path" needs.

use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{among, flag, record, whole};

record! {
    /// What only paths need.
    pub struct PathKeys {
        /// Surfaces that a path meets at most, 1 … 1 024; belongs to integrator = "path". Default: 16, or as `--quality` says.
        optional max_bounces: Placed<u64> = whole(1, 1024);
        /// Whether light of suns and glowing surfaces that smooth surfaces throw on matt ones, and mirrors on much less glossy surfaces, is followed. Without it the
        /// picture is darker by that light, and free of the rare bright samples that find it; and rain or snow turns only light on its way to the
        /// camera, not between matt surfaces. Belongs to integrator = "path".
        /// Default: true.
        optional caustics: Placed<bool> = flag();
        /// Whether lobes that come after wider ones are widened (path-space regularisation): metals, coats, glass and paint that a path meets behind a glossy
        /// surface (and behind a matt one where caustics are followed) are rougher than they are, so that lamps in them are found without rare bright
        /// samples. The picture is biased: mirror images in what other surfaces mirror, and caustics, are blurred. What is seen straight or in
        /// mirrors is as it was. Belongs to integrator = "path". Default: false.
        optional regularize: Placed<bool> = flag();
        /// Whether matt surfaces scatter paths to where light was found to come from (path guiding): before each pass a sixteenth as many paths as it has (with "noise_threshold", as "min_spp" makes),
        /// at most 524 288, are followed. Noise of indirect light depends on it, no mean does. Belongs to integrator = "path". Default: false.
        optional guiding: Placed<bool> = flag();
        /// Paths that go on, and lights that are drawn, at the first surface that is no mirror, for each sample, 1 … 64 (branched path tracing): the way there is paid once, and
        /// light has the noise of as many more samples, for less time where that way is long. Edges, depth of field and motion
        /// have the noise of "spp". No mean changes. Excludes "path_reuse_px" above 1; belongs to integrator = "path". Default: 1.
        optional branches: Placed<u64> = whole(1, 64);
        /// Paths of blocks of this many by this many pixels of one colour share their tails: 1 (none do), 2, 4 or 8. It takes
        /// much less time for the same error where light is scattered from surface to surface, but errors of the pixels of
        /// a block are then alike. Belongs to integrator = "path". Default: 1.
        optional path_reuse_px: Placed<u64> = among(&[1, 2, 4, 8]);
    }
}

impl PathKeys {
    /// Paths that continue from a first surface, for each sample.
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

    /// Whether the command line's "path_reuse_px" supersedes the "branches" of a file.
    fn reuse_counts(&self) -> bool {
        let is_of_command = |key: &Option<Placed<u64>>| above_one(key).is_some_and(|key| key.place.is_command_line());
        is_of_command(&self.path_reuse_px) && !is_of_command(&self.branches)
    }

    /// Paths that branch share no tails: of the two keys that of the command line counts.
    pub(super) fn check_branches(&self, faults: &mut Faults) {
        let (Some(branches), Some(reuse)) = (above_one(&self.branches), above_one(&self.path_reuse_px)) else { return };
        let (key, of, other, cause) = match self.reuse_counts() {
            true => ("branches", branches, "path_reuse_px", reuse),
            false => ("path_reuse_px", reuse, "branches", branches),
        };
        let problem =
            format!("\"{key}\" and \"{other}\" = {} exclude each other: paths that branch share no tails", cause.value);
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
