//! The command line of Étendue: arguments, progress, tables and exit codes. What it does is the library `etendue`.

// A binary exports nothing: `pub` here means `for the other modules`.
#![allow(unreachable_pub)]

mod args;
mod commands;
mod machine;
mod output;
mod progress;

use args::{Arguments, Verb};
use clap::Parser;
use etendue::Error;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments.verb) {
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

fn run(verb: &Verb) -> Result<(), Error> {
    match verb {
        Verb::Render(arguments) => commands::render::run(arguments),
        Verb::Merge(arguments) => commands::render::merge(arguments),
        Verb::Plan(arguments) => commands::plan::run(arguments),
        Verb::Expose(arguments) => commands::render::expose(arguments),
        Verb::Develop(arguments) => commands::render::develop(arguments),
        Verb::Flat(arguments) => commands::sensor::flat(arguments),
        Verb::Datasheet(arguments) => commands::sensor::datasheet(arguments),
        Verb::Inspect(arguments) => commands::inspect::run(arguments),
        Verb::Compare(arguments) => commands::compare::run(arguments),
        Verb::Chart(arguments) => commands::chart::run(arguments),
        Verb::Measure(arguments) => commands::measure::run(arguments),
        Verb::Calibrate(arguments) => commands::measure::calibrate(arguments),
        Verb::Schema(arguments) => commands::schema::run(arguments),
    }
}
