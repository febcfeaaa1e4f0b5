//! Motion: common keys of moving objects, frames, lamps and cameras.

use etendue_core::ExactTime;
use etendue_core::track::Interpolation;
use glam::{DMat3, DQuat, DVec3};

use std::path::PathBuf;

use crate::asset::TrajectoryRow;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{choice, number, path, record, time, words};

words! {
    /// Axes of a trajectory file, for the world and for the moving object.
    pub enum TrajectoryAxes {
        /// x forward, y left, z up (ISO 8855, REP-103); of the world also east, north, up.
        "flu" => Flu,
        /// x forward, y right, z down (SAE J670); of the world also north, east, down.
        "frd" => Frd,
        /// x right, y down, z forward: poses of cameras as written by visual odometry.
        "rdf" => Rdf,
    }
}

impl TrajectoryAxes {
    /// Rotation from the file's axes to x forward, y left, z up.
    #[must_use]
    pub fn to_world(self) -> DMat3 {
        match self {
            Self::Flu => DMat3::IDENTITY,
            Self::Frd => DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z),
            Self::Rdf => DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X),
        }
    }

    /// Converts a row to axes x forward, y left, z up, for the world and for the moving object.
    #[must_use]
    pub fn to_standard_axes(self, row: &TrajectoryRow) -> TrajectoryRow {
        let turn = DQuat::from_mat3(&self.to_world());
        let rotation = match self {
            Self::Flu => row.rotation,
            Self::Frd | Self::Rdf => turn * row.rotation * turn.conjugate(),
        };
        TrajectoryRow { time: row.time, position_m: self.to_world() * row.position_m, rotation }
    }
}

record! {
    /// Keys from a file, as written by loggers.
    pub struct Trajectory {
        /// CSV with column names, or a JSON list: `time_s`, `x_m`, `y_m`, `z_m`, optionally `qw`, `qx`, `qy`, `qz` or `yaw_deg`, `pitch_deg`, `roll_deg`;
        /// others are ignored.
        required file: Placed<PathBuf> = path(&["csv", "json"]);
        /// Offset added to the times. Default: 0.
        optional time_offset_s: Placed<ExactTime> = time();
        /// Axes of the file. Default: "flu", the world's.
        optional axes: Placed<TrajectoryAxes> = choice();
    }
}

record! {
    /// Motion between keys.
    pub struct MotionKeys {
        /// Interpolation between keys or rows. Default: "linear".
        optional interpolation: Placed<Interpolation> = choice();
        /// Positions over time.
        optional trajectory: Trajectory = record();
    }
}

record! {
    /// A wheel: it turns about its y axis as its origin moves in the world along its x axis, without slipping.
    pub struct Wheel {
        /// Rolling radius.
        required radius_m: Placed<f64> = number("m").above(0.0);
    }
}

/// Checks that the placement is stated once.
pub(super) fn check_placements(
    placements: impl IntoIterator<Item = Option<(&'static str, Place)>>,
    what: &str,
    errors: &mut DescriptionErrors,
) {
    let stated: Vec<(&str, Place)> = placements.into_iter().flatten().collect();
    if let [(first, _), (second, place), ..] = stated.as_slice() {
        let problem = format!("{second} contradicts {first}: both state the position of {what}");
        errors.add(
            ErrorCode::Contradiction,
            place,
            problem,
            "keep one of the two; to move a placed object, attach it to a moving frame",
        );
    }
}

/// The trajectory as a statement of the placement.
pub(super) fn trajectory_placement(motion_keys: Option<&MotionKeys>) -> Option<(&'static str, Place)> {
    motion_keys?.trajectory.as_ref().map(|trajectory| ("\"trajectory\"", trajectory.place.clone()))
}

/// Reports contradictions of keys at these times.
pub(super) fn check_motion<'a>(
    motion_keys: Option<&MotionKeys>,
    times: impl Iterator<Item = &'a Placed<ExactTime>>,
    errors: &mut DescriptionErrors,
) {
    let times: Vec<&Placed<ExactTime>> = times.collect();
    for pair in times.windows(2) {
        check_order(pair[0], pair[1], errors);
    }
    let Some(MotionKeys { interpolation: Some(interpolation), trajectory: None, .. }) = motion_keys else { return };
    if times.len() < 2 {
        errors.add(
            ErrorCode::NoEffect,
            &interpolation.place,
            "\"interpolation\" has no effect here, there are no keys to interpolate",
            "give two \"keys\" or more, or a \"trajectory\", or remove it",
        );
    }
}

fn check_order(before: &Placed<ExactTime>, after: &Placed<ExactTime>, errors: &mut DescriptionErrors) {
    let (before_s, after_s) = (before.value, after.value);
    if after_s == before_s {
        errors.add(
            ErrorCode::Duplicate,
            &after.place,
            format!("two keys are at {after_s} s"),
            "give each key a different time",
        );
    } else if after_s < before_s {
        let problem = format!("the key at {after_s} s follows the key at {before_s} s");
        errors.add(ErrorCode::WrongOrder, &after.place, problem, "give the keys in order of time");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forward motion and a right turn in each convention remain so in the world; a yaw about a z axis that points down turns right.
    #[test]
    fn axes_are_turned_as_a_whole() {
        let quarter = |axis: DVec3| DQuat::from_axis_angle(axis, core::f64::consts::FRAC_PI_2);
        let rows = [
            (TrajectoryAxes::Flu, DVec3::new(3.0, -2.0, 1.0), quarter(DVec3::NEG_Z)),
            (TrajectoryAxes::Frd, DVec3::new(3.0, 2.0, -1.0), quarter(DVec3::Z)),
            (TrajectoryAxes::Rdf, DVec3::new(2.0, -1.0, 3.0), quarter(DVec3::Y)),
        ];
        for (axes, position_m, rotation) in rows {
            let row = axes.to_standard_axes(&TrajectoryRow { time: 4.0.into(), position_m, rotation });
            assert_eq!((row.time.seconds(), row.position_m), (4.0, DVec3::new(3.0, -2.0, 1.0)));
            assert!((row.rotation * DVec3::X - DVec3::NEG_Y).length() < 1e-15, "{axes:?}");
            assert!((row.rotation * DVec3::Z - DVec3::Z).length() < 1e-15, "{axes:?}");
        }
    }
}
