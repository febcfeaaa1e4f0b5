//! The command line of Étendue: arguments, progress, tables and exit codes. What it does is the library `etendue`.

// A binary exports nothing: `pub` here means `for the other modules`.
#![allow(unreachable_pub)]

mod args;
mod display;
mod machine;
mod output;
mod panics;
mod progress;
mod subcommands;
mod verbs;

use clap::Parser;
use etendue::Error;
use etendue_scene::limits;
use std::process::ExitCode;
use verbs::Verb;

/// Spectral path tracing joined to a physical camera: from a scene file to the picture that camera would have taken.
#[derive(Debug, Parser)]
#[command(name = "etendue", version, max_term_width = 110)]
#[command(after_help = "Exit status: 0 done, 1 a comparison or run failed, 2 unusable input or arguments.\n\
    Results go to stdout, everything else to stderr. Start with: etendue render scenes/street/street.toml -o out/street")]
struct Arguments {
    /// What to do.
    #[command(subcommand)]
    verb: Verb,
    /// Move a limit on what files may cost, e.g. picture-mib=4096; docs/limits.md lists them
    #[arg(long = "limit", value_name = "NAME=N", global = true)]
    limits: Vec<String>,
}

impl Arguments {
    fn run(&self) -> Result<(), Error> {
        for limit in &self.limits {
            limits::set(limit).map_err(|told| Error::input(format!("--limit {limit}: {told}")))?;
        }
        self.verb.run()
    }
}

fn main() -> ExitCode {
    panics::quieten_decoders();
    let arguments = Arguments::parse();
    match panics::caught(|| arguments.run()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            output::print_message(&error.to_string());
            ExitCode::from(status(&error))
        }
    }
}

/// 2 for unusable input or arguments, 1 where a comparison or run failed.
fn status(error: &Error) -> u8 {
    match error {
        Error::Input(_) => 2,
        Error::Run(_) => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_well_formed() {
        Arguments::command().debug_assert();
    }
}
