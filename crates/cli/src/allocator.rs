//! Settings of the C library's allocator: large freed blocks are returned to the system at once.

/// Minimum size of blocks that are returned to the system as soon as they are freed, bytes. Smaller blocks are reused. Larger ones, such as planes of
/// images and vertices of mesh files, would stay allocated, and a run would take more memory than it needs at any time.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const LARGE_BYTES: core::ffi::c_int = 1 << 20;

/// Fixes the size from which freed blocks are returned to the system. The C library otherwise raises this threshold, up to 32 MiB, with each freed block.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub(crate) fn return_large_blocks() {
    use core::ffi::c_int;
    /// `M_MMAP_THRESHOLD` of `malloc.h`.
    const MMAP_THRESHOLD: c_int = -3;
    // SAFETY: the signature is that of glibc.
    #[allow(unsafe_code)]
    unsafe extern "C" {
        fn mallopt(parameter: c_int, value: c_int) -> c_int;
    }
    // SAFETY: `mallopt` takes two numbers; no other threads, which it must not race with, exist yet. If it fails, nothing changes.
    #[allow(unsafe_code)]
    unsafe {
        mallopt(MMAP_THRESHOLD, LARGE_BYTES)
    };
}

/// Does nothing: other C libraries have no such setting that is known here.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub(crate) fn return_large_blocks() {}
