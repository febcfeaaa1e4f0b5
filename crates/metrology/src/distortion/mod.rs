//! Distortion from one picture of a plane chart, without a model of the lens.
//!
//! 1. The radial polynomial of k₁ and k₂ nearest to the picture is found in either direction, with its centre ([`RadialFit`]).
//! 2. Beginning with the better one, places of the picture are taken to where a camera without distortion and with the scale of the
//!    picture's centre would see the same, the chart tilted as it is ([`ideal`](Ideal)): by a map of the ninth degree of which value,
//!    slope and, as far as it can, curvature at the centre are a homography's. (Of discs, the shift of each centroid is
//!    taken off and the map found again; [`disc`](crate::patch_statistics).)
//! 3. The ratio of the two distances from the centre,
//!    observed over ideal, against the observed one in half diagonals, is the distortion curve ([`curve`](CurvePoint)); less 1
//!    it is the local geometric distortion of ISO 17850:2015, whose ideal scale is that of the dots about the centre as well
//!    ([`LocalDistortion`]).
//! 4. The bow of rows and columns in the picture's height is ISO 17850's line distortion ([`LineBow`]).
//! 5. The height of the picture at its sides over that in the middle, from the outermost rows that reach from side to side, is
//!    the picture-height (television) distortion.
//!
//! Positions are raster coordinates, px; ratios are pure. Ideal scale is a slope at one place, where a chart of few points says little
//! of it: terms beyond k₁, k₂ and second degree count as far as the points show them, and what the points leave open of
//! them is in the uncertainty with the points' own scatter ([`fit_mixed_model`](crate::fit::fit_mixed_model())). So charts of 16 points on are
//! measured; the fewer, the less certain. Assumed: errors of points are independent and alike; what departs from k₁ and k₂ is a smooth field,
//! about as large across the chart as along it. What of a distortion centred elsewhere looks
//! like a tilt at the centre is in it no more than in the curve: [`Distortion::largest_difference`] tells. Left out: the
//! chart's own errors.

mod base;
mod curve;
mod fields;
mod ideal;
mod radial;

use etendue_projection::Sense;
use glam::DVec2;
use rayon::prelude::*;

use crate::target::{Grid, Node};
use crate::{Estimate, calibrate::Sightings};

pub use curve::{CurvePoint, LineBow, LocalDistortion};
pub use fields::DistortionError;
pub use ideal::Ideal;
pub use radial::RadialFit;

/// The distortion of a picture.
#[derive(Clone, Debug)]
pub struct Distortion {
    /// The centre to which distances are taken, px.
    pub centre_px: DVec2,
    /// Half the picture's diagonal, px.
    pub half_diagonal_px: f64,
    /// The way from the picture to the ideal picture.
    pub ideal: Ideal,
    /// The curve, at equal steps of field as far as the chart reaches.
    pub curve: Vec<CurvePoint>,
    /// Every point of the chart but those at the centre itself.
    pub local: Vec<LocalDistortion>,
    /// The one of them that is largest by magnitude, with the uncertainty of the largest.
    pub largest: Option<LocalDistortion>,
    /// Rows and columns.
    pub lines: Vec<LineBow>,
    /// Picture-height distortion: the height at the sides over that in the middle, less 1; `None`
    /// where no two rows reach from side to side.
    pub height: Option<Estimate>,
    /// k₁, k₂ from ideal to observed.
    pub forward: RadialFit,
    /// k₁, k₂ from observed to ideal.
    pub backward: RadialFit,
}

impl Distortion {
    /// Where the curve and k₁, k₂ (observed to ideal) differ the most for their joint uncertainty: the curve's point, the ratio
    /// by the coefficients, and the normalised error (k = 2).
    #[must_use]
    pub fn largest_difference(&self) -> Option<(CurvePoint, Estimate, f64)> {
        let beside = |p: &CurvePoint| {
            let by_fit = self.backward.ratio(p.field);
            (*p, by_fit, p.ratio.normalised_error(by_fit).abs())
        };
        self.curve.iter().map(beside).max_by(|a, b| a.2.total_cmp(&b.2))
    }
}

/// The distortion that a grid shows, about a centre (the picture's middle where none is stated).
///
/// # Errors
/// [`DistortionError`].
pub fn distortion(grid: &Grid, size_px: [usize; 2], centre_px: Option<DVec2>) -> Result<Distortion, DistortionError> {
    let size = DVec2::new(size_px[0] as f64, size_px[1] as f64);
    let centre = centre_px.unwrap_or(0.5 * size);
    let half_diagonal_px = 0.5 * size.length();
    if grid.nodes.len() < ideal::LEAST {
        return Err(DistortionError::Few { points: grid.nodes.len(), least: ideal::LEAST });
    }
    let found = without_shifts(grid, centre, half_diagonal_px)?;
    let Found { nodes, ideal, forward, backward } = found;
    let local = curve::all(&ideal, &nodes, half_diagonal_px);
    Ok(Distortion {
        centre_px: centre,
        half_diagonal_px,
        curve: curve::curve(&ideal, &nodes, half_diagonal_px),
        largest: curve::largest(&ideal, &local),
        local,
        lines: curve::bows(&nodes, grid.size, centre, size.y),
        height: curve::picture_height(&nodes, grid.size),
        forward,
        backward,
        ideal,
    })
}

/// The maps, and the points from which they were found.
struct Found {
    nodes: Vec<Node>,
    ideal: Ideal,
    forward: RadialFit,
    backward: RadialFit,
}

/// The maps of a grid, of discs with each disc's centre where its centroid was.
fn without_shifts(grid: &Grid, centre: DVec2, half_diagonal_px: f64) -> Result<Found, DistortionError> {
    const ROUNDS: usize = 2;
    let mut found = maps(grid.nodes.clone(), grid.size, centre, half_diagonal_px)?;
    let Some(radius) = grid.disc_radius_steps else { return Ok(found) };
    for _ in 0..ROUNDS {
        let moved = grid.nodes.par_iter().map(|seen| {
            let shift = found.ideal.disc_shift(seen, radius).unwrap_or(DVec2::ZERO);
            Node { at: seen.at - shift, ..*seen }
        });
        found = maps(moved.collect(), grid.size, centre, half_diagonal_px)?;
    }
    Ok(found)
}

fn maps(nodes: Vec<Node>, size: [usize; 2], centre: DVec2, half_diagonal_px: f64) -> Result<Found, DistortionError> {
    let grid = Grid { nodes, disc_radius_steps: None, size };
    let points = Sightings::of_grid(&grid, 1.0).points;
    let radial = |sense| RadialFit::of(&points, sense, centre, half_diagonal_px);
    let (forward, backward) = (radial(Sense::IdealToObserved)?, radial(Sense::ObservedToIdeal)?);
    let ideal = Ideal::of(&grid.nodes, centre, [&forward, &backward], half_diagonal_px)?;
    Ok(Found { nodes: grid.nodes, ideal, forward, backward })
}
