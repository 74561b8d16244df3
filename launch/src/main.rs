//! The binary `limn`: all of it is in the library.

use clap::Parser as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    match limn::cli::run(limn::cli::Cli::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            tracing::error!("{}", limn::story::story(&error));
            ExitCode::FAILURE
        }
    }
}
