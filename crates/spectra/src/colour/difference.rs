//! The CIEDE2000 colour difference (CIE 142-2001; notation and test pairs of Sharma, Wu & Dalal 2005).

use super::Lab;
use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64 as maths;

/// CIEDE2000 difference of two colours, weights k_L = k_C = k_H = 1.
#[must_use]
pub fn ciede2000(first: Lab, second: Lab) -> f64 {
    let mean_chroma = (chroma(first) + chroma(second)) / 2.0;
    let stretch = 1.0 + 0.5 * (1.0 - seventh_share(mean_chroma));
    let (one, two) = (Polar::new(first, stretch), Polar::new(second, stretch));
    let mean = Polar {
        lightness: (one.lightness + two.lightness) / 2.0,
        chroma: (one.chroma + two.chroma) / 2.0,
        hue_rad: mean_hue_rad(one, two),
    };
    let lightness = (two.lightness - one.lightness) / lightness_weight(mean.lightness);
    let chroma = (two.chroma - one.chroma) / (1.0 + 0.045 * mean.chroma);
    let hue = hue_difference(one, two) / (1.0 + 0.015 * mean.chroma * hue_weight(mean.hue_rad));
    (lightness * lightness + chroma * chroma + hue * hue + rotation(mean) * chroma * hue).max(0.0).sqrt()
}

/// A colour by lightness, (stretched) chroma and hue angle.
#[derive(Clone, Copy)]
struct Polar {
    lightness: f64,
    chroma: f64,
    hue_rad: f64,
}

impl Polar {
    fn new(lab: Lab, stretch: f64) -> Self {
        let stretched = Lab { a: lab.a * stretch, ..lab };
        let angle = maths::atan2(stretched.b, stretched.a);
        Self { lightness: lab.l, chroma: chroma(stretched), hue_rad: if angle < 0.0 { angle + TAU } else { angle } }
    }
}

fn chroma(lab: Lab) -> f64 {
    (lab.a * lab.a + lab.b * lab.b).sqrt()
}

/// √(C⁷ / (C⁷ + 25⁷)).
fn seventh_share(chroma: f64) -> f64 {
    let seventh = maths::pow(chroma / 25.0, 7.0);
    (seventh / (seventh + 1.0)).sqrt()
}

/// The signed hue difference as a length: 2 √(C₁ C₂) sin(Δh/2).
fn hue_difference(one: Polar, two: Polar) -> f64 {
    let turn = two.hue_rad - one.hue_rad;
    let turn = if turn > PI {
        turn - TAU
    } else if turn < -PI {
        turn + TAU
    } else {
        turn
    };
    2.0 * (one.chroma * two.chroma).sqrt() * maths::sin(turn / 2.0)
}

/// The mean hue by the shorter way round; the sum where one colour has no hue.
fn mean_hue_rad(one: Polar, two: Polar) -> f64 {
    let sum = one.hue_rad + two.hue_rad;
    if one.chroma * two.chroma == 0.0 {
        sum
    } else if (one.hue_rad - two.hue_rad).abs() <= PI {
        sum / 2.0
    } else if sum < TAU {
        (sum + TAU) / 2.0
    } else {
        (sum - TAU) / 2.0
    }
}

fn lightness_weight(lightness: f64) -> f64 {
    let offset = (lightness - 50.0) * (lightness - 50.0);
    1.0 + 0.015 * offset / (20.0 + offset).sqrt()
}

fn hue_weight(hue_rad: f64) -> f64 {
    let wave = |order: f64, phase_deg: f64| maths::cos(order * hue_rad + phase_deg.to_radians());
    1.0 - 0.17 * wave(1.0, -30.0) + 0.24 * wave(2.0, 0.0) + 0.32 * wave(3.0, 6.0) - 0.20 * wave(4.0, -63.0)
}

/// The rotation term of the blue region.
fn rotation(mean: Polar) -> f64 {
    let offset = (mean.hue_rad.to_degrees() - 275.0) / 25.0;
    let turn_deg = 30.0 * maths::exp(-offset * offset);
    -maths::sin((2.0 * turn_deg).to_radians()) * 2.0 * seventh_share(mean.chroma)
}
