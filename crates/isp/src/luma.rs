//! Luminance of linear colours and luma of encoded ones, by the weights of ITU-R BT.709.

/// The weights of red, green and blue.
pub(crate) const BT709: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The weighted sum.
pub(crate) fn luma(rgb: [f32; 3]) -> f32 {
    let [r, g, b] = BT709.map(|w| w as f32);
    r * rgb[0] + g * rgb[1] + b * rgb[2]
}
