//! Shading correction: gains that make an evenly lit picture even.
//!
//! | model | gain at a pixel |
//! | --- | --- |
//! | [`Shading::Radial`] | a table over the distance from a centre, equal steps from 0 to 1, linear between; 1 is the farthest corner of the picture |
//! | [`Shading::Grid`] | a table of columns by rows laid over the picture, its outer nodes on the corners, bilinear between |
//!
//! Gains are at least 1, so that a saturated pixel stays white (clipped at 1 after the gain). One gain serves all
//! colours; shading that differs by colour is left out. Noise grows with the gain.

/// Gains over the picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Shading {
    /// By the distance from a centre.
    Radial {
        /// The centre, raster coordinates (the top left corner is 0, 0), px.
        centre_px: [f64; 2],
        /// Gains at equal steps of the distance, from the centre to the farthest corner; two or more.
        gains: Vec<f64>,
    },
    /// By a grid over the picture.
    Grid {
        /// Columns of the grid, two or more.
        columns: usize,
        /// Gains row by row.
        gains: Vec<f64>,
    },
}

/// Why a table cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShadingError {
    /// Too few entries or no rectangle.
    #[error("a shading table of {entries} gains {shape}: give at least two along each direction")]
    Shape {
        /// Gains given.
        entries: usize,
        /// What is wrong with them.
        shape: &'static str,
    },
    /// A gain that is none.
    #[error("a shading gain is {0}, but finite gains of at least 1 are needed: divide them by the smallest")]
    Gain(f64),
}

impl Shading {
    /// Whether the table can be used.
    ///
    /// # Errors
    /// Where it is too small, not a rectangle, or holds a gain below 1.
    pub fn check(&self) -> Result<(), ShadingError> {
        let (gains, shape) = match self {
            Self::Radial { gains, .. } => (gains, (gains.len() < 2).then_some("is too short")),
            Self::Grid { columns, gains } => {
                let rectangle = *columns >= 2 && gains.len() % columns == 0 && gains.len() / columns >= 2;
                (gains, (!rectangle).then_some("is no grid of two by two or more"))
            }
        };
        if let Some(shape) = shape {
            return Err(ShadingError::Shape { entries: gains.len(), shape });
        }
        gains.iter().find(|g| !(g.is_finite() && **g >= 1.0)).map_or(Ok(()), |g| Err(ShadingError::Gain(*g)))
    }

    /// The gains of row `y` of a picture of `width` × `height` pixels. The table is a checked one.
    pub(crate) fn row(&self, y: usize, width: usize, height: usize) -> Vec<f32> {
        let gain = |x: usize| match self {
            Self::Radial { centre_px, gains } => radial(gains, *centre_px, [x, y], [width, height]),
            Self::Grid { columns, gains } => grid(gains, *columns, [x, y], [width, height]),
        };
        (0..width).map(|x| gain(x) as f32).collect()
    }
}

fn radial(gains: &[f64], centre: [f64; 2], pixel: [usize; 2], size: [usize; 2]) -> f64 {
    let far = [0, 1].map(|i| centre[i].abs().max((size[i] as f64 - centre[i]).abs()));
    let from = [0, 1].map(|i| pixel[i] as f64 + 0.5 - centre[i]);
    let share = ((from[0] * from[0] + from[1] * from[1]) / (far[0] * far[0] + far[1] * far[1])).sqrt();
    let (low, part) = place(share, gains.len());
    gains[low] + part * (gains[low + 1] - gains[low])
}

fn grid(gains: &[f64], columns: usize, pixel: [usize; 2], size: [usize; 2]) -> f64 {
    let share = |i: usize| (pixel[i] as f64 + 0.5) / size[i] as f64;
    let ((x, u), (y, v)) = (place(share(0), columns), place(share(1), gains.len() / columns));
    let along = |row: usize| {
        let left = gains[row * columns + x];
        left + u * (gains[row * columns + x + 1] - left)
    };
    let (top, bottom) = (along(y), along(y + 1));
    top + v * (bottom - top)
}

/// The node below a share of the whole, and how far beyond it, of `count` nodes.
fn place(share: f64, count: usize) -> (usize, f64) {
    let at = share.clamp(0.0, 1.0) * (count - 1) as f64;
    let low = (at as usize).min(count - 2);
    (low, at - low as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radial_table_undoes_the_vignetting_it_was_made_of() {
        // 1/gain of a fall-off 1 − 0.5 r², tabulated in 64 steps: linear interpolation errs by at most h² max|g″|/8.
        let gains: Vec<f64> = (0..=64).map(|i| 1.0 / (1.0 - 0.5 * square(f64::from(i) / 64.0))).collect();
        let table = Shading::Radial { centre_px: [32.0, 24.0], gains };
        table.check().expect("a legal table");
        for y in 0..48 {
            for (x, gain) in table.row(y, 64, 48).iter().enumerate() {
                let (dx, dy) = (x as f64 + 0.5 - 32.0, y as f64 + 0.5 - 24.0);
                let light = 1.0 - 0.5 * (dx * dx + dy * dy) / (32.0 * 32.0 + 24.0 * 24.0);
                // max g″ = 14 at the corner: 14/8/64² = 4.3e-4, relative to a gain of 2 half of it.
                assert!((f64::from(*gain) * light - 1.0).abs() < 4.3e-4, "{x} {y}");
            }
        }
    }

    fn square(x: f64) -> f64 {
        x * x
    }

    #[test]
    fn a_grid_is_bilinear() {
        let table = Shading::Grid { columns: 3, gains: vec![1.0, 2.0, 3.0, 3.0, 4.0, 5.0] };
        table.check().expect("a legal table");
        for y in 0..6 {
            for (x, gain) in table.row(y, 8, 6).iter().enumerate() {
                let want = 1.0 + 2.0 * (x as f64 + 0.5) / 8.0 + 2.0 * (y as f64 + 0.5) / 6.0;
                assert!((f64::from(*gain) - want).abs() < 1e-6, "{gain} {want}");
            }
        }
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        let radial = |gains| Shading::Radial { centre_px: [1.0, 1.0], gains };
        assert!(matches!(radial(vec![1.0]).check(), Err(ShadingError::Shape { .. })));
        assert_eq!(radial(vec![1.0, 0.5]).check(), Err(ShadingError::Gain(0.5)));
        assert!(radial(vec![1.0, f64::NAN]).check().is_err());
        assert!(Shading::Grid { columns: 2, gains: vec![1.0; 5] }.check().is_err());
        assert!(Shading::Grid { columns: 0, gains: vec![] }.check().is_err());
    }
}
