//! Dead pixels: they hold no charge, whatever falls on them.
//!
//! e ← 0 for a share of pixels, after the full well: they still drain and pass what overflows. Which ones is the specimen's.
//! Draw: `Dead`. Left out: pixels stuck at other values, dead rows and columns, clusters.

use super::Verdict;
use crate::operation::Context;
use crate::parameters::SensorParameters;
use crate::random::sparse;
use etendue_core::random::{NoiseDraw, NoiseKey};

pub(super) fn need(p: &SensorParameters) -> (Verdict, String) {
    match p.pattern.dead_fraction {
        0.0 => (Verdict::Skipped, super::NOT_DESCRIBED.into()),
        share => (Verdict::Required, format!("{share} of pixels hold no charge")),
    }
}

/// Dead pixels, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DeadPixels {
    share: f64,
    key: NoiseKey,
}

impl DeadPixels {
    pub(crate) fn new(context: &Context<'_>) -> Self {
        Self { share: context.p.pattern.dead_fraction, key: context.pattern(NoiseDraw::Dead) }
    }

    pub(crate) fn apply(&self, electrons: &mut [f64], y: u32) {
        sparse::each(self.key, y, self.share, electrons.len(), |x, _| electrons[x] = 0.0);
    }
}

#[cfg(test)]
mod tests {
    use crate::frame::tests::{ADDRESS, quiet, run};
    use crate::state::FrameAddress;
    use etendue_core::Plane;

    #[test]
    fn a_share_of_pixels_is_dark_in_every_frame() {
        let mut p = quiet();
        p.pattern.dead_fraction = 0.02;
        let means = Plane::filled(200, 200, 100.0);
        let raw = run(&p, &means, ADDRESS);
        let dead = raw.plane.samples().iter().filter(|dn| **dn == 0).count() as f64;
        // 800 ± 28; four of those.
        assert!((dead - 800.0).abs() < 112.0, "{dead}");
        assert!(raw.plane.samples().iter().all(|dn| *dn == 0 || *dn == 100));
        assert_eq!(raw.plane, run(&p, &means, FrameAddress { frame: 9, ..ADDRESS }).plane);
    }
}
