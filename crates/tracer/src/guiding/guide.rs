//! What was learnt, ready to be asked.

use super::distribution::{BINS, DirectionDistribution, neighbours};
use super::found::FoundByBin;
use super::place::Place;
use glam::Vec3;
use std::collections::BTreeMap;

/// Share of the cosine in the mixture (defensive sampling): no weight is more than five times that without a guide.
const UNGUIDED: f64 = 0.2;
/// Paths a bin for which what is expected of it counts.
const EXPECTED_PATHS: f64 = 4.0;
/// What a path of a neighbouring bin counts.
const NEIGHBOUR: f64 = 0.5;

/// Densities of directions at matt surfaces by their place.
#[derive(Clone, Debug, Default)]
pub struct Guide {
    /// Open addresses: a place and the number of its density; the number [`EMPTY`] where there is none.
    slots: Vec<(Place, u32)>,
    distributions: Vec<DirectionDistribution>,
}

/// No density's number.
const EMPTY: u32 = u32::MAX;

impl Guide {
    /// Of what was found in cubes and, of all of these, in those four times as wide.
    pub(super) fn new(fine: &BTreeMap<Place, FoundByBin>, coarse: &BTreeMap<Place, FoundByBin>) -> Self {
        let wide: BTreeMap<Place, [f64; BINS]> =
            coarse.iter().map(|(place, found)| (*place, squares(found, &[1.0; BINS]))).collect();
        let places = wide.len() + fine.len();
        let mut guide = Self {
            slots: vec![(Place::of(Vec3::ZERO, Vec3::Z), EMPTY); (2 * places + 1).next_power_of_two()],
            distributions: Vec::with_capacity(places),
        };
        wide.iter().for_each(|(place, squares)| guide.insert(*place, squares));
        fine.iter().for_each(|(place, found)| guide.insert(*place, &squares(found, &wide[&place.coarse()])));
        guide
    }

    fn insert(&mut self, place: Place, squares: &[f64; BINS]) {
        let mut slot = place.hash() & (self.slots.len() - 1);
        while self.slots[slot].1 != EMPTY {
            slot = (slot + 1) & (self.slots.len() - 1);
        }
        self.slots[slot] = (place, self.distributions.len() as u32);
        self.distributions.push(distribution(squares));
    }

    /// The density at a point (render frame, m) of a surface with a unit shading normal; `None` where too few paths came.
    #[inline(always)]
    pub(crate) fn at(&self, position: Vec3, normal: Vec3) -> Option<&DirectionDistribution> {
        let place = Place::of(position, normal);
        self.of(place).or_else(|| self.of(place.coarse()))
    }

    #[inline(always)]
    fn of(&self, place: Place) -> Option<&DirectionDistribution> {
        let last = self.slots.len().checked_sub(1)?;
        let mut slot = place.hash() & last;
        loop {
            let (found, number) = self.slots[slot];
            if number == EMPTY {
                return None;
            }
            if found == place {
                return Some(&self.distributions[number as usize]);
            }
            slot = (slot + 1) & last;
        }
    }

    /// How many places have a density, of cubes and of those four times as wide together.
    #[cfg(test)]
    pub(crate) fn places(&self) -> usize {
        self.distributions.len()
    }
}

/// Mean squares by bin, over their mean; where few paths came they are near what is `expected`, and like those of neighbouring bins.
fn squares(found: &FoundByBin, expected: &[f64; BINS]) -> [f64; BINS] {
    let mean = found.iter().map(|bin| bin.squares).sum::<f64>() / found.iter().map(|bin| bin.paths).sum::<f64>();
    let of = |bin: usize| (found[bin].squares / mean, found[bin].paths);
    let squares: [f64; BINS] = core::array::from_fn(|bin| {
        let around = neighbours(bin).map(of).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
        let (sum, count) = of(bin);
        let (sum, count) = (sum + NEIGHBOUR * around.0, count + NEIGHBOUR * around.1);
        (sum + EXPECTED_PATHS * expected[bin]) / (count + EXPECTED_PATHS)
    });
    let mean = squares.iter().sum::<f64>() / BINS as f64;
    squares.map(|square| square / mean)
}

/// The density of least variance: the root of the mean squares; a part of it even.
fn distribution(squares: &[f64; BINS]) -> DirectionDistribution {
    let roots = squares.map(f64::sqrt);
    let mean = roots.iter().sum::<f64>() / BINS as f64;
    DirectionDistribution::new(&roots.map(|root| UNGUIDED + (1.0 - UNGUIDED) * root / mean))
}
