//! The discrete Fourier transform of a rectangle of complex numbers.
//!
//! Stockham's self-sorting algorithm (Cochran et al. 1967) in radices 4, 2, 3 and 5, decimated in frequency, on strips of adjacent lines. All
//! arithmetic is f64, and the roots of unity come from the core crate's own sine: common FFT libraries use that of the platform, whose last bit
//! differs between machines.

use core::{f64::consts::PI, ops::Range};

use etendue_core::maths::f64::sin_cos;

/// Lines transformed together.
const LANES: usize = 16;

/// The smallest length, at least `least`, that is a product of 2, 3 and 5.
pub(crate) fn fast_length(minimum: usize) -> usize {
    (minimum.max(1)..).find(|n| factors(*n).is_some()).expect("powers of two have no end")
}

/// The radices of a length, or `None` if another prime divides it.
fn factors(mut n: usize) -> Option<Vec<usize>> {
    let mut prime_factors = Vec::new();
    for radix in [4, 2, 3, 5] {
        while n.is_multiple_of(radix) {
            prime_factors.push(radix);
            n /= radix;
        }
    }
    (n == 1).then_some(prime_factors)
}

/// Complex numbers as two lists.
#[derive(Clone, Debug, Default)]
struct ComplexLine {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl ComplexLine {
    fn zeros(len: usize) -> Self {
        Self { re: vec![0.0; len], im: vec![0.0; len] }
    }
}

/// A transform of one length.
#[derive(Clone, Debug)]
struct Transform {
    n: usize,
    radices: Vec<usize>,
    /// exp(−2πi k/n).
    roots: ComplexLine,
}

impl Transform {
    /// `n` is a product of 2, 3 and 5.
    fn new(n: usize) -> Self {
        let radices = factors(n).expect("a fast length");
        let (im, re) = (0..n).map(|k| sin_cos(-2.0 * PI * k as f64 / n as f64)).unzip();
        Self { n, radices, roots: ComplexLine { re, im } }
    }

    /// Transforms `lanes` interleaved lines; `spare` has the same size.
    fn run(&self, data: &mut ComplexLine, spare: &mut ComplexLine, lanes: usize) {
        let (mut length, mut stride) = (self.n, lanes);
        for radix in &self.radices {
            let step = self.n / length;
            length /= radix;
            for p in 0..length {
                let pass = Pass { from: data, to: spare, stride, gap: length * stride };
                let twiddle = |j: usize| self.root(p * j * step);
                match radix {
                    2 => pass.two(p, [twiddle(1)]),
                    3 => pass.three(p, [twiddle(1), twiddle(2)]),
                    4 => pass.four(p, [twiddle(1), twiddle(2), twiddle(3)]),
                    _ => pass.five(p, [twiddle(1), twiddle(2), twiddle(3), twiddle(4)]),
                }
            }
            stride *= radix;
            core::mem::swap(data, spare);
        }
    }

    fn root(&self, k: usize) -> Complex {
        (self.roots.re[k % self.n], self.roots.im[k % self.n])
    }
}

type Complex = (f64, f64);

#[inline(always)]
fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

#[inline(always)]
fn plus(a: Complex, b: Complex) -> Complex {
    (a.0 + b.0, a.1 + b.1)
}

#[inline(always)]
fn minus(a: Complex, b: Complex) -> Complex {
    (a.0 - b.0, a.1 - b.1)
}

/// −i a.
#[inline(always)]
fn turned(a: Complex) -> Complex {
    (a.1, -a.0)
}

#[inline(always)]
fn scaled(a: Complex, s: f64) -> Complex {
    (a.0 * s, a.1 * s)
}

/// One pass of the algorithm: inputs `gap` apart, outputs `stride` apart.
struct Pass<'a> {
    from: &'a ComplexLine,
    to: &'a mut ComplexLine,
    stride: usize,
    gap: usize,
}

/// One butterfly for all lanes: the inputs a₀ …, their transform, the twiddle factors.
macro_rules! butterfly {
    ($self:ident, $p:ident, $twiddles:ident, $radix:literal, |$a:ident| $transform:expr) => {{
        let Self { from, to, stride, gap } = $self;
        let ins: [(&[f64], &[f64]); $radix] = core::array::from_fn(|k| {
            let start = $p * stride + k * gap;
            (&from.re[start..start + stride], &from.im[start..start + stride])
        });
        let start = $p * stride * $radix;
        let (re, im) = (&mut to.re[start..start + $radix * stride], &mut to.im[start..start + $radix * stride]);
        for q in 0..stride {
            let $a: [Complex; $radix] = core::array::from_fn(|k| (ins[k].0[q], ins[k].1[q]));
            let out: [Complex; $radix] = $transform;
            (re[q], im[q]) = out[0];
            for j in 1..$radix {
                (re[j * stride + q], im[j * stride + q]) = times(out[j], $twiddles[j - 1]);
            }
        }
    }};
}

impl Pass<'_> {
    fn two(self, p: usize, twiddles: [Complex; 1]) {
        butterfly!(self, p, twiddles, 2, |a| [plus(a[0], a[1]), minus(a[0], a[1])]);
    }

    fn three(self, p: usize, twiddles: [Complex; 2]) {
        // sin 60°.
        const SINE: f64 = 0.866_025_403_784_438_6;
        butterfly!(self, p, twiddles, 3, |a| {
            let (sum, difference) = (plus(a[1], a[2]), scaled(turned(minus(a[1], a[2])), SINE));
            let middle = minus(a[0], scaled(sum, 0.5));
            [plus(a[0], sum), plus(middle, difference), minus(middle, difference)]
        });
    }

    fn four(self, p: usize, twiddles: [Complex; 3]) {
        butterfly!(self, p, twiddles, 4, |a| {
            let (even, even_difference) = (plus(a[0], a[2]), minus(a[0], a[2]));
            let (odd, odd_difference) = (plus(a[1], a[3]), turned(minus(a[1], a[3])));
            [
                plus(even, odd),
                plus(even_difference, odd_difference),
                minus(even, odd),
                minus(even_difference, odd_difference),
            ]
        });
    }

    fn five(self, p: usize, twiddles: [Complex; 4]) {
        // Cosines and sines of 72° and 144°.
        const C1: f64 = 0.309_016_994_374_947_45;
        const C2: f64 = -0.809_016_994_374_947_5;
        const S1: f64 = 0.951_056_516_295_153_5;
        const S2: f64 = 0.587_785_252_292_473_1;
        butterfly!(self, p, twiddles, 5, |a| {
            let (outer, outer_difference) = (plus(a[1], a[4]), turned(minus(a[1], a[4])));
            let (inner, inner_difference) = (plus(a[2], a[3]), turned(minus(a[2], a[3])));
            let first = plus(a[0], plus(scaled(outer, C1), scaled(inner, C2)));
            let second = plus(a[0], plus(scaled(outer, C2), scaled(inner, C1)));
            let first_turn = plus(scaled(outer_difference, S1), scaled(inner_difference, S2));
            let second_turn = minus(scaled(outer_difference, S2), scaled(inner_difference, S1));
            [
                plus(a[0], plus(outer, inner)),
                plus(first, first_turn),
                plus(second, second_turn),
                minus(second, second_turn),
                minus(first, first_turn),
            ]
        });
    }
}

/// Transforms of rectangles of one size; the sides are fast lengths.
#[derive(Clone, Debug)]
pub(crate) struct TransformPlan {
    rows: Transform,
    columns: Transform,
}

/// A rectangle of complex numbers, row by row.
#[derive(Clone, Debug)]
pub(crate) struct ComplexGrid {
    width: usize,
    data: ComplexLine,
}

impl ComplexGrid {
    pub(crate) fn zeros(width: usize, height: usize) -> Self {
        Self { width, data: ComplexLine::zeros(width * height) }
    }

    /// The real parts of a row.
    pub(crate) fn re(&self, y: usize) -> &[f64] {
        &self.data.re[y * self.width..(y + 1) * self.width]
    }

    /// The imaginary parts of a row.
    pub(crate) fn im(&self, y: usize) -> &[f64] {
        &self.data.im[y * self.width..(y + 1) * self.width]
    }

    /// The real parts of a row.
    pub(crate) fn re_mut(&mut self, y: usize) -> &mut [f64] {
        &mut self.data.re[y * self.width..(y + 1) * self.width]
    }

    /// The imaginary parts of a row.
    pub(crate) fn im_mut(&mut self, y: usize) -> &mut [f64] {
        &mut self.data.im[y * self.width..(y + 1) * self.width]
    }

    /// Multiplies by another grid of the same size.
    pub(crate) fn multiply(&mut self, by: &Self) {
        let ComplexLine { re, im } = &mut self.data;
        let factors = by.data.re.iter().zip(&by.data.im);
        for ((re, im), (a, b)) in re.iter_mut().zip(im).zip(factors) {
            (*re, *im) = times((*re, *im), (*a, *b));
        }
    }
}

impl TransformPlan {
    /// Transforms of `width` × `height` numbers.
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self { rows: Transform::new(width), columns: Transform::new(height) }
    }

    /// Columns.
    pub(crate) fn width(&self) -> usize {
        self.rows.n
    }

    /// Rows.
    pub(crate) fn height(&self) -> usize {
        self.columns.n
    }

    /// Σ a exp(−2πi (xu/w + yv/h)), where only the rows `used` are not zero.
    pub(crate) fn forward(&self, grid: &mut ComplexGrid, used: Range<usize>) {
        self.along_rows(grid, used);
        self.along_columns(grid);
    }

    /// Σ a exp(+2πi (xu/w + yv/h)), not divided by the number of points, in the rows `wanted`; the other rows are undefined.
    pub(crate) fn inverse(&self, grid: &mut ComplexGrid, rows: Range<usize>) {
        // The conjugate of the transform of the conjugate; exchanging the parts does the same.
        core::mem::swap(&mut grid.data.re, &mut grid.data.im);
        self.along_columns(grid);
        self.along_rows(grid, rows);
        core::mem::swap(&mut grid.data.re, &mut grid.data.im);
    }

    fn along_rows(&self, grid: &mut ComplexGrid, rows: Range<usize>) {
        let n = self.rows.n;
        let (mut strip, mut spare) = (ComplexLine::zeros(n * LANES), ComplexLine::zeros(n * LANES));
        for first in rows.clone().step_by(LANES) {
            let lanes = LANES.min(rows.end - first);
            resize(&mut strip, &mut spare, n * lanes);
            for lane in 0..lanes {
                let (re, im) = (grid.re(first + lane), grid.im(first + lane));
                for x in 0..n {
                    (strip.re[x * lanes + lane], strip.im[x * lanes + lane]) = (re[x], im[x]);
                }
            }
            self.rows.run(&mut strip, &mut spare, lanes);
            for lane in 0..lanes {
                let start = (first + lane) * n;
                for x in 0..n {
                    grid.data.re[start + x] = strip.re[x * lanes + lane];
                    grid.data.im[start + x] = strip.im[x * lanes + lane];
                }
            }
        }
    }

    fn along_columns(&self, grid: &mut ComplexGrid) {
        let (n, width) = (self.columns.n, grid.width);
        let (mut strip, mut spare) = (ComplexLine::zeros(n * LANES), ComplexLine::zeros(n * LANES));
        for first in (0..width).step_by(LANES) {
            let lanes = LANES.min(width - first);
            resize(&mut strip, &mut spare, n * lanes);
            for y in 0..n {
                let from = y * width + first;
                strip.re[y * lanes..(y + 1) * lanes].copy_from_slice(&grid.data.re[from..from + lanes]);
                strip.im[y * lanes..(y + 1) * lanes].copy_from_slice(&grid.data.im[from..from + lanes]);
            }
            self.columns.run(&mut strip, &mut spare, lanes);
            for y in 0..n {
                let to = y * width + first;
                grid.data.re[to..to + lanes].copy_from_slice(&strip.re[y * lanes..(y + 1) * lanes]);
                grid.data.im[to..to + lanes].copy_from_slice(&strip.im[y * lanes..(y + 1) * lanes]);
            }
        }
    }
}

fn resize(strip: &mut ComplexLine, spare: &mut ComplexLine, len: usize) {
    for list in [&mut strip.re, &mut strip.im, &mut spare.re, &mut spare.im] {
        list.resize(len, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers without a pattern that could favour the transform.
    fn noise(i: usize) -> f64 {
        let x = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(31).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (x >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }

    fn filled(width: usize, height: usize) -> ComplexGrid {
        let mut grid = ComplexGrid::zeros(width, height);
        for y in 0..height {
            grid.re_mut(y).iter_mut().enumerate().for_each(|(x, v)| *v = noise(y * width + x));
            grid.im_mut(y).iter_mut().enumerate().for_each(|(x, v)| *v = noise(7919 + y * width + x));
        }
        grid
    }

    #[test]
    fn it_is_the_sum_that_defines_it() {
        // Every radix, and more lines than a strip holds.
        let (width, height) = (20, 18);
        let before = filled(width, height);
        let mut after = before.clone();
        TransformPlan::new(width, height).forward(&mut after, 0..height);
        for (u, v) in [(0, 0), (1, 0), (0, 1), (7, 11), (19, 17)] {
            let mut sum = (0.0, 0.0);
            for y in 0..height {
                for x in 0..width {
                    let turns = (x * u) as f64 / width as f64 + (y * v) as f64 / height as f64;
                    let (s, c) = sin_cos(-2.0 * PI * turns);
                    sum = plus(sum, times((before.re(y)[x], before.im(y)[x]), (c, s)));
                }
            }
            let error = minus(sum, (after.re(v)[u], after.im(v)[u]));
            // 360 terms of size one half, each rounded.
            assert!(error.0.abs() < 1e-12 && error.1.abs() < 1e-12, "at ({u}, {v}): {error:?}");
        }
    }

    #[test]
    fn there_and_back_is_the_same() {
        for (width, height) in [(1, 1), (2, 3), (64, 5), (45, 16), (30, 40)] {
            let before = filled(width, height);
            let plan = TransformPlan::new(width, height);
            let mut after = before.clone();
            plan.forward(&mut after, 0..height);
            plan.inverse(&mut after, 0..height);
            let scale = 1.0 / (width * height) as f64;
            for y in 0..height {
                let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a * scale - b).abs() < 1e-14);
                assert!(close(after.re(y), before.re(y)) && close(after.im(y), before.im(y)), "{width} × {height}");
            }
        }
    }

    #[test]
    fn fast_lengths_have_small_factors() {
        let lengths: Vec<_> = [1, 7, 11, 101, 1025].into_iter().map(fast_length).collect();
        assert_eq!(lengths, [1, 8, 12, 108, 1080]);
    }
}
