//! Inputs one after the other, in a process that may die of one.

use crate::attempt::{Attempt, Outcome, attempt};
use crate::mutate::{Material, Mutator};
use crate::targets::Target;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Kept inputs of new ways, beside the seeds.
const MAX_STORED: usize = 2048;
/// Longest input that is kept, bytes.
const MAX_STORED_BYTES: usize = 16_384;
/// Longest time of an input that is mutated, s.
const QUICK_S: f64 = 0.3;
/// How long a finding is made smaller.
const SHRINKING: Duration = Duration::from_secs(4);

/// How long a worker goes on.
#[derive(Clone, Copy, Debug)]
pub enum StopCondition {
    /// For this long.
    Time(Duration),
    /// For so many inputs.
    Inputs(u64),
}

/// What a worker did.
#[derive(Clone, Debug, Default)]
pub struct WorkerResult {
    /// Inputs that were read.
    pub inputs: u64,
    /// Ways that were found, those of the seeds included.
    pub paths: usize,
    /// Most memory of an input, bytes.
    pub peak_bytes: u64,
    /// Longest time of an input, s.
    pub time_s: f64,
    /// Findings: what is wrong, and the smallest input that shows it.
    pub findings: BTreeMap<String, (String, Vec<u8>)>,
}

/// A prepared target.
struct PreparedTarget<'a> {
    target: &'a Target,
    file: PathBuf,
    /// Milliseconds at which the input began that is being read, plus 1; 0: none is.
    input_start: Arc<AtomicU64>,
    start: Instant,
}

impl PreparedTarget<'_> {
    fn read(&self, input: &[u8]) -> Attempt {
        fs::write(&self.file, input).expect("the folder of the worker is writable");
        self.input_start.store(1 + self.start.elapsed().as_millis() as u64, Ordering::Relaxed);
        let attempt = attempt(self.target, &self.file);
        self.input_start.store(0, Ordering::Relaxed);
        attempt
    }

    fn finding_of(&self, input: &[u8]) -> Option<String> {
        let attempt = self.read(input);
        attempt.finding(self.target, input.len()).map(|finding| kind(&finding, &attempt))
    }

    /// The input without what its fault does not need.
    fn shrunk(&self, input: Vec<u8>, kind: &str) -> Vec<u8> {
        let (mut input, mut size, start) = (input, usize::MAX, Instant::now());
        while size > 0 && start.elapsed() < SHRINKING {
            size = size.min(input.len() / 2);
            let mut at = 0;
            while at < input.len() && start.elapsed() < SHRINKING && size > 0 {
                let mut smaller = input.clone();
                smaller.drain(at..(at + size).min(input.len()));
                if self.finding_of(&smaller).as_deref() == Some(kind) {
                    input = smaller;
                } else {
                    at += size;
                }
            }
            size /= 2;
        }
        input
    }
}

/// Ends the process where an input takes too long.
fn watch_time(input_start: Arc<AtomicU64>, start: Instant) {
    std::thread::spawn(move || {
        loop {
            std::thread::sleep(Duration::from_millis(250));
            let since = input_start.load(Ordering::Relaxed);
            let now = start.elapsed().as_millis() as u64;
            if since > 0 && now.saturating_sub(since) as f64 > 1000.0 * crate::watch::LIMIT_S {
                std::process::exit(crate::watch::TIMEOUT_STATUS);
            }
        }
    });
}

/// A fault without what differs from input to input.
fn kind(finding: &str, attempt: &Attempt) -> String {
    match &attempt.outcome {
        Outcome::Panicked(message) => {
            let place = message.strip_prefix("panicked at ").unwrap_or(message);
            place.split(": ").next().unwrap_or(place).to_owned()
        }
        Outcome::Returned(_) => format!("{} {}", finding.split(':').next().unwrap_or_default(), attempt.path()),
    }
}

/// Mutates the seeds of `target` in `folder` and has it read what comes of them.
///
/// # Panics
/// Where the folder cannot be written to.
#[must_use]
pub fn work(target: &Target, folder: &Path, seed: u64, until: StopCondition) -> WorkerResult {
    let mut inputs = (target.prepare)(folder);
    inputs.extend(
        crate::stored_inputs::findings(target.name)
            .into_iter()
            .map(|(_, input)| input)
            .filter(|i| i.len() < MAX_STORED_BYTES),
    );
    let (input_start, start) = (Arc::new(AtomicU64::new(0)), Instant::now());
    watch_time(Arc::clone(&input_start), start);
    let bench = PreparedTarget { target, file: folder.join(target.file), input_start, start };
    // Slow ones would take the time of all others.
    let mut paths = BTreeSet::new();
    inputs.retain(|input| {
        let attempt = bench.read(input);
        paths.insert(attempt.path());
        attempt.time_s < QUICK_S
    });
    let mut work = WorkerResult::default();
    let mut mutator = Mutator::new(seed);
    let go_on = |done: u64| match until {
        StopCondition::Time(time) => start.elapsed() < time,
        StopCondition::Inputs(count) => done < count,
    };
    while go_on(work.inputs) {
        let input = mutator.next(Material { inputs: &inputs, words: target.words, is_text: target.is_text });
        let attempt = bench.read(&input);
        work.inputs += 1;
        work.peak_bytes = work.peak_bytes.max(attempt.peak_bytes);
        work.time_s = work.time_s.max(attempt.time_s);
        if let Some(finding) = attempt.finding(target, input.len()) {
            let kind = kind(&finding, &attempt);
            if let Entry::Vacant(place) = work.findings.entry(kind) {
                let small = bench.shrunk(input, place.key());
                place.insert((finding, small));
            }
        } else if attempt.time_s < QUICK_S && input.len() < MAX_STORED_BYTES && paths.insert(attempt.path()) {
            inputs.push(input);
            // New ways are followed; old ones have been.
            if inputs.len() > MAX_STORED {
                inputs.swap_remove(0);
            }
        }
    }
    work.paths = paths.len();
    work
}
