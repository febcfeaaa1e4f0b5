//! What the program prints: results to stdout, everything else to stderr.

/// Results go to stdout. A reader that has gone away (a closed pipe) ends the program quietly; a full disk is an error.
pub fn print(text: &str) {
    use std::io::{ErrorKind, Write as _};
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => {}
        Err(cause) if cause.kind() == ErrorKind::BrokenPipe => std::process::exit(0),
        Err(cause) => {
            print_message(&format!("error: the results cannot be written: {cause}\n"));
            std::process::exit(1);
        }
    }
}

/// Everything that is no result goes to stderr.
pub fn print_message(text: &str) {
    use std::io::Write as _;
    // There is nowhere left to report a failing stderr to.
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}
