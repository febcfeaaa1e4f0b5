//! Colour images of planes other than light: flow, identities, lengths, vectors, boxes.
//!
//! | plane | drawn as |
//! | --- | --- |
//! | optical flow, image velocity | colour wheel of Baker et al. 2011 ([`flow_wheel`]): hue by direction, saturation by length; black: not known |
//! | identities | a colour each, the same in every file ([`identity_colour`]); black: 0, the background |
//! | depth, distance, disparity | viridis ([`VIRIDIS`]) by the logarithm of lengths, evenly for disparity; white: infinite, magenta: NaN |
//! | vectors | x, y and z as red, green and blue about grey; magenta: NaN |
//! | boxes | outlines in the objects' identity colours ([`draw_boxes`]) |
//!
//! Vectors of the image as colours: the wheel of Baker et al. 2011, "A database and evaluation methodology for optical flow" (IJCV 92), as in their program
//! colorcode.cpp. Hue is the direction (right red, down yellow, left cyan, up violet), white is no motion, full saturation is the length of the scale; longer
//! vectors are darker. Unknown vectors are black.
//!
//! Every identity has a colour: the same one in every file, and far from those of neighbouring numbers.
//!
//! Hues advance by the golden ratio of a turn, which distributes any run of numbers evenly (Knuth, The Art of Computer Programming 3, 6.4), with three
//! alternating lightnesses, at one chroma of Oklab (Ottosson 2020, "A perceptual color space for image processing").
//!
//! Vectors as colours: x, y and z are red, green and blue, 0 is grey at half the range, the scale is the full range.
//!
//! Lengths and disparities as colours: viridis (Smith, van der Walt 2015; in the public domain), whose lightness increases uniformly, also for people with
//! colour-blindness. Seventeen of its colours, linearly interpolated.

use etendue_core::maths::f64::{atan2, ln, sin_cos};
use etendue_spectra::colour::encode;
use serde::Deserialize;

use super::Preview;

/// Steps from each of six colours to the next; the channel of red, green and blue that changes, and its direction.
const SPANS: [(usize, [i32; 3], usize, i32); 6] = [
    (15, [255, 0, 0], 1, 255),
    (6, [255, 255, 0], 0, -255),
    (4, [0, 255, 0], 2, 255),
    (11, [0, 255, 255], 1, -255),
    (13, [0, 0, 255], 0, 255),
    (6, [255, 0, 255], 2, -255),
];

/// Image of vectors given by components, and the length of full saturation: the 99th percentile of the known ones.
pub(super) fn draw_flow(u: &[f32], v: &[f32]) -> (Vec<[u8; 3]>, f32) {
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

/// The 55 colours of the wheel, sRGB bytes: from red (a vector to the right) over yellow (down) and cyan (left) to violet (up).
#[must_use]
pub fn flow_wheel() -> Vec<[u8; 3]> {
    let step = |(steps, from, channel, change): (usize, [i32; 3], usize, i32)| {
        (0..steps).map(move |i| {
            let mut colour = from;
            colour[channel] += change.signum() * (change.abs() * i as i32 / steps as i32);
            colour.map(|c| c as u8)
        })
    };
    SPANS.into_iter().flat_map(step).collect()
}

/// Colour of a vector whose full-scale length is 1.
fn colour(wheel: &[[f64; 3]], u: f64, v: f64) -> [u8; 3] {
    let length = (u * u + v * v).sqrt();
    if !length.is_finite() {
        return [0; 3];
    }
    // A vector to the right has the angles π and −π; the latter is used, as the wheel begins there.
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

/// (√5 − 1)/2.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
const LIGHTNESS: [f64; 3] = [0.72, 0.56, 0.86];
const CHROMA: f64 = 0.13;

/// Image of identities.
pub(super) fn draw_identities(ids: &[u32]) -> Vec<[u8; 3]> {
    ids.iter().map(|id| identity_colour(*id)).collect()
}

/// The colour of an identity, sRGB bytes; black for 0, the background.
#[must_use]
pub fn identity_colour(id: u32) -> [u8; 3] {
    if id == 0 {
        return [0; 3];
    }
    let turns = f64::from(id) * GOLDEN;
    let (sin, cos) = sin_cos((turns - turns.floor()) * core::f64::consts::TAU);
    let lightness = LIGHTNESS[id as usize % LIGHTNESS.len()];
    let linear = linear_of_oklab(lightness, CHROMA * cos, CHROMA * sin);
    linear.map(|v| (encode(v.clamp(0.0, 1.0) as f32) * 255.0).round() as u8)
}

/// Linear sRGB of Oklab.
fn linear_of_oklab(lightness: f64, a: f64, b: f64) -> [f64; 3] {
    let cubed = |root: f64| root * root * root;
    let l = cubed(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let m = cubed(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let s = cubed(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

/// Image of vectors, and the component at full red, green or blue: 1 for unit vectors, else the 99th percentile of the components' magnitudes.
pub(super) fn draw_vectors(components: [&[f32]; 3], is_unit: bool) -> (Vec<[u8; 3]>, f32) {
    let [x, y, z] = components;
    let sizes = components.into_iter().flatten().map(|v| v.abs());
    let scale = if is_unit { 1.0 } else { percentile(sizes, 99).filter(|s| *s > 0.0).unwrap_or(1.0) };
    let byte = |v: f32| (127.5 + 127.5 * (v / scale).clamp(-1.0, 1.0)).round() as u8;
    let colour = |v: [f32; 3]| if v.iter().any(|c| c.is_nan()) { [255, 0, 255] } else { v.map(byte) };
    (x.iter().zip(y).zip(z).map(|((x, y), z)| colour([*x, *y, *z])).collect(), scale)
}

/// Seventeen colours of viridis at equal steps, sRGB bytes.
pub const VIRIDIS: [[u8; 3]; 17] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x18, 0x6a],
    [0x47, 0x2d, 0x7b],
    [0x42, 0x40, 0x86],
    [0x3b, 0x52, 0x8b],
    [0x33, 0x63, 0x8d],
    [0x2c, 0x72, 0x8e],
    [0x26, 0x82, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x1f, 0xa0, 0x88],
    [0x28, 0xae, 0x80],
    [0x3f, 0xbc, 0x73],
    [0x5e, 0xc9, 0x62],
    [0x84, 0xd4, 0x4b],
    [0xad, 0xdc, 0x30],
    [0xd8, 0xe2, 0x19],
    [0xfd, 0xe7, 0x25],
];

/// Image, and the values at the ends of the map.
type ScaledImage = (Vec<[u8; 3]>, [f32; 2]);

/// Image of lengths by their logarithm, near yellow and far violet; and the values at the ends of the map: the 1st and 99th percentile of those above 0.
pub(super) fn draw_lengths(lengths: &[f32]) -> ScaledImage {
    let lit = || lengths.iter().copied().filter(|v| *v > 0.0);
    let [near, far] = [1, 99].map(|percent| percentile(lit(), percent).unwrap_or(1.0));
    let [low, high] = [near, far].map(|v| ln(f64::from(v)));
    let part = |v: f32| if v > 0.0 { 1.0 - fraction(ln(f64::from(v)), low, high) } else { 1.0 };
    (lengths.iter().map(|v| viridis_colour(*v, part)).collect(), [near, far])
}

/// Image of numbers, small violet and large yellow; and the values at the ends: the 1st and 99th percentile.
pub(super) fn draw_differences(values: &[f32]) -> ScaledImage {
    let [low, high] = [1, 99].map(|percent| percentile(values.iter().copied(), percent).unwrap_or(1.0));
    let part = |v: f32| fraction(f64::from(v), f64::from(low), f64::from(high));
    (values.iter().map(|v| viridis_colour(*v, part)).collect(), [low, high])
}

fn fraction(value: f64, low: f64, high: f64) -> f64 {
    if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
}

/// White for infinite values, magenta for NaN.
fn viridis_colour(value: f32, part: impl Fn(f32) -> f64) -> [u8; 3] {
    match value {
        v if v.is_nan() => [255, 0, 255],
        v if v.is_infinite() => [255; 3],
        v => between(part(v)),
    }
}

fn between(part: f64) -> [u8; 3] {
    let place = part * (VIRIDIS.len() - 1) as f64;
    let low = (place as usize).min(VIRIDIS.len() - 2);
    let (from, to) = (VIRIDIS[low], VIRIDIS[low + 1]);
    core::array::from_fn(|i| {
        let (from, to) = (f64::from(from[i]), f64::from(to[i]));
        (from + (to - from) * (place - low as f64)).round() as u8
    })
}

/// Smallest value that is not below `percent` of the finite values; `None` if no value is finite.
fn percentile(values: impl Iterator<Item = f32>, percent: usize) -> Option<f32> {
    let mut finite: Vec<f32> = values.filter(|v| v.is_finite()).collect();
    let rank = finite.len().checked_sub(1)? * percent / 100;
    Some(*finite.select_nth_unstable_by(rank, f32::total_cmp).1)
}

/// One object as read. Boxes are left, top, right, bottom in raster coordinates, px.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct ObjectBox {
    /// Identity.
    pub id: u32,
    /// Name; `None` if the scene gives none.
    #[serde(default)]
    pub name: Option<String>,
    /// Class; `None` if it has none.
    #[serde(default)]
    pub class: Option<String>,
    /// Box about its visible pixels; `None` if none is visible.
    pub visible_box_px: Option<[f64; 4]>,
    /// Box about its whole projection, also outside the image.
    pub amodal_box_px: Option<[f64; 4]>,
    /// Visible pixels over those of the object alone; `None` if unknown.
    #[serde(default)]
    pub visible_fraction: Option<f64>,
}

/// Pitch of the dots of a dotted line, px.
const DOT_PITCH: usize = 4;

/// Draws the boxes of visible objects.
pub(super) fn draw_boxes(preview: &mut Preview, objects: &[ObjectBox]) {
    for object in objects.iter().filter(|object| object.visible_box_px.is_some()) {
        let colour = identity_colour(object.id);
        if let Some(edges) = object.amodal_box_px {
            outline(preview, edges, colour, DOT_PITCH);
        }
        if let Some(edges) = object.visible_box_px {
            outline(preview, edges, colour, 1);
        }
    }
}

/// Draws the outermost pixels within `left, top, right, bottom` (raster coordinates of the edges), clipped to the image.
fn outline(preview: &mut Preview, edges: [f64; 4], colour: [u8; 3], pitch: usize) {
    let (width, height) = (preview.width as f64, preview.height as f64);
    let [left, top, right, bottom] = edges;
    if !(left < right && top < bottom) {
        return;
    }
    // From the pixel in which an edge begins to the last one before the opposite edge.
    let (first, last) = ([left.floor(), top.floor()], [right.ceil() - 1.0, bottom.ceil() - 1.0]);
    let inside = |from: f64, to: f64, size: f64| {
        let (from, to) = (from.max(0.0), to.min(size - 1.0));
        if from <= to { (from as usize)..(to as usize + 1) } else { 0..0 }
    };
    for y in [first[1], last[1]].into_iter().filter(|y| (0.0..height).contains(y)) {
        inside(first[0], last[0], width).step_by(pitch).for_each(|x| set(preview, x, y as usize, colour));
    }
    for x in [first[0], last[0]].into_iter().filter(|x| (0.0..width).contains(x)) {
        inside(first[1], last[1], height).step_by(pitch).for_each(|y| set(preview, x as usize, y, colour));
    }
}

fn set(preview: &mut Preview, x: usize, y: usize, colour: [u8; 3]) {
    preview.rgb[y * preview.width + x] = colour;
}

#[cfg(test)]
mod tests {
    use etendue_spectra::colour::{Lab, ciede2000, decode_byte, lab, xyz_from_linear_srgb};

    use super::*;

    #[test]
    fn the_wheel_is_that_of_the_paper() {
        let wheel = wheel();
        assert_eq!(wheel.len(), 55);
        let at = |i: usize| wheel[i].map(|c| (c * 255.0).round() as u8);
        assert_eq!([at(0), at(15), at(21)], [[255, 0, 0], [255, 255, 0], [0, 255, 0]]);
        assert_eq!([at(25), at(36), at(49)], [[0, 255, 255], [0, 0, 255], [255, 0, 255]]);
        // 255 · 7 / 15 = 119 in integers, as in their program.
        assert_eq!(at(7), [255, 119, 0]);
    }

    #[test]
    fn directions_and_lengths_have_their_colours() {
        let wheel = wheel();
        assert_eq!(colour(&wheel, 1.0, 0.0), [255, 0, 0]);
        // A quarter turn is position 13.5 of 54, between 13/15 and 14/15 of the way from red to yellow: (221 + 238) / 2 = 229.5.
        assert_eq!(colour(&wheel, 0.0, 1.0), [255, 229, 0]);
        // Half a turn is position 27: two steps of eleven from cyan to blue, 255 − 46.
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
        let (rgb, scale) = draw_flow(&u, &[0.0; 100]);
        assert_eq!((scale, rgb[0], rgb[7], rgb[8]), (2.0, [255, 0, 0], [191, 0, 0], [0; 3]));
        assert_eq!(draw_flow(&[0.0; 4], &[0.0; 4]).1, 1.0);
    }

    fn perceived(id: u32) -> Lab {
        let linear = identity_colour(id).map(|byte| f64::from(decode_byte(byte)));
        lab(xyz_from_linear_srgb(linear), xyz_from_linear_srgb([1.0; 3]))
    }

    #[test]
    fn oklab_has_its_white_and_its_published_red() {
        let white = linear_of_oklab(1.0, 0.0, 0.0);
        assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-6), "{white:?}");
        // sRGB red is L 0.628, a 0.225, b 0.126 (Ottosson 2020, to three digits).
        let red = linear_of_oklab(0.628, 0.225, 0.126);
        assert!((red[0] - 1.0).abs() < 5e-3 && red[1].abs() < 5e-3 && red[2].abs() < 5e-3, "{red:?}");
    }

    #[test]
    fn twelve_successive_identities_are_distinct_and_none_is_black() {
        for first in [1, 2, 40, 1_000, 65_530, 4_000_000_000] {
            for (i, j) in (0..12).flat_map(|i| (0..i).map(move |j| (i, j))) {
                let difference = ciede2000(perceived(first + i), perceived(first + j));
                assert!(difference > 7.0, "{} and {}: {difference}", first + i, first + j);
            }
            assert!(ciede2000(perceived(first), perceived(0)) > 30.0);
        }
        assert_eq!(draw_identities(&[0, 7, 7]), [[0; 3], identity_colour(7), identity_colour(7)]);
    }

    #[test]
    fn axes_are_red_green_and_blue() {
        let (rgb, scale) = draw_vectors([&[1.0, 0.0, f32::NAN], &[0.0, -1.0, 0.0], &[0.0, 0.0, 1.0]], true);
        assert_eq!((rgb, scale), (vec![[255, 128, 128], [128, 0, 128], [255, 0, 255]], 1.0));
        let (rgb, scale) = draw_vectors([&[2.0, -4.0], &[4.0, 0.0], &[4.0, 4.0]], false);
        assert_eq!((rgb[0], scale), ([191, 255, 255], 4.0));
        assert_eq!(draw_vectors([&[0.0], &[0.0], &[0.0]], false).1, 1.0);
    }

    #[test]
    fn lightness_grows_evenly_along_the_map() {
        let lightness = |part: f64| {
            let linear = between(part).map(|byte| f64::from(decode_byte(byte)));
            lab(xyz_from_linear_srgb(linear), xyz_from_linear_srgb([1.0; 3])).l
        };
        let (first, last) = (lightness(0.0), lightness(1.0));
        // Viridis is uniform in CAM02-UCS, whose lightness is not quite CIE L*.
        for i in 0..=64 {
            let part = f64::from(i) / 64.0;
            let even = first + (last - first) * part;
            assert!((lightness(part) - even).abs() < 3.0, "{part}: {} for {even}", lightness(part));
        }
    }

    #[test]
    fn lengths_go_by_ratios_and_what_is_not_finite_is_marked() {
        let lengths = [1.0, 10.0, 100.0, f32::INFINITY, f32::NAN, 0.0, -3.0];
        let (rgb, range) = draw_lengths(&lengths);
        // The 99th percentile of three values is the second: ranks are whole.
        assert_eq!(range, [1.0, 10.0]);
        assert_eq!(rgb[..2], [VIRIDIS[16], VIRIDIS[0]]);
        assert_eq!(rgb[2..5], [VIRIDIS[0], [255; 3], [255, 0, 255]]);
        assert_eq!(rgb[5..], [VIRIDIS[16]; 2]);
        let many: Vec<f32> = (0..=200).map(|i| [1.0, 2.0, 4.0][i % 3]).collect();
        assert_eq!(draw_lengths(&many).0[1], VIRIDIS[8], "2 is half-way from 1 to 4");
        assert_eq!(draw_differences(&[5.0; 4]).0, [VIRIDIS[8]; 4]);
        assert!(draw_lengths(&[f32::NAN]).0 == [[255, 0, 255]]);
    }

    fn drawn(edges: [f64; 4]) -> Vec<usize> {
        let mut preview = Preview { width: 8, height: 6, rgb: vec![[0; 3]; 48] };
        outline(&mut preview, edges, [9; 3], 1);
        (0..48).filter(|i| preview.rgb[*i] == [9; 3]).collect()
    }

    #[test]
    fn a_box_is_drawn_on_its_outermost_pixels() {
        assert_eq!(drawn([2.0, 1.0, 5.0, 4.0]), [10, 11, 12, 18, 20, 26, 27, 28]);
        assert_eq!(drawn([3.0, 3.0, 4.0, 4.0]), [27]);
        assert_eq!(drawn([2.3, 1.9, 4.1, 3.5]), drawn([2.0, 1.0, 5.0, 4.0]));
    }

    #[test]
    fn what_lies_outside_is_left_out() {
        // The right and lower edge only.
        assert_eq!(drawn([-5.0, -5.0, 3.0, 2.0]), [2, 8, 9, 10]);
        assert_eq!(drawn([-5.0, -5.0, 30.0, 20.0]), [0; 0]);
        assert_eq!(drawn([20.0, 20.0, 30.0, 30.0]), [0; 0]);
        assert_eq!(drawn([-9.0, 1.0, -2.0, 3.0]), [0; 0]);
        assert_eq!(drawn([f64::NAN, 0.0, 1.0, 1.0]), [0; 0]);
    }
}
