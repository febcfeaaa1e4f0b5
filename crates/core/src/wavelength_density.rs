//! Density of wavelengths with fast sampling.

use crate::Wavelengths;

/// Minimum number of guide steps per piece: most steps begin and end in one piece.
const STEPS_PER_PIECE: usize = 16;
/// Maximum number of pieces that the guide can address.
const MAX_PIECES: usize = 1 << 16;
/// Numbers in [0, 1) are multiples of its inverse.
const GRID: f64 = 16_777_216.0;

/// Piecewise-constant density over a range of wavelengths, from weights of equal pieces of it.
///
/// Sampled by inversion: a guide table (Chen and Asau 1974) finds the piece. The probabilities of the pieces are rounded to multiples of 2⁻²⁴, the resolution
/// of the random numbers. Densities are those of the rounded probabilities: exactly the ones by which wavelengths are sampled. A piece of less than half of
/// that resolution is never sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct WavelengthDensity {
    pieces: Vec<DensityPiece>,
    /// Guide table: for each of equal steps of [0, 1), a power of two of them, the piece that contains its beginning.
    guide: Vec<u16>,
}

/// Piece of nonzero probability.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DensityPiece {
    /// Numbers from `begin` to `end` sample it.
    begin: f32,
    end: f32,
    /// Wavelengths of the piece, nm; both ends belong to it.
    low_nm: f32,
    high_nm: f32,
    nm_per_number: f32,
    /// Density, 1/nm.
    pdf: f32,
}

impl WavelengthDensity {
    /// Returns the density over `[low_nm, high_nm)`. `None` if there are no weights or more than 65 536, one is negative or not finite, or all are zero.
    #[must_use]
    pub fn new(weights: &[f32], low_nm: f32, high_nm: f32) -> Option<Self> {
        let total: f64 = weights.iter().map(|w| f64::from(*w)).sum();
        let legal = weights.iter().all(|w| *w >= 0.0) && total > 0.0 && total.is_finite();
        if !legal || weights.len() > MAX_PIECES {
            return None;
        }
        let step_nm = (f64::from(high_nm) - f64::from(low_nm)) / weights.len() as f64;
        let edge_nm = |i: usize| (f64::from(low_nm) + step_nm * i as f64) as f32;
        let (mut pieces, mut sum, mut begin) = (Vec::with_capacity(weights.len()), 0.0, 0.0);
        for (i, weight) in weights.iter().enumerate() {
            sum += f64::from(*weight);
            let end = (sum / total * GRID).round() / GRID;
            if end > begin {
                pieces.push(DensityPiece::new(begin, end, edge_nm(i), edge_nm(i + 1)));
                begin = end;
            }
        }
        Some(Self { guide: guide(&pieces, (STEPS_PER_PIECE * weights.len()).next_power_of_two()), pieces })
    }

    /// Samples `N` wavelengths from one number `u` in [0, 1) and its rotations.
    #[must_use]
    #[inline]
    pub fn sample<const N: usize>(&self, u: f32) -> Wavelengths<N> {
        let (mut nm, mut pdf) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            (nm[i], pdf[i]) = self.sample_one(crate::wavelength::turned(u, i, N));
        }
        Wavelengths { nm, pdf }
    }

    #[inline]
    fn sample_one(&self, u: f32) -> (f32, f32) {
        // Exact: the steps are a power of two.
        let step = ((u * self.guide.len() as f32) as usize).min(self.guide.len() - 1);
        let mut i = usize::from(self.guide[step]);
        while self.pieces[i].end <= u && i + 1 < self.pieces.len() {
            i += 1;
        }
        let piece = &self.pieces[i];
        let nm = piece.low_nm + (u - piece.begin) * piece.nm_per_number;
        (nm.clamp(piece.low_nm, piece.high_nm), piece.pdf)
    }

    /// The density at a wavelength, 1/nm.
    #[inline]
    #[must_use]
    pub fn pdf(&self, nm: f32) -> f32 {
        let piece = self.pieces.iter().find(|piece| (piece.low_nm..=piece.high_nm).contains(&nm));
        piece.map_or(0.0, |piece| piece.pdf)
    }
}

impl DensityPiece {
    fn new(begin: f64, end: f64, low_nm: f32, next_nm: f32) -> Self {
        let width_nm = f64::from(next_nm) - f64::from(low_nm);
        Self {
            begin: begin as f32,
            end: end as f32,
            low_nm,
            high_nm: next_nm.next_down(),
            nm_per_number: (width_nm / (end - begin)) as f32,
            pdf: ((end - begin) / width_nm) as f32,
        }
    }
}

#[inline]
fn guide(pieces: &[DensityPiece], steps: usize) -> Vec<u16> {
    let begin = |step: usize| {
        let u = step as f64 / steps as f64;
        pieces.partition_point(|piece| f64::from(piece.end) <= u) as u16
    };
    (0..steps).map(begin).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavelengths_fall_into_pieces_by_weight() {
        let density = WavelengthDensity::new(&[1.0, 0.0, 3.0, 4.0], 400.0, 800.0).expect("weights");
        let n = 1 << 12;
        let mut counts = [0; 4];
        for i in 0..n {
            let sampled = density.sample::<1>(i as f32 / n as f32);
            counts[((sampled.nm[0] - 400.0) / 100.0) as usize] += 1;
            assert_eq!(sampled.pdf[0], density.pdf(sampled.nm[0]));
        }
        assert_eq!(counts, [n / 8, 0, 3 * n / 8, n / 2]);
        assert_eq!(
            [450.0, 550.0, 650.0, 750.0, 850.0].map(|nm| density.pdf(nm)),
            [0.001_25, 0.0, 0.003_75, 0.005, 0.0]
        );
    }

    /// The piece of a number is the first whose end lies beyond it, also for coarse guide steps.
    #[test]
    fn the_guide_leads_to_the_piece_that_a_search_finds() {
        let weights: Vec<f32> = (0..94).map(|i| if i % 7 == 0 { 1e-3 } else { ((i * 37) % 23) as f32 }).collect();
        let density = WavelengthDensity::new(&weights, 360.0, 830.0).expect("weights");
        let grain = (1.0 / GRID) as f32;
        let edges = density.pieces.iter().flat_map(|p| [p.begin, p.end - grain]);
        for u in edges.chain((0..100_000).map(|i| i as f32 / 100_000.0)) {
            let piece = density.pieces.iter().find(|p| p.end > u).expect("the last one ends at 1");
            let sampled = density.sample::<1>(u);
            assert!((piece.low_nm..=piece.high_nm).contains(&sampled.nm[0]), "{u}: {sampled:?}");
            assert_eq!(sampled.pdf[0], piece.pdf);
        }
    }

    #[test]
    fn the_density_is_one_in_all_and_that_of_the_weights() {
        let weights: Vec<f32> = (0..47).map(|i| 0.05 + (i % 11) as f32).collect();
        let density = WavelengthDensity::new(&weights, 300.0, 1100.0).expect("weights");
        let total: f32 = weights.iter().sum();
        let mut sum = 0.0;
        for (piece, weight) in density.pieces.iter().zip(&weights) {
            let fraction = f64::from(piece.pdf) * 800.0 / 47.0;
            sum += fraction;
            // Half of the resolution at either end, and edges of some 17 nm rounded to f32: each by 3e-5 nm at most.
            assert!((fraction - f64::from(weight / total)).abs() < 1.0 / GRID + 4e-6 * fraction + 1e-9);
        }
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    }

    #[test]
    fn sampled_wavelengths_estimate_an_integral_by_their_density() {
        let density = WavelengthDensity::new(&[1.0, 0.0, 3.0, 4.0], 400.0, 800.0).expect("weights");
        let mut sum = 0.0;
        for i in 0..256 {
            let w = density.sample::<4>((i as f32 + 0.5) / 256.0);
            for (nm, pdf) in w.nm.iter().zip(w.pdf) {
                sum += f64::from(*nm) / f64::from(pdf) / 1024.0;
            }
        }
        // ∫ λ dλ over the three pieces of nonzero weight; the midpoint rule is exact except for rounding.
        let exact = 450.0 * 100.0 + 700.0 * 200.0;
        assert!((sum / exact - 1.0).abs() < 1e-4, "{sum} {exact}");
    }

    #[test]
    fn weights_that_are_none_are_refused() {
        for weights in [&[][..], &[0.0], &[f32::NAN, 1.0], &[-1.0, 2.0], &[f32::INFINITY, 1.0]] {
            assert!(WavelengthDensity::new(weights, 400.0, 800.0).is_none());
        }
    }
}
