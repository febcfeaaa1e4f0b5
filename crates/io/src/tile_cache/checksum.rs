//! A checksum that finds accidents: flipped bits, missing parts, exchanged blocks of bytes. It is no defence against intent.

/// Odd, with as many ones as zeros: 2⁶⁴ divided by the golden ratio (Knuth, The Art of Computer Programming, 6.4).
const MULTIPLIER: u64 = 0x9e37_79b9_7f4a_7c15;

/// The checksum of bytes: words of eight bytes, each mixed into the sum by a multiplication. Any change within one word changes it.
pub(super) fn of(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mut last = [0; 8];
    last[..rest.len()].copy_from_slice(rest);
    let sum = words.iter().fold(bytes.len() as u64, |sum, word| mixed(sum, *word));
    mixed(sum, last)
}

/// One-to-one in the word for a given sum, and in the sum for a given word.
fn mixed(sum: u64, word: [u8; 8]) -> u64 {
    let product = (sum ^ u64::from_le_bytes(word)).wrapping_mul(MULTIPLIER);
    product ^ (product >> 32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_and_every_length_counts() {
        let bytes: Vec<u8> = (0..37).collect();
        for bit in 0..37 * 8 {
            let mut flipped = bytes.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert_ne!(of(&flipped), of(&bytes), "{bit}");
        }
        assert_ne!(of(&[0; 8]), of(&[0; 9]));
        assert_ne!(of(&[]), of(&[0]));
    }
}
