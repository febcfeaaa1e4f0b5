//! Wavelengths carried by a path, values over them, and bands of a spectral image.

use core::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, MulAssign, Sub};

/// Shortest wavelength that a description may state, nm.
pub const MIN_NM: f64 = 300.0;
/// Longest wavelength that a description may state, nm.
pub const MAX_NM: f64 = 1100.0;

/// `N` wavelengths (nm) that one path carries, with the density by which each was sampled (1/nm).
///
/// Hero wavelength sampling (Wilkie et al. 2014): the first is sampled; the others are its rotations by equal steps in the cumulative distribution, so each
/// alone is a valid sample of the support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelengths<const N: usize> {
    /// Wavelengths, nm; the first is the hero.
    pub nm: [f32; N],
    /// Density of each wavelength, 1/nm.
    pub pdf: [f32; N],
}

impl<const N: usize> Wavelengths<N> {
    /// Returns `N` wavelengths spread uniformly over `[low_nm, high_nm)`, from one number `u` in [0, 1).
    #[must_use]
    pub fn uniform(low_nm: f32, high_nm: f32, u: f32) -> Self {
        let range = high_nm - low_nm;
        let nm = core::array::from_fn(|i| within(low_nm, high_nm, turned(u, i, N)));
        Self { nm, pdf: [1.0 / range; N] }
    }
}

/// Wavelength at `x` in [0, 1) of `[low_nm, high_nm)`; rounding never reaches the upper end.
fn within(low_nm: f32, high_nm: f32, x: f32) -> f32 {
    (low_nm + (high_nm - low_nm) * x).min(high_nm.next_down())
}

/// `u` rotated by `i` of `n` equal steps, in [0, 1).
#[inline]
pub(crate) fn turned(u: f32, i: usize, n: usize) -> f32 {
    let turned = u + i as f32 / n as f32;
    if turned >= 1.0 { turned - 1.0 } else { turned }
}

/// One value for each wavelength of a path; the unit is its owner's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Spectral<const N: usize>(pub [f32; N]);

impl<const N: usize> Default for Spectral<N> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const N: usize> Spectral<N> {
    /// Zero at every wavelength.
    pub const ZERO: Self = Self([0.0; N]);
    /// One at every wavelength.
    pub const ONE: Self = Self([1.0; N]);

    /// The same value at every wavelength.
    #[must_use]
    pub const fn splat(value: f32) -> Self {
        Self([value; N])
    }

    /// Returns the value of `f` at each index.
    #[must_use]
    pub fn from_fn(f: impl FnMut(usize) -> f32) -> Self {
        Self(core::array::from_fn(f))
    }

    /// Applies `f` to each value.
    #[must_use]
    pub fn map(self, f: impl FnMut(f32) -> f32) -> Self {
        Self(self.0.map(f))
    }

    /// Returns the largest value (−∞ never: `N` is at least 1). Ignores NaN.
    #[must_use]
    pub fn max_value(self) -> f32 {
        self.0.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }

    /// The mean, summed in order.
    #[must_use]
    pub fn mean(self) -> f32 {
        self.0.into_iter().sum::<f32>() / N as f32
    }

    /// True if every value is exactly zero.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self.0.into_iter().all(|v| v == 0.0)
    }

    /// True if every value is finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.0.into_iter().all(f32::is_finite)
    }
}

impl<const N: usize> Index<usize> for Spectral<N> {
    type Output = f32;
    fn index(&self, i: usize) -> &f32 {
        &self.0[i]
    }
}

impl<const N: usize> IndexMut<usize> for Spectral<N> {
    fn index_mut(&mut self, i: usize) -> &mut f32 {
        &mut self.0[i]
    }
}

macro_rules! elementwise {
    ($($trait:ident $method:ident $op:tt;)*) => {
        $(impl<const N: usize> $trait for Spectral<N> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self::from_fn(|i| self.0[i] $op other.0[i])
            }
        })*
    };
}

elementwise! { Add add +; Sub sub -; Mul mul *; Div div /; }

impl<const N: usize> Mul<f32> for Spectral<N> {
    type Output = Self;
    fn mul(self, k: f32) -> Self {
        self.map(|v| v * k)
    }
}

impl<const N: usize> Div<f32> for Spectral<N> {
    type Output = Self;
    fn div(self, k: f32) -> Self {
        self.map(|v| v / k)
    }
}

impl<const N: usize> AddAssign for Spectral<N> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> MulAssign for Spectral<N> {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

/// An interval of wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavelengthRange {
    /// Shortest wavelength, nm.
    pub low_nm: f64,
    /// Longest wavelength, nm.
    pub high_nm: f64,
}

impl WavelengthRange {
    /// Returns the interval from `low_nm` to `high_nm`.
    #[must_use]
    pub const fn new(low_nm: f64, high_nm: f64) -> Self {
        Self { low_nm, high_nm }
    }

    /// Returns its width, nm.
    #[must_use]
    pub fn width_nm(self) -> f64 {
        self.high_nm - self.low_nm
    }
}

/// Adjoining wavelength bands of equal width: the bins of a spectral image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bands {
    low_nm: f64,
    width_nm: f64,
    count: usize,
}

impl Bands {
    /// Returns `count` bands of `width_nm` from `low_nm` up. `None` if they leave 300–1 100 nm or `count` is 0.
    #[must_use]
    pub fn new(low_nm: f64, width_nm: f64, count: usize) -> Option<Self> {
        let high_nm = low_nm + width_nm * count as f64;
        let legal = count > 0 && width_nm > 0.0 && low_nm >= MIN_NM && high_nm <= MAX_NM + 1e-9;
        legal.then_some(Self { low_nm, width_nm, count })
    }

    /// Returns bands of `width_nm` that cover `[low_nm, high_nm]` exactly. `None` if the width does not divide the range (to 1e-6 of a band) or the range is
    /// not legal.
    #[must_use]
    pub fn covering(low_nm: f64, high_nm: f64, width_nm: f64) -> Option<Self> {
        let count = ((high_nm - low_nm) / width_nm).round();
        let fits = count >= 1.0 && ((high_nm - low_nm) / width_nm - count).abs() < 1e-6;
        if fits { Self::new(low_nm, width_nm, count as usize) } else { None }
    }

    /// Number of bands.
    #[must_use]
    pub fn count(self) -> usize {
        self.count
    }

    /// Lower edge of the first band, nm.
    #[must_use]
    pub fn low_nm(self) -> f64 {
        self.low_nm
    }

    /// Upper edge of the last band, nm.
    #[must_use]
    pub fn high_nm(self) -> f64 {
        self.low_nm + self.width_nm * self.count as f64
    }

    /// Returns the interval from the lower edge of the first band to the upper edge of the last.
    #[must_use]
    pub fn range(self) -> WavelengthRange {
        WavelengthRange::new(self.low_nm(), self.high_nm())
    }

    /// Width of a band, nm.
    #[must_use]
    pub fn width_nm(self) -> f64 {
        self.width_nm
    }

    /// Centre of band `i`, nm.
    #[must_use]
    pub fn centre_nm(self, i: usize) -> f64 {
        self.low_nm + self.width_nm * (i as f64 + 0.5)
    }

    /// Returns the index of the band that contains `nm`; `None` outside. A band includes its lower edge.
    #[must_use]
    pub fn index_of(self, nm: f64) -> Option<usize> {
        let i = ((nm - self.low_nm) / self.width_nm).floor();
        (i >= 0.0 && i < self.count as f64).then_some(i as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hero_wavelengths_are_equally_spaced_and_stay_in_the_support() {
        for u in [0.0, 0.3, 0.74, 0.999_999_94] {
            assert!(Wavelengths::<1>::uniform(500.0, 600.0, u).nm[0] < 600.0, "the upper end is no wavelength");
            let w = Wavelengths::<4>::uniform(380.0, 780.0, u);
            let mut nm = w.nm;
            nm.sort_by(f32::total_cmp);
            assert!(nm[0] >= 380.0 && nm[3] <= 780.0);
            for pair in nm.windows(2) {
                assert!((pair[1] - pair[0] - 100.0).abs() < 1e-3);
            }
            assert_eq!(w.pdf, [1.0 / 400.0; 4]);
        }
    }

    #[test]
    fn a_band_owns_its_lower_edge() {
        let bands = Bands::covering(380.0, 780.0, 5.0).expect("80 bands");
        assert_eq!(bands.count(), 80);
        assert_eq!(bands.index_of(380.0), Some(0));
        assert_eq!(bands.index_of(385.0), Some(1));
        assert_eq!(bands.index_of(780.0), None);
        assert_eq!(bands.index_of(379.9), None);
        assert!(Bands::covering(380.0, 780.0, 7.0).is_none());
        assert!(Bands::new(200.0, 5.0, 3).is_none());
    }
}
