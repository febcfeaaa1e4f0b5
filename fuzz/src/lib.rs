//! Fuzzing of everything of Étendue that reads a file: `cargo run --release -p etendue-fuzz -- --seconds 600 obj ies`.
//!
//! Small valid files are mutated and read by the public readers, in a process of its own for each target. What a reader may not do, whatever the file:
//! panic, end the process, take longer than [`watch::LIMIT_S`], or hold more memory at a time than its target states
//! ([a multiple of the file](targets::Target::times), [and a constant](targets::Target::constant_bytes)). An input whose outcome is told in words that no other was told in is kept and mutated further, so that
//! readers are entered deeply without instruments in their code. The same seed makes the same inputs.
//!
//! - [`targets`]: the closed list of readers, each with its seeds and words;
//! - [`mutate`]: how inputs are changed;
//! - [`attempt`]: one input, one outcome;
//! - [`worker`]: inputs one after the other, findings made small;
//! - [`watch`]: workers as child processes, and what they die of.
//!
//! What was found lies in `fuzz/found`, and a test reads all of it again. docs/evidence/fuzzing.md tells how long each target ran.

pub mod attempt;
pub mod mutate;
mod random;
pub mod stored_inputs;
pub mod targets;
pub mod watch;
pub mod worker;

/// Counts what is allocated, and the most at a time.
#[global_allocator]
static MEMORY: peak_alloc::PeakAlloc = peak_alloc::PeakAlloc;
