//! Internal errors of the program: a panic, on any thread, ends the run as an error.
//!
//! A panic drops the objects of the run: files without a final name are removed, and the run reports the files that remain.

use etendue::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Message after a panic.
const PANIC_MESSAGE: &str = "error: an internal error ended this run, at the place stated above; files with their final \
    names are complete. Please report the lines above with the job";

/// Prints the messages of panics, except those of decoders, which become errors of the file.
pub fn silence_decoder_panics() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !etendue::is_decoding() {
            print(info);
        }
    }));
}

/// Returns the result of `run`; an error if it panics.
pub fn catch_panic(run: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
    catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(|_| Err(Error::Run(PANIC_MESSAGE.to_owned())))
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
        let error = catch_panic(|| {
            panicking();
            Ok(())
        });
        assert_eq!(error, Err(Error::Run(PANIC_MESSAGE.to_owned())));
        assert_eq!(catch_panic(|| Ok(())), Ok(()));
        workers.install(|| (0..100).into_par_iter().for_each(|_| {}));
    }
}
