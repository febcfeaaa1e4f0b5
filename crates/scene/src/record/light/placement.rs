//! Position and direction of a lamp.

use etendue_core::ExactTime;

use glam::{DMat3, DVec3};

use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::{Place, Placed};
use crate::reader::{keyed, list, name_of, number, record, text, time, vector};
use crate::record::motion::{MotionKeys, check_motion, check_placements, trajectory_placement};
use crate::record::transform::yaw_pitch_roll;

record! {
    /// Position and direction of a lamp, with one or more instances.
    pub struct LampPlacement check(check) {
        /// World position of a single instance.
        optional position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Direction, of a lamp with one instance. Default: no rotation.
        group aim: LampAim;
        /// Instances.
        many instances: LampInstance = list(record(), 1);
        /// Positions over time.
        many keys: LampKey = list(record(), 1);
        /// Motion.
        group course: MotionKeys;
        /// Frame of its positions and targets. Default: the world.
        optional frame: Placed<String> = name_of(NameKind::Frame);
        /// Coefficient a of a factor 1/(1 + a·distance). Default: 0.
        optional attenuation_per_m: Placed<f64> = number("1/m").at_least(0.0);
    }
}

record! {
    /// An instance of a lamp.
    pub struct LampInstance check(check_instance) {
        /// Name of the instance. Default: the lamp's name and a number.
        optional name: Placed<String> = text("the name of the instance");
        /// Frame. Default: the lamp's.
        optional frame: Placed<String> = name_of(NameKind::Frame);
        /// Position in the world.
        required position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Direction. Default: no rotation.
        group aim: LampAim;
        /// Delay added to the lamp's "modulation". Default: 0.
        optional modulation_delay_s: Placed<f64> = number("s");
    }
}

record! {
    /// Position of a lamp at a time.
    pub struct LampKey check(check_key) {
        /// Simulated time.
        required time_s: Placed<ExactTime> = time();
        /// Position in the world.
        required position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Direction. Default: no rotation.
        group aim: LampAim;
    }
}

keyed! {
    /// Direction of a lamp.
    pub enum LampAim {
        /// Yaw, pitch and roll; at 0 the lamp's axes are the world's.
        rotation_deg => Rotation(Placed<[f64; 3]>) = vector::<3>(number("°"));
        /// World point at which +x (γ = 0 in C planes) aims; y stays level.
        target_m => Target(Placed<[f64; 3]>) = vector::<3>(number("m"));
    }
}

/// Main direction of a lamp, which "target_m" turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MainAxis {
    /// +x: spots, headlamps, photometry of types A and B.
    Forward,
    /// −z: photometry of type C.
    Downward,
}

impl LampAim {
    /// Returns the lamp's x, y and z axes in the world as columns, for a lamp at `position_m`; `None` if it aims at its own position.
    #[must_use]
    pub fn axes(&self, position_m: [f64; 3], main: MainAxis) -> Option<DMat3> {
        match self {
            Self::Rotation(degrees) => Some(yaw_pitch_roll(degrees.value)),
            Self::Target(target) => {
                let direction = DVec3::from_array(target.value) - DVec3::from_array(position_m);
                towards(direction.try_normalize()?, main)
            }
        }
    }

    /// Place in the file.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Rotation(v) | Self::Target(v) => &v.place,
        }
    }
}

/// Returns axes with the main axis along `direction` and a level y axis; towards the zenith or nadir the y axis is the world's.
fn towards(direction: DVec3, main: MainAxis) -> Option<DMat3> {
    let left = DVec3::Z.cross(direction).try_normalize().unwrap_or(DVec3::Y);
    Some(match main {
        MainAxis::Forward => DMat3::from_cols(direction, left, direction.cross(left)),
        MainAxis::Downward => DMat3::from_cols(left.cross(-direction), left, -direction),
    })
}

impl LampPlacement {
    /// All stated directions.
    pub(super) fn aims(&self) -> impl Iterator<Item = &LampAim> {
        let instances = self.instances.iter().filter_map(|instance| instance.aim.as_ref());
        self.aim.iter().chain(instances).chain(self.keys.iter().filter_map(|key| key.aim.as_ref()))
    }
}

fn check(placement: &LampPlacement, errors: &mut DescriptionErrors) {
    let own = placement.position_m.as_ref().map(|p| ("\"position_m\"", p.place.clone()));
    let own = own.or(placement.aim.as_ref().map(|a| ("the light's own aim", a.place().clone())));
    let keys = placement.keys.first().map(|key| ("\"keys\"", key.place.clone()));
    let instances = placement.instances.first().map(|first| ("\"instances\"", first.place.clone()));
    let has_position = placement.position_m.is_some()
        || [&keys, &instances].iter().any(|item| item.is_some())
        || trajectory_placement(placement.course.as_ref()).is_some();
    check_placements([own, keys, trajectory_placement(placement.course.as_ref()), instances], "the light", errors);
    check_motion(placement.course.as_ref(), placement.keys.iter().map(|key| &key.time_s), errors);
    if !has_position {
        errors.add(
            ErrorCode::MissingKey,
            &placement.place,
            "the light has no position",
            "add \"position_m\", \"instances\" for many places, or \"keys\" or \"trajectory\" for one that moves",
        );
    }
    if let (Some(position), Some(aim)) = (&placement.position_m, &placement.aim) {
        check_aim(position, aim, errors);
    }
}

fn check_instance(instance: &LampInstance, errors: &mut DescriptionErrors) {
    instance.aim.iter().for_each(|aim| check_aim(&instance.position_m, aim, errors));
}

fn check_key(key: &LampKey, errors: &mut DescriptionErrors) {
    key.aim.iter().for_each(|aim| check_aim(&key.position_m, aim, errors));
}

fn check_aim(position: &Placed<[f64; 3]>, aim: &LampAim, errors: &mut DescriptionErrors) {
    if aim.axes(position.value, MainAxis::Forward).is_none() {
        errors.add(ErrorCode::Degenerate, aim.place(), "the light points at its own position", "move \"target_m\"");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn main_axes_meet_their_target_and_left_stays_level() {
        for direction in [DVec3::X, DVec3::NEG_Z, DVec3::Z, DVec3::new(1.0, -2.0, -0.5).normalize()] {
            let forward = towards(direction, MainAxis::Forward).expect("axes");
            let downward = towards(direction, MainAxis::Downward).expect("axes");
            // Products of unit vectors, with a few roundings each.
            assert!(
                (forward * DVec3::X - direction).length() < 1e-15
                    && (downward * DVec3::NEG_Z - direction).length() < 1e-15
            );
            for axes in [forward, downward] {
                assert!((axes.determinant() - 1.0).abs() < 1e-15 && (axes * DVec3::Y).z.abs() < 1e-15);
            }
        }
        let down = towards(DVec3::NEG_Z, MainAxis::Downward).expect("axes");
        assert_eq!(down, DMat3::IDENTITY, "a road lamp that shines straight down is not turned");
    }
}
