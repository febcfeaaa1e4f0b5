//! The program `etendue`.

mod allocator;
mod closed_stdout;

use std::process::ExitCode;

fn main() -> ExitCode {
    allocator::return_large_blocks();
    let status = match closed_stdout::is_closed() {
        true => etendue_cli::refuse_closed_stdout(),
        false => etendue_cli::main(std::env::args_os()),
    };
    ExitCode::from(status)
}
