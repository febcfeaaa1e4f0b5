//! A receiver's gloss in the choice among lights.
//!
//! What a light counts is its irradiance times 1 + the lobes' values relative to the matt part. Of a light or cluster that is
//! seen under a half angle with sine r, a lobe's mean over it is estimated: the kernel of `materials::gloss`, its width w
//! grown to √(w² + (r/2)²) by the share of a disc's radius that is its root mean square along one axis, its peak lowered so that
//! as much light is sent back. Half vectors move by half of what the light does in the plane of incidence, and by
//! 1/(cos θₒ + cos θᵢ) of it across: both widths are told apart, as towards grazing they differ by orders of magnitude.
//!
//! A matt part is never taken for less than [`LEAST`] of what the lobes send back: a floor for lights outside them.

use core::f32::consts::{FRAC_1_PI, PI};
use glam::Vec3;

use crate::materials::{About, Gloss, GlossLobe, ShadingFrame, TOLD, schlick};

/// Share of what the lobes send back that the matt part counts at least.
const LEAST: f32 = 0.05;

/// How many times as bright as the matt part lobes are at least together; where less, they are left out.
const BRIGHT: f32 = 4.0;

/// Least width of a lobe that clusters are opened for: what narrower ones mirror of a lamp is smaller than a pixel, whose error
/// is then that of its place in the pixel.
const RESOLVED: f32 = 0.004;

/// How many widths from its axis a lobe ends, for whether a cluster reaches into it.
const INTO: f32 = 2.0;

/// Mean square along one axis over a disc of radius 1.
const SPREAD2: f32 = 0.25;

/// The lobes of a receiver in the render frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceiverGloss {
    /// Towards the viewer, unit.
    viewer: Vec3,
    normal: Vec3,
    /// Unit, in the surface: in the plane of incidence of the viewer, and across.
    along: Vec3,
    across: Vec3,
    lobes: [Lobe; TOLD],
}

/// A lobe relative to the matt part.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lobe {
    about: About,
    width2: f32,
    peak: f32,
    f0: f32,
}

impl ReceiverGloss {
    /// The gloss of a surface seen in `frame`; `None` where no lobe is bright enough to matter.
    pub(crate) fn new(gloss: &Gloss, frame: &ShadingFrame) -> Option<Self> {
        let cos_o = frame.wo.z;
        if gloss.lobes.iter().all(|lobe| lobe.peak <= 0.0) {
            return None;
        }
        let sent: f32 = gloss.lobes.iter().map(|lobe| albedo(lobe, cos_o)).sum();
        let matt = gloss.matt.max(LEAST * FRAC_1_PI * sent).max(f32::MIN_POSITIVE);
        let bright: f32 = gloss.lobes.iter().map(|lobe| lobe.peak * lobe.fresnel_at_axis(cos_o)).sum();
        if !(bright > BRIGHT * matt && bright.is_finite()) {
            return None;
        }
        let (viewer, normal) = (frame.turned_outward(frame.wo), frame.normal());
        let along =
            (viewer - normal * viewer.dot(normal)).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        let lobe = |told: &GlossLobe| Lobe {
            about: match told.about {
                About::HalfVector => About::HalfVector,
                About::Direction(axis) => About::Direction(frame.turned_outward(axis)),
            },
            width2: told.width * told.width,
            peak: told.peak / matt,
            f0: told.f0,
        };
        let lobes = core::array::from_fn(|i| lobe(&gloss.lobes[i]));
        Some(Self { viewer, normal, along, across: normal.cross(along), lobes })
    }

    /// What lobes send of light from a cone about the unit `direction` whose half angle has the sine `sin`, relative to what
    /// the matt part sends of light from above.
    #[inline]
    pub(super) fn relative(&self, direction: Vec3, sin: f32) -> f32 {
        self.lobes.iter().map(|lobe| if lobe.peak > 0.0 { self.of_lobe(lobe, direction, sin) } else { 0.0 }).sum()
    }

    #[inline(always)]
    fn of_lobe(&self, lobe: &Lobe, direction: Vec3, sin: f32) -> f32 {
        match lobe.about {
            About::HalfVector => self.of_half_vectors(lobe, direction, sin),
            About::Direction(axis) => {
                let width2 = lobe.width2 + SPREAD2 * sin * sin;
                let fallen = width2 / (width2 + (direction - axis).length_squared());
                lobe.peak * (lobe.width2 / width2) * (fallen * fallen)
            }
        }
    }

    /// Whether a lobe is narrower than a cone that reaches into it, so that it tells parts of it apart.
    pub(super) fn divides(&self, direction: Vec3, sin: f32) -> bool {
        self.lobes.iter().any(|lobe| lobe.peak > 0.0 && self.lobe_divides(lobe, direction, sin))
    }

    fn lobe_divides(&self, lobe: &Lobe, direction: Vec3, sin: f32) -> bool {
        let width = lobe.width2.sqrt();
        if width < RESOLVED {
            return false;
        }
        match lobe.about {
            About::HalfVector => {
                let half = self.viewer + direction;
                let height = half.dot(self.normal).max(LOWEST);
                let reach = (0.5 * sin, sin / height);
                let (along, across) = (half.dot(self.along).abs() / height, half.dot(self.across).abs() / height);
                reach.0.max(reach.1) > width && along < reach.0 + INTO * width && across < reach.1 + INTO * width
            }
            About::Direction(axis) => sin > width && (direction - axis).length() < sin + INTO * width,
        }
    }

    #[inline(always)]
    fn of_half_vectors(&self, lobe: &Lobe, direction: Vec3, sin: f32) -> f32 {
        let half = self.viewer + direction;
        // A cone that reaches below the horizon counts by its part above.
        let height = half.dot(self.normal).max(0.25 * sin).max(LOWEST);
        let (along, across) = (half.dot(self.along) / height, half.dot(self.across) / height);
        let spread2 = SPREAD2 * sin * sin;
        let width2_along = lobe.width2 + 0.25 * spread2;
        let width2_across = lobe.width2 + spread2 / (height * height);
        let aside2 = along * along + across * across;
        let scaled2 = along * along / width2_along + across * across / width2_across;
        let shape = (1.0 + aside2) / (1.0 + scaled2.max(aside2));
        let lowered = lobe.width2 / (width2_along * width2_across).sqrt();
        lobe.peak * schlick(lobe.f0, 0.5 * half.length()) * lowered * (shape * shape)
    }
}

/// Least cos θₒ + cos θᵢ.
const LOWEST: f32 = 1e-4;

/// Share of light that a lobe sends back, about.
fn albedo(lobe: &GlossLobe, cos_o: f32) -> f32 {
    let solid = PI * lobe.width * lobe.width;
    match lobe.about {
        // Directions move twice as far as half vectors, and about the mirror direction across only cos θ as much.
        About::HalfVector => 4.0 * solid * cos_o * lobe.peak * lobe.fresnel_at_axis(cos_o),
        About::Direction(_) => solid * lobe.peak,
    }
}
