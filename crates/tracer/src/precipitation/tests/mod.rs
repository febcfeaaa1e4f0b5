//! Rain and snow against closed forms, laws and themselves.

mod drops;
mod fields;
mod laws;
mod seam;
mod visibility;

use super::*;
use etendue_core::TimeInterval;
use glam::DVec3;

/// Everything within `radius_m`, of every class.
fn ball(radius_m: f64) -> ChangeOver {
    ChangeOver { clear_m: 0.0, radii_m: vec![radius_m; class::CLASSES as usize], expected: 0.0 }
}

fn moment(time_s: f64) -> TimeInterval {
    TimeInterval::at(time_s).expect("finite")
}
