//! Arithmetic on eight numbers at once.
//!
//! The accelerator's arithmetic is written once over [`Lanes`]. [`Plain`] computes lane by lane, with the operand order of the x86 instructions where
//! it matters (minimum and maximum of zeros and NaN). The AVX2 form does the same operations eight at a time. No operation is fused except
//! [`Lanes::mul_sub`], on which no result depends.

/// Eight f32, aligned for one load.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct F32x8(pub(crate) [f32; 8]);

/// Four f32, aligned for one load.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(crate) struct F32x4(pub(crate) [f32; 4]);

/// Index of one of six times eight numbers, as a byte offset.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlaneOffset(usize);

impl PlaneOffset {
    /// Index of a number below six.
    #[inline(always)]
    pub(crate) fn new(index: usize) -> Self {
        Self(index.min(5) * size_of::<F32x8>())
    }

    /// Byte offset from the first of the six: less than six times the size of [`F32x8`], and a multiple of it.
    #[inline(always)]
    pub(crate) fn bytes(self) -> usize {
        self.0
    }
}

/// An implementation of arithmetic on eight numbers at once. All implementations give the same bits.
pub(crate) trait Lanes: Copy {
    /// Eight numbers.
    type V: Copy;
    /// Eight booleans.
    type M: Copy;

    /// Loads eight numbers of six times as many.
    fn load_of(self, six: &[F32x8; 6], at: PlaneOffset) -> Self::V;
    /// Loads four numbers from one place and four from another.
    fn load_halves(self, low: &F32x4, high: &F32x4) -> Self::V;
    /// Stores eight numbers to memory.
    fn store(self, v: Self::V) -> F32x8;
    /// The same number eight times.
    fn splat(self, x: f32) -> Self::V;
    /// a + b
    fn add(self, a: Self::V, b: Self::V) -> Self::V;
    /// a − b
    fn sub(self, a: Self::V, b: Self::V) -> Self::V;
    /// a · b
    fn mul(self, a: Self::V, b: Self::V) -> Self::V;
    /// a · b − c, rounded once or twice: only where no result depends on the last bit
    fn mul_sub(self, a: Self::V, b: Self::V, c: Self::V) -> Self::V;
    /// a / b
    fn div(self, a: Self::V, b: Self::V) -> Self::V;
    /// a < b ? a : b
    fn min(self, a: Self::V, b: Self::V) -> Self::V;
    /// a > b ? a : b
    fn max(self, a: Self::V, b: Self::V) -> Self::V;
    /// |a|
    fn abs(self, a: Self::V) -> Self::V;
    /// a ≤ b; false for NaN
    fn le(self, a: Self::V, b: Self::V) -> Self::M;
    /// a < b; false for NaN
    fn lt(self, a: Self::V, b: Self::V) -> Self::M;
    /// Both.
    fn and(self, a: Self::M, b: Self::M) -> Self::M;
    /// Either.
    fn or(self, a: Self::M, b: Self::M) -> Self::M;
    /// Lane i in bit i.
    fn bits(self, m: Self::M) -> u32;
    /// Called at every visit of a traversal; only counting lanes use it.
    #[inline(always)]
    fn record_visit(self, _visit: Visit) {}
    /// Runs a task, compiled for these lanes.
    fn run<J: LaneTask>(self, job: J) -> J::Output;
}

/// A visit of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Visit {
    /// A node, whose eight boxes are tested at once.
    Node,
    /// A leaf of a mesh, whose triangles are tested at once.
    Leaf,
    Instance,
}

/// A task that can be compiled for any lanes.
pub(crate) trait LaneTask {
    type Output;
    /// Runs the task. Mark it `#[inline(always)]`, so that it is compiled with the lanes' instructions.
    fn work<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Lane by lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plain;

#[inline(always)]
fn zip(a: F32x8, b: F32x8, f: impl Fn(f32, f32) -> f32) -> F32x8 {
    F32x8(core::array::from_fn(|i| f(a.0[i], b.0[i])))
}

impl Lanes for Plain {
    type V = F32x8;
    type M = [bool; 8];

    #[inline(always)]
    fn load_of(self, six: &[F32x8; 6], at: PlaneOffset) -> F32x8 {
        six[at.bytes() / size_of::<F32x8>()]
    }
    #[inline(always)]
    fn load_halves(self, low: &F32x4, high: &F32x4) -> F32x8 {
        F32x8(core::array::from_fn(|i| if i < 4 { low.0[i] } else { high.0[i - 4] }))
    }
    #[inline(always)]
    fn store(self, v: F32x8) -> F32x8 {
        v
    }
    #[inline(always)]
    fn splat(self, x: f32) -> F32x8 {
        F32x8([x; 8])
    }
    #[inline(always)]
    fn add(self, a: F32x8, b: F32x8) -> F32x8 {
        zip(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, a: F32x8, b: F32x8) -> F32x8 {
        zip(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, a: F32x8, b: F32x8) -> F32x8 {
        zip(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn mul_sub(self, a: F32x8, b: F32x8, c: F32x8) -> F32x8 {
        self.sub(self.mul(a, b), c)
    }
    #[inline(always)]
    fn div(self, a: F32x8, b: F32x8) -> F32x8 {
        zip(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, a: F32x8, b: F32x8) -> F32x8 {
        zip(a, b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, a: F32x8, b: F32x8) -> F32x8 {
        zip(a, b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn abs(self, a: F32x8) -> F32x8 {
        F32x8(a.0.map(f32::abs))
    }
    #[inline(always)]
    fn le(self, a: F32x8, b: F32x8) -> [bool; 8] {
        core::array::from_fn(|i| a.0[i] <= b.0[i])
    }
    #[inline(always)]
    fn lt(self, a: F32x8, b: F32x8) -> [bool; 8] {
        core::array::from_fn(|i| a.0[i] < b.0[i])
    }
    #[inline(always)]
    fn and(self, a: [bool; 8], b: [bool; 8]) -> [bool; 8] {
        core::array::from_fn(|i| a[i] & b[i])
    }
    #[inline(always)]
    fn or(self, a: [bool; 8], b: [bool; 8]) -> [bool; 8] {
        core::array::from_fn(|i| a[i] | b[i])
    }
    #[inline(always)]
    fn bits(self, m: [bool; 8]) -> u32 {
        m.iter().enumerate().fold(0, |bits, (i, set)| bits | u32::from(*set) << i)
    }
    #[inline(always)]
    fn run<J: LaneTask>(self, job: J) -> J::Output {
        job.work(self)
    }
}
