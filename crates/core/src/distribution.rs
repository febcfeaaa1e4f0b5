//! Piecewise-constant distributions in one and two dimensions, sampled by inversion.

use glam::Vec2;

/// A piecewise-constant density over [0, 1), from non-negative weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution1 {
    weights: Vec<f32>,
    /// `cumulative[i]` = fraction of the weights before `i`; one more entry than weights; the last is exactly 1.
    cumulative: Vec<f64>,
    /// Guide table: for each of as many equal steps of `u` as there are pieces, the piece in which the step begins.
    guide: Vec<u32>,
    /// Last piece of positive weight.
    last: usize,
    mean: f64,
    per_mean: f64,
    per_piece: f64,
}

impl Distribution1 {
    /// Returns the distribution over `weights`. `None` if there are none, one is negative or not finite, or all are zero.
    #[must_use]
    pub fn new(weights: Vec<f32>) -> Option<Self> {
        if !weights.iter().all(|w| w.is_finite() && *w >= 0.0) {
            return None;
        }
        let total: f64 = weights.iter().map(|w| f64::from(*w)).sum();
        if total <= 0.0 {
            return None;
        }
        let mut sum = 0.0;
        let mut cumulative: Vec<f64> = Vec::with_capacity(weights.len() + 1);
        for w in &weights {
            cumulative.push(sum / total);
            sum += f64::from(*w);
        }
        cumulative.push(1.0);
        let mean = total / weights.len() as f64;
        let last = weights.iter().rposition(|w| *w > 0.0)?;
        let (per_mean, per_piece) = (1.0 / mean, 1.0 / weights.len() as f64);
        Some(Self { guide: guide(&cumulative), weights, cumulative, last, mean, per_mean, per_piece })
    }

    /// Number of pieces.
    #[must_use]
    pub fn len(&self) -> usize {
        self.weights.len()
    }

    /// Never true: an empty distribution cannot be made.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }

    /// Mean of the weights.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Probability of piece `i`.
    #[must_use]
    pub fn probability(&self, i: usize) -> f32 {
        (f64::from(self.weights[i]) / (self.mean * self.weights.len() as f64)) as f32
    }

    /// Returns the piece that contains `u` in [0, 1) and the position of `u` within it, in [0, 1). Never a piece of zero weight.
    #[must_use]
    pub fn sample_discrete(&self, u: f32) -> (usize, f32) {
        let u = f64::from(u);
        let step = ((u * self.guide.len() as f64) as usize).min(self.guide.len() - 1);
        let mut i = self.guide[step] as usize;
        while i < self.last && self.cumulative[i + 1] <= u {
            i += 1;
        }
        let i = i.min(self.last);
        let (low, high) = (self.cumulative[i], self.cumulative[i + 1]);
        let within = if high > low { ((u - low) / (high - low)) as f32 } else { 0.0 };
        (i, within.clamp(0.0, ONE_BELOW))
    }

    /// Samples per point of [0, 1); returns it with its density.
    #[must_use]
    pub fn sample(&self, u: f32) -> (f32, f32) {
        let (i, within) = self.sample_discrete(u);
        (self.point(i, within), self.pdf_of_piece(i))
    }

    /// Density at `x` in [0, 1).
    #[must_use]
    pub fn pdf(&self, x: f32) -> f32 {
        self.pdf_of_piece(piece(x, self.len()))
    }

    /// Returns the point at `within` of piece `i`. Rounding never moves it into another piece.
    fn point(&self, i: usize, within: f32) -> f32 {
        let pieces = self.len() as f64;
        let x = ((i as f64 + f64::from(within)) * self.per_piece) as f32;
        // Exact: 24 bits times the number of pieces.
        let place = f64::from(x) * pieces;
        if place >= (i + 1) as f64 {
            x.next_down()
        } else if place < i as f64 {
            x.next_up()
        } else {
            x
        }
    }

    fn pdf_of_piece(&self, i: usize) -> f32 {
        (f64::from(self.weights[i]) * self.per_mean) as f32
    }
}

/// Returns the guide table (Chen and Asau 1974): for each step the entry of the cumulative table at which the search begins.
fn guide(cumulative: &[f64]) -> Vec<u32> {
    let pieces = cumulative.len() - 1;
    let mut i = 0;
    let begin = |step: usize| {
        let u = step as f64 / pieces as f64;
        while i + 1 < pieces && cumulative[i + 1] <= u {
            i += 1;
        }
        i as u32
    };
    (0..pieces).map(begin).collect()
}

/// Returns the index of the piece, of equal pieces of [0, 1), that contains `x`; without rounding.
fn piece(x: f32, pieces: usize) -> usize {
    ((f64::from(x) * pieces as f64) as usize).min(pieces - 1)
}

/// The largest `f32` below one.
const ONE_BELOW: f32 = 1.0 - f32::EPSILON / 2.0;

/// A piecewise-constant density over the unit square, from non-negative weights row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution2 {
    rows: Vec<Option<Distribution1>>,
    marginal: Distribution1,
    columns: usize,
}

impl Distribution2 {
    /// Returns the distribution over `weights` in rows of `columns`. `None` if they do not fill rows, one is negative or not finite, or all are zero.
    #[must_use]
    pub fn new(columns: usize, weights: &[f32]) -> Option<Self> {
        if columns == 0 || !weights.len().is_multiple_of(columns) || weights.iter().any(|w| !w.is_finite() || *w < 0.0)
        {
            return None;
        }
        let rows: Vec<_> = weights.chunks(columns).map(|row| Distribution1::new(row.to_vec())).collect();
        let marginal = rows.iter().map(|row| row.as_ref().map_or(0.0, |r| r.mean() as f32)).collect();
        Some(Self { marginal: Distribution1::new(marginal)?, rows, columns })
    }

    /// Mean of the weights.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.marginal.mean()
    }

    /// Columns of the grid.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Samples per point of the unit square (x along a row, y across rows); returns it with its density by area.
    #[must_use]
    pub fn sample(&self, u: Vec2) -> (Vec2, f32) {
        let (i, within) = self.marginal.sample_discrete(u.y);
        let (y, y_pdf) = (self.marginal.point(i, within), self.marginal.pdf_of_piece(i));
        // A row without weights is never sampled.
        let (x, x_pdf) = self.rows[i].as_ref().map_or((u.x, 0.0), |row| row.sample(u.x));
        (Vec2::new(x, y), x_pdf * y_pdf)
    }

    /// Density by area at a point of the unit square.
    #[must_use]
    pub fn pdf(&self, p: Vec2) -> f32 {
        self.rows[piece(p.y, self.rows.len())].as_ref().map_or(0.0, |r| r.pdf(p.x) * self.marginal.pdf(p.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_sampled_by_weight_and_zero_ones_never() {
        let d = Distribution1::new(vec![0.0, 1.0, 0.0, 3.0, 0.0]).expect("weights");
        let mut counts = [0; 5];
        for i in 0..1000 {
            counts[d.sample_discrete((i as f32 + 0.5) / 1000.0).0] += 1;
        }
        assert_eq!(counts, [0, 250, 0, 750, 0]);
        assert_eq!(d.sample_discrete(ONE_BELOW).0, 3);
        assert_eq!(d.sample_discrete(0.0).0, 1);
        assert!((d.probability(3) - 0.75).abs() < 1e-7);
    }

    #[test]
    fn the_guide_leads_to_the_piece_that_a_search_finds() {
        let weights: Vec<f32> = (0..97).map(|i| if i % 5 == 0 { 0.0 } else { ((i * 37) % 23) as f32 }).collect();
        let d = Distribution1::new(weights).expect("weights");
        for i in 0..100_000 {
            let u = i as f32 / 100_000.0;
            let searched = d.cumulative.partition_point(|c| *c <= f64::from(u)) - 1;
            assert_eq!(d.sample_discrete(u).0, searched.min(d.last), "{u}");
        }
    }

    #[test]
    fn points_stay_in_their_piece_at_both_of_its_ends() {
        for n in [3, 49, 1000, 4095, 4096, 65536] {
            let d = Distribution1::new((0..n).map(|i| ((i + 1) % 2) as f32).collect()).expect("weights");
            for i in (0..n).step_by(2) {
                for u in [d.cumulative[i] as f32, (d.cumulative[i + 1] as f32).next_down()] {
                    let (x, pdf) = d.sample(u);
                    assert!(pdf > 0.0 && d.pdf(x) == pdf, "{n} pieces, {i}, {u}: {x} has {} for {pdf}", d.pdf(x));
                }
                for within in [0.0, 0.5, ONE_BELOW] {
                    assert_eq!(piece(d.point(i, within), n), i, "{n} pieces, {within}");
                }
            }
            assert!(d.point(n - 1, ONE_BELOW) < 1.0);
        }
    }

    #[test]
    fn rows_without_weights_are_never_sampled() {
        let rows = 4096;
        let weights: Vec<f32> = (0..rows).flat_map(|row| [((row + 1) % 2) as f32, 0.0]).collect();
        let d = Distribution2::new(2, &weights).expect("weights");
        for row in (0..rows).step_by(2) {
            let y = (d.marginal.cumulative[row + 1] as f32).next_down();
            let (p, pdf) = d.sample(Vec2::new(ONE_BELOW, y));
            assert!(pdf > 0.0 && d.pdf(p) == pdf && p.x < 0.5, "{row}: {p}");
        }
    }

    #[test]
    fn densities_are_those_of_the_samples() {
        let d = Distribution2::new(3, &[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 4.0, 5.0, 6.0]).expect("weights");
        let mut sum = 0.0;
        for i in 0..90 {
            for j in 0..90 {
                sum += d.pdf(Vec2::new((i as f32 + 0.5) / 90.0, (j as f32 + 0.5) / 90.0)) / 8100.0;
                let (p, pdf) = d.sample(Vec2::new((i as f32 + 0.5) / 90.0, (j as f32 + 0.5) / 90.0));
                assert!((pdf - d.pdf(p)).abs() < 1e-4 && pdf > 0.0);
            }
        }
        assert!((sum - 1.0).abs() < 1e-4);
    }

    #[test]
    fn weights_that_are_none_are_refused() {
        assert!(Distribution1::new(vec![]).is_none());
        assert!(Distribution1::new(vec![0.0]).is_none());
        assert!(Distribution1::new(vec![f32::NAN, 1.0]).is_none());
        assert!(Distribution2::new(2, &[1.0, 2.0, 3.0]).is_none());
    }
}
