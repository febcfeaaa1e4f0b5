//! What decides how many samples a pixel gets: "spp", "passes" or "noise_threshold".
//!
//! One of them counts. A camera's own choice stands in the place of the job's; what the command line says, in the place of what files say. Two
//! in one record exclude each other.

use crate::fault::Faults;
use crate::place::{Place, Placed};
use crate::record::Render;

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
    fn place(self, render: &Render) -> Option<&Place> {
        match self {
            Self::Noise => render.noise_threshold.as_ref().map(|limit| &limit.place),
            Self::Passes => render.passes.first().map(|pass| &pass.place),
            Self::Spp => render.spp.as_ref().map(|spp| &spp.place),
        }
    }

    fn is_of_command_line(self, render: &Render) -> bool {
        self.place(render).is_some_and(Place::is_command_line)
    }

    /// Takes it out of a record.
    fn remove(self, render: &mut Render) {
        match self {
            Self::Noise => (render.noise_threshold, render.min_spp, render.max_spp) = (None, None, None),
            Self::Passes => render.passes.clear(),
            Self::Spp => render.spp = None,
        }
    }

    /// Which of them counts in a record.
    fn in_force(render: &Render) -> Option<Self> {
        let stated = Self::ALL.into_iter().filter(|choice| choice.place(render).is_some());
        let by_command_line = stated.clone().find(|choice| choice.is_of_command_line(render));
        by_command_line.or_else(|| stated.clone().next())
    }
}

impl Render {
    /// The limit of noise, where it decides the samples: the command line's "spp" or "passes" supersede that of a file.
    #[must_use]
    pub fn threshold_in_force(&self) -> Option<&Placed<f64>> {
        self.noise_threshold.as_ref().filter(|_| Choice::in_force(self) == Some(Choice::Noise))
    }

    /// The passes, where they are stated and count.
    #[must_use]
    pub fn passes_in_force(&self) -> Option<&[Placed<f64>]> {
        (Choice::in_force(self) == Some(Choice::Passes)).then_some(&self.passes[..])
    }
}

/// Leaves a camera's record and the job's without what the other's choice stands in the place of.
pub(super) fn choose(own: &mut Render, base: &mut Render) {
    let is_stated = |choice: Choice, render: &Render| choice.place(render).is_some();
    if let Some(choice) = Choice::ALL.into_iter().find(|choice| is_stated(*choice, own)) {
        for other in Choice::ALL.into_iter().filter(|other| *other != choice) {
            if !other.is_of_command_line(base) {
                other.remove(base);
            }
        }
    }
    if Choice::Noise.is_of_command_line(base) {
        own.noise_threshold = None;
    }
    if Choice::Passes.is_of_command_line(base) {
        own.passes.clear();
        // Those of the passes.
        if base.replicates.as_ref().is_some_and(|given| given.place.is_command_line()) {
            own.replicates = None;
        }
    }
}

/// Checks a record into which the job's has been merged.
pub(super) fn check(render: &Render, faults: &mut Faults) {
    if let Some(choice) = Choice::in_force(render) {
        Choice::ALL
            .into_iter()
            .filter(|other| *other != choice)
            .for_each(|other| refuse(other, choice, render, faults));
    }
    let keys = [("min_spp", &render.min_spp), ("max_spp", &render.max_spp)];
    let keys = keys.into_iter().filter(|_| render.threshold_in_force().is_none());
    for (key, value) in keys.filter_map(|(key, value)| Some((key, value.as_ref()?))) {
        let problem = format!("\"{key}\" has no effect without \"noise_threshold\"");
        let cause = Choice::in_force(render).and_then(|choice| choice.place(render));
        faults.add_idle((key, &value.place), cause, problem, "add it, or remove the key");
    }
}

/// Refuses a choice beside the one that counts.
fn refuse(other: Choice, choice: Choice, render: &Render, faults: &mut Faults) {
    let Some(place) = other.place(render) else { return };
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
    faults.add_idle((other.key(), place), choice.place(render), problem.into(), "remove one of them");
}
