//! Faults of the program itself: a panic, on whatever thread, ends the run as an error.
//!
//! On its way a panic drops what the run holds: files that have no final name yet are removed, and the run tells what it keeps.

use etendue::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What the user is told after a panic.
const FAULT: &str = "error: a fault in the program ended this run, where the lines above say; files that have their final names are whole. \
    Please report those lines with the job";

/// Panics print their message, but for those of decoders, which become errors of the file.
pub fn quieten_decoders() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !etendue::is_decoding() {
            print(info);
        }
    }));
}

/// What `run` answers; an error where it panics.
pub fn caught(run: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| Err(Error::Run(FAULT.to_owned())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::pool;
    use rayon::prelude::*;

    #[test]
    fn a_panic_of_a_worker_is_an_error_of_the_run() {
        let workers = pool(Some(2)).expect("threads");
        let panicking =
            || workers.install(|| (0..100).into_par_iter().for_each(|i| assert_ne!(i, 57, "a test's panic")));
        let told = caught(|| {
            panicking();
            Ok(())
        });
        assert_eq!(told, Err(Error::Run(FAULT.to_owned())));
        assert_eq!(caught(|| Ok(())), Ok(()));
        workers.install(|| (0..100).into_par_iter().for_each(|_| {}));
    }
}
