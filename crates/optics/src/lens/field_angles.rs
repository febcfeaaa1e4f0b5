//! Field angles of chief rays at equal steps of the distance from the axis, interpolated.

use etendue_core::maths::f64::sin_cos;
use glam::{DVec2, DVec3};

/// Field angles (rad) at radii 0, step, 2 step, … mm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FieldAngles {
    pub(crate) step_mm: f64,
    pub(crate) angles: Vec<f64>,
}

impl FieldAngles {
    pub(crate) fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        let radius_mm = sensor_mm.length();
        let (sin, cos) = sin_cos(self.angle(radius_mm)?);
        let outwards = if radius_mm > 0.0 { sensor_mm / radius_mm } else { DVec2::ZERO };
        Some((outwards * sin).extend(cos))
    }

    /// The field angle of a radius; `None` beyond the table, which ends with the picture or the lens.
    fn angle(&self, radius_mm: f64) -> Option<f64> {
        let place = radius_mm / self.step_mm;
        let last = self.angles.len().checked_sub(2)?;
        if place > (last + 1) as f64 {
            return None;
        }
        let i = (place as usize).min(last);
        Some(cubic(self.around(i), place - i as f64))
    }

    /// Four angles about the interval `i`: odd about the axis, straight on beyond the end.
    fn around(&self, i: usize) -> [f64; 4] {
        let a = &self.angles;
        let before = if i == 0 { -a[1] } else { a[i - 1] };
        let after = a.get(i + 2).copied().unwrap_or(2.0 * a[i + 1] - a[i]);
        [before, a[i], a[i + 1], after]
    }
}

/// The cubic from `b` (t = 0) to `c` (t = 1) with the slopes of the neighbours' chords.
fn cubic([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    let (start, end) = (0.5 * (c - a), 0.5 * (d - b));
    let rest = c - b;
    b + t * (start + t * (3.0 * rest - 2.0 * start - end + t * (start + end - 2.0 * rest)))
}
