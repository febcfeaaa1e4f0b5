//! What decides how many samples a pixel gets: "spp", "passes" or "noise_threshold".
//!
//! One of them counts. A camera's own choice stands in the place of the job's; what the command line says, in the place of what files say. Two
//! in one record exclude each other.

use crate::fault::{ErrorCode, Faults};
use crate::place::{Place, Placed};

/// What a record says of samples.
#[derive(Clone, Debug)]
pub(super) struct SampleKeys {
    pub(super) spp: Option<Placed<u64>>,
    pub(super) passes: Vec<Placed<f64>>,
    pub(super) replicates: Option<Placed<u64>>,
    pub(super) noise_threshold: Option<Placed<f64>>,
    pub(super) min_spp: Option<Placed<u64>>,
    pub(super) max_spp: Option<Placed<u64>>,
}

/// What decides the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Noise,
    Passes,
    Spp,
}

impl Choice {
    /// In the order in which they count where a record, which is then refused, says several.
    const ALL: [Self; 3] = [Self::Noise, Self::Passes, Self::Spp];

    fn key(self) -> &'static str {
        match self {
            Self::Noise => "noise_threshold",
            Self::Passes => "passes",
            Self::Spp => "spp",
        }
    }

    /// Where a record says it.
    fn place(self, keys: &SampleKeys) -> Option<&Place> {
        match self {
            Self::Noise => keys.noise_threshold.as_ref().map(|limit| &limit.place),
            Self::Passes => keys.passes.first().map(|pass| &pass.place),
            Self::Spp => keys.spp.as_ref().map(|spp| &spp.place),
        }
    }

    fn is_of_command_line(self, keys: &SampleKeys) -> bool {
        self.place(keys).is_some_and(Place::is_command_line)
    }

    /// Takes it out of a record.
    fn remove(self, keys: &mut SampleKeys) {
        match self {
            Self::Noise => (keys.noise_threshold, keys.min_spp, keys.max_spp) = (None, None, None),
            Self::Passes => keys.passes.clear(),
            Self::Spp => keys.spp = None,
        }
    }

    /// Which of them counts in a record.
    fn in_force(keys: &SampleKeys) -> Option<Self> {
        let stated = Self::ALL.into_iter().filter(|choice| choice.place(keys).is_some());
        let by_command_line = stated.clone().find(|choice| choice.is_of_command_line(keys));
        by_command_line.or_else(|| stated.clone().next())
    }
}

impl SampleKeys {
    /// Whether noise decides the samples: the command line's "spp" or "passes" supersede the limit of a file.
    pub(super) fn has_threshold_in_force(&self) -> bool {
        Choice::in_force(self) == Some(Choice::Noise)
    }

    /// Whether the passes that are stated count.
    pub(super) fn has_passes_in_force(&self) -> bool {
        Choice::in_force(self) == Some(Choice::Passes)
    }

    /// What a camera's record says, and the job's where it is silent.
    pub(super) fn over(self, base: Self) -> Self {
        let (mut own, mut base) = (self, base);
        if let Some(choice) = Choice::ALL.into_iter().find(|choice| choice.place(&own).is_some()) {
            for other in Choice::ALL.into_iter().filter(|other| *other != choice) {
                if !other.is_of_command_line(&base) {
                    other.remove(&mut base);
                }
            }
        }
        if Choice::Noise.is_of_command_line(&base) {
            own.noise_threshold = None;
        }
        if Choice::Passes.is_of_command_line(&base) {
            own.passes.clear();
            // Those of the passes.
            if base.replicates.as_ref().is_some_and(|given| given.place.is_command_line()) {
                own.replicates = None;
            }
        }
        Self {
            spp: own.spp.or(base.spp),
            passes: if own.passes.is_empty() { base.passes } else { own.passes },
            replicates: own.replicates.or(base.replicates),
            noise_threshold: own.noise_threshold.or(base.noise_threshold),
            min_spp: own.min_spp.or(base.min_spp),
            max_spp: own.max_spp.or(base.max_spp),
        }
    }

    /// Checks a record into which the job's has been merged.
    pub(super) fn check(&self, faults: &mut Faults) {
        if let Some(choice) = Choice::in_force(self) {
            let others = Choice::ALL.into_iter().filter(|other| *other != choice);
            others.for_each(|other| refuse(other, choice, self, faults));
        }
        let keys = [("min_spp", &self.min_spp), ("max_spp", &self.max_spp)];
        let keys = keys.into_iter().filter(|_| !self.has_threshold_in_force());
        for (key, value) in keys.filter_map(|(key, value)| Some((key, value.as_ref()?))) {
            let problem = format!("\"{key}\" has no effect without \"noise_threshold\"");
            let cause = Choice::in_force(self).and_then(|choice| choice.place(self));
            faults.add_idle(ErrorCode::NoEffect, key, &value.place, cause, problem, "add it, or remove the key");
        }
    }
}

/// Refuses a choice beside the one that counts.
fn refuse(other: Choice, choice: Choice, keys: &SampleKeys, faults: &mut Faults) {
    let Some(place) = other.place(keys) else { return };
    let problem = match (other, choice) {
        (Choice::Spp, Choice::Passes) | (Choice::Passes, Choice::Spp) => {
            "\"spp\" and \"passes\" exclude each other: the samples of a pixel are the sum of its passes"
        }
        (Choice::Noise, Choice::Passes) | (Choice::Passes, Choice::Noise) => {
            "\"passes\" and \"noise_threshold\" exclude each other: so many samples everywhere, or as many as a pixel needs"
        }
        _ => {
            "\"spp\" and \"noise_threshold\" exclude each other: so many samples everywhere, or as many as a pixel needs"
        }
    };
    faults.add_idle(
        ErrorCode::Contradiction,
        other.key(),
        place,
        choice.place(keys),
        problem.into(),
        "remove one of them",
    );
}
