//! Memory that is held, by either program: a counting allocator for ours, the device's memory monitor for Embree.

use core::ffi::c_void;
use core::sync::atomic::{AtomicIsize, Ordering};
use std::alloc::{GlobalAlloc, Layout, System};

/// Bytes that are held, and the most that were since the count began.
pub struct Meter {
    held: AtomicIsize,
    most: AtomicIsize,
}

/// What Rust code holds: Étendue and this program, not Embree.
pub static OURS: Meter = Meter::new();
/// What Embree's devices hold.
pub static EMBREES: Meter = Meter::new();

/// What some work added to the bytes that were held before.
#[derive(Clone, Copy, Debug)]
pub struct Added {
    /// At most while it ran.
    pub peak: isize,
    /// When it was done, its answer included.
    pub held: isize,
}

impl Meter {
    const fn new() -> Self {
        Self { held: AtomicIsize::new(0), most: AtomicIsize::new(0) }
    }

    fn add(&self, bytes: isize) {
        let held = self.held.fetch_add(bytes, Ordering::Relaxed) + bytes;
        if bytes > 0 {
            self.most.fetch_max(held, Ordering::Relaxed);
        }
    }

    /// What `work` answers, and what it added. Nothing else may allocate at the same time.
    pub fn measure<R>(&self, work: impl FnOnce() -> R) -> (R, Added) {
        let before = self.held.load(Ordering::Relaxed);
        self.most.store(before, Ordering::Relaxed);
        let answer = work();
        let (most, held) = (self.most.load(Ordering::Relaxed), self.held.load(Ordering::Relaxed));
        (answer, Added { peak: most - before, held: held - before })
    }
}

/// The system's allocator, counted by [`OURS`]: bytes asked for, without what the system adds.
pub struct Counting;

// SAFETY: all is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        OURS.add(layout.size() as isize);
        // SAFETY: as the caller's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        OURS.add(layout.size() as isize);
        // SAFETY: as the caller's.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        OURS.add(-(layout.size() as isize));
        // SAFETY: as the caller's.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        OURS.add(size as isize - layout.size() as isize);
        // SAFETY: as the caller's.
        unsafe { System.realloc(at, layout, size) }
    }
}

/// RTCMemoryMonitorFunction: allows everything and counts it.
pub extern "C" fn monitor(_: *mut c_void, bytes: isize, _post: bool) -> bool {
    EMBREES.add(bytes);
    true
}
