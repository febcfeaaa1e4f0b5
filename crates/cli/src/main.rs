//! The command line of Étendue.
fn main() {}
