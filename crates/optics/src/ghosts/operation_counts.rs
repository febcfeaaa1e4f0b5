//! What a layer of ghosts has to do, counted before it is made: a plan foretells its cost from it.

use super::GhostSettings;
use super::footprint::{NODES, NODES_OF_LOOK};
use super::response::{ANGLES, knots};
use crate::lens::Prescribed;
use crate::prescription::ghost::GhostPair;

/// Numbers of what takes time, of a picture that has light at all field angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GhostOperationCounts {
    /// Surfaces that rays meet, if none is lost on its way and no pair is left out.
    pub met: f64,
    /// Beams laid on the sensor: one a source, a pair and a tabulated wavelength, if no pair is left out.
    pub laid: f64,
}

/// What the ghosts of so many sources take between two wavelengths, nm. How many a picture has, only its light tells: a quite
/// even one 1024, one with half of its light in the sun about 260, a single lamp 1.
#[must_use]
pub fn operation_counts(
    lens: &Prescribed,
    settings: GhostSettings,
    range_nm: [f64; 2],
    sources: f64,
) -> GhostOperationCounts {
    let prescription = lens.prescription();
    let pairs = prescription.ghost_pairs(settings.sensor_reflectance > 0.0);
    let (wavelengths, surfaces) = (knots(lens, range_nm).len() as f64, prescription.surfaces().len());
    // Through the lens, and twice what lies between the mirrors.
    let way = |pair: &GhostPair| (surfaces + 2 * (pair.rear - pair.front)) as f64;
    let rays = (NODES_OF_LOOK as f64 + wavelengths * NODES as f64) * ANGLES as f64;
    GhostOperationCounts {
        met: rays * pairs.iter().map(way).sum::<f64>(),
        laid: sources * wavelengths * pairs.len() as f64,
    }
}
