//! Predefined headlamps: a low beam with an asymmetric cut-off, a high beam.
//!
//! Both are grids of type A (the sphere with a vertical polar axis of the UN regulations; V up, H to the right, degrees) of candela, computed from
//! formulas and not measured on any lamp. The low beam for traffic on the right is
//!
//! I = s(V, H) + [1 + e^{(V − c(H))/w}]⁻¹ · (24 000 g(H − 1, 5 or 3.5) g(V + 1.2, 2) + 3 500 g(H, 20) g(V + 3, 5)) cd
//!
//! with g(x, σ) = e^{−x²/2σ²} (the narrower σ on the side of oncoming traffic). Its cut-off c lies 0.57° (1 %) below the horizon on the side of
//! oncoming traffic, rises by 15° from the middle, and ends 1° above the horizon. Its width w = 0.15° gives a sharpness G = lg I(V) − lg I(V + 0.1°)
//! of 0.2–0.3, between the 0.13 and 0.40 that UN R112 requires. Stray light s = 160 g(H, 15) g(V, 5) cd reaches signs above the road. For traffic on
//! the left all is mirrored. The high beam is 52 000 g(H, 3.5) g(V, 1.5) + 6 000 g(H, 12) g(V + 0.5, 3.5) cd.
//!
//! The low beam meets the test points of the passing beam of UN Regulation No. 149, class B (tested on rendered walls, with the one table of these
//! points, in `io::inspect::passing_beam`).

use etendue_core::maths;

use super::profile::{PhotometricAxes, PhotometricGrid};

/// The side of the road on which traffic drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Traffic {
    /// As on the European continent.
    Right,
    /// As in the United Kingdom or Japan.
    Left,
}

/// A low beam, cd.
#[must_use]
pub fn low_beam(traffic: Traffic) -> PhotometricGrid {
    grid(|v, h| low(v, mirrored(h, traffic)))
}

/// A high beam, cd.
#[must_use]
pub fn high_beam() -> PhotometricGrid {
    grid(|v, h| 52_000.0 * gaussian(h, 3.5) * gaussian(v, 1.5) + 6_000.0 * gaussian(h, 12.0) * gaussian(v + 0.5, 3.5))
}

fn mirrored(horizontal_deg: f64, traffic: Traffic) -> f64 {
    if traffic == Traffic::Left { -horizontal_deg } else { horizontal_deg }
}

/// Width of the cut-off, degrees.
const CUT_OFF_WIDTH_DEG: f64 = 0.15;

fn low(v: f64, h: f64) -> f64 {
    let above = (v - cut_off(h)) / CUT_OFF_WIDTH_DEG;
    let passed = 1.0 / (1.0 + maths::f64::exp(above.min(700.0)));
    let side = if h < 1.0 { 3.5 } else { 5.0 };
    let beam = 24_000.0 * gaussian(h - 1.0, side) * gaussian(v + 1.2, 2.0)
        + 3_500.0 * gaussian(h, 20.0) * gaussian(v + 3.0, 5.0);
    160.0 * gaussian(h, 15.0) * gaussian(v, 5.0) + passed * beam
}

/// Elevation of the cut-off above the horizon, degrees.
fn cut_off(h: f64) -> f64 {
    const SLOPE: f64 = 0.267_949_192_431_122_7;
    (SLOPE * h.max(0.0) - 0.57).min(1.0)
}

fn gaussian(x: f64, sigma: f64) -> f64 {
    maths::f64::exp(-0.5 * x * x / (sigma * sigma))
}

/// Angles from −`most` to `most`: steps of `fine` up to `near`, then of a sixth of the angle.
fn angles(fine: f64, near: f64, maximum: f64) -> Vec<f64> {
    let mut right: Vec<f64> = (0..=(near / fine).round() as u32).map(|i| f64::from(i) * fine).collect();
    while let Some(last) = right.last().copied().filter(|last| *last < maximum) {
        let next = last + (last / 6.0).max(fine);
        right.push(if next > maximum - 0.5 * fine { maximum } else { next });
    }
    right.iter().skip(1).rev().map(|a| -a).chain(right.iter().copied()).collect()
}

fn grid(candela: impl Fn(f64, f64) -> f64) -> PhotometricGrid {
    let (vertical, horizontal) = (angles(0.05, 2.0, 30.0), angles(0.2, 6.0, 75.0));
    let values = horizontal.iter().flat_map(|h| vertical.iter().map(|v| candela(*v, *h) as f32).collect::<Vec<_>>());
    let (rows, columns) = (vertical.iter().map(|v| *v as f32), horizontal.iter().map(|h| *h as f32));
    PhotometricGrid::new(PhotometricAxes::A, rows.collect(), columns.collect(), values.collect())
        .expect("increasing angles and finite values")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lights::profile::Profile;

    #[test]
    fn beams_are_as_strong_as_lamps_are() {
        for (lamp, peak, flux) in [
            (Profile::PhotometricGrid(low_beam(Traffic::Right)), 25e3..30e3, 700.0..1000.0),
            (Profile::PhotometricGrid(high_beam()), 50e3..70e3, 700.0..1100.0),
        ] {
            assert!(peak.contains(&lamp.peak()) && flux.contains(&lamp.flux_sr()), "{lamp:?}");
        }
    }

    #[test]
    fn the_cut_off_is_sharp_low_and_kinked() {
        let lamp = low_beam(Traffic::Right);
        let sharpest = |h: f32| {
            let at = |i: i32| -2.0 + 0.05 * i as f32;
            let g = |v: f32| (lamp.at_deg(v, h) / lamp.at_deg(v + 0.1, h)).max(1.0);
            (0..80).map(at).map(|v| (maths::f32::log10(g(v)), v)).fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
        };
        let (left, at_left) = sharpest(-2.5);
        let (_, at_right) = sharpest(3.0);
        assert!((0.13..=0.40).contains(&left), "G = {left}");
        // The fall is steepest a little above the middle of the cut-off; 3° to the right the kink has lifted it 0.8°.
        assert!((-0.6..0.0).contains(&at_left), "{at_left}");
        assert!((at_right - at_left - 0.8).abs() < 0.15, "{at_left} {at_right}");
    }
}
