//! Worker threads.

use crate::clock::cpu_s;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// A pool of threads.
pub fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started")
}

/// What `work` answers on a pool, and the processor time of the pool's busiest thread, s.
pub fn busiest<R: Send>(pool: &ThreadPool, work: impl FnOnce() -> R + Send) -> (R, f64) {
    let before = pool.broadcast(|_| cpu_s());
    let answer = pool.install(work);
    let after = pool.broadcast(|_| cpu_s());
    (answer, after.iter().zip(&before).map(|(after, before)| after - before).fold(0.0, f64::max))
}
