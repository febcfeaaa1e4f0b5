//! Notes and warnings of compilation.

use etendue_pipeline::Plan;
use etendue_pipeline::note::{Severity, grouped};

/// A note or warning, without duplicates.
#[derive(Clone, Debug, serde::Serialize)]
pub struct NoteReport {
    /// Text, without a full stop.
    pub text: String,
    /// Files, places or objects that it concerns; empty if the text names them or it concerns the whole job.
    pub about: Vec<String>,
    /// Number of occurrences.
    pub count: usize,
    /// Severity.
    pub weight: NoteSeverity,
}

/// Severity of a note or warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum NoteSeverity {
    /// States how an input was read or extrapolated.
    Note,
    /// The image may differ from what the user expects of the description.
    Warning,
}

impl NoteReport {
    pub(super) fn notes_of_plan(plan: &Plan) -> Vec<Self> {
        let groups = grouped(&plan.notes).into_iter();
        let of = groups.map(|group| Self {
            text: group.text().to_owned(),
            about: group.subjects().iter().map(|&subject| subject.to_owned()).collect(),
            count: group.count(),
            weight: match group.weight {
                Severity::Note => NoteSeverity::Note,
                Severity::Warning => NoteSeverity::Warning,
            },
        });
        of.collect()
    }
}
