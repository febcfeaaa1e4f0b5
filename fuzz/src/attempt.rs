//! One input and what its reader makes of it.

use crate::MEMORY;
use crate::targets::Target;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// What came of an input.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// What the reader said, or where it panicked.
    pub outcome: Outcome,
    /// Most memory that it held at a time, bytes.
    pub peak_bytes: u64,
    /// How long it took, s of processor time.
    pub time_s: f64,
}

/// How a reader ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// As it should: what it read or refused, in words.
    Returned(String),
    /// By a panic: its place and message.
    Panicked(String),
}

/// The first panic of an attempt, on whatever thread.
static PANIC: Mutex<Option<String>> = Mutex::new(None);

fn first_panic() -> MutexGuard<'static, Option<String>> {
    PANIC.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps places and messages of panics, and prints none.
pub fn keep_panics() {
    std::panic::set_hook(Box::new(|info| {
        let message = info.to_string().replace('\n', " ");
        first_panic().get_or_insert(message);
    }));
}

/// Has a target read the file that it is prepared for.
#[must_use]
pub fn attempt(target: &Target, file: &Path) -> Attempt {
    *first_panic() = None;
    MEMORY.reset_peak_usage();
    let (before, start) = (MEMORY.current_usage(), processor_time_s());
    let read_result = catch_unwind(AssertUnwindSafe(|| (target.read)(file)));
    let time_s = processor_time_s() - start;
    let peak_bytes = MEMORY.peak_usage().saturating_sub(before) as u64;
    let outcome = match read_result {
        // The folder of the worker has another name each time.
        Ok(text) => Outcome::Returned(text.replace(&*file.with_file_name("").to_string_lossy(), "")),
        Err(_) => Outcome::Panicked(first_panic().take().unwrap_or_default()),
    };
    Attempt { outcome, peak_bytes, time_s }
}

/// Processor time of all threads of this process, readers' pools included, s, so that a busy machine makes nobody slow; the clock's where the system does
/// not tell. Threads that have ended are left out: pools last.
fn processor_time_s() -> f64 {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    let thread_time = |thread: std::fs::DirEntry| {
        let schedstat = std::fs::read_to_string(thread.path().join("schedstat")).ok()?;
        schedstat.split(' ').next()?.parse::<f64>().ok()
    };
    let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let nanoseconds: f64 = threads.filter_map(thread_time).sum();
    if nanoseconds > 0.0 { 1e-9 * nanoseconds } else { START.elapsed().as_secs_f64() }
}

impl Attempt {
    /// What is wrong with it, for an input of this length; `None` where nothing is.
    #[must_use]
    pub fn finding(&self, target: &Target, length: usize) -> Option<String> {
        if let Outcome::Panicked(message) = &self.outcome {
            return Some(format!("panic: {message}"));
        }
        let max_bytes = target.max_bytes(length);
        if self.peak_bytes > max_bytes {
            return Some(format!(
                "memory: {} bytes, where {length} bytes of input may take {max_bytes}",
                self.peak_bytes
            ));
        }
        (self.time_s > crate::watch::SLOW_S).then(|| format!("time: {} s", self.time_s))
    }

    /// The words of the outcome without numbers and what is quoted: equal for inputs that go the same way.
    #[must_use]
    pub fn path(&self) -> String {
        let (Outcome::Returned(text) | Outcome::Panicked(text)) = &self.outcome;
        path_of(text)
    }
}

fn path_of(text: &str) -> String {
    let mut path = String::new();
    let mut quoted = false;
    for letter in text.chars().take(2000) {
        match letter {
            '"' | '`' => quoted = !quoted,
            _ if quoted || letter.is_ascii_digit() || !letter.is_ascii() => {}
            _ => path.push(letter),
        }
    }
    path.truncate(160);
    path
}
