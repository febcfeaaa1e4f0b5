//! A receiver's gloss in light selection.
//!
//! The weight of a light is its irradiance times 1 + the lobes' values relative to the diffuse part. For a light or cluster seen under a half angle
//! with sine r, the mean of a lobe over it is estimated. The estimate is the kernel of `materials::gloss` with its width w increased to
//! √(w² + (r/2)²) and its peak lowered so that the reflected light stays the same. (Half a disc's radius is its root mean square along one axis.) In
//! the plane of incidence, half vectors move by half of the motion of the light; across it, by 1/(cos θₒ + cos θᵢ) of it. The two widths are
//! distinct, as towards grazing they differ by orders of magnitude.
//!
//! The diffuse part counts as at least [`MIN_DIFFUSE_FRACTION`] of the light that the lobes reflect: a floor for lights outside them.

use core::f32::consts::{FRAC_1_PI, PI};

use glam::{Mat3, Vec3};

use crate::materials::{Gloss, GlossLobe, LobeCentre, MAX_GLOSS_LOBES, ShadingFrame, schlick};

/// Minimum diffuse part, as a fraction of the light that the lobes reflect.
const MIN_DIFFUSE_FRACTION: f32 = 0.05;

/// Minimum ratio of the brightness of all lobes to the diffuse part; below, lobes are left out. From 4 to 32 the error of the dry street
/// stays the same; below, sampling by the diffuse part alone is as good.
const MIN_LOBE_RATIO: f32 = 16.0;

/// Minimum width of a lobe for which clusters are split. The reflection of a lamp in narrower lobes is smaller than a pixel; its error is
/// then that of its place in the pixel.
const MIN_RESOLVED_WIDTH: f32 = 0.004;

/// Sine of a cone's half angle above which the change of half vectors over it is not treated as linear.
const MAX_LINEAR_SIN: f32 = 0.2;

/// Mean square along one axis over a disc of radius 1.
const SPREAD2: f32 = 0.25;

/// The lobes of a receiver in the render frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceiverGloss {
    /// Unit vector towards the viewer.
    viewer: Vec3,
    normal: Vec3,
    /// Unit vectors in the surface: in the viewer's plane of incidence, and across it.
    along: Vec3,
    across: Vec3,
    lobes: [ReceiverLobe; MAX_GLOSS_LOBES],
}

/// Directions about a unit axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct DirectionCone {
    pub(super) axis: Vec3,
    /// Sine of the half angle.
    pub(super) sin: f32,
}

/// A lobe relative to the diffuse part.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ReceiverLobe {
    about: LobeCentre,
    width2: f32,
    peak: f32,
    f0: f32,
}

impl ReceiverGloss {
    /// The gloss of a surface seen in `frame`; `None` if no lobe is bright enough to matter.
    pub(crate) fn new(gloss: &Gloss, frame: &ShadingFrame) -> Option<Self> {
        let cos_o = frame.wo.z;
        if gloss.lobes.iter().all(|lobe| lobe.peak <= 0.0) {
            return None;
        }
        let sent: f32 = gloss.lobes.iter().map(|lobe| albedo(lobe, cos_o)).sum();
        let diffuse = gloss.diffuse.max(MIN_DIFFUSE_FRACTION * FRAC_1_PI * sent).max(f32::MIN_POSITIVE);
        let bright: f32 = gloss.lobes.iter().map(|lobe| brightness(lobe, cos_o)).sum();
        if !(bright > MIN_LOBE_RATIO * diffuse && bright.is_finite()) {
            return None;
        }
        let (viewer, normal) = (frame.turned_outward(frame.wo), frame.normal());
        let along =
            (viewer - normal * viewer.dot(normal)).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        let lobe = |lobe: &GlossLobe| ReceiverLobe {
            about: match lobe.about {
                LobeCentre::HalfVector => LobeCentre::HalfVector,
                LobeCentre::Direction(axis) => LobeCentre::Direction(frame.turned_outward(axis)),
            },
            width2: lobe.width * lobe.width,
            peak: lobe.peak / diffuse,
            f0: lobe.f0,
        };
        let lobes = core::array::from_fn(|i| lobe(&gloss.lobes[i]));
        Some(Self { viewer, normal, along, across: normal.cross(along), lobes })
    }

    /// The same gloss turned by a rotation.
    pub(super) fn turned(&self, rotation: &Mat3) -> Self {
        let lobe = |lobe: &ReceiverLobe| match lobe.about {
            LobeCentre::HalfVector => *lobe,
            LobeCentre::Direction(axis) => ReceiverLobe { about: LobeCentre::Direction(*rotation * axis), ..*lobe },
        };
        let [viewer, normal, along, across] =
            [self.viewer, self.normal, self.along, self.across].map(|axis| *rotation * axis);
        Self { viewer, normal, along, across, lobes: core::array::from_fn(|i| lobe(&self.lobes[i])) }
    }

    /// Light that lobes reflect from a cone about the unit `direction` whose half angle has the sine `sin`, relative to the light that the
    /// diffuse part reflects from above.
    #[inline]
    pub(super) fn relative(&self, direction: Vec3, sin: f32) -> f32 {
        self.relative_four(direction.to_array().map(|x| [x; 4]), [sin; 4])[0]
    }

    /// The same for four cones.
    #[inline(always)]
    pub(super) fn relative_four(&self, directions: [FourValues; 3], sin: FourValues) -> FourValues {
        let mut sum = [0.0; 4];
        for lobe in self.lobes.iter().filter(|lobe| lobe.peak > 0.0) {
            let of = match lobe.about {
                LobeCentre::HalfVector => self.relative_by_half_vector(lobe, directions, sin),
                LobeCentre::Direction(axis) => relative_by_direction(lobe, axis, directions, sin),
            };
            sum = each(|i| sum[i] + of[i]);
        }
        sum
    }

    /// Approximate maximum of the light that lobes reflect from one place in a cone about the unit `direction` whose half angle has the
    /// sine `sin`, or from anywhere if there is no cone, relative to the light that the diffuse part reflects from above; 0 for lobes too
    /// narrow to be resolved.
    pub(super) fn max_relative(&self, cone: Option<DirectionCone>) -> f32 {
        self.lobes.iter().map(|lobe| self.max_relative_of(lobe, cone)).sum()
    }

    fn max_relative_of(&self, lobe: &ReceiverLobe, cone: Option<DirectionCone>) -> f32 {
        if lobe.peak <= 0.0 || lobe.width2 < MIN_RESOLVED_WIDTH * MIN_RESOLVED_WIDTH {
            return 0.0;
        }
        let at_axis = schlick(lobe.f0, self.viewer.dot(self.normal));
        let (aside2, fresnel) = match (lobe.about, cone) {
            (LobeCentre::HalfVector, None) => (0.0, at_axis),
            (LobeCentre::HalfVector, Some(DirectionCone { axis: direction, sin })) if sin > MAX_LINEAR_SIN => {
                (self.min_aside2(direction, sin), at_axis)
            }
            (LobeCentre::HalfVector, Some(DirectionCone { axis: direction, sin })) => {
                let half = self.viewer + direction;
                let height = half.dot(self.normal).max(MIN_COS_SUM);
                let outside = |of: Vec3, reach: f32| (half.dot(of).abs() / height - reach).max(0.0);
                let (along, across) = (outside(self.along, 0.5 * sin), outside(self.across, sin / height));
                (along * along + across * across, schlick(lobe.f0, 0.5 * half.length()))
            }
            (LobeCentre::Direction(_), None) => (0.0, 1.0),
            (LobeCentre::Direction(axis), Some(DirectionCone { axis: direction, sin })) => {
                let reach = (2.0 - 2.0 * (1.0 - sin * sin).max(0.0).sqrt()).sqrt();
                let outside = ((direction - axis).length() - reach).max(0.0);
                (outside * outside, 1.0)
            }
        };
        let fallen = (1.0 + aside2) / (1.0 + (aside2 / lobe.width2).max(aside2));
        lobe.peak * fresnel * fallen * fallen
    }

    /// Minimum tan² between half vector and normal in a wide cone. A direction at an angle δ from the mirror direction has its half vector
    /// at δ/2 or more from the normal: the two reflections differ by a rotation of twice the angle between them.
    fn min_aside2(&self, direction: Vec3, sin: f32) -> f32 {
        let mirrored = self.normal * (2.0 * self.viewer.dot(self.normal)) - self.viewer;
        let (cos_a, cos) = (mirrored.dot(direction).clamp(-1.0, 1.0), (1.0 - sin * sin).max(0.0).sqrt());
        if cos_a >= cos {
            return 0.0;
        }
        let cos_d = cos_a * cos + (1.0 - cos_a * cos_a).sqrt() * sin;
        (1.0 - cos_d) / (1.0 + cos_d).max(f32::MIN_POSITIVE)
    }

    #[inline(always)]
    fn relative_by_half_vector(&self, lobe: &ReceiverLobe, [x, y, z]: [FourValues; 3], sin: FourValues) -> FourValues {
        let half = [each(|i| x[i] + self.viewer.x), each(|i| y[i] + self.viewer.y), each(|i| z[i] + self.viewer.z)];
        let dot = |v: Vec3| each(|i| half[0][i] * v.x + half[1][i] * v.y + half[2][i] * v.z);
        let length2 = each(|i| half[0][i] * half[0][i] + half[1][i] * half[1][i] + half[2][i] * half[2][i]);
        let cos = each(|i| at_most(0.5 * length2[i].sqrt(), 1.0));
        let (up, along, across) = (dot(self.normal), dot(self.along), dot(self.across));
        // A cone that reaches below the horizon counts by its part above.
        let per_height = each(|i| 1.0 / at_least(at_least(up[i], 0.25 * sin[i]), MIN_COS_SUM));
        let along2 = each(|i| along[i] * along[i] * per_height[i] * per_height[i]);
        let across2 = each(|i| across[i] * across[i] * per_height[i] * per_height[i]);
        let spread2 = each(|i| SPREAD2 * sin[i] * sin[i]);
        let width2_along = each(|i| lobe.width2 + 0.25 * spread2[i]);
        let width2_across = each(|i| lobe.width2 + spread2[i] * per_height[i] * per_height[i]);
        let aside2 = each(|i| along2[i] + across2[i]);
        let scaled2 = each(|i| along2[i] / width2_along[i] + across2[i] / width2_across[i]);
        let shape = each(|i| (1.0 + aside2[i]) / (1.0 + at_least(scaled2[i], aside2[i])));
        let lowered = each(|i| lobe.width2 / (width2_along[i] * width2_across[i]).sqrt());
        let fresnel = each(|i| schlick_unclamped(lobe.f0, cos[i]));
        each(|i| lobe.peak * fresnel[i] * lowered[i] * (shape[i] * shape[i]))
    }
}

#[inline(always)]
fn relative_by_direction(lobe: &ReceiverLobe, axis: Vec3, [x, y, z]: [FourValues; 3], sin: FourValues) -> FourValues {
    let (x, y, z) = (each(|i| x[i] - axis.x), each(|i| y[i] - axis.y), each(|i| z[i] - axis.z));
    let aside2 = each(|i| x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    let width2 = each(|i| lobe.width2 + SPREAD2 * sin[i] * sin[i]);
    let fallen = each(|i| width2[i] / (width2[i] + aside2[i]));
    each(|i| lobe.peak * (lobe.width2 / width2[i]) * (fallen[i] * fallen[i]))
}

/// Schlick's approximation, for a cosine of at most 1.
#[inline(always)]
fn schlick_unclamped(f0: f32, cos: f32) -> f32 {
    let x = 1.0 - cos;
    let x2 = x * x;
    f0 + (1.0 - f0) * (x2 * x2 * x)
}

/// Minimum cos θₒ + cos θᵢ.
const MIN_COS_SUM: f32 = 1e-4;

/// Light that a lobe reflects at its axis. Lobes about a direction are compared with the light that the diffuse part reflects from that
/// same direction. For a road marking far ahead this is little: lamp and viewer are low.
fn brightness(lobe: &GlossLobe, cos_o: f32) -> f32 {
    let at_axis = lobe.peak * lobe.fresnel_at_axis(cos_o);
    match lobe.about {
        LobeCentre::HalfVector => at_axis,
        LobeCentre::Direction(axis) => at_axis / axis.z.max(MIN_COS_SUM),
    }
}

/// Approximate albedo of a lobe.
fn albedo(lobe: &GlossLobe, cos_o: f32) -> f32 {
    let solid = PI * lobe.width * lobe.width;
    match lobe.about {
        // Directions move twice as far as half vectors, and about the mirror direction across only cos θ as much.
        LobeCentre::HalfVector => 4.0 * solid * cos_o * lobe.peak * lobe.fresnel_at_axis(cos_o),
        LobeCentre::Direction(_) => solid * lobe.peak,
    }
}

/// Four values processed side by side (SIMD).
pub(super) type FourValues = [f32; 4];

/// Computes each of the four values from its index.
#[inline(always)]
pub(super) fn each(f: impl Fn(usize) -> f32) -> FourValues {
    [f(0), f(1), f(2), f(3)]
}

/// Maximum of two numbers, as one instruction.
#[inline(always)]
pub(super) fn at_least(x: f32, low: f32) -> f32 {
    if x > low { x } else { low }
}

/// Minimum of two numbers, as one instruction.
#[inline(always)]
pub(super) fn at_most(x: f32, high: f32) -> f32 {
    if x < high { x } else { high }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::random::{philox4x32, unit_f32};
    use etendue_core::warp::uniform_sphere;
    use glam::Vec2;

    fn number(i: u32, k: u32) -> f32 {
        unit_f32(philox4x32([i, k, 0, 0], [7, 0])[0])
    }

    fn direction(i: u32, k: u32) -> Vec3 {
        uniform_sphere(Vec2::new(number(i, k), number(i, k + 1)))
    }

    /// A surface facing up with one lobe that reflects all light, so that the Fresnel factor is 1 everywhere.
    fn mirror(viewer: Vec3, width: f32, about: LobeCentre) -> ReceiverGloss {
        let along = Vec3::new(viewer.x, viewer.y, 0.0).normalize();
        let lobe = ReceiverLobe { about, width2: width * width, peak: 1e4, f0: 1.0 };
        let none = ReceiverLobe { peak: 0.0, ..lobe };
        ReceiverGloss { viewer, normal: Vec3::Z, along, across: Vec3::Z.cross(along), lobes: [lobe, none] }
    }

    /// The weight of any reflected light is at most the maximum weight of its cluster. (The Fresnel factor, left out here, is that of the
    /// mirror direction, which wide lobes exceed at grazing by some tenths.)
    #[test]
    fn no_light_in_a_wide_cone_counts_more_than_the_cone_may() {
        for i in 0..40_000 {
            let viewer = direction(i, 0);
            let viewer = Vec3::new(viewer.x, viewer.y, viewer.z.abs().max(0.02)).normalize();
            let width = [0.01, 0.06, 0.3][i as usize % 3];
            let about = if i % 2 == 0 { LobeCentre::HalfVector } else { LobeCentre::Direction(direction(i, 2)) };
            let gloss = mirror(viewer, width, about);
            let (axis, sin) = (direction(i, 4), 0.2 + 0.8 * number(i, 6));
            let minimum = (1.0 - sin * sin).max(0.0).sqrt();
            // Half of the lights lie about the mirror direction, where it matters.
            let mirrored = Vec3::new(-viewer.x, -viewer.y, viewer.z);
            let light =
                direction(i, 7) * if i % 4 < 2 { 1.0 } else { 0.1 } + mirrored * if i % 4 < 2 { 0.0 } else { 1.0 };
            let light = light.normalize();
            if light.dot(axis) >= minimum && light.z > 0.0 {
                let (counts, maximum) =
                    (gloss.relative(light, 0.0), gloss.max_relative(Some(DirectionCone { axis, sin })));
                // Some roundings of f32 in half vectors near grazing.
                assert!(counts <= 1.01 * maximum, "{i}: {counts} of at most {maximum}");
                assert!(counts <= 1.01 * gloss.max_relative(None), "{i}: {counts} all around");
            }
        }
    }
}
