//! Radiance HDR files with other axis orders, and in XYZ (`32-bit_rle_xyze`).
//!
//! Source: Radiance File Formats (G. Ward, LBNL): the resolution string `-Y N +X M` states the axis of the scan lines last; with `-X` first the scan lines are
//! columns. The XYZ of such files are CIE 1931 tristimulus values, of which 1, 1, 1 is the equal-energy white; they are converted without adaptation, as the
//! chromaticities of OpenEXR are.
//!
//! The decoder of the image crate reads `-Y N +X M` and RGBE alone. The header is replaced by such a one, and the pixels are turned afterwards.

use std::borrow::Cow;

use etendue_scene::asset::{ColourMatrix, ImagePixels};
use etendue_spectra::colour::SRGB_FROM_XYZ;

/// Radiance file with a header that the decoder reads.
pub(super) struct RadianceFile<'a> {
    pub(super) bytes: Cow<'a, [u8]>,
    orientation: Orientation,
    is_xyz: bool,
}

/// Axis order of a file: that of its scan lines, and that within a scan line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Orientation {
    /// True if the scan lines are columns.
    is_transposed: bool,
    /// True if the first scan line is the bottom row, or the right column.
    is_from_end: bool,
    /// True if a scan line begins at the right, or at the bottom.
    is_reversed: bool,
}

const PLAIN: Orientation = Orientation { is_transposed: false, is_from_end: false, is_reversed: false };

/// Returns true for a Radiance file.
pub(super) fn is_radiance(bytes: &[u8]) -> bool {
    bytes.starts_with(b"#?")
}

impl<'a> RadianceFile<'a> {
    /// A file of another form than the decoder's is rewritten; one whose header cannot be read is left to the decoder.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let unchanged = Self { bytes: Cow::Borrowed(bytes), orientation: PLAIN, is_xyz: false };
        let Some(head) = RadianceHead::parse(bytes) else { return unchanged };
        if bytes.starts_with(b"#?RADIANCE") && head.orientation == PLAIN && !head.is_xyz {
            return unchanged;
        }
        let [lines, pixels] = head.counts;
        let mut plain = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {lines} +X {pixels}\n").into_bytes();
        plain.extend_from_slice(&bytes[head.length..]);
        Self { bytes: Cow::Owned(plain), orientation: head.orientation, is_xyz: head.is_xyz }
    }

    /// Matrix from the file's colours to Rec. 709; `None` for RGB.
    pub(super) fn to_rec_709(&self) -> Option<ColourMatrix> {
        self.is_xyz.then_some(ColourMatrix(SRGB_FROM_XYZ))
    }

    /// Turns decoded pixels of `size` (pixels per scan line, scan lines) to rows from the top left; returns width, height and pixels.
    pub(super) fn upright(&self, size: [u32; 2], pixels: ImagePixels) -> ([u32; 2], ImagePixels) {
        match pixels {
            ImagePixels::Rgb32F(pixels) if self.orientation != PLAIN => {
                let (size, pixels) = self.orientation.upright(size, &pixels);
                (size, ImagePixels::Rgb32F(pixels))
            }
            pixels => (size, pixels),
        }
    }
}

impl Orientation {
    fn upright(self, [length, lines]: [u32; 2], pixels: &[[f32; 3]]) -> ([u32; 2], Vec<[f32; 3]>) {
        let [width, height] = if self.is_transposed { [lines, length] } else { [length, lines] };
        let pixel = |x: u32, y: u32| {
            let [line, at] = if self.is_transposed { [x, y] } else { [y, x] };
            let line = if self.is_from_end { lines - 1 - line } else { line };
            let at = if self.is_reversed { length - 1 - at } else { at };
            pixels[line as usize * length as usize + at as usize]
        };
        ([width, height], (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect())
    }
}

/// Header of a file.
struct RadianceHead {
    orientation: Orientation,
    is_xyz: bool,
    /// Scan lines, and pixels of each.
    counts: [u32; 2],
    /// Bytes before the pixels.
    length: usize,
}

impl RadianceHead {
    fn parse(bytes: &[u8]) -> Option<Self> {
        const MAX_HEAD: usize = 1 << 16;
        let text = &bytes[..bytes.len().min(MAX_HEAD)];
        let (mut at, mut is_xyz, mut is_ended) = (0, false, false);
        loop {
            let length = text.get(at..)?.iter().position(|byte| *byte == b'\n')?;
            let line = text[at..at + length].trim_ascii();
            at += length + 1;
            if is_ended {
                let (orientation, counts) = resolution(std::str::from_utf8(line).ok()?)?;
                return Some(Self { orientation, is_xyz, counts, length: at });
            }
            is_ended = line.is_empty();
            if let Some(format) = line.strip_prefix(b"FORMAT=") {
                is_xyz = match format.trim_ascii() {
                    b"32-bit_rle_xyze" => true,
                    b"32-bit_rle_rgbe" => false,
                    _ => return None,
                };
            }
        }
    }
}

fn resolution(line: &str) -> Option<(Orientation, [u32; 2])> {
    let words: Vec<&str> = line.split_ascii_whitespace().collect();
    let [first, lines, second, pixels] = words[..] else { return None };
    let counts = [lines.parse().ok()?, pixels.parse().ok()?];
    let is_transposed = match (first, second) {
        ("-Y" | "+Y", "-X" | "+X") => false,
        ("-X" | "+X", "-Y" | "+Y") => true,
        _ => return None,
    };
    // Rows count from the top and columns from the left: +Y and -X begin at the end.
    let from_end = |axis: &str| matches!(axis, "+Y" | "-X");
    let orientation = Orientation { is_transposed, is_from_end: from_end(first), is_reversed: from_end(second) };
    (counts[0] > 0 && counts[1] > 0).then_some((orientation, counts))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::decode_image;
    use super::*;

    /// An image of 3 × 2 pixels whose red is x + 1 and whose green is y + 1, stored in this order without compression.
    fn file(format: &str, order: [&str; 2]) -> Vec<u8> {
        let count = |axis: &str| if axis.ends_with('X') { 3_u32 } else { 2 };
        let [lines, pixels] = order.map(count);
        let mut bytes =
            format!("#?RADIANCE\nFORMAT={format}\nSOFTWARE=x\n\n{} {lines} {} {pixels}\n", order[0], order[1])
                .into_bytes();
        let place = |axis: &str, at: u32| match axis {
            "+X" | "-Y" => at,
            "-X" => 2 - at,
            _ => 1 - at,
        };
        for line in 0..lines {
            for at in 0..pixels {
                let (a, b) = (place(order[0], line), place(order[1], at));
                let (x, y) = if order[0].ends_with('X') { (a, b) } else { (b, a) };
                bytes.extend([(x as u8 + 1) * 32, (y as u8 + 1) * 32, 0, 131]); // mantissa · 2^(131 − 136)
            }
        }
        bytes
    }

    #[test]
    fn every_axis_order_is_one_image() {
        let expected: Vec<[f32; 3]> = (0..6).map(|i| [(i % 3 + 1) as f32, (i / 3 + 1) as f32, 0.0]).collect();
        for first in ["-Y", "+Y", "-X", "+X"] {
            for second in if first.ends_with('Y') { ["+X", "-X"] } else { ["-Y", "+Y"] } {
                let image =
                    decode_image(Path::new("a.hdr"), &file("32-bit_rle_rgbe", [first, second])).expect("readable");
                assert_eq!((image.width, image.height), (3, 2), "{first} {second}");
                assert_eq!(image.pixels, ImagePixels::Rgb32F(expected.clone()), "{first} {second}");
                assert_eq!(image.to_rec_709, None);
            }
        }
    }

    /// Figures of IEC 61966-2-1: linear sRGB = M⁻¹ XYZ.
    #[test]
    fn xyz_becomes_rec_709() {
        let image =
            decode_image(Path::new("a.hdr"), &file("32-bit_rle_xyze", ["-Y", "+X"])).expect("readable").in_rec_709();
        let ImagePixels::Rgb32F(pixels) = image.pixels else { panic!("floats") };
        // X = Y = 1, Z = 0. Four digits of the standard.
        for (actual, expected) in pixels[0].into_iter().zip([3.2406 - 1.5372, -0.9689 + 1.8758, 0.0557 - 0.2040]) {
            assert!((actual - expected).abs() < 5e-4, "{actual} {expected}");
        }
    }

    #[test]
    fn an_unreadable_file_is_not_advised_to_be_a_png() {
        for bytes in
            [&b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X"[..], b"#?RADIANCE\nFORMAT=other\n\n-Y 1 +X 1\n1234"]
        {
            let message = decode_image(Path::new("a.hdr"), bytes).expect_err("damaged").to_string();
            assert!(message.starts_with("a.hdr: ") && !message.contains("PNG"), "{message}");
        }
    }
}
