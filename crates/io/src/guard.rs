//! Decoders of other authors: where one of them panics, the file is refused.
//!
//! Sizes are checked before anything is decoded; what is left are slips of a decoder over damaged data, which a user cannot tell from a damaged file. The
//! panic ends here. A program may keep its message back ([`is_decoding`]).

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::Error;

thread_local! {
    static DECODING: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is within a decoder whose panics become errors: what a panic hook asks before it prints.
#[must_use]
pub fn is_decoding() -> bool {
    DECODING.get()
}

/// What `decode` makes of the bytes of `file`; an error where it panics.
pub fn guarded<T>(file: &Path, decode: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    let was = DECODING.replace(true);
    let decoded = catch_unwind(AssertUnwindSafe(decode));
    DECODING.set(was);
    decoded.unwrap_or_else(|_| {
        Err(Error::new(
            file,
            "damaged: its data cannot be decoded; make or fetch it again, or store it in another format",
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_within_is_an_error_of_the_file() {
        // The hook is that of all tests of the process: this one prints.
        let told = guarded::<()>(Path::new("a.exr"), || panic!("within a decoder")).expect_err("refused").to_string();
        assert!(told.starts_with("a.exr: damaged: "), "{told}");
        assert!(!is_decoding());
        assert_eq!(guarded(Path::new("a.exr"), || Ok(is_decoding())), Ok(true));
    }
}
