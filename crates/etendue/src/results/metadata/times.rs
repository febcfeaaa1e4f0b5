//! Times in side-cars: numbers, and text if a number would be rounded.

use etendue_core::ExactTime;
use etendue_pipeline::plan::Timing;
use serde_json::{Map, Value};

/// Returns `<name>_s`, the nearest number, and, for a job whose epoch is not zero, `<name>`, text with digits to the picosecond.
pub(crate) fn facts(timing: &Timing, name: &str, time: ExactTime) -> Map<String, Value> {
    let number = (format!("{name}_s"), time.seconds().into());
    let text = (!timing.epoch.is_zero()).then(|| (name.to_owned(), digits(time).into()));
    std::iter::once(number).chain(text).collect()
}

/// Returns decimal seconds, rounded to the picosecond.
fn digits(time: ExactTime) -> String {
    const PER_S: f64 = 1e12;
    let rounded = (time.fraction_s() * PER_S).round() / PER_S;
    (ExactTime::from(time.whole_s() as f64) + rounded.into()).to_string()
}

/// Adds the entries of a time to a table.
pub(crate) fn add(table: &mut Value, timing: &Timing, name: &str, time: ExactTime) {
    if let Some(table) = table.as_object_mut() {
        table.extend(facts(timing, name, time));
    }
}
