//! What compiling found that is no fault but worth saying.

use std::fmt::{self, Display, Formatter};

/// How much a remark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// How something was read or continued. The plan says it.
    Note,
    /// The picture is not what the description might be taken to ask for. The plan says it, and a rendering repeats it.
    Warning,
}

/// A remark on a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// The file, the place or the thing that it concerns; `None` where the text names it or it concerns the whole.
    pub about: Option<String>,
    /// The remark, without a full stop.
    pub text: String,
    /// How much it matters.
    pub weight: Weight,
}

/// Remarks of one text, told once with all that they concern.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grouped<'a> {
    about: Vec<&'a str>,
    text: &'a str,
    /// How much they matter.
    pub weight: Weight,
}

impl Display for Grouped<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.about.as_slice() {
            [] => f.write_str(self.text),
            names => write!(f, "{}: {}", names.join(", "), self.text),
        }
    }
}

/// Remarks by their text, in the order in which each was first made.
#[must_use]
pub fn grouped(remarks: &[Remark]) -> Vec<Grouped<'_>> {
    let mut groups: Vec<Grouped<'_>> = Vec::new();
    for Remark { about, text, weight } in remarks {
        let same = |group: &&mut Grouped<'_>| group.text == text && group.weight == *weight;
        match (groups.iter_mut().find(same), about) {
            (Some(group), Some(name)) if !group.about.is_empty() => group.about.push(name),
            (Some(group), None) if group.about.is_empty() => {}
            _ => groups.push(Grouped { about: about.iter().map(String::as_str).collect(), text, weight: *weight }),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn remark(about: Option<&str>, text: &str, weight: Weight) -> Remark {
        Remark { about: about.map(str::to_owned), text: text.to_owned(), weight }
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
        assert_eq!(told, ["a, b: ends at 700 nm", "nothing is kept", "c: ends at 700 nm", "d: nothing is kept"]);
    }
}
