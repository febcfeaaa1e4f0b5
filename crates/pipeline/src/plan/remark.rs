//! Notes and warnings of compilation.

use std::fmt::{self, Display, Formatter};

/// Severity of a remark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// States how an input was read or extrapolated. The plan reports it.
    Note,
    /// The image may differ from what the user expects of the description. The plan reports it, and a render repeats it.
    Warning,
}

/// A note or warning on a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// File, place or object that it concerns; `None` if the text names it or it concerns the whole job.
    pub about: Option<String>,
    /// Text, without a full stop.
    pub text: String,
    /// Severity.
    pub weight: Weight,
    /// Number of occurrences, 1 or more.
    pub count: usize,
}

/// Remarks of one text, reported once with everything that they concern.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grouped<'a> {
    about: Vec<&'a str>,
    text: &'a str,
    count: usize,
    /// Severity.
    pub weight: Weight,
}

impl<'a> Grouped<'a> {
    /// Files, places or objects that they concern; empty if the text names them.
    #[must_use]
    pub fn about(&self) -> &[&'a str] {
        &self.about
    }

    /// Text, without a full stop.
    #[must_use]
    pub fn text(&self) -> &'a str {
        self.text
    }

    /// Number of occurrences, 1 or more.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }
}

impl Display for Grouped<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.about.as_slice() {
            [] => f.write_str(self.text),
            names => write!(f, "{}: {}", names.join(", "), self.text),
        }?;
        if self.count > 1 { write!(f, " ({} times)", self.count) } else { Ok(()) }
    }
}

/// Groups remarks by text, in the order of first occurrence.
#[must_use]
pub fn grouped(remarks: &[Remark]) -> Vec<Grouped<'_>> {
    let mut groups: Vec<Grouped<'_>> = Vec::new();
    for Remark { about, text, weight, count } in remarks {
        let is_same = |group: &&mut Grouped<'_>| {
            group.text == text && group.weight == *weight && group.about.is_empty() == about.is_none()
        };
        let about = about.iter().map(String::as_str);
        match groups.iter_mut().find(is_same) {
            Some(group) => {
                group.about.extend(about);
                group.count += count;
            }
            None => groups.push(Grouped { about: about.collect(), text, count: *count, weight: *weight }),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn remark(about: Option<&str>, text: &str, weight: Weight) -> Remark {
        Remark { about: about.map(str::to_owned), text: text.to_owned(), weight, count: 1 }
    }

    #[test]
    fn what_is_said_of_several_things_is_told_once() {
        let remarks = [
            remark(Some("a"), "ends at 700 nm", Weight::Note),
            remark(None, "nothing is kept", Weight::Note),
            remark(Some("b"), "ends at 700 nm", Weight::Note),
            remark(Some("c"), "ends at 700 nm", Weight::Warning),
            remark(Some("d"), "nothing is kept", Weight::Note),
        ];
        let told: Vec<String> = grouped(&remarks).iter().map(ToString::to_string).collect();
        let expected = ["a, b: ends at 700 nm (2 times)", "nothing is kept", "c: ends at 700 nm", "d: nothing is kept"];
        assert_eq!(told, expected);
    }

    #[test]
    fn equal_remarks_are_counted() {
        let twice = Remark { count: 2, ..remark(None, "nothing is kept", Weight::Note) };
        let remarks = [twice, remark(None, "nothing is kept", Weight::Note)];
        let groups = grouped(&remarks);
        assert_eq!((groups.len(), groups[0].count()), (1, 3));
        assert_eq!(groups[0].to_string(), "nothing is kept (3 times)");
    }
}
