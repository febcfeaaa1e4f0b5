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
const OUTLIER_FRACTION: f64 = 0.05;
const MAX_OUTLIERS: f64 = 0.02;
const REJECTIONS: usize = 8;

/// Fits edge and profile to the pixels marked in `seen`, and again without the defective ones.
pub(super) fn fit_edge(
    image: &Image,
    usable: &[bool],
    start: Edge,
    settings: &SfrSettings,
) -> Result<(Edge, Profile), SfrError> {
    let mut inliers = usable.to_vec();
    let mut edge = converged_edge(image, start, &inliers, settings)?;
    for _ in 0..REJECTIONS {
        let next_inliers = regular_pixels(image, usable, &edge, &inliers, settings)?;
        if next_inliers == inliers {
            break;
        }
        inliers = next_inliers;
        edge = converged_edge(image, edge, &inliers, settings)?;
    }
    edge.check()?;
    let samples = samples(image, &edge, &inliers);
    let knots = Knots::new(image, &edge, &samples, settings)?;
    let profile = Profile::fit(knots, &samples, image).ok_or(SfrError::NoEdge("the profile has gaps"))?;
    profile.check(&edge)?;
    Ok((edge, profile))
}

fn samples(image: &Image, edge: &Edge, inliers: &[bool]) -> Vec<Sample> {
    let sample = |i: usize| {
        let (x, y) = (i % image.width(), i / image.width());
        let (column, row) = (x as f64 + 0.5, y as f64 + 0.5);
        Sample { pixel: i, distance: edge.distance(column, row), row, reading: f64::from(image.at(x, y)) }
    };
    (0..inliers.len()).filter(|i| inliers[*i]).map(sample).collect()
}

/// The best-fitting edge: Gauss–Newton on edge and profile together, so that neither constrains the other.
fn converged_edge(image: &Image, start: Edge, inliers: &[bool], settings: &SfrSettings) -> Result<Edge, SfrError> {
    let mut edge = start;
    let mut best: Option<(f64, Edge, Vec<f64>)> = None;
    for _ in 0..ROUNDS {
        let samples = samples(image, &edge, inliers);
        let knots = Knots::new(image, &edge, &samples, settings)?;
        let (squares, mut by) = knots.correction(&samples, &edge, settings.edge_degree)?;
        // A step that increased the residual was too large: half of it.
        match best.as_mut().filter(|(min_squares, ..)| squares > *min_squares) {
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
fn regular_pixels(
    image: &Image,
    usable: &[bool],
    edge: &Edge,
    inliers: &[bool],
    settings: &SfrSettings,
) -> Result<Vec<bool>, SfrError> {
    let inlier_samples = samples(image, edge, inliers);
    let knots = Knots::new(image, edge, &inlier_samples, settings)?;
    let normal = knots.normal(&inlier_samples, &knots.rows(&inlier_samples));
    let levels = normal.solve().ok_or(SfrError::NoEdge("the profile has gaps"))?;
    let samples = samples(image, edge, usable);
    let residuals: Vec<f64> =
        samples.iter().zip(knots.rows(&samples)).map(|(s, row)| s.reading - row.dot(&levels)).collect();
    let neighbour_deviations = outliers_by_neighbours(&samples, &residuals);
    let [left, right] = knots.plateaus(&levels);
    let min_deviation = OUTLIER_FRACTION * (right - left).abs();
    let zone = |s: &Sample| ZONES_PX.iter().filter(|far| s.distance.abs() > **far).count();
    let limit = |z: usize| {
        let within = samples.iter().zip(&neighbour_deviations).filter(|(s, _)| zone(s) == z);
        (OUTLIER_SIGMAS * 1.4826 * upper_median(within.map(|(_, r)| *r)).unwrap_or(0.0)).max(min_deviation)
    };
    let limits: Vec<f64> = (0..=ZONES_PX.len()).map(limit).collect();
    let defects: Vec<&Sample> =
        samples.iter().zip(&neighbour_deviations).filter(|(s, r)| **r > limits[zone(s)]).map(|(s, _)| s).collect();
    if defects.len() as f64 > MAX_OUTLIERS * samples.len() as f64 {
        return Err(SfrError::NoEdge("more than 2 % of the pixels do not fit one straight edge"));
    }
    let mut next_inliers = usable.to_vec();
    defects.iter().for_each(|s| next_inliers[s.pixel] = false);
    Ok(next_inliers)
}

/// Difference of each residual from the median of those at the nearest distances, which removes the common misfit of the splines.
fn outliers_by_neighbours(samples: &[Sample], residuals: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..samples.len()).collect();
    order.sort_by(|a, b| samples[*a].distance.total_cmp(&samples[*b].distance));
    let mut deviations = vec![0.0; samples.len()];
    for (place, i) in order.iter().enumerate() {
        let near = &order[place.saturating_sub(NEIGHBOURS)..(place + NEIGHBOURS + 1).min(order.len())];
        deviations[*i] = (residuals[*i] - upper_median(near.iter().map(|k| residuals[*k])).unwrap_or(0.0)).abs();
    }
    deviations
}
