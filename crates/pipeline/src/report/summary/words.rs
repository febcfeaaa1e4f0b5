//! Lines, lists and numbers of a summary.

use std::fmt::{self, Display, Formatter};

/// "a, b and c".
pub(super) fn list(words: &[&str]) -> String {
    match words {
        [] => "nothing".to_owned(),
        [one] => (*one).to_owned(),
        [some @ .., last] => format!("{} and {last}", some.join(", ")),
    }
}

/// A number with a noun: "1 sphere", "2 spheres".
pub(super) fn count(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") }
}

/// One line: a name and its text.
pub(super) fn line(f: &mut Formatter<'_>, name: &str, text: impl Display) -> fmt::Result {
    writeln!(f, "  {name:<14} {text}")
}

/// A number rounded to four decimals.
pub(super) fn figure(x: f64) -> f64 {
    (x * 1e4).round() / 1e4
}

/// A ratio to three digits, without decimals from 100 on.
pub(super) fn ratio(x: f64) -> String {
    match x {
        x if x < 10.0 => format!("{x:.2}"),
        x if x < 100.0 => format!("{x:.1}"),
        x => format!("{x:.0}"),
    }
}

/// Seconds as text: to a tenth below ten.
pub(super) fn seconds(s: f64) -> String {
    if s < 10.0 { format!("{s:.1}") } else { format!("{s:.0}") }
}
