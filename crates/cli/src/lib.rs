//! The command line of Étendue as a library: the program `etendue` is [`main`]; [`call`] runs a verb for another program, which receives its answer.
//! The verbs call the library `etendue`.

// Modules export nothing except the items here: `pub` in them means `for the other modules`.
#![allow(unreachable_pub)]

mod args;
mod browser;
mod catalogue;
mod console;
mod display;
mod machine;
mod memory;
mod output;
mod panics;
mod progress;
mod spelling;
mod subcommands;
mod verbs;

pub use catalogue::{Argument, ArgumentKind, Subcommand, catalogue};
use clap::error::ErrorKind;
use clap::{CommandFactory as _, FromArgMatches as _, Parser};
pub use console::Console;
use etendue::{Error, ErrorCode};
use etendue_scene::limits;
pub use machine::{pool, simd};
pub use memory::stated_or_free as memory_limits;
pub use panics::silence_decoder_panics;
use progress::TerminalProgress;
use spelling::{SpelledConsole, Spelling};
use std::ffi::OsString;
use verbs::Verb;

/// Spectral path tracing joined to a physical camera: from a scene file to the image that camera would capture.
#[derive(Debug, Parser)]
#[command(name = "etendue", version, max_term_width = 110)]
#[command(after_help = "Exit status: 0 done, 1 a comparison or run failed, 2 unusable input or arguments.\n\
    Results go to stdout, everything else to stderr. Start with: etendue render scenes/street/street.toml -o out/street")]
struct Arguments {
    /// The verb.
    #[command(subcommand)]
    verb: Verb,
    /// Raise a limit on input files, e.g. picture-mib=4096; docs/limits.md lists them
    #[arg(id = "limit", long = "limit", value_name = "NAME=N", global = true)]
    limits: Vec<String>,
}

impl Arguments {
    fn run(&self, console: &dyn Console) -> Result<(), Error> {
        for limit in &self.limits {
            set_limit(limit)?;
        }
        self.verb.run(console)
    }
}

/// The grammar of the command line, from which shell completions and manual pages are made.
#[must_use]
pub fn command() -> clap::Command {
    Arguments::command()
}

/// Runs the program: `arguments` begin with its name. Returns its exit status: 0 done, 1 a comparison or run failed, 2 unusable input or arguments.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    panics::silence_decoder_panics();
    let (arguments, spelling) = match parsed(arguments, Spelling::flags) {
        Ok(parsed) => parsed,
        Err(error) => return usage(&error),
    };
    let terminal = TerminalProgress::default();
    let console = SpelledConsole { console: &terminal, spelling: &spelling };
    match panics::catch_panic(|| arguments.run(&console)) {
        Ok(()) => 0,
        Err(error) => {
            output::print_message(&spelling.text(&error.to_string()));
            status(&error)
        }
    }
}

/// Parses the arguments; also returns the spelling of their names for the called verb.
fn parsed(
    arguments: impl IntoIterator<Item = OsString>,
    spelling: fn(&clap::Command, &clap::ArgMatches) -> Spelling,
) -> Result<(Arguments, Spelling), clap::Error> {
    let mut command = command();
    let matches = command.try_get_matches_from_mut(arguments)?;
    let arguments = Arguments::from_arg_matches(&matches).map_err(|error| error.format(&mut command))?;
    Ok((arguments, spelling(&command, &matches)))
}

/// Error code of wrong arguments.
fn code_of(error: &clap::Error) -> ErrorCode {
    match error.kind() {
        ErrorKind::UnknownArgument | ErrorKind::InvalidSubcommand => ErrorCode::UnknownArgument,
        ErrorKind::MissingRequiredArgument | ErrorKind::MissingSubcommand => ErrorCode::MissingArgument,
        ErrorKind::ArgumentConflict => ErrorCode::Contradiction,
        _ => ErrorCode::InvalidArgument,
    }
}

/// Prints help, or the error of the arguments, which are escaped as all other text.
fn usage(error: &clap::Error) -> u8 {
    if error.use_stderr() {
        let code = code_of(error);
        output::print_message(&error.to_string().replacen("error: ", &format!("error[{code}]: "), 1));
        return u8::try_from(error.exit_code()).unwrap_or(2);
    }
    match error.print() {
        Ok(()) => 0,
        Err(cause) => {
            output::print_message(&output::write_error_message(&cause));
            1
        }
    }
}

/// Refuses to run without a standard output, before any work; returns the exit status.
#[must_use]
pub fn refuse_closed_stdout() -> u8 {
    output::print_message(
        "error[unwritable-output]: standard output, which receives the results, is closed; leave it open, or redirect it to a file or to /dev/null\n",
    );
    2
}

/// Changes a limit on input files for the whole process, `NAME=N`, as `--limit`.
///
/// # Errors
/// There is no such limit, or the number is not from 1 to its highest value.
pub fn set_limit(limit: &str) -> Result<(), Error> {
    limits::set(limit).map_err(|error| Error::argument("limit", format!("`limit` {limit}: {error}")))
}

/// Runs a verb: `arguments` are those after the program's name. Its answer is printed on the console. Messages name arguments as parameters: flags
/// without dashes, in backticks.
///
/// # Errors
/// The arguments cannot be used, or the verb fails.
pub fn call(arguments: &[OsString], console: &dyn Console) -> Result<(), Error> {
    let program = OsString::from("etendue");
    let arguments = std::iter::once(&program).chain(arguments).cloned();
    let (arguments, spelling) = parsed(arguments, Spelling::parameters).map_err(|error| {
        let text = error.to_string();
        let words = text.split("\n\nUsage:").next().unwrap_or_default().trim_start_matches("error: ").trim_end();
        Error::coded(code_of(&error), words.lines().map(str::trim).collect::<Vec<_>>().join(" "))
    })?;
    arguments.run(&SpelledConsole { console, spelling: &spelling }).map_err(|error| spelling.error(error))
}

/// Exit status: 2 for unusable input or arguments, 1 for a failed comparison or run.
fn status(error: &Error) -> u8 {
    match error {
        Error::Input(_) => 2,
        Error::Run(_) => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_well_formed() {
        command().debug_assert();
    }
}
