//! Eight lanes by AVX2, if the machine has it. The only file with unsafe code: the instructions exist only on some machines, and a value of [`Avx2`]
//! is the proof that they exist on this one.

#![allow(unsafe_code, reason = "vector instructions that are chosen at run time")]

use core::arch::x86_64::*;

use super::lanes::{F32x4, F32x8, LaneTask, Lanes, PlaneOffset};

/// Proof that this machine has AVX2 with fused multiplication and bit-manipulation instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

impl Avx2 {
    /// The lanes, if this machine has them.
    pub(crate) fn detect() -> Option<Self> {
        let has_all = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2");
        has_all.then_some(Self(()))
    }
}

// SAFETY, for every block below: an `Avx2` exists only where AVX2 was detected. Loads and stores go through references
// to eight or four floats, which their types align.
impl Lanes for Avx2 {
    type V = __m256;
    type M = __m256;

    #[inline(always)]
    fn load_of(self, six: &[F32x8; 6], at: PlaneOffset) -> __m256 {
        // SAFETY: see above; an `OfSix` stays within the six and is a multiple of the size of one.
        unsafe { _mm256_load_ps(six.as_ptr().byte_add(at.bytes()).cast()) }
    }
    #[inline(always)]
    fn load_halves(self, low: &F32x4, high: &F32x4) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_set_m128(_mm_load_ps(high.0.as_ptr()), _mm_load_ps(low.0.as_ptr())) }
    }
    #[inline(always)]
    fn store(self, v: __m256) -> F32x8 {
        let mut to = F32x8([0.0; 8]);
        // SAFETY: see above.
        unsafe { _mm256_store_ps(to.0.as_mut_ptr(), v) };
        to
    }
    #[inline(always)]
    fn splat(self, x: f32) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_set1_ps(x) }
    }
    #[inline(always)]
    fn add(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_add_ps(a, b) }
    }
    #[inline(always)]
    fn sub(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_sub_ps(a, b) }
    }
    #[inline(always)]
    fn mul(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_mul_ps(a, b) }
    }
    #[inline(always)]
    fn mul_sub(self, a: __m256, b: __m256, c: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_fmsub_ps(a, b, c) }
    }
    #[inline(always)]
    fn div(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_div_ps(a, b) }
    }
    #[inline(always)]
    fn min(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_min_ps(a, b) }
    }
    #[inline(always)]
    fn max(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_max_ps(a, b) }
    }
    #[inline(always)]
    fn abs(self, a: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), a) }
    }
    #[inline(always)]
    fn le(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(a, b) }
    }
    #[inline(always)]
    fn lt(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(a, b) }
    }
    #[inline(always)]
    fn and(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_and_ps(a, b) }
    }
    #[inline(always)]
    fn or(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: see above.
        unsafe { _mm256_or_ps(a, b) }
    }
    #[inline(always)]
    fn bits(self, m: __m256) -> u32 {
        // SAFETY: see above.
        unsafe { _mm256_movemask_ps(m) as u32 }
    }
    #[inline(always)]
    fn run<J: LaneTask>(self, job: J) -> J::Output {
        #[target_feature(enable = "avx2,fma,bmi1,bmi2")]
        fn with_avx2<J: LaneTask>(lanes: Avx2, job: J) -> J::Output {
            job.work(lanes)
        }
        // SAFETY: see above.
        unsafe { with_avx2(self, job) }
    }
}
