//! Where a verb's answer goes, and who watches the verb: the terminal of the program, or a caller that takes both.

use etendue::Observer;
use std::path::PathBuf;

/// What a verb answers to. Called from worker threads.
pub trait Console: Sync {
    /// A part of the answer: what the program prints on stdout.
    fn print(&self, text: &str);

    /// The answer, where it is one JSON document.
    fn print_json(&self, document: &str) {
        self.print(document);
    }

    /// A line beside the answer that is no message of the library: what the program prints on stderr.
    fn tell(&self, line: &str);

    /// Whether a person reads the answer as it is printed, for whom a page may be opened.
    fn is_terminal(&self) -> bool {
        false
    }

    /// Returns a text of the library, such as a report, with the names of arguments as this console spells them. What is printed otherwise
    /// may hold words of files and stays as it is.
    fn spelled(&self, text: &str) -> String {
        text.to_owned()
    }

    /// Who is told of progress and messages, and asked whether to stop.
    fn observer(&self) -> &dyn Observer;
}

/// The files that were written, one a line.
pub(crate) fn print_paths(console: &dyn Console, paths: &[PathBuf]) {
    console.print(&paths.iter().map(|path| format!("{}\n", path.display())).collect::<String>());
}
