//! What paths find, by place and direction.

use super::distribution::BINS;
use super::found::{Found, FoundByBin};
use super::guide::Guide;
use super::place::Place;
use std::collections::BTreeMap;
use std::sync::Mutex;

/// Parts that are locked apart.
const PARTS: usize = 16;
/// What 1 counts as: squares of radiance, (W/(m² sr nm))², from 8e-25 on are told apart, and their sums to 2.8e14. Beyond, densities tend to the cosine's.
const ONE: f64 = (1_u128 << 80) as f64;

/// Paths below which a place has no density of its own.
const LEAST_PATHS: u32 = 16;

/// What was found in the directions of one bin, while threads add to it.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    /// Sum of squares of radiance, in units of 1/[`ONE`].
    squares: u128,
    paths: u32,
}

/// Gathers what paths find behind matt surfaces. Threads may add in any order.
#[derive(Debug, Default)]
pub struct Training {
    parts: [Mutex<BTreeMap<(Place, u8), Sum>>; PARTS],
}

impl Training {
    /// Adds what a path has found that left a place in the directions of a bin: the radiance that arrived by them, W/(m² sr nm), summed over the
    /// path's wavelengths as they count at the camera.
    pub(crate) fn add(&self, place: Place, bin: usize, radiance: f32) {
        let square = f64::from(radiance) * f64::from(radiance) * ONE;
        let mut part = self.parts[place.hash() % PARTS].lock().expect("no path panicked");
        let sum = part.entry((place, bin as u8)).or_default();
        sum.squares = sum.squares.saturating_add(square as u128);
        sum.paths = sum.paths.saturating_add(1);
    }

    /// What all paths have found.
    #[must_use]
    pub fn guide(self) -> Guide {
        let parts = self.parts.map(|part| part.into_inner().expect("no path panicked"));
        // In an order that is always the same, so that sums have the same bits.
        let sums: Vec<(Place, u8, Sum)> =
            parts.into_iter().flatten().map(|((place, bin), sum)| (place, bin, sum)).collect();
        Guide::new(&by_place(&sums, |place| place), &by_place(&sums, Place::coarse))
    }
}

/// What was found at the places that enough paths have left.
fn by_place(sums: &[(Place, u8, Sum)], place_of: impl Fn(Place) -> Place) -> BTreeMap<Place, FoundByBin> {
    let mut paths: BTreeMap<Place, u32> = BTreeMap::new();
    for (place, _, sum) in sums {
        *paths.entry(place_of(*place)).or_default() += sum.paths;
    }
    paths.retain(|_, paths| *paths >= LEAST_PATHS);
    let mut found: BTreeMap<Place, FoundByBin> =
        paths.into_keys().map(|place| (place, [Found::default(); BINS])).collect();
    for (place, bin, sum) in sums {
        if let Some(found) = found.get_mut(&place_of(*place)) {
            let found = &mut found[usize::from(*bin)];
            found.squares += sum.squares as f64 / ONE;
            found.paths += f64::from(sum.paths);
        }
    }
    found.retain(|_, found| found.iter().any(|bin| bin.squares > 0.0));
    found
}
