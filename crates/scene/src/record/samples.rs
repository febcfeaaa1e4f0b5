//! Number of samples per pixel: "spp", "passes" or "noise_threshold".
//!
//! Only one of them counts. A camera's choice overrides the job's, and the command line overrides files. Two in one record exclude each other.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{integer, list, number, record};

/// Largest number of samples per pixel.
pub const MAX_SPP: u64 = 1 << 20;

record! {
    /// Number of samples.
    pub struct SampleKeys {
        /// Samples per pixel, a multiple of "replicates". Default: 64, or the quality preset's.
        optional spp: Placed<u64> = integer(1, MAX_SPP);
        /// Samples per pixel of at most 64 independent passes, averaged by weight: multiples of "replicates" (at least one), or fewer on part of the pixels.
        /// Excludes "spp". Default: one pass.
        many passes: Placed<f64> = list(number("").above(0.0).at_most(MAX_SPP as f64), 1);
        /// Independent replicates that estimate the variance. Default: 4, or 2 or 1 where "spp" is no multiple.
        optional replicates: Placed<u64> = integer(1, 1024);
        /// Adaptive sampling: maximum standard error of a pixel over its sensor noise (without electrons, its mean). Needs 5 replicates, by default 8.
        /// Excludes "spp". Default: off.
        optional noise_threshold: Placed<f64> = number("").above(0.0).at_most(100.0);
        /// With "noise_threshold": minimum samples, a multiple of "replicates". Default: 16.
        optional min_spp: Placed<u64> = integer(8, 65_536);
        /// With "noise_threshold": maximum samples, a multiple of "replicates". Default: 4 096.
        optional max_spp: Placed<u64> = integer(8, 1 << 20);
    }
}

/// The key that decides the number of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SampleKey {
    Noise,
    Passes,
    Spp,
}

impl SampleKey {
    /// Priority where a record, which is then refused, states several.
    const ALL: [Self; 3] = [Self::Noise, Self::Passes, Self::Spp];

    fn key(self) -> &'static str {
        match self {
            Self::Noise => "noise_threshold",
            Self::Passes => "passes",
            Self::Spp => "spp",
        }
    }

    /// Place in a record.
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

    /// Removes it from a record.
    fn remove(self, keys: &mut SampleKeys) {
        match self {
            Self::Noise => (keys.noise_threshold, keys.min_spp, keys.max_spp) = (None, None, None),
            Self::Passes => keys.passes.clear(),
            Self::Spp => keys.spp = None,
        }
    }

    /// The one that counts in a record.
    fn in_force(keys: &SampleKeys) -> Option<Self> {
        let stated_keys = Self::ALL.into_iter().filter(|choice| choice.place(keys).is_some());
        let by_command_line = stated_keys.clone().find(|choice| choice.is_of_command_line(keys));
        by_command_line.or_else(|| stated_keys.clone().next())
    }
}

impl SampleKeys {
    /// Noise threshold, where it decides the number of samples. "spp" or "passes" of the command line override that of a file.
    #[must_use]
    pub fn threshold_in_force(&self) -> Option<&Placed<f64>> {
        self.noise_threshold.as_ref().filter(|_| SampleKey::in_force(self) == Some(SampleKey::Noise))
    }

    /// Passes, where they are stated and count.
    #[must_use]
    pub fn passes_in_force(&self) -> Option<&[Placed<f64>]> {
        (SampleKey::in_force(self) == Some(SampleKey::Passes)).then_some(&self.passes[..])
    }

    /// Removes from a camera's keys and from `base`, the job's, those overridden by the other.
    pub(super) fn exclude(&mut self, base: &mut Self) {
        if let Some(choice) = SampleKey::ALL.into_iter().find(|choice| choice.place(self).is_some()) {
            for other in SampleKey::ALL.into_iter().filter(|other| *other != choice) {
                if !other.is_of_command_line(base) {
                    other.remove(base);
                }
            }
        }
        if SampleKey::Noise.is_of_command_line(base) {
            self.noise_threshold = None;
        }
        if SampleKey::Passes.is_of_command_line(base) {
            self.passes.clear();
            // The replicates belong to the passes.
            if base.replicates.as_ref().is_some_and(|key| key.place.is_command_line()) {
                self.replicates = None;
            }
        }
    }

    /// Checks a record into which the job's has been merged.
    pub(super) fn check(&self, errors: &mut DescriptionErrors) {
        if let Some(choice) = SampleKey::in_force(self) {
            let others = SampleKey::ALL.into_iter().filter(|other| *other != choice);
            others.for_each(|other| refuse(other, choice, self, errors));
        }
        let keys = [("min_spp", &self.min_spp), ("max_spp", &self.max_spp)];
        let keys = keys.into_iter().filter(|_| self.threshold_in_force().is_none());
        for (key, value) in keys.filter_map(|(key, value)| Some((key, value.as_ref()?))) {
            let problem = format!("\"{key}\" has no effect without \"noise_threshold\"");
            let cause = SampleKey::in_force(self).and_then(|choice| choice.place(self));
            errors.add_without_effect(
                ErrorCode::NoEffect,
                key,
                &value.place,
                cause,
                problem,
                "add it, or remove the key",
            );
        }
    }
}

/// Refuses a choice that conflicts with the one that counts.
fn refuse(other: SampleKey, choice: SampleKey, keys: &SampleKeys, errors: &mut DescriptionErrors) {
    let Some(place) = other.place(keys) else { return };
    let problem = match (other, choice) {
        (SampleKey::Spp, SampleKey::Passes) | (SampleKey::Passes, SampleKey::Spp) => {
            "\"spp\" and \"passes\" exclude each other: the samples of a pixel are the sum of its passes"
        }
        (SampleKey::Noise, SampleKey::Passes) | (SampleKey::Passes, SampleKey::Noise) => {
            "\"passes\" and \"noise_threshold\" exclude each other: a fixed number of samples, or as many as each pixel needs"
        }
        _ => {
            "\"spp\" and \"noise_threshold\" exclude each other: a fixed number of samples, or as many as each pixel needs"
        }
    };
    errors.add_without_effect(
        ErrorCode::Contradiction,
        other.key(),
        place,
        choice.place(keys),
        problem.into(),
        "remove one of them",
    );
}
