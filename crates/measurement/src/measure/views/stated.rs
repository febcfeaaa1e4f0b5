//! Lengths as they are stated: known to their last digit.

use etendue_arguments::positive;
use etendue_metrology::Estimate;
use std::str::FromStr;

/// A length above 0 and the unit of its last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatedLength {
    /// The length.
    pub value: f64,
    /// What its last digit counts; 0 where it is exact.
    pub digit: f64,
}

impl StatedLength {
    /// Rounded to its last digit: anywhere within half of it either way (GUM, JCGM 100:2008, F.2.2.1).
    #[must_use]
    pub fn rounded(self) -> Estimate {
        Estimate::new(self.value, self.digit / 12_f64.sqrt())
    }
}

/// A length as typed: the decimals after the point are its digits; of whole numbers the last digit counts, 0 or not.
impl FromStr for StatedLength {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let value = positive(text)?;
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let digit = format!("1e{}", exponent.parse::<i64>().unwrap_or(0) - decimals as i64);
        // 1e3 is 1000 written shortly.
        Ok(Self { value, digit: digit.parse::<f64>().unwrap_or(0.0).min(1.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_digit_tells_how_well_a_length_is_known() {
        let digit = |text: &str| text.parse::<StatedLength>().map(|stated| (stated.value, stated.digit));
        assert_eq!(digit("1000"), Ok((1000.0, 1.0)));
        assert_eq!(digit(" 30.67"), Ok((30.67, 0.01)));
        assert_eq!((digit("1.50e3"), digit("1e3")), (Ok((1500.0, 1.0)), Ok((1000.0, 1.0))));
        assert!(digit("-1").is_err() && digit("one").is_err());
        assert!(
            ("1000".parse::<StatedLength>().map(|s| s.rounded().standard_uncertainty).unwrap_or(0.0) - 0.288_675).abs()
                < 1e-6
        );
    }
}
