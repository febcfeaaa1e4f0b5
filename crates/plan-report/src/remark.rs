//! Notes and warnings of compilation.

use etendue_pipeline::Plan;
use etendue_pipeline::remark::{Weight, grouped};

/// A note or warning, without duplicates.
#[derive(Clone, Debug, serde::Serialize)]
pub struct RemarkReport {
    /// Text, without a full stop.
    pub text: String,
    /// Files, places or objects that it concerns; empty if the text names them or it concerns the whole job.
    pub about: Vec<String>,
    /// Number of occurrences.
    pub count: usize,
    /// Severity.
    pub weight: RemarkWeight,
}

/// Severity of a note or warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RemarkWeight {
    /// States how an input was read or extrapolated.
    Note,
    /// The image may differ from what the user expects of the description.
    Warning,
}

impl RemarkReport {
    pub(super) fn all(plan: &Plan) -> Vec<Self> {
        let groups = grouped(&plan.remarks).into_iter();
        let of = groups.map(|group| Self {
            text: group.text().to_owned(),
            about: group.about().iter().map(|&about| about.to_owned()).collect(),
            count: group.count(),
            weight: match group.weight {
                Weight::Note => RemarkWeight::Note,
                Weight::Warning => RemarkWeight::Warning,
            },
        });
        of.collect()
    }
}
