//! Destination of a verb's answer, and observer of the verb: the terminal of the program, or a caller that receives both.

use etendue::Observer;
use std::path::PathBuf;

/// Output of a verb. Called from worker threads.
pub trait Console: Sync {
    /// Prints a part of the answer; the program prints it on stdout.
    fn print(&self, text: &str);

    /// Prints an answer that is one JSON document.
    fn print_json(&self, document: &str) {
        self.print(document);
    }

    /// Prints a line that is neither answer nor message of the library; the program prints it on stderr.
    fn print_message(&self, line: &str);

    /// True if a person reads the answer as it is printed, so that a page may be opened.
    fn is_terminal(&self) -> bool {
        false
    }

    /// Returns a text of the library, such as a report, with the names of arguments as this console spells them. Other printed text may contain words
    /// of files and is not changed.
    fn spelled(&self, text: &str) -> String {
        text.to_owned()
    }

    /// Receives progress and messages, and can stop the run.
    fn observer(&self) -> &dyn Observer;
}

/// Prints the written files, one per line.
pub(crate) fn print_paths(console: &dyn Console, paths: &[PathBuf]) {
    console.print(&paths.iter().map(|path| format!("{}\n", path.display())).collect::<String>());
}
