//! Values over time.

use gltf::json::animation::Interpolation;

use crate::Problem;

/// Linear keys that approximate a cubic curve between two of the file's keys.
pub const GLTF_CUBIC_KEYS: usize = 16;
/// Maximum keys of the tracks of a file: as text they have about 100 MB.
const MAX_KEYS: u64 = 1_000_000;
/// Minimum length of a quaternion that determines a rotation.
pub const GLTF_MIN_TURN: f64 = 1e-6;

/// Values over time; constant before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfTrack<const N: usize> {
    /// Times, s, increasing.
    pub times_s: Vec<f64>,
    keys: GltfKeys<N>,
}

#[derive(Clone, Debug, PartialEq)]
enum GltfKeys<const N: usize> {
    Linear(Vec<[f64; N]>),
    Step(Vec<[f64; N]>),
    /// Tangent before, value, tangent after.
    Cubic(Vec<[[f64; N]; 3]>),
}

pub(super) fn track<const N: usize>(
    times: Vec<f64>,
    values: Vec<[f64; N]>,
    cubic: bool,
    steps: bool,
) -> Result<GltfTrack<N>, Problem> {
    let each = if cubic { 3 } else { 1 };
    if times.is_empty() || values.len() != each * times.len() {
        return Err(format!("has {} values for {} times; export the file again", values.len(), times.len()).into());
    }
    if times.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err("the times do not increase; export the file again".into());
    }
    let keys = match (cubic, steps) {
        (true, _) => GltfKeys::Cubic(values.as_chunks().0.to_vec()),
        (_, true) => GltfKeys::Step(values),
        _ => GltfKeys::Linear(values),
    };
    Ok(GltfTrack { times_s: times, keys })
}

/// Adds to `before` the keys that a track of `times` makes: cubic curves and steps need more.
pub(super) fn counted(before: u64, times: u64, interpolation: Interpolation) -> Result<u64, Problem> {
    let each = match interpolation {
        Interpolation::CubicSpline => GLTF_CUBIC_KEYS as u64,
        Interpolation::Step => 2,
        Interpolation::Linear => 1,
    };
    match before.saturating_add(times.saturating_mul(each)) {
        keys if keys <= MAX_KEYS => Ok(keys),
        _ => Err(format!(
            "its tracks and those before it have more than {MAX_KEYS} keys (a cubic key counts as {GLTF_CUBIC_KEYS}, a step key as 2); export fewer"
        ).into()),
    }
}

/// Refuses keys that are no rotation.
pub(super) fn check_rotation(track: &GltfTrack<4>) -> Result<(), Problem> {
    let length = |q: [f64; 4]| q.iter().map(|v| v * v).sum::<f64>().sqrt();
    match track.values().position(|q| length(q) < GLTF_MIN_TURN) {
        Some(key) => {
            Err(format!("key {key} of its rotations is a quaternion of length 0; export the file again").into())
        }
        None => Ok(()),
    }
}

impl<const N: usize> GltfTrack<N> {
    /// Returns true if values change in steps.
    #[must_use]
    pub fn is_step(&self) -> bool {
        matches!(self.keys, GltfKeys::Step(_))
    }

    /// Returns true if values follow cubic curves.
    #[must_use]
    pub fn is_cubic(&self) -> bool {
        matches!(self.keys, GltfKeys::Cubic(_))
    }

    pub(super) fn values(&self) -> impl Iterator<Item = [f64; N]> {
        let (plain, cubic) = match &self.keys {
            GltfKeys::Linear(values) | GltfKeys::Step(values) => (values.as_slice(), [].as_slice()),
            GltfKeys::Cubic(keys) => ([].as_slice(), keys.as_slice()),
        };
        plain.iter().copied().chain(cubic.iter().map(|[_, value, _]| *value))
    }

    /// Value at a time: linear (interpolated by `between`), stepped, or on cubic Hermite curves.
    #[must_use]
    pub fn at(&self, time_s: f64, between: impl Fn([f64; N], [f64; N], f64) -> [f64; N]) -> [f64; N] {
        let last = self.times_s.len() - 1;
        let next = self.times_s.partition_point(|t| *t <= time_s);
        let (i, fraction) = match next {
            0 => (0, 0.0),
            next if next > last => (last, 0.0),
            next => {
                let (from, to) = (self.times_s[next - 1], self.times_s[next]);
                (next - 1, (time_s - from) / (to - from))
            }
        };
        match &self.keys {
            GltfKeys::Step(values) => values[i],
            GltfKeys::Linear(values) if fraction == 0.0 => values[i],
            GltfKeys::Linear(values) => between(values[i], values[i + 1], fraction),
            GltfKeys::Cubic(keys) if fraction == 0.0 => keys[i][1],
            GltfKeys::Cubic(keys) => {
                let step = self.times_s[i + 1] - self.times_s[i];
                let ([_, v0, b0], [a1, v1, _]) = (keys[i], keys[i + 1]);
                let (t, t2, t3) = (fraction, fraction * fraction, fraction * fraction * fraction);
                std::array::from_fn(|n| {
                    (2.0 * t3 - 3.0 * t2 + 1.0) * v0[n]
                        + step * (t3 - 2.0 * t2 + t) * b0[n]
                        + (3.0 * t2 - 2.0 * t3) * v1[n]
                        + step * (t3 - t2) * a1[n]
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight(a: [f64; 1], b: [f64; 1], fraction: f64) -> [f64; 1] {
        [a[0] + fraction * (b[0] - a[0])]
    }

    #[test]
    fn values_go_as_their_interpolation_says() {
        let times = || vec![1.0, 2.0, 4.0];
        let values = || vec![[0.0], [1.0], [3.0]];
        let linear = track(times(), values(), false, false).expect("a track");
        assert_eq!([0.0, 1.5, 3.0, 9.0].map(|t| linear.at(t, straight)[0]), [0.0, 0.5, 2.0, 3.0]);
        let step = track(times(), values(), false, true).expect("a track");
        assert_eq!([0.0, 1.5, 2.0, 3.9, 9.0].map(|t| step.at(t, straight)[0]), [0.0, 0.0, 1.0, 1.0, 3.0]);
        // x = t²: at rest at 0, speed 2 at 1.
        let cubic =
            track(vec![0.0, 1.0], vec![[0.0], [0.0], [0.0], [2.0], [1.0], [2.0]], true, false).expect("a track");
        assert_eq!([0.0, 0.5, 1.0].map(|t| cubic.at(t, straight)[0]), [0.0, 0.25, 1.0]);
        assert!(track(times(), vec![[0.0]], false, false).is_err());
        assert!(track(vec![1.0, 1.0], vec![[0.0], [1.0]], false, false).is_err());
    }

    #[test]
    fn keys_are_limited_and_rotations_have_length() {
        assert_eq!(counted(5, 10, Interpolation::CubicSpline), Ok(165));
        assert_eq!(counted(0, MAX_KEYS, Interpolation::Linear), Ok(MAX_KEYS));
        assert!(counted(0, MAX_KEYS, Interpolation::Step).expect_err("too many").words.contains("1000000 keys"));
        let rotation = |q: [f64; 4]| track(vec![0.0], vec![q], false, false).expect("a track");
        assert!(check_rotation(&rotation([0.0, 0.0, 0.0, 1.0])).is_ok());
        assert!(check_rotation(&rotation([0.0; 4])).expect_err("none").words.contains("key 0"));
    }
}
