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
mod progress;
mod reading;
mod adapter;
mod clips;
mod face_args;
mod picture_args;
mod cli;
mod offscreen;
mod film;
mod config;
mod store;
mod files;
mod window;
mod script;
mod verbs;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches};
use std::process::ExitCode;

fn main() -> ExitCode {
    let matches = match cli::Cli::command().try_get_matches() {
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

/// What clap says, or prints: help and version are errors to it. Names are explained as everywhere else.
fn wrong_usage(error: &clap::Error) -> ExitCode {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => text.as_str(),
        _ => "",
    };
    let command = cli::Cli::command();
    let verbs = || command.get_subcommands().map(clap::Command::get_name);
    let names = match error.get(ContextKind::ValidValue) {
        Some(ContextValue::Strings(names)) => names.as_slice(),
        _ => &[],
    };
    let own = if !names.is_empty() {
        let option = text(ContextKind::InvalidArg).split(' ').next().unwrap_or_default();
        let found = text(ContextKind::InvalidValue);
        Some(usage::unknown_option(option, found, names.iter().map(String::as_str)))
    } else if error.kind() == ErrorKind::InvalidSubcommand {
        Some(usage::unknown_option("verb", text(ContextKind::InvalidSubcommand), verbs()))
    } else {
        None
    };
    match own {
        Some(error) => standard::tell(format_args!("error: {error}\n\nFor more information, try '--help'.")),
        // Nothing can be done where nobody reads it.
        None => drop(error.print()),
    }
    let mut words = std::env::args_os().skip(1);
    let is_verb = |word: &std::ffi::OsString| verbs().any(|verb| word == verb);
    if error.use_stderr()
        && words.next().is_some_and(|word| !is_verb(&word))
        && let Some(verb) = words.find(is_verb)
    {
        standard::tell(format_args!(
            "A verb comes first, its options after it: avatar-viewer {} …",
            verb.display()
        ));
    }
    ExitCode::from(if error.use_stderr() { 2 } else { 0 })
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
