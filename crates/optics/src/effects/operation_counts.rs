//! What the effects behind a film have to do, counted before it is done: a plan foretells their cost from it.

use core::iter::Sum;
use core::ops::{Add, Mul};

/// Numbers of what takes time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OperationCounts {
    /// Products of a pixel and a tap, where few taps are summed directly.
    pub taps: f64,
    /// Numbers that pass a Fourier transform, each times the bits of both its sides' lengths.
    pub transformed: f64,
    /// Points of light shared among the taps of kernels.
    pub shared: f64,
    /// Diffraction patterns of a wavefront.
    pub patterns: f64,
}

impl Add for OperationCounts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            taps: self.taps + other.taps,
            transformed: self.transformed + other.transformed,
            shared: self.shared + other.shared,
            patterns: self.patterns + other.patterns,
        }
    }
}

impl Mul<f64> for OperationCounts {
    type Output = Self;

    fn mul(self, by: f64) -> Self {
        Self {
            taps: self.taps * by,
            transformed: self.transformed * by,
            shared: self.shared * by,
            patterns: self.patterns * by,
        }
    }
}

impl Sum for OperationCounts {
    fn sum<I: Iterator<Item = Self>>(works: I) -> Self {
        works.fold(Self::default(), Add::add)
    }
}

/// How often a kernel is made ready, and how many pictures it is applied to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Uses {
    pub(super) ready: f64,
    pub(super) applied: f64,
}
