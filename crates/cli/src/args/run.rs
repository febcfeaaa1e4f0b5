//! Seeds, frames, shards and levels as typed.

use etendue::{Levels, MAX_FRAMES, ShardSpec};
use etendue_scene::record::render::MAX_SEED;
use etendue_scene::record::variations::MAX_SAMPLES;

/// A seed, as the key `seed` admits it.
pub fn seed(text: &str) -> Result<u64, String> {
    let seed = text.parse().ok().filter(|seed| *seed <= MAX_SEED);
    seed.ok_or_else(|| format!("expected a whole number from 0 to {MAX_SEED}, not '{text}'"))
}

pub fn frames(text: &str) -> Result<std::ops::Range<u32>, String> {
    let expected = || format!("expected FIRST..END with FIRST < END, e.g. 0..10, not '{text}'");
    let (first, end) = text.split_once("..").ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<u32>().map_err(|_| expected());
    let range = number(first)?..number(end)?;
    match range.len() {
        0 => Err(expected()),
        count if count > MAX_FRAMES => Err(format!("{count} frames; one run takes at most {MAX_FRAMES}")),
        _ => Ok(range),
    }
}

/// Numbers of samples of a data set.
pub fn samples(text: &str) -> Result<std::ops::Range<u32>, String> {
    let range = frames(text)?;
    match u64::from(range.end) <= MAX_SAMPLES {
        true => Ok(range),
        false => Err(format!("sample {}; a data set has at most {MAX_SAMPLES}", range.end - 1)),
    }
}

/// A whole number from `least` to `most`.
pub fn whole(least: u32, most: u32) -> impl Fn(&str) -> Result<u32, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|n| (least..=most).contains(n));
        number.ok_or_else(|| format!("expected a whole number from {least} to {most}, not '{text}'"))
    }
}

pub fn levels(text: &str) -> Result<Levels, String> {
    let expected = || format!("expected BLACK..WHITE with BLACK < WHITE, e.g. 64..4095, not '{text}'");
    let (black, white) = text.split_once("..").ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<f64>().map_err(|_| expected());
    let (black_dn, white_dn) = (number(black)?, number(white)?);
    let legal = black_dn >= 0.0 && black_dn < white_dn && white_dn.is_finite();
    legal.then_some(Levels { black_dn, white_dn }).ok_or_else(expected)
}

pub fn shard(text: &str) -> Result<ShardSpec, String> {
    let expected = || format!("expected I/N with I < N, e.g. 0/3, not '{text}'");
    let (index, count) = text.split_once('/').ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<u32>().map_err(|_| expected());
    let (index, count) = (number(index)?, number(count)?);
    if index < count { Ok(ShardSpec { index, count }) } else { Err(expected()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_have_ranges() {
        assert_eq!((whole(3, 10)("3"), whole(3, 10)("10")), (Ok(3), Ok(10)));
        assert_eq!(whole(3, 10)("2"), Err("expected a whole number from 3 to 10, not '2'".to_owned()));
        assert_eq!(whole(1, 9)("1.5"), Err("expected a whole number from 1 to 9, not '1.5'".to_owned()));
    }

    #[test]
    fn seeds_and_frames_are_as_many_as_keys_and_memory_hold() {
        assert_eq!(seed("9223372036854775807"), Ok(MAX_SEED));
        assert!(seed("9223372036854775808").is_err() && seed("-1").is_err());
        assert_eq!(frames("0..100000"), Ok(0..100_000));
        assert_eq!(frames("0..100001"), Err("100001 frames; one run takes at most 100000".to_owned()));
    }

    #[test]
    fn frames_and_shards_are_ranges() {
        assert_eq!(frames("2..5"), Ok(2..5));
        assert!(frames("5..5").is_err() && frames("5").is_err() && frames("a..b").is_err());
        assert_eq!(shard("1/3"), Ok(ShardSpec { index: 1, count: 3 }));
        assert!(shard("3/3").is_err() && shard("1").is_err());
        assert_eq!(levels("63.5..4095"), Ok(Levels { black_dn: 63.5, white_dn: 4095.0 }));
        assert!(["64", "5..5", "-1..5", "0..inf", "a..b"].iter().all(|text| levels(text).is_err()));
    }
}
