//! Several runs of one measurement.

/// How often everything is measured.
pub const COUNT: usize = 5;

/// What several runs measured.
#[derive(Clone, Debug, Default)]
pub struct RunStatistics(Vec<f64>);

impl RunStatistics {
    /// Notes one run.
    pub fn add(&mut self, value: f64) {
        self.0.push(value);
    }

    /// [`COUNT`] runs of `measure`.
    pub fn measure(mut measure: impl FnMut() -> f64) -> Self {
        Self((0..COUNT).map(|_| measure()).collect())
    }

    /// The run in the middle.
    pub fn median(&self) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    }

    /// Run by run, these values over those.
    #[must_use]
    pub fn over(&self, other: &Self) -> Self {
        Self(self.0.iter().zip(&other.0).map(|(a, b)| a / b).collect())
    }

    /// Distance of the farthest run from the middle one, as a share of it.
    pub fn spread(&self) -> f64 {
        let median = self.median();
        self.0.iter().map(|v| (v / median - 1.0).abs()).fold(0.0, f64::max)
    }

    /// Distance of the farthest run in words.
    pub fn spread_text(&self) -> String {
        format!("± {:.0} %", 100.0 * self.spread())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outlier_moves_the_spread_and_not_the_median() {
        let mut runs = RunStatistics::default();
        [3.0, 1.0, 2.0, 2.0, 5.0].into_iter().for_each(|v| runs.add(v));
        assert_eq!((runs.median(), runs.spread()), (2.0, 1.5));
    }
}
