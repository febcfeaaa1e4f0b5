//! Points of a chart that are seen in a picture.

use glam::DVec2;

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
