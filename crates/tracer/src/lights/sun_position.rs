//! Position of the Sun from time and place.
//!
//! The Sun's apparent longitude (Meeus, *Astronomical Algorithms*, 2nd edition 1998, chapter 25, lower accuracy: 0.01°), apparent sidereal time
//! (chapter 12), the rotation to the horizon (chapter 13), and the parallax in elevation (8.794″). From 1900 to 2100 the result lies within 0.01° of
//! NREL's Solar Position Algorithm; within 0.3° of the zenith or nadir the azimuth loses its meaning.
//!
//! UTC is used as universal time (they differ by less than 0.9 s: 0.004°). Terrestrial time is 69 s ahead of it, as it was about 2020; other years of
//! the range differ by a minute or two, in which the Sun moves 0.002°.
//!
//! **Left out:** refraction, which lifts a Sun at the horizon by about 0.5° (the sky's model has none either), and the observer's height.

use core::f64::consts::TAU;

use etendue_core::maths::f64::{asin, atan2, cos, sin, sin_cos};

/// A time of the Gregorian calendar, UTC.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UtcTime {
    /// Days from noon of 1 January 2000 (JD 2 451 545).
    days: f64,
}

/// Position of the Sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunPosition {
    /// From north by east, in [0, 2π), rad.
    pub azimuth_rad: f64,
    /// Above the horizon, without refraction, rad.
    pub elevation_rad: f64,
}

/// Error of a time or place.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SunPositionError {
    /// A year beyond the formulas.
    #[error("year {year} is outside 1900 to 2100, for which the Sun's position is computed")]
    Year {
        /// The year given.
        year: i32,
    },
    /// A month or day that is not in the calendar.
    #[error("{year}-{month:02}-{day:02} is not a calendar date: give year, month 1 to 12 and day of the month")]
    Date {
        /// The year given.
        year: i32,
        /// The month given.
        month: u32,
        /// The day given.
        day: u32,
    },
    /// An invalid time of day.
    #[error("{hour:02}:{minute:02}:{second} is not a time of day: give hour 0 to 23, minute 0 to 59, second below 60")]
    Time {
        /// The hour given.
        hour: u32,
        /// The minute given.
        minute: u32,
        /// The second given.
        second: f64,
    },
    /// A place that does not exist on the Earth.
    #[error(
        "latitude {latitude_deg}°, longitude {longitude_deg}° is not a position on Earth: give −90 to 90 (north is positive) and \
         −180 to 180 (east is positive)"
    )]
    Place {
        /// The latitude given, degrees.
        latitude_deg: f64,
        /// The longitude given, degrees.
        longitude_deg: f64,
    },
}

/// A day of the Gregorian calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CalendarDate {
    /// 1900 to 2100.
    pub year: i32,
    /// 1 to 12.
    pub month: u32,
    /// From 1 on.
    pub day: u32,
}

/// A time of day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockTime {
    /// 0 to 23.
    pub hour: u32,
    /// 0 to 59.
    pub minute: u32,
    /// 0 or more, below 60.
    pub second: f64,
}

impl UtcTime {
    /// The time of a date and a time of day.
    ///
    /// # Errors
    /// If the calendar or the day has no such time, or the year is out of range.
    pub fn new(date: CalendarDate, time: ClockTime) -> Result<Self, SunPositionError> {
        let CalendarDate { year, month, day } = date;
        let ClockTime { hour, minute, second } = time;
        if !(1900..=2100).contains(&year) {
            return Err(SunPositionError::Year { year });
        }
        if !(1..=12).contains(&month) || !(1..=days_of_month(year, month)).contains(&day) {
            return Err(SunPositionError::Date { year, month, day });
        }
        if hour > 23 || minute > 59 || !(0.0..60.0).contains(&second) {
            return Err(SunPositionError::Time { hour, minute, second });
        }
        let of_day = (f64::from(hour) + (f64::from(minute) + second / 60.0) / 60.0) / 24.0;
        Ok(Self { days: days_since_2000(year, month, day) - 0.5 + of_day })
    }
}

fn is_leap(year: i32) -> bool {
    year % 4 == 0 && (year % 100 != 0 || year % 400 == 0)
}

fn days_of_month(year: i32, month: u32) -> u32 {
    match month {
        2 => 28 + u32::from(is_leap(year)),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Whole days from 1 January 2000 to a date; years from 1900 on.
fn days_since_2000(year: i32, month: u32, day: u32) -> f64 {
    let before = year - 1;
    let leap_days = before / 4 - before / 100 + before / 400 - (1999 / 4 - 1999 / 100 + 1999 / 400);
    let months: u32 = (1..month).map(|m| days_of_month(year, m)).sum();
    f64::from(365 * (year - 2000) + leap_days) + f64::from(months + day - 1)
}

/// Position of the Sun at a time, seen from a latitude (degrees, north positive) and longitude (degrees, east positive).
///
/// # Errors
/// If there is no such place.
pub fn sun_position(time: UtcTime, latitude_deg: f64, longitude_deg: f64) -> Result<SunPosition, SunPositionError> {
    if !(latitude_deg.abs() <= 90.0 && longitude_deg.abs() <= 180.0) {
        return Err(SunPositionError::Place { latitude_deg, longitude_deg });
    }
    let sun = apparent(time);
    let hour_angle = sun.greenwich_hour_angle_rad + longitude_deg.to_radians();
    let (sin_latitude, cos_latitude) = sin_cos(latitude_deg.to_radians());
    let (sin_declination, cos_declination) = sin_cos(sun.declination_rad);
    let (sin_hour, cos_hour) = sin_cos(hour_angle);
    let up = sin_latitude * sin_declination + cos_latitude * cos_declination * cos_hour;
    let north = cos_latitude * sin_declination - sin_latitude * cos_declination * cos_hour;
    let east = -cos_declination * sin_hour;
    let elevation = atan2(up, (north * north + east * east).sqrt());
    let parallax = (8.794_f64 / 3600.0).to_radians() * cos(elevation);
    let azimuth_rad = atan2(east, north).rem_euclid(TAU) % TAU;
    Ok(SunPosition { azimuth_rad, elevation_rad: elevation - parallax })
}

/// Position of the Sun relative to the rotating Earth.
struct ApparentSun {
    greenwich_hour_angle_rad: f64,
    declination_rad: f64,
}

fn apparent(time: UtcTime) -> ApparentSun {
    const AHEAD_DAYS: f64 = 69.0 / 86400.0;
    let t = (time.days + AHEAD_DAYS) / 36525.0;
    let node = (125.04 - 1934.136 * t).to_radians();
    let nutation_deg = -0.00478 * sin(node);
    let longitude = (true_longitude_deg(t) - 0.00569 + nutation_deg).to_radians();
    let obliquity = (23.439_291 - 0.013_004_2 * t + 0.00256 * cos(node)).to_radians();
    let (sin_obliquity, cos_obliquity) = sin_cos(obliquity);
    let right_ascension = atan2(cos_obliquity * sin(longitude), cos(longitude));
    let sidereal_deg =
        280.460_618_37 + 360.985_647_366_29 * time.days + 0.000_387_933 * t * t + nutation_deg * cos_obliquity;
    ApparentSun {
        greenwich_hour_angle_rad: sidereal_deg.rem_euclid(360.0).to_radians() - right_ascension,
        declination_rad: asin(sin_obliquity * sin(longitude)),
    }
}

/// The Sun's true longitude, degrees: the mean one and the equation of the centre; `t` in centuries from 2000.
fn true_longitude_deg(t: f64) -> f64 {
    let mean = 280.466_46 + (36_000.769_83 + 0.000_303_2 * t) * t;
    let anomaly = (357.529_11 + (35_999.050_29 - 0.000_153_7 * t) * t).to_radians();
    let centre = (1.914_602 - (0.004_817 + 0.000_014 * t) * t) * sin(anomaly)
        + (0.019_993 - 0.000_101 * t) * sin(2.0 * anomaly)
        + 0.000_289 * sin(3.0 * anomaly);
    (mean + centre).rem_euclid(360.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    fn utc(date: CalendarDate, time: ClockTime) -> UtcTime {
        UtcTime::new(date, time).expect("a moment")
    }

    fn date(year: i32, month: u32, day: u32) -> CalendarDate {
        CalendarDate { year, month, day }
    }

    fn time(hour: u32, minute: u32, second: f64) -> ClockTime {
        ClockTime { hour, minute, second }
    }

    /// A time written as 2024-06-21T11:30:00.
    fn parsed(text: &str) -> UtcTime {
        let part = |from: usize, to: usize| text[from..to].parse::<u32>().expect("a number");
        let second = text[17..].parse().expect("a number");
        utc(date(part(0, 4) as i32, part(5, 7), part(8, 10)), time(part(11, 13), part(14, 16), second))
    }

    /// Figures of `tests/oracles/sun_position.py`: NREL's algorithm in pvlib, good to 0.0003°.
    #[test]
    fn the_sun_stands_where_the_oracle_says() {
        let figures: Value =
            serde_json::from_str(include_str!("../../../../tests/oracles/figures/sun_position.json")).expect("JSON");
        let rows = figures["rows"].as_array().expect("a list");
        assert_eq!(rows.len(), 80);
        for row in rows {
            let number = |i: usize| row[i].as_f64().expect("a number");
            let actual = sun_position(parsed(row[0].as_str().expect("a time")), number(1), number(2)).expect("a place");
            let (azimuth, elevation) = (actual.azimuth_rad.to_degrees(), actual.elevation_rad.to_degrees());
            let aside = ((azimuth - number(3) + 540.0).rem_euclid(360.0) - 180.0) * cos(actual.elevation_rad);
            let off = (aside * aside + (elevation - number(4)) * (elevation - number(4))).sqrt();
            // The stated accuracy: Meeus' lower accuracy.
            assert!(off < 0.01, "{row}: {azimuth} {elevation}, off by {off}");
        }
    }

    /// Meeus, example 25.a: 13 October 1992, 0 h dynamical time: apparent right ascension 198.38083°, declination −7.78507°.
    #[test]
    fn the_book_example() {
        let sun = apparent(UtcTime { days: 2_448_908.5 - 2_451_545.0 - 69.0 / 86400.0 });
        assert!((sun.declination_rad.to_degrees() + 7.785_07).abs() < 1e-5, "{}", sun.declination_rad.to_degrees());
        let t = (2_448_908.5 - 2_451_545.0) / 36525.0;
        assert!((true_longitude_deg(t) - 199.909_88).abs() < 1e-5);
    }

    #[test]
    fn the_calendar() {
        assert_eq!(utc(date(2000, 1, 1), time(12, 0, 0.0)).days, 0.0);
        // Meeus, chapter 7: JD of 31.0 January 1999, 19.5 June 1987.
        assert_eq!(utc(date(1999, 1, 1), time(0, 0, 0.0)).days, 2_451_179.5 - 2_451_545.0);
        assert_eq!(utc(date(1987, 6, 19), time(12, 0, 0.0)).days, 2_446_966.0 - 2_451_545.0);
        assert_eq!(utc(date(1900, 1, 1), time(0, 0, 0.0)).days, 2_415_020.5 - 2_451_545.0);
        assert_eq!(utc(date(2000, 3, 1), time(0, 0, 0.0)).days - utc(date(2000, 2, 29), time(0, 0, 0.0)).days, 1.0);
        assert!((utc(date(2100, 12, 31), time(23, 59, 59.9)).days - 36_889.5).abs() < 1e-5);
    }

    #[test]
    fn what_is_no_time_or_place_is_reported() {
        let error = |date, time| UtcTime::new(date, time).expect_err("a fault").to_string();
        assert!(error(date(1899, 1, 1), time(0, 0, 0.0)).starts_with("year 1899 is outside 1900 to 2100"));
        assert!(error(date(2023, 2, 29), time(0, 0, 0.0)).starts_with("2023-02-29 is not a calendar date"));
        assert!(error(date(2100, 2, 29), time(0, 0, 0.0)).starts_with("2100-02-29 is not a calendar date"));
        assert!(error(date(2024, 13, 1), time(0, 0, 0.0)).starts_with("2024-13-01 is not a calendar date"));
        assert!(error(date(2024, 4, 0), time(0, 0, 0.0)).starts_with("2024-04-00 is not a calendar date"));
        assert!(error(date(2024, 4, 1), time(24, 0, 0.0)).starts_with("24:00:0 is not a time"));
        assert!(error(date(2024, 4, 1), time(12, 0, f64::NAN)).starts_with("12:00:NaN is not a time"));
        let noon = utc(date(2024, 6, 21), time(12, 0, 0.0));
        for (latitude, longitude) in [(90.1, 0.0), (0.0, -180.5), (f64::NAN, 0.0)] {
            let message = sun_position(noon, latitude, longitude).expect_err("a fault").to_string();
            assert!(message.ends_with("(east is positive)"), "{message}");
        }
        for latitude in [-90.0, 0.0, 90.0] {
            let sun = sun_position(noon, latitude, 180.0).expect("a place");
            assert!(sun.elevation_rad.is_finite() && (0.0..TAU).contains(&sun.azimuth_rad));
        }
    }
}
