//! Displacement fields over the image, by which one map of a plane differs from another; errors of a distortion measurement.
//!
//! A homography near the identity has eight: two of position, four of slope, two of tilt, v (t · v). A distortion is described by
//! fields without position, slope and tilt at the centre, so that none of them is confused with a homography: four of the six
//! quadratic ones, and all of higher degree. x is the position relative to the centre divided by the chart's reach, |x| ≤ 1 on
//! the chart.

use glam::DVec2;

use crate::fit::FitError;

/// Number of fields of a homography.
pub(super) const PLANE: usize = 8;
/// Degree of the highest field.
pub(super) const DEGREE: usize = 9;

/// The fields of a homography.
pub(super) fn plane(x: DVec2) -> [DVec2; PLANE] {
    let (e, f) = (DVec2::X, DVec2::Y);
    [e, f, x.x * e, x.y * e, x.x * f, x.y * f, x.x * x, x.y * x]
}

/// The fields of a distortion: the quadratic ones, then x₁ⁱ x₂ʲ √(n over j) along either axis for degrees n = i + j from 3 on,
/// whose squares add to 2 |x|²ⁿ for each n in every direction.
pub(super) fn distortion(x: DVec2) -> Vec<DVec2> {
    let (xx, xy, yy) = (x.x * x.x, x.x * x.y, x.y * x.y);
    let mut fields =
        vec![DVec2::new(0.0, xx), DVec2::new(yy, 0.0), DVec2::new(xx, -2.0 * xy), DVec2::new(-2.0 * xy, yy)];
    let (along, down) = (powers(x.x), powers(x.y));
    for n in 3..=DEGREE {
        let mut binomial = 1.0;
        for j in 0..=n {
            let term = f64::sqrt(binomial) * along[n - j] * down[j];
            fields.extend([DVec2::new(term, 0.0), DVec2::new(0.0, term)]);
            binomial *= (n - j) as f64 / (j + 1) as f64;
        }
    }
    fields
}

fn powers(x: f64) -> [f64; DEGREE + 1] {
    let mut powers = [1.0; DEGREE + 1];
    (1..=DEGREE).for_each(|n| powers[n] = powers[n - 1] * x);
    powers
}

/// Reason why a distortion cannot be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DistortionError {
    /// Too few points.
    #[error(
        "{points} points of the chart are too few for a distortion curve; at least {least} are needed: use a chart with more points"
    )]
    Few {
        /// Points found.
        points: usize,
        /// Minimum number of points.
        least: usize,
    },
    /// The chart does not cover the centre.
    #[error(
        "the chart does not cover the image centre, ({:.1}, {:.1}) px, where the ideal scale is determined: centre the chart, or \
         state another centre", centre_px[0], centre_px[1]
    )]
    Centre { centre_px: [f64; 2] },
    /// A fit failed.
    #[error(transparent)]
    Fit(#[from] FitError),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_field_of_a_distortion_is_a_homography_s() {
        let at = |x: f64, y: f64| distortion(DVec2::new(x, y));
        let h = 1e-3;
        let (zero, count) = (at(0.0, 0.0), 4 + (3..=DEGREE).map(|n| 2 * (n + 1)).sum::<usize>());
        assert_eq!(zero.len(), count);
        for (k, at_zero) in zero.iter().enumerate() {
            let second = |a: [f64; 2], b: [f64; 2]| (at(a[0], a[1])[k] + at(b[0], b[1])[k]) / (h * h);
            let (xx, yy) = (second([h, 0.0], [-h, 0.0]), second([0.0, h], [0.0, -h]));
            let xy = 0.25 * (second([h, h], [-h, -h]) - second([h, -h], [-h, h]));
            assert!(*at_zero == DVec2::ZERO && (at(h, 0.0)[k].length() / h) < 2.0 * h, "{k}");
            // Fourth powers leave h²; the tilt nearest to a curvature is −(xx.x + xy.y, yy.y + xy.x)/3.
            assert!((xx.x + xy.y).abs() < 1e-5 && (yy.y + xy.x).abs() < 1e-5, "{k}: {xx} {xy} {yy}");
        }
    }

    #[test]
    fn each_degree_is_as_large_in_every_direction() {
        for x in [DVec2::X, DVec2::new(0.6, 0.8), DVec2::new(-0.28, 0.96)] {
            let squares: f64 = distortion(x)[4..].iter().map(|f| f.length_squared()).sum();
            assert!((squares - 2.0 * (DEGREE - 2) as f64).abs() < 1e-12, "{squares}");
        }
    }
}
