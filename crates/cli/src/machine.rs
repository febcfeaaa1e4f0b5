//! The machine's threads and instruction sets. They change the duration of a run, not the result.

use crate::console::{Console, print_paths};
use etendue::{Error, ErrorCode, Simd};
use std::path::PathBuf;

/// The environment variable that selects the accelerator's instruction set: `auto` (default) or `scalar`.
const SIMD_VARIABLE: &str = "ETENDUE_SIMD";

/// A pool of worker threads; `None` for one per processor.
pub fn pool(threads: Option<u32>) -> Result<rayon::ThreadPool, Error> {
    let builder = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0) as usize);
    builder.build().map_err(|error| Error::Run(format!("the worker threads cannot be started: {error}")))
}

/// Runs a task with one thread per processor, and prints the files that it wrote.
pub fn print_written(
    console: &dyn Console,
    task: impl FnOnce() -> Result<Vec<PathBuf>, Error> + Send,
) -> Result<(), Error> {
    print_paths(console, &pool(None)?.install(task)?);
    Ok(())
}

/// The instruction set requested by the environment.
pub fn simd() -> Result<Simd, Error> {
    match std::env::var(SIMD_VARIABLE).as_deref() {
        Err(_) | Ok("" | "auto") => Ok(Simd::Auto),
        Ok("scalar") => Ok(Simd::Scalar),
        Ok(other) => {
            Err(Error::coded(ErrorCode::InvalidArgument, format!("{SIMD_VARIABLE}={other}: expected auto or scalar")))
        }
    }
}

/// Processor time of all threads of this process, s; `None` if the system does not state it.
pub fn processor_seconds() -> Option<f64> {
    let by_ticks = by_ticks()?;
    // Only the ticks include threads that have ended; they may lack two ticks.
    Some(by_nanoseconds().map_or(by_ticks, |seconds| seconds.max(by_ticks - 0.02)))
}

/// Processor time from the scheduler's account of each thread.
fn by_nanoseconds() -> Option<f64> {
    // The kernel updates a thread's account when it yields, otherwise only at its tick.
    std::thread::yield_now();
    let tasks = std::fs::read_dir("/proc/self/task").ok()?;
    let of = |task: std::io::Result<std::fs::DirEntry>| {
        let account = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        account.split(' ').next()?.parse::<f64>().ok()
    };
    let nanoseconds = tasks.map(of).sum::<Option<f64>>()?;
    (nanoseconds > 0.0).then_some(1e-9 * nanoseconds)
}

fn by_ticks() -> Option<f64> {
    // proc(5): user and system time are the 14th and 15th field, in ticks of 1/100 s; the 2nd, in brackets, may hold blanks.
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: u64 = fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?;
    Some(ticks as f64 / 100.0)
}
