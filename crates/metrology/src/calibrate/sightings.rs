//! Observed points of a chart, known properties of a camera, and errors of a calibration.

use etendue_projection::{CalibrationError, model::ModelError};
use glam::DVec2;

use crate::{Estimate, fit::FitError};

/// A point of a chart and its observed position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Position on the chart, in the caller's unit of length.
    pub chart: DVec2,
    /// Observed position, raster coordinates, px.
    pub at: DVec2,
}

/// One image of the chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Sightings {
    pub points: Vec<Sighting>,
    /// Radius of discs whose centroids were observed, in the caller's unit of length.
    pub disc_radius: Option<f64>,
}

impl Sightings {
    /// The points of a grid with a step of this length on the chart.
    #[must_use]
    pub fn from_grid(grid: &crate::target::Grid, step: f64) -> Self {
        let chart = |[i, j]: [usize; 2]| DVec2::new(i as f64, j as f64) * step;
        let points = grid.nodes.iter().map(|n| Sighting { chart: chart(n.index), at: n.at });
        Self { points: points.collect(), disc_radius: grid.disc_radius_steps.map(|r| r * step) }
    }
}

/// Known properties.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CalibrationOptions {
    /// True if fx = fy.
    pub square_pixels: bool,
    /// Known principal point, raster coordinates; fitted if `None`.
    pub principal_px: Option<DVec2>,
    /// Known focal length (principal distance), px; fitted if `None`.
    pub focal_px: Option<f64>,
    /// Distance of the entrance pupil from the chart's plane in every view, in the caller's unit of length.
    pub distance: Option<Estimate>,
    /// True if points far from the fit have less weight.
    pub robust: bool,
}

/// Reason why views do not give a camera.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CalibrateError {
    #[error("no views: give at least one image of the chart")]
    NoViews,
    /// A view with too few points.
    #[error("view {} shows {points} points of the chart; at least {least} are needed: leave it out", view + 1)]
    Sparse {
        /// The view, from 0.
        view: usize,
        /// Number of its points.
        points: usize,
        /// Minimum number of points.
        least: usize,
    },
    /// One view prevents the calibration.
    #[error(
        "view {} prevents the calibration, which succeeds without it: {cause}. Check the numbering of its points, leave the view out, or give more views",
        view + 1
    )]
    View {
        /// The view, from 0.
        view: usize,
        /// The error with all views.
        cause: Box<CalibrateError>,
    },
    /// No initial guess.
    #[error(
        "the points do not fit a plane chart seen with this model: check the order of the points and the model (a fisheye for very wide fields)"
    )]
    Start,
    /// The fit failed.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The fitted coefficients are not a valid model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The fitted parameters are not a valid camera.
    #[error(transparent)]
    Camera(#[from] CalibrationError),
    /// A stated value contradicts the views.
    #[error(
        "the stated distance {} ± {} contradicts the views, which give {:.6} ± {:.2} (in the pitch's unit): check distance and pitch, state the \
         uncertainty of the distance, or leave it out", stated.value, stated.standard_uncertainty, shown.value, shown.standard_uncertainty
    )]
    Distance {
        /// Stated value.
        stated: Estimate,
        /// Value from the views.
        shown: Estimate,
    },
    /// Parameters that the views do not determine.
    #[error(
        "the views do not determine {}: add views with the chart turned by 20° to 45° about different axes and out to the corners of the image, state the \
         chart's distance, or fit a model with fewer coefficients (a narrow field does not determine those of wide fields)", names.join(", ")
    )]
    Undetermined {
        /// Names of the parameters.
        names: Vec<String>,
    },
}
