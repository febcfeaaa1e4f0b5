//! Mechanical vignetting: the light from a pupil to a sensor point where apertures clip it. Ranges and the wavelength shared by several lenses.
//!
//! In the plane of the pupil (radius 1) the pupil and the projections of the apertures are discs whose centres lie on one line, the direction of the
//! sensor point. Along that line the integrand z²/d⁴ has a closed antiderivative. Across it, a Gauss–Legendre rule runs piecewise between the points
//! where the boundary changes from one circle to another, in a variable that removes the square roots at the ends.

use core::f64::consts::{FRAC_PI_2, PI};

use etendue_core::maths::f64::{atan, sin_cos};

use crate::{error::OpticsError, pupil::PupilView};

/// A disc of the plane of the unit pupil, centred on the line through the pupil's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Disc {
    pub(crate) centre: f64,
    pub(crate) radius: f64,
}

/// The pupil itself.
const PUPIL: Disc = Disc { centre: 0.0, radius: 1.0 };

impl Disc {
    /// True if part of the pupil lies outside this disc.
    pub(crate) fn clips_unit_disc(self) -> bool {
        self.centre.abs() + 1.0 > self.radius
    }

    /// Half the chord at height `t`; `None` if there is none.
    fn half_chord(self, t: f64) -> Option<f64> {
        let h2 = (self.radius - t) * (self.radius + t);
        (h2 >= 0.0).then(|| h2.sqrt())
    }
}

/// ∫ z²/d⁴ dA over the part of the pupil inside the apertures, sr, for a sensor point `sensor_radius_mm` from the axis.
pub(crate) fn clipped_etendue_sr(view: &PupilView, sensor_radius_mm: f64, discs: [Option<Disc>; 2]) -> f64 {
    over_half(discs, |t, low, high| strip_sr(view, sensor_radius_mm, t, low, high)) * 2.0
}

/// Position on the line of the area centroid of the part of the pupil inside the apertures; `None` if nothing is open.
pub(crate) fn open_centroid(discs: [Option<Disc>; 2]) -> Option<f64> {
    let area = over_half(discs, |_, low, high| high - low);
    let moment = over_half(discs, |_, low, high| 0.5 * (high - low) * (high + low));
    (area > 0.0).then(|| moment / area)
}

/// The integral over height of `strip(height, low, high)` over one half of the open region, which is symmetric about the
/// line.
fn over_half(discs: [Option<Disc>; 2], strip: impl Fn(f64, f64, f64) -> f64) -> f64 {
    let at = |t: f64| chord(discs, t).map_or(0.0, |(low, high)| strip(t, low, high));
    break_heights(discs).windows(2).map(|piece| integrate(&at, piece[0], piece[1])).sum()
}

/// The ends of the open region's chord at height `t`.
fn chord(apertures: [Option<Disc>; 2], t: f64) -> Option<(f64, f64)> {
    let discs = apertures.into_iter().flatten().chain([PUPIL]);
    let (low, high) = discs.into_iter().try_fold((f64::NEG_INFINITY, f64::INFINITY), |(low, high), disc| {
        let half = disc.half_chord(t)?;
        Some((low.max(disc.centre - half), high.min(disc.centre + half)))
    })?;
    (low < high).then_some((low, high))
}

/// The strip at height `t` from `low` to `high`, per unit of height: ∫ z² a² / (A² + (a s + X)²)² ds with
/// A² = z² + a² t², by ∫ dw/(A² + w²)² = w/(2A²(A² + w²)) + atan(w/A)/(2A³).
fn strip_sr(view: &PupilView, sensor_radius_mm: f64, t: f64, low: f64, high: f64) -> f64 {
    let (z, a) = (view.distance_mm, view.radius_mm);
    let across2 = z * z + a * a * t * t;
    let across = across2.sqrt();
    let primitive = |s: f64| {
        let w = a * s + sensor_radius_mm;
        (w / (across2 + w * w) + atan(w / across) / across) / (2.0 * across2)
    };
    z * z * a * (primitive(high) - primitive(low))
}

/// Heights, in order from 0 to the smallest radius, between which the boundary consists of the same circles.
fn break_heights(discs: [Option<Disc>; 2]) -> [f64; 5] {
    let [front, rear] = discs;
    let pair = |a: Option<Disc>, b: Option<Disc>| a.zip(b).and_then(|(a, b)| crossing_height(a, b)).unwrap_or(0.0);
    let minimum = [front, rear].into_iter().flatten().map(|d| d.radius).fold(1.0, f64::min);
    let crossings = [pair(front, Some(PUPIL)), pair(rear, Some(PUPIL)), pair(front, rear)];
    let [a, b, c] = crossings.map(|t| t.min(minimum));
    let mut heights = [0.0, a, b, c, minimum];
    heights.sort_by(f64::total_cmp);
    heights
}

/// The height at which two circles cross; `None` if they do not.
fn crossing_height(a: Disc, b: Disc) -> Option<f64> {
    let d = b.centre - a.centre;
    let s = (d * d + a.radius * a.radius - b.radius * b.radius) / (2.0 * d);
    let t2 = (a.radius - s) * (a.radius + s);
    (t2 > 0.0).then(|| t2.sqrt())
}

/// ∫ f dt from `low` to `high`, with t = centre + half · sin φ, which removes square roots at both ends.
fn integrate(f: &impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    if half <= 0.0 {
        return 0.0;
    }
    let at = |x: f64| {
        let (s, c) = sin_cos(FRAC_PI_2 * x);
        f(middle + half * s) * c
    };
    let sum: f64 = GAUSS.iter().map(|[x, w]| w * (at(*x) + at(-*x))).sum();
    sum * half * 0.5 * PI
}

/// Positive abscissae and weights of the Gauss–Legendre rule of 16 points on [−1, 1].
pub(crate) const GAUSS: [[f64; 2]; 8] = [
    [0.09501250983763744, 0.18945061045506864],
    [0.2816035507792589, 0.18260341504492364],
    [0.45801677765722737, 0.16915651939500265],
    [0.6178762444026438, 0.1495959888165767],
    [0.755404408355003, 0.12462897125553407],
    [0.8656312023878318, 0.0951585116824926],
    [0.9445750230732326, 0.062253523938647456],
    [0.9894009349916499, 0.027152459411754176],
];

/// Returns `value` if it is positive and finite.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, OpticsError> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(OpticsError::NotPositive { name, value }) }
}

/// Returns `value` if it is a possible f-number of a lens.
pub(crate) fn f_number(value: f64) -> Result<f64, OpticsError> {
    let value = positive("f_number", value)?;
    if value >= MIN_F_NUMBER { Ok(value) } else { Err(OpticsError::Faster { value }) }
}

/// The f-number at which axial light fills the whole half space: an aplanatic lens in air has 1/2N = sin θ′ ≤ 1 (Abbe).
const MIN_F_NUMBER: f64 = 0.5;

/// Returns `value` if it is finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<f64, OpticsError> {
    if value.is_finite() { Ok(value) } else { Err(OpticsError::NotFinite { name, value }) }
}

/// The wavelength of ground truth, and of first-order quantities if a lens file gives no other, nm: the helium d line.
pub const PRINCIPAL_NM: f64 = 587.56;

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    const VIEW: PupilView = PupilView { distance_mm: 3.0, radius_mm: 1.2 };

    /// The same integral by strips of equal height: slow, and without break points or substitution.
    fn by_strips(sensor_radius_mm: f64, discs: [Option<Disc>; 2]) -> f64 {
        let n = 200_000;
        let strips = (0..n).map(|i| {
            let t = 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
            let ends = discs
                .into_iter()
                .flatten()
                .chain([PUPIL])
                .map(|d| d.half_chord(t).map(|h| (d.centre - h, d.centre + h)));
            let chord = ends.reduce(|a, b| a.zip(b).map(|(a, b)| (a.0.max(b.0), a.1.min(b.1)))).flatten();
            chord.filter(|c| c.0 < c.1).map_or(0.0, |c| strip_sr(&VIEW, sensor_radius_mm, t, c.0, c.1))
        });
        strips.sum::<f64>() * 2.0 / f64::from(n)
    }

    #[test]
    fn an_aperture_around_the_pupil_leaves_the_closed_form() {
        for x in [0.0, 0.7, 2.5] {
            let exact = VIEW.projected_solid_angle_sr(DVec2::new(x, 0.0));
            for aperture in [
                Disc { centre: 0.0, radius: 1.0 },
                Disc { centre: 0.3, radius: 1.3 },
                Disc { centre: -2.0, radius: 9.0 },
            ] {
                // 16 Gauss points on an analytic integrand.
                assert!(
                    (clipped_etendue_sr(&VIEW, x, [Some(aperture), None]) / exact - 1.0).abs() < 1e-9,
                    "{aperture:?}"
                );
            }
        }
    }

    #[test]
    fn three_discs_have_the_strips_sum() {
        let disc = |centre, radius| Some(Disc { centre, radius });
        let cases = [
            [disc(0.4, 1.0), None],
            [disc(-0.8, 1.1), disc(0.5, 0.9)],
            [disc(-0.2, 0.9), disc(0.3, 0.6)],
            [disc(-0.7, 1.0), disc(0.7, 1.0)],
            [disc(0.9, 1.2), disc(0.5, 1.3)],
        ];
        for discs in cases {
            for x in [0.0, 1.7] {
                let (fast, slow) = (clipped_etendue_sr(&VIEW, x, discs), by_strips(x, discs));
                // The strips' midpoint rule at square-root ends: n^-1.5 = 1e-8.
                assert!((fast / slow - 1.0).abs() < 1e-7, "{discs:?} at {x}: {fast} against {slow}");
            }
        }
    }

    #[test]
    fn the_centroid_of_a_lens_shape_is_its_middle() {
        let middle = open_centroid([Some(Disc { centre: 0.8, radius: 1.0 }), None]).expect("open");
        assert!((middle - 0.4).abs() < 1e-12);
        assert_eq!(open_centroid([Some(Disc { centre: 2.1, radius: 1.0 }), None]), None);
        // A half disc, cut by a huge circle: 4/3π; the cut's sagitta is 1/(2·1e6).
        let half = open_centroid([Some(Disc { centre: 1e6, radius: 1e6 }), None]).expect("open");
        assert!((half - 4.0 / (3.0 * PI)).abs() < 1e-6);
    }

    #[test]
    fn discs_apart_let_nothing_through() {
        let apart = Some(Disc { centre: 2.5, radius: 1.0 });
        assert_eq!(clipped_etendue_sr(&VIEW, 1.0, [apart, None]), 0.0);
        let between = [Some(Disc { centre: 1.5, radius: 1.0 }), Some(Disc { centre: -1.5, radius: 1.0 })];
        assert_eq!(clipped_etendue_sr(&VIEW, 1.0, between), 0.0);
    }
}
