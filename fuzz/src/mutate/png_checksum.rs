//! Checksums of the chunks of a PNG (PNG specification, third edition, 5.3): a changed chunk is read for what is in it.

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
/// The reversed polynomial of CRC-32.
const POLYNOMIAL: u32 = 0xedb8_8320;

/// Writes the right checksum behind every whole chunk.
pub(super) fn correct(input: &mut [u8]) {
    if !input.starts_with(SIGNATURE) {
        return;
    }
    let mut at = SIGNATURE.len();
    while let Some(length) = input.get(at..at + 4).and_then(|four| four.try_into().ok()).map(u32::from_be_bytes) {
        let end = at + 8 + length as usize;
        let Some(body) = input.get(at + 4..end) else { return };
        let checksum = crc(body);
        let Some(place) = input.get_mut(end..end + 4) else { return };
        place.copy_from_slice(&checksum.to_be_bytes());
        at = end + 4;
    }
}

fn crc(bytes: &[u8]) -> u32 {
    let shifted = |c: u32| if c & 1 == 1 { POLYNOMIAL ^ (c >> 1) } else { c >> 1 };
    let step = |c: u32, byte: &u8| (0..8).fold(c ^ u32::from(*byte), |c, _| shifted(c));
    !bytes.iter().fold(u32::MAX, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_png() {
        // The empty chunk IEND.
        assert_eq!(crc(b"IEND"), 0xae42_6082);
    }
}
