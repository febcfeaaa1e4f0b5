//! Distortion from one image of a plane chart, without a model of the lens.
//!
//! 1. The radial polynomial of k₁ and k₂ nearest to the image is fitted in both directions, with its centre ([`RadialFit`]).
//! 2. Starting with the better one, image positions are mapped to those of a camera without distortion that has the scale at the
//!    image centre and the same tilt of the chart ([`ideal`](IdealMap)). The map has degree nine; its value, slope and, as nearly as
//!    possible, curvature at the centre are a homography's. (For discs, the shift of each centroid is subtracted and the map
//!    fitted again; [`disc`](crate::patch_statistics).)
//! 3. The ratio of the two distances from the centre, observed over ideal, against the observed one in half diagonals, is the
//!    distortion curve ([`curve`](CurvePoint)); less 1 it is the local geometric distortion of ISO 17850:2015, whose ideal scale
//!    is also that of the dots about the centre ([`LocalDistortion`]).
//! 4. The bow of rows and columns relative to the image height is ISO 17850's line distortion ([`LineBow`]).
//! 5. The height of the image at its sides relative to the middle, from the outermost rows that reach from side to side, is the
//!    picture-height (television) distortion.
//!
//! Positions are raster coordinates, px; ratios are dimensionless. The ideal scale is a slope at one point, where a chart of few
//! points gives little information. Terms beyond k₁, k₂ and second degree therefore count as far as the points show them; what
//! the points leave open is included in the uncertainty with the points' own scatter
//! ([`fit_mixed_model`](crate::fit::fit_mixed_model())). Charts with 16 points or more can be measured; fewer points give larger
//! uncertainties.
//!
//! Assumptions: point errors are independent and have equal variance; the departure from k₁ and k₂ is a smooth field of about
//! equal size in both directions. The part of a decentred distortion that looks like a tilt at the centre is in neither the map
//! nor the curve: [`Distortion::largest_difference`] reveals it. Limitations: errors of the chart itself.

mod base;
mod curve;
mod fields;
mod ideal;
mod radial;

use etendue_projection::DistortionDirection;
use glam::DVec2;
use rayon::prelude::*;

use crate::target::{Grid, Node};
use crate::{Estimate, calibrate::Sightings};

pub use curve::{CurvePoint, LineBow, LocalDistortion};
pub use fields::DistortionError;
pub use ideal::IdealMap;
pub use radial::RadialFit;

/// Distortion of an image.
#[derive(Clone, Debug)]
pub struct Distortion {
    /// Centre of the radial distances, px.
    pub centre_px: DVec2,
    /// Half the image diagonal, px.
    pub half_diagonal_px: f64,
    /// Map from the image to the ideal image.
    pub ideal: IdealMap,
    /// The curve, at equal steps of field as far as the chart reaches.
    pub curve: Vec<CurvePoint>,
    /// Local distortion at every point of the chart except those at the centre itself.
    pub local: Vec<LocalDistortion>,
    /// The largest of them by magnitude, with the uncertainty of the largest.
    pub largest: Option<LocalDistortion>,
    /// Rows and columns.
    pub lines: Vec<LineBow>,
    /// Picture-height distortion: height at the sides relative to the middle, less 1; `None` if fewer than two rows reach from side
    /// to side.
    pub height: Option<Estimate>,
    /// k₁, k₂ from ideal to observed.
    pub forward: RadialFit,
    /// k₁, k₂ from observed to ideal.
    pub backward: RadialFit,
}

impl Distortion {
    /// The point of the largest difference between the curve and k₁, k₂ (observed to ideal) relative to their joint uncertainty:
    /// the curve's point, the ratio from the coefficients, and the normalised error (k = 2).
    #[must_use]
    pub fn largest_difference(&self) -> Option<(CurvePoint, Estimate, f64)> {
        let deviation = |p: &CurvePoint| {
            let by_fit = self.backward.ratio(p.field);
            (*p, by_fit, p.ratio.normalised_error(by_fit).abs())
        };
        self.curve.iter().map(deviation).max_by(|a, b| a.2.total_cmp(&b.2))
    }
}

/// Measures the distortion of a grid about a centre (the image centre by default).
///
/// # Errors
/// [`DistortionError`].
pub fn distortion(grid: &Grid, size_px: [usize; 2], centre_px: Option<DVec2>) -> Result<Distortion, DistortionError> {
    let size = DVec2::new(size_px[0] as f64, size_px[1] as f64);
    let centre = centre_px.unwrap_or(0.5 * size);
    let half_diagonal_px = 0.5 * size.length();
    if grid.nodes.len() < ideal::MIN_NODES {
        return Err(DistortionError::Few { points: grid.nodes.len(), least: ideal::MIN_NODES });
    }
    let fitted_maps = correct_disc_shifts(grid, centre, half_diagonal_px)?;
    let FittedMaps { nodes, ideal, forward, backward } = fitted_maps;
    let local = curve::all(&ideal, &nodes, half_diagonal_px);
    Ok(Distortion {
        centre_px: centre,
        half_diagonal_px,
        curve: curve::curve(&ideal, &nodes, half_diagonal_px),
        largest: curve::largest(&ideal, &local),
        local,
        lines: curve::bows(&nodes, grid.size, centre, size.y),
        height: curve::image_height(&nodes, grid.size),
        forward,
        backward,
        ideal,
    })
}

/// The maps, and the points used to fit them.
struct FittedMaps {
    nodes: Vec<Node>,
    ideal: IdealMap,
    forward: RadialFit,
    backward: RadialFit,
}

/// The maps of a grid; for discs, centroids are replaced by the discs' centres.
fn correct_disc_shifts(grid: &Grid, centre: DVec2, half_diagonal_px: f64) -> Result<FittedMaps, DistortionError> {
    const ROUNDS: usize = 2;
    let mut result = maps(grid.nodes.clone(), grid.size, centre, half_diagonal_px)?;
    let Some(radius) = grid.disc_radius_steps else { return Ok(result) };
    for _ in 0..ROUNDS {
        let moved = grid.nodes.par_iter().map(|node| {
            let shift = result.ideal.disc_shift(node, radius).unwrap_or(DVec2::ZERO);
            Node { at: node.at - shift, ..*node }
        });
        result = maps(moved.collect(), grid.size, centre, half_diagonal_px)?;
    }
    Ok(result)
}

fn maps(
    nodes: Vec<Node>,
    size: [usize; 2],
    centre: DVec2,
    half_diagonal_px: f64,
) -> Result<FittedMaps, DistortionError> {
    let grid = Grid { nodes, disc_radius_steps: None, size };
    let points = Sightings::from_grid(&grid, 1.0).points;
    let radial = |sense| RadialFit::new(&points, sense, centre, half_diagonal_px);
    let (forward, backward) =
        (radial(DistortionDirection::IdealToObserved)?, radial(DistortionDirection::ObservedToIdeal)?);
    let ideal = IdealMap::from_nodes(&grid.nodes, centre, [&forward, &backward], half_diagonal_px)?;
    Ok(FittedMaps { nodes: grid.nodes, ideal, forward, backward })
}
