//! Shows a rigged face in a window, and does the same without one: `avatar-viewer --help` explains all.
//!
//! The program only wires: files, command line, clock, keyboard and window on one side, the library crates on
//! the other. Exit status: 0 on success, 2 where the command line has to be corrected, 1 on any other
//! failure.

mod standard;
mod usage;
mod numbers;
mod drafts;
mod output;
mod ending;
mod picture_file;
mod hair_args;
mod label;
mod look_args;
mod lod_args;
mod progress;
mod threads;
mod reading;
mod adapter;
mod recordings;
mod clips;
mod life_args;
mod espeak;
mod speech_args;
mod speech;
mod live;
mod face_args;
mod identity_args;
mod picture_args;
mod spaces_args;
mod live_args;
mod cli;
mod command_line;
mod config;
mod store;
mod files;
mod offscreen;
mod film;
mod sound;
mod window;
mod script;
mod verbs;

use clap::FromArgMatches;
use command_line::wrong_usage;
use std::process::ExitCode;

fn main() -> ExitCode {
    let matches = match command_line::command().try_get_matches() {
        Ok(matches) => matches,
        Err(error) => return wrong_usage(&error),
    };
    quiet_mesa();
    let run = match cli::Cli::from_arg_matches(&matches) {
        Ok(cli) => verbs::run(cli, &matches),
        Err(error) => return wrong_usage(&error),
    };
    let Err(error) = run else { return ExitCode::SUCCESS };
    if standard::is_closed_pipe(&error) {
        // Whoever read our output has seen enough (`avatar-viewer trace … | head`).
        return ExitCode::SUCCESS;
    }
    standard::tell(format_args!("error: {error:#}"));
    if error.is::<usage::UsageError>() { ExitCode::from(2) } else { ExitCode::FAILURE }
}

/// Starts the program anew where Mesa's layer that sorts devices would look for Wayland and print an error of
/// its own among ours (no XDG_RUNTIME_DIR, as in containers). The layer takes its switch from the
/// environment, which a program can set safely only for another one.
fn quiet_mesa() {
    #[cfg(unix)]
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() && std::env::var_os(MESA_SWITCH).is_none() {
        use std::os::unix::process::CommandExt;
        if let Ok(program) = std::env::current_exe() {
            // Returns only if it fails; then the noise stays.
            let arguments = std::env::args_os().skip(1);
            let _ = std::process::Command::new(program).args(arguments).env(MESA_SWITCH, "1").exec();
        }
    }
}

#[cfg(unix)]
const MESA_SWITCH: &str = "NODEVICE_SELECT";
