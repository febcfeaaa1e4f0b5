//! A guide, the training paths from which it is built, and the places that share statistics.

use std::{collections::BTreeMap, sync::Mutex};

use glam::Vec3;

use super::distribution::{BINS, DirectionDistribution, neighbours};

/// Side of a cube over its distance from the camera, between half of this and all of it.
const CUBE_ANGLE: f32 = 0.08;
/// Number of normals per unit: a direction's components, times this, are rounded.
const NORMAL_STEPS: f32 = 1.8;

/// A cube about the camera with a range of normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct GuideCell(u64);

/// Bits per coordinate.
const BITS: u32 = 10;
/// Half of the range of a coordinate.
const HALF: i32 = 1 << (BITS - 1);
/// Position of the exponent of a cube's side, above three coordinates and the normal.
const EXPONENT: u32 = 3 * BITS + 8;
/// Marks cubes of the coarse kind.
const COARSE: u64 = 1 << 60;

impl GuideCell {
    /// The place of a point (render frame, m) of a surface with the unit shading normal `normal`.
    #[inline(always)]
    pub(crate) fn new(position: Vec3, normal: Vec3) -> Self {
        let side = (position.length() * CUBE_ANGLE).clamp(f32::MIN_POSITIVE, f32::MAX / 2.0);
        let exponent = side.to_bits() >> 23;
        // Sides are powers of two, so that the quotient is exact; up to 25 cubes lie between the camera and a point.
        let inverse = f32::from_bits((254 - exponent).max(1) << 23);
        let cube = (position * inverse).floor();
        let word = coordinates([cube.x, cube.y, cube.z].map(|c| c as i32));
        Self(u64::from(exponent) << EXPONENT | normal_bits(normal) << (3 * BITS) | word)
    }

    /// The cube four times as wide that contains this one, with the same normals.
    #[inline(always)]
    pub(super) fn coarse(self) -> Self {
        let word = coordinates(core::array::from_fn(|axis| self.coordinate(axis as u32) >> 2));
        Self(COARSE | self.0 >> (3 * BITS) << (3 * BITS) | word)
    }

    #[inline(always)]
    fn coordinate(self, axis: u32) -> i32 {
        (self.0 >> (axis * BITS) & ((1 << BITS) - 1)) as i32 - HALF
    }

    /// A hash whose lowest bits are well distributed.
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

/// The range of a normal. Frames about normals flip where z changes its sign, so its sign counts.
#[inline(always)]
fn normal_bits(normal: Vec3) -> u64 {
    let [x, y, z] = (normal * NORMAL_STEPS).round().to_array().map(|c| (c as i32 + 2) as u64);
    x + 5 * y + 25 * z + 128 * u64::from(normal.z.is_sign_negative())
}

/// Fraction of the cosine in the mixture (defensive sampling): no weight is more than five times that without a guide.
const COSINE_FRACTION: f64 = 0.2;
/// Weight, in paths, of the expected value of a bin.
const PRIOR_PATHS: f64 = 4.0;
/// Weight of a path of a neighbouring bin.
const NEIGHBOUR_WEIGHT: f64 = 0.5;

/// Densities of directions at diffuse surfaces by their place.
#[derive(Clone, Debug, Default)]
pub struct Guide {
    /// Open addressing: a place and the index of its density; the index [`EMPTY`] if there is none.
    slots: Vec<(GuideCell, u32)>,
    distributions: Vec<DirectionDistribution>,
}

const EMPTY: u32 = u32::MAX;

impl Guide {
    /// From the statistics in cubes and, aggregated from these, in those four times as wide.
    pub(super) fn new(
        fine: &BTreeMap<GuideCell, CellStatistics>,
        coarse: &BTreeMap<GuideCell, CellStatistics>,
    ) -> Self {
        let wide: BTreeMap<GuideCell, [f64; BINS]> =
            coarse.iter().map(|(place, statistics)| (*place, squares(statistics, &[1.0; BINS]))).collect();
        let places = wide.len() + fine.len();
        let mut guide = Self {
            slots: vec![(GuideCell::new(Vec3::ZERO, Vec3::Z), EMPTY); (2 * places + 1).next_power_of_two()],
            distributions: Vec::with_capacity(places),
        };
        wide.iter().for_each(|(place, squares)| guide.insert(*place, squares));
        fine.iter().for_each(|(place, statistics)| guide.insert(*place, &squares(statistics, &wide[&place.coarse()])));
        guide
    }

    fn insert(&mut self, place: GuideCell, squares: &[f64; BINS]) {
        let mut slot = place.hash() & (self.slots.len() - 1);
        while self.slots[slot].1 != EMPTY {
            slot = (slot + 1) & (self.slots.len() - 1);
        }
        self.slots[slot] = (place, self.distributions.len() as u32);
        self.distributions.push(distribution(squares));
    }

    /// The density at a point (render frame, m) of a surface with a unit shading normal; `None` if there were too few paths.
    #[inline(always)]
    pub(crate) fn at(&self, position: Vec3, normal: Vec3) -> Option<&DirectionDistribution> {
        let place = GuideCell::new(position, normal);
        self.find(place).or_else(|| self.find(place.coarse()))
    }

    #[inline(always)]
    fn find(&self, place: GuideCell) -> Option<&DirectionDistribution> {
        let last = self.slots.len().checked_sub(1)?;
        let mut slot = place.hash() & last;
        loop {
            let (cell, number) = self.slots[slot];
            if number == EMPTY {
                return None;
            }
            if cell == place {
                return Some(&self.distributions[number as usize]);
            }
            slot = (slot + 1) & last;
        }
    }

    /// Number of places with a density, of cubes and of those four times as wide together.
    #[cfg(test)]
    pub(crate) fn places(&self) -> usize {
        self.distributions.len()
    }
}

/// Mean squares by bin, over their mean. If there were few paths they are close to the `expected` values and to those of neighbouring bins.
fn squares(statistics: &CellStatistics, expected: &[f64; BINS]) -> [f64; BINS] {
    let mean =
        statistics.iter().map(|bin| bin.squares).sum::<f64>() / statistics.iter().map(|bin| bin.paths).sum::<f64>();
    let of = |bin: usize| (statistics[bin].squares / mean, statistics[bin].paths);
    let squares: [f64; BINS] = core::array::from_fn(|bin| {
        let around = neighbours(bin).map(of).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
        let (sum, count) = of(bin);
        let (sum, count) = (sum + NEIGHBOUR_WEIGHT * around.0, count + NEIGHBOUR_WEIGHT * around.1);
        (sum + PRIOR_PATHS * expected[bin]) / (count + PRIOR_PATHS)
    });
    let mean = squares.iter().sum::<f64>() / BINS as f64;
    squares.map(|square| square / mean)
}

/// The density of least variance: the root of the mean squares, mixed with a uniform part.
fn distribution(squares: &[f64; BINS]) -> DirectionDistribution {
    let roots = squares.map(f64::sqrt);
    let mean = roots.iter().sum::<f64>() / BINS as f64;
    DirectionDistribution::new(&roots.map(|root| COSINE_FRACTION + (1.0 - COSINE_FRACTION) * root / mean))
}

/// Statistics of the directions of one bin.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BinStatistics {
    /// Sum of squares of radiance.
    pub(super) squares: f64,
    pub(super) paths: f64,
}

/// Statistics of one place.
pub(super) type CellStatistics = [BinStatistics; BINS];

/// Number of parts with separate locks.
const PARTS: usize = 16;
/// Unit of the sums: squares of radiance, (W/(m² sr nm))², are resolved from 8e-25 on, and their sums up to 2.8e14. Beyond, densities tend
/// to the cosine's.
const ONE: f64 = (1_u128 << 80) as f64;

/// Minimum number of paths for a place to have a density of its own.
const MIN_PATHS: u32 = 16;

/// Statistics of the directions of one bin, while threads add to it.
#[derive(Clone, Copy, Debug, Default)]
struct BinSum {
    /// Sum of squares of radiance, in units of 1/[`ONE`].
    squares: u128,
    paths: u32,
}

/// A sum of the directions of one bin at one place.
struct TrainingSum {
    place: GuideCell,
    bin: u8,
    sum: BinSum,
}

/// Collects the radiance that paths find behind diffuse surfaces. Threads may add in any order.
#[derive(Debug, Default)]
pub struct Training {
    parts: [Mutex<BTreeMap<(GuideCell, u8), BinSum>>; PARTS],
}

impl Training {
    /// Adds the result of a path that left a place in the directions of a bin: the radiance that arrived from there, W/(m² sr nm), summed
    /// over the path's wavelengths, weighted as at the camera.
    pub(crate) fn add(&self, place: GuideCell, bin: usize, radiance: f32) {
        let square = f64::from(radiance) * f64::from(radiance) * ONE;
        let mut part = self.parts[place.hash() % PARTS].lock().expect("no path panicked");
        let sum = part.entry((place, bin as u8)).or_default();
        sum.squares = sum.squares.saturating_add(square as u128);
        sum.paths = sum.paths.saturating_add(1);
    }

    /// Builds the guide from the results of all paths.
    #[must_use]
    pub fn guide(self) -> Guide {
        let parts = self.parts.map(|part| part.into_inner().expect("no path panicked"));
        // In a fixed order, so that sums have the same bits.
        let sums: Vec<TrainingSum> =
            parts.into_iter().flatten().map(|((place, bin), sum)| TrainingSum { place, bin, sum }).collect();
        Guide::new(&statistics_by_cell(&sums, |place| place), &statistics_by_cell(&sums, GuideCell::coarse))
    }
}

/// Statistics of the places that enough paths have left.
fn statistics_by_cell(
    sums: &[TrainingSum],
    place_of: impl Fn(GuideCell) -> GuideCell,
) -> BTreeMap<GuideCell, CellStatistics> {
    let mut paths: BTreeMap<GuideCell, u32> = BTreeMap::new();
    for TrainingSum { place, sum, .. } in sums {
        *paths.entry(place_of(*place)).or_default() += sum.paths;
    }
    paths.retain(|_, paths| *paths >= MIN_PATHS);
    let mut cells: BTreeMap<GuideCell, CellStatistics> =
        paths.into_keys().map(|place| (place, [BinStatistics::default(); BINS])).collect();
    for TrainingSum { place, bin, sum } in sums {
        if let Some(cell) = cells.get_mut(&place_of(*place)) {
            let bin_statistics = &mut cell[usize::from(*bin)];
            bin_statistics.squares += sum.squares as f64 / ONE;
            bin_statistics.paths += f64::from(sum.paths);
        }
    }
    cells.retain(|_, bins| bins.iter().any(|bin| bin.squares > 0.0));
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubes_grow_with_the_distance_and_hold_what_is_near_each_other() {
        let at = |x: f32| GuideCell::new(Vec3::new(x, 0.001, 0.001), Vec3::Z);
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
        let mut places: Vec<GuideCell> = points.iter().map(|p| GuideCell::new(*p, Vec3::X)).collect();
        places.sort_unstable();
        places.dedup();
        // Cubes of 1/16 m; -0.395 m to 0.395 m covers fourteen.
        assert_eq!(places.len(), 14 * 14);
    }

    #[test]
    fn sides_of_a_wall_and_walls_that_meet_differ() {
        let at = Vec3::new(2.0, 1.0, 0.5);
        let normals = [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z, Vec3::new(0.6, 0.0, 0.8)];
        let places = normals.map(|normal| GuideCell::new(at, normal));
        for (i, place) in places.iter().enumerate() {
            assert!(!places[..i].contains(place), "{i}");
        }
    }

    /// From the smallest to the largest numbers there is a place, and the same one for the same point.
    #[test]
    fn every_point_has_a_place() {
        for scale in [0.0, 1e-38, 1e-30, 1e-25, 1e-20, 1.0, 1e12, 1e30, f32::MAX / 4.0] {
            let point = Vec3::new(0.3, -0.7, 0.6) * scale;
            assert_eq!(GuideCell::new(point, Vec3::Z), GuideCell::new(point, Vec3::Z), "{scale}");
        }
        assert_ne!(GuideCell::new(Vec3::splat(1e-20), Vec3::Z), GuideCell::new(Vec3::splat(1e12), Vec3::Z));
    }
}
