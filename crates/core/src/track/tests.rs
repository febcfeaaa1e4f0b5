//! Tests of tracks: interpolation against closed forms, bounds against many moments.

mod bounds;
mod interpolation;

use super::{Interpolation, Key, Track};
use crate::random::{philox4x32, unit_f64};
use glam::{DQuat, DVec3};

/// Reproducible numbers.
struct Random(u32, u32);

impl Random {
    fn unit(&mut self) -> f64 {
        self.1 += 1;
        let words = philox4x32([self.1, 0, 0, 0], [self.0, 0]);
        unit_f64(u64::from(words[0]) << 32 | u64::from(words[1]))
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn cube(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    fn rotation(&mut self) -> DQuat {
        let v = self.cube() + DVec3::splat(1e-3);
        DQuat::from_xyzw(v.x, v.y, v.z, self.between(-1.0, 1.0)).normalize()
    }

    /// Returns a track of two to six keys at irregular times from 0 on.
    fn track(&mut self) -> (Track, Vec<Key>) {
        let mut time_s = 0.0;
        let count = 2 + (self.unit() * 5.0) as usize;
        let reach = [0.0, 1.0, 100.0, 1e6][(self.unit() * 4.0) as usize];
        let key = |_| {
            time_s += self.between(0.05, 1.0);
            let scale = DVec3::new(self.between(0.5, 2.0), self.between(-2.0, -0.5), self.between(0.1, 3.0));
            Key { time_s, position_m: self.cube() * reach, rotation: self.rotation(), scale }
        };
        let keys: Vec<Key> = (0..count).map(key).collect();
        let how = if self.unit() < 0.5 { Interpolation::Linear } else { Interpolation::Smooth };
        (Track::new(&keys, how).expect("a legal track"), keys)
    }
}

fn key(time_s: f64, position_m: DVec3, rotation: DQuat) -> Key {
    Key { time_s, position_m, rotation, scale: DVec3::ONE }
}

/// Rotation about z by an angle in rad.
fn about_z(angle: f64) -> DQuat {
    let (sin, cos) = crate::maths::f64::sin_cos(0.5 * angle);
    DQuat::from_xyzw(0.0, 0.0, sin, cos)
}
