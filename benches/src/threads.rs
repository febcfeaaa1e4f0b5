//! Worker threads.

use rayon::{ThreadPool, ThreadPoolBuilder};

/// A pool of threads.
pub fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started")
}
