//! A kernel for means and, squared, for variances.

use super::canvas::Canvas;
use super::convolve::{Convolver, Field};
use super::kernel::Kernel;

/// A kernel for means and, squared, for variances.
#[derive(Debug)]
pub(super) struct Spread {
    pub(super) mean: Convolver,
    pub(super) variance: Convolver,
}

impl Spread {
    pub(super) fn new(kernel: &Kernel, canvas: &Canvas) -> Self {
        let of = |kernel: &Kernel| Convolver::new(kernel, canvas.size(), canvas.whole());
        Self { mean: of(kernel), variance: of(&kernel.squared()) }
    }

    pub(super) fn apply(&self, light: &Field, variance: Option<&Field>) -> (Field, Option<Field>) {
        (self.mean.apply(light), variance.map(|variance| self.variance.apply(variance)))
    }
}
