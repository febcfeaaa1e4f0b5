//! How the system's allocator gives memory back.

/// Blocks from this size on are given back to the system as soon as they are freed, bytes: below it pages are used again, above it planes of pictures and
/// the vertices of files would stay, and a run would take more than it needs at any time.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
const LARGE_BYTES: core::ffi::c_int = 1 << 20;

/// Has large blocks given back. The C library otherwise raises the size from which it does so, up to 32 MiB, with every block that is freed.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub(crate) fn give_back_large_blocks() {
    use core::ffi::c_int;
    /// `M_MMAP_THRESHOLD` of `malloc.h`.
    const MMAP_THRESHOLD: c_int = -3;
    // SAFETY: the signature is that of glibc.
    #[allow(unsafe_code)]
    unsafe extern "C" {
        fn mallopt(parameter: c_int, value: c_int) -> c_int;
    }
    // SAFETY: `mallopt` takes two numbers; other threads, which it must not race with, do not exist yet. Where it refuses, all is as before.
    #[allow(unsafe_code)]
    unsafe {
        mallopt(MMAP_THRESHOLD, LARGE_BYTES)
    };
}

/// Nothing is known of other C libraries.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub(crate) fn give_back_large_blocks() {}
