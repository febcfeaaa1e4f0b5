//! Splits of a range of references in two: the surface area heuristic over bins.
//!
//! The split is the plane between bins of the centres' box, on any axis, at which the sum over both sides of (area of the box × number of primitives)
//! is least (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies"). References are reordered within their range, in the same
//! way whatever the number of threads.

use glam::Vec4;

use super::reference::{Extent, Reference};

/// Ranges of fewer references are split between 8 bins per axis, others between 32.
const MIN_FINE_REFERENCES: usize = 64;
/// Longer ranges are binned in pieces, by as many threads as there are.
const PIECE_LENGTH: usize = 1 << 15;

/// Bounds of a range of references.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReferenceRange {
    /// The box of all of them.
    pub(super) extent: Extent,
    /// The box of their centres.
    centres: Extent,
}

impl ReferenceRange {
    const EMPTY: Self = Self { extent: Extent::EMPTY, centres: Extent::EMPTY };

    #[inline(always)]
    fn union(self, other: Self) -> Self {
        Self { extent: self.extent.union(&other.extent), centres: self.centres.union(&other.centres) }
    }

    /// The range of these references.
    pub(super) fn from_references(references: &[Reference]) -> Self {
        let of = |piece: &[Reference]| {
            let mut range = Self::EMPTY;
            piece.iter().for_each(|r| {
                range.extent.add(r);
                range.centres.add_point(r.centre());
            });
            range
        };
        in_pieces(references, of, Self::union)
    }

    /// The axis on which centres spread most.
    fn longest_axis(&self) -> usize {
        let size = self.centres.size();
        (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best })
    }
}

/// Two ranges split from one: number of references in the first, and the bounds of both.
pub(super) struct SplitRanges {
    pub(super) at: usize,
    pub(super) ranges: [ReferenceRange; 2],
}

/// Splits two references or more so that each side has at least one.
pub(super) fn cut(references: &mut [Reference], range: &ReferenceRange) -> SplitRanges {
    let best = match references.len() {
        ..=2 => None,
        3..MIN_FINE_REFERENCES => best_plane::<8>(references, range),
        _ => best_plane::<32>(references, range),
    };
    match best {
        Some((grid, plane)) => partition(references, &grid, &plane),
        None => cut_anywhere(references),
    }
}

/// Splits references into halves by count, along the axis on which their centres spread most.
pub(super) fn halve(references: &mut [Reference], range: &ReferenceRange) -> SplitRanges {
    let axis = range.longest_axis();
    let along = |r: &Reference| r.centre()[axis];
    references.select_nth_unstable_by(references.len() / 2, |a, b| {
        along(a).total_cmp(&along(b)).then(a.primitive().cmp(&b.primitive()))
    });
    cut_anywhere(references)
}

/// The first half and the second.
fn cut_anywhere(references: &[Reference]) -> SplitRanges {
    let at = references.len() / 2;
    SplitRanges {
        at,
        ranges: [
            ReferenceRange::from_references(&references[..at]),
            ReferenceRange::from_references(&references[at..]),
        ],
    }
}

/// Applies `of` to pieces of a long range and combines the results from the first to the last; applies it to a short range as a whole.
#[inline(always)]
fn in_pieces<T: Send>(
    references: &[Reference],
    of: impl Fn(&[Reference]) -> T + Sync + Send,
    join: fn(T, T) -> T,
) -> T {
    use rayon::prelude::*;
    if references.len() <= PIECE_LENGTH {
        return of(references);
    }
    let pieces: Vec<T> = references.par_chunks(PIECE_LENGTH).map(of).collect();
    pieces.into_iter().reduce(join).expect("a long range has pieces")
}

/// Bins of a range on each axis: from a centre to its bin.
#[derive(Clone, Copy, Debug)]
struct BinGrid {
    low: Vec4,
    /// Bins per unit of length; 0 on an axis without extent.
    scale: Vec4,
    /// Number of bins minus one.
    last: u32,
}

impl BinGrid {
    #[inline(always)]
    fn new(centres: &Extent, bins: usize) -> Self {
        let scale = (bins as f32 * (1.0 - 1e-6)) / centres.size();
        let finite = Vec4::select(scale.cmplt(Vec4::INFINITY), scale, Vec4::ZERO);
        Self { low: centres.low(), scale: finite, last: bins as u32 - 1 }
    }

    /// A centre's bin on each axis.
    #[inline(always)]
    fn bins(&self, centre: Vec4) -> [usize; 3] {
        let [x, y, z, _] = ((centre - self.low) * self.scale).to_array();
        [x, y, z].map(|b| (b as u32).min(self.last) as usize)
    }

    /// A centre's bin on one axis.
    #[inline(always)]
    fn bin(&self, centre: Vec4, axis: usize) -> usize {
        (((centre[axis] - self.low[axis]) * self.scale[axis]) as u32).min(self.last) as usize
    }
}

/// Contents of a range of bins.
#[derive(Clone, Copy, Debug)]
struct BinRange {
    extent: Extent,
    count: u32,
}

impl BinRange {
    const EMPTY: Self = Self { extent: Extent::EMPTY, count: 0 };

    #[inline(always)]
    fn add(&mut self, extent: &Extent, count: u32) {
        self.extent = self.extent.union(extent);
        self.count += count;
    }

    /// Area × number.
    #[inline(always)]
    fn cost(&self) -> f32 {
        self.extent.half_area() * self.count as f32
    }
}

/// Bins of each axis.
#[derive(Clone, Copy)]
struct Bins<const B: usize> {
    extents: [[Extent; B]; 3],
    counts: [[u32; B]; 3],
}

impl<const B: usize> Bins<B> {
    #[inline(always)]
    fn from_references(references: &[Reference], grid: &BinGrid) -> Self {
        let mut bins = Self { extents: [[Extent::EMPTY; B]; 3], counts: [[0; B]; 3] };
        for reference in references {
            let [x, y, z] = grid.bins(reference.centre()).map(|bin| bin % B);
            bins.extents[0][x].add(reference);
            bins.extents[1][y].add(reference);
            bins.extents[2][z].add(reference);
            bins.counts[0][x] += 1;
            bins.counts[1][y] += 1;
            bins.counts[2][z] += 1;
        }
        bins
    }

    fn union(mut self, other: Self) -> Self {
        for axis in 0..3 {
            for bin in 0..B {
                self.extents[axis][bin] = self.extents[axis][bin].union(&other.extents[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
        self
    }

    /// The best plane of an axis; `None` if all are in one bin.
    #[inline(always)]
    fn plane(&self, axis: usize) -> Option<SplitPlane> {
        let (extents, counts) = (&self.extents[axis], &self.counts[axis]);
        let mut after = [BinRange::EMPTY; B];
        let mut sum = BinRange::EMPTY;
        for i in (1..B).rev() {
            sum.add(&extents[i], counts[i]);
            after[i] = sum;
        }
        let (mut before, mut best) = (BinRange::EMPTY, None::<SplitPlane>);
        for i in 1..B {
            before.add(&extents[i - 1], counts[i - 1]);
            if before.count == 0 || after[i].count == 0 {
                continue;
            }
            let cost = before.cost() + after[i].cost();
            if best.is_none_or(|b| cost < b.cost) {
                best = Some(SplitPlane { cost, axis, bin: i, extents: [before.extent, after[i].extent] });
            }
        }
        best
    }
}

/// A plane before a bin of an axis, and both of its sides.
#[derive(Clone, Copy, Debug)]
struct SplitPlane {
    cost: f32,
    axis: usize,
    bin: usize,
    extents: [Extent; 2],
}

/// The best of all planes between the bins of each axis; `None` if all centres coincide.
#[inline(never)]
fn best_plane<const B: usize>(references: &[Reference], range: &ReferenceRange) -> Option<(BinGrid, SplitPlane)> {
    let grid = BinGrid::new(&range.centres, B);
    let bins = in_pieces(references, |piece| Bins::<B>::from_references(piece, &grid), Bins::union);
    let planes = (0..3).filter_map(|axis| bins.plane(axis));
    let best = planes.reduce(|a, b| if b.cost < a.cost { b } else { a })?;
    Some((grid, best))
}

/// Moves those before the plane to the front.
fn partition(references: &mut [Reference], grid: &BinGrid, plane: &SplitPlane) -> SplitRanges {
    let is_before = |centre| grid.bin(centre, plane.axis) < plane.bin;
    let (mut begin, mut end) = (0, references.len());
    let [mut before, mut after] = [Extent::EMPTY; 2];
    loop {
        while begin < end {
            let centre = references[begin].centre();
            if !is_before(centre) {
                break;
            }
            before.add_point(centre);
            begin += 1;
        }
        while begin < end {
            let centre = references[end - 1].centre();
            if is_before(centre) {
                break;
            }
            after.add_point(centre);
            end -= 1;
        }
        if begin == end {
            break;
        }
        references.swap(begin, end - 1);
    }
    let [first, second] = plane.extents;
    SplitRanges {
        at: begin,
        ranges: [ReferenceRange { extent: first, centres: before }, ReferenceRange { extent: second, centres: after }],
    }
}
