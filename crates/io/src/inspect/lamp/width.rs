//! Beam and field angle: how wide a lamp is at 50 % and at 10 % of its greatest intensity (ANSI/IES LS-1; CIE 17).
//!
//! Types A and B: across the peak, horizontally and vertically. Type C: in the planes C0–C180 and C90–C270, from the
//! greatest intensity of the plane to both sides. Between points the intensity is linear; where a beam reaches the end
//! of its grid it ends there.

use etendue_scene::asset::{PhotometryAsset, PhotometryAxes};

/// Angles (degrees, rising) and intensities of a cut through a lamp.
type Cut = Vec<(f64, f64)>;

/// The cuts by name, each with its beam and field angle, degrees.
pub(super) fn of(lamp: &PhotometryAsset) -> Vec<(&'static str, [f64; 2])> {
    let cuts = match lamp.axes {
        PhotometryAxes::C => vec![("C0–C180", plane(lamp, 0.0)), ("C90–C270", plane(lamp, 90.0))],
        PhotometryAxes::A | PhotometryAxes::B => fan(lamp),
    };
    cuts.into_iter().map(|(name, cut)| (name, [0.5, 0.1].map(|share| width(&cut, share)))).collect()
}

fn fan(lamp: &PhotometryAsset) -> Vec<(&'static str, Cut)> {
    let (_, h, v) = lamp.peak();
    let across = lamp.horizontal_deg.iter().map(|angle| (*angle, lamp.candela_at(*angle, v))).collect();
    let up = lamp.vertical_deg.iter().map(|angle| (*angle, lamp.candela_at(h, *angle))).collect();
    vec![("horizontal", across), ("vertical", up)]
}

/// A plane and the one across: angles from the nadir, negative on the other side.
pub(super) fn plane(lamp: &PhotometryAsset, c: f64) -> Cut {
    let far = lamp.vertical_deg.iter().rev().filter(|v| **v > 0.0).map(|v| (-v, lamp.candela_at(c + 180.0, *v)));
    far.chain(lamp.vertical_deg.iter().map(|v| (*v, lamp.candela_at(c, *v)))).collect()
}

/// From the greatest value to both sides, as far as `share` of it is reached.
fn width(cut: &[(f64, f64)], share: f64) -> f64 {
    let peak = (0..cut.len()).fold(0, |best, i| if cut[i].1 > cut[best].1 { i } else { best });
    let level = share * cut[peak].1;
    let up = edge(cut[peak..].iter().copied(), level);
    let down = edge(cut[..=peak].iter().rev().copied(), level);
    up - down
}

/// Where a cut first falls below a level.
fn edge(cut: impl Iterator<Item = (f64, f64)>, level: f64) -> f64 {
    let mut before = (0.0, f64::INFINITY);
    for (angle, value) in cut {
        if value < level {
            let share = (before.1 - level) / (before.1 - value);
            return before.0 + share * (angle - before.0);
        }
        before = (angle, value);
    }
    before.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_beam_is_as_wide_as_where_its_light_has_fallen() {
        let cut = [(-30.0, 0.0), (-10.0, 40.0), (0.0, 100.0), (5.0, 100.0), (15.0, 20.0), (25.0, 0.0)];
        // 50: from −8⅓ to 11¼; 10: from −25 to 20.
        assert!((width(&cut, 0.5) - (11.25 + 25.0 / 3.0)).abs() < 1e-12);
        assert!((width(&cut, 0.1) - 45.0).abs() < 1e-12);
        assert_eq!(width(&[(0.0, 5.0), (90.0, 5.0)], 0.5), 90.0, "to the end of the grid");
    }
}
