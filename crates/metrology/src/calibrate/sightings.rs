//! Points of a chart that are seen in a picture, what of a camera is stated beforehand, and why there is no camera.

use etendue_projection::{CalibrationError, model::ModelError};
use glam::DVec2;

use crate::{Estimate, fit::FitError};

/// A point of a chart and where it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// On the chart, in the caller's unit of length.
    pub chart: DVec2,
    /// Raster coordinates, px.
    pub at: DVec2,
}

/// One picture of the chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Sightings {
    /// Its points.
    pub points: Vec<Sighting>,
    /// Of discs, whose centroids were seen: their radius, in the caller's unit of length.
    pub disc_radius: Option<f64>,
}

impl Sightings {
    /// The points of a grid whose steps on the chart have a length.
    #[must_use]
    pub fn of_grid(grid: &crate::target::Grid, step: f64) -> Self {
        let chart = |[i, j]: [usize; 2]| DVec2::new(i as f64, j as f64) * step;
        let points = grid.nodes.iter().map(|n| Sighting { chart: chart(n.index), at: n.at });
        Self { points: points.collect(), disc_radius: grid.disc_radius_steps.map(|r| r * step) }
    }
}

/// What is known before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// fx = fy.
    pub square_pixels: bool,
    /// The principal point is this, raster coordinates; otherwise it is fitted.
    pub principal_px: Option<DVec2>,
    /// The focal length (principal distance) is this, px; otherwise it is fitted.
    pub focal_px: Option<f64>,
    /// The entrance pupil is at this distance from the chart's plane in every view, in the caller's unit of length.
    pub distance: Option<Estimate>,
    /// Points far from the fit count less.
    pub robust: bool,
}

/// Why views give no camera.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CalibrateError {
    /// No views at all.
    #[error("no views: give at least one picture of the chart")]
    NoViews,
    /// A view of too few points.
    #[error("view {} shows {points} points of the chart; at least {least} are needed: leave it out", view + 1)]
    Sparse {
        /// The view, from 0.
        view: usize,
        /// Its points.
        points: usize,
        /// Points that would do.
        least: usize,
    },
    /// One view is the reason.
    #[error(
        "view {}: without it the others give a camera, with it: {cause}. See how its points are numbered, leave it out, or give more views",
        view + 1
    )]
    View {
        /// The view, from 0.
        view: usize,
        /// What is wrong with all.
        cause: Box<CalibrateError>,
    },
    /// No first guess.
    #[error(
        "the points lie on no plane chart as this model would see it: check the order of the points and the model (a fisheye for \
         very wide fields)"
    )]
    Start,
    /// The fit failed.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The fitted coefficients are no model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The fitted numbers are no camera.
    #[error(transparent)]
    Camera(#[from] CalibrationError),
    /// What is stated is not what the views show.
    #[error(
        "the stated distance, {} ± {}, is not what the views show, {:.6} ± {:.2} (in the pitch's unit): check distance and pitch, state the \
         distance's uncertainty, or leave it out", stated.value, stated.standard_uncertainty, shown.value, shown.standard_uncertainty
    )]
    Distance {
        /// As stated.
        stated: Estimate,
        /// As the views show it.
        shown: Estimate,
    },
    /// Numbers that the views do not tell.
    #[error(
        "the views do not determine {}: add views with the chart turned by 20° to 45° about different axes and out to the picture's \
         corners, state the chart's distance, or fit a model of fewer coefficients (a narrow field does not tell those of wide ones)", names.join(", ")
    )]
    Undetermined {
        /// Their names.
        names: Vec<String>,
    },
}
