//! Notes and warnings of compilation.

use std::fmt::{self, Display, Formatter};

/// Severity of a note.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// States how an input was read or extrapolated. The plan reports it.
    Note,
    /// The image may differ from what the user expects of the description. The plan reports it, and a render repeats it.
    Warning,
}

/// A note or warning on a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// File, place or object that it concerns; `None` if the text names it or it concerns the whole job.
    pub subject: Option<String>,
    /// Text, without a full stop.
    pub text: String,
    /// Severity.
    pub weight: Severity,
    /// Number of occurrences, 1 or more.
    pub count: usize,
}

/// Remarks of one text, reported once with everything that they concern.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoteGroup<'a> {
    subject: Vec<&'a str>,
    text: &'a str,
    count: usize,
    /// Severity.
    pub weight: Severity,
}

impl<'a> NoteGroup<'a> {
    /// Files, places or objects that they concern; empty if the text names them.
    #[must_use]
    pub fn subjects(&self) -> &[&'a str] {
        &self.subject
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

impl Display for NoteGroup<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.subject.as_slice() {
            [] => f.write_str(self.text),
            names => write!(f, "{}: {}", names.join(", "), self.text),
        }?;
        if self.count > 1 { write!(f, " ({} times)", self.count) } else { Ok(()) }
    }
}

/// Groups remarks by text, in the order of first occurrence.
#[must_use]
pub fn grouped(notes: &[Note]) -> Vec<NoteGroup<'_>> {
    let mut groups: Vec<NoteGroup<'_>> = Vec::new();
    for Note { subject, text, weight, count } in notes {
        let is_same = |group: &&mut NoteGroup<'_>| {
            group.text == text && group.weight == *weight && group.subject.is_empty() == subject.is_none()
        };
        let subject = subject.iter().map(String::as_str);
        match groups.iter_mut().find(is_same) {
            Some(group) => {
                group.subject.extend(subject);
                group.count += count;
            }
            None => groups.push(NoteGroup { subject: subject.collect(), text, count: *count, weight: *weight }),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn note(subject: Option<&str>, text: &str, weight: Severity) -> Note {
        Note { subject: subject.map(str::to_owned), text: text.to_owned(), weight, count: 1 }
    }

    #[test]
    fn equal_notes_of_several_objects_are_reported_once() {
        let notes = [
            note(Some("a"), "ends at 700 nm", Severity::Note),
            note(None, "nothing is kept", Severity::Note),
            note(Some("b"), "ends at 700 nm", Severity::Note),
            note(Some("c"), "ends at 700 nm", Severity::Warning),
            note(Some("d"), "nothing is kept", Severity::Note),
        ];
        let lines: Vec<String> = grouped(&notes).iter().map(ToString::to_string).collect();
        let expected = ["a, b: ends at 700 nm (2 times)", "nothing is kept", "c: ends at 700 nm", "d: nothing is kept"];
        assert_eq!(lines, expected);
    }

    #[test]
    fn equal_remarks_are_counted() {
        let twice = Note { count: 2, ..note(None, "nothing is kept", Severity::Note) };
        let notes = [twice, note(None, "nothing is kept", Severity::Note)];
        let groups = grouped(&notes);
        assert_eq!((groups.len(), groups[0].count()), (1, 3));
        assert_eq!(groups[0].to_string(), "nothing is kept (3 times)");
    }
}
