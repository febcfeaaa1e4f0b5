//! Gradient noise (Perlin, "Improving noise", 2002) in octaves: the density variation of fog.

use glam::{DVec3, UVec3};

/// Noise of mean zero, within −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Size of the largest eddies (the lattice's step), m. Positive.
    pub scale_m: f64,
    /// Octaves, 1 to 12, each of half the size of the previous one.
    pub octaves: u32,
    /// Strength of an octave relative to the previous one, 0 to 1.
    pub gain: f64,
    pub seed: u32,
}

impl Noise {
    /// Size of the smallest eddies, m.
    #[must_use]
    pub fn smallest_m(&self) -> f64 {
        self.scale_m / f64::from(1_u32 << (self.octaves - 1))
    }

    /// The value at a point, m.
    #[must_use]
    pub fn at(&self, point_m: DVec3) -> f64 {
        let (mut sum, mut total_strength, mut strength, mut place) = (0.0, 0.0, 1.0, point_m / self.scale_m);
        for octave in 0..self.octaves {
            sum += strength * gradient_noise(place, self.seed.wrapping_add(octave.wrapping_mul(0x9e37_79b9)));
            total_strength += strength;
            strength *= self.gain;
            place *= 2.0;
        }
        (sum / total_strength).clamp(-1.0, 1.0)
    }
}

/// One octave of step 1.
fn gradient_noise(place: DVec3, seed: u32) -> f64 {
    let low = place.floor();
    let rest = place - low;
    // Lattices repeat after 2³² steps.
    let cell = low.rem_euclid(DVec3::splat(4_294_967_296.0)).as_uvec3();
    let fade = rest * rest * rest * (rest * (rest * 6.0 - 15.0) + 10.0);
    let corner = |x: u32, y: u32, z: u32| {
        let at = UVec3::new(x, y, z);
        slope(hash(cell.wrapping_add(at), seed), rest - at.as_dvec3())
    };
    let along = |y: u32, z: u32| mix(corner(0, y, z), corner(1, y, z), fade.x);
    mix(mix(along(0, 0), along(1, 0), fade.y), mix(along(0, 1), along(1, 1), fade.y), fade.z)
}

fn mix(low: f64, high: f64, fraction: f64) -> f64 {
    low + fraction * (high - low)
}

/// The product of a point and one of the twelve directions to the edges of a cube.
fn slope(hash: u32, p: DVec3) -> f64 {
    let h = hash & 15;
    let u = if h < 8 { p.x } else { p.y };
    let v = if h < 4 {
        p.y
    } else if h == 12 || h == 14 {
        p.x
    } else {
        p.z
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// Hash of a corner of the lattice (finaliser of MurmurHash3, Appleby 2011).
fn hash(at: UVec3, seed: u32) -> u32 {
    let word = |h: u32, w: u32| {
        let mut h = h ^ w;
        h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
        h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
        h ^ (h >> 16)
    };
    word(word(word(seed ^ 0x51ed_270b, at.x), at.y), at.z) >> 7
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: Noise = Noise { scale_m: 5.0, octaves: 4, gain: 0.5, seed: 3 };

    /// The mean over a box of 60³ steps: as many independent cells leave 1/√n of the deviation.
    #[test]
    fn its_mean_is_zero_and_its_range_one() {
        let one = Noise { octaves: 1, ..NOISE };
        let n = 60_i32;
        let (mut sum, mut squares) = (0.0, 0.0);
        for x in 0..n {
            for y in 0..n {
                for z in 0..n {
                    let at =
                        one.at(DVec3::new(f64::from(x) + 0.5, f64::from(y) + 0.37, f64::from(z) + 0.71) * 5.0 * 0.617);
                    assert!(at.abs() <= 1.0);
                    sum += at;
                    squares += at * at;
                }
            }
        }
        let count = f64::from(n * n * n);
        let deviation = (squares / count).sqrt();
        // Neighbours within a cell depend on each other: 0.617³ cells a point.
        assert!((sum / count).abs() < 4.0 * deviation / (0.23 * count).sqrt(), "{}", sum / count);
        assert!(deviation > 0.2 && deviation < 0.4, "{deviation}");
    }

    #[test]
    fn it_has_no_steps_and_a_seed() {
        let at = |x: f64| NOISE.at(DVec3::new(x, 1.3, -2.2));
        for i in -50..50 {
            // Slopes of octaves of equal steepness: below 2 a step each.
            assert!((at(f64::from(i) + 1e-6) - at(f64::from(i) - 1e-6)).abs() < 1e-5);
        }
        assert!((Noise { seed: 4, ..NOISE }.at(DVec3::splat(7.7)) - NOISE.at(DVec3::splat(7.7))).abs() > 1e-3);
    }
}
