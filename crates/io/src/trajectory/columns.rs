//! Which column says what.

use etendue_core::ExactTime;
use etendue_scene::asset::TrajectoryRow;
use etendue_scene::record::transform::yaw_pitch_roll_quaternion;
use glam::{DQuat, DVec3};

const PLACE: [&str; 4] = ["time_s", "x_m", "y_m", "z_m"];
const QUATERNION: [&str; 4] = ["qw", "qx", "qy", "qz"];
const ANGLES: [&str; 3] = ["yaw_deg", "pitch_deg", "roll_deg"];

/// How far the length of a quaternion may be from 1: loggers write few digits.
const LENGTH_ERROR: f64 = 0.01;

/// Rows with their lines, and the names that were not read.
pub(super) type Read = (Vec<(usize, TrajectoryRow)>, Vec<String>);

/// Where the values of a row stand.
pub(super) struct Columns {
    place: [usize; 4],
    rotation: Rotation,
}

enum Rotation {
    None,
    Quaternion([usize; 4]),
    Angles([usize; 3]),
}

/// Whether a name says something.
pub(super) fn is_known(name: &str) -> bool {
    PLACE.contains(&name) || QUATERNION.contains(&name) || ANGLES.contains(&name)
}

impl Columns {
    /// By the names of all columns.
    pub(super) fn of(names: &[&str]) -> Result<Self, String> {
        if let Some(twice) = names.iter().enumerate().find(|(i, name)| is_known(name) && names[..*i].contains(name)) {
            return Err(format!("two columns are called \"{}\"; leave one out", twice.1));
        }
        let place = found(names, PLACE).ok_or_else(|| missing(names, &PLACE))?;
        let given = |wanted: &[&str]| wanted.iter().any(|name| names.contains(name));
        let rotation = match (given(&QUATERNION), given(&ANGLES)) {
            (false, false) => Rotation::None,
            (true, false) => Rotation::Quaternion(found(names, QUATERNION).ok_or_else(|| missing(names, &QUATERNION))?),
            (false, true) => Rotation::Angles(found(names, ANGLES).ok_or_else(|| missing(names, &ANGLES))?),
            (true, true) => {
                let both = [QUATERNION.join(", "), ANGLES.join(", ")];
                return Err(format!("rotations are given twice, as {} and as {}; leave one out", both[0], both[1]));
            }
        };
        Ok(Self { place, rotation })
    }

    /// Builds a row from the values of its columns; `exact` returns the time.
    pub(super) fn row(
        &self,
        value: impl Fn(usize) -> Result<f64, String>,
        exact: impl Fn(usize) -> Result<ExactTime, String>,
    ) -> Result<TrajectoryRow, String> {
        let [time, x, y, z] = self.place;
        let rotation = match self.rotation {
            Rotation::None => DQuat::IDENTITY,
            Rotation::Angles([yaw, pitch, roll]) => {
                yaw_pitch_roll_quaternion([value(yaw)?, value(pitch)?, value(roll)?])
            }
            Rotation::Quaternion([w, x, y, z]) => {
                let quaternion = DQuat::from_xyzw(value(x)?, value(y)?, value(z)?, value(w)?);
                let length = quaternion.length();
                if (length - 1.0).abs().is_nan() || (length - 1.0).abs() > LENGTH_ERROR {
                    return Err(format!("a quaternion of length {length}; expected a rotation, of length 1"));
                }
                quaternion
            }
        };
        Ok(TrajectoryRow { time: exact(time)?, position_m: DVec3::new(value(x)?, value(y)?, value(z)?), rotation })
    }
}

/// Where all of the wanted names stand.
fn found<const N: usize>(names: &[&str], wanted: [&str; N]) -> Option<[usize; N]> {
    let at = wanted.map(|wanted| names.iter().position(|name| *name == wanted));
    at.iter().all(Option::is_some).then(|| at.map(Option::unwrap_or_default))
}

fn missing(names: &[&str], wanted: &[&str]) -> String {
    let missing: Vec<&str> = wanted.iter().filter(|name| !names.contains(name)).copied().collect();
    format!(
        "nothing is called {}; expected {} and, of what turns, {} or {}",
        missing.join(", "),
        PLACE.join(", "),
        QUATERNION.join(", "),
        ANGLES.join(", ")
    )
}
