//! Vectors as colours: x, y and z are red, green and blue, 0 is grey of half the range, the scale is full.

use super::percentile::percentile;

/// The picture of vectors, and the component at full red, green or blue: 1 for unit vectors, else the 99th percentile of the components'
/// sizes.
pub(in crate::inspect) fn of_vectors(components: [&[f32]; 3], is_unit: bool) -> (Vec<[u8; 3]>, f32) {
    let [x, y, z] = components;
    let sizes = components.into_iter().flatten().map(|v| v.abs());
    let scale = if is_unit { 1.0 } else { percentile(sizes, 99).filter(|s| *s > 0.0).unwrap_or(1.0) };
    let byte = |v: f32| (127.5 + 127.5 * (v / scale).clamp(-1.0, 1.0)).round() as u8;
    let colour = |v: [f32; 3]| if v.iter().any(|c| c.is_nan()) { [255, 0, 255] } else { v.map(byte) };
    (x.iter().zip(y).zip(z).map(|((x, y), z)| colour([*x, *y, *z])).collect(), scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_red_green_and_blue() {
        let (rgb, scale) = of_vectors([&[1.0, 0.0, f32::NAN], &[0.0, -1.0, 0.0], &[0.0, 0.0, 1.0]], true);
        assert_eq!((rgb, scale), (vec![[255, 128, 128], [128, 0, 128], [255, 0, 255]], 1.0));
        let (rgb, scale) = of_vectors([&[2.0, -4.0], &[4.0, 0.0], &[4.0, 4.0]], false);
        assert_eq!((rgb[0], scale), ([191, 255, 255], 4.0));
        assert_eq!(of_vectors([&[0.0], &[0.0], &[0.0]], false).1, 1.0);
    }
}
