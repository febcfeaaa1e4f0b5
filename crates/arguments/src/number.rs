//! Numbers with their ranges.

use clap::builder::RangedI64ValueParser;
use std::ops::RangeInclusive;

/// Parses a whole number of a range; the error message is our own.
pub fn integer(range: RangeInclusive<u32>) -> impl Fn(&str) -> Result<u32, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|n| range.contains(n));
        let (min, max) = (range.start(), range.end());
        number.ok_or_else(|| format!("expected a whole number from {min} to {max}, not '{text}'"))
    }
}

/// Parses a whole number of a range; the error message is clap's.
#[must_use]
pub fn in_range<N>(range: RangeInclusive<N>) -> RangedI64ValueParser<N>
where
    N: Into<i64> + TryFrom<i64> + Clone + Send + Sync + 'static,
    <N as TryFrom<i64>>::Error: Into<Box<dyn std::error::Error + Send + Sync>>,
{
    let (min, max) = range.into_inner();
    RangedI64ValueParser::new().range(min.into()..=max.into())
}

/// Parses a finite number from 0.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn not_negative(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0);
    number.ok_or_else(|| format!("expected a number of 0 or more, not '{text}'"))
}

/// Parses a finite number above 0.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v > 0.0);
    number.ok_or_else(|| format!("expected a number above 0, not '{text}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_have_ranges() {
        assert_eq!((integer(3..=10)("3"), integer(3..=10)("10")), (Ok(3), Ok(10)));
        assert_eq!(integer(3..=10)("2"), Err("expected a whole number from 3 to 10, not '2'".to_owned()));
        assert_eq!(integer(1..=9)("1.5"), Err("expected a whole number from 1 to 9, not '1.5'".to_owned()));
    }
}
