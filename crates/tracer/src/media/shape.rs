//! Region of a medium: everywhere, below a height, in a box, a ball or a closed mesh; in its own frame.

use std::sync::Arc;

use glam::DVec3;

use super::solid::Solid;

/// The part of space that a medium fills.
#[derive(Clone, Debug, PartialEq)]
pub enum MediumRegion {
    /// All of space.
    Everywhere,
    /// Below z = `top_m`.
    Below {
        /// Height of the upper end, m.
        top_m: f64,
    },
    /// A box about the origin.
    Box {
        /// Half of its size along each axis, m.
        half_m: DVec3,
    },
    /// A ball about the origin.
    Ball { radius_m: f64 },
    /// The inside of a mesh.
    Mesh(Arc<Solid>),
}

impl MediumRegion {
    /// Start and end of the part of a ray that lies inside, between 0 and `end` in lengths of `direction`; `None` if there is none. For a
    /// mesh from the ray's first entry to its last exit: gaps may lie between ([`MediumRegion::gaps`]).
    pub(super) fn span(&self, origin: DVec3, direction: DVec3, end: f64) -> Option<(f64, f64)> {
        let (from, to) = match self {
            Self::Everywhere => (0.0, end),
            Self::Below { top_m } => slab(origin.z, direction.z, f64::NEG_INFINITY, *top_m),
            Self::Box { half_m } => {
                let (mut from, mut to) = (0.0_f64, end);
                for axis in 0..3 {
                    let (enter, leave) = slab(origin[axis], direction[axis], -half_m[axis], half_m[axis]);
                    (from, to) = (from.max(enter), to.min(leave));
                }
                (from, to)
            }
            Self::Ball { radius_m } => ball(origin, direction, *radius_m)?,
            Self::Mesh(solid) => {
                let parts = solid.parts(origin, direction, end);
                (parts.first()?.0, parts.last()?.1)
            }
        };
        let (from, to) = (from.max(0.0), to.min(end));
        (from < to).then_some((from, to))
    }

    /// The mesh, which is not convex, so that a ray may leave and enter it again.
    #[inline]
    pub(super) fn gaps(&self) -> Option<&Solid> {
        if let Self::Mesh(solid) = self { Some(solid) } else { None }
    }
}

/// Interval in which x + d t lies between two ends; empty if it never does.
fn slab(x: f64, d: f64, low: f64, high: f64) -> (f64, f64) {
    if d == 0.0 {
        return if x >= low && x <= high {
            (f64::NEG_INFINITY, f64::INFINITY)
        } else {
            (f64::INFINITY, f64::NEG_INFINITY)
        };
    }
    let (a, b) = ((low - x) / d, (high - x) / d);
    (a.min(b), a.max(b))
}

/// Intersections of a line with a ball about the origin.
fn ball(origin: DVec3, direction: DVec3, radius_m: f64) -> Option<(f64, f64)> {
    let length2 = direction.length_squared();
    let middle = -origin.dot(direction) / length2;
    let aside2 = (origin + direction * middle).length_squared();
    let half2 = (radius_m * radius_m - aside2) / length2;
    (half2 > 0.0).then(|| (middle - half2.sqrt(), middle + half2.sqrt()))
}

/// A part of a uniform medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HollowPart {
    /// Minimum distance of this part, m.
    pub from_m: f64,
    /// Fraction of the medium.
    pub fraction: f64,
}

/// Parts of a uniform medium, each of which begins at a distance of its own: nearer, particles are modelled one by one.
#[derive(Clone, Debug, PartialEq)]
pub struct HollowRegion {
    /// By increasing starting distance.
    parts: Vec<HollowPart>,
}

impl HollowRegion {
    /// From the parts, whose fractions sum to 1.
    #[must_use]
    pub fn new(mut parts: Vec<HollowPart>) -> Self {
        parts.sort_by(|a, b| a.from_m.total_cmp(&b.from_m));
        Self { parts }
    }

    /// Fraction of the medium present at a distance, m.
    #[must_use]
    pub fn density(&self, distance_m: f64) -> f64 {
        self.parts.iter().take_while(|part| part.from_m <= distance_m).map(|part| part.fraction).sum()
    }

    /// Length of a line through the medium between `from` and `to`, each part weighted by its fraction; in lengths of the direction.
    #[must_use]
    pub fn path_length(&self, origin: DVec3, direction: DVec3, from: f64, to: f64) -> f64 {
        let length2 = direction.length_squared();
        let middle = -origin.dot(direction) / length2;
        let aside2 = (origin + direction * middle).length_squared();
        let outside = |radius: f64| {
            let half = ((radius * radius - aside2) / length2).max(0.0).sqrt();
            let inside = ((middle + half).min(to) - (middle - half).max(from)).max(0.0);
            to - from - inside
        };
        self.parts.iter().filter(|part| part.fraction > 0.0).map(|part| part.fraction * outside(part.from_m)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_of_plain_shapes() {
        let x = DVec3::X;
        assert_eq!(MediumRegion::Everywhere.span(DVec3::ONE, x, 7.0), Some((0.0, 7.0)));
        let below = MediumRegion::Below { top_m: 2.0 };
        assert_eq!(below.span(DVec3::ZERO, DVec3::Z, 9.0), Some((0.0, 2.0)));
        assert_eq!(below.span(DVec3::Z * 5.0, -DVec3::Z, 9.0), Some((3.0, 9.0)));
        assert!(below.span(DVec3::Z * 5.0, x, 9.0).is_none());
        assert_eq!(below.span(DVec3::Z, x, f64::INFINITY), Some((0.0, f64::INFINITY)));
        let cube = MediumRegion::Box { half_m: DVec3::new(1.0, 2.0, 3.0) };
        assert_eq!(cube.span(x * -4.0, x, 9.0), Some((3.0, 5.0)));
        assert_eq!(cube.span(DVec3::ZERO, x, 9.0), Some((0.0, 1.0)), "from inside");
        assert!(cube.span(DVec3::new(-4.0, 2.5, 0.0), x, 9.0).is_none());
        let ball = MediumRegion::Ball { radius_m: 2.0 };
        assert_eq!(ball.span(x * -4.0, x * 2.0, 9.0), Some((1.0, 3.0)), "in lengths of the direction");
        assert!(ball.span(x * 4.0, x, 9.0).is_none());
    }

    #[test]
    fn the_way_is_the_integral_of_the_density() {
        let hollow = HollowRegion::new(
            [(5.0, 0.3), (0.0, 0.5), (2.0, 0.2)].map(|(from_m, fraction)| HollowPart { from_m, fraction }).to_vec(),
        );
        let (origin, direction) = (DVec3::new(0.3, -1.0, 0.2), DVec3::new(1.0, 2.0, -0.5));
        let n = 200_000_u32;
        let (from, to) = (0.1, 6.0);
        let step = (to - from) / f64::from(n);
        let at = |i: u32| hollow.density((origin + direction * (from + (f64::from(i) + 0.5) * step)).length());
        let sum: f64 = (0..n).map(at).sum::<f64>() * step;
        // Three steps of the density, each hit to half a step.
        assert!((hollow.path_length(origin, direction, from, to) - sum).abs() < 2.0 * step);
        assert_eq!((hollow.density(0.0), hollow.density(1e9)), (0.5, 1.0));
    }
}
