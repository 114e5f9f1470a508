//! Shows a rigged face in a window, and does the same without one: `avatar-viewer --help` explains all.
//!
//! The program only wires: files, command line, clock, keyboard and window on one side, the library crates on the
//! other. Exit status: 0 on success, 2 where the command line has to be corrected, 1 on any other failure.

mod cli;
mod face_args;
mod files;
mod label;
mod offscreen;
mod output;
mod scene;
mod usage;
mod verbs;
mod window;

use clap::{CommandFactory, FromArgMatches};
use std::process::ExitCode;

fn main() -> ExitCode {
    let matches = cli::Cli::command().get_matches();
    let run = match cli::Cli::from_arg_matches(&matches) {
        Ok(cli) => verbs::run(cli, &matches),
        Err(error) => error.exit(),
    };
    let Err(error) = run else { return ExitCode::SUCCESS };
    if output::is_closed_pipe(&error) {
        // Whoever read our output has seen enough (`avatar-viewer trace … | head`).
        return ExitCode::SUCCESS;
    }
    eprintln!("error: {error:#}");
    if error.is::<usage::UsageError>() { ExitCode::from(2) } else { ExitCode::FAILURE }
}
