//! Ground truth of a chart of points: its kind and pitch, and the distance of the camera.

use std::path::Path;

use etendue_charts::design::{Checkerboard, Circles, Dots};
use etendue_io::failure::Error;
use etendue_metrology::target::Target;
use glam::DVec3;

use super::Truth;

/// Charts of points.
pub(crate) const CHARTS: [&str; 3] = [Dots::NAME, Checkerboard::NAME, Circles::NAME];

/// A chart of points.
pub(crate) struct PointChart {
    pub target: Target,
    /// Distance of neighbouring points, mm.
    pub pitch_mm: f64,
    /// From the entrance pupil to the chart's plane, mm; `None` if the ground truth does not state both positions.
    pub distance_mm: Option<f64>,
}

impl Truth {
    pub(crate) fn points(&self) -> Result<PointChart, Error> {
        let pitch_mm = self.content.size("pitch_mm").ok_or_else(|| self.refused("lacks the pitch of the points"))?;
        let staggered = self.content.sizes.get("asymmetric").and_then(serde_json::Value::as_bool) == Some(true);
        let checkerboard = self.content.chart == Checkerboard::NAME;
        Ok(PointChart {
            target: if checkerboard { Target::Checkerboard } else { Target::Dots },
            // Pitch of cells of which every other one holds a circle.
            pitch_mm: if staggered { core::f64::consts::SQRT_2 * pitch_mm } else { pitch_mm },
            distance_mm: self.distance_mm(),
        })
    }

    fn distance_mm(&self) -> Option<f64> {
        let (sheet, camera) =
            (&self.content.panels.first()?.sheet_mm_to_world_m, self.camera_record().camera_to_world?);
        let column = |m: &[[f64; 4]; 3], k: usize| DVec3::new(m[0][k], m[1][k], m[2][k]);
        let normal = column(sheet, 0).cross(column(sheet, 1)).try_normalize()?;
        Some(1000.0 * normal.dot(column(sheet, 3) - column(&camera, 3)).abs())
    }

    /// Checks that an image, or a list of points, has the camera's image size.
    pub(crate) fn fits_size(&self, file: &Path, [width, height]: [usize; 2]) -> Result<(), Error> {
        self.sized(file, width, height)
    }
}
