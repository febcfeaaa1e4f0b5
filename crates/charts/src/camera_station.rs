//! Camera poses and exposures of a chart job.

use std::f64::consts::TAU;

use etendue_core::CameraPose;
use etendue_core::maths::f64::{exp, ln, sin_cos};
use glam::DVec3;

use crate::error::ChartError;

/// A camera of the job.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraStation {
    /// Name in the job, and of its file.
    pub name: String,
    pub position_m: DVec3,
    /// Point looked at, m.
    pub target_m: DVec3,
    /// Up direction.
    pub up: DVec3,
    /// Exposure, s, if it differs from the camera's own.
    pub exposure_s: Option<f64>,
    /// True for a dark frame: the camera looks away from the chart into the dark.
    pub dark: bool,
}

impl CameraStation {
    /// Returns the pose. Position and target differ, and the view direction is not along `up`.
    #[must_use]
    pub fn pose(&self) -> CameraPose {
        CameraPose::looking_at(self.position_m, self.target_m, self.up).expect("a station looks at the sheet")
    }
}

/// Spacing of exposures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// Equal ratios.
    Log,
    /// Equal steps.
    Linear,
}

/// A series of exposures, by the fraction of saturation that white reaches in each.
#[derive(Clone, Debug, PartialEq)]
pub struct Exposures {
    /// Fractions, above 0.
    pub fractions: Vec<f64>,
}

impl Exposures {
    /// Returns `count` fractions from `lowest` to `highest`.
    ///
    /// # Errors
    /// If there are fewer than two, or the fractions do not increase from above 0.
    pub fn spaced(count: u32, spacing: Spacing, lowest: f64, highest: f64) -> Result<Self, ChartError> {
        if count < 2 {
            return Err(ChartError::option("exposures", count, "expected two or more exposures"));
        }
        let is_valid = lowest > 0.0 && lowest < highest && highest.is_finite();
        if !is_valid {
            let message = format!("expected a fraction of saturation above 0 and below `highest` {highest}");
            return Err(ChartError::option("lowest", lowest, message));
        }
        let at = |i: u32| {
            let t = f64::from(i) / f64::from(count - 1);
            match spacing {
                Spacing::Linear => lowest + t * (highest - lowest),
                Spacing::Log => exp(ln(lowest) + t * (ln(highest) - ln(lowest))),
            }
        };
        Ok(Self { fractions: (0..count).map(at).collect() })
    }

    /// Returns the fractions as listed.
    ///
    /// # Errors
    /// If there is none, or one is not above 0.
    pub fn listed(fractions: Vec<f64>) -> Result<Self, ChartError> {
        let is_valid = !fractions.is_empty() && fractions.iter().all(|s| s.is_finite() && *s > 0.0);
        let text = fractions.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
        let option_error = || ChartError::option("levels", text, "expected fractions of saturation, each above 0");
        if is_valid { Ok(Self { fractions }) } else { Err(option_error()) }
    }
}

/// The cameras of a job: one perpendicular to the sheet at `distance_m`; or `views` of them around it, tilted by 25 degrees and
/// farther away so that the sheet stays in the image, the first one perpendicular; or one for each exposure (s).
#[must_use]
pub fn camera_stations(distance_m: f64, views: u32, exposures_s: &[f64], dark: bool) -> Vec<CameraStation> {
    let ahead = |name: String, exposure_s| CameraStation {
        name,
        position_m: DVec3::ZERO,
        target_m: DVec3::X * distance_m,
        up: DVec3::Z,
        exposure_s,
        dark: false,
    };
    if !exposures_s.is_empty() {
        let exposure_stations = |(i, t): (usize, &f64)| {
            let lit = ahead(format!("exposure-{:02}", i + 1), Some(*t));
            let dark_station = CameraStation {
                name: format!("dark-{:02}", i + 1),
                target_m: -lit.target_m,
                dark: true,
                ..lit.clone()
            };
            [Some(lit), dark.then_some(dark_station)]
        };
        return exposures_s.iter().enumerate().flat_map(exposure_stations).flatten().collect();
    }
    match views {
        0 | 1 => vec![ahead("camera".to_owned(), None)],
        _ => (0..views)
            .map(|i| CameraStation { name: format!("view-{:02}", i + 1), ..view(distance_m, i, views) })
            .collect(),
    }
}

/// Tilt of the views relative to the sheet.
const TILT_DEG: f64 = 25.0;
/// Distance of tilted views relative to the perpendicular one.
const TILTED_DISTANCE: f64 = 1.45;
/// Roll of the views about their own axis, in turn.
const ROLLS_DEG: [f64; 3] = [0.0, 10.0, -10.0];

/// View `i` of `count`: the first perpendicular, the others around it in equal steps, rolled in turn.
fn view(distance_m: f64, i: u32, count: u32) -> CameraStation {
    let centre = DVec3::X * distance_m;
    let turn = TAU * f64::from(i.saturating_sub(1)) / f64::from(count - 1);
    let (tilt, distance_factor) = if i == 0 { (0.0, 1.0) } else { (TILT_DEG.to_radians(), TILTED_DISTANCE) };
    let (across, along) = sin_cos(tilt);
    let (up, left) = sin_cos(turn);
    let from = DVec3::new(-along, across * left, across * up) * distance_m * distance_factor;
    let (sin, cos) = sin_cos(ROLLS_DEG[i as usize % 3].to_radians());
    CameraStation {
        name: String::new(),
        position_m: centre + from,
        target_m: centre,
        up: DVec3::new(0.0, sin, cos),
        exposure_s: None,
        dark: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposures_are_evenly_spaced() {
        let log = Exposures::spaced(4, Spacing::Log, 0.001, 1.0).expect("legal");
        let linear = Exposures::spaced(5, Spacing::Linear, 0.2, 1.2).expect("legal");
        let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-12);
        assert!(
            near(&log.fractions, &[0.001, 0.01, 0.1, 1.0]) && near(&linear.fractions, &[0.2, 0.45, 0.7, 0.95, 1.2])
        );
        assert!(Exposures::spaced(1, Spacing::Log, 0.1, 1.0).is_err());
        assert!(Exposures::spaced(3, Spacing::Log, 1.0, 0.1).is_err());
        assert!(Exposures::listed(vec![0.1, 0.0]).is_err() && Exposures::listed(vec![]).is_err());
    }

    #[test]
    fn views_look_at_the_sheet_and_dark_frames_away() {
        let views = camera_stations(2.0, 7, &[], false);
        assert_eq!((views.len(), views[0].position_m), (7, DVec3::ZERO));
        for view in &views[1..] {
            let axis = view.pose().rotation.z_axis;
            assert!((axis.x - sin_cos(TILT_DEG.to_radians()).1).abs() < 1e-12, "{axis}");
            assert!(((view.position_m - DVec3::X * 2.0).length() - 2.9).abs() < 1e-12);
        }
        let series = camera_stations(2.0, 1, &[0.1, 0.2], true);
        let names: Vec<&str> = series.iter().map(|s| s.name.as_str()).collect();
        assert_eq!(names, ["exposure-01", "dark-01", "exposure-02", "dark-02"]);
        assert!(series[1].dark && series[1].target_m.x < 0.0);
    }
}
