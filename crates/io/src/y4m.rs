//! YUV4MPEG2 videos (`.y4m`): frames without compression, which ffmpeg, mpv and OpenCV read.
//!
//! Eight bits, 4:4:4, R′G′B′ by the matrix of ITU-R BT.709 in limited range (BT.709-6, 3.2 to 3.5; black 16, white 235, colour 16 to 240), rounded to nearest:
//! the file says `C444` and `XCOLORRANGE=LIMITED`; it has no place for the matrix. The frame rate and the pixel aspect are the simplest fractions within 10⁻¹²
//! of the requested values: 29.97002997002997 is 30000:1001.

use std::io::{self, Write};

/// Header of a video.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VideoFacts {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Frame rate, Hz, above 0.
    pub frame_rate_hz: f64,
    /// Pixel width over height, above 0.
    pub pixel_aspect: f64,
}

/// Writes the header of a video.
///
/// # Errors
/// Those of the writer.
pub fn write_head(out: &mut impl Write, facts: &VideoFacts) -> io::Result<()> {
    let VideoFacts { width, height, .. } = facts;
    let ([rate, per], [x, y]) = (fraction(facts.frame_rate_hz), fraction(facts.pixel_aspect));
    writeln!(out, "YUV4MPEG2 W{width} H{height} F{rate}:{per} Ip A{x}:{y} C444 XCOLORRANGE=LIMITED")
}

/// Writes a frame of R′G′B′ bytes, row by row from the top.
///
/// # Errors
/// Those of the writer.
pub fn write_frame(out: &mut impl Write, pixels: &[[u8; 3]]) -> io::Result<()> {
    out.write_all(b"FRAME\n")?;
    let mut planes = [const { Vec::new() }; 3];
    planes.iter_mut().for_each(|plane| plane.reserve(pixels.len()));
    for pixel in pixels {
        planes.iter_mut().zip(limited_range(*pixel)).for_each(|(plane, value)| plane.push(value));
    }
    planes.iter().try_for_each(|plane| out.write_all(plane))
}

/// Y′, C′b, C′r of R′G′B′ bytes.
fn limited_range(rgb: [u8; 3]) -> [u8; 3] {
    let [r, g, b] = rgb.map(|v| f64::from(v) / 255.0);
    let luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let colour = |difference: f64, max: f64| 128.0 + 224.0 * difference / max;
    [16.0 + 219.0 * luma, colour(b - luma, 1.8556), colour(r - luma, 1.5748)].map(|v| v.round() as u8)
}

/// Relative tolerance of a fraction.
const TOLERANCE: f64 = 1e-12;

/// Simplest fraction within [`TOLERANCE`] of a number above 0: the first such convergent of its continued fraction.
fn fraction(value: f64) -> [u64; 2] {
    let (mut before, mut now) = ([0.0, 1.0], [1.0, 0.0]);
    let mut rest = value;
    for _ in 0..40 {
        let integer = rest.floor();
        (before, now) = (now, [0, 1].map(|i| integer * now[i] + before[i]));
        if (now[0] / now[1] - value).abs() <= TOLERANCE * value || rest == integer {
            break;
        }
        rest = 1.0 / (rest - integer);
    }
    now.map(|v: f64| v as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_the_fractions_that_are_meant() {
        assert_eq!(fraction(25.0), [25, 1]);
        assert_eq!(fraction(1.0 / (1.0 / 29.97)), [2997, 100]);
        assert_eq!(fraction(30_000.0 / 1001.0), [30_000, 1001]);
        assert_eq!(fraction(29.970_029_970_029_97), [30_000, 1001]);
        assert_eq!(fraction(1.0 / 0.0333), [10_000, 333]);
        assert_eq!(fraction(0.1), [1, 10]);
        assert_eq!(fraction(1.0), [1, 1]);
    }

    #[test]
    fn black_white_and_the_colours_are_those_of_the_standard() {
        // Round (16 + 219 E'Y), (128 + 224 E'C): 100 % colour bars of BT.709.
        let bars = [
            ([0, 0, 0], [16, 128, 128]),
            ([255, 255, 255], [235, 128, 128]),
            ([255, 0, 0], [63, 102, 240]),
            ([0, 255, 0], [173, 42, 26]),
            ([0, 0, 255], [32, 240, 118]),
            ([255, 255, 0], [219, 16, 138]),
        ];
        for (rgb, expected) in bars {
            assert_eq!(limited_range(rgb), expected, "{rgb:?}");
        }
    }

    #[test]
    fn a_video_is_a_head_and_planes() {
        let mut file = Vec::new();
        let facts = VideoFacts { width: 2, height: 1, frame_rate_hz: 12.5, pixel_aspect: 1.0 };
        write_head(&mut file, &facts).expect("memory");
        write_frame(&mut file, &[[255; 3], [0; 3]]).expect("memory");
        let head = b"YUV4MPEG2 W2 H1 F25:2 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
        assert_eq!(file, [&head[..], b"FRAME\n", &[235, 16, 128, 128, 128, 128]].concat());
    }
}
