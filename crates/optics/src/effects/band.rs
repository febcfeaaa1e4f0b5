//! Distributes a spread function over the pixel lattice without widening it.
//!
//! A lattice of taps k has the modulation K(f) = Σ kₙ exp(−2πi f·n). It should equal that of the spread, H(f), for all frequencies that the pixels
//! can represent, up to half a cycle per pixel: then kₙ = ∫ P(t) sinc(t/p − n) dt. Hann's window cuts off the sinc after [`LOBES`] lobes; before
//! that, mass is gathered on a lattice of eighths of a pixel with cubic weights. Mass beyond [`NEAR_PX`] is distributed bilinearly (`kernel.rs`),
//! which is equivalent for so wide and smooth a spread.
//!
//! Light is not negative, and next to a light source a tap of −1 % would be a hole. Negative taps are set to 0, and rows and columns are scaled in
//! turn until their sums are again those of the band-limited kernel (iterative proportional fitting, Deming & Stephan 1940). Negative sums become 0,
//! and the others are lowered in proportion, about the same centroid. Diffraction, whose modulation falls from the start, keeps its modulation along
//! both image axes to 0.004 and loses up to 0.06 along the diagonals (at half a cycle per pixel, for patterns about as wide as a pixel). A Gaussian
//! of 0.7 pixels keeps it to 0.02, of 0.4 pixels to 0.08: no film of whole pixels can do better without negative light. Where samples come through
//! the lens, such spreads displace these (`sample_spread.rs`). A narrow spread off the centre of a pixel has even more negative taps; it is
//! distributed bilinearly as a whole.

use core::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use etendue_core::maths::f64::sin_cos;
use glam::DVec2;

use super::kernel::Kernel;

/// Lobes of the sinc to either side.
const LOBES: usize = 16;
/// Distance from the centre, along rows or columns, within which mass is distributed by the sinc, px.
const NEAR_PX: usize = 12;
/// Cells per pixel of the lattice on which mass is gathered first.
const FINE: usize = 8;
/// Cells along its side: one pixel more at each end, for the cubic weights.
const SIDE: usize = 2 * (NEAR_PX + 1) * FINE + 1;
/// Rounds of scaling; each reduces the remaining error by an order of magnitude.
const ROUNDS: usize = 8;
/// Negative mass in the sums of rows or columns above which a spread is distributed bilinearly.
const MAX_NEGATIVE_MASS: f64 = 0.1;

/// Mass on a lattice finer than pixels about the centre, and bilinear taps: of the far mass, and of all.
#[derive(Debug)]
pub(crate) struct BandLimited {
    fine: Vec<f64>,
    far: Kernel,
    bilinear: Kernel,
}

impl BandLimited {
    pub(crate) fn zeros(reach: [usize; 2]) -> Self {
        Self { fine: vec![0.0; SIDE * SIDE], far: Kernel::zeros(reach), bilinear: Kernel::zeros(reach) }
    }

    /// Adds a mass at `offset_px` from the centre.
    pub(crate) fn deposit(&mut self, offset_px: DVec2, mass: f64) {
        self.bilinear.deposit(offset_px, mass);
        if offset_px.abs().max_element() > NEAR_PX as f64 {
            return self.far.deposit(offset_px, mass);
        }
        let place = (offset_px + (NEAR_PX + 1) as f64) * FINE as f64;
        let (low, fraction) = (place.floor(), place - place.floor());
        let (x, y) = (low.x as usize - 1, low.y as usize - 1);
        let (wide, tall) = (cubic(fraction.x), cubic(fraction.y));
        for (j, tall) in tall.into_iter().enumerate() {
            let row = &mut self.fine[(y + j) * SIDE + x..][..4];
            row.iter_mut().zip(wide).for_each(|(cell, wide)| *cell += mass * tall * wide);
        }
    }

    /// The taps by the sinc: along the rows of the fine lattice, then along its columns.
    fn band(&self) -> Kernel {
        let cell_weights: Vec<CellWeights> = (0..SIDE).map(CellWeights::new).collect();
        let width = 2 * (NEAR_PX + 1 + LOBES) + 1;
        let middle = (NEAR_PX + 1 + LOBES) as isize;
        let mut columns = vec![0.0; SIDE * width];
        for (fine, to) in self.fine.chunks_exact(SIDE).zip(columns.chunks_exact_mut(width)) {
            for (mass, weights) in fine.iter().zip(&cell_weights).filter(|(mass, _)| **mass != 0.0) {
                weights.places().for_each(|(column, weight)| to[(column + middle) as usize] += mass * weight);
            }
        }
        let mut kernel = self.far.clone();
        for (row, weights) in columns.chunks_exact(width).zip(&cell_weights) {
            for (y, weight) in weights.places() {
                for (x, mass) in row.iter().enumerate().filter(|(_, mass)| **mass != 0.0) {
                    kernel.add(x as isize - middle, y, weight * mass);
                }
            }
        }
        kernel
    }

    /// Maximum modulation error of the kernel, over frequencies up to half a cycle per pixel along rows, columns and both diagonals.
    pub(crate) fn worst_error(self) -> f64 {
        let frequencies = [0.125, 0.25, 0.375, 0.5].into_iter().flat_map(|f| {
            [DVec2::X, DVec2::Y, DVec2::splat(FRAC_1_SQRT_2), DVec2::new(FRAC_1_SQRT_2, -FRAC_1_SQRT_2)]
                .map(|along| along * f)
        });
        let frequencies: Vec<DVec2> = frequencies.collect();
        let at = |i: usize| DVec2::new((i % SIDE) as f64, (i / SIDE) as f64) / FINE as f64 - (NEAR_PX + 1) as f64;
        let exact = |frequency: DVec2| {
            modulation(
                self.fine
                    .iter()
                    .enumerate()
                    .map(|(i, mass)| (at(i), *mass))
                    .chain(self.far.taps().map(|(x, y, mass)| (DVec2::new(x as f64, y as f64), mass))),
                frequency,
            )
        };
        let all = self.fine.iter().sum::<f64>() + self.far.sum();
        let exact: Vec<DVec2> = frequencies.iter().map(|f| exact(*f) / all).collect();
        let kernel = self.kernel();
        let modulation_at = |frequency: DVec2| {
            modulation(kernel.taps().map(|(x, y, tap)| (DVec2::new(x as f64, y as f64), tap)), frequency)
        };
        frequencies.iter().zip(exact).map(|(f, exact)| (modulation_at(*f) - exact).length()).fold(0.0, f64::max)
    }

    /// The kernel: its sum is one, its centroid that of the mass, and no tap is negative.
    pub(crate) fn kernel(self) -> Kernel {
        let unit = |kernel: Kernel| {
            let sum = kernel.sum();
            kernel.scaled(1.0 / sum)
        };
        let (band, bilinear) = (unit(self.band()), unit(self.bilinear));
        let sums = band.sums();
        if sums.iter().any(|line| negative(line) > MAX_NEGATIVE_MASS) {
            return bilinear;
        }
        let centroids = bilinear.sums().map(|line| centroid(&line));
        let [columns, rows] = core::array::from_fn(|axis| target_sums(&sums[axis], centroids[axis]));
        unit(fitted(band.positive(), &columns, &rows))
    }
}

/// Real and imaginary part.
fn modulation(masses: impl Iterator<Item = (DVec2, f64)>, frequency: DVec2) -> DVec2 {
    let wave = |(place, mass): (DVec2, f64)| {
        let (sine, cosine) = sin_cos(TAU * frequency.dot(place));
        mass * DVec2::new(cosine, sine)
    };
    masses.filter(|(_, mass)| *mass != 0.0).map(wave).sum()
}

fn negative(sums: &[f64]) -> f64 {
    sums.iter().map(|s| (-s).max(0.0)).sum()
}

/// The centroid of line sums that total one, in lines from the first.
fn centroid(sums: &[f64]) -> f64 {
    sums.iter().enumerate().map(|(i, s)| i as f64 * s).sum()
}

/// Line sums of total one without negative values, about a centroid: sums on one side of it are scaled up, on the other down, in proportion to the
/// distance up to two lines.
fn target_sums(sums: &[f64], centroid: f64) -> Vec<f64> {
    let positive: Vec<f64> = sums.iter().map(|s| s.max(0.0)).collect();
    let tilt = |i: usize| (i as f64 - centroid).clamp(-2.0, 2.0);
    let moment = |by: &dyn Fn(usize) -> f64| -> f64 {
        positive.iter().enumerate().map(|(i, s)| (i as f64 - centroid) * s * by(i)).sum()
    };
    let slope = -moment(&|_| 1.0) / moment(&tilt).max(f64::MIN_POSITIVE);
    let tilted: Vec<f64> = positive.iter().enumerate().map(|(i, s)| s * (1.0 + slope * tilt(i)).max(0.0)).collect();
    let sum: f64 = tilted.iter().sum();
    tilted.iter().map(|s| s / sum).collect()
}

/// Scales a kernel to other sums of its columns and rows.
fn fitted(mut kernel: Kernel, columns: &[f64], rows: &[f64]) -> Kernel {
    let ratios = |target: &[f64], actual: &[f64]| -> Vec<f64> {
        target.iter().zip(actual).map(|(w, f)| if *f > 0.0 { w / f } else { 0.0 }).collect()
    };
    for _ in 0..ROUNDS {
        let by_row = ratios(rows, &kernel.sums()[1]);
        kernel.scale_lines(None, Some(&by_row));
        let by_column = ratios(columns, &kernel.sums()[0]);
        kernel.scale_lines(Some(&by_column), None);
    }
    kernel
}

/// Weights of four cells of a lattice, the second and third adjacent to the position (Keys 1981: third order in the cell).
fn cubic(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [0.5 * (-t3 + 2.0 * t2 - t), 0.5 * (3.0 * t3 - 5.0 * t2 + 2.0), 0.5 * (-3.0 * t3 + 4.0 * t2 + t), 0.5 * (t3 - t2)]
}

/// Fractions of a cell's mass per pixel along one axis; they sum to one.
struct CellWeights {
    first: isize,
    weights: [f64; 2 * LOBES],
}

impl CellWeights {
    fn new(cell: usize) -> Self {
        let low = cell / FINE;
        let fraction = (cell % FINE) as f64 / FINE as f64;
        let first = low as isize - (NEAR_PX + LOBES) as isize;
        let weight = |t: usize| {
            let distance = t as f64 - (LOBES as f64 - 1.0) - fraction;
            let sinc = if distance == 0.0 { 1.0 } else { sin_cos(PI * distance).0 / (PI * distance) };
            let on_other_pixel = fraction == 0.0 && distance != 0.0;
            if on_other_pixel { 0.0 } else { sinc * 0.5 * (1.0 + sin_cos(PI * distance / LOBES as f64).1) }
        };
        let weights: [f64; 2 * LOBES] = core::array::from_fn(weight);
        let sum: f64 = weights.iter().sum();
        Self { first, weights: weights.map(|w| w / sum) }
    }

    fn places(&self) -> impl Iterator<Item = (isize, f64)> {
        self.weights.iter().enumerate().map(|(t, weight)| (self.first + t as isize, *weight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::maths::f64::exp;

    /// The real modulation of a kernel along a direction.
    fn modulation(kernel: &Kernel, frequency: DVec2) -> f64 {
        super::modulation(kernel.taps().map(|(x, y, tap)| (DVec2::new(x as f64, y as f64), tap)), frequency).x
    }

    /// A Gaussian, in steps of an eighth of a pixel.
    fn gaussian(sigma_px: f64, middle: DVec2) -> Kernel {
        let mut band = BandLimited::zeros([24, 24]);
        for i in -64..=64 {
            for j in -64..=64 {
                let place = DVec2::new(f64::from(i), f64::from(j)) / 8.0;
                band.deposit(place + middle, exp(-0.5 * place.length_squared() / (sigma_px * sigma_px)));
            }
        }
        band.kernel()
    }

    #[test]
    fn gaussians_keep_their_modulation() {
        // Within a sixteenth of a cycle about 0.5 the window mixes f and 1 − f; the negative part, largest at 0.4 px, is left out.
        for (sigma_px, lost) in [(0.4, 0.08), (0.7, 0.02), (1.0, 0.004)] {
            let kernel = gaussian(sigma_px, DVec2::ZERO);
            for f in [0.1, 0.2, 0.3, 0.4, 0.5] {
                let expected = exp(-0.5 * (TAU * sigma_px * f) * (TAU * sigma_px * f));
                for along in [DVec2::X, DVec2::Y] {
                    let actual = modulation(&kernel, along * f);
                    assert!((actual - expected).abs() < lost, "{sigma_px} at {f}: {actual} for {expected}");
                }
                let diagonal = modulation(&kernel, DVec2::splat(f / 2f64.sqrt()));
                assert!((-2.0 * lost..0.004).contains(&(diagonal - expected)), "{sigma_px} at {f}: {diagonal}");
            }
            assert!(kernel.taps().all(|(_, _, tap)| tap >= 0.0) && (kernel.sum() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_spread_of_no_width_is_the_identity_or_shared_by_two() {
        let at = |offset: DVec2| {
            let mut band = BandLimited::zeros([14, 14]);
            band.deposit(offset, 3.0);
            band.kernel()
        };
        assert_eq!(at(DVec2::ZERO).taps().collect::<Vec<_>>(), [(0, 0, 1.0)]);
        assert_eq!(at(DVec2::new(0.5, 0.0)).taps().collect::<Vec<_>>(), [(0, 0, 0.5), (1, 0, 0.5)]);
    }

    #[test]
    fn centroids_are_kept() {
        let middle = DVec2::new(0.3, -0.2);
        let actual: DVec2 = gaussian(0.6, middle).taps().map(|(x, y, tap)| DVec2::new(x as f64, y as f64) * tap).sum();
        // The error of the sinc's window.
        assert!((actual - middle).length() < 2e-3, "{actual}");
    }
}
