//! Convolution of an image with a kernel, and its cost. Light from outside the image is zero.
//!
//! Few taps are summed directly. Many use the Fourier transform by blocks of the result, two blocks at once as real and imaginary part; the number of
//! blocks is the cheapest one.

use core::iter::Sum;
use core::ops::{Add, Mul, Range};

use super::fourier::{ComplexGrid, TransformPlan, fast_length};
use super::kernel::Kernel;

/// Maximum number of taps for direct summation.
const DIRECT_TAPS: usize = 49;
/// Maximum number of blocks along an axis.
const MAX_BLOCKS: usize = 24;

/// Numbers in a rectangle, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NumberField {
    pub(crate) width: usize,
    pub(crate) values: Vec<f64>,
}

impl NumberField {
    pub(crate) fn zeros(width: usize, height: usize) -> Self {
        Self { width, values: vec![0.0; width * height] }
    }

    pub(crate) fn height(&self) -> usize {
        self.values.len() / self.width.max(1)
    }

    pub(crate) fn row(&self, y: usize) -> &[f64] {
        &self.values[y * self.width..(y + 1) * self.width]
    }

    pub(crate) fn row_mut(&mut self, y: usize) -> &mut [f64] {
        &mut self.values[y * self.width..(y + 1) * self.width]
    }
}

/// A rectangle of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Region {
    pub(crate) x: Range<usize>,
    pub(crate) y: Range<usize>,
}

/// A kernel prepared for images of one size and a region of them.
#[derive(Clone, Debug)]
pub(crate) struct Convolver {
    region: Region,
    method: Method,
}

#[derive(Clone, Debug)]
enum Method {
    Direct(Vec<(isize, isize, f64)>),
    Fourier { plan: Box<TransformPlan>, spectrum: Box<ComplexGrid>, blocks: Vec<Block> },
}

/// A block of the result, and the part of the image that it needs.
#[derive(Clone, Debug)]
struct Block {
    out: Region,
    from: Region,
}

impl Convolver {
    /// Prepares `kernel` for images of `size`, of which `region` of the result is needed.
    pub(crate) fn new(kernel: &Kernel, size: [usize; 2], region: Region) -> Self {
        let taps: Vec<_> = kernel.taps().collect();
        let method = if taps.len() <= DIRECT_TAPS { Method::Direct(taps) } else { fourier(kernel, size, &region) };
        Self { region, method }
    }

    /// The convolved region of the image.
    pub(crate) fn apply(&self, image: &NumberField) -> NumberField {
        let mut result = NumberField::zeros(self.region.x.len(), self.region.y.len());
        match &self.method {
            Method::Direct(taps) => {
                for (dx, dy, tap) in taps {
                    self.add_tap(image, *dx, *dy, *tap, &mut result);
                }
            }
            Method::Fourier { plan, spectrum, blocks } => {
                for pair in blocks.chunks(2) {
                    let grid = through(plan, spectrum, pair, image);
                    pair.iter().enumerate().for_each(|(part, block)| self.take(&grid, block, part, &mut result));
                }
            }
        }
        result
    }

    fn add_tap(&self, image: &NumberField, dx: isize, dy: isize, tap: f64, result: &mut NumberField) {
        let (height, width) = (image.height(), image.width);
        for y in self.region.y.clone() {
            let Some(from) = y.checked_add_signed(-dy).filter(|from| *from < height) else { continue };
            let to = result.row_mut(y - self.region.y.start);
            for x in self.region.x.clone() {
                if let Some(from_x) = x.checked_add_signed(-dx).filter(|from| *from < width) {
                    to[x - self.region.x.start] += tap * image.row(from)[from_x];
                }
            }
        }
    }

    /// Copies a block out of the real or the imaginary part.
    fn take(&self, grid: &ComplexGrid, block: &Block, part: usize, result: &mut NumberField) {
        let shift = block.out.x.start - block.from.x.start;
        for y in block.out.y.clone() {
            let row = y - block.from.y.start;
            let values = if part == 0 { grid.re(row) } else { grid.im(row) };
            let start = block.out.x.start - self.region.x.start;
            let to = &mut result.row_mut(y - self.region.y.start)[start..start + block.out.x.len()];
            to.copy_from_slice(&values[shift..shift + block.out.x.len()]);
        }
    }
}

/// Transforms a pair of blocks, multiplies and transforms back.
fn through(plan: &TransformPlan, spectrum: &ComplexGrid, pair: &[Block], image: &NumberField) -> ComplexGrid {
    let mut grid = ComplexGrid::zeros(plan.width(), plan.height());
    let rows = |of: fn(&Block) -> Range<usize>| pair.iter().map(|b| of(b).end).max().unwrap_or(0);
    for (part, Block { from, .. }) in pair.iter().enumerate() {
        for (row, y) in from.y.clone().enumerate() {
            let to = if part == 0 { grid.re_mut(row) } else { grid.im_mut(row) };
            to[..from.x.len()].copy_from_slice(&image.row(y)[from.x.clone()]);
        }
    }
    plan.forward(&mut grid, 0..rows(|b| 0..b.from.y.len()));
    grid.multiply(spectrum);
    plan.inverse(&mut grid, 0..rows(|b| 0..b.out.y.end - b.from.y.start));
    grid
}

/// Operation counts of a kernel without zero taps on images of `size`, of which `region` of the result is needed.
pub(super) fn operation_counts(
    reach: [usize; 2],
    size: [usize; 2],
    region: &Region,
    uses: UsageCounts,
) -> OperationCounts {
    let taps = (2 * reach[0] + 1) * (2 * reach[1] + 1);
    if taps <= DIRECT_TAPS {
        return OperationCounts {
            taps: uses.applied * (taps * region.x.len() * region.y.len()) as f64,
            ..OperationCounts::default()
        };
    }
    let BlockLayout { blocks, sides } = BlockLayout::best(reach, size, region);
    let pairs = (blocks[0] * blocks[1]).div_ceil(2) as f64;
    // One forward and one inverse transform per pair of blocks.
    let transforms = uses.ready + 2.0 * pairs * uses.applied;
    OperationCounts { transformed: transforms * effort(sides), ..OperationCounts::default() }
}

/// Blocks across and down, and the sides of their transform.
struct BlockLayout {
    blocks: [usize; 2],
    sides: [usize; 2],
}

impl BlockLayout {
    /// The cheapest division into blocks.
    fn best(reach: [usize; 2], size: [usize; 2], region: &Region) -> Self {
        let lengths = |range: &Range<usize>, axis: usize| -> Vec<usize> {
            (1..=MAX_BLOCKS).map(|count| length(&spans(range, count, reach[axis], size[axis]))).collect()
        };
        let (widths, heights) = (lengths(&region.x, 0), lengths(&region.y, 1));
        let (mut best, mut cost) = (Self { blocks: [1, 1], sides: [widths[0], heights[0]] }, f64::INFINITY);
        for (width, columns) in widths.iter().zip(1_usize..) {
            for (height, rows) in heights.iter().zip(1_usize..) {
                let sides = [*width, *height];
                let this = (columns * rows).div_ceil(2) as f64 * effort(sides);
                if this < cost {
                    (best, cost) = (Self { blocks: [columns, rows], sides }, this);
                }
            }
        }
        best
    }
}

fn fourier(kernel: &Kernel, size: [usize; 2], region: &Region) -> Method {
    let [rx, ry] = kernel.reach();
    let BlockLayout { blocks, sides } = BlockLayout::best([rx, ry], size, region);
    let (across, down) = (spans(&region.x, blocks[0], rx, size[0]), spans(&region.y, blocks[1], ry, size[1]));
    let plan = Box::new(TransformPlan::new(sides[0], sides[1]));
    let pairs = down.iter().flat_map(|y| across.iter().map(move |x| (x, y)));
    let block = |(x, y): (&BlockSpan, &BlockSpan)| Block {
        out: Region { x: x.out.clone(), y: y.out.clone() },
        from: Region { x: x.from.clone(), y: y.from.clone() },
    };
    let blocks = pairs.map(block).collect();
    Method::Fourier { spectrum: Box::new(spectrum(kernel, &plan)), plan, blocks }
}

/// Cost of a transform of this size, in arbitrary units: n log n.
fn effort([width, height]: [usize; 2]) -> f64 {
    let bits = |n: usize| f64::from(usize::BITS - n.leading_zeros());
    (width * height) as f64 * (bits(width) + bits(height))
}

/// A block along one axis.
struct BlockSpan {
    out: Range<usize>,
    from: Range<usize>,
    reach: usize,
}

/// Divides `wanted` into `count` parts of nearly equal length, each with the input it needs of an image of length `size`.
fn spans(range: &Range<usize>, count: usize, reach: usize, size: usize) -> Vec<BlockSpan> {
    let end = |i: usize| range.start + range.len() * i / count;
    let span = |i: usize| {
        let out = end(i)..end(i + 1);
        BlockSpan { from: out.start.saturating_sub(reach)..(out.end + reach).min(size), out, reach }
    };
    (0..count).map(span).filter(|span| !span.out.is_empty()).collect()
}

/// The transform length at which no block overlaps its own periodic copies.
fn length(spans: &[BlockSpan]) -> usize {
    let need = |BlockSpan { out, from, reach }: &BlockSpan| {
        let furthest = (from.end - out.start).max(out.end - from.start);
        furthest + (*reach).min(furthest)
    };
    fast_length(spans.iter().map(need).max().unwrap_or(1))
}

/// The transform of the kernel, divided by the number of points.
fn spectrum(kernel: &Kernel, plan: &TransformPlan) -> ComplexGrid {
    let mut grid = ComplexGrid::zeros(plan.width(), plan.height());
    let scale = 1.0 / (plan.width() * plan.height()) as f64;
    for (x, y, tap) in kernel.taps() {
        // Taps farther apart than any two pixels of a block fall outside and are left out.
        if x.unsigned_abs() < plan.width().div_ceil(2) && y.unsigned_abs() < plan.height().div_ceil(2) {
            let column = x.rem_euclid(plan.width() as isize) as usize;
            grid.re_mut(y.rem_euclid(plan.height() as isize) as usize)[column] += tap * scale;
        }
    }
    plan.forward(&mut grid, 0..plan.height());
    grid
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OperationCounts {
    /// Products of a pixel and a tap in direct summation.
    pub taps: f64,
    /// Values that pass a Fourier transform, each times the bits of the lengths of both sides.
    pub transformed: f64,
    /// Points of light distributed over the taps of kernels.
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

/// Number of times a kernel is prepared, and number of images it is applied to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UsageCounts {
    pub(super) ready: f64,
    pub(super) applied: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn test_image(width: usize, height: usize) -> NumberField {
        let value = |i: usize| ((i * 7919 + 104_729) % 1013) as f64 / 1013.0;
        NumberField { width, values: (0..width * height).map(value).collect() }
    }

    fn kernel(reach: [usize; 2]) -> Kernel {
        let mut kernel = Kernel::zeros(reach);
        for y in -(reach[1] as isize)..=reach[1] as isize {
            for x in -(reach[0] as isize)..=reach[0] as isize {
                kernel.add(x, y, 1.0 / (1.0 + (x * x + 2 * y * y + x) as f64).abs());
            }
        }
        kernel
    }

    /// The sum that defines a convolution.
    fn summed(kernel: &Kernel, image: &NumberField, region: &Region) -> NumberField {
        let mut result = NumberField::zeros(region.x.len(), region.y.len());
        for (j, y) in region.y.clone().enumerate() {
            for (i, x) in region.x.clone().enumerate() {
                let from = (0..image.values.len()).map(|k| {
                    let (u, v) = (k % image.width, k / image.width);
                    image.values[k] * kernel.at(x as isize - u as isize, y as isize - v as isize)
                });
                result.row_mut(j)[i] = from.sum();
            }
        }
        result
    }

    #[test]
    fn blocks_are_the_sum_for_kernels_small_and_wider_than_the_image() {
        let (width, height) = (61, 37);
        let image = test_image(width, height);
        let everything = Region { x: 0..width, y: 0..height };
        let inner = Region { x: 9..50, y: 4..36 };
        for reach in [[1, 1], [3, 3], [5, 9], [30, 20], [60, 36], [100, 50]] {
            let kernel = kernel(reach);
            for region in [&everything, &inner] {
                let actual = Convolver::new(&kernel, [width, height], region.clone()).apply(&image);
                let expected = summed(&kernel, &image, region);
                let error = actual.values.iter().zip(&expected.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                // Sums of 2257 terms below 1: rounding of the transform.
                assert!(error < 1e-11, "{reach:?} {region:?}: {error}");
            }
        }
    }

    #[test]
    fn large_images_go_by_blocks() {
        let (width, height) = (400, 300);
        let image = test_image(width, height);
        let kernel = kernel([6, 5]);
        let region = Region { x: 0..width, y: 0..height };
        let convolver = Convolver::new(&kernel, [width, height], region);
        assert!(matches!(&convolver.method, Method::Fourier { blocks, .. } if blocks.len() > 4));
        let actual = convolver.apply(&image);
        for (x, y) in [(0, 0), (399, 299), (133, 77), (200, 150)] {
            let region = Region { x: x..x + 1, y: y..y + 1 };
            let expected = summed(&kernel, &image, &region).values[0];
            assert!((actual.row(y)[x] - expected).abs() < 1e-11);
        }
    }

    #[test]
    fn a_kernel_of_one_tap_is_the_identity_to_the_bit() {
        let mut kernel = Kernel::zeros([2, 2]);
        kernel.add(0, 0, 1.0);
        let image = test_image(20, 10);
        let region = Region { x: 0..20, y: 0..10 };
        assert_eq!(Convolver::new(&kernel, [20, 10], region).apply(&image), image);
    }
}
