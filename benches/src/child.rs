//! This program run again, in a process of its own: for memory, whose peak a process has once.

use std::process::Command;

/// What the program answers to these arguments, without the end of the line. Panics where it fails.
pub fn answer(arguments: &[&str]) -> String {
    let program = std::env::current_exe().expect("this program has a file");
    let output = Command::new(program).args(arguments).output().expect("this program can be run again");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

/// A row of a table: its name and the words of an answer.
pub fn row(name: &str, arguments: &[&str]) -> Vec<String> {
    std::iter::once(name.to_owned()).chain(answer(arguments).split_whitespace().map(str::to_owned)).collect()
}
