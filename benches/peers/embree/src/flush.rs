//! Denormal numbers as zero, as Embree's manual asks of its callers' threads. Étendue keeps them.

/// Runs `work` with denormal numbers taken and made as zero.
#[cfg(target_arch = "x86_64")]
#[allow(deprecated, reason = "the register is put back before any other floating-point code of ours runs")]
pub fn to_zero<R>(work: impl FnOnce() -> R) -> R {
    use core::arch::x86_64::{_mm_getcsr, _mm_setcsr};
    const FLUSH: u32 = 0x8000 | 0x0040;
    // SAFETY: every x86-64 has the register; only results that are denormal change.
    let before = unsafe { _mm_getcsr() };
    unsafe { _mm_setcsr(before | FLUSH) };
    let answer = work();
    unsafe { _mm_setcsr(before) };
    answer
}

/// Runs `work`.
#[cfg(not(target_arch = "x86_64"))]
pub fn to_zero<R>(work: impl FnOnce() -> R) -> R {
    work()
}
