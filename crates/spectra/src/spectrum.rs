//! A function of wavelength.

use etendue_core::wavelength::{MAX_NM, MIN_NM};
use etendue_core::{Bands, Spectral, Wavelengths};

use crate::table::{self, Extrapolation, SpectrumError, TablePlace, rows};

/// Nodes of the grid: 300, 301, … 1 100 nm.
pub(crate) const NODES: usize = 801;

/// A function of wavelength: values at every nanometre from 300 to 1 100 nm, linear between; the owner defines the unit.
///
/// A table at integer nanometres is stored unchanged. A node with a table point closer than 1 nm takes the mean over its neighbourhood (weights
/// falling linearly to zero at 1 nm), so that tables finer than the grid and narrow lines keep their power. A table that is zero outside falls to
/// zero within 1 nm of its end.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    values: Box<[f32; NODES]>,
    covered_nm: (f64, f64),
}

impl Spectrum {
    /// The same value at every wavelength.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self::from_fn(|_| value)
    }

    /// The values of `f`, a function of the wavelength in nm, at every node. `f` must be finite.
    #[must_use]
    pub fn from_fn(mut f: impl FnMut(f64) -> f64) -> Self {
        let values = (0..NODES).map(|i| f(node_nm(i)) as f32).collect();
        Self { values: boxed(values), covered_nm: (MIN_NM, MAX_NM) }
    }

    /// Creates a spectrum from points (wavelength in nm, value), wavelengths increasing; linear between points.
    ///
    /// # Errors
    /// If there are no points, a single one in a table that is zero outside, a number is not finite, wavelengths do not increase, or the table does not
    /// reach into 300 to 1 100 nm.
    pub fn from_points(points: &[(f64, f64)], outside: Extrapolation) -> Result<Self, SpectrumError> {
        table::check(points, TablePlace::Point)?;
        table::check_width(points, outside)?;
        Ok(Self::from_checked(points, outside))
    }

    /// Parses a spectrum from the text of a CSV table: two columns `wavelength_nm,value`, an optional header line, empty lines and `#` comments
    /// allowed.
    ///
    /// # Errors
    /// As [`Spectrum::from_points`], and if a line is not two numbers; the error names the line.
    pub fn from_csv(text: &str, outside: Extrapolation) -> Result<Self, SpectrumError> {
        let points = table::points(text)?;
        table::check_width(&points, outside)?;
        Ok(Self::from_checked(&points, outside))
    }

    pub(crate) fn from_checked(points: &[(f64, f64)], outside: Extrapolation) -> Self {
        let values = (0..NODES).map(|i| table::node_value(points, outside, node_nm(i)) as f32).collect();
        let (first, last) = (points[0].0, points[points.len() - 1].0);
        Self { values: boxed(values), covered_nm: (first.max(MIN_NM), last.min(MAX_NM)) }
    }

    /// The value at a wavelength of 300 to 1 100 nm; the end value beyond.
    #[must_use]
    #[inline]
    pub fn at(&self, nm: f32) -> f32 {
        let (i, t) = node_below(nm);
        self.values[i] + t * (self.values[i + 1] - self.values[i])
    }

    /// The values at a path's wavelengths.
    #[must_use]
    #[inline]
    pub fn sample<const N: usize>(&self, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        Spectral(wavelengths.nm.map(|nm| self.at(nm)))
    }

    /// Integral over `[low_nm, high_nm]`, exact for the piecewise linear function; zero beyond 300–1 100 nm. The unit is the value's × nm.
    #[must_use]
    pub fn integral(&self, low_nm: f64, high_nm: f64) -> f64 {
        let (low, high) = (low_nm.max(MIN_NM) - MIN_NM, high_nm.min(MAX_NM) - MIN_NM);
        if low >= high {
            return 0.0;
        }
        (low.floor() as usize..high.ceil() as usize)
            .map(|i| self.piece_integral(i, low.max(i as f64), high.min((i + 1) as f64)))
            .sum()
    }

    /// Integral over a part of one piece of the grid; all lengths in nm from the first node.
    fn piece_integral(&self, i: usize, low: f64, high: f64) -> f64 {
        let (a, b) = (f64::from(self.values[i]), f64::from(self.values[i + 1]));
        let middle = (low + high) / 2.0 - i as f64;
        (high - low) * (a + middle * (b - a))
    }

    /// Mean over `[low_nm, high_nm]`, which must be non-empty and within 300–1 100 nm.
    #[must_use]
    pub fn band_mean(&self, low_nm: f64, high_nm: f64) -> f64 {
        self.integral(low_nm, high_nm) / (high_nm - low_nm)
    }

    /// The mean over each band, shortest wavelength first.
    #[must_use]
    pub fn band_means(&self, bands: Bands) -> Vec<f64> {
        let half = bands.width_nm() / 2.0;
        let mean = |i| self.band_mean(bands.centre_nm(i) - half, bands.centre_nm(i) + half);
        (0..bands.count()).map(mean).collect()
    }

    /// The spectrum times a number.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        self.mapped(|_, v| v * factor)
    }

    /// The product with another spectrum, node by node; it covers the intersection of both ranges.
    #[must_use]
    pub fn product(&self, other: &Self) -> Self {
        let covered_nm = (self.covered_nm.0.max(other.covered_nm.0), self.covered_nm.1.min(other.covered_nm.1));
        Self { covered_nm, ..self.mapped(|i, v| v * f64::from(other.values[i])) }
    }

    fn mapped(&self, f: impl Fn(usize, f64) -> f64) -> Self {
        let values = self.values.iter().enumerate().map(|(i, v)| f(i, f64::from(*v)) as f32).collect();
        Self { values: boxed(values), covered_nm: self.covered_nm }
    }

    /// The largest value within 300 to 1 100 nm.
    #[must_use]
    pub fn max_value(&self) -> f32 {
        self.values.iter().copied().fold(f32::NEG_INFINITY, f32::max)
    }

    /// The smallest value within 300 to 1 100 nm.
    #[must_use]
    pub fn min_value(&self) -> f32 {
        self.values.iter().copied().fold(f32::INFINITY, f32::min)
    }

    /// First and last wavelength (nm, within 300–1 100) covered by the table or function of the spectrum; beyond, its [`Extrapolation`] rule holds.
    #[must_use]
    pub fn covered_nm(&self) -> (f64, f64) {
        self.covered_nm
    }

    /// The first and last wavelength (nm) between which the spectrum is not zero; `None` if it is zero everywhere.
    #[must_use]
    pub fn support_nm(&self) -> Option<(f64, f64)> {
        let first = self.values.iter().position(|v| *v != 0.0)?;
        let last = self.values.iter().rposition(|v| *v != 0.0)?;
        Some((node_nm(first.saturating_sub(1)), node_nm((last + 1).min(NODES - 1))))
    }

    /// The values at 300, 301, … 1 100 nm.
    #[must_use]
    pub fn nodes(&self) -> &[f32; NODES] {
        &self.values
    }
}

/// Wavelength of node `i`, nm.
pub(crate) fn node_nm(i: usize) -> f64 {
    MIN_NM + i as f64
}

/// The node at or below a wavelength, never the last, and the fraction towards the next, in [0, 1].
#[inline]
pub(crate) fn node_below(nm: f32) -> (usize, f32) {
    let x = (nm - MIN_NM as f32).clamp(0.0, (NODES - 1) as f32);
    // Converts through i32, for which the processor has a direct instruction.
    let i = (x as i32 as usize).min(NODES - 2);
    (i, x - i as f32)
}

fn boxed(values: Vec<f32>) -> Box<[f32; NODES]> {
    values.try_into().expect("one value per node")
}

/// The spectra of an embedded table: `C` columns, the first the wavelength in nm.
pub(crate) fn embedded<const C: usize>(text: &str, outside: Extrapolation) -> Vec<Spectrum> {
    let rows = rows::<C>(text).expect("a table of the crate has numbers in every column");
    let column = |c: usize| rows.iter().map(|(_, row)| (row[0], row[c])).collect::<Vec<_>>();
    (1..C).map(|c| Spectrum::from_points(&column(c), outside).expect("a table of the crate is in order")).collect()
}

/// The column names of an embedded table, without the wavelength's.
pub(crate) fn embedded_names(text: &'static str) -> impl Iterator<Item = &'static str> {
    text.lines().next().unwrap_or("").split(',').skip(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(points: &[(f64, f64)], outside: Extrapolation) -> Spectrum {
        Spectrum::from_points(points, outside).expect("a table in order")
    }

    #[test]
    fn a_line_is_exact_inside_and_follows_its_rule_outside() {
        let points = [(400.0, 1.0), (500.0, 3.0)];
        let (zero, hold) = (table(&points, Extrapolation::Zero), table(&points, Extrapolation::Hold));
        for (nm, value) in [(400.0, 1.0), (450.0, 2.0), (475.25, 2.505), (500.0, 3.0)] {
            // One rounding to f32 in store, two in between.
            assert!((zero.at(nm) - value).abs() < 1e-6 && (hold.at(nm) - value).abs() < 1e-6);
        }
        assert_eq!((zero.at(399.0), zero.at(501.0), zero.at(300.0)), (0.0, 0.0, 0.0));
        assert_eq!((hold.at(399.0), hold.at(501.0), hold.at(1100.0)), (1.0, 3.0, 3.0));
        assert_eq!(zero.covered_nm(), (400.0, 500.0));
        assert_eq!(zero.support_nm(), Some((399.0, 501.0)));
        assert_eq!((hold.at(0.0), hold.at(f32::INFINITY)), (1.0, 3.0), "clamped");
        assert!(hold.at(f32::NAN).is_nan());
    }

    #[test]
    fn samples_are_values() {
        let spectrum = Spectrum::from_fn(|nm| nm * nm);
        let wavelengths = Wavelengths::<4>::uniform(380.0, 780.0, 0.371);
        let values = spectrum.sample(&wavelengths);
        for i in 0..4 {
            assert_eq!(values[i], spectrum.at(wavelengths.nm[i]));
            // The chord over 1 nm lies at most 1/4 above the parabola; f32 rounds 6e5 to 0.03.
            assert!((values[i] - wavelengths.nm[i] * wavelengths.nm[i]).abs() < 0.32);
        }
    }

    #[test]
    fn integrals_of_a_line_are_exact() {
        let line = Spectrum::from_fn(|nm| nm);
        for (low, high) in [(300.0, 1100.0), (400.25, 400.75), (399.5, 617.125), (1099.5, 1100.0)] {
            let exact = (high * high - low * low) / 2.0;
            assert!((line.integral(low, high) / exact - 1.0).abs() < 1e-12, "{low}–{high}");
            assert!((line.band_mean(low, high) / ((low + high) / 2.0) - 1.0).abs() < 1e-12);
        }
        assert_eq!((line.integral(100.0, 300.0), line.integral(500.0, 400.0)), (0.0, 0.0));
        let bands = Bands::covering(380.0, 780.0, 2.5).expect("bands");
        let sum: f64 = line.band_means(bands).iter().map(|m| m * 2.5).sum();
        assert!((sum / line.integral(380.0, 780.0) - 1.0).abs() < 1e-12);
    }

    /// A laser line of 0.1 nm between two nodes: point samples would lose it.
    #[test]
    fn narrow_lines_keep_their_power() {
        for centre in [532.0, 532.3, 632.5] {
            let points = [(centre - 0.1, 0.0), (centre, 10.0), (centre + 0.1, 0.0)];
            let line = table(&points, Extrapolation::Zero);
            // Area of the triangle: 1; values are rounded to f32.
            assert!((line.integral(500.0, 700.0) - 1.0).abs() < 1e-6, "{centre}: {}", line.integral(500.0, 700.0));
        }
        let fine: Vec<_> = (0..=80).map(|i| (400.0 + 0.25 * f64::from(i), 5.0)).collect();
        assert_eq!(table(&fine, Extrapolation::Hold), {
            let flat = Spectrum::constant(5.0);
            Spectrum { covered_nm: (400.0, 420.0), ..flat }
        });
    }

    #[test]
    fn products_and_scales() {
        let (a, b) = (table(&[(400.0, 1.0), (500.0, 3.0)], Extrapolation::Hold), Spectrum::from_fn(|nm| nm / 100.0));
        let product = a.product(&b).scaled(2.0);
        assert!((product.at(450.0) - 18.0).abs() < 1e-5);
        assert_eq!(product.covered_nm(), (400.0, 500.0));
        assert_eq!((product.max_value(), product.min_value()), (66.0, 6.0));
    }
}
