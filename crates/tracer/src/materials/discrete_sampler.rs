//! Choosing one of a few lobes by weight.

/// Probabilities of `K` lobes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DiscreteSampler<const K: usize>([f32; K]);

impl<const K: usize> DiscreteSampler<K> {
    /// Probabilities in proportion to `shares` (0 or more); `None` where all are zero.
    pub(super) fn new(shares: [f32; K]) -> Option<Self> {
        let total: f32 = shares.iter().sum();
        (total > 0.0).then(|| Self(shares.map(|s| s / total)))
    }

    /// Probability of lobe `k`.
    pub(super) fn of(&self, k: usize) -> f32 {
        self.0[k]
    }

    /// The lobe that `choice` in [0, 1) falls on; never one of no probability.
    pub(super) fn draw(&self, choice: f32) -> usize {
        let mut left = choice;
        let mut last = 0;
        for (k, p) in self.0.iter().enumerate().filter(|(_, p)| **p > 0.0) {
            last = k;
            if left < *p {
                break;
            }
            left -= p;
        }
        last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lobes_are_drawn_by_weight() {
        let discrete_sampler = DiscreteSampler::new([0.0, 1.0, 0.0, 3.0, 0.0]).expect("weights");
        let mut counts = [0; 5];
        (0..1000).for_each(|i| counts[discrete_sampler.draw((i as f32 + 0.5) / 1000.0)] += 1);
        assert_eq!(counts, [0, 250, 0, 750, 0]);
        assert_eq!(discrete_sampler.draw(0.999_999_94), 3);
        assert_eq!(discrete_sampler.of(3), 0.75);
        assert!(DiscreteSampler::new([0.0; 3]).is_none());
    }
}
