//! Placement of an image on a surface, and its continuation beyond the edges.
//!
//! - By texture coordinates.
//! - From three sides (triplanar), if a shape has no or poor texture coordinates: the image is projected along each axis of the shape's
//!   own frame, with a width of `size_m` metres (so u = place / size), and the three readings are blended by
//!   |nₐ|ᵏ / Σ |n|ᵏ, n the shape's normal, k the sharpness: 1 blends widely, 16 only near the edges. On the sides ±x and
//!   ±y the image is upright (v along z) and reads from left to right as seen from outside; on ±z v runs along y.
//!   Where projections blend, contrast is lost; at a slant the image is stretched by up to √3.

use etendue_core::maths::f32::pow;
use glam::{DVec2, DVec3, Vec2, Vec3};

use super::Lookup;

/// Placement of an image on a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Projection {
    /// By the surface's texture coordinates.
    #[default]
    Uv,
    /// From three sides.
    Triplanar {
        /// Width and height of the image in the shape's own frame, m.
        size_m: f32,
        /// The exponent k, 1 to 64.
        sharpness: f32,
    },
}

/// A place in an image's coordinates: the middle of the footprint, its short side's width, its long side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TextureFootprint {
    pub(super) uv: Vec2,
    pub(super) width: f32,
    pub(super) long: Vec2,
}

impl Projection {
    pub(super) fn is_legal(self) -> bool {
        match self {
            Self::Uv => true,
            Self::Triplanar { size_m, sharpness } => {
                size_m > 0.0 && size_m.is_finite() && (1.0 / size_m).is_finite() && (1.0..=64.0).contains(&sharpness)
            }
        }
    }

    /// Reads `value` at the projected places, blended.
    #[inline]
    pub(super) fn read<T>(self, lookup: &Lookup, wrap: [Wrap; 2], value: impl Fn(&TextureFootprint) -> T) -> T
    where
        T: Default + core::ops::Add<Output = T> + core::ops::Mul<f32, Output = T>,
    {
        match self {
            Self::Uv => value(&TextureFootprint { uv: lookup.uv, width: lookup.width, long: lookup.long }),
            Self::Triplanar { size_m, sharpness } => {
                let weights = weights(lookup.local_normal, sharpness);
                let sides = sides(lookup, 1.0 / size_m, wrap);
                (0..3).filter(|i| weights[*i] > 0.0).fold(T::default(), |sum, i| sum + value(&sides[i]) * weights[i])
            }
        }
    }
}

/// Weights of the three axes, which sum to 1.
fn weights(normal: Vec3, sharpness: f32) -> [f32; 3] {
    let maximum = normal.abs().max_element();
    // Written so that a normal without direction counts as one along z.
    if !(maximum > 0.0 && maximum.is_finite()) {
        return [0.0, 0.0, 1.0];
    }
    // Relative to the largest component, so that powers do not vanish.
    let powers = (normal.abs() / maximum).to_array().map(|n| if n > 0.0 { pow(n, sharpness) } else { 0.0 });
    let sum = powers[0] + powers[1] + powers[2];
    powers.map(|p| p / sum)
}

fn sides(lookup: &Lookup, per_m: f32, wrap: [Wrap; 2]) -> [TextureFootprint; 3] {
    let side = lookup.local_normal.map(|n| 1.0_f32.copysign(n));
    let onto = |v: Vec3| {
        [Vec2::new(side.x * v.y, v.z), Vec2::new(-side.y * v.x, v.z), Vec2::new(side.z * v.x, v.y)].map(|p| p * per_m)
    };
    let (mut places, longs) = (onto(lookup.local), onto(lookup.long_local));
    if lookup.origin != DVec3::ZERO {
        let (v, side, per_m) = (lookup.origin + lookup.local.as_dvec3(), side.as_dvec3(), f64::from(per_m));
        let far = [DVec2::new(side.x * v.y, v.z), DVec2::new(-side.y * v.x, v.z), DVec2::new(side.z * v.x, v.y)];
        places = far.map(|p| Vec2::new(wrap[0].near(p.x * per_m), wrap[1].near(p.y * per_m)));
    }
    let width = lookup.width_local * per_m;
    core::array::from_fn(|i| TextureFootprint { uv: places[i], width, long: longs[i] })
}

/// Continuation of a texture outside 0–1 along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image repeated.
    #[default]
    Repeat,
    /// The texels of the edge.
    Clamp,
    /// The image mirrored, and repeated.
    Mirror,
}

impl Wrap {
    /// A coordinate folded into [0, 1].
    pub(super) fn fold(self, x: f32) -> f32 {
        match self {
            Self::Repeat => x - x.floor(),
            Self::Clamp => x.clamp(0.0, 1.0),
            Self::Mirror => {
                let turn = x - 2.0 * (0.5 * x).floor();
                if turn > 1.0 { 2.0 - turn } else { turn }
            }
        }
    }

    /// Replaces any coordinate, however large, by one near 0 with the same value.
    pub(super) fn near(self, x: f64) -> f32 {
        match self {
            Self::Repeat | Self::Mirror => (x - 2.0 * (0.5 * x).floor()) as f32,
            Self::Clamp => x as f32,
        }
    }

    /// A texel index of −1 to `count`, folded into 0 to `count` − 1. A mirrored image's neighbour at the edge is the edge itself.
    pub(super) fn neighbour(self, i: i32, count: u32) -> usize {
        let last = count as i32 - 1;
        let i = match self {
            Self::Repeat if i < 0 => last,
            Self::Repeat if i > last => 0,
            _ => i.clamp(0, last),
        };
        i as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(local: Vec3, local_normal: Vec3) -> Vec2 {
        let lookup = Lookup { local, local_normal, ..Lookup::point(Vec2::ZERO) };
        let triplanar = Projection::Triplanar { size_m: 2.0, sharpness: 4.0 };
        triplanar.read(&lookup, [Wrap::Repeat; 2], |place| Vec2::new(place.uv.x, place.uv.y))
    }

    #[test]
    fn sides_of_a_box_read_from_left_to_right() {
        let p = Vec3::new(0.2, 0.6, 1.0);
        assert_eq!(read(p, Vec3::X), Vec2::new(0.3, 0.5));
        assert_eq!(read(p, Vec3::NEG_X), Vec2::new(-0.3, 0.5));
        assert_eq!(read(p, Vec3::Y), Vec2::new(-0.1, 0.5));
        assert_eq!(read(p, Vec3::NEG_Y), Vec2::new(0.1, 0.5));
        assert_eq!(read(p, Vec3::Z), Vec2::new(0.1, 0.3));
    }

    #[test]
    fn a_shape_far_from_its_files_origin_reads_what_the_file_says() {
        let triplanar = Projection::Triplanar { size_m: 2.0, sharpness: 4.0 };
        let origin = DVec3::new(500_000.25, 5_400_001.5, 100.0);
        let lookup =
            Lookup { local: Vec3::new(0.2, 0.6, 1.0), origin, local_normal: Vec3::Z, ..Lookup::point(Vec2::ZERO) };
        let read = |wrap| triplanar.read(&lookup, [wrap; 2], |place| place.uv);
        // x = 500 000.45, y = 5 400 002.1: 250 000.225 and 2 700 001.05 images.
        assert!((read(Wrap::Mirror) - Vec2::new(0.225, 1.05)).length() < 1e-6, "{}", read(Wrap::Mirror));
        assert_eq!(read(Wrap::Clamp), Vec2::new(250_000.22, 2_700_001.0));
    }

    #[test]
    fn shares_sum_to_one_and_follow_the_normal() {
        for n in [Vec3::new(0.6, 0.0, 0.8), Vec3::new(1e-20, 1.0, 1e-9), Vec3::splat(0.577_35)] {
            for sharpness in [1.0, 4.0, 64.0] {
                let w = weights(n, sharpness);
                assert!((w.iter().sum::<f32>() - 1.0).abs() < 1e-6 && w.iter().all(|w| *w >= 0.0), "{n} {w:?}");
            }
        }
        // 0.8⁴ / (0.8⁴ + 0.6⁴) = 0.7596.
        assert!((weights(Vec3::new(0.6, 0.0, -0.8), 4.0)[2] - 0.759_65).abs() < 1e-4);
        assert_eq!(weights(Vec3::ZERO, 4.0), [0.0, 0.0, 1.0]);
    }

    #[test]
    fn each_rule_has_its_pattern() {
        let at = |wrap: Wrap| [-1.25, -0.25, 0.25, 1.25, 2.25].map(|x| wrap.fold(x));
        assert_eq!(at(Wrap::Repeat), [0.75, 0.75, 0.25, 0.25, 0.25]);
        assert_eq!(at(Wrap::Clamp), [0.0, 0.0, 0.25, 1.0, 1.0]);
        assert_eq!(at(Wrap::Mirror), [0.75, 0.25, 0.25, 0.75, 0.25]);
    }

    #[test]
    fn neighbours_of_the_edge_follow_the_rule() {
        assert_eq!((Wrap::Repeat.neighbour(-1, 4), Wrap::Repeat.neighbour(4, 4)), (3, 0));
        assert_eq!((Wrap::Clamp.neighbour(-1, 4), Wrap::Clamp.neighbour(4, 4)), (0, 3));
        assert_eq!((Wrap::Mirror.neighbour(-1, 4), Wrap::Mirror.neighbour(4, 4)), (0, 3));
    }
}
