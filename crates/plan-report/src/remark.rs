//! What compiling found that is no fault but worth saying.

use etendue_pipeline::Plan;
use etendue_pipeline::remark::{Weight, grouped};

/// A remark, equal ones once.
#[derive(Clone, Debug, serde::Serialize)]
pub struct RemarkReport {
    /// The remark, without a full stop.
    pub text: String,
    /// The files, places or things that it concerns; empty where the text names them or it concerns the whole.
    pub about: Vec<String>,
    /// How often it was made.
    pub count: usize,
    /// How much it matters.
    pub weight: RemarkWeight,
}

/// How much a remark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RemarkWeight {
    /// How something was read or continued.
    Note,
    /// The picture is not what the description might be taken to ask for.
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
