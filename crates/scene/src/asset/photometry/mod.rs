//! A measured lamp: luminous intensity (cd) by direction, on a grid of angles.
//!
//! | axes | planes of one horizontal angle H | zero (H = 0, V = 0) | vertical angle V | horizontal angle H |
//! | --- | --- | --- | --- | --- |
//! | C | vertical, about a vertical axis | nadir | 0° nadir … 180° zenith | 0° … 360°, counter-clockwise from above |
//! | A | vertical, about a vertical axis | optical axis | −90° down … 90° up, a latitude | −180° … 180°, clockwise from above |
//! | B | planes of one V share a horizontal axis | optical axis | −180° … 180° up, about that axis | −90° left … 90° right, a latitude |
//!
//! (ANSI/IESNA LM-63-2002, section 3; CIE 121:1996.) The grid is complete: symmetries are expanded and a full turn holds both its ends, so that
//! bilinear interpolation in the two angles is sufficient. Outside the grid a lamp is dark.

mod flux;

use etendue_core::maths::f64::{atan2, sin_cos};

/// Systems of angles of photometric measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotometryAxes {
    /// Vertical planes about a vertical axis, zero ahead: headlamps and signals (the H-V of UN R149).
    A,
    /// Planes about a horizontal axis, zero ahead: flood lights.
    B,
    /// Vertical planes about a vertical axis, zero below: rooms and roads.
    C,
}

/// Dependence of a lamp's light on its tilt.
#[derive(Clone, Debug, PartialEq)]
pub enum Tilt {
    /// Independent of the tilt, or not stated by the file.
    None,
    /// A table of tilts (degrees) and factors; not applied: the grid holds for the tilt of the measurement.
    Table {
        /// Position of the lamp in the luminaire: 1 base up or down, 2 horizontal and not turning, 3 horizontal and turning.
        geometry: u8,
        /// Angles from the position of measurement, degrees, and factors.
        factors: Vec<(f64, f64)>,
    },
    /// Tilt of the luminaire during the measurement, degrees (EULUMDAT); the angles are its own.
    Measured(f64),
}

/// The shape of the luminous opening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OpeningShape {
    Point,
    /// A box; a rectangle if its height is zero.
    Rectangular,
    /// A round body: a disc or an upright cylinder, or an ellipse with two diameters.
    Round,
    /// A sphere or an ellipsoid.
    Ball,
    /// A horizontal cylinder, its axis along the length.
    Lying,
    /// A horizontal cylinder, its axis along the width.
    LyingAcross,
}

/// The luminous opening, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    pub shape: OpeningShape,
    /// Extent along the C0–C180 plane of type C, along the vertical plane through the axis of types A and B.
    pub length_m: f64,
    /// Extent across it.
    pub width_m: f64,
    /// Extent upwards.
    pub height_m: f64,
}

/// A measured lamp.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotometryAsset {
    /// Format of the file, with its version.
    pub format: String,
    /// The system of angles.
    pub axes: PhotometryAxes,
    /// Vertical angles, degrees, increasing; at least one.
    pub vertical_deg: Vec<f64>,
    /// Horizontal angles, degrees, increasing; at least two. Type C: 0 … 360.
    pub horizontal_deg: Vec<f64>,
    /// Intensity, cd, with every factor applied: all vertical angles of the first horizontal one, then of the next.
    pub candela: Vec<f64>,
    /// Total rated lumens of all lamps; `None` for a luminaire that was measured by itself (absolute photometry).
    pub rated_lumens: Option<f64>,
    /// Fraction of the rated lumens that leaves the luminaire, if the file states it.
    pub output_ratio: Option<f64>,
    /// Number of lamps.
    pub lamps: u32,
    /// Factor applied to the numbers of the file, ballast factors and lumens of the lamps included.
    pub factor: f64,
    /// Electrical power, ballast included, W.
    pub watts: f64,
    /// The luminous opening.
    pub opening: Opening,
    /// Dependence on the tilt.
    pub tilt: Tilt,
    /// Texts of the file: name and content, in its order.
    pub texts: Vec<(String, String)>,
    /// Anomalies, assumptions and unused content, in sentences for the user, with the check of the flux.
    pub report: Vec<String>,
    /// SHA-256 of the file and of the file of tilts it names.
    pub hash: [u8; 32],
}

impl PhotometryAsset {
    /// Intensities at the horizontal angle with this index, one per vertical angle.
    #[must_use]
    pub fn column(&self, horizontal: usize) -> &[f64] {
        let rows = self.vertical_deg.len();
        &self.candela[horizontal * rows..][..rows]
    }

    /// Intensity at two angles (degrees), cd: bilinear within the grid, 0 outside it.
    #[must_use]
    pub fn candela_at(&self, horizontal_deg: f64, vertical_deg: f64) -> f64 {
        let (Some((h, s)), Some((v, t))) =
            (cell(&self.horizontal_deg, horizontal_deg), cell(&self.vertical_deg, vertical_deg))
        else {
            return 0.0;
        };
        let column_value = |column: usize| {
            let values = self.column(column);
            blend(values[v], values[(v + 1).min(values.len() - 1)], t)
        };
        blend(column_value(h), column_value((h + 1).min(self.horizontal_deg.len() - 1)), s)
    }

    /// Intensity (cd) towards the right and up as in UN regulations for headlamps (a latitude and a longitude about a vertical axis, degrees); `None`
    /// for type C, which has no forward direction.
    #[must_use]
    pub fn candela_ahead(&self, right_deg: f64, up_deg: f64) -> Option<f64> {
        match self.axes {
            PhotometryAxes::A => Some(self.candela_at(right_deg, up_deg)),
            PhotometryAxes::B => {
                let ((sin_right, cos_right), (sin_up, cos_up)) =
                    (sin_cos(right_deg.to_radians()), sin_cos(up_deg.to_radians()));
                let [ahead, right, up] = [cos_up * cos_right, cos_up * sin_right, sin_up];
                let across = atan2(right, (ahead * ahead + up * up).sqrt()).to_degrees();
                Some(self.candela_at(across, atan2(up, ahead).to_degrees()))
            }
            PhotometryAxes::C => None,
        }
    }

    /// Greatest intensity (cd) with its horizontal and vertical angle (degrees): the first of equals.
    #[must_use]
    pub fn peak(&self) -> (f64, f64, f64) {
        let rows = self.vertical_deg.len();
        let best =
            self.candela.iter().enumerate().fold((0, f64::NEG_INFINITY), |best, (index, value)| {
                if *value > best.1 { (index, *value) } else { best }
            });
        (best.1, self.horizontal_deg[best.0 / rows], self.vertical_deg[best.0 % rows])
    }

    /// Luminous flux that leaves the luminaire, lm, if the file states it.
    #[must_use]
    pub fn stated_flux_lm(&self) -> Option<f64> {
        Some(self.rated_lumens? * self.output_ratio.unwrap_or(1.0))
    }
}

/// Cell of an increasing grid that contains `at`, and the position in it (0 … 1).
fn cell(grid: &[f64], at: f64) -> Option<(usize, f64)> {
    let above = grid.partition_point(|g| *g <= at);
    let last = grid.len() - 1;
    match above.checked_sub(1)? {
        below if below < last => Some((below, (at - grid[below]) / (grid[below + 1] - grid[below]))),
        below => (grid[below] == at).then_some((below, 0.0)),
    }
}

fn blend(a: f64, b: f64, t: f64) -> f64 {
    (1.0 - t) * a + t * b
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lamp with the given intensities by horizontal and vertical angle.
    pub(super) fn grid(
        axes: PhotometryAxes,
        horizontal_deg: &[f64],
        vertical_deg: &[f64],
        candela: impl Fn(f64, f64) -> f64,
    ) -> PhotometryAsset {
        let candela = horizontal_deg
            .iter()
            .flat_map(|h| vertical_deg.iter().map(|v| candela(*h, *v)).collect::<Vec<_>>())
            .collect();
        PhotometryAsset {
            format: String::new(),
            axes,
            vertical_deg: vertical_deg.to_vec(),
            horizontal_deg: horizontal_deg.to_vec(),
            candela,
            rated_lumens: None,
            output_ratio: None,
            lamps: 1,
            factor: 1.0,
            watts: 0.0,
            opening: Opening { shape: OpeningShape::Point, length_m: 0.0, width_m: 0.0, height_m: 0.0 },
            tilt: Tilt::None,
            texts: Vec::new(),
            report: Vec::new(),
            hash: [0; 32],
        }
    }

    #[test]
    fn between_points_the_intensity_is_bilinear_and_outside_it_is_dark() {
        let lamp = grid(PhotometryAxes::A, &[-10.0, 0.0, 20.0], &[-5.0, 5.0], |h, v| 100.0 + 2.0 * h + 4.0 * v);
        for (h, v) in [(-10.0, -5.0), (-4.0, 1.0), (0.0, 0.0), (15.0, 4.5), (20.0, 5.0)] {
            let expected = 100.0 + 2.0 * h + 4.0 * v;
            assert!((lamp.candela_at(h, v) - expected).abs() < 1e-12 * expected, "({h}, {v})");
        }
        for (h, v) in [(-10.01, 0.0), (20.01, 0.0), (0.0, 5.01), (0.0, -5.01)] {
            assert_eq!(lamp.candela_at(h, v), 0.0, "({h}, {v})");
        }
        assert_eq!(lamp.peak(), (160.0, 20.0, 5.0));
    }

    #[test]
    fn the_directions_of_regulations_are_type_a_and_turned_for_type_b() {
        let (across, up) = ([-30.0, 0.0, 30.0], [-20.0, 0.0, 20.0]);
        let a = grid(PhotometryAxes::A, &across, &up, |h, v| 100.0 + h + 2.0 * v);
        assert_eq!(a.candela_ahead(10.0, -5.0), Some(a.candela_at(10.0, -5.0)));
        let b = grid(PhotometryAxes::B, &across, &up, |h, v| 100.0 + h + 2.0 * v);
        // cos 10° cos 20°, cos 10° sin 20°, sin 10° are ahead, right and up: asin 0.336824 and atan(0.173648 / 0.925417).
        let actual = b.candela_ahead(20.0, 10.0).expect("ahead");
        assert!((actual - (100.0 + 19.683_498 + 2.0 * 10.627_584)).abs() < 1e-5, "{actual}: angles to six decimals");
        assert_eq!(grid(PhotometryAxes::C, &across, &up, |_, _| 1.0).candela_ahead(0.0, 0.0), None);
    }

    #[test]
    fn a_single_plane_is_a_grid_too() {
        let lamp = grid(PhotometryAxes::C, &[0.0, 360.0], &[90.0], |_, _| 7.0);
        assert_eq!((lamp.candela_at(123.0, 90.0), lamp.candela_at(123.0, 89.0)), (7.0, 0.0));
    }
}
