//! A convolution kernel on the pixel lattice.
//!
//! Uses bilinear weights, for wide and smooth spreads (glare, far parts of patterns); `band.rs` handles narrow spreads without widening them.
//!
//! The film holds means over pixels. With a spread function P of the plane, the mean over a pixel after the spread is ∫ P(t) Ē(x − t) dt, Ē the
//! irradiance's running mean over a pixel; between pixel centres, where Ē is unknown, it is taken as bilinear. The tap at n is then ∫ P(t) Λ(t/p − n)
//! dt with the triangle Λ in both directions: mass of P is distributed over the four nearest taps. This preserves mass and centroid exactly, leaves a
//! spread of zero width the identity, and widens the spread by the variance of the triangle, p²/6 per direction, which is part of the pixel's own.

use glam::DVec2;

/// Taps at whole pixels from `-reach` to `reach`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Kernel {
    reach: [usize; 2],
    taps: Vec<f64>,
}

impl Kernel {
    /// All zero.
    pub(crate) fn zeros(reach: [usize; 2]) -> Self {
        Self { reach, taps: vec![0.0; (2 * reach[0] + 1) * (2 * reach[1] + 1)] }
    }

    /// Columns and rows to each side of the centre.
    pub(crate) fn reach(&self) -> [usize; 2] {
        self.reach
    }

    /// Taps per row.
    pub(crate) fn width(&self) -> usize {
        2 * self.reach[0] + 1
    }

    /// The tap at an offset; 0 beyond the reach.
    #[cfg(test)]
    pub(crate) fn at(&self, x: isize, y: isize) -> f64 {
        self.index(x, y).map_or(0.0, |i| self.taps[i])
    }

    /// Adds to the tap at an offset; beyond the reach it is lost.
    pub(crate) fn add(&mut self, x: isize, y: isize, mass: f64) {
        if let Some(i) = self.index(x, y) {
            self.taps[i] += mass;
        }
    }

    fn index(&self, x: isize, y: isize) -> Option<usize> {
        let column = x.checked_add_unsigned(self.reach[0])?;
        let row = y.checked_add_unsigned(self.reach[1])?;
        let (column, row) = (usize::try_from(column).ok()?, usize::try_from(row).ok()?);
        (column < self.width() && row <= 2 * self.reach[1]).then(|| row * self.width() + column)
    }

    /// Distributes a mass at `offset_px` over the four nearest taps.
    pub(crate) fn deposit(&mut self, offset_px: DVec2, mass: f64) {
        let low = offset_px.floor();
        let fraction = offset_px - low;
        let (x, y) = (low.x as isize, low.y as isize);
        self.add(x, y, mass * (1.0 - fraction.x) * (1.0 - fraction.y));
        self.add(x + 1, y, mass * fraction.x * (1.0 - fraction.y));
        self.add(x, y + 1, mass * (1.0 - fraction.x) * fraction.y);
        self.add(x + 1, y + 1, mass * fraction.x * fraction.y);
    }

    /// Sums over columns and over rows: of each column, of each row.
    pub(crate) fn sums(&self) -> [Vec<f64>; 2] {
        let mut sums = [vec![0.0; self.width()], vec![0.0; 2 * self.reach[1] + 1]];
        for (y, row) in self.taps.chunks_exact(self.width()).enumerate() {
            sums[1][y] = row.iter().sum();
            sums[0].iter_mut().zip(row).for_each(|(sum, tap)| *sum += tap);
        }
        sums
    }

    /// Scales every column and every row by its own factor.
    pub(crate) fn scale_lines(&mut self, columns: Option<&[f64]>, rows: Option<&[f64]>) {
        let width = self.width();
        for (y, row) in self.taps.chunks_exact_mut(width).enumerate() {
            let tall = rows.map_or(1.0, |r| r[y]);
            row.iter_mut().enumerate().for_each(|(x, tap)| *tap *= tall * columns.map_or(1.0, |c| c[x]));
        }
    }

    /// The kernel with 0 for negative taps.
    pub(crate) fn positive(&self) -> Self {
        Self { reach: self.reach, taps: self.taps.iter().map(|tap| tap.max(0.0)).collect() }
    }

    /// Sum of the taps.
    pub(crate) fn sum(&self) -> f64 {
        self.taps.iter().sum()
    }

    /// The kernel times a number.
    pub(crate) fn scaled(mut self, by: f64) -> Self {
        self.taps.iter_mut().for_each(|tap| *tap *= by);
        self
    }

    /// The squares of the taps: the effect on variances of independent pixels.
    pub(crate) fn squared(&self) -> Self {
        Self { reach: self.reach, taps: self.taps.iter().map(|tap| tap * tap).collect() }
    }

    /// Offsets and values of the taps that are not zero.
    pub(crate) fn taps(&self) -> impl Iterator<Item = (isize, isize, f64)> {
        let (width, [rx, ry]) = (self.width(), self.reach);
        let place = move |i: usize| ((i % width) as isize - rx as isize, (i / width) as isize - ry as isize);
        self.taps.iter().enumerate().filter(|(_, tap)| **tap != 0.0).map(move |(i, tap)| {
            let (x, y) = place(i);
            (x, y, *tap)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deposits_keep_mass_and_centroid() {
        let mut kernel = Kernel::zeros([3, 2]);
        let masses = [(DVec2::new(0.0, 0.0), 0.5), (DVec2::new(-1.3, 0.9), 0.25), (DVec2::new(1.75, -1.2), 1.5)];
        let mut centroid = DVec2::ZERO;
        for (place, mass) in masses {
            kernel.deposit(place, mass);
            centroid += place * mass;
        }
        let actual: DVec2 = kernel.taps().map(|(x, y, tap)| DVec2::new(x as f64, y as f64) * tap).sum();
        // Rounding of a dozen terms.
        assert!((kernel.sum() - 2.25).abs() < 1e-14 && (actual - centroid).length() < 1e-14);
        assert!((kernel.squared().at(0, 0) - kernel.at(0, 0) * kernel.at(0, 0)).abs() < 1e-16);
    }

    #[test]
    fn what_lies_beyond_the_reach_is_lost() {
        let mut kernel = Kernel::zeros([1, 1]);
        kernel.deposit(DVec2::new(1.5, 0.0), 1.0);
        kernel.deposit(DVec2::new(-7.0, 40.0), 1.0);
        assert_eq!((kernel.sum(), kernel.at(1, 0), kernel.at(2, 0)), (0.5, 0.5, 0.0));
    }
}
