//! What a path carries: what roulette goes by (`roulette.rs`).

/// The chance of a path to go on, over the share that is left of what it carried behind the first surface.
const CHANCE_PER_SHARE: f32 = 1.5;

/// What a path carries, by which its chance to go on is found.
#[derive(Clone, Copy)]
pub(super) struct Carried {
    /// Beside the throughput: what that was when it was last set to one.
    prior: f32,
    /// Behind the first surface that is no mirror.
    first: Option<f32>,
}

impl Default for Carried {
    fn default() -> Self {
        Self { prior: 1.0, first: None }
    }
}

impl Carried {
    /// More, or less, beside the throughput.
    pub(super) fn scale(&mut self, factor: f32) {
        self.prior *= factor;
    }

    /// The chance to go on of a path that has been scattered by more than mirrors; 1 or more: it does, as it does where nothing is told (NaN).
    pub(super) fn chance(&mut self, throughput: f32) -> f32 {
        let now = self.prior * throughput;
        CHANCE_PER_SHARE * (now / *self.first.get_or_insert(now))
    }
}
