//! Numbers, places and names as typed on the command line.

use etendue::measure::{ChosenEncoding, StatedLength};
use glam::DVec2;
use std::path::PathBuf;

pub fn tile(text: &str) -> Result<String, String> {
    let tile = text.to_ascii_uppercase();
    let known = tile.chars().count() == 4 && tile.chars().all(|c| "RGBCMYWE".contains(c));
    known
        .then_some(tile)
        .ok_or_else(|| format!("expected four of the letters R, G, B, C, M, Y, W, E, e.g. RGGB, not '{text}'"))
}

pub fn region(text: &str) -> Result<[usize; 4], String> {
    let numbers: Option<Vec<usize>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    let expected = || format!("expected X,Y,WIDTH,HEIGHT in whole pixels, not '{text}'");
    let numbers: [usize; 4] = numbers.ok_or_else(expected)?.try_into().map_err(|_| expected())?;
    if numbers[2] > 0 && numbers[3] > 0 { Ok(numbers) } else { Err(expected()) }
}

pub fn chosen(text: &str) -> Result<ChosenEncoding, String> {
    match text {
        "linear" => Ok(ChosenEncoding::Linear),
        "srgb" => Ok(ChosenEncoding::Srgb),
        file if file.to_ascii_lowercase().ends_with(".csv") => Ok(ChosenEncoding::Table(file.into())),
        _ => Err(format!("expected linear, srgb or a table FILE.csv, not '{text}'")),
    }
}

pub fn grid(text: &str) -> Result<[usize; 2], String> {
    let expected = || format!("expected COLUMNSxROWS, e.g. 11x8, not '{text}'");
    let (columns, rows) = text.split_once(['x', '×']).ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<usize>().ok().filter(|n| (2..=1000).contains(n)).ok_or_else(expected);
    Ok([number(columns)?, number(rows)?])
}

pub fn size(text: &str) -> Result<[usize; 2], String> {
    let expected = || format!("expected WIDTHxHEIGHT in pixels, e.g. 640x480, not '{text}'");
    let (width, height) = text.split_once(['x', '×']).ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<usize>().ok().filter(|n| (1..=1_000_000).contains(n)).ok_or_else(expected);
    Ok([number(width)?, number(height)?])
}

pub fn place(text: &str) -> Result<[f64; 2], String> {
    let expected = || format!("expected two numbers X,Y, not '{text}'");
    let (x, y) = text.split_once(',').ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<f64>().ok().filter(|v| v.is_finite()).ok_or_else(expected);
    Ok([number(x)?, number(y)?])
}

pub fn point(text: &str) -> Result<(f64, f64), String> {
    place(text).map(Into::into)
}

pub fn corner(text: &str) -> Result<DVec2, String> {
    place(text).map(Into::into)
}

pub fn series(text: &str) -> Result<(f64, PathBuf), String> {
    let both = text.split_once(':').and_then(|(celsius, file)| Some((celsius.parse().ok()?, PathBuf::from(file))));
    both.ok_or_else(|| format!("expected CELSIUS:DESCRIPTOR.txt, e.g. 45:warm/list.txt, not '{text}'"))
}

pub fn not_negative(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0);
    number.ok_or_else(|| format!("expected a number from 0, not '{text}'"))
}

pub fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v > 0.0);
    number.ok_or_else(|| format!("expected a number above 0, not '{text}'"))
}

/// A length as typed: the decimals after the point are its digits; of whole numbers the last digit counts, 0 or not.
pub fn length(text: &str) -> Result<StatedLength, String> {
    let text = text.trim();
    let value = positive(text)?;
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let digit = format!("1e{}", exponent.parse::<i64>().unwrap_or(0) - decimals as i64);
    // 1e3 is 1000 written shortly.
    Ok(StatedLength { value, digit: digit.parse::<f64>().unwrap_or(0.0).min(1.0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_digit_tells_how_well_a_length_is_known() {
        let digit = |text: &str| length(text).map(|stated| (stated.value, stated.digit));
        assert_eq!(digit("1000"), Ok((1000.0, 1.0)));
        assert_eq!(digit(" 30.67"), Ok((30.67, 0.01)));
        assert_eq!((digit("1.50e3"), digit("1e3")), (Ok((1500.0, 1.0)), Ok((1000.0, 1.0))));
        assert!(digit("-1").is_err() && digit("one").is_err());
        assert!((length("1000").map(|s| s.rounded().standard_uncertainty).unwrap_or(0.0) - 0.288_675).abs() < 1e-6);
    }

    #[test]
    fn words_and_tables_are_told_apart() {
        assert_eq!(chosen("srgb"), Ok(ChosenEncoding::Srgb));
        assert_eq!(chosen("curve.CSV"), Ok(ChosenEncoding::Table("curve.CSV".into())));
        assert!(chosen("gamma").is_err_and(|told| told.contains("FILE.csv")));
    }
}
