//! The footprints of a lens by field angle, pair and wavelength, and the operation counts of a layer of ghosts.

use rayon::prelude::*;

use super::footprint::{COARSE_NODES, Footprint, GhostBeam, NODES};
use super::{GhostSettings, mirrored};
use crate::{lens::PrescriptionLens, prescription::ghost::GhostPair};

/// Field angles from the axis to the largest.
pub(super) const ANGLES: usize = 48;
/// Maximum total fraction of an angle's ghost light in omitted pairs.
const MAX_OMITTED_FRACTION: f64 = 5e-3;
/// Maximum distance of wavelengths, nm.
const KNOT_NM: f64 = 100.0;

/// One angle's footprints: by pair (the relevant ones), by wavelength.
type AngleFootprints = Vec<Option<Vec<Footprint>>>;

/// Tabulated ghosts.
pub(super) struct Response {
    pub(super) pairs: Vec<GhostPair>,
    pub(super) knots_nm: Vec<f64>,
    step: f64,
    /// By angle; `None` if no source is near.
    table: Vec<Option<AngleFootprints>>,
}

impl Response {
    /// Footprints at the tabulated angles next to the `wanted` ones (rad, increasing to at most `greatest`).
    pub(super) fn new(
        lens: &PrescriptionLens,
        settings: GhostSettings,
        range_nm: [f64; 2],
        maximum: f64,
        needed: &[f64],
    ) -> Self {
        let pairs = lens.prescription().ghost_pairs(settings.sensor_reflectance > 0.0);
        let (knots_nm, step) = (knots(lens, range_nm), maximum / (ANGLES - 1) as f64);
        let mut near = [false; ANGLES];
        for angle in needed {
            let i = place(*angle, step).0;
            (near[i], near[i + 1]) = (true, true);
        }
        let at = |i: usize| near[i].then(|| at_angle(lens, settings, step * i as f64, &pairs, &knots_nm));
        let table = (0..ANGLES).into_par_iter().map(at).collect();
        Self { pairs, knots_nm, step, table }
    }

    /// The footprints of a pair (by its index in the list) at an angle; `None` if it is omitted.
    pub(super) fn at(&self, angle: f64, pair: usize) -> Option<Vec<Footprint>> {
        let (i, fraction) = place(angle, self.step);
        let side = |i: usize| self.table[i].as_ref().and_then(|pairs| pairs[pair].as_ref());
        match (side(i), side(i + 1)) {
            (Some(a), Some(b)) => Some(a.iter().zip(b).map(|(a, b)| a.mix(b, fraction)).collect()),
            (Some(a), None) => Some(a.iter().map(|a| a.dimmed(1.0 - fraction)).collect()),
            (None, Some(b)) => Some(b.iter().map(|b| b.dimmed(fraction)).collect()),
            (None, None) => None,
        }
    }
}

/// The tabulated angle below, and the fraction towards the next.
fn place(angle: f64, step: f64) -> (usize, f32) {
    let place = if step > 0.0 { angle / step } else { 0.0 };
    let i = (place as usize).min(ANGLES - 2);
    (i, (place - i as f64) as f32)
}

/// Uniformly spaced wavelengths over a range: one at its centre for a lens that does not depend on the wavelength.
pub(super) fn knots(lens: &PrescriptionLens, [low, high]: [f64; 2]) -> Vec<f64> {
    if !lens.disperses() {
        return vec![0.5 * (low + high)];
    }
    let count = ((high - low) / KNOT_NM).ceil().max(1.0) as usize;
    (0..=count).map(|i| low + (high - low) * i as f64 / count as f64).collect()
}

fn at_angle(
    lens: &PrescriptionLens,
    settings: GhostSettings,
    angle: f64,
    pairs: &[GhostPair],
    knots_nm: &[f64],
) -> AngleFootprints {
    let beam = GhostBeam::new(lens.prescription(), angle);
    let middle_nm = knots_nm[knots_nm.len() / 2];
    let survey = |pair: &GhostPair| {
        let (window, area) = beam.survey(*pair, middle_nm)?;
        Some((window, area * mirrored(lens, pair.rear, settings)))
    };
    let surveys: Vec<_> = pairs.iter().map(survey).collect();
    let areas: Vec<f64> = surveys.iter().map(|survey| survey.map_or(0.0, |(_, area)| area)).collect();
    let minimum = threshold(&areas);
    let footprints = |(pair, survey): (&GhostPair, Option<([glam::DVec2; 2], f64)>)| {
        let (window, _) = survey.filter(|(_, area)| *area >= minimum)?;
        Some(knots_nm.iter().map(|nm| beam.footprint(*pair, *nm, window)).collect())
    };
    pairs.iter().zip(surveys).map(footprints).collect()
}

/// The area below which pairs together have at most the fraction of light that may be omitted.
fn threshold(areas: &[f64]) -> f64 {
    let mut rising = areas.to_vec();
    rising.sort_by(f64::total_cmp);
    let total: f64 = rising.iter().sum();
    let mut sum = 0.0;
    let first = rising.into_iter().find(|area| {
        sum += area;
        sum > MAX_OMITTED_FRACTION * total
    });
    first.unwrap_or(f64::INFINITY)
}

/// Operation counts for an image that has light at all field angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GhostOperationCounts {
    /// Surfaces met by rays, if no ray is lost and no pair is omitted.
    pub surface_hits: f64,
    /// Beams splatted onto the sensor: one per source, pair and tabulated wavelength, if no pair is omitted.
    pub splats: f64,
}

/// Operation counts of the ghosts of a number of sources between two wavelengths, nm. The number depends on the light of the image: a nearly uniform
/// one has 1024, one with half of its light in the sun about 260, a single light 1.
#[must_use]
pub fn operation_counts(
    lens: &PrescriptionLens,
    settings: GhostSettings,
    range_nm: [f64; 2],
    sources: f64,
) -> GhostOperationCounts {
    let prescription = lens.prescription();
    let pairs = prescription.ghost_pairs(settings.sensor_reflectance > 0.0);
    let (wavelengths, surfaces) = (knots(lens, range_nm).len() as f64, prescription.surfaces().len());
    // Through the lens, and twice through the part between the reflecting surfaces.
    let surface_count = |pair: &GhostPair| (surfaces + 2 * (pair.rear - pair.front)) as f64;
    let rays = (COARSE_NODES as f64 + wavelengths * NODES as f64) * ANGLES as f64;
    GhostOperationCounts {
        surface_hits: rays * pairs.iter().map(surface_count).sum::<f64>(),
        splats: sources * wavelengths * pairs.len() as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_out_is_little() {
        // 0.3 + 0.1 of 100 may be omitted, with 0.2 more they may not.
        let areas = [60.0, 0.1, 39.4, 0.3, 0.2];
        assert_eq!(threshold(&areas), 0.3);
        assert_eq!(threshold(&[5.0, 5.0]), 5.0);
        assert_eq!(threshold(&[0.0, 0.0]), f64::INFINITY);
    }

    #[test]
    fn places_between_angles() {
        assert_eq!(place(0.5, 0.25), (2, 0.0));
        assert_eq!(place(47.0, 1.0), (46, 1.0));
        assert_eq!(place(0.0, 0.0), (0, 0.0));
    }
}
