//! Writes the shell completions and manual pages of the program below a folder: `completions` (bash, zsh, fish) and
//! `man/man1`, a page for the program and for each of its verbs.

use clap_complete::Shell;
use std::io;
use std::path::Path;
use std::process::ExitCode;

/// The program's name, as its users type it.
const PROGRAM: &str = "etendue";
const SHELLS: [Shell; 3] = [Shell::Bash, Shell::Zsh, Shell::Fish];

fn main() -> ExitCode {
    let Some(folder) = std::env::args_os().nth(1) else {
        return failed("the folder to write to is missing: etendue-packaging FOLDER");
    };
    match write_below(Path::new(&folder)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failed(&format!("{}: {error}", Path::new(&folder).display())),
    }
}

#[allow(clippy::print_stderr)]
fn failed(message: &str) -> ExitCode {
    eprintln!("error: {message}");
    ExitCode::FAILURE
}

fn write_below(folder: &Path) -> io::Result<()> {
    let (completions, manual) = (folder.join("completions"), folder.join("man/man1"));
    std::fs::create_dir_all(&completions)?;
    std::fs::create_dir_all(&manual)?;
    for shell in SHELLS {
        clap_complete::generate_to(shell, &mut etendue_cli::command(), PROGRAM, &completions)?;
    }
    clap_mangen::generate_to(etendue_cli::command(), &manual)
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_cli::Subcommand;

    fn written() -> tempfile::TempDir {
        let folder = tempfile::tempdir().expect("a temporary folder");
        write_below(folder.path()).expect("completions and pages are written");
        folder
    }

    /// The names of all verbs, those of a group with the group's name before them.
    fn verbs(catalogue: &[Subcommand], group: &str) -> Vec<String> {
        let names = |verb: &Subcommand| {
            let name = format!("{group}{}", verb.name);
            let within = verbs(&verb.verbs, &format!("{name}-"));
            std::iter::once(name).chain(within).collect::<Vec<_>>()
        };
        catalogue.iter().flat_map(names).collect()
    }

    #[test]
    fn every_verb_has_a_manual_page() {
        let folder = written();
        let verbs = verbs(&etendue_cli::catalogue(), "");
        assert!(verbs.len() > 40 && verbs.iter().any(|verb| verb == "measure-sfr"), "{verbs:?}");
        for verb in verbs {
            let file = folder.path().join(format!("man/man1/etendue-{verb}.1"));
            let page = std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            assert!(page.contains(".SH SYNOPSIS") && page.contains(".SH OPTIONS"), "{page}");
        }
    }

    #[test]
    fn completions_of_every_shell_know_all_verbs() {
        let folder = written();
        for file in ["etendue.bash", "_etendue", "etendue.fish"] {
            let text = std::fs::read_to_string(folder.path().join("completions").join(file)).expect("completions");
            for verb in etendue_cli::catalogue() {
                assert!(text.contains(&verb.name), "{file} lacks {}", verb.name);
            }
        }
    }
}
