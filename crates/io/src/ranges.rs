//! Ranges of arguments, which are named by their fields.

use crate::failure::Error;
use std::fmt::Display;
use std::ops::RangeInclusive;

/// Refuses a whole number that is out of its range.
pub fn whole<N: PartialOrd + Display>(name: &str, value: N, range: RangeInclusive<N>) -> Result<(), Error> {
    let (least, most) = (range.start(), range.end());
    let told =
        || Error::argument(name, format!("`{name}`: expected a whole number from {least} to {most}, not {value}"));
    if range.contains(&value) { Ok(()) } else { Err(told()) }
}

/// Refuses a number that is out of its range, or not finite.
pub fn number(name: &str, value: f64, range: RangeInclusive<f64>, unit: &str) -> Result<(), Error> {
    let (least, most) = (range.start(), range.end());
    let told = || Error::argument(name, format!("`{name}`: expected {least} to {most} {unit}, not {value}"));
    if value.is_finite() && range.contains(&value) { Ok(()) } else { Err(told()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_out_of_range_is_refused_by_its_name() {
        assert_eq!(whole("rings", 4, 4..=1000), Ok(()));
        let told = whole("rings", 3, 4..=1000).map_err(|error| error.to_string());
        assert_eq!(told, Err("error: `rings`: expected a whole number from 4 to 1000, not 3\n".to_owned()));
        assert!(number("wavelength_nm", f64::NAN, 300.0..=1100.0, "nm").is_err());
        assert!(number("photons", f64::INFINITY, 0.0..=f64::MAX, "photons").is_err());
    }
}
