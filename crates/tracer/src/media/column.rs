//! How much of each medium lies along a ray, by quadrature: for one answer a ray, without random numbers.

use etendue_core::Ray;

use super::media::{Media, Placed};

/// Steps along one ray at most.
const MAX_STEPS: f64 = 8192.0;

/// Steps to the smallest eddy.
const STEPS_PER_EDDY: f64 = 6.0;

impl Media<'_> {
    /// ∫ density dt up to a ray's `t_max`, m, of each medium: the length of mean density that takes as much light. Infinite where the way is.
    /// Uneven densities are summed at the middles of at least six steps to their smallest eddy, but of at most 8 192 steps.
    #[must_use]
    pub fn columns_m(&self, ray: &Ray) -> Vec<f64> {
        self.placed.iter().map(|placed| self.column_m(placed, ray)).collect()
    }

    fn column_m(&self, placed: &Placed<'_>, ray: &Ray) -> f64 {
        let Some((from, to)) = self.span(placed, ray, f64::from(ray.t_max)) else { return 0.0 };
        let length_m = (to - from) * f64::from(ray.direction.length());
        if let Some(hollow) = &placed.hollow {
            let line = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
            return hollow.way(line, (from, to)) * f64::from(ray.direction.length());
        }
        let Some(unevenness) = placed.medium.unevenness.filter(|_| length_m.is_finite()) else {
            return self.inside(placed, ray, (from, to)) * f64::from(ray.direction.length());
        };
        let steps = (length_m / unevenness.noise.smallest_m() * STEPS_PER_EDDY).ceil().clamp(1.0, MAX_STEPS);
        let middles = (0..steps as u32).map(|i| from + (f64::from(i) + 0.5) / steps * (to - from));
        length_m * middles.map(|t| self.density(placed, ray, t)).sum::<f64>() / steps
    }
}
