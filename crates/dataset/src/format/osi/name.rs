//! Names of traces: `<time>_<type>_<OSI version>_<protobuf version>_<number of frames>_<name>.osi`.
//!
//! Source: ASAM OSI 3.8.0, "OSI trace file naming conventions".

/// The version of protobuf: that of osi-python 3.8.0, which reads the files.
const PROTOBUF: [u64; 3] = [6, 30, 2];
const SECONDS_PER_DAY: i64 = 86_400;
/// The last second of the year 9999.
const LAST_S: f64 = 253_402_300_799.0;

/// The name of a trace of `GroundTruth` that begins at a time, s from 1970.
pub(super) fn of(time_s: f64, version: [u64; 3], frames: usize, sample: u32) -> String {
    let digits = |version: [u64; 3]| version.map(|number| number.to_string()).concat();
    format!("{}_gt_{}_{}_{frames}_{sample:06}.osi", stamp(time_s), digits(version), digits(PROTOBUF))
}

/// A time, s from 1970, as ISO 8601 has it in UTC, `yyyymmddThhmmssZ`; whole seconds, those of the years 1 to 9999.
fn stamp(time_s: f64) -> String {
    let whole = time_s.floor().clamp(-62_135_596_800.0, LAST_S) as i64;
    let (days, second) = (whole.div_euclid(SECONDS_PER_DAY), whole.rem_euclid(SECONDS_PER_DAY));
    let [year, month, day] = date(days);
    format!("{year:04}{month:02}{day:02}T{:02}{:02}{:02}Z", second / 3600, second / 60 % 60, second % 60)
}

/// Year, month and day of a number of days from 1970-01-01 (Gregorian).
///
/// Source: Richards in Urban and Seidelmann (eds.), Explanatory Supplement to the Astronomical Almanac, 3rd edition, 2013, section 15.11.3.
fn date(days: i64) -> [i64; 3] {
    // The number of the Julian day at noon.
    let julian = days + 2_440_588;
    let f = julian + 1401 + (4 * julian + 274_277) / 146_097 * 3 / 4 - 38;
    let e = 4 * f + 3;
    let h = 5 * (e % 1461 / 4) + 2;
    let (day, month) = (h % 153 / 5 + 1, (h / 153 + 2) % 12 + 1);
    [e / 1461 - 4716 + (14 - month) / 12, month, day]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_follow_the_convention() {
        assert_eq!(of(0.25, [3, 8, 0], 2, 17), "19700101T000000Z_gt_380_6302_2_000017.osi");
        // The time of the convention's own example.
        assert_eq!(stamp(1_629_299_142.0), "20210818T150542Z");
        assert_eq!(stamp(-0.25), "19691231T235959Z");
        assert_eq!(stamp(951_782_400.0), "20000229T000000Z");
        assert_eq!(stamp(f64::MAX), "99991231T235959Z");
        assert_eq!(stamp(f64::MIN), "00010101T000000Z");
    }
}
