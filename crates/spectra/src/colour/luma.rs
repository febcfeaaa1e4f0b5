//! Luminance of linear colours and luma of encoded ones, by the weights of ITU-R BT.709 (those of IEC 61966-2-1 too).
//!
//! The standards state four digits. Y of linear sRGB with this crate's own white is the middle row of
//! [`XYZ_FROM_SRGB`](super::XYZ_FROM_SRGB), which differs by less than 1e-4.

/// The weights of red, green and blue; they sum to 1.
pub const BT709: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The weighted sum of a colour, in its own unit.
#[must_use]
pub fn luma(rgb: [f32; 3]) -> f32 {
    let [r, g, b] = BT709.map(|w| w as f32);
    r * rgb[0] + g * rgb[1] + b * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_are_those_of_the_primaries() {
        assert!((BT709.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        let own = super::super::XYZ_FROM_SRGB[1];
        assert!(BT709.iter().zip(own).all(|(weight, y)| (weight - y).abs() < 1e-4));
    }
}
