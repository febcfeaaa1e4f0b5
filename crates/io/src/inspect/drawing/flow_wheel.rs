//! Vectors of the image as colours: the wheel of Baker et al. 2011, "A database and evaluation methodology for optical flow" (IJCV 92), as
//! their program colorcode.cpp has it. Hue is the direction (right red, down yellow, left cyan, up violet), white is no motion, full
//! saturation is the length of the scale; longer vectors are darker. What is not known is black.

use super::percentile::percentile;
use etendue_core::maths::f64::atan2;

/// Steps from each of six colours to the next, and which of red, green and blue goes up (or down) on the way.
const SPANS: [(usize, [i32; 3], usize, i32); 6] = [
    (15, [255, 0, 0], 1, 255),
    (6, [255, 255, 0], 0, -255),
    (4, [0, 255, 0], 2, 255),
    (11, [0, 255, 255], 1, -255),
    (13, [0, 0, 255], 0, 255),
    (6, [255, 0, 255], 2, -255),
];

/// The picture of vectors given by their components, and the length of full saturation: the 99th percentile of the known ones.
pub(in crate::inspect) fn of_flow(u: &[f32], v: &[f32]) -> (Vec<[u8; 3]>, f32) {
    let lengths = u.iter().zip(v).map(|(u, v)| length(*u, *v));
    let scale = percentile(lengths, 99).filter(|scale| *scale > 0.0).unwrap_or(1.0);
    let wheel = wheel();
    let colour = |(u, v): (&f32, &f32)| colour(&wheel, f64::from(*u / scale), f64::from(*v / scale));
    (u.iter().zip(v).map(colour).collect(), scale)
}

fn length(u: f32, v: f32) -> f32 {
    (u * u + v * v).sqrt()
}

fn wheel() -> Vec<[f64; 3]> {
    flow_wheel().into_iter().map(|colour| colour.map(|c| f64::from(c) / 255.0)).collect()
}

/// The 55 colours of the wheel, sRGB bytes: from red (a vector to the right) by yellow (down), cyan (left) and violet (up).
#[must_use]
pub fn flow_wheel() -> Vec<[u8; 3]> {
    let step = |(steps, from, channel, way): (usize, [i32; 3], usize, i32)| {
        (0..steps).map(move |i| {
            let mut colour = from;
            colour[channel] += way.signum() * (way.abs() * i as i32 / steps as i32);
            colour.map(|c| c as u8)
        })
    };
    SPANS.into_iter().flat_map(step).collect()
}

/// The colour of a vector whose full length is 1.
fn colour(wheel: &[[f64; 3]], u: f64, v: f64) -> [u8; 3] {
    let length = (u * u + v * v).sqrt();
    if !length.is_finite() {
        return [0; 3];
    }
    // Of the two angles of a vector to the right, π and −π, the latter: the wheel begins there.
    let opposite = if v == 0.0 && u > 0.0 { -core::f64::consts::PI } else { atan2(-v, -u) };
    let place = (opposite / core::f64::consts::PI + 1.0) / 2.0 * (wheel.len() - 1) as f64;
    let low = place.floor();
    let (from, to) = (wheel[low as usize], wheel[(low as usize + 1) % wheel.len()]);
    core::array::from_fn(|i| {
        let hue = from[i] + (to[i] - from[i]) * (place - low);
        let shown = if length <= 1.0 { 1.0 - length * (1.0 - hue) } else { 0.75 * hue };
        (255.0 * shown) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wheel_is_that_of_the_paper() {
        let wheel = wheel();
        assert_eq!(wheel.len(), 55);
        let at = |i: usize| wheel[i].map(|c| (c * 255.0).round() as u8);
        assert_eq!([at(0), at(15), at(21)], [[255, 0, 0], [255, 255, 0], [0, 255, 0]]);
        assert_eq!([at(25), at(36), at(49)], [[0, 255, 255], [0, 0, 255], [255, 0, 255]]);
        // 255 · 7 / 15 = 119 in whole numbers, as in their program.
        assert_eq!(at(7), [255, 119, 0]);
    }

    #[test]
    fn directions_and_lengths_have_their_colours() {
        let wheel = wheel();
        assert_eq!(colour(&wheel, 1.0, 0.0), [255, 0, 0]);
        // A quarter turn on is place 13.5 of 54, between 13/15 and 14/15 of the way from red to yellow: (221 + 238) / 2 = 229.5.
        assert_eq!(colour(&wheel, 0.0, 1.0), [255, 229, 0]);
        // Half a turn is place 27: two steps of eleven from cyan to blue, 255 − 46.
        assert_eq!(colour(&wheel, -1.0, 0.0), [0, 209, 255]);
        assert_eq!(colour(&wheel, 0.5, 0.0), [255, 127, 127]);
        assert_eq!(colour(&wheel, 2.0, 0.0), [191, 0, 0]);
        assert_eq!(colour(&wheel, 0.0, 0.0), [255; 3]);
        assert_eq!([colour(&wheel, f64::NAN, 0.0), colour(&wheel, f64::INFINITY, 0.0)], [[0; 3]; 2]);
    }

    #[test]
    fn the_longest_of_a_hundred_does_not_set_the_scale() {
        let mut u = vec![2.0_f32; 100];
        u[7] = 1e6;
        u[8] = f32::NAN;
        let (rgb, scale) = of_flow(&u, &[0.0; 100]);
        assert_eq!((scale, rgb[0], rgb[7], rgb[8]), (2.0, [255, 0, 0], [191, 0, 0], [0; 3]));
        assert_eq!(of_flow(&[0.0; 4], &[0.0; 4]).1, 1.0);
    }
}
