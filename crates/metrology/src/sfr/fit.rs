//! Position of the edge and selection of pixels: Gauss–Newton on edge and profile together, without defective pixels.

use etendue_stats::upper_median;

use super::knots::{Knots, Sample};
use super::{Edge, SfrError, SfrSettings, profile::Profile};
use crate::Image;

/// Maximum number of refinement steps, and the change that ends them, px.
const ROUNDS: usize = 30;
const MIN_MOVE_PX: f64 = 1e-4;
/// Detection of defective pixels, which are left out. A pixel's residual is compared with those of this many pixels at the next
/// smaller and larger distances. It must differ by more than a number of robust standard deviations (1.4826 times the median of
/// the magnitudes in their zone, as demosaicing scatters pixels near the edge), and by more than a fraction of the edge's height.
/// Also the maximum fraction of defects, and the number of search passes.
const NEIGHBOURS: usize = 4;
const ZONES_PX: [f64; 2] = [1.0, 3.0];
const OUTLIER_SIGMAS: f64 = 6.0;
const OUTLIER_SHARE: f64 = 0.05;
const MAX_OUTLIERS: f64 = 0.02;
const REJECTIONS: usize = 8;

/// Fits edge and profile to the pixels marked in `seen`, and again without the defective ones.
pub(super) fn fitted(
    image: &Image,
    seen: &[bool],
    start: Edge,
    settings: &SfrSettings,
) -> Result<(Edge, Profile), SfrError> {
    let mut kept = seen.to_vec();
    let mut edge = settled(image, start, &kept, settings)?;
    for _ in 0..REJECTIONS {
        let found = regular(image, seen, &edge, &kept, settings)?;
        if found == kept {
            break;
        }
        kept = found;
        edge = settled(image, edge, &kept, settings)?;
    }
    edge.check()?;
    let samples = samples(image, &edge, &kept);
    let knots = Knots::new(image, &edge, &samples, settings)?;
    let profile = Profile::of(knots, &samples, image).ok_or(SfrError::NoEdge("the profile has gaps"))?;
    profile.check(&edge)?;
    Ok((edge, profile))
}

fn samples(image: &Image, edge: &Edge, kept: &[bool]) -> Vec<Sample> {
    let sample = |i: usize| {
        let (x, y) = (i % image.width(), i / image.width());
        let (column, row) = (x as f64 + 0.5, y as f64 + 0.5);
        Sample { pixel: i, distance: edge.distance(column, row), row, reading: f64::from(image.at(x, y)) }
    };
    (0..kept.len()).filter(|i| kept[*i]).map(sample).collect()
}

/// The best-fitting edge: Gauss–Newton on edge and profile together, so that neither constrains the other.
fn settled(image: &Image, start: Edge, kept: &[bool], settings: &SfrSettings) -> Result<Edge, SfrError> {
    let mut edge = start;
    let mut best: Option<(f64, Edge, Vec<f64>)> = None;
    for _ in 0..ROUNDS {
        let samples = samples(image, &edge, kept);
        let knots = Knots::new(image, &edge, &samples, settings)?;
        let (squares, mut by) = knots.correction(&samples, &edge, settings.edge_degree)?;
        // A step that increased the residual was too large: half of it.
        match best.as_mut().filter(|(least, ..)| squares > *least) {
            Some((_, from, last)) => {
                last.iter_mut().for_each(|v| *v *= 0.5);
                (edge, by) = (from.clone(), last.clone());
            }
            None => best = Some((squares, edge.clone(), by.clone())),
        }
        edge = edge.moved(&by);
        if by.iter().all(|move_px| move_px.abs() < MIN_MOVE_PX) {
            break;
        }
    }
    Ok(edge)
}

/// Marks pixels that are not defective, by their residuals from the profile of the pixels accepted so far.
fn regular(
    image: &Image,
    seen: &[bool],
    edge: &Edge,
    kept: &[bool],
    settings: &SfrSettings,
) -> Result<Vec<bool>, SfrError> {
    let believed = samples(image, edge, kept);
    let knots = Knots::new(image, edge, &believed, settings)?;
    let normal = knots.normal(&believed, &knots.rows(&believed));
    let levels = normal.solve().ok_or(SfrError::NoEdge("the profile has gaps"))?;
    let samples = samples(image, edge, seen);
    let residuals: Vec<f64> =
        samples.iter().zip(knots.rows(&samples)).map(|(s, row)| s.reading - row.dot(&levels)).collect();
    let apart = apart_from_neighbours(&samples, &residuals);
    let [left, right] = knots.plateaus(&levels);
    let least = OUTLIER_SHARE * (right - left).abs();
    let zone = |s: &Sample| ZONES_PX.iter().filter(|far| s.distance.abs() > **far).count();
    let limit = |z: usize| {
        let within = samples.iter().zip(&apart).filter(|(s, _)| zone(s) == z);
        (OUTLIER_SIGMAS * 1.4826 * upper_median(within.map(|(_, r)| *r)).unwrap_or(0.0)).max(least)
    };
    let limits: Vec<f64> = (0..=ZONES_PX.len()).map(limit).collect();
    let defects: Vec<&Sample> =
        samples.iter().zip(&apart).filter(|(s, r)| **r > limits[zone(s)]).map(|(s, _)| s).collect();
    if defects.len() as f64 > MAX_OUTLIERS * samples.len() as f64 {
        return Err(SfrError::NoEdge("more than 2 % of the pixels do not fit one straight edge"));
    }
    let mut kept = seen.to_vec();
    defects.iter().for_each(|s| kept[s.pixel] = false);
    Ok(kept)
}

/// Difference of each residual from the median of those at the nearest distances, which removes the common misfit of the splines.
fn apart_from_neighbours(samples: &[Sample], residuals: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..samples.len()).collect();
    order.sort_by(|a, b| samples[*a].distance.total_cmp(&samples[*b].distance));
    let mut apart = vec![0.0; samples.len()];
    for (place, i) in order.iter().enumerate() {
        let near = &order[place.saturating_sub(NEIGHBOURS)..(place + NEIGHBOURS + 1).min(order.len())];
        apart[*i] = (residuals[*i] - upper_median(near.iter().map(|k| residuals[*k])).unwrap_or(0.0)).abs();
    }
    apart
}
