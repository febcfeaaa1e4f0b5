//! The program `etendue`.

mod closed_stdout;

use std::process::ExitCode;

fn main() -> ExitCode {
    let status = match closed_stdout::is_closed() {
        true => etendue_cli::refuse_closed_stdout(),
        false => etendue_cli::main(std::env::args_os()),
    };
    ExitCode::from(status)
}
