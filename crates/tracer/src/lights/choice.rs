//! Which light to ask.
//!
//! By power, with a floor: one draw in twenty is uniform over the lights of a kind, so that a dim light beside the
//! point, or one outside the range that weighed it, is never lost. Lights at infinity and lights in the scene share
//! the draws equally, because their powers cannot be compared.

use etendue_core::distribution::Distribution1;

/// Share of the draws that are uniform.
const FLOOR: f64 = 0.05;

/// A fixed distribution over lights.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    distribution: Distribution1,
    probabilities: Vec<f32>,
}

impl Choice {
    /// Lights in the scene by power, then those at infinity by irradiance; `None` where there is none.
    pub(super) fn new(local: &[f64], distant: &[f64]) -> Option<Self> {
        let share = if local.is_empty() || distant.is_empty() { 1.0 } else { 0.5 };
        let weights = shares(local, share).chain(shares(distant, share)).collect();
        let distribution = Distribution1::new(weights)?;
        let probabilities = (0..distribution.len()).map(|i| distribution.probability(i)).collect();
        Some(Self { distribution, probabilities })
    }

    /// The light that `u` falls on, and its probability.
    pub(super) fn draw(&self, u: f32) -> (usize, f32) {
        let (i, _) = self.distribution.sample_discrete(u);
        (i, self.probabilities[i])
    }

    pub(super) fn probability(&self, i: usize) -> f32 {
        self.probabilities[i]
    }
}

fn shares(powers: &[f64], share: f64) -> impl Iterator<Item = f32> {
    let total: f64 = powers.iter().sum();
    let even = 1.0 / powers.len() as f64;
    powers.iter().map(move |power| {
        let by_power = if total > 0.0 && total.is_finite() { power / total } else { even };
        (share * (FLOOR * even + (1.0 - FLOOR) * by_power)) as f32
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_light_has_a_chance() {
        let choice = Choice::new(&[1e-30, 1e12, 0.0], &[5.0]).expect("four lights");
        let probabilities: Vec<_> = (0..4).map(|i| choice.probability(i)).collect();
        assert!(probabilities.iter().all(|p| *p > 0.005), "{probabilities:?}");
        assert!((probabilities.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        assert!((probabilities[3] - 0.5).abs() < 1e-6);
    }

    #[test]
    fn no_light_is_no_choice() {
        assert!(Choice::new(&[], &[]).is_none());
        assert_eq!(Choice::new(&[], &[0.0]).expect("one").draw(0.7), (0, 1.0));
    }
}
