//! The command line of Étendue: arguments, files, progress and exit codes. Physics lives in the libraries.

// A binary exports nothing: `pub` here means `for the other modules`.
#![allow(unreachable_pub)]

mod args;
mod calibration;
mod camera_file;
mod chart_args;
mod deliver;
mod facts;
mod failure;
mod files;
mod film_file;
mod job;
mod machine;
mod named_file;
mod photographs;
mod plot;
mod progress;
mod raw_file;
mod results;
mod sensor_args;
mod trade;
mod verbs;

use args::{Arguments, Verb};
use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments.verb) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            tell(&failure.to_string());
            ExitCode::from(failure.status())
        }
    }
}

fn run(verb: &Verb) -> Result<(), Failure> {
    match verb {
        Verb::Render(arguments) => verbs::render::run(arguments),
        Verb::Merge(arguments) => verbs::merge::run(arguments),
        Verb::Plan(arguments) => verbs::plan::run(arguments),
        Verb::Expose(arguments) => verbs::expose::run(arguments),
        Verb::Develop(arguments) => verbs::develop::run(arguments),
        Verb::Flat(arguments) => verbs::flat::run(arguments),
        Verb::Datasheet(arguments) => verbs::datasheet::run(arguments),
        Verb::Inspect(arguments) => verbs::inspect::run(arguments),
        Verb::Compare(arguments) => verbs::compare::run(arguments),
        Verb::Chart(arguments) => verbs::chart::run(arguments),
        Verb::Measure(arguments) => verbs::measure::run(arguments),
        Verb::Calibrate(arguments) => verbs::measure::calibrate::run(arguments),
        Verb::Schema(arguments) => verbs::schema::run(arguments),
    }
}

/// Results go to stdout. A reader that has gone away (a closed pipe) ends the program quietly; a full disk is told.
fn say(text: &str) {
    use std::io::{ErrorKind, Write as _};
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => {}
        Err(cause) if cause.kind() == ErrorKind::BrokenPipe => std::process::exit(0),
        Err(cause) => {
            tell(&format!("error: the results cannot be written: {cause}\n"));
            std::process::exit(1);
        }
    }
}

/// Everything that is no result goes to stderr.
fn tell(text: &str) {
    use std::io::Write as _;
    // There is nowhere left to report a failing stderr to.
    let _ = std::io::stderr().lock().write_all(text.as_bytes());
}
