//! Part of a line's image within the image frame.
//!
//! Image points of the line are connected by straight segments, which are clipped at the image border (Liang and Barsky 1984). Segments are halved until they
//! follow the image: perspective keeps lines straight, distortion and motion bend them. If one end of a segment has no image, for example behind the camera,
//! bisection finds the last point that has one.

use super::pixel_box::PixelBox;
use glam::DVec2;

/// Maximum distance of the image of a segment's middle from the segment, px.
const MAX_DEVIATION_PX: f64 = 0.01;
/// Maximum number of times a segment is halved.
const HALVINGS: u32 = 12;
/// Number of bisections for the end of the image: to 6e-8 of a segment.
const END_HALVINGS: u32 = 24;

/// A point of the line and its image.
#[derive(Clone, Copy)]
struct LinePoint {
    fraction: f64,
    at_px: DVec2,
}

/// Box around the images, within `picture`, of a line divided into `parts`; `image` returns the image of the point at a fraction of its length. `None` if no
/// part of it lies in the image. A line with images only between two neighbouring points of the division has none.
pub(super) fn clipped_box(
    image: &impl Fn(f64) -> Option<DVec2>,
    parts: usize,
    image_bounds: &PixelBox,
) -> Option<PixelBox> {
    let fraction = |i: usize| i as f64 / parts as f64;
    let point = |fraction: f64| image(fraction).map(|at_px| LinePoint { fraction, at_px });
    let mut from = point(0.0);
    let mut bounds = None;
    for i in 1..=parts {
        let to = point(fraction(i));
        let segment = match (from, to) {
            (Some(from), Some(to)) => Some((from, to)),
            (Some(from), None) => Some((from, last_point(image, from, fraction(i)))),
            (None, Some(to)) => Some((last_point(image, to, fraction(i - 1)), to)),
            (None, None) => None,
        };
        let segment = segment.and_then(|(from, to)| segment_within(image, from, to, image_bounds, HALVINGS));
        bounds = PixelBox::union(bounds, segment);
        from = to;
    }
    bounds
}

/// Last point with an image between a point that has one and a point that has none.
fn last_point(image: &impl Fn(f64) -> Option<DVec2>, from: LinePoint, mut without: f64) -> LinePoint {
    let mut with = from;
    for _ in 0..END_HALVINGS {
        let fraction = 0.5 * (with.fraction + without);
        match image(fraction) {
            Some(at_px) => with = LinePoint { fraction, at_px },
            None => without = fraction,
        }
    }
    with
}

fn segment_within(
    image: &impl Fn(f64) -> Option<DVec2>,
    from: LinePoint,
    to: LinePoint,
    image_bounds: &PixelBox,
    halvings: u32,
) -> Option<PixelBox> {
    let fraction = 0.5 * (from.fraction + to.fraction);
    let middle = (halvings > 0).then(|| image(fraction)).flatten();
    match middle {
        Some(at_px) if !is_between(at_px, from.at_px, to.at_px) => {
            let middle = LinePoint { fraction, at_px };
            PixelBox::union(
                segment_within(image, from, middle, image_bounds, halvings - 1),
                segment_within(image, middle, to, image_bounds, halvings - 1),
            )
        }
        _ => segment_box(from.at_px, to.at_px, image_bounds),
    }
}

/// Returns true if a point lies on the segment between two others.
fn is_between(at: DVec2, from: DVec2, to: DVec2) -> bool {
    let direction = to - from;
    let length = direction.length();
    if length == 0.0 {
        return at.distance(from) <= MAX_DEVIATION_PX;
    }
    let towards = direction / length;
    let reach = (at - from).dot(towards);
    // Far outside the image, rounding errors are proportional to the distance of the points.
    let tolerance = MAX_DEVIATION_PX.max(1e-9 * length);
    (at - from).perp_dot(towards).abs() <= tolerance && (-tolerance..=length + tolerance).contains(&reach)
}

/// Box around the part of a segment within the image.
fn segment_box(from: DVec2, to: DVec2, image_bounds: &PixelBox) -> Option<PixelBox> {
    let direction = to - from;
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let (low, high) = (image_bounds.low[axis] - from[axis], image_bounds.high[axis] - from[axis]);
        if direction[axis] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (a, b) = (low / direction[axis], high / direction[axis]);
        enters = enters.max(a.min(b));
        leaves = leaves.min(a.max(b));
    }
    if enters > leaves {
        return None;
    }
    // Rounding may place a point on the border slightly beyond it.
    let at = |fraction: f64| {
        let at = if fraction <= 0.0 {
            from
        } else if fraction >= 1.0 {
            to
        } else {
            from + direction * fraction
        };
        at.clamp(image_bounds.low, image_bounds.high)
    };
    let (a, b) = (at(enters), at(leaves));
    Some(PixelBox { low: a.min(b), high: a.max(b) })
}

#[cfg(test)]
mod tests {
    use super::*;

    const PICTURE: PixelBox = PixelBox { low: DVec2::ZERO, high: DVec2::new(200.0, 120.0) };

    fn edges(pixel_box: Option<PixelBox>) -> [f64; 4] {
        pixel_box.expect("within the picture").edges_px()
    }

    #[test]
    fn a_straight_line_is_cut_at_the_border() {
        let line = |fraction: f64| Some(DVec2::new(-100.0, 20.0).lerp(DVec2::new(100.0, 60.0), fraction));
        assert_eq!(edges(clipped_box(&line, 1, &PICTURE)), [0.0, 40.0, 100.0, 60.0]);
        let partly_outside = |fraction: f64| Some(DVec2::new(-100.0, 20.0).lerp(DVec2::new(-1.0, 60.0), fraction));
        assert_eq!(clipped_box(&partly_outside, 4, &PICTURE), None);
        // It misses a corner, although its box contains it.
        let past = |fraction: f64| Some(DVec2::new(-10.0, 5.0).lerp(DVec2::new(5.0, -10.0), fraction));
        assert_eq!(clipped_box(&past, 1, &PICTURE), None);
    }

    /// A line along the ground from 10 m before a pinhole camera to 10 m behind it: it leaves the image at the lower border.
    #[test]
    fn a_line_that_passes_the_camera_ends_at_the_border() {
        let image = |fraction: f64| {
            let (ahead, below, right) = (10.0 - 20.0 * fraction, 1.5, -0.5);
            (ahead > 0.0).then(|| DVec2::new(100.0, 60.0) + DVec2::new(right, below) * (200.0 / ahead))
        };
        for parts in [1, 7] {
            let [left, top, right, bottom] = edges(clipped_box(&image, parts, &PICTURE));
            assert!(
                (top - 90.0).abs() < 1e-9 && bottom == 120.0 && (right - 90.0).abs() < 1e-9,
                "{top} {bottom} {right}"
            );
            assert!((left - 80.0).abs() < 1e-6, "{left}");
        }
    }

    /// A semicircle that enters the image only between its ends.
    #[test]
    fn bent_lines_are_followed() {
        let image = |fraction: f64| {
            let (sin, cos) = etendue_core::maths::f64::sin_cos(core::f64::consts::PI * (fraction - 0.5));
            Some(DVec2::new(-50.0 + 100.0 * cos, 60.0 + 30.0 * sin))
        };
        let [left, _, right, _] = edges(clipped_box(&image, 3, &PICTURE));
        assert!(left == 0.0 && (right - 50.0).abs() < MAX_DEVIATION_PX, "{left} {right}");
    }
}
