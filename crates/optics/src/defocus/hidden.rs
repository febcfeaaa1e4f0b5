//! Estimates of surfaces that are hidden from the centre of the pupil but visible from its edge, from neighbouring pixels.
//!
//! The farther surface at a jump of the distance is assumed to continue behind the nearer one. From each pixel the first jump to a farther surface is
//! searched in eight directions, within the reach of the blurs. The pixel one step beyond the jump provides light and inverse distance, because the
//! pixel at the jump may mix both surfaces. The mean over the directions, weighted by the inverse square of the number of steps, is the estimate of
//! the surface behind the pixel.

use super::{PinholeView, footprint::Footprints};

const DIRECTIONS: [[i64; 2]; 8] = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
/// Change of the blur diameter from a pixel to its neighbour that counts as a jump, px. Along a surface it changes at most by the pupil's diameter
/// over the distance to the surface's vanishing line: a few hundredths.
const JUMP_PX: f32 = 0.75;

/// Estimate of the surface hidden behind a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HiddenSurface {
    pub(super) pixel: u32,
    pub(super) inverse_per_m: f32,
    /// Pixels that contribute its light, and their weights, which sum to one; unused ones have weight 0.
    pub(super) taps: [(u32, f32); DIRECTIONS.len()],
}

/// Estimates of hidden surfaces, where rays from the edge of the pupil can reach them.
pub(super) fn fills(view: &PinholeView<'_>, footprints: &Footprints) -> Vec<HiddenSurface> {
    let inverse: Vec<f32> =
        (0..view.width() * view.height()).map(|i| view.inverse_per_m(i).unwrap_or(f32::NAN)).collect();
    let radius = |w: f32| if w.is_nan() { 0.0 } else { footprints.reach_px(f64::from(w)) as f32 };
    let radii: Vec<f32> = inverse.iter().map(|w| radius(*w)).collect();
    let farthest = radii.iter().copied().fold(0.0, f32::max);
    let search = HiddenSurfaceSearch {
        size: [view.width() as i64, view.height() as i64],
        jump_per_m: JUMP_PX / footprints.spread_px() as f32,
        steps: farthest.ceil() as i64 + 1,
        inverse: &inverse,
        radii: &radii,
    };
    (0..inverse.len()).filter(|i| !inverse[*i].is_nan()).filter_map(|i| search.behind(i)).collect()
}

struct HiddenSurfaceSearch<'a> {
    size: [i64; 2],
    jump_per_m: f32,
    /// Number of steps searched in each direction.
    steps: i64,
    inverse: &'a [f32],
    radii: &'a [f32],
}

impl HiddenSurfaceSearch<'_> {
    fn behind(&self, pixel: usize) -> Option<HiddenSurface> {
        let mut taps = [(0, 0.0); DIRECTIONS.len()];
        for (tap, direction) in taps.iter_mut().zip(DIRECTIONS) {
            if let Some((pixel_found, steps)) = self.find_jump(pixel, direction) {
                *tap = (pixel_found as u32, 1.0 / (steps * steps) as f32);
            }
        }
        let sum: f32 = taps.iter().map(|(_, weight)| weight).sum();
        if sum == 0.0 {
            return None;
        }
        taps.iter_mut().for_each(|(_, weight)| *weight /= sum);
        let inverse_per_m = taps.iter().map(|(pixel_found, weight)| self.inverse[*pixel_found as usize] * weight).sum();
        Some(HiddenSurface { pixel: pixel as u32, inverse_per_m, taps })
    }

    /// The pixel beyond the first jump to a farther surface, and its distance in steps.
    fn find_jump(&self, pixel: usize, direction: [i64; 2]) -> Option<(usize, i64)> {
        let mut last = self.inverse[pixel];
        for steps in 1..=self.steps {
            let index = self.at(pixel, direction, steps)?;
            let inverse = self.inverse[index];
            if last - inverse > self.jump_per_m && self.inverse[pixel] - inverse > self.jump_per_m {
                let reach = self.radii[pixel].max(self.radii[index]) + 1.0;
                return (steps as f32 <= reach).then(|| self.beyond(pixel, direction, steps, index));
            }
            last = inverse;
        }
        None
    }

    /// The next pixel along the direction if it belongs to the same surface.
    fn beyond(&self, pixel: usize, direction: [i64; 2], steps: i64, index: usize) -> (usize, i64) {
        let same = |next: &usize| (self.inverse[*next] - self.inverse[index]).abs() <= self.jump_per_m;
        self.at(pixel, direction, steps + 1).filter(same).map_or((index, steps), |next| (next, steps + 1))
    }

    fn at(&self, pixel: usize, direction: [i64; 2], steps: i64) -> Option<usize> {
        let [width, height] = self.size;
        let x = pixel as i64 % width + direction[0] * steps;
        let y = pixel as i64 / width + direction[1] * steps;
        ((0..width).contains(&x) && (0..height).contains(&y)).then_some((y * width + x) as usize)
    }
}
