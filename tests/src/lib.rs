//! Tests that need two crates or the binary live in `tests/`; this library is empty.
