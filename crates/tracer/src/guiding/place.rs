//! Where surfaces share what they learn: cubes and ranges of normals.

use glam::Vec3;

/// Side of a cube over its distance from the camera, between half of this and all of it.
const ANGLE: f32 = 0.08;
/// How many normals there are a side: a direction's components, times this, are rounded.
const NORMALS: f32 = 1.8;

/// A cube about the camera with a range of normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Place(u64);

/// Bits of a coordinate.
const BITS: u32 = 10;
/// Half of the range of a coordinate.
const HALF: i32 = 1 << (BITS - 1);
/// Where the exponent of a cube's side stands, above three coordinates and the normal.
const EXPONENT: u32 = 3 * BITS + 8;
/// Marks cubes of the coarse kind.
const COARSE: u64 = 1 << 60;

impl Place {
    /// The place of a point (render frame, m) of a surface with the unit shading normal `normal`.
    #[inline(always)]
    pub(crate) fn of(position: Vec3, normal: Vec3) -> Self {
        let side = (position.length() * ANGLE).clamp(f32::MIN_POSITIVE, f32::MAX / 2.0);
        let exponent = side.to_bits() >> 23;
        // Sides are powers of two, so that the quotient is exact; up to 25 cubes lie between the camera and a point of theirs.
        let inverse = f32::from_bits((254 - exponent).max(1) << 23);
        let cube = (position * inverse).floor();
        let word = coordinates([cube.x, cube.y, cube.z].map(|c| c as i32));
        Self(u64::from(exponent) << EXPONENT | normal_bits(normal) << (3 * BITS) | word)
    }

    /// The cube four times as wide that this one is in, with the same normals.
    #[inline(always)]
    pub(super) fn coarse(self) -> Self {
        let word = coordinates(core::array::from_fn(|axis| self.coordinate(axis as u32) >> 2));
        Self(COARSE | self.0 >> (3 * BITS) << (3 * BITS) | word)
    }

    #[inline(always)]
    fn coordinate(self, axis: u32) -> i32 {
        (self.0 >> (axis * BITS) & ((1 << BITS) - 1)) as i32 - HALF
    }

    /// A number whose lowest bits are scattered.
    #[inline(always)]
    pub(super) fn hash(self) -> usize {
        let mixed = self.0.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed ^ mixed >> 32) as usize
    }
}

/// Three coordinates in one word.
#[inline(always)]
fn coordinates(cube: [i32; 3]) -> u64 {
    let bits = cube.map(|c| (c.clamp(-HALF, HALF - 1) + HALF) as u64);
    bits[0] | bits[1] << BITS | bits[2] << (2 * BITS)
}

/// The range of a normal. Frames about normals turn where z changes its sign, so its sign counts.
#[inline(always)]
fn normal_bits(normal: Vec3) -> u64 {
    let [x, y, z] = (normal * NORMALS).round().to_array().map(|c| (c as i32 + 2) as u64);
    x + 5 * y + 25 * z + 128 * u64::from(normal.z.is_sign_negative())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_grow_with_the_distance_and_hold_what_is_near_each_other() {
        let at = |x: f32| Place::of(Vec3::new(x, 0.001, 0.001), Vec3::Z);
        assert_eq!(at(10.0), at(10.4));
        assert_ne!(at(10.0), at(10.6));
        assert_eq!(at(100.0), at(101.0));
        assert_ne!(at(10.0), at(100.0));
        assert_eq!(at(10.0).coarse(), at(11.9).coarse());
        assert_ne!(at(10.0).coarse(), at(12.1).coarse());
    }

    /// Every pair of different cubes has different places, on a grid that crosses the camera's axes.
    #[test]
    fn different_cubes_have_different_places() {
        let grid = || (-40..40).map(|i| i as f32 * 0.01 + 0.005);
        let points: Vec<Vec3> = grid().flat_map(|x| grid().map(move |y| Vec3::new(x, y, 1.0))).collect();
        let mut places: Vec<Place> = points.iter().map(|p| Place::of(*p, Vec3::X)).collect();
        places.sort_unstable();
        places.dedup();
        // Cubes of 1/16 m, of which -0.395 m to 0.395 m meets fourteen.
        assert_eq!(places.len(), 14 * 14);
    }

    #[test]
    fn sides_of_a_wall_and_walls_that_meet_differ() {
        let at = Vec3::new(2.0, 1.0, 0.5);
        let normals = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z, Vec3::new(0.6, 0.0, 0.8)];
        let places = normals.map(|normal| Place::of(at, normal));
        for (i, place) in places.iter().enumerate() {
            assert!(!places[..i].contains(place), "{i}");
        }
    }

    /// From the smallest to the greatest numbers there is a place, and the same one for the same point.
    #[test]
    fn every_point_has_a_place() {
        for scale in [0.0, 1e-38, 1e-30, 1e-25, 1e-20, 1.0, 1e12, 1e30, f32::MAX / 4.0] {
            let point = Vec3::new(0.3, -0.7, 0.6) * scale;
            assert_eq!(Place::of(point, Vec3::Z), Place::of(point, Vec3::Z), "{scale}");
        }
        assert_ne!(Place::of(Vec3::splat(1e-20), Vec3::Z), Place::of(Vec3::splat(1e12), Vec3::Z));
    }
}
