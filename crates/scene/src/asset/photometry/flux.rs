//! The luminous flux of a grid: ∫ I dΩ, exact for intensities that are bilinear in the two angles.
//!
//! One angle, the longitude, enters the solid angle linearly, the other by the sine of its distance from the pole: dΩ = sin V dV dH for type C, cos V
//! dV dH for A, cos H dH dV for B. Along a latitude t, with f linear between t₀ and t₁ and b its slope, ∫ f cos t dt = [f sin t + b cos t].

use etendue_core::maths::f64::{cos, sin};

use super::{PhotometryAsset, PhotometryAxes};

impl PhotometryAsset {
    /// Total flux of the grid, lm.
    #[must_use]
    pub fn flux_lm(&self) -> f64 {
        let columns: Vec<usize> = (0..self.horizontal_deg.len()).collect();
        let rows: Vec<usize> = (0..self.vertical_deg.len()).collect();
        let at = |h: usize, v: usize| self.column(h)[v];
        match self.axes {
            PhotometryAxes::C => self.by_column(&columns, |v| v - 90.0),
            PhotometryAxes::A => self.by_column(&columns, |v| v),
            PhotometryAxes::B => {
                let bands: Vec<f64> =
                    rows.iter().map(|v| integrate_over_latitudes(&self.horizontal_deg, |h| at(h, *v), |h| h)).collect();
                integrate_trapezoids(&self.vertical_deg, &bands)
            }
        }
    }

    /// Flux of a grid whose vertical angles are latitudes after `latitude` is applied.
    fn by_column(&self, columns: &[usize], latitude: impl Fn(f64) -> f64 + Copy) -> f64 {
        let bands: Vec<f64> = columns
            .iter()
            .map(|h| integrate_over_latitudes(&self.vertical_deg, |v| self.column(*h)[v], latitude))
            .collect();
        integrate_trapezoids(&self.horizontal_deg, &bands)
    }
}

/// ∫ f cos t dt over a grid in degrees.
fn integrate_over_latitudes(grid_deg: &[f64], value: impl Fn(usize) -> f64, latitude_deg: impl Fn(f64) -> f64) -> f64 {
    let at = |i: usize| (latitude_deg(grid_deg[i]).to_radians(), value(i));
    let piece = |i: usize| {
        let ((t0, f0), (t1, f1)) = (at(i - 1), at(i));
        let slope = (f1 - f0) / (t1 - t0);
        (f1 * sin(t1) + slope * cos(t1)) - (f0 * sin(t0) + slope * cos(t0))
    };
    (1..grid_deg.len()).map(piece).sum()
}

/// ∫ f dt over a grid in degrees.
fn integrate_trapezoids(grid_deg: &[f64], values: &[f64]) -> f64 {
    let step = |i: usize| (grid_deg[i] - grid_deg[i - 1]).to_radians() * 0.5 * (values[i] + values[i - 1]);
    (1..grid_deg.len()).map(step).sum()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::super::tests::grid;
    use super::*;

    /// Sums of a few dozen terms of order 1 to 10, each accurate to about 1e-15.
    const ROUNDING: f64 = 1e-12;

    fn steps(low: f64, high: f64, count: usize) -> Vec<f64> {
        (0..=count).map(|i| low + (high - low) * i as f64 / count as f64).collect()
    }

    #[test]
    fn a_uniform_lamp_gives_the_solid_angle_of_its_grid() {
        let all = [
            (PhotometryAxes::C, steps(0.0, 360.0, 5), steps(0.0, 180.0, 7), 4.0 * PI),
            (PhotometryAxes::C, vec![0.0, 360.0], vec![0.0, 60.0], PI),
            (PhotometryAxes::A, steps(-180.0, 180.0, 3), steps(-90.0, 90.0, 4), 4.0 * PI),
            (PhotometryAxes::A, vec![-45.0, 45.0], vec![-30.0, 30.0], 0.5 * PI),
            (PhotometryAxes::B, steps(-90.0, 90.0, 3), steps(-180.0, 180.0, 4), 4.0 * PI),
            (PhotometryAxes::B, vec![-30.0, 30.0], vec![-45.0, 45.0], 0.5 * PI),
        ];
        for (axes, horizontal, vertical, expected) in all {
            let flux = grid(axes, &horizontal, &vertical, |_, _| 1.0).flux_lm();
            assert!((flux - expected).abs() < ROUNDING * expected, "{axes:?}: {flux}, not {expected}");
        }
    }

    #[test]
    fn intensities_that_are_linear_in_the_angles_are_summed_without_error() {
        // ∫₀^π γ sin γ dγ = π, so that I = γ (rad) gives 2π².
        let cone = grid(PhotometryAxes::C, &[0.0, 90.0, 360.0], &[0.0, 20.0, 180.0], |_, v| v.to_radians());
        assert!((cone.flux_lm() - 2.0 * PI * PI).abs() < ROUNDING * 20.0, "{}", cone.flux_lm());
        // I = |V| (rad): ∫ |V| cos V dV over ±90° = 2 (π/2 − 1).
        let fan = grid(PhotometryAxes::A, &[-90.0, 90.0], &[-90.0, 0.0, 90.0], |_, v| v.abs().to_radians());
        assert!((fan.flux_lm() - PI * (PI - 2.0)).abs() < ROUNDING * 4.0, "{}", fan.flux_lm());
        let turned = grid(PhotometryAxes::B, &[-90.0, 0.0, 90.0], &[-90.0, 90.0], |h, _| h.abs().to_radians());
        assert_eq!(turned.flux_lm(), fan.flux_lm(), "type B is type A with the axes exchanged");
    }
}
