//! Distortion from one picture of a plane chart, without a model of the lens.
//!
//! 1. A polynomial of high degree takes places of the picture to the chart ([`ideal`](Ideal)). (Of discs, the shift of each
//!    centroid by the inverse polynomial is taken off first; [`disc`](crate::disc).)
//! 2. At the centre of the picture it is compared with a homography of the same value, slope and, as far as it can,
//!    curvature: how a camera without distortion and with the scale of the picture's centre would see the chart, tilted as it is.
//! 3. That homography says of every place where it would be seen ideally. The ratio of the two distances from the centre,
//!    observed over ideal, against the observed one in half diagonals, is the distortion curve ([`curve`](CurvePoint)); less 1
//!    it is the local geometric distortion of ISO 17850:2015, whose ideal scale is that of the dots about the centre as well.
//! 4. The bow of rows and columns in the picture's height is ISO 17850's line distortion ([`LineBow`]).
//! 5. The height of the picture at its sides over that in the middle, from the outermost rows that reach from side to side, is
//!    the picture-height (television) distortion.
//! 6. k₁ and k₂ of the radial polynomial in either direction, in half diagonals, and its centre, are fitted beside
//!    ([`RadialFit`]).
//!
//! Positions are raster coordinates, px; ratios are pure. Uncertainty: the polynomial's covariance, from its residuals, to
//! first order in its coefficients; the homography's slope and tilt are theirs too. What of a distortion centred elsewhere looks
//! like a tilt at the centre is in it no more than in the curve: [`Distortion::largest_difference`] tells. Left out: what a polynomial of this degree cannot follow (seen in its residuals), and the
//! chart's own errors.

mod curve;
mod ideal;
mod lines;
mod radial;

pub use curve::CurvePoint;
pub use ideal::Ideal;
pub use lines::LineBow;
pub use radial::RadialFit;

use crate::Estimate;
use crate::calibrate::Sightings;
use crate::fit::FitError;
use crate::target::{Grid, Node};
use etendue_projection::Sense;
use glam::DVec2;

/// Why a picture has no distortion to tell.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DistortionError {
    /// Too few points.
    #[error(
        "{points} points of the chart are too few for a distortion curve; at least {least} are needed: use a chart of more points"
    )]
    Few {
        /// Points found.
        points: usize,
        /// Points that would do.
        least: usize,
    },
    /// The chart does not show the centre.
    #[error("the chart does not cover the picture's centre, ({:.1}, {:.1}) px, where ideal scale is taken: centre the chart, or state another centre", centre_px[0], centre_px[1])]
    Centre {
        /// The centre, px.
        centre_px: [f64; 2],
    },
    /// A fit failed.
    #[error(transparent)]
    Fit(#[from] FitError),
}

/// Distortion at one point of the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalDistortion {
    /// Column and row of the point.
    pub index: [usize; 2],
    /// Where it is seen, px.
    pub at: DVec2,
    /// Where it would be seen ideally, px.
    pub ideal: DVec2,
    /// Its distance from the centre, in half diagonals.
    pub field: f64,
    /// (Observed − ideal)/ideal distance from the centre. Its uncertainty is that of the point alone: that of the ideal places,
    /// which neighbours share, is the curve's.
    pub distortion: Estimate,
    /// Standard uncertainty of a coordinate of `at`, px.
    pub uncertainty_px: f64,
}

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
    let nodes = ideal::without_shifts(grid)?;
    let ideal = Ideal::of(&nodes, centre)?;
    let sightings = Sightings::of_grid(&Grid { nodes: nodes.clone(), disc_radius_steps: None, size: grid.size }, 1.0);
    Ok(Distortion {
        centre_px: centre,
        half_diagonal_px,
        curve: curve::curve(&ideal, &nodes, half_diagonal_px),
        local: nodes.iter().filter_map(|n| local(&ideal, n, half_diagonal_px)).collect(),
        lines: lines::bows(&nodes, grid.size, centre, size.y),
        height: lines::picture_height(&nodes, grid.size),
        forward: RadialFit::of(&sightings.points, Sense::IdealToObserved, centre, half_diagonal_px)?,
        backward: RadialFit::of(&sightings.points, Sense::ObservedToIdeal, centre, half_diagonal_px)?,
        ideal,
    })
}

fn local(ideal: &Ideal, node: &Node, half_diagonal_px: f64) -> Option<LocalDistortion> {
    let seen = node.at - ideal.centre();
    let place = ideal.place(node.at);
    // At the centre itself a ratio says nothing.
    let far = seen.length() > 0.02 * half_diagonal_px;
    let ratio = seen.length() / (place - ideal.centre()).length();
    far.then(|| LocalDistortion {
        index: node.index,
        at: node.at,
        ideal: place,
        field: seen.length() / half_diagonal_px,
        distortion: Estimate::new(ratio - 1.0, ratio * node.uncertainty_px / seen.length()),
        uncertainty_px: node.uncertainty_px,
    })
}
