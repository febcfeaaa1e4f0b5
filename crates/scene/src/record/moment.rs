//! Days and times, as TOML dates or as texts.

use serde_json::{Value as Json, json};

use crate::document::{Node, Value};
use crate::fault::DescriptionErrors;
use crate::place::Placed;
use crate::reader::{Rule, ValueKind};
use crate::written::{Item, Value as WrittenValue};

/// A day of the Gregorian calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Date {
    /// The year, 1950 … 2099.
    pub year: u32,
    /// The month, 1 … 12.
    pub month: u32,
    /// The day of the month, 1 … 31.
    pub day: u32,
}

/// A time of the day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TimeOfDay {
    /// Seconds since midnight.
    pub seconds: u32,
}

/// The rule of a date, `2026-06-21`.
pub(crate) const fn date() -> DateRule {
    DateRule
}

/// The rule of a time of the day, `09:30:00`.
pub(crate) const fn time_of_day() -> TimeRule {
    TimeRule
}

/// See [`date`].
pub(crate) struct DateRule;

/// See [`time_of_day`].
pub(crate) struct TimeRule;

impl Rule for DateRule {
    type Out = Placed<Date>;
    fn accepts(&self, kind: ValueKind) -> bool {
        matches!(kind, ValueKind::Text | ValueKind::Moment)
    }
    fn expected(&self) -> String {
        "a date from 1950 to 2099 as year-month-day: 2026-06-21".to_owned()
    }
    fn schema(&self) -> Json {
        json!({ "type": "string", "format": "date", "examples": ["2026-06-21"] })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<Date>> {
        match text(node).and_then(parse_date) {
            Some(date) => Some(Placed::new(date, node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Placed<Date>) -> Option<Item> {
        let Date { year, month, day } = value.value;
        Some(Item::at(&value.place, WrittenValue::Moment(format!("{year:04}-{month:02}-{day:02}"))))
    }
}

impl Rule for TimeRule {
    type Out = Placed<TimeOfDay>;
    fn accepts(&self, kind: ValueKind) -> bool {
        matches!(kind, ValueKind::Text | ValueKind::Moment)
    }
    fn expected(&self) -> String {
        "a time of day in UTC, without a zone, in whole seconds as hour:minute:second: 09:30:00".to_owned()
    }
    fn schema(&self) -> Json {
        json!({ "type": "string", "format": "time", "examples": ["09:30:00"] })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<Placed<TimeOfDay>> {
        match text(node).and_then(parse_time) {
            Some(time) => Some(Placed::new(time, node.place.clone())),
            None => self.refuse(node, errors),
        }
    }
    fn write(&self, value: &Placed<TimeOfDay>) -> Option<Item> {
        let seconds = value.seconds;
        let [hour, minute, second] = [seconds / 3600, seconds / 60 % 60, seconds % 60];
        Some(Item::at(&value.place, WrittenValue::Moment(format!("{hour:02}:{minute:02}:{second:02}"))))
    }
}

fn text(node: &Node) -> Option<&str> {
    match &node.value {
        Value::Text(text) | Value::Moment(text) => Some(text),
        _ => None,
    }
}

fn parse_date(text: &str) -> Option<Date> {
    let [year, month, day] = fields(text, '-', [4, 2, 2])?;
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let days = match month {
        4 | 6 | 9 | 11 => 30,
        2 if leap => 29,
        2 => 28,
        1..=12 => 31,
        _ => return None,
    };
    let legal = (1950..=2099).contains(&year) && (1..=days).contains(&day);
    legal.then_some(Date { year, month, day })
}

fn parse_time(text: &str) -> Option<TimeOfDay> {
    let [hour, minute, second] = fields(text, ':', [2; 3])?;
    let legal = hour < 24 && minute < 60 && second < 60;
    legal.then_some(TimeOfDay { seconds: 3600 * hour + 60 * minute + second })
}

/// Parses three numbers with the given numbers of digits.
fn fields(text: &str, separator: char, digits: [usize; 3]) -> Option<[u32; 3]> {
    let parts: Vec<&str> = text.split(separator).collect();
    let plain = |part: &str, digits: usize| part.len() == digits && part.bytes().all(|b| b.is_ascii_digit());
    let [a, b, c] = *parts.as_slice() else { return None };
    let legal = [a, b, c].into_iter().zip(digits).all(|(part, digits)| plain(part, digits));
    let number = |part: &str| part.parse().ok();
    if legal { Some([number(a)?, number(b)?, number(c)?]) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_of_the_calendar() {
        assert_eq!(parse_date("2024-02-29"), Some(Date { year: 2024, month: 2, day: 29 }));
        for none in ["2023-02-29", "2024-13-01", "2024-00-10", "2024-04-31", "24-04-01", "2024-4-01", "1900-01-01", "x"]
        {
            assert_eq!(parse_date(none), None, "{none}");
        }
    }

    #[test]
    fn times_of_the_day() {
        assert_eq!(parse_time("09:30:15"), Some(TimeOfDay { seconds: 34_215 }));
        for none in ["24:00:00", "09:60:00", "9:30:00", "09:30", "09:30:00.5", "-1:00:00"] {
            assert_eq!(parse_time(none), None, "{none}");
        }
    }
}
