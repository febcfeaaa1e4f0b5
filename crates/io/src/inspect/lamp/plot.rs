//! Image of a lamp's intensity distribution, with its beam and field angle and the test points of a passing beam.
//!
//! Beam and field angle: full width at 50 % and at 10 % of the largest intensity (ANSI/IES LS-1; CIE 17).
//!
//! Types A and B: across the peak, horizontally and vertically. Type C: in the planes C0–C180 and C90–C270, from the largest intensity of the plane to both
//! sides. Intensity is linear between points; a beam that reaches the end of its grid ends there.
//!
//! Layout of the image.
//!
//! Type C: a polar diagram, straight down at the bottom; C0 is right and C180 left (red), C90 right and C270 left (blue); rings at quarters of the largest
//! intensity, spokes every 30°. Types A and B: the view ahead as in H-V diagrams, right is right, up is up; brightness by the logarithm over three decades,
//! lines at 1, ½, ⅕ and 1/10 of each decade of the peak; cross hairs at H = 0, V = 0 and dots at the test points of a passing beam.

use etendue_core::maths::f64::{atan2, log10};
use etendue_scene::asset::{PhotometryAsset, PhotometryAxes};

use super::passing_beam;
use crate::inspect::Preview;

/// Angles (degrees, increasing) and intensities of a section through a lamp.
type PlaneCut = Vec<(f64, f64)>;

/// Sections by name, each with its beam and field angle, degrees.
pub(super) fn beam_and_field(lamp: &PhotometryAsset) -> Vec<(&'static str, [f64; 2])> {
    let cuts = match lamp.axes {
        PhotometryAxes::C => vec![("C0–C180", plane(lamp, 0.0)), ("C90–C270", plane(lamp, 90.0))],
        PhotometryAxes::A | PhotometryAxes::B => fan(lamp),
    };
    cuts.into_iter().map(|(name, cut)| (name, [0.5, 0.1].map(|fraction| width(&cut, fraction)))).collect()
}

fn fan(lamp: &PhotometryAsset) -> Vec<(&'static str, PlaneCut)> {
    let (_, h, v) = lamp.peak();
    let across = lamp.horizontal_deg.iter().map(|angle| (*angle, lamp.candela_at(*angle, v))).collect();
    let up = lamp.vertical_deg.iter().map(|angle| (*angle, lamp.candela_at(h, *angle))).collect();
    vec![("horizontal", across), ("vertical", up)]
}

/// Section of a C plane and the opposite one: angles from the nadir, negative on the other side.
pub(super) fn plane(lamp: &PhotometryAsset, c: f64) -> PlaneCut {
    let far = lamp.vertical_deg.iter().rev().filter(|v| **v > 0.0).map(|v| (-v, lamp.candela_at(c + 180.0, *v)));
    far.chain(lamp.vertical_deg.iter().map(|v| (*v, lamp.candela_at(c, *v)))).collect()
}

/// Full width from the largest value to the first crossing of `share` of it on both sides.
fn width(cut: &[(f64, f64)], fraction: f64) -> f64 {
    let peak = (0..cut.len()).fold(0, |best, i| if cut[i].1 > cut[best].1 { i } else { best });
    let level = fraction * cut[peak].1;
    let up = edge(cut[peak..].iter().copied(), level);
    let down = edge(cut[..=peak].iter().rev().copied(), level);
    up - down
}

/// Position where a section first falls below a level.
fn edge(cut: impl Iterator<Item = (f64, f64)>, level: f64) -> f64 {
    let mut before = (0.0, f64::INFINITY);
    for (angle, value) in cut {
        if value < level {
            let fraction = (before.1 - level) / (before.1 - value);
            return before.0 + fraction * (angle - before.0);
        }
        before = (angle, value);
    }
    before.0
}

const PIXELS: usize = 512;
const WHITE: [u8; 3] = [255; 3];
const RED: [u8; 3] = [200, 30, 30];
const BLUE: [u8; 3] = [30, 60, 200];
const PALE: [u8; 3] = [215; 3];

/// Image of a lamp.
pub(super) fn draw(lamp: &PhotometryAsset) -> Preview {
    match lamp.axes {
        PhotometryAxes::C => polar(lamp),
        PhotometryAxes::A | PhotometryAxes::B => ahead(lamp),
    }
}

fn polar(lamp: &PhotometryAsset) -> Preview {
    let planes = [(plane(lamp, 90.0), BLUE), (plane(lamp, 0.0), RED)];
    let (peak, _, _) = lamp.peak();
    let half = PIXELS as f64 / 2.0;
    let at = |x: f64, y: f64| ((x * x + y * y).sqrt() / (0.95 * half), atan2(x, y).to_degrees());
    paint(PIXELS, |x, y| {
        let corners = [(0.0, 0.0), (1.5, 0.0), (0.0, 1.5), (1.5, 1.5)].map(|(dx, dy)| at(x - half + dx, y - half + dy));
        let curve = planes.iter().rev().find(|(cut, _)| {
            let inside = corners.map(|(radius, angle)| radius * peak <= value(cut, angle));
            inside.contains(&true) && inside.contains(&false)
        });
        curve.map_or_else(|| scale(corners), |(_, colour)| *colour)
    })
}

/// Rings at quarters and spokes every 30°.
fn scale(corners: [(f64, f64); 4]) -> [u8; 3] {
    let differ = |component: fn((f64, f64)) -> f64| {
        let of_corners = corners.map(component);
        of_corners.iter().any(|cell| *cell != of_corners[0])
    };
    let on_ring = differ(|(radius, _)| (4.0 * radius.min(1.01)).floor());
    let on_spoke = corners[0].0 < 1.0 && differ(|(_, angle)| (angle / 30.0).floor());
    if on_ring || on_spoke { PALE } else { WHITE }
}

/// Interpolated value of a section; 0 outside.
fn value(cut: &[(f64, f64)], angle: f64) -> f64 {
    let above = cut.partition_point(|(a, _)| *a < angle);
    match (above.checked_sub(1).map(|i| cut[i]), cut.get(above)) {
        (Some((a, low)), Some((b, high))) => low + (high - low) * (angle - a) / (b - a),
        (None, Some((a, first))) if *a == angle => *first,
        _ => 0.0,
    }
}

fn ahead(lamp: &PhotometryAsset) -> Preview {
    let (left, right) = (lamp.horizontal_deg[0], lamp.horizontal_deg[lamp.horizontal_deg.len() - 1]);
    let (down, up) = (lamp.vertical_deg[0], lamp.vertical_deg[lamp.vertical_deg.len() - 1]);
    let (peak, _, _) = lamp.peak();
    let step = (right - left) / (PIXELS - 1) as f64;
    let rows = (((up - down) / step) as usize + 1).clamp(16, 2 * PIXELS);
    let down_step = (up - down) / (rows - 1) as f64;
    let relative = |h: f64, v: f64| lamp.candela_at(h, v) / peak;
    let on = |angle: f64, line: f64, step: f64| (angle - line).abs() <= 0.5 * step;
    paint(rows, |x, y| {
        let (h, v) = (left + step * x, up - down_step * y);
        let here = relative(h, v);
        let next = [relative(h + step, v), relative(h, v - down_step)];
        let is_point =
            passing_beam::POINTS.iter().any(|p| on(h, p.right_deg, 3.0 * step) && on(v, p.up_deg, 3.0 * down_step));
        match () {
            () if is_point => RED,
            () if on(h, 0.0, step) || on(v, 0.0, down_step) => BLUE,
            () if next.iter().any(|n| line(*n) != line(here)) => WHITE,
            () => [brightness(here); 3],
        }
    })
}

/// Three decades down from the peak, darker than the lines.
fn brightness(relative: f64) -> u8 {
    let decades = if relative > 0.0 { log10(relative) } else { f64::NEG_INFINITY };
    (180.0 * (1.0 + decades / 3.0).clamp(0.0, 1.0)).round() as u8
}

/// Index of the contour interval of a fraction of the peak.
fn line(relative: f64) -> usize {
    const LINES: [f64; 9] = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5];
    LINES.partition_point(|line| *line <= relative)
}

fn paint(rows: usize, pixel: impl Fn(f64, f64) -> [u8; 3]) -> Preview {
    let row = |y: usize| (0..PIXELS).map(move |x| (x as f64, y as f64));
    Preview { width: PIXELS, height: rows, rgb: (0..rows).flat_map(row).map(|(x, y)| pixel(x, y)).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_is_as_wide_as_where_its_light_has_fallen() {
        let cut = [(-30.0, 0.0), (-10.0, 40.0), (0.0, 100.0), (5.0, 100.0), (15.0, 20.0), (25.0, 0.0)];
        // 50 %: from −8⅓ to 11¼; 10 %: from −25 to 20.
        assert!((width(&cut, 0.5) - (11.25 + 25.0 / 3.0)).abs() < 1e-12);
        assert!((width(&cut, 0.1) - 45.0).abs() < 1e-12);
        assert_eq!(width(&[(0.0, 5.0), (90.0, 5.0)], 0.5), 90.0, "to the end of the grid");
    }
}
