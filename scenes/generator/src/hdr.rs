//! Radiance RGBE pictures (Ward 1991), run-length coded, the same bytes on every machine.

/// The file of a picture of linear colours, row 0 on top.
#[must_use]
pub fn hdr(width: usize, pixels: &[[f64; 3]]) -> Vec<u8> {
    let height = pixels.len() / width;
    let mut file = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for row in pixels.chunks_exact(width) {
        file.extend([2, 2, (width >> 8) as u8, (width & 255) as u8]);
        let coded: Vec<[u8; 4]> = row.iter().map(|&pixel| rgbe(pixel)).collect();
        for channel in 0..4 {
            let bytes: Vec<u8> = coded.iter().map(|pixel| pixel[channel]).collect();
            pack(&bytes, &mut file);
        }
    }
    file
}

/// Three mantissas of 8 bits under one exponent.
fn rgbe(pixel: [f64; 3]) -> [u8; 4] {
    let most = pixel.into_iter().fold(0.0, f64::max);
    if most < 1e-32 {
        return [0; 4];
    }
    // The exponent e for which 2^(e−1) ≤ most < 2^e, read from the number's own bits.
    let exponent = ((most.to_bits() >> 52) & 0x7ff) as i32 - 1022;
    let scale = f64::from_bits(((1023 + 8 - exponent) as u64) << 52);
    let [r, g, b] = pixel.map(|x| (x * scale) as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// Runs of four or more equal bytes as (128 + length, byte), all else as (length, bytes …).
fn pack(bytes: &[u8], file: &mut Vec<u8>) {
    let mut at = 0;
    while at < bytes.len() {
        let run = run_length(&bytes[at..]);
        if run >= 4 {
            file.extend([128 + run as u8, bytes[at]]);
            at += run;
        } else {
            let rest = &bytes[at..];
            let plain = (1..rest.len()).find(|&i| run_length(&rest[i..]) >= 4).unwrap_or(rest.len()).min(127);
            file.push(plain as u8);
            file.extend(&rest[..plain]);
            at += plain;
        }
    }
}

fn run_length(bytes: &[u8]) -> usize {
    bytes.iter().take(127).take_while(|byte| **byte == bytes[0]).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_reads_back() {
        let pixels: Vec<[f64; 3]> = (0..64 * 3).map(|i| [f64::from(i % 64), 5000.0, 0.01 * f64::from(i / 7)]).collect();
        let read = image::load_from_memory_with_format(&hdr(64, &pixels), image::ImageFormat::Hdr).unwrap().to_rgb32f();
        for (pixel, wanted) in read.pixels().zip(&pixels) {
            // The mantissa has eight bits and is cut, not rounded: within 1/128 of the largest channel.
            let most = wanted.iter().copied().fold(0.0, f64::max);
            assert!((0..3).all(|c| (f64::from(pixel[c]) - wanted[c]).abs() <= most / 128.0), "{pixel:?} {wanted:?}");
        }
    }
}
