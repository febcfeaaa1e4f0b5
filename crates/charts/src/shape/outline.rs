//! Outlines: closed polygons, clockwise as seen.

use etendue_core::maths::f64::sin_cos;
use glam::DVec2;
use std::f64::consts::TAU;

/// Area by the shoelace formula, mm²; positive for outlines that turn clockwise as seen (x right, y down).
#[must_use]
pub fn area(outline: &[DVec2]) -> f64 {
    edges(outline).map(|(a, b)| a.perp_dot(b)).sum::<f64>() / 2.0
}

/// Centroid of the area; the mean of the corners where there is no area.
#[must_use]
pub fn centroid(outline: &[DVec2]) -> DVec2 {
    let first = outline.first().copied().unwrap_or_default();
    let weighed =
        edges(outline).map(|(a, b)| (a - first, b - first)).fold((DVec2::ZERO, 0.0), |(sum, weight), (a, b)| {
            let twice = a.perp_dot(b);
            (sum + (a + b) * twice, weight + twice)
        });
    match weighed {
        (sum, weight) if weight != 0.0 => first + sum / (3.0 * weight),
        _ => outline.iter().sum::<DVec2>() / outline.len().max(1) as f64,
    }
}

/// Least and greatest coordinates.
#[must_use]
pub fn bounds(outline: &[DVec2]) -> (DVec2, DVec2) {
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    outline.iter().fold(none, |(low, high), point| (low.min(*point), high.max(*point)))
}

/// A rectangle by its top left and bottom right corners.
#[must_use]
pub fn rectangle(low: DVec2, high: DVec2) -> Vec<DVec2> {
    vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)]
}

/// A regular polygon of `corners` corners with the area of the disc of `radius`, the first corner at `start_rad` from +x
/// towards +y. Its outline leaves the circle by at most radius · (π/corners)²/3 on either side; its centroid is the disc's.
#[must_use]
pub fn disc(centre: DVec2, radius: f64, corners: usize, start_rad: f64) -> Vec<DVec2> {
    let step = TAU / corners as f64;
    let reach = radius * (step / sin_cos(step).0).sqrt();
    (0..corners).map(|i| centre + reach * direction(start_rad + step * i as f64)).collect()
}

/// An outline turned about `centre` by `angle_rad`, clockwise as seen, and enlarged.
#[must_use]
pub fn turned(outline: &[DVec2], centre: DVec2, angle_rad: f64) -> Vec<DVec2> {
    let axis = direction(angle_rad);
    outline.iter().map(|point| centre + axis.rotate(*point - centre)).collect()
}

/// The unit vector at an angle from +x towards +y.
pub(crate) fn direction(angle_rad: f64) -> DVec2 {
    let (sin, cos) = sin_cos(angle_rad);
    DVec2::new(cos, sin)
}

/// Edges from corner to corner.
pub(crate) fn edges(outline: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = outline.iter().cycle().skip(1);
    outline.iter().copied().zip(next.copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_and_centroids_of_known_shapes() {
        let square = rectangle(DVec2::new(1.0, 2.0), DVec2::new(4.0, 4.0));
        assert_eq!((area(&square), centroid(&square)), (6.0, DVec2::new(2.5, 3.0)));
        let triangle = [DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::new(0.0, 3.0)];
        assert_eq!((area(&triangle), centroid(&triangle)), (4.5, DVec2::ONE));
    }

    #[test]
    fn a_disc_has_the_circle_s_area_and_hugs_it() {
        for corners in [8, 64, 128] {
            let centre = DVec2::new(100.0, -40.0);
            let polygon = disc(centre, 5.0, corners, 0.3);
            let exact = std::f64::consts::PI * 25.0;
            assert!((area(&polygon) / exact - 1.0).abs() < 1e-13, "{corners}");
            assert!((centroid(&polygon) - centre).length() < 1e-12);
            let half = std::f64::consts::PI / corners as f64;
            let bound = 5.0 * half * half / 3.0;
            let middles = edges(&polygon).map(|(a, b)| (a + b) / 2.0);
            let worst =
                polygon.iter().copied().chain(middles).map(|p| ((p - centre).length() - 5.0).abs()).fold(0.0, f64::max);
            // The next order of the series adds 2 % at eight corners.
            assert!(worst < 1.05 * bound, "{corners}: {worst} {bound}");
        }
    }
}
