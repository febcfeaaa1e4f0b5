//! Divisors and multiples.

/// The greatest number that divides both; the other where one is 0.
#[must_use]
pub fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    let (mut x, mut y) = (a, b);
    while y > 0 {
        (x, y) = (y, x % y);
    }
    x
}

/// The least number above 0 that both, above 0, divide.
///
/// # Panics
/// Where both are 0.
#[must_use]
pub fn least_common_multiple(a: u32, b: u32) -> u32 {
    a / greatest_common_divisor(a, b) * b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn divisors_and_multiples() {
        assert_eq!([(12, 18), (7, 5), (0, 4), (9, 9)].map(|(a, b)| greatest_common_divisor(a, b)), [6, 1, 4, 9]);
        assert_eq!([(4, 6), (7, 5), (8, 2)].map(|(a, b)| least_common_multiple(a, b)), [12, 35, 8]);
    }
}
