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

#[cfg(test)]
mod tests {
    use super::*;

    type Pair = ([f64; 3], [f64; 3], f64);

    /// Table 1 of Sharma, Wu & Dalal 2005: pairs of colours and their differences, as printed.
    const PUBLISHED: [Pair; 34] = [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485], 2.8615),
        ([50.0, 2.8361, -74.02], [50.0, 0.0, -82.7485], 3.4412),
        ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0),
        ([50.0, -1.1848, -84.8006], [50.0, 0.0, -82.7485], 1.0),
        ([50.0, -0.9009, -85.5211], [50.0, 0.0, -82.7485], 1.0),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, -1.0, 2.0], [50.0, 0.0, 0.0], 2.3669),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009], 7.1792),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.001], 7.1792),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0011], 7.2195),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0012], 7.2195),
        ([50.0, -0.001, 2.49], [50.0, 0.0009, -2.49], 4.8045),
        ([50.0, -0.001, 2.49], [50.0, 0.001, -2.49], 4.8045),
        ([50.0, -0.001, 2.49], [50.0, 0.0011, -2.49], 4.7461),
        ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([50.0, 2.5, 0.0], [61.0, -5.0, 29.0], 22.8977),
        ([50.0, 2.5, 0.0], [56.0, -27.0, -3.0], 31.903),
        ([50.0, 2.5, 0.0], [58.0, 24.0, 15.0], 19.4535),
        ([50.0, 2.5, 0.0], [50.0, 3.1736, 0.5854], 1.0),
        ([50.0, 2.5, 0.0], [50.0, 3.2972, 0.0], 1.0),
        ([50.0, 2.5, 0.0], [50.0, 1.8634, 0.5757], 1.0),
        ([50.0, 2.5, 0.0], [50.0, 3.2592, 0.335], 1.0),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ([63.0109, -31.0961, -5.8663], [62.8187, -29.7946, -4.0864], 1.263),
        ([61.2901, 3.7196, -5.3901], [61.4292, 2.248, -4.962], 1.8731),
        ([35.0831, -44.1164, 3.7933], [35.0232, -40.0716, 1.5901], 1.8645),
        ([22.7233, 20.0904, -46.694], [23.0331, 14.973, -42.5619], 2.0373),
        ([36.4612, 47.858, 18.3852], [36.2715, 50.5065, 21.2231], 1.4146),
        ([90.8027, -2.0831, 1.441], [91.1528, -1.6435, 0.0447], 1.4441),
        ([90.9257, -0.5406, -0.9208], [88.6381, -0.8985, -0.7239], 1.5381),
        ([6.7747, -0.2908, -2.4247], [5.8714, -0.0985, -2.2286], 0.6377),
        ([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514], 0.9082),
    ];

    #[test]
    fn the_published_pairs_have_their_published_differences() {
        for ([l, a, b], [l2, a2, b2], difference) in PUBLISHED {
            let (one, two) = (Lab { l, a, b }, Lab { l: l2, a: a2, b: b2 });
            for found in [ciede2000(one, two), ciede2000(two, one)] {
                // Printed to four decimals.
                assert!((found - difference).abs() < 5.1e-5, "{one:?} {two:?}: {found} for {difference}");
            }
        }
    }
}
