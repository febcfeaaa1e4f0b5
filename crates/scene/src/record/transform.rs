//! Placement of an object.

use etendue_core::maths::f64 as maths;
use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::place::{Place, Placed};
use crate::reader::{Rule, RuleExt as _, either, number, record, vector};

record! {
    /// Transform from an object's frame to the world: scale, then rotation, then translation.
    pub struct Transform {
        /// Position in the world. Default: its origin.
        optional position_m: Placed<[f64; 3]> = vector::<3>(number("m"));
        /// Yaw, pitch and roll about z, y and x. Default: 0.
        optional rotation_deg: Placed<[f64; 3]> = vector::<3>(number("°"));
        /// Factor on the size. Default: 1.
        optional scale: Placed<[f64; 3]> = scale();
    }
}

fn scale() -> impl Rule<Out = Placed<[f64; 3]>> {
    let factor = number("").above(0.0);
    let same = |scale: &Placed<[f64; 3]>| {
        let [x, y, z] = scale.value;
        (x == y && y == z).then(|| scale.clone().map(|_| x))
    };
    either(factor.map(|f| f.map(|s| [s; 3]), same), vector::<3>(factor))
}

impl Transform {
    /// Transform from the object's frame to the world.
    #[must_use]
    pub fn to_world(&self) -> DAffine3 {
        DAffine3::from_mat3_translation(self.rotation() * DMat3::from_diagonal(self.factors()), self.position())
    }

    /// The same without the scale.
    #[must_use]
    pub fn to_world_unscaled(&self) -> DAffine3 {
        DAffine3::from_mat3_translation(self.rotation(), self.position())
    }

    /// Position of the object's origin, m.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position_m.as_ref().map_or(DVec3::ZERO, |p| DVec3::from_array(p.value))
    }

    /// The rotation as a quaternion.
    #[must_use]
    pub fn quaternion(&self) -> DQuat {
        self.rotation_deg.as_ref().map_or(DQuat::IDENTITY, |r| yaw_pitch_roll_quaternion(r.value))
    }

    /// The scale along each axis.
    #[must_use]
    pub fn factors(&self) -> DVec3 {
        self.scale.as_ref().map_or(DVec3::ONE, |s| DVec3::from_array(s.value))
    }

    fn rotation(&self) -> DMat3 {
        self.rotation_deg.as_ref().map_or(DMat3::IDENTITY, |r| yaw_pitch_roll(r.value))
    }

    /// Place of the first key that is given.
    pub(crate) fn stated_at(&self) -> Option<&Place> {
        let keys = [&self.position_m, &self.rotation_deg, &self.scale];
        keys.into_iter().flatten().next().map(|key| &key.place)
    }

    /// True if any key is given.
    pub(crate) fn is_given(&self) -> bool {
        self.position_m.is_some() || self.rotation_deg.is_some() || self.scale.is_some()
    }
}

/// The rotation Rz(yaw)·Ry(pitch)·Rx(roll), angles in degrees; quarter turns are exact.
#[must_use]
pub fn yaw_pitch_roll(degrees: [f64; 3]) -> DMat3 {
    let [(sz, cz), (sy, cy), (sx, cx)] = degrees.map(sin_cos_deg);
    let yaw = DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
    let pitch = DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
    let roll = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
    yaw * pitch * roll
}

/// The same as a quaternion.
#[must_use]
pub fn yaw_pitch_roll_quaternion(degrees: [f64; 3]) -> DQuat {
    let [(sz, cz), (sy, cy), (sx, cx)] = degrees.map(|angle| maths::sin_cos(0.5 * angle.to_radians()));
    let (yaw, pitch) = (DQuat::from_xyzw(0.0, 0.0, sz, cz), DQuat::from_xyzw(0.0, sy, 0.0, cy));
    yaw * pitch * DQuat::from_xyzw(sx, 0.0, 0.0, cx)
}

/// Yaw, pitch and roll of a rotation, degrees: the inverse of [`yaw_pitch_roll`]. Roll is 0 where the front points straight up or down.
#[must_use]
pub fn angles_deg(rotation: DMat3) -> [f64; 3] {
    let (x, y, z) = (rotation.x_axis, rotation.y_axis, rotation.z_axis);
    let level = (x.x * x.x + x.y * x.y).sqrt();
    let pitch = maths::atan2(-x.z, level);
    let (yaw, roll) = match level > 1e-9 {
        true => (maths::atan2(x.y, x.x), maths::atan2(y.z, z.z)),
        false => (maths::atan2(-y.x, y.y), 0.0),
    };
    [yaw, pitch, roll].map(f64::to_degrees)
}

/// Sine and cosine of an angle in degrees, exact at quarter turns.
fn sin_cos_deg(degrees: f64) -> (f64, f64) {
    let quarters = (degrees / 90.0).round();
    let (s, c) = maths::sin_cos((degrees - 90.0 * quarters).to_radians());
    match quarters.rem_euclid(4.0) {
        1.0 => (c, -s),
        2.0 => (-s, -c),
        3.0 => (-c, s),
        _ => (s, c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_as_the_format_says() {
        let ahead = |degrees| yaw_pitch_roll(degrees) * DVec3::X;
        assert_eq!(ahead([90.0, 0.0, 0.0]), DVec3::Y, "positive yaw turns to the left, a quarter turn exactly");
        assert_eq!(ahead([0.0, 90.0, 0.0]), DVec3::NEG_Z, "positive pitch lowers the front");
        assert_eq!(yaw_pitch_roll([0.0, 0.0, 90.0]) * DVec3::Y, DVec3::Z, "positive roll lifts the left side");
        assert_eq!(ahead([90.0, 90.0, 0.0]), DVec3::NEG_Z, "pitched before it is yawed");
    }

    #[test]
    fn quaternions_are_the_rotations() {
        for degrees in [[0.0; 3], [90.0, 0.0, 0.0], [10.0, 20.0, 30.0], [-170.0, 85.0, 721.0], [180.0, 90.0, -180.0]] {
            let off = DMat3::from_quat(yaw_pitch_roll_quaternion(degrees)) - yaw_pitch_roll(degrees);
            // Products of three unit quaternions and matrices, with a few roundings each; 721° as radians is rounded to 2e-15.
            assert!(off.to_cols_array().iter().all(|x| x.abs() < 1e-14), "{degrees:?} {off}");
        }
    }

    #[test]
    fn angles_are_found_again() {
        for degrees in [[0.0; 3], [10.0, 20.0, 30.0], [-170.0, 85.0, -121.0], [40.0, 90.0, 30.0], [-40.0, -90.0, 30.0]]
        {
            let rotation = yaw_pitch_roll(degrees);
            let off = yaw_pitch_roll(angles_deg(rotation)) - rotation;
            // Straight up, the level part of the front is rounding only, below 1e-9.
            assert!(off.to_cols_array().iter().all(|x| x.abs() < 2e-9), "{degrees:?} {off}");
        }
    }

    #[test]
    fn every_turn_is_a_rotation() {
        for degrees in [[10.0, 20.0, 30.0], [-170.0, 85.0, 721.0], [45.0, -45.0, 135.0]] {
            let r = yaw_pitch_roll(degrees);
            let error =
                (r * r.transpose() - DMat3::IDENTITY).to_cols_array().map(f64::abs).into_iter().fold(0.0, f64::max);
            // Three products of unit vectors, with a few roundings each.
            assert!(error < 8.0 * f64::EPSILON && (r.determinant() - 1.0).abs() < 8.0 * f64::EPSILON);
        }
    }
}
