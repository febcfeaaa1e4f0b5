//! Detects a program that was started without a standard output (`>&-`).
//!
//! Before `main` the Rust runtime opens `/dev/null` for closed standard streams, so that results would be lost without an error. The check must run
//! earlier: functions that the loader calls first are listed in a section of the program (ELF `.init_array`, Mach-O `__mod_init_func`). Without such
//! a list (Windows) a closed output counts as an open one.

#[cfg(any(target_os = "linux", target_vendor = "apple"))]
use core::ffi::c_int;
use std::sync::atomic::{AtomicBool, Ordering};

static IS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Returns true if there was no standard output when the program was started.
pub(crate) fn is_closed() -> bool {
    IS_CLOSED.load(Ordering::Relaxed)
}

#[cfg(any(target_os = "linux", target_vendor = "apple"))]
const STDOUT: c_int = 1;
/// POSIX command that reads the flags of a descriptor, -1 if there is none of that number. It is 1 on all systems of the list.
#[cfg(any(target_os = "linux", target_vendor = "apple"))]
const F_GETFD: c_int = 1;

// SAFETY: the signature is that of POSIX.
#[cfg(any(target_os = "linux", target_vendor = "apple"))]
#[allow(unsafe_code)]
unsafe extern "C" {
    fn fcntl(descriptor: c_int, command: c_int, ...) -> c_int;
}

#[cfg(any(target_os = "linux", target_vendor = "apple"))]
#[allow(unsafe_code)]
extern "C" fn check() {
    // SAFETY: `fcntl` with F_GETFD takes no further argument, accesses no memory of the program and is allowed for every number.
    let flags = unsafe { fcntl(STDOUT, F_GETFD) };
    IS_CLOSED.store(flags == -1, Ordering::Relaxed);
}

// SAFETY: the section is a list of functions of this type; their arguments may be ignored.
#[cfg(any(target_os = "linux", target_vendor = "apple"))]
#[allow(unsafe_code)]
#[used]
#[cfg_attr(target_os = "linux", unsafe(link_section = ".init_array"))]
#[cfg_attr(target_vendor = "apple", unsafe(link_section = "__DATA,__mod_init_func"))]
static CHECK: extern "C" fn() = check;
