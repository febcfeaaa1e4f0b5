//! Frames, samples and seeds.

use etendue_scene::record::render::MAX_SEED;
use etendue_scene::record::variations::MAX_SAMPLES;
use std::ops::Range;

/// Maximum number of frames of one run.
pub const MAX_FRAMES: usize = 100_000;

/// Parses a seed, as the key `seed` admits it.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn seed(text: &str) -> Result<u64, String> {
    let seed = text.parse().ok().filter(|seed| *seed <= MAX_SEED);
    seed.ok_or_else(|| format!("expected a whole number from 0 to {MAX_SEED}, not '{text}'"))
}

/// Parses numbers of frames, the last excluded.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn frames(text: &str) -> Result<Range<u32>, String> {
    let expected = || format!("expected FIRST..END with FIRST < END, e.g. 0..10, not '{text}'");
    let (first, end) = text.split_once("..").ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<u32>().map_err(|_| expected());
    let range = number(first)?..number(end)?;
    match range.len() {
        0 => Err(expected()),
        count if count > MAX_FRAMES => Err(format!("{count} frames; one run can have at most {MAX_FRAMES}")),
        _ => Ok(range),
    }
}

/// Parses numbers of samples of a data set, the last excluded.
///
/// # Errors
/// The text has another form; the error states the expected one.
pub fn samples(text: &str) -> Result<Range<u32>, String> {
    let range = frames(text)?;
    match u64::from(range.end) <= MAX_SAMPLES {
        true => Ok(range),
        false => Err(format!("sample {}; a data set has at most {MAX_SAMPLES}", range.end - 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_and_frames_are_as_many_as_keys_and_memory_hold() {
        assert_eq!(seed("9223372036854775807"), Ok(MAX_SEED));
        assert!(seed("9223372036854775808").is_err() && seed("-1").is_err());
        assert_eq!(frames("0..100000"), Ok(0..100_000));
        assert_eq!(frames("0..100001"), Err("100001 frames; one run can have at most 100000".to_owned()));
    }

    #[test]
    fn frames_are_ranges() {
        assert_eq!(frames("2..5"), Ok(2..5));
        assert!(frames("5..5").is_err() && frames("5").is_err() && frames("a..b").is_err());
    }
}
